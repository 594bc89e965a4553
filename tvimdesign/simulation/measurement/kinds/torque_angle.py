"""Torque against angle of a spring or a joint, loaded and unloaded: stiffness, friction and backlash.

theta = theta_0 + (T - s T_f)/K + b/2 sgn(T - s T_f): a linear spring behind Coulomb friction T_f, which always opposes
the motion (s = +1 while the torque rises, -1 while it falls), with a play b that is crossed where the load changes its
sign. The modulus of the wire follows from the rate of a spring, k = E d^4/(64 D n) (physics/spring.py).

Torque of a frozen joint that is turned slowly until it gives: its stiffness, the torque it holds, and the bond.

T = K (theta - theta_0) up to the torque at which the layer gives, and that torque from there on, with a corner rounded
over a fiftieth of it; what comes after a break is left out. Joints that break without bending give their largest
torque each, three or more of them its middle. Joints that give at torques of their own, as after more and more cycles,
have one each, and the interval is that of the next such joint. The bond's strength is the traction at the layer's outer
rim, as the product has it (physics/layers/layer.py, `traction`).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from scipy.special import stdtrit

from tvimdesign.base.errors import InputError
from tvimdesign.physics import spring
from tvimdesign.physics.layers import layer
from tvimdesign.physics.polymers.polymer import ramp
from tvimdesign.simulation.measurement.fitting.fit import Fit, fitted, simplest_fit, with_intervals
from tvimdesign.simulation.measurement.fitting.problem import Channel, Derived, Parameter, Problem, Values, from_zero
from tvimdesign.simulation.measurement.measurement import Measurement, Settings, endings, required, rows_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.symbols import ca

GRAVITY = 9.80665  # m/s^2, standard
_SIZES = ("wire_diameter", "coil_diameter", "coil_count")


def torque_angle(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit blocks of torque, mass or force over angle. Raises InputError for what lacks."""
    series = [_series(block, settings) for block in blocks]
    torque = np.concatenate([values for values, _ in series])
    angle = np.concatenate([values for _, values in series])
    both_signs = bool(np.min(torque) < 0.0 < np.max(torque))
    two_ways = any(len(set(direction(values))) > 1 for values, _ in series)
    slope, zero = (float(number) for number in np.polyfit(torque, angle, 1))
    friction, turned = 0.05 * float(np.ptp(torque)), float(np.ptp(angle))
    parameters = [
        Parameter("stiffness", "N*m/rad", "Torque for each angle", max(1.0 / slope if slope else 1.0, 1e-9)),
        Parameter("zero_angle", "deg", "Angle without a load", zero, positive=False, scale=float(np.ptp(angle)) or 1.0),
    ]
    if two_ways:
        parameters.append(from_zero("friction", "N*m", "Friction torque, which opposes the motion", friction))
    if both_signs:
        parameters.append(from_zero("backlash", "deg", "Play between the two directions", 0.01 * turned))
    channels = [
        Channel(f"angle of {block.file}", "deg", angles, angle_of(torques), torques, "torque", "N*m",
                step=block.step("angle"))
        for block, (torques, angles) in zip(blocks, series, strict=True)
    ]  # fmt: skip
    derived = [_modulus(settings)] if any(name in settings for name in _SIZES) else []
    fit = fitted(Problem(parameters, channels, derived), profiles=profiles)
    record = {"youngs_modulus": fit["youngs_modulus"]} if derived else {}
    return Measurement(fit, tuple(_notes(two_ways, both_signs, bool(derived))), record)


def direction(torque: Array) -> Array:
    """Return +1 where the torque has risen to its value, -1 where it has fallen; the first goes as the second does."""
    change = np.sign(np.diff(torque))
    steps = np.concatenate([[0.0], change])
    for i in range(1, len(steps)):
        steps[i] = steps[i] or steps[i - 1]
    first = next((step for step in steps if step), 1.0)
    return np.asarray(np.where(steps == 0.0, first, steps))


def angle_of(torque: Array) -> Callable[[Values], Any]:
    """Return the function of the parameters that gives the angle [rad] at each torque [N*m] of a series, in its order.

    The motion's way and the touched side are those of the load, but for the friction.
    """
    load, way, side = (ca.DM(column) for column in (torque, direction(torque), np.sign(torque)))

    def angle(values: Values) -> Any:
        turned = (load - way * values.get("friction", 0.0)) / values["stiffness"]
        return values["zero_angle"] + turned + side * (0.5 * values.get("backlash", 0.0))

    return angle


def _series(block: Block, settings: Settings) -> tuple[Array, Array]:
    """Return torque [N*m] and angle [rad] in the order of the file."""
    load = next(name for name in ("torque", "force", "mass") if name in block.columns)
    given, angle = rows_of(block, [load, "angle"])
    if load == "torque":
        return given, angle
    arm = required(settings, "arm", f"as {block.file} has a {load} and no torque")
    return given * arm * (GRAVITY if load == "mass" else 1.0), angle


