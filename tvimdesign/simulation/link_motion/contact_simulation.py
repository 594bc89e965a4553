"""A motion between two one-sided blocks on its way: exact from event to event, every event found.

As long as the same blocks touch, the motion is linear and the matrix exponential carries it; each step is looked
through for the moment at which a block's pull passes zero, and goes on from there with the other matrix.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.motions import one_sided
from tvimdesign.physics.motions.motion import Joint
from tvimdesign.physics.motions.one_sided import Blocks, Touching
from tvimdesign.simulation.link_motion.linear_system import Stretch, matrix_of
from tvimdesign.simulation.link_motion.link import Array, Motion, settling_time

Rates = Callable[[Array, Array, list[Array], Touching], list[Array]]
"""Rates of angle, speed and internal angles while the same blocks touch."""
SEARCHED = 1e-13
"""Share of a step to which an event is located."""
NUDGE = 2.0**-10
"""Share of a step taken where a block is grazed, before it is asked again whether it touches."""
RESTING = 1e-12
"""Share of the largest speed up to which a link rests."""
TURNS_OF_A_SWING = 2


@dataclass(frozen=True)
class ContactEvent:
    """A block left or met."""

    time: float
    """[s]"""
    side: int
    """0: the first block, 1: the second."""
    touching: bool
    """Whether it touches from here on."""


@dataclass(frozen=True)
class OneSided:
    """A motion between blocks; every event is one of its samples."""

    motion: Motion
    """`internal` has the rows of the first block, then those of the second."""
    touching: NDArray[np.bool_]
    """Whether each block touches from a sample to the next; one row a block."""
    events: tuple[ContactEvent, ...]
    rest: float | None = None
    """Angle at which friction holds the link for good [rad]; None where it is free, or still moves."""

    def lost_share(self, start: float, end: float) -> float:
        """Share of the time between two moments [s] in which no block touches."""
        return self.average(one_sided.out_of_contact(Touching(*self.touching.astype(float))), start, end)

    def average(self, values: Array, start: float, end: float) -> float:
        """Mean over the time between two moments [s] of what has one value from a sample to the next."""
        edges = np.clip(self.motion.times, start, end)
        return float(np.sum(np.diff(edges) * values[:-1]) / (end - start))

    def first_swing(self) -> float:
        """Time [s] at which the link turns round for the second time; the end of the motion if it never does."""
        turns = turns_of(self.motion.speed)
        enough = len(turns) >= TURNS_OF_A_SWING
        return float(self.motion.times[turns[TURNS_OF_A_SWING - 1]] if enough else self.motion.times[-1])

    def settling_time(self, share: float) -> float:
        """Time [s] after which it stays within a share of its start from its rest; infinite if that is not seen.

        A curve that ends while the link swings may end just as it passes its rest: a whole swing must be within.
        """
        times, turns = self.motion.times, turns_of(self.motion.speed)
        settled = settling_time(times, self.motion.angle - (self.rest or 0.0), share)
        if self.rest is None and len(turns) > TURNS_OF_A_SWING:
            swing = times[turns[-1]] - times[turns[-1 - TURNS_OF_A_SWING]]
            return settled if times[-1] - settled >= swing else float("inf")
        return settled


def turns_of(speed: Array) -> NDArray[np.int64]:
    """Samples just after a link that started at rest has turned round."""
    # At rest, at the start or where friction stops it, a link has the speed of rounding.
    moving = np.flatnonzero(np.abs(speed[1:]) > RESTING * np.max(np.abs(speed))) + 1
    return moving[1:][speed[moving[1:]] * speed[moving[:-1]] < 0.0]


class Regime:
    """The linear motion while the same blocks touch, in coordinates whose square is the energy when both do."""

    def __init__(self, touching: Sequence[float], matrix: Array, pulls: Array) -> None:
        """Take x' = matrix x and the blocks' pulls as rows that take x; those that touch stay above zero."""
        self.touching, self.matrix, self.pulls = touching, matrix, pulls
        self.slopes = pulls @ matrix
        self._known: dict[float, Array] = {}

    @cached_property
    def values(self) -> Array:
        """Eigenvalues [1/s]."""
        return np.asarray(np.linalg.eigvals(self.matrix))

    def after(self, state: Array, step: float) -> Array:
        """State a regular step later; its propagator is kept."""
        from scipy.linalg import expm

        if step not in self._known:
            self._known[step] = expm(self.matrix * step)
        return np.asarray(self._known[step] @ state)

    def later(self, state: Array, time: float) -> Array:
        """State any time later."""
        from scipy.linalg import expm

        return np.asarray(expm(self.matrix * time) @ state)

    def leaving(self, side: int, state: Array, end: Array, step: float) -> float | None:
        """First time [s] in a step at which a block's pull gets the wrong sign, or None; `end` is the step's.

        A pull that falls and rises again within the step is looked at where it turns.
        """
        sign = 1.0 if self.touching[side] else -1.0
        pull, slope = sign * self.pulls[side], sign * self.slopes[side]
        starts, ends = float(slope @ state), float(slope @ end)
        if pull @ end >= 0.0 and not starts < 0.0 < ends:
            return None
        after = self._zero(slope, state, 0.0, step) if starts < 0.0 < ends else step
        return self._zero(pull, state, 0.0, after) if self._at(pull, state, after) < 0.0 else None

    def _at(self, row: Array, state: Array, time: float) -> float:
        from scipy.linalg import expm

        return float(row @ expm(self.matrix * time) @ state)

    def _zero(self, row: Array, state: Array, before: float, after: float) -> float:
        """Where a row of the state passes zero; the nearer end where rounding has taken the change of sign away."""
        from scipy.optimize import brentq

        ends = {time: self._at(row, state, time) for time in (before, after)}
        if ends[before] * ends[after] >= 0.0:
            return min(ends, key=lambda time: abs(ends[time]))
        return float(brentq(lambda time: self._at(row, state, time), before, after, xtol=SEARCHED * after, rtol=1e-14))


class Course:
    """A motion on its way: where it is, which blocks touch, and what it has come through."""

    def __init__(self, joint: Joint, blocks: Blocks, rates: Rates) -> None:
        """Take the link and what turns it; `start` comes next."""
        self._joint, self._blocks, self._rates = joint, blocks, rates
        self._size = 2 + len(blocks.first) + len(blocks.second)
        identity = np.eye(self._size)
        terms = one_sided.energy_terms(identity[0], identity[1], list(identity[2:]), Touching(1.0, 1.0), joint, blocks)
        self._to_energy = np.linalg.qr(np.array([np.sqrt(c) * d for c, d in terms]), mode="r")
        self._from_energy = np.linalg.inv(self._to_energy)
        self._pulls = np.array(one_sided.pulls(identity[0], list(identity[2:]), blocks))
        self._regimes: dict[Touching, Regime] = {}
        self._switched: set[int] = set()
        self.events: list[ContactEvent] = []

    def start(self, angle: float, speed: float, internal: Array) -> None:
        """Begin here; a block that lies just at the link touches if the link moves towards it."""
        state = np.concatenate([[angle, speed], internal])
        pulls = self._pulls @ state
        approach = self._pulls @ np.array([speed, *np.zeros(self._size - 1)])
        touching = (pulls > 0.0) | ((pulls == 0.0) & (approach > 0.0))
        self.columns = [self._to_energy @ state]
        self.durations: list[float] = []
        self.time = 0.0
        self.regime = self._regime(Touching(*touching.astype(float).tolist()))
        self.regimes = [self.regime]

    def across(self, step: float) -> None:
        """Go on by a step [s], through the events in it."""
        left = step
        while left > SEARCHED * step:
            state = self.columns[-1]
            end = self.regime.after(state, left) if left == step else self.regime.later(state, left)
            found = [
                (time, side) for side in (0, 1) if (time := self.regime.leaving(side, state, end, left)) is not None
            ]
            if not found:
                self._go(left, end)
                return
            time, side = min(found)
            if time <= SEARCHED * step and side in self._switched:
                time = min(NUDGE * step, left)
                self._go(time, self.regime.later(state, time))
            else:
                if time > 0.0:
                    self._go(time, self.regime.later(state, time))
                self._switch(side)
            left -= time

    def states(self) -> Array:
        """Angle, speed and internal angles, one column a sample."""
        return np.asarray(self._from_energy @ np.column_stack(self.columns))

    def turns(self) -> int:
        """How often the link has turned round."""
        return len(turns_of(self._from_energy[1] @ np.column_stack(self.columns)))

    def energy(self) -> float:
        """Energy where it is now [J]."""
        angle, speed, *internal = self._from_energy @ self.columns[-1]
        touching = Touching(*self.regime.touching)
        return float(one_sided.stored_energy(angle, speed, internal, touching, self._joint, self._blocks))

    def found(self) -> OneSided:
        """All it has come through."""
        states, stretches = self.states(), stretches_of(self.durations)
        touching = np.array([regime.touching for regime in self.regimes]).T
        given = (states[0], list(states[2:]), Touching(*touching), self._joint, self._blocks)
        motion = Motion(
            times=np.concatenate([[0.0], np.cumsum(self.durations)]),
            angle=states[0],
            speed=states[1],
            internal=states[2:],
            torque=np.asarray(one_sided.module_torque(*given)),
            energy=np.asarray(one_sided.stored_energy(states[0], states[1], *given[1:])),
            stretches=stretches,
        )
        return OneSided(motion, touching > 0.0, tuple(self.events))

    def _go(self, time: float, state: Array) -> None:
        self.columns.append(state)
        self.durations.append(time)
        self.regimes.append(self.regime)
        self.time += time
        self._switched.clear()

    def _switch(self, side: int) -> None:
        touching = list(self.regime.touching)
        touching[side] = 1.0 - touching[side]
        self.regime = self._regime(Touching(*touching))
        self.regimes[-1] = self.regime
        self._switched.add(side)
        self.events.append(ContactEvent(self.time, side, touching[side] > 0.0))

    def _regime(self, touching: Touching) -> Regime:
        if touching not in self._regimes:
            matrix = matrix_of(lambda a, w, *q: self._rates(a, w, list(q), touching), self._size)
            scaled = self._to_energy @ matrix @ self._from_energy
            self._regimes[touching] = Regime(touching, scaled, self._pulls @ self._from_energy)
        return self._regimes[touching]


def stretches_of(durations: Iterable[float]) -> tuple[Stretch, ...]:
    """Steps of the same length, one after the other, as stretches."""
    found: list[Stretch] = []
    for step in durations:
        same = bool(found) and found[-1][0] == step
        found[-1:] = [(step, found[-1][1] + 1)] if same else [*found[-1:], (step, 1)]
    return tuple(found)
