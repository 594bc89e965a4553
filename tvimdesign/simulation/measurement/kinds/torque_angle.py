"""Torque against angle of a spring or a joint, loaded and unloaded: stiffness, friction and backlash.

theta = theta_0 + (T - s T_f)/K + b/2 sgn(T - s T_f): a linear spring behind Coulomb friction T_f, which always opposes
the motion (s = +1 while the torque rises, -1 while it falls), with a play b that is crossed where the load changes its
sign. The modulus of the wire follows from the rate of a spring, k = E d^4/(64 D n) (physics/spring.py).
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tvimdesign.physics import spring
from tvimdesign.simulation.measurement.fitting.fit import fitted
from tvimdesign.simulation.measurement.fitting.problem import Channel, Derived, Parameter, Problem, Values, from_zero
from tvimdesign.simulation.measurement.measurement import Measurement, Settings, required, rows_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.symbols import ca

GRAVITY = 9.80665  # m/s^2, standard
_SIZES = ("wire_diameter", "coil_diameter", "coil_count")


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
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
