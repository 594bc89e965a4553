"""Curves to draw: the layer's temperatures over each phase, and stiffness and damping against temperature."""

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.simulation.working_cycle.cycle import Trajectory
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule
from tvimdesign.simulation.working_cycle.melt_history import HISTORIES, fractions_at, left_at
from tvimdesign.simulation.working_cycle.phase_functions import SHOWN, PhaseFunctions

Array = NDArray[np.float64]
Curves = dict[str, list[float]]
SAMPLES = 161
LOOP_SAMPLES = 73
PHASE_UNITS = {
    "time": "s", "current": "A", "frozen": "1", "joint_impedance": "N*m/rad", "joint_stiffness": "N*m/rad",
    "joint_damping": "N*m*s/rad", "electrical_power": "W", "electrical_energy": "J",
}  # fmt: skip
"""Units of a phase's columns; all others are temperatures [degC]."""


def phase_history(model: DeviceFunctions, inputs: Array, trajectory: Trajectory, phase: str) -> Curves:
    """Return a phase's curves by column: temperatures [degC] through the stack, and the columns of `PHASE_UNITS`.

    Stiffness and damping are those of the joint at the frequency of the operating point where the phase leads; energy
    is what the supply gave since the phase began.
    """
    states, times = trajectory.states, trajectory.times
    currents = trajectory.currents[None, :]
    columns = np.repeat(inputs[:, None], len(times), axis=1)
    compiled = model.phases[phase]
    temperatures = np.asarray(compiled.temperatures.map(len(times))(states, currents, columns)) - ZERO_CELSIUS
    impedance = np.asarray(compiled.impedance_now.map(len(times))(states, currents, columns)).ravel()
    frozen = np.mean(np.asarray(compiled.fractions.map(len(times))(states, currents, columns)), axis=0)
    names = temperature_names(model, inputs, compiled)
    history = dict(zip(names, temperatures.tolist(), strict=True))
    shown = np.asarray(compiled.watch(list(SHOWN.values())).map(len(times))(states, currents, columns))
    drawn = dict(zip(SHOWN, shown, strict=True))
    power = drawn["electrical_power"]
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(times))])
    more = {"current": trajectory.currents, "frozen": frozen, "joint_impedance": impedance, **drawn,
            "electrical_energy": energy}  # fmt: skip
    return {"time": times.tolist(), **history, **{name: column.tolist() for name, column in more.items()}}


def temperature_names(model: DeviceFunctions, inputs: Array, compiled: PhaseFunctions) -> list[str]:
    """Return a name for each of a phase's temperatures, in their order."""
    depth = [f"cell_{i + 1}" for i in range(model.cells)]
    plate = [f"rotor_{i + 1}" for i in range(int(inputs[model.index["rotor_cells"]]))]
    names = ["cold_side", "hot_side", "near_face", *depth, "far_face", *plate]
    beside, around = compiled.bodies
    names += [*(f"rotor_beside_{i + 1}" for i in range(beside - 1)), "core_and_link"]
    names += ["sink"] * (compiled.temperatures.numel_out(0) - len(names) - around)
    return [*names, *(f"beside_pads_{i + 1}" for i in range(around - 1)), "housing"]


def torque_loop(stiffness: float, damping: float, frequency: float, amplitude: float) -> tuple[Array, Array]:
    """Return angles [rad] and torques [N*m] of one period in which a joint is turned as a sine.

    T = K phi + b dphi/dt with phi = amplitude sin(2 pi f t): stiffness [N*m/rad], damping [N*m*s/rad], frequency [Hz].
    """
    turned = np.linspace(0.0, 2.0 * np.pi, LOOP_SAMPLES)
    angle = amplitude * np.sin(turned)
    return angle, stiffness * angle + damping * 2.0 * np.pi * frequency * amplitude * np.cos(turned)


def impedance_sweep(resolved: ResolvedModule) -> Curves:
    """Return layer's and joint's stiffness and damping against the layer's temperature [degC] at the hot frequency.

    Each with its least and largest value over what history allows, `..._low` and `..._high`; the middle one is the
    equilibrium curve on heating. `rig` holds the design's numbers.
    """
    celsius = np.linspace(0.0, 120.0, SAMPLES)
    names = ["pcl_stiffness", "pcl_damping", "joint_stiffness", "joint_damping", "solid_fraction"]
    low, nominal, high = np.array([fractions_at(resolved, float(at)) for at in celsius + ZERO_CELSIUS]).T
    shares = np.array([nominal, *(low + part * (high - low) for part in np.linspace(0.0, 1.0, HISTORIES))])
    # Every sample at once; the solid fraction at the hot point is given.
    swept = left_at(resolved.values, "hot", shares, nominal) | {"temperature@hot": celsius + ZERO_CELSIUS}
    found = resolved.table.evaluate(swept, [f"{name}@hot" for name in names])
    curves: Curves = {"temperature": celsius.tolist()}
    for name in names:
        every = np.broadcast_to(found[f"{name}@hot"], shares.shape)
        curves |= {name: every[0].tolist(), f"{name}_low": every.min(axis=0).tolist(),
                   f"{name}_high": every.max(axis=0).tolist()}  # fmt: skip
    return curves
