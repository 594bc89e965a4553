"""What is drawn: the layer's temperatures over a switch, and stiffness and damping against temperature."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.polymer import ZERO_CELSIUS
from tvimdesign.solve.model import Model
from tvimdesign.solve.simulate import Switch

Array = NDArray[np.float64]
Curves = dict[str, list[float]]
SAMPLES = 161


def switch_history(model: Model, inputs: Array, switch: Switch) -> Curves:
    """Temperatures [degC] through the stack over one switch, and the joint's impedance [N*m/rad], by column name."""
    states, times = switch.trajectory.states, switch.trajectory.times
    columns = np.repeat(inputs[:, None], len(times), axis=1)
    temperatures = np.asarray(model.temperatures.map(len(times))(states, columns)) - ZERO_CELSIUS
    impedance = np.asarray(model.impedance_now.map(len(times))(states, columns)).ravel()
    depth = [f"cell_{i + 1}" for i in range(model.cells)]
    plate = [f"rotor_{i + 1}" for i in range(int(inputs[model.index["rotor_cells"]]))]
    names = ["cold_side", "hot_side", "near_face", *depth, "far_face", *plate, "rotor_rest", "core_and_link"]
    history = dict(zip(names, temperatures.tolist(), strict=True))
    return {"time": times.tolist(), **history, "joint_impedance": impedance.tolist()}


def impedance_sweep(model: Model, inputs: Array, switch: Switch) -> Curves:
    """Stiffness and damping of layer and joint against the layer's temperature [degC], at the hot point's frequency."""
    temperatures = np.linspace(0.0, 120.0, SAMPLES)
    names = ["pcl_stiffness", "pcl_damping", "joint_stiffness", "joint_damping", "solid_fraction"]
    columns = np.repeat(inputs[:, None], SAMPLES, axis=1)
    columns[model.index["temperature@hot"]] = temperatures + ZERO_CELSIUS
    outputs = model.outputs([f"{name}@hot" for name in names])
    switches = np.repeat(np.array([[switch.values[name]] for name in model.switch_names]), SAMPLES, axis=1)
    values = np.asarray(outputs.map(SAMPLES)(columns, switches))
    return {"temperature": temperatures.tolist(), **dict(zip(names, values.tolist(), strict=True))}
