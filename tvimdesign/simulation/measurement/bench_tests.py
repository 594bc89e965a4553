"""Tests of one module in a laboratory: rows to fill in, and values that the module's own equations predict for them.

Each function returns the columns of a test in SI, by the quantities that `fit` reads: what is set, from the module as
it is, and what is measured, from a module with some inputs replaced. Data made so go through `fit` and give the inputs
again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from tvimdesign.physics.heat_flow import peltier
from tvimdesign.physics.springs import spring
from tvimdesign.simulation.measurement.kinds import frozen_torque, pad, release, torque_angle
from tvimdesign.simulation.measurement.kinds.heating_log import Course, LoggedModule, heat_inputs
from tvimdesign.simulation.measurement.kinds.joint_of_module import FROZEN, JointOfModule
from tvimdesign.simulation.measurement.reading.data_file import Array
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule

Columns = dict[str, Array]
Inputs = Mapping[str, float]
DESIGN = "design.json"
"""File of the module, in the folder of its tests."""
ARM = 0.1
"""m, of the arm that weights hang on."""
_AIR = 296.15  # K
_PULLED, _BEYOND = 0.5, 3.0
"""Share of what a frozen joint holds by which it is pulled and let go; of the bond's, up to which it is turned."""
_CYCLES = (0, 10, 100)
"""Freezings and meltings that the bond has seen."""
_PERIODS, _SAMPLES = 12, 300


def weights(module: ResolvedModule, inputs: Inputs) -> Columns:
    """Return masses on an arm, up and down, and the angle of the joint on its springs alone."""
    names = ["spring_stiffness", "pin_friction_torque"]
    drawn, built = (_values(module, names, given) for given in ({}, inputs))
    most = drawn["spring_stiffness"] * float(module.values["stroke"]) / (ARM * torque_angle.GRAVITY)
    up = np.round(np.linspace(0.0, most, 7), 2)
    mass = np.concatenate([up, up[-2::-1]])
    known = {"stiffness": built["spring_stiffness"], "zero_angle": 0.0, "friction": built["pin_friction_torque"]}
    return {"mass": mass, "angle": torque_angle.angle_of(mass * ARM * torque_angle.GRAVITY, known)}


def weights_settings(module: ResolvedModule) -> dict[str, str]:
    """Return the spring's sizes; the coils that bend are those that give the module's rate."""
    modulus, wire, coil = (float(module.values[name]) for name in (
        "spring_youngs_modulus", "wire_diameter", "coil_diameter"))  # fmt: skip
    values = _values(module, ["spring_stiffness", "spring_rate", "spring_count"], {})
    rate, count = values["spring_rate"], values["spring_count"]
    return {
        "arm": f"{1e3 * ARM:g} mm", "wire_diameter": f"{1e3 * wire:.6g} mm", "coil_diameter": f"{1e3 * coil:.6g} mm",
        "coil_count": f"{float(spring.rate(modulus, wire, coil, 1.0)) / rate:.6g}", "spring_count": f"{count:g}",
        "transmission": f"{np.sqrt(values['spring_stiffness'] / (count * rate)):.6g}",
    }  # fmt: skip


def pads(module: ResolvedModule, inputs: Inputs) -> Columns:
    """Return currents, and voltage and cold face of an insulated pad whose other face is near the air's temperature."""
    most = min(float(module.values["current"]), 2.0)
    current = np.round(np.linspace(0.2, 1.0, 8) * most, 2)
    names = ("peltier_seebeck", "peltier_resistance", "peltier_conductance")
    seebeck, resistance, conductance = (float({**module.values, **inputs}[name]) for name in names)
    single = peltier.PeltierModule(seebeck, resistance, conductance)
    hot = _AIR + 3.0 * current / most
    cold = pad.cold_temperature(single, current, hot, 0.0, 0.0, _AIR)
    voltage = peltier.voltage(single, current, hot, cold)
    return {"current": current, "voltage": voltage, "hot_temperature": hot, "cold_temperature": cold}


def log(module: ResolvedModule, inputs: Inputs) -> Columns:
    """Return the module's log: heated until it is soft and half as long again, then left to the air."""
    heating = 1.5 * float(module.values["response_time"])
    time = np.concatenate([heating * np.linspace(0.0, 1.0, 26) ** 2, heating * (1.0 + np.linspace(0.0, 2.0, 26)[1:])])
    time, current = np.round(time, 1), float(module.values["current"])
    on = np.where(time < time[25], current, 0.0)
    names = [*heat_inputs(module), "ambient_temperature"]
    logged = LoggedModule(module, names)
    values = {name: ca.DM(float({**module.values, **inputs}[name])) for name in names}
    places = logged.temperatures(Course(time, on[:-1], 25), values)
    taken = ("hot_temperature", "cold_temperature", "rotor_temperature", "housing_temperature")
    seen = ca.evalf(ca.horzcat(*(ca.MX(places[name]) for name in taken)))
    columns = dict(zip(taken, np.asarray(ca.DM(seen)).T, strict=True))
    return {"time": time, "current": on, **columns}


def frozen(module: ResolvedModule, inputs: Inputs) -> Columns:
    """Return angles, and the torque of a frozen joint up to beyond what its bond bears."""
    stiffness = _values(module, ["joint_stiffness@cold"], {})["joint_stiffness@cold"]
    drawn, built = (_bond_torque(module, given) for given in ({}, inputs))
    angle = np.linspace(0.0, _BEYOND * drawn / stiffness, 60)
    known = {"stiffness": stiffness, "holding_torque": built, "zero_angle": 0.0}
    return {"angle": angle, "torque": _numbers(frozen_torque.torque_of(ca.DM(angle), known))}


