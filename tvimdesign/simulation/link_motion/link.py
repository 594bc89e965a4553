"""The link's motion in time: held, released, swung or turned; exact in every mode of its polymer."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.motions import motion
from tvimdesign.simulation.link_motion import sampled_motion
from tvimdesign.simulation.link_motion.course import HELD, Course, Plant
from tvimdesign.simulation.link_motion.sampled_motion import Array, Motion, OneSided, Stretch


def held(plant: Plant, angle: float, seconds: float, precompression: float = 0.0) -> Array:
    """Return the internal angles [rad] of a polymer that was turned at once to an angle and held there.

    It was free of strain before, or blocks were squeezed by `precompression`.
    """
    course = Course(plant, omega=0.0)
    course.start(angle, 0.0, squeezed(plant, precompression))
    if len(plant.sides) == 1 and seconds > 0.0:
        course.across(seconds)
    elif seconds > 0.0:
        quickest = min(time for side in plant.sides for time, _ in side)
        for step, count in sampled_motion.doubling(quickest / sampled_motion.SAMPLES_A_PERIOD, seconds):
            for _ in range(count):
                course.across(step)
    return course.states()[2:, -1]


def slipped(plant: Plant, angle: float, internal: Array, most: float) -> tuple[Array, float]:
    """Return the internal angles [rad] of a bonded layer at an angle, and how far it slipped to get there.

    It slips until springs and layer together resist with `most` [N*m], as all of it turns with the slip.
    """
    torque, less = (float(plant.torque(np.array(angle), list(internal + slip), HELD)) for slip in (0.0, 1.0))
    slip = max(abs(torque) - most, 0.0) * np.sign(torque) / (torque - less)
    return internal + slip, float(slip)


def released(plant: Plant, angle: float, internal: Array, friction: float = 0.0, turns: float = np.inf) -> OneSided:
    """Let go of a link at rest, against a friction torque [N*m], and follow it until it rests, or for an hour.

    With `turns` not much longer than until it has turned round so often. In coordinates whose square is the energy the
    propagator is a contraction: rounding is relative to the energy.
    """
    course = Course(plant, friction)
    course.start(angle, 0.0, internal)
    enough = sampled_motion.DEAD**2 * course.driving_energy()
    first = course.quickest / sampled_motion.SAMPLES_A_PERIOD
    while not course.over(enough, turns):
        course.follow(first, enough, turns)
    return course.motion()


def swung(
    plant: Plant, amplitude: float, frequency: float, periods: int, samples: int, precompression: float = 0.0
) -> OneSided:
    """Turn a link to and fro as a sine [rad, Hz] from rest, its polymer as `held` has it at first."""
    omega = 2.0 * np.pi * frequency
    course = Course(plant, omega=omega)
    course.start(0.0, amplitude * omega, squeezed(plant, precompression))
    for _ in range(periods * samples):
        course.across(1.0 / frequency / samples)
    return course.motion()


def squeezed(plant: Plant, angle: float) -> Array:
    """Return the internal angles [rad] of blocks that were free of strain and have just been squeezed by an angle."""
    return np.full(plant.size - 2, -angle)


def kelvin_voigt(
    joint: motion.Joint, damping: float, stiffness: float, angle: float, like: Motion
) -> tuple[Array, Array]:
    """Return angle [rad] and torque [N*m] of a release with one spring and one dashpot, at the times of another."""
    matrix = _matrix_of(lambda a, w: motion.kelvin_voigt_rates(a, w, joint.inertia, damping, stiffness), 2)
    states = _propagate(matrix, np.array([angle, 0.0]), like.stretches)
    return states[0], motion.kelvin_voigt_torque(states[0], states[1], damping, stiffness)


@dataclass(frozen=True)
class Swings:
    """A release as a sum of exponentials: their rates [1/s], and their shares in the angle at the start [rad]."""

    rates: NDArray[np.complex128]
    shares: NDArray[np.complex128]

    def ringing(self) -> tuple[float, float]:
        """Return frequency [Hz] and damping ratio of the swing that stands out; 0 and 1 where none does."""
        main = self._main
        if main is None:
            return 0.0, 1.0
        return float(main.imag / (2.0 * np.pi)), float(-main.real / abs(main))

    def ringing_time(self, share: float) -> float:
        """Return time [s] after which that swing has fallen to a share; 0 where none stands out."""
        return 0.0 if self._main is None else float(np.log(share) / self._main.real)

    @property
    def _main(self) -> complex | None:
        """Rate of the swing that stands out."""
        visible = 2.0 * np.abs(self.shares) > 0.05 * abs(np.sum(self.shares))
        swinging = (self.rates.imag > 0.0) & visible & (-self.rates.real < 0.5 * np.abs(self.rates))
        if not np.any(swinging):
            return None
        return complex(self.rates[swinging][np.argmax(np.abs(self.shares[swinging]))])

    def fading_time(self, limit: float) -> float:
        """Return time [s] after which all swings together stay below a limit [rad]; infinite if that never comes."""
        from scipy.optimize import brentq

        def excess(log_time: float) -> float:
            fading = np.exp(np.minimum(self.rates.real, 0.0) * np.exp(log_time))
            return float(np.log(np.sum(np.abs(self.shares) * fading) + 1e-300) - np.log(limit))

        last = np.log(1e3 * sampled_motion.LONGEST)
        return float(np.exp(brentq(excess, -20.0, last))) if excess(last) < 0.0 else float("inf")


def swings(joint: motion.Joint, modes: motion.Modes, angle: float, internal: Array) -> Swings:
    """Take the release of a link at rest apart into its exponentials."""
    matrix = _matrix_of(lambda a, w, *q: motion.rates(a, w, q, 0.0, joint, modes), 2 + len(modes))
    return _exponentials(matrix, np.concatenate([[angle, 0.0], internal]))


def kelvin_voigt_swings(joint: motion.Joint, damping: float, stiffness: float, angle: float) -> Swings:
    """Take a release with one spring and one dashpot apart."""
    matrix = _matrix_of(lambda a, w: motion.kelvin_voigt_rates(a, w, joint.inertia, damping, stiffness), 2)
    return _exponentials(matrix, np.array([angle, 0.0]))


def _exponentials(matrix: Array, start: Array) -> Swings:
    values, vectors = np.linalg.eig(matrix)
    return Swings(values.astype(complex), np.linalg.solve(vectors, start.astype(complex)) * vectors[0])


def _matrix_of(rates: Callable[..., Iterable[Array]], size: int) -> Array:
    """Return the matrix of x' = A x, read off at the unit vectors; `rates` takes one argument a state."""
    return np.array([np.broadcast_to(row, size) for row in rates(*np.eye(size))])


def _propagate(matrix: Array, start: Array, stretches: Iterable[Stretch]) -> Array:
    """Return states of x' = A x, one column a sample, from the start on."""
    from scipy.linalg import expm

    columns, known, last = [start], 0.0, np.eye(len(start))
    for step, count in stretches:
        if step != known:
            known, last = step, expm(matrix * step)
        for _ in range(count):
            columns.append(last @ columns[-1])
    return np.column_stack(columns)
