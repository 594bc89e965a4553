"""Record values that follow from a joint's stiffness, damping and friction, by the module's equations.

A molten joint is turned over its stroke: K = K_s(E) + Re k(eta, omega, theta), b = Im k/omega, where k is the melt's
branch over the measured amplitude (device/core/impedance/large_motion.py); the springs' modulus E and the melt's
viscosity eta are those for which both hold. In a frozen one the pads' shear modulus and the loss of faces that are
fastened are those for which `joint_stiffness@cold` and `joint_damping@cold` hold. Friction that no speed changes is
that of the springs' pins. What sizes and other materials are off by counts as these.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record
from tvimdesign.device import Input
from tvimdesign.simulation.measurement.fitting.fit import Estimate, Fit
from tvimdesign.simulation.measurement.fitting.problem import Derived
from tvimdesign.simulation.measurement.measurement import Measurement, OtherRecord, Settings, resolve_measured
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.simulation.working_cycle.symbols import ca

MOLTEN, FROZEN = "molten", "frozen"
_POINTS = {MOLTEN: "hot", FROZEN: "cold"}
_EXPLAINS = {
    MOLTEN: ("spring_youngs_modulus", "pcl_zero_shear_viscosity"),
    FROZEN: ("heater_shear_modulus", "clamped_loss_factor"),
}
"""The inputs that stiffness and damping determine, in this order: those whose ranges move them most."""
_JOINT = "joint"  # The choice of the records that this kind itself writes
_FRICTION, _INERTIA = "pin_friction", "moving_inertia"
_OF_STEEL = "leg_pin_friction"  # That of a module with dowel pins, from the same field of the record
_HELD = 0.01  # Share of stiffness and of damping to which the values found must give them again
_NEWTON: dict[str, Any] = {"abstol": 1e-10, "max_iter": 60, "error_on_fail": False}


_FARTHEST = 8.0  # Logarithm of the factor beyond which no value is looked for: three thousand times the study's


def _factor(share: Any) -> Any:
    """Return the factor of a value for the solver's number: its logarithm near one."""
    return np.exp(_FARTHEST * np.tanh(share / _FARTHEST))


