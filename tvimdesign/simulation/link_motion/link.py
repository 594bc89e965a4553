"""The link's motion in time: released, held, or turned as prescribed; exact in every mode of the layer."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.motions import motion
from tvimdesign.simulation.link_motion.linear_system import PER_STRETCH, Stretch, matrix_of, propagate, times_of

Array = NDArray[np.float64]
SAMPLES_A_PERIOD = 24
DEAD = 1e-3  # share of its start at which a swing is no longer worth its samples, and the whole motion is over
LONGEST = 3600.0  # s, after which a release is given up
MOST_SAMPLES = 6_000  # what a joint that hardly damps is shown for


@dataclass(frozen=True)
class Motion:
    """A motion, sampled: times [s], angle [rad], torque of the module on the link [N*m], stored energy [J]."""

    times: Array
    angle: Array
    speed: Array
    internal: Array
    """Internal angle of each mode [rad], one row a mode."""
    torque: Array
    energy: Array
    stretches: tuple[Stretch, ...]
    """The steps in which it was sampled."""


def held(joint: motion.Joint, modes: motion.Modes, angle: float, seconds: float) -> Array:
    """Internal angles [rad] of a layer that was free of strain, turned at once to an angle and held there."""
    matrix = matrix_of(
        lambda theta, *inner: [np.zeros_like(theta), *motion.internal_rates(theta, inner, joint, modes)], 1 + len(modes)
    )
    start = np.append(angle, np.zeros(len(modes)))
    return propagate(matrix, start, [(seconds, 1)])[1:, -1] if seconds > 0.0 else start[1:]


def released(joint: motion.Joint, modes: motion.Modes, angle: float, internal: Array) -> Motion:
    """Let go of a link at rest, and follow it until its energy is as good as gone, or for an hour.

    In coordinates whose square is the energy the propagator is a contraction: rounding is relative to the energy.
    """
    size = 2 + len(modes)
    matrix = matrix_of(lambda a, w, *q: motion.rates(a, w, q, 0.0, joint, modes), size)
    identity = np.eye(size)
    terms = motion.energy_terms(identity[0], identity[1], list(identity[2:]), joint, modes)
    to_energy = np.linalg.qr(np.array([np.sqrt(c) * d for c, d in terms]), mode="r")
    from_energy = np.linalg.inv(to_energy)
    state = to_energy @ np.concatenate([[angle, 0.0], internal])
    turned = to_energy @ matrix @ from_energy
    first = 2.0 * np.pi / SAMPLES_A_PERIOD * np.sqrt(joint.inertia / stiffest(joint, modes))
    enough = DEAD**2 * float(state @ state)
    stretches, columns, taken = [], [state[:, None]], 1
    for stretch in growing(first, np.linalg.eigvals(turned)):
        columns.append(propagate(turned, columns[-1][:, -1], [stretch])[:, 1:])
        stretches.append(stretch)
        taken += stretch[1]
        state = columns[-1][:, -1]
        if float(state @ state) < enough or taken > MOST_SAMPLES:
            break
    return _motion(from_energy @ np.concatenate(columns, axis=1), joint, modes, tuple(stretches))


def turned(joint: motion.Joint, modes: motion.Modes, angle: float, rise: float, after: Sequence[Stretch]) -> Motion:
    """Turn a link whose layer is free of strain at a steady speed to an angle in `rise` seconds, and hold it there."""
    size = 2 + len(modes)

    def rates(theta: Array, speed: Array, *inner: Array) -> list[Array]:
        return [speed, np.zeros_like(speed), *motion.internal_rates(theta, inner, joint, modes)]

    matrix = matrix_of(rates, size)
    ramp = [(rise / PER_STRETCH, PER_STRETCH)]
    rising = propagate(matrix, np.concatenate([[0.0, angle / rise], np.zeros(len(modes))]), ramp)
    stop = rising[:, -1].copy()
    stop[1] = 0.0
    holding = propagate(matrix, stop, after)
    return _motion(np.concatenate([rising, holding[:, 1:]], axis=1), joint, modes, (*ramp, *after))


def swung(
    joint: motion.Joint, modes: motion.Modes, amplitude: float, frequency: float, periods: int, samples: int
) -> Motion:
    """Turn a link to and fro as a sine [rad, Hz] from rest, its layer free of strain at first."""
    omega = 2.0 * np.pi * frequency

    def rates(theta: Array, speed: Array, *inner: Array) -> list[Array]:
        return [speed, -(omega**2) * theta, *motion.internal_rates(theta, inner, joint, modes)]

    start = np.concatenate([[0.0, amplitude * omega], np.zeros(len(modes))])
    steps = ((1.0 / frequency / samples, periods * samples),)
    return _motion(propagate(matrix_of(rates, 2 + len(modes)), start, steps), joint, modes, steps)


def kelvin_voigt(
    joint: motion.Joint, damping: float, stiffness: float, angle: float, like: Motion
) -> tuple[Array, Array]:
    """Angle [rad] and torque [N*m] of the same release with one spring and one dashpot, at the times of another."""
    matrix = matrix_of(lambda a, w: motion.kelvin_voigt_rates(a, w, joint.inertia, damping, stiffness), 2)
    states = propagate(matrix, np.array([angle, 0.0]), like.stretches)
    return states[0], motion.kelvin_voigt_torque(states[0], states[1], damping, stiffness)


@dataclass(frozen=True)
class Swings:
    """A release as a sum of exponentials: their rates [1/s], and their shares in the angle at the start [rad]."""

    rates: NDArray[np.complex128]
    shares: NDArray[np.complex128]

    def ringing(self) -> tuple[float, float]:
        """Frequency [Hz] and damping ratio of the swing that stands out; 0 and 1 where none does."""
        visible = 2.0 * np.abs(self.shares) > 0.05 * abs(np.sum(self.shares))
        swinging = (self.rates.imag > 0.0) & visible & (-self.rates.real < 0.5 * np.abs(self.rates))
        if not np.any(swinging):
            return 0.0, 1.0
        main = self.rates[swinging][np.argmax(np.abs(self.shares[swinging]))]
        return float(main.imag / (2.0 * np.pi)), float(-main.real / abs(main))

    def fading_time(self, limit: float) -> float:
        """Time [s] after which all swings together stay below a limit [rad]; infinite if that never comes."""
        from scipy.optimize import brentq

        def excess(log_time: float) -> float:
            fading = np.exp(np.minimum(self.rates.real, 0.0) * np.exp(log_time))
            return float(np.log(np.sum(np.abs(self.shares) * fading) + 1e-300) - np.log(limit))

        last = np.log(1e3 * LONGEST)
        return float(np.exp(brentq(excess, -20.0, last))) if excess(last) < 0.0 else float("inf")


def swings(joint: motion.Joint, modes: motion.Modes, angle: float, internal: Array) -> Swings:
    """Take the release of a link at rest apart into its exponentials."""
    matrix = matrix_of(lambda a, w, *q: motion.rates(a, w, q, 0.0, joint, modes), 2 + len(modes))
    return _apart(matrix, np.concatenate([[angle, 0.0], internal]))


def kelvin_voigt_swings(joint: motion.Joint, damping: float, stiffness: float, angle: float) -> Swings:
    """The same with one spring and one dashpot."""
    matrix = matrix_of(lambda a, w: motion.kelvin_voigt_rates(a, w, joint.inertia, damping, stiffness), 2)
    return _apart(matrix, np.array([angle, 0.0]))


def _apart(matrix: Array, start: Array) -> Swings:
    values, vectors = np.linalg.eig(matrix)
    return Swings(values.astype(complex), np.linalg.solve(vectors, start.astype(complex)) * vectors[0])


def settling_time(times: Array, angle: Array, share: float) -> float:
    """Time [s] after which the angle stays within a share of its start; infinite if not within the samples."""
    limit = share * abs(angle[0])
    last = int(np.flatnonzero(np.abs(angle) > limit)[-1])
    if last + 1 == len(times):
        return float("inf")
    before, after = abs(angle[last]), abs(angle[last + 1])
    return float(times[last] + (before - limit) / (before - after) * (times[last + 1] - times[last]))


def stiffest(joint: motion.Joint, modes: motion.Modes) -> float:
    """Stiffness of the joint before any mode relaxes [N*m/rad]."""
    layer = sum(stiffness for _, stiffness in modes)
    return float(joint.spring_stiffness + joint.structure_stiffness * layer / (joint.structure_stiffness + layer))


def growing(first: float, values: Array) -> Iterator[Stretch]:
    """Stretches whose step doubles as soon as every swing that still lives is sampled finely enough."""
    swings = [(-value.real, 2.0 * np.pi / (value.imag * SAMPLES_A_PERIOD)) for value in values if value.imag > 0.0]
    time, step = 0.0, first
    while time < LONGEST:
        count = min(PER_STRETCH, int(np.ceil((LONGEST - time) / step)))
        yield step, count
        time += step * count
        finest = min((need for decay, need in swings if decay * time < -np.log(DEAD)), default=np.inf)
        if 2.0 * step <= finest:
            step *= 2.0


def _motion(states: Array, joint: motion.Joint, modes: motion.Modes, stretches: tuple[Stretch, ...]) -> Motion:
    angle, speed, internal = states[0], states[1], states[2:]
    return Motion(
        times=times_of(stretches),
        angle=angle,
        speed=speed,
        internal=internal,
        torque=np.asarray(motion.module_torque(angle, list(internal), joint, modes)),
        energy=np.asarray(motion.stored_energy(angle, speed, list(internal), joint, modes)),
        stretches=stretches,
    )
