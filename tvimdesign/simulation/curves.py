"""What is drawn: the layer's temperatures over each phase, and stiffness and damping against temperature."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.polymer import ZERO_CELSIUS
from tvimdesign.simulation.device_functions import DeviceFunctions
from tvimdesign.simulation.melt_history import HISTORIES, fractions_at
from tvimdesign.simulation.resolved_module import ResolvedModule
from tvimdesign.simulation.trajectory import Trajectory

Array = NDArray[np.float64]
Curves = dict[str, list[float]]
SAMPLES = 161


def phase_history(model: DeviceFunctions, inputs: Array, trajectory: Trajectory, phase: str) -> Curves:
    """Temperatures [degC] through the stack over a phase, current [A], impedance [N*m/rad], frozen share, by column."""
    states, times = trajectory.states, trajectory.times
    currents = trajectory.currents[None, :]
    columns = np.repeat(inputs[:, None], len(times), axis=1)
    compiled = model.phases[phase]
    temperatures = np.asarray(compiled.temperatures.map(len(times))(states, currents, columns)) - ZERO_CELSIUS
    impedance = np.asarray(compiled.impedance_now.map(len(times))(states, currents, columns)).ravel()
    frozen = np.mean(np.asarray(compiled.fractions.map(len(times))(states, currents, columns)), axis=0)
    depth = [f"cell_{i + 1}" for i in range(model.cells)]
    plate = [f"rotor_{i + 1}" for i in range(int(inputs[model.index["rotor_cells"]]))]
    names = ["cold_side", "hot_side", "near_face", *depth, "far_face", *plate, "rotor_rest", "core_and_link"]
    names += ["sink"] * (len(temperatures) - len(names))
    history = dict(zip(names, temperatures.tolist(), strict=True))
    more = {"current": trajectory.currents.tolist(), "frozen": frozen.tolist(), "joint_impedance": impedance.tolist()}
    return {"time": times.tolist(), **history, **more}


def impedance_sweep(resolved: ResolvedModule) -> Curves:
    """Stiffness and damping of layer and joint against the layer's temperature [degC], at the hot point's frequency.

    Each with its least and largest value over what history allows, `..._low` and `..._high`; the middle one is the
    equilibrium curve on heating. `rig` holds the design's numbers.
    """
    celsius = np.linspace(0.0, 120.0, SAMPLES)
    names = ["pcl_stiffness", "pcl_damping", "joint_stiffness", "joint_damping", "solid_fraction"]
    low, nominal, high = np.array([fractions_at(resolved, float(at)) for at in celsius + ZERO_CELSIUS]).T
    shares = np.array([nominal, *(low + part * (high - low) for part in np.linspace(0.0, 1.0, HISTORIES))])
    # Every sample at once; the solid fraction at the hot point is given.
    swept = {**resolved.values, "temperature@hot": celsius + ZERO_CELSIUS, "solid_fraction@hot": shares}
    found = resolved.table.evaluate(swept, [f"{name}@hot" for name in names])
    curves: Curves = {"temperature": celsius.tolist()}
    for name in names:
        every = found[f"{name}@hot"]
        curves |= {name: every[0].tolist(), f"{name}_low": every.min(axis=0).tolist(),
                   f"{name}_high": every.max(axis=0).tolist()}  # fmt: skip
    return curves
