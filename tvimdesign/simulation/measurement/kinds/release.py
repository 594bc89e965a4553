"""The angle of a joint that is let go: I theta'' + b theta' + T_f sgn(theta') + K (theta - theta_0) = 0.

A spring, a dashpot and a dry friction (physics/motions/motion.py, `kelvin_voigt_rates`); the friction's corner is
rounded at a hundredth of the highest speed. Integrated by Runge and Kutta's method of fourth order, so that every
sample's derivatives are those of the integration, exactly.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.motions import dynamics, motion
from tvimdesign.simulation.measurement.fitting.fit import fitted
from tvimdesign.simulation.measurement.fitting.problem import Channel, Derived, Parameter, Problem, Values
from tvimdesign.simulation.measurement.kinds.measurement import Measurement, Settings, rows_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.casadi_setup import ca

_MOST_SAMPLES = 300
_STEPS_A_PERIOD = 60
_LEAST_STEPS, _MOST_STEPS = 1, 50
_CORNER = 0.01
"""Speed, over the highest of the record, at which the friction has 0.76 of its size."""
_NAMES = ("inertia", "damping", "friction", "stiffness", "zero_angle", "first_angle", "first_speed")


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit one record of time and angle. Raises InputError for what lacks."""
    if len(blocks) != 1:
        raise InputError(f"release: {len(blocks)} tables have time and angle; give one record at a time")
    time, angle = thinned(*rows_of(blocks[0], ["time", "angle"]))
    if np.any(np.diff(time) <= 0.0):
        raise InputError(f"{blocks[0].file}: time does not rise from row to row")
    period, decay = _swing(time, angle)
    inertia = settings.get("inertia", 1e-3)
    stiffness = inertia * (2.0 * np.pi / period) ** 2
    size, rest = float(np.ptp(angle)), float(np.median(angle[-max(len(angle) // 10, 3) :]))
    speed = (angle[1] - angle[0]) / (time[1] - time[0])
    parameters = [
        Parameter("stiffness", "N*m/rad", "Stiffness", stiffness),
        Parameter(
            "damping",
            "N*m*s/rad",
            "Viscous damping",
            2.0 * inertia * decay,
            positive=False,
            scale=2.0 * inertia * decay,
            least=0.0,
        ),
        Parameter(
            "friction",
            "N*m",
            "Dry friction: the half-width of the loop at rest",
            3e-3 * stiffness * size,
            positive=False,
            scale=3e-3 * stiffness * size,
            least=0.0,
        ),
        Parameter("zero_angle", "deg", "Angle at rest", rest, positive=False, scale=size),
        Parameter("first_angle", "deg", "Angle at the first sample", float(angle[0]), positive=False, scale=size),
        Parameter("first_speed", "rad/s", "Speed at the first sample", speed, positive=False, scale=size / period),
    ]
    if "inertia" not in settings:
        parameters.insert(0, Parameter("inertia", "kg*m^2", "Inertia of all that turns", inertia))
    steps = int(np.clip(_STEPS_A_PERIOD * np.max(np.diff(time)) / period, _LEAST_STEPS, _MOST_STEPS))
    corner = _CORNER * size * np.pi / period
    predicted = _predicted(time, steps, corner, settings)
    channel = Channel(f"angle of {blocks[0].file}", "deg", angle, predicted, time, "time", "s")
    found = fitted(Problem(parameters, [channel], _derived(settings)), profiles=profiles)
    return Measurement(found, tuple(_notes(settings, len(time), blocks[0].complete(["time", "angle"]))))


def thinned(time: Array, angle: Array) -> tuple[Array, Array]:
    """At most `_MOST_SAMPLES` of the samples, evenly."""
    every = -(-len(time) // _MOST_SAMPLES)
    return time[::every], angle[::every]


def swing(time: Array, values: Values, steps: int, corner: float) -> Any:
    """Angle [rad] at each time [s], from the angle and speed at the first."""
    state = ca.SX.sym("state", 2)
    step, constants = ca.SX.sym("step"), ca.SX.sym("constants", 5)
    inertia, damping, friction, stiffness, zero = ca.vertsplit(constants)

    def rates(now: Any) -> Any:
        turned = now[0] - zero
        speed, acceleration = motion.kelvin_voigt_rates(turned, now[1], inertia, damping, stiffness)
        return ca.vertcat(speed, acceleration - friction * np.tanh(now[1] / corner) / inertia)

    after = state
    for _ in range(steps):
        h = step / steps
        k1 = rates(after)
        k2 = rates(after + 0.5 * h * k1)
        k3 = rates(after + 0.5 * h * k2)
        k4 = rates(after + h * k3)
        after = after + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    one = ca.Function("one", [state, step, constants], [after])
    given = ca.vertcat(*(values[name] for name in _NAMES[:5]))
    count = len(time) - 1
    first = ca.vertcat(values["first_angle"], values["first_speed"])
    course = one.mapaccum(count)(first, np.diff(time)[None, :], ca.repmat(given, 1, count))
    return ca.horzcat(first, course)[0, :].T


def _predicted(time: Array, steps: int, corner: float, settings: Settings) -> Callable[[Values], Any]:
    known = {"inertia": settings["inertia"]} if "inertia" in settings else {}
    return lambda values: swing(time, {**values, **known}, steps, corner)


def _swing(time: Array, angle: Array) -> tuple[float, float]:
    """Period [s] by the crossings of rest and decay [1/s] by the sizes of the halves; for a record that creeps, its
    length."""
    rest = float(np.median(angle[-max(len(angle) // 10, 3) :]))
    away = angle - rest
    noise = 0.05 * np.max(np.abs(away))
    changes = np.flatnonzero(np.diff(np.sign(away)) != 0)
    crossings = [i for i in changes if np.max(np.abs(away[i : i + max(len(away) // 50, 3)])) > noise]
    if len(crossings) < 2:
        gone = np.flatnonzero(np.abs(away) < 0.37 * np.max(np.abs(away)))
        time_gone = time[gone[0]] - time[0] if len(gone) else time[-1] - time[0]
        return 4.0 * max(float(time_gone), float(time[1] - time[0])), 1.0 / max(float(time_gone), 1e-9)
    period = 2.0 * float(np.median(np.diff(time[crossings])))
    tops = [float(np.max(np.abs(away[a:b]))) for a, b in pairwise(crossings) if b > a]
    decay = np.log(tops[0] / tops[-1]) / (0.5 * period * (len(tops) - 1)) if len(tops) > 1 else 0.1 / period
    return period, max(float(decay), 0.01 / period)


def _derived(settings: Settings) -> list[Derived]:
    known = {"inertia": settings["inertia"]} if "inertia" in settings else {}

    def of(formula: Callable[[Any, Any, Any], Any]) -> Callable[[Values], Any]:
        return lambda values: formula({**values, **known}["inertia"], values["damping"], values["stiffness"])

    return [
        Derived("natural_frequency", "Hz", "Undamped natural frequency",
                of(lambda inertia, _, stiffness: dynamics.natural_frequency(stiffness, inertia))),
        Derived("damping_ratio", "1", "Damping over the critical one",
                of(lambda inertia, damping, stiffness: dynamics.damping_ratio(damping, stiffness, inertia))),
    ]  # fmt: skip


def _notes(settings: Settings, used: int, there: int) -> list[str]:
    notes = [] if used == there else [f"Every {-(-there // _MOST_SAMPLES)}th sample is used, {used} of {there}."]
    if "inertia" not in settings:
        notes.append(
            "Without --set inertia=... a free swing gives ratios only: natural frequency and damping ratio are sure, "
            "stiffness, damping and friction are not."
        )
    return notes
