"""A joint turned to and fro: inertia, stiffness, damping and hysteresis from angle and torque over time.

T = I theta'' + b theta' + K (theta - theta_0) + T_f sgn(theta') (physics/motions/motion.py, `kelvin_voigt_torque`), the
friction's corner rounded as in `release`. The true angle of each record is a sum of harmonics whose sizes are unknowns,
as the encoder errs as well as the torque's cell; so its derivatives are exact.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.motions import motion
from tvimdesign.simulation.measurement.fitting.fit import fitted
from tvimdesign.simulation.measurement.fitting.problem import Channel, Derived, Parameter, Problem, Values, from_zero
from tvimdesign.simulation.measurement.kinds.joint_of_module import joint_of_module, with_records
from tvimdesign.simulation.measurement.kinds.release import CORNER
from tvimdesign.simulation.measurement.measurement import Measurement, Settings, series_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.symbols import ca

HARMONICS = 3
_MOST_SAMPLES = 400
_ALIKE = 1.05  # Ratio of frequencies below which two records say the same of inertia and stiffness
_TRIED = 200


class Sine(NamedTuple):
    """One record: samples, the frequency found to begin with, and the harmonics' start."""

    file: str
    time: Array
    angle: Array
    torque: Array
    omega: float
    start: Array  # Mean, then cosine and sine of each harmonic [rad]
    end: str
    steps: tuple[float, float]  # Of the last digits of angle and torque [SI]

    @property
    def size(self) -> float:
        """Amplitude [rad]."""
        return float(np.hypot(*self.start[1:3]))

    def parameters(self) -> list[Parameter]:
        """Return the frequency and the harmonics of the true angle: of this measurement alone."""
        shape = [
            Parameter(f"shape{self.end}_{i}", "deg", "Part of the angle", float(value), positive=False, scale=self.size,
                      nuisance=True)
            for i, value in enumerate(self.start)
        ]  # fmt: skip
        omega = Parameter(f"omega{self.end}", "rad/s", "Angular frequency", self.omega, nuisance=True)
        return [omega, *shape]

    def course(self, values: Values) -> tuple[Any, Any, Any]:
        """Return angle [rad], speed and acceleration at every sample."""
        omega, time = values[f"omega{self.end}"], ca.DM(self.time - self.time[0])
        shape = [values[f"shape{self.end}_{i}"] for i in range(len(self.start))]
        angle, speed, acceleration = shape[0], 0.0, 0.0
        for k in range(1, HARMONICS + 1):
            turned, rate = k * omega * time, k * omega
            cosine, sine = shape[2 * k - 1] * np.cos(turned), shape[2 * k] * np.sin(turned)
            slope = shape[2 * k] * np.cos(turned) - shape[2 * k - 1] * np.sin(turned)
            angle, speed = angle + cosine + sine, speed + rate * slope
            acceleration = acceleration - rate**2 * (cosine + sine)
        return angle, speed, acceleration

    def channels(self, known: Values) -> list[Channel]:
        """Return the channels of angle and torque."""

        def torque(values: Values) -> Any:
            joint = {**values, **known}
            angle, speed, acceleration = self.course(joint)
            stiffness = joint.get("stiffness", joint.get("dynamic_stiffness"))
            spring = motion.kelvin_voigt_torque(angle - joint["zero_angle"], speed, joint["damping"], stiffness)
            corner = CORNER * self.size * self.omega
            return joint["inertia"] * acceleration - spring + joint["friction"] * np.tanh(speed / corner)

        return [
            Channel(f"angle of {self.file}", "deg", self.angle, lambda values: self.course(values)[0], self.time,
                    "time", "s", step=self.steps[0], noise_of="angle"),
            Channel(f"torque of {self.file}", "N*m", self.torque, torque, self.time, "time", "s",
                    step=self.steps[1], noise_of="torque"),
        ]  # fmt: skip


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit records of time, angle and torque, together. Raises InputError for what lacks."""
    records = [_record(block, f"_{i}") for i, block in enumerate(blocks, start=1)]
    known = {"inertia": settings["inertia"]} if "inertia" in settings else {}
    omegas = [record.omega for record in records]
    together = not known and max(omegas) < _ALIKE * min(omegas)
    with_inertia = not known and not together
    known = {"inertia": 0.0} if together else known
    first = records[0]
    module = joint_of_module(settings, first.omega, first.size)
    problem = Problem(
        [*_joint(records, known, together=together), *(value for record in records for value in record.parameters())],
        [channel for record in records for channel in record.channels(known)],
        [
            # b omega, and 4 T_f/(pi A) of the friction's loop (Den Hartog)
            Derived("loss", "N*m/rad", "Part of the stiffness in quadrature at the first record's frequency",
                    lambda values: values["damping"] * first.omega + 4.0 * values["friction"] / (np.pi * first.size)),
            *(module.derived() if module and not together else []),
        ],
    )  # fmt: skip
    return with_records(
        fitted(problem, profiles=profiles), _notes(records, together=together), module, inertia=with_inertia
    )


def _joint(records: Sequence[Sine], known: Values, *, together: bool) -> list[Parameter]:
    """Return the shared parameters, started by least squares of the torque. `together`: K and I are one."""
    table, torque = [], []
    for record in records:
        values = {f"omega{record.end}": record.omega}
        values |= {f"shape{record.end}_{i}": float(value) for i, value in enumerate(record.start)}
        angle, speed, acceleration = (np.asarray(ca.DM(value)).ravel() for value in record.course(values))
        table.append(np.column_stack([angle, speed, np.sign(speed), np.ones(len(angle)), acceleration]))
        torque.append(record.torque - known.get("inertia", 0.0) * acceleration)
    whole = np.concatenate(table)[:, : 4 if known else 5]
    terms = np.linalg.lstsq(whole, np.concatenate(torque), rcond=None)[0]
    size = float(np.ptp(torque[0])) / records[0].size
    stiffness = max(abs(float(terms[0])), 1e-3 * size)
    name, meaning = "stiffness", "Stiffness"
    if together:
        name, meaning = "dynamic_stiffness", "Stiffness less inertia times omega^2, at the frequency of the records"
    parameters = [
        Parameter(name, "N*m/rad", meaning, stiffness),
        from_zero("damping", "N*m*s/rad", "Viscous damping", max(float(terms[1]), 1e-3 * stiffness / records[0].omega)),
        from_zero("friction", "N*m", "Dry friction: the loop's half-width that no speed changes",
                  max(float(terms[2]), 1e-3 * stiffness * records[0].size)),
        Parameter("zero_angle", "deg", "Angle without torque", -float(terms[3]) / stiffness, positive=False,
                  scale=records[0].size, nuisance=together),
    ]  # fmt: skip
    if not known:
        inertia = max(float(terms[4]), 1e-3 * stiffness / records[0].omega ** 2)
        parameters.insert(0, Parameter("inertia", "kg*m^2", "Inertia of what the torque's cell moves", inertia))
    return parameters


def _record(block: Block, end: str) -> Sine:
    time, angle, torque = series_of(block, ["time", "angle", "torque"], _MOST_SAMPLES)
    omega = _frequency(time, angle)
    if not omega**2 > 0.0:
        raise InputError(f"{block.file}: {time[-1] - time[0]:.3g} s is no time of a motion; look at the unit of time")
    if omega * (time[-1] - time[0]) < 2.0 * np.pi:
        raise InputError(f"{block.file}: the record holds less than one period")
    start: Array = np.linalg.lstsq(_harmonics(time - time[0], omega), angle, rcond=None)[0].astype(np.float64)
    return Sine(block.file, time, angle, torque, omega, start, end, (block.step("angle"), block.step("torque")))


def _harmonics(time: Array, omega: float) -> Array:
    parts = [np.ones(len(time))]
    for k in range(1, HARMONICS + 1):
        parts += [np.cos(k * omega * time), np.sin(k * omega * time)]
    return np.column_stack(parts)


def _frequency(time: Array, angle: Array) -> float:
    """Return the frequency of the sine that fits best: by crossings of the mean, then near it by least squares."""
    away = angle - np.mean(angle)
    crossings = np.flatnonzero((away[1:] > 0.0) != (away[:-1] > 0.0))
    rough = np.pi * max(len(crossings), 1) / (time[-1] - time[0])
    tried = rough * np.linspace(0.7, 1.3, _TRIED)
    for _ in range(2):
        left = [_left(time - time[0], angle, frequency) for frequency in tried]
        best, step = tried[int(np.argmin(left))], tried[1] - tried[0]
        tried = best + step * np.linspace(-1.0, 1.0, _TRIED)
    return float(best)


def _left(time: Array, angle: Array, omega: float) -> float:
    table = _harmonics(time, omega)[:, :3]
    return float(np.sum((angle - table @ np.linalg.lstsq(table, angle, rcond=None)[0]) ** 2))


def _notes(records: Sequence[Sine], *, together: bool) -> list[str]:
    frequencies = ", ".join(f"{record.omega / (2.0 * np.pi):.3g} Hz" for record in records)
    notes = [f"Frequencies: {frequencies}. The angle is taken as {HARMONICS} harmonics."]
    if together:
        notes.append(
            "One frequency cannot tell inertia and stiffness apart: only dynamic_stiffness, K - I omega^2, is known. "
            "Give a record at another frequency, or --set inertia=..."
        )
    return notes
