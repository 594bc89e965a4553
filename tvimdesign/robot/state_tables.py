"""The joint's stiffness and damping as columns: at each state, element by element, and over temperature."""

from __future__ import annotations

from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.robot.joint_model import JointModel
from tvimdesign.simulation.working_cycle.curves import impedance_sweep
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule

Columns = dict[str, list[float]]
UNITS = {
    "temperature": "degC", "frequency": "Hz", "stiffness": "N*m/rad", "damping": "N*m*s/rad", "springs": "N*m/rad",
    "friction": "N*m", "relaxation_time": "s", "joint_stiffness": "N*m/rad", "joint_damping": "N*m*s/rad",
}  # fmt: skip
"""Of the columns; what is not here has none."""


def unit_of(column: str) -> str:
    """Unit of a column, also of the least and the largest value of one."""
    return UNITS.get(column.removesuffix("_low").removesuffix("_high"), "1")


def states(model: JointModel) -> Columns:
    """A row for each state: at which frequency the whole joint has which stiffness and damping, and its friction."""
    return {
        "temperature": [state.temperature - ZERO_CELSIUS for state in model.states],
        "frequency": [state.frequency for state in model.states],
        "stiffness": [state.stiffness for state in model.states],
        "damping": [state.damping for state in model.states],
        "springs": [state.springs for state in model.states],
        "friction": [state.friction for state in model.states],
    }


def elements(model: JointModel) -> Columns:
    """A row for each Maxwell element of each state, beside the springs: all of the joint's linear behaviour."""
    rows = [(state.temperature, time, k) for state in model.states for time, k in state.modes]
    temperatures, times, stiffnesses = (list(column) for column in zip(*rows, strict=True))
    return {
        "temperature": [value - ZERO_CELSIUS for value in temperatures],
        "relaxation_time": times,
        "stiffness": stiffnesses,
    }


def over_temperature(resolved: ResolvedModule, model: JointModel) -> Columns:
    """Stiffness and damping of the joint against temperature, at the hot point's frequency, as heated.

    `..._low` and `..._high` are the least and the largest over what the PCL's history allows.
    """
    swept = impedance_sweep(resolved)
    kept = [name for name in swept if name.startswith(("joint_", "solid_fraction"))]
    frequency = float(resolved.quantity("frequency@hot"))
    count = len(swept["temperature"])
    return {
        "temperature": swept["temperature"],
        "frequency": [frequency] * count,
        **{name: swept[name] for name in kept},
        "springs": [model.states[0].springs] * count,
    }