def _modulus(settings: Settings) -> Derived:
    """Return E of the wire, for which the springs together have the stiffness that was measured: N k w'^2 = K."""
    d, D, n = (required(settings, name, "for the modulus of the wire") for name in _SIZES)
    of_one = settings["spring_count"] * settings["transmission"] ** 2 * spring.rate(1.0, d, D, n)
    return Derived("youngs_modulus", "GPa", "Modulus of the wire", lambda values: values["stiffness"] / of_one)


def _notes(two_ways: bool, both_signs: bool, with_modulus: bool) -> list[str]:
    notes = []
    if not two_ways:
        notes.append("The load only rises, or only falls: friction is not fitted, and shifts the zero by friction/K.")
    if not both_signs:
        notes.append("The load has one sign: a backlash would not be seen, and is not fitted.")
    if with_modulus:
        notes.append(
            "The modulus is the one for which E d^4/(64 D n) is the stiffness that was measured: what legs, pins and "
            "coils that touch give is in it."
        )
    else:
        notes.append(
            "Without --set wire_diameter, coil_diameter and coil_count the modulus of the wire does not follow, and "
            "no record is written."
        )
    return notes


_LAYER = ("layer_inner_radius", "layer_outer_radius", "layer_span")
_TORQUE = "holding_torque"
_CORNER = 0.02
_BROKEN = 0.7  # Share of the largest torque below which, after it, the joint is broken
_BENDS = 0.9  # Share of the first stiffness below which, near the largest torque, the joint gives
_LEAST_BREAKS = 3
"""Joints that must break without bending, or give at torques of their own, for these to have an interval."""


class Turned(NamedTuple):
    """One joint that was turned: angle and torque up to the break, and how it ended."""

    file: str
    angle: Array
    torque: Array
    broke: bool  # True if the torque fell after its largest value
    end: str
    step: float

    @property
    def line(self) -> tuple[float, float]:
        """Stiffness and zero of the lower half."""
        low = self.torque <= 0.5 * np.max(self.torque)
        low = low if np.sum(low) > 2 else np.ones(len(self.torque), bool)
        slope, offset = np.polyfit(self.angle[low], self.torque[low], 1)
        slope = abs(float(slope)) or 1.0
        return slope, -float(offset) / slope

    @property
    def bends(self) -> bool:
        """True where the torque falls behind the line of its lower half."""
        stiffness, zero = self.line
        return bool(np.max(self.torque) < _BENDS * stiffness * (np.max(self.angle) - zero))

    @property
    def most(self) -> float:
        """Largest torque [N*m]."""
        return float(np.max(self.torque))

    def channel(self) -> Channel:
        """Return the channel of its torque, by a holding torque of its own where there is one."""
        angle = ca.DM(self.angle)

        def predicted(values: Values) -> Any:
            own = {"holding_torque": values[f"{_TORQUE}{self.end}"]} if f"{_TORQUE}{self.end}" in values else {}
            return torque_of(angle, {**values, **own}, f"zero_angle{self.end}", bends=self.bends)

        return Channel(f"torque of {self.file}", "N*m", self.torque, predicted, self.angle, "angle", "deg",
                       step=self.step, noise_of="torque")  # fmt: skip


