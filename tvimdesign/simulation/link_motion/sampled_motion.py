"""A sampled motion of the link, what is read off it, and the steps in which it is sampled.

Samples come in stretches of one step each. Steps that double from stretch to stretch resolve microseconds and hours in
a few hundred samples, and no step is too long for a stiff system, as the matrix exponential carries the state.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.motions import one_sided
from tvimdesign.physics.motions.one_sided import Touching

Array = NDArray[np.float64]
Stretch = tuple[float, int]
"""(step [s], count of steps)."""
PER_STRETCH = 24  # samples of one doubling of time
SAMPLES_A_PERIOD = 24
DEAD = 1e-3  # share of its start at which a swing is no longer worth its samples, and the whole motion is over
LONGEST = 3600.0  # s, after which a release is given up
MOST_SAMPLES = 6_000  # what a joint that hardly damps is shown for
RESTING = 1e-12
"""Share of the largest speed up to which a link rests."""
TURNS_OF_A_SWING = 2


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


@dataclass(frozen=True)
class ContactEvent:
    """A block left or met."""

    time: float
    """[s]"""
    side: int
    """0: the first block, 1: the second."""
    touching: bool
    """True if it touches from here on."""


@dataclass(frozen=True)
class OneSided:
    """A motion between blocks; every event is one of its samples."""

    motion: Motion
    """`internal` has the rows of the first block, then those of the second."""
    touching: NDArray[np.bool_]
    """True where a block touches from a sample to the next; one row a block."""
    events: tuple[ContactEvent, ...]
    rest: float | None = None
    """Angle at which friction holds the link for good [rad]; None where it is free, or still moves."""

    def lost_share(self, start: float, end: float) -> float:
        """Return the share of the time between two moments [s] in which no block touches."""
        return self.average(one_sided.out_of_contact(Touching(*self.touching.astype(float))), start, end)

    def average(self, values: Array, start: float, end: float) -> float:
        """Return the mean over the time between two moments [s] of what has one value from a sample to the next."""
        edges = np.clip(self.motion.times, start, end)
        return float(np.sum(np.diff(edges) * values[:-1]) / (end - start))

    def first_swing(self) -> float:
        """Return time [s] at which the link turns round for the second time; the end of the motion if it never does."""
        turns = turns_of(self.motion.speed)
        enough = len(turns) >= TURNS_OF_A_SWING
        return float(self.motion.times[turns[TURNS_OF_A_SWING - 1]] if enough else self.motion.times[-1])

    def settling_time(self, share: float) -> float:
        """Return time [s] after which it stays within a share of its start from its rest; infinite if that is not seen.

        A curve that ends while the link swings may end just as it passes its rest: a whole swing must be within.
        """
        times, turns = self.motion.times, turns_of(self.motion.speed)
        settled = settling_time(times, self.motion.angle - (self.rest or 0.0), share)
        if self.rest is None and len(turns) > TURNS_OF_A_SWING:
            swing = times[turns[-1]] - times[turns[-1 - TURNS_OF_A_SWING]]
            return settled if times[-1] - settled >= swing else float("inf")
        return settled


def turns_of(speed: Array) -> NDArray[np.int64]:
    """Return samples just after a link that started at rest has turned round."""
    # At rest, at the start or where friction stops it, a link has the speed of rounding.
    moving = np.flatnonzero(np.abs(speed[1:]) > RESTING * np.max(np.abs(speed))) + 1
    return moving[1:][speed[moving[1:]] * speed[moving[:-1]] < 0.0]


def settling_time(times: Array, angle: Array, share: float) -> float:
    """Return time [s] after which the angle stays within a share of its start; infinite if not within the samples."""
    limit = share * abs(angle[0])
    last = int(np.flatnonzero(np.abs(angle) > limit)[-1])
    if last + 1 == len(times):
        return float("inf")
    before, after = abs(angle[last]), abs(angle[last + 1])
    return float(times[last] + (before - limit) / (before - after) * (times[last + 1] - times[last]))


def doubling(first: float, last: float) -> list[Stretch]:
    """Return stretches from 0 to `last`: the first of step `first`, each later one of twice the step before."""
    stretches: list[Stretch] = []
    time, step = 0.0, min(first, last / PER_STRETCH)
    while time < last * (1.0 - 1e-9):
        count = min(PER_STRETCH, int(np.ceil((last - time) / step - 1e-9)))
        stretches.append((min(step, (last - time) / count), count))
        time, step = time + stretches[-1][0] * count, 2.0 * step
    return stretches


def growing(first: float, values: Array) -> Iterator[Stretch]:
    """Return stretches whose step doubles as soon as every swing that still lives is sampled finely enough."""
    swings = [(-value.real, 2.0 * np.pi / (value.imag * SAMPLES_A_PERIOD)) for value in values if value.imag > 0.0]
    time, step = 0.0, first
    while time < LONGEST:
        count = min(PER_STRETCH, int(np.ceil((LONGEST - time) / step)))
        yield step, count
        time += step * count
        finest = min((need for decay, need in swings if decay * time < -np.log(DEAD)), default=np.inf)
        if 2.0 * step <= finest:
            step *= 2.0


def stretches_of(durations: Iterable[float]) -> tuple[Stretch, ...]:
    """Return steps of the same length, one after the other, as stretches."""
    stretches: list[Stretch] = []
    for step in durations:
        same = bool(stretches) and stretches[-1][0] == step
        stretches[-1:] = [(step, stretches[-1][1] + 1)] if same else [*stretches[-1:], (step, 1)]
    return tuple(stretches)