@dataclass(frozen=True)
class JointOfModule:
    """A module whose joint was turned, in one state, at a frequency and an amplitude."""

    resolved: ResolvedModule
    source: Path
    state: str
    omega: float  # [rad/s]
    amplitude: float  # [rad]

    @property
    def _explained(self) -> tuple[Input, Input]:
        rows = {row.name: row for row in self.resolved.table.inputs}
        first, second = _EXPLAINS[self.state]
        return rows[first], rows[second]

    def impedance(self, given: Mapping[str, Any]) -> tuple[Any, Any]:
        """Return stiffness [N*m/rad] and damping [N*m*s/rad] of the module with some inputs replaced."""
        point, table = _POINTS[self.state], self.resolved.table
        as_built = {**self.resolved.values, **given, f"frequency@{point}": self.omega / (2.0 * np.pi)}
        if self.state == FROZEN:
            names = [f"joint_stiffness@{point}", f"joint_damping@{point}"]
            values_by_name = table.evaluate(as_built, names)
            return values_by_name[names[0]], values_by_name[names[1]]
        springs = table.evaluate(as_built, ["spring_stiffness"])["spring_stiffness"]
        branch = table.evaluate({**as_built, "stroke": self.amplitude}, ["stroke_branch"])["stroke_branch"]
        return springs + branch[0], branch[1] / self.omega

    def derived(self) -> list[Derived]:
        """Return the two inputs that follow from `stiffness` and `damping`, by the implicit function."""
        rows = self._explained
        starts = [float(self.resolved.values[row.name]) for row in rows]
        share, seen = ca.SX.sym("share", 2), ca.SX.sym("seen", 2)
        inputs = {row.name: start * _factor(share[i]) for i, (row, start) in enumerate(zip(rows, starts, strict=True))}
        stiffness, damping = self.impedance(inputs)
        usual = [float(entry) for entry in self.impedance({})]
        left = ca.vertcat((stiffness - seen[0]) / usual[0], (damping - seen[1]) / usual[1])
        solve = ca.rootfinder("solve", "newton", ca.Function("left", [share, seen], [left]), _NEWTON)

        def value(i: int) -> Any:
            return lambda values: starts[i] * _factor(solve(0.0, ca.vertcat(values["stiffness"], values["damping"]))[i])

        return [
            Derived(row.name, row.unit, f"{row.description}, for which the module has this stiffness and damping",
                    value(i))
            for i, row in enumerate(rows)
        ]  # fmt: skip

    def drop_impossible(self, fit: Fit) -> tuple[Fit, list[str]]:
        """Drop values that the module cannot have from a fit; return notes on them too."""
        names = [row.name for row in self._explained]
        if not {*names} <= {quantity.name for quantity in fit.derived}:
            return fit, []
        values = {name: fit.value(name) for name in names}
        if all(np.isfinite(values[row.name]) and row.lower <= values[row.name] <= row.upper for row in self._explained):
            there = np.array(self.impedance(values), dtype=float)
            misses = np.abs(there / np.array([fit.value("stiffness"), fit.value("damping")]) - 1.0)
            if np.max(misses) < _HELD:
                return fit, []
        left = tuple(quantity for quantity in fit.derived if quantity.name not in names)
        return replace(fit, derived=left), [
            f"No {names[0]} and {names[1]} give {self.source.name} this stiffness and damping when {self.state}: "
            "neither is written to a record. Another value of the module is not as the study has it."
        ]

    def records(self, fit: Fit, *, inertia: bool) -> tuple[dict[str, Estimate], list[OtherRecord], list[str]]:
        """Return values of the joint's own record, records of other categories, and notes on them."""
        own, others, notes = {}, [], []
        if inertia:
            own[_INERTIA] = fit["inertia"]
        if self.state == MOLTEN:
            friction, note = self._pin_friction(fit["friction"])
            own |= {_FRICTION: friction} if friction else {}
            notes += note
        names = {quantity.name for quantity in fit.derived}
        for row in (row for row in self._explained if row.name in names):
            if row.record is None:
                continue
            choice, value = row.record
            record = self.resolved.values[choice]
            if choice == _JOINT:
                own[value] = fit[row.name]
            elif isinstance(record, Record):
                others.append(OtherRecord(record.category, record.name, choice, {value: fit[row.name]}))
        return own, others, notes

    def _pin_friction(self, torque: Estimate) -> tuple[Estimate | None, list[str]]:
        """Return the coefficient at the pins: what the axial preload's wave spring rubs is taken off."""
        table, values = self.resolved.table, self.resolved.values
        names = ["pin_friction_torque", "preload_friction_torque"]
        of_one = table.evaluate({**values, _FRICTION: 1.0, _OF_STEEL: 1.0}, names)
        unit, intercept = float(of_one[names[0]]), float(of_one[names[1]])
        if unit <= 0.0 or torque.value <= intercept:
            return None, [
                f"The friction is no more than the wave spring's {intercept:.3g} N.m: none is left for the pins."
            ]
        low, high = (None if end is None else max(end - intercept, 0.0) / unit for end in (torque.low, torque.high))
        return Estimate(_FRICTION, "1", "Friction of legs on pins", (torque.value - intercept) / unit, low, high), []

    def notes(self) -> list[str]:
        """Return notes on the assumptions."""
        sentences = [
            f"The module is that of {self.source.name}, {self.state}, at {self.omega / (2.0 * np.pi):.3g} Hz: what its "
            "sizes and other materials are off by counts as the values found."
        ]
        if self.state == MOLTEN:
            turned = float(np.degrees(self.amplitude))
            sentences.append(
                f"The melt's stiffness and damping are those of a motion of {turned:.3g} degrees to each side."
            )
        return sentences


def joint_of_module(settings: Settings, omega: float, amplitude: float) -> JointOfModule | None:
    """Return the module that was measured, where the settings name one. Raises InputError for what lacks."""
    if "study" not in settings:
        return None
    state = settings.get("state", "")
    if state not in _POINTS:
        raise InputError(f"--set state=...: needed with a study, {MOLTEN} or {FROZEN}")
    source = Path(settings["study"])
    resolved = resolve_measured(source)
    point = _POINTS[state]
    if point not in resolved.points:
        raise InputError(f"{source}: has no operating point {point}, which says how warm a {state} joint is")
    if "temperature" in settings:
        values = {**resolved.values, f"temperature@{point}": settings["temperature"]}
        resolved = ResolvedModule(resolved.study, values, resolved.current_profiles)
    return JointOfModule(resolved, source, state, omega, amplitude)


def with_records(fit: Fit, notes: Sequence[str], module: JointOfModule | None, *, inertia: bool) -> Measurement:
    """Return a measurement of a joint with what follows for records; `inertia` says whether it was fitted."""
    if module is None:
        note = "Without --set study=... and --set state=... nothing but the inertia goes to a record."
        own = {_INERTIA: fit["inertia"]} if inertia else {}
        return Measurement(fit, (*notes, note), own)
    possible_fit, missed = module.drop_impossible(fit)
    own, others, left = module.records(possible_fit, inertia=inertia)
    return Measurement(possible_fit, (*notes, *module.notes(), *missed, *left), own, more_records=others)