def frozen_torque(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit joints that were turned until they gave, together: one stiffness, and one torque if they share it.

    Raises InputError for what lacks.
    """
    joints = [_turned(block, end) for block, end in zip(blocks, endings(blocks), strict=True)]
    gave = [joint for joint in joints if joint.bends]
    broke = [joint for joint in joints if joint.broke and not joint.bends]
    broke = broke if len(broke) >= _LEAST_BREAKS else []
    ended = [*gave, *broke]
    bond = settings if ended and any(name in settings for name in _LAYER) else None
    notes = _frozen_notes(joints, bool(ended), bond is not None)
    problems = [_frozen_problem(joints, {"": ended} if ended else {}, broke, bond)]
    if len(gave) > 1 and not broke:
        problems.append(_frozen_problem(joints, {joint.end: [joint] for joint in gave}, [], bond))
    own, best = simplest_fit(problems)
    fit = with_intervals(best, profiles=profiles)
    if own:
        fit, note = _of_next_joint(fit, gave)
        notes.append(note)
    return Measurement(fit, tuple(notes), {each.name: each for each in fit.derived if each.low is not None})


def _frozen_problem(
    joints: Sequence[Turned], torques: Mapping[str, Sequence[Turned]], broke: Sequence[Turned], bond: Settings | None
) -> Problem:
    """Return the problem of joints; `torques` are those that share one, by the end of its name."""
    parameters = [Parameter("stiffness", "N*m/rad", "Stiffness of the frozen joint", joints[0].line[0])]
    parameters += [
        Parameter(_TORQUE + end, "N*m", "Torque at which it gives", float(np.median([joint.most for joint in alike])))
        for end, alike in torques.items()
    ]
    parameters += [
        Parameter(f"zero_angle{joint.end}", "deg", "Angle without torque", joint.line[1], positive=False,
                  scale=float(np.ptp(joint.angle)))
        for joint in joints
    ]  # fmt: skip
    channels = [joint.channel() for joint in joints]
    if broke:
        most, count = np.array([joint.most for joint in broke]), len(broke)
        channels.append(
            Channel("torque at the break", "N*m", most, lambda values: values[_TORQUE] * ca.DM.ones(count),
                    np.arange(1.0, count + 1.0), "joint", "1", relative=True)
        )  # fmt: skip

    def middle(values: Values) -> Any:
        return np.exp(sum(np.log(values[_TORQUE + end]) for end in torques) / len(torques))

    return Problem(parameters, channels, [_bond(bond, middle)] if bond is not None else [])


def _of_next_joint(fit: Fit, gave: Sequence[Turned]) -> tuple[Fit, str]:
    """Return the fit in which the bond's interval is that of the next joint, by the scatter of these, and a note."""
    torques = [fit.value(_TORQUE + joint.end) for joint in gave]
    listed = ", ".join(f"{torque:.3g}" for torque in torques)
    note = f"The joints give at torques of their own, {listed} N.m in the order of the tables. "
    if len(gave) < _LEAST_BREAKS:
        left_open = tuple(replace(each, low=None, high=None) for each in fit.derived)
        note += f"{_LEAST_BREAKS} joints or more give the bond's strength an interval and a record."
        return replace(fit, derived=left_open), note
    half = float(stdtrit(len(gave) - 1, 0.975) * np.std(np.log(torques), ddof=1) * np.sqrt(1.0 + 1.0 / len(gave)))
    derived = [replace(each, low=each.value * np.exp(-half), high=each.value * np.exp(half)) for each in fit.derived]
    return replace(fit, derived=tuple(derived)), f"{note}The bond's interval is that of the next such joint."


def torque_of(angle: Any, values: Values, zero: str = "zero_angle", *, bends: bool = True) -> Any:
    """Return torque [N*m] at each angle [rad]; of a joint that does not bend before it breaks, a straight line."""
    straight = values["stiffness"] * (angle - values[zero])
    if not bends:
        return straight
    most = values["holding_torque"]
    return straight - ramp(straight - most, _CORNER * most)


def _turned(block: Block, end: str) -> Turned:
    """Return angle and torque, above zero where the torque is largest, up to the break. Raises InputError."""
    angle, torque = rows_of(block, ["angle", "torque"])
    sign = np.sign(torque[np.argmax(np.abs(torque))])
    angle, torque = sign * angle, sign * torque
    top = int(np.argmax(torque))
    after = np.flatnonzero(torque[top:] < _BROKEN * torque[top])
    last = top + int(after[0]) if len(after) else len(torque)
    if not np.ptp(angle[:last]) > 0.0:
        raise InputError(
            f"{block.file}: up to its largest torque, {torque[top]:.3g} N.m, the joint has one angle, {angle[0]:.3g} "
            "rad: no stiffness follows; check that row, or leave out what comes before the joint is turned"
        )
    return Turned(block.file, angle[:last], torque[:last], bool(len(after)), end, block.step("torque"))


def _bond(settings: Settings, torque: Callable[[Values], Any]) -> Derived:
    inner, outer, span = (required(settings, name, "for the strength of the bond") for name in _LAYER)
    moment = settings["layer_count"] * span / 4.0 * (outer**4 - inner**4)
    return Derived("bond_strength", "MPa", "Traction at the layer's outer rim where it gives",
                   lambda values: layer.traction(torque(values), moment, outer))  # fmt: skip


def _frozen_notes(joints: Sequence[Turned], seen: bool, with_bond: bool) -> list[str]:
    notes = ["The stiffness is that of all between the two places the angle is measured at: fixture and link too."]
    if not seen:
        most = max(joint.most for joint in joints)
        notes.append(
            f"The torque rises straight up to its largest value: the joint holds {most:.3g} N.m at least. Where it "
            f"gives is not fitted; {_LEAST_BREAKS} joints that break give a torque with an interval."
        )
    elif with_bond:
        notes.append(
            "The bond is taken as what gives, and its traction as rising with the radius: a link that slips, or an "
            "edge that bears more than its share, makes the bond look weaker than it is."
        )
    else:
        notes.append(
            "Without --set layer_inner_radius, layer_outer_radius and layer_span the bond's strength does not follow, "
            "and no record is written."
        )
    return notes
