"""The angle of a joint that is let go, in one record or several: stiffness, damping and friction.

I theta'' + b theta' + T_f sgn(theta') + K (theta - theta_0) = 0: a spring, a dashpot and a dry friction
(physics/motions/motion.py, `kelvin_voigt_rates`); the friction's corner is rounded at a hundredth of the highest speed.
Integrated by Runge and Kutta's method of fourth order, so that every sample's derivatives are those of the integration.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.motions import motion
from tvimdesign.simulation.measurement.fitting.fit import fitted
from tvimdesign.simulation.measurement.fitting.problem import Channel, Derived, Parameter, Problem, Values, from_zero
from tvimdesign.simulation.measurement.kinds.joint_of_module import joint_of_module, with_records
from tvimdesign.simulation.measurement.measurement import Measurement, Settings, endings, series_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.symbols import ca

_MOST_SAMPLES = 300
_STEPS_A_PERIOD = 60
_LEAST_STEPS, _MOST_STEPS = 1, 50
CORNER = 0.01  # Speed, over the highest of the record, at which the friction has 0.76 of its size
_CONSTANTS = ("inertia", "damping", "friction", "stiffness", "zero_angle")
_OWN = ("zero_angle", "first_angle", "first_speed")  # Parameters that each record has for itself


class Record(NamedTuple):
    """One record: samples, how often the period is gone through, and the end of the names of what is its own."""

    file: str
    time: Array
    angle: Array
    period: float
    decay: float
    end: str
    step: float

    @property
    def size(self) -> float:
        """Range of the angle [rad]."""
        return float(np.ptp(self.angle))

    @property
    def corner(self) -> float:
        """Speed at which the friction's corner is [rad/s]."""
        return CORNER * self.size * np.pi / self.period

    def own(self) -> list[Parameter]:
        """Return its own parameters."""
        rest_angle = float(np.median(self.angle[-max(len(self.angle) // 10, 3) :]))
        speed = (self.angle[1] - self.angle[0]) / (self.time[1] - self.time[0])
        sizes = (self.size, self.size, self.size / self.period)
        starts = (rest_angle, float(self.angle[0]), float(speed))
        units = ("deg", "deg", "rad/s")
        meanings = ("Angle at rest", "Angle at the first sample", "Speed at the first sample")
        return [
            Parameter(name + self.end, unit, meaning, start, positive=False, scale=size)
            for name, unit, meaning, start, size in zip(_OWN, units, meanings, starts, sizes, strict=True)
        ]

    def channel(self, known: Values) -> Channel:
        """Return the channel of its angle."""
        steps = int(np.clip(_STEPS_A_PERIOD * np.max(np.diff(self.time)) / self.period, _LEAST_STEPS, _MOST_STEPS))

        def predicted(values: Values) -> Any:
            own = {name: values[name + self.end] for name in _OWN}
            return swing(self.time, {**values, **known, **own}, steps, self.corner)

        return Channel(f"angle of {self.file}", "deg", self.angle, predicted, self.time, "time", "s", step=self.step)


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit records of time and angle, together. Raises InputError for what lacks."""
    records = [_record(block, end) for block, end in zip(blocks, endings(blocks), strict=True)]
    known = {"inertia": settings["inertia"]} if "inertia" in settings else {}
    inertia = settings.get("inertia", 1e-3)
    first = records[0]
    stiffness = inertia * (2.0 * np.pi / first.period) ** 2
    parameters = [
        Parameter("stiffness", "N*m/rad", "Stiffness", stiffness),
        from_zero("damping", "N*m*s/rad", "Viscous damping", 2.0 * inertia * first.decay),
        from_zero("friction", "N*m", "Dry friction: the half-width of the loop at rest", 3e-3 * stiffness * first.size),
    ]
    if not known:
        parameters.insert(0, Parameter("inertia", "kg*m^2", "Inertia of all that turns", inertia))
    parameters += [entry for record in records for entry in record.own()]
    module = joint_of_module(settings, 2.0 * np.pi / first.period, first.size)
    following = [*_derived(known), *(module.derived() if module and known else [])]
    fit = fitted(Problem(parameters, [entry.channel(known) for entry in records], following), profiles=profiles)
    notes = []
    for used, block in ((len(record.time), block) for record, block in zip(records, blocks, strict=True)):
        there = block.complete(["time", "angle"])
        if used < there:
            notes.append(f"{block.file}: every {-(-there // _MOST_SAMPLES)}th sample is used, {used}.")
    if not known:
        notes.append(
            "Without --set inertia=... a free swing gives ratios only: natural frequency and damping ratio are sure, "
            "stiffness, damping and friction are not: no record follows."
        )
        return Measurement(fit, tuple(notes))
    return with_records(fit, notes, module, inertia=False)


def _record(block: Block, end: str) -> Record:
    time, angle = series_of(block, ["time", "angle"], _MOST_SAMPLES)
    return Record(block.file, time, angle, *period_and_decay(time, angle), end, block.step("angle"))


def _derived(known: Values) -> list[Derived]:
    def of(formula: Callable[[Any, Any, Any], Any]) -> Callable[[Values], Any]:
        return lambda values: formula({**values, **known}["inertia"], values["damping"], values["stiffness"])

    return [
        Derived("natural_frequency", "Hz", "Undamped natural frequency",
                of(lambda inertia, _, stiffness: motion.natural_frequency(stiffness, inertia))),
        Derived("damping_ratio", "1", "Damping over the critical one",
                of(lambda inertia, damping, stiffness: motion.damping_ratio(damping, stiffness, inertia))),
    ]  # fmt: skip


def swing(time: Array, values: Values, steps: int, corner: float) -> Any:
    """Return angle [rad] at each time [s], from the angle and speed at the first."""
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
    one_step = ca.Function("one", [state, step, constants], [after])
    given = ca.vertcat(*(values[name] for name in _CONSTANTS))
    count = len(time) - 1
    first = ca.vertcat(values["first_angle"], values["first_speed"])
    course = one_step.mapaccum(count)(first, np.diff(time)[None, :], ca.repmat(given, 1, count))
    return ca.horzcat(first, course)[0, :].T


def period_and_decay(time: Array, angle: Array) -> tuple[float, float]:
    """Return period [s] by the crossings of rest and decay [1/s] by the sizes of halves; its length if it creeps."""
    rest_angle = float(np.median(angle[-max(len(angle) // 10, 3) :]))
    away = angle - rest_angle
    noise = 0.05 * np.max(np.abs(away))
    changes = np.flatnonzero(np.diff(np.sign(away)) != 0)
    crossings = [i for i in changes if np.max(np.abs(away[i : i + max(len(away) // 50, 3)])) > noise]
    if len(crossings) < 2:
        gone = np.flatnonzero(np.abs(away) < 0.37 * np.max(np.abs(away)))
        time_gone = time[gone[0]] - time[0] if len(gone) else time[-1] - time[0]
        return 4.0 * max(float(time_gone), float(time[1] - time[0])), 1.0 / max(float(time_gone), 1e-9)
    at = np.array(crossings)
    moments = time[at] - away[at] * (time[at + 1] - time[at]) / (away[at + 1] - away[at])
    whole = moments[2:] - moments[:-2] if len(at) > 2 else 2.0 * np.diff(moments)
    period = max(float(np.median(whole)), float(time[1] - time[0]))
    sizes = [float(np.max(np.abs(away[a:b]))) for a, b in pairwise(crossings) if b > a]
    tops = [size for size in sizes if size > 0.0]  # a half that no sample lies in has no size
    decay = np.log(tops[0] / tops[-1]) / (0.5 * period * (len(tops) - 1)) if len(tops) > 1 else 0.1 / period
    return period, max(float(decay), 0.01 / period)