def thawed(module: ResolvedModule, inputs: Inputs) -> Columns:
    """Return the same of joints whose bond was frozen and molten many times."""
    columns = frozen(module, inputs)
    count = len(columns["angle"])
    return {"specimen": np.repeat(_CYCLES, count), **{name: np.tile(values, 3) for name, values in columns.items()}}


def holding(module: ResolvedModule) -> float:
    """Return the torque [N*m] that the weakest part of the frozen joint bears."""
    return _values(module, ["holding_torque"], {})["holding_torque"]


def bond_settings(module: ResolvedModule) -> dict[str, str]:
    """Return the sizes of the layer."""
    inner, outer, span, count = _layer(module)
    return {
        "layer_inner_radius": f"{1e3 * inner:.6g} mm", "layer_outer_radius": f"{1e3 * outer:.6g} mm",
        "layer_span": f"{np.degrees(span):.6g} deg", "layer_count": f"{count:g}",
    }  # fmt: skip


def ringing(module: ResolvedModule, inputs: Inputs) -> Columns:
    """Return the swing of a frozen joint that is let go at half of what it bears."""
    inertia = float(module.values["moving_inertia"])
    drawn, _, omega = _swinging(module, {})
    stiffness, damping, _ = _swinging(module, inputs)
    first = _PULLED * min(_bond_torque(module, {}), holding(module)) / drawn
    time = np.linspace(0.0, _PERIODS * 2.0 * np.pi / omega, _SAMPLES)
    known = {"inertia": inertia, "damping": damping, "friction": 0.0, "stiffness": stiffness, "zero_angle": 0.0,
             "first_angle": first, "first_speed": 0.0}  # fmt: skip
    return {"time": time, "angle": _numbers(release.swing(time, known, 6, first * omega))}


def ringing_settings(module: ResolvedModule) -> dict[str, str]:
    """Return the inertia, and the module whose joint it is."""
    return {"inertia": f"{float(module.values['moving_inertia']):.6g} kg.m^2", "study": DESIGN, "state": FROZEN}


def _swinging(module: ResolvedModule, inputs: Inputs) -> tuple[float, float, float]:
    """Return stiffness and damping at the frequency [rad/s] at which the frozen joint swings."""
    inertia, omega = float(module.values["moving_inertia"]), 2.0 * np.pi * 100.0
    stiffness, damping = 0.0, 0.0
    for _ in range(20):
        joint = JointOfModule(module, Path(), FROZEN, omega, 0.0)
        stiffness, damping = (float(value) for value in joint.impedance(inputs))
        omega = float(np.sqrt(stiffness / inertia))
    return stiffness, damping, omega


def _layer(module: ResolvedModule) -> tuple[float, float, float, float]:
    inner, outer, span = (float(module.values[n]) for n in ("pcl_inner_radius", "pcl_outer_radius", "arc_span"))
    return inner, outer, span, float(module.values["arc_count"])


def _bond_torque(module: ResolvedModule, inputs: Inputs) -> float:
    inner, outer, span, count = _layer(module)
    strength = float({**module.values, **inputs}["pcl_bond_strength"])
    return strength * count * span / 4.0 * (outer**4 - inner**4) / outer


def _values(module: ResolvedModule, names: list[str], inputs: Inputs) -> dict[str, float]:
    values = module.table.evaluate({**module.values, **inputs}, names)
    return {name: float(values[name]) for name in names}


def _numbers(expression: Any) -> Array:
    return np.asarray(ca.DM(ca.evalf(ca.MX(expression)))).ravel()


TESTS: dict[str, tuple[Callable[[ResolvedModule, Inputs], Columns], Callable[[ResolvedModule], dict[str, str]]]] = {
    "weights": (weights, weights_settings), "pads": (pads, lambda _: {}), "log": (log, lambda _: {"study": DESIGN}),
    "frozen": (frozen, bond_settings), "ringing": (ringing, ringing_settings), "thawed": (thawed, bond_settings),
}  # fmt: skip
"""By name: the columns of a test, and the settings of its fit."""


def explained(name: str, module: ResolvedModule) -> tuple[str, ...]:
    """Return the inputs that a test measures."""
    return {
        "weights": ("spring_youngs_modulus", "pin_friction"),
        "pads": ("peltier_seebeck", "peltier_resistance", "peltier_conductance"),
        "log": heat_inputs(module), "frozen": ("pcl_bond_strength",),
        "ringing": ("peltier_shear_modulus", "clamped_loss_factor"), "thawed": ("pcl_bond_strength",),
    }[name]  # fmt: skip


def possible(name: str, module: ResolvedModule) -> bool:
    """Return whether a module can be put to a test: it has what is measured."""
    inputs = {row.name for row in module.table.inputs}
    if not all(each in inputs for each in explained(name, module)) or not explained(name, module):
        return False
    if name in {"frozen", "ringing", "thawed"}:
        return {"pcl_inner_radius", "pcl_outer_radius", "arc_span", "arc_count"} <= inputs and "cold" in module.points
    return name != "log" or bool(np.isfinite(module.values["response_time"]))
