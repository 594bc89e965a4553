"""One run of a phase by the engine: its steps and its events.

The last step ends at the event, and the lengths of the others follow from the module smoothly. So every value is a
smooth function of the inputs, and its derivatives are those of the steps as they are taken.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, cached_property
from typing import TYPE_CHECKING

import numpy as np

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.errors import SimulationError
from tvimdesign.engine.integrator import STAGES, TIMES, Motion, advance, pursue, step
from tvimdesign.engine.interpreter import Array
from tvimdesign.engine.vectors import LANES
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.phase_instants import Drive, Grid, Instant, hermite

if TYPE_CHECKING:
    from tvimdesign.simulation.working_cycle.phase_engine import PhaseEngine

TOLERANCE = 2e-3
"""Largest error of a step of second order in the scaled state, a fifth of a kelvin; steps are of third order. Event
times are within 2e-3 of CVODES's at 1e-9 (tests)."""
FIRST = 0.02  # The first step, in times that the pads would need to heat the layer
MOST_STEPS, EXTRA, GROWTH = 5000, 40, 1.3
"""Steps of a phase at most; beyond those of the first run, and by how much each of these grows."""
STALLED = 1e-7  # Change of the scaled state over the rest of the horizon below which nothing will happen any more
NEAR, MOST_TRIALS, ROUGH = 1e-5, 12, 1e-3
"""Part of a step by which the last one may miss an event: what is left, its square, is made up by slopes. Part of the
step's change to which an event is looked for between its ends."""


class PhaseRun:
    """One run of a phase, at given inputs."""

    def __init__(
        self, phase: PhaseEngine, motion: Motion, registers: tuple[Array, Array, Array], inputs: Array, along: Array
    ) -> None:
        """Start before the first step; `registers` have the constants of the motion in place."""
        self.of, self.motion, self.registers = phase, motion, registers
        self.inputs, self.along, self.lanes = inputs, along, along.shape[1]
        self.instants: list[Instant] = []  # The start, and the ends of all steps
        self._given: dict[tuple[str, ...], tuple[Array, Array]] = {}

    def first(self, start: Instant, pace: float, sought: list[str], horizon: float, tolerance: float) -> Grid:
        """Step as far as the events that are sought, each step as long as its error allows."""
        constant = CurrentProfile.constant(start.current)
        events, _ = self.simulate(start, pace, sought, horizon, constant, tolerance, seek=False)
        times = np.array([instant.time for instant in self.instants])
        return Grid((np.diff(times) / pace).tolist(), {name: instant.step for name, instant in events.items()})

    def simulate(
        self, start: Instant, pace: float, sought: list[str], horizon: float, profile: CurrentProfile,
        tolerance: float, deadline: Deadline = NEVER, *, seek: bool = True, throughout: bool = False,
    ) -> tuple[dict[str, Instant], bool]:  # fmt: skip
        """Step as far as the events that are sought, or `throughout`, each step as long as its error allows.

        Returns the instants of the events (with `seek`; else those before the steps in which they are due), and whether
        nothing will change any more. Raises SimulationError where not even the first step can be taken.
        """
        start = replace(start, current=float(profile.at(np.zeros(1))[0]))
        self.instants, h, events = [start], FIRST * pace, dict[str, Instant]()
        states, lengths = np.empty((LANES, start.state.size)), np.empty(LANES - 1)
        ahead, nothing, settled = np.zeros(start.state.size), np.zeros((start.state.size, self.lanes)), False
        while (now := self.instants[-1]).time < horizon and len(self.instants) <= MOST_STEPS and h > 0.0:
            if settled or (len(events) == len(sought) and not throughout):
                break
            deadline.check("the working cycle of a design was simulated")
            corner, first = profile.next_corner(now.time), len(self.instants)
            room = min(corner, horizon) - now.time
            slope = (float(profile.at(np.array([now.time + room]))[0]) - now.current) / room
            states[0] = now.state
            taken, h = pursue(
                self.motion.system, self.registers[2], states, lengths, now.current, slope, h, room, tolerance, ahead
            )
            times = np.minimum(np.cumsum(lengths[:taken]), room).tolist()
            self.instants += [
                Instant(
                    now.time + time, now.of_time, state.copy(), nothing, now.current + slope * time, now.of_current, k
                )
                for k, (time, state) in enumerate(zip(times, states[1:], strict=False), start=first - 1)
            ]
            for name, k in self._first_due([name for name in sought if name not in events], first - 1).items():
                before, then = self.instants[max(k - 1, 0)], self.instants[k]
                events[name] = self._crossing(name, before, then, slope) if seek and k > 0 else then
            if len(events) == len(sought) and not throughout:
                del self.instants[max((moment.step for moment in events.values()), default=-1) + 2 :]
            elif len(self.instants) == 1:
                name = self.of.phase.phase.name
                raise SimulationError(f"the {name} of this design cannot be simulated; check its inputs")
            last = self.instants[-1]
            if slope == 0.0 and not throughout and np.isinf(corner):
                settled = bool(np.max(np.abs(self.rates(last)[: self.of.size])) * (horizon - last.time) < STALLED)
        return events, settled

    def search(self, start: Instant, pace: float, dpace: Array, sought: list[str], grid: Grid) -> dict[str, Instant]:
        """Step along a grid to where each event first is due."""
        shares = np.array(grid.shares)
        if len(shares):
            shares = np.append(shares, shares[-1] * GROWTH ** np.arange(1, EXTRA + 1))
        self.instants = [start]
        steps = _Steps(start, shares * pace, shares[:, None] * dpace)
        events: dict[str, Instant] = {}

        @cache
        def gaps(group: tuple[str, ...], k: int) -> Array:
            return self._values(group, self.instants[k].state, self.instants[k].current)

        for name in sorted(sought, key=grid.events.__getitem__):
            group, place = self.of.together[name]
            k = grid.events[name]
            while 0 <= k < len(shares):
                if not self._advanced(steps, k + 1):
                    return events
                if gaps(group, k)[place] >= 0.0:
                    k -= 1
                elif gaps(group, k + 1)[place] < 0.0:
                    k += 1
                else:
                    events[name] = self._crossing(name, self.instants[k], self.instants[k + 1])
                    break
            if k < 0:
                events[name] = start
        return events

    def _advanced(self, steps: _Steps, count: int) -> bool:
        """Return whether so many steps could be taken."""
        done = len(self.instants) - 1
        if count <= done:
            return True
        reached = advance(
            self.motion.system, *self.registers, steps.states, steps.tangents, done, steps.lengths[:count],
            steps.of_lengths[:count], steps.u, steps.du, steps.ahead,
        )  # fmt: skip
        for k in range(done, reached):
            before = self.instants[k]
            self.instants.append(Instant(
                before.time + steps.lengths[k], before.of_time + steps.of_lengths[k], steps.states[k + 1],
                steps.tangents[k + 1], steps.u[k, -1], steps.du[k, -1], k,
            ))  # fmt: skip
        return reached == count

    def driven(self, start: Instant, drive: Drive) -> Instant | None:
        """Step to the end of a drive; None where a step fails."""
        start = replace(start, current=float(drive.currents[0]), of_current=drive.of_currents[0])
        self.instants = [start]
        shares = np.arange(drive.steps) / drive.steps
        pieces = np.diff(drive.moments)
        rise, of_rise = np.diff(drive.currents), np.diff(drive.of_currents, axis=0)
        at = (shares[:, None] + TIMES / drive.steps).ravel()  # of a piece: stage after stage
        u = (drive.currents[:-1, None] + rise[:, None] * at).reshape(-1, STAGES)
        du = (drive.of_currents[:-1, None, :] + of_rise[:, None, :] * at[:, None]).reshape(-1, STAGES, self.lanes)
        lengths = np.repeat(pieces / drive.steps, drive.steps)
        of_lengths = np.repeat(np.diff(drive.of_moments, axis=0) / drive.steps, drive.steps, axis=0)
        steps = _Steps(start, lengths, of_lengths, u, du)
        return self.instants[-1] if self._advanced(steps, len(lengths)) else None

    def value(self, name: str, y: Array, current: float) -> float:
        """Return a quantity at an instant; of an event what it waits for."""
        group, place = self.of.together[name]
        return float(self._values(group, y, current)[place])

    def _first_due(self, names: list[str], first: int) -> dict[str, int]:
        """Return the first instant, from the one numbered `first` on, at which each event has happened."""
        due, places = dict[str, int](), {name: self.of.together[name] for name in names}
        for group in {group for group, _ in places.values()}:
            happened = self.values(group, self.instants[first:]) >= 0.0
            due |= {
                name: first + int(np.argmax(happened[:, place]))
                for name, (its, place) in places.items()
                if its == group and happened[:, place].any()
            }
        return due

    def values(self, group: tuple[str, ...], passed: Sequence[Instant]) -> Array:
        """Return quantities that are recorded together, a column each, at some instants, a row each."""
        given = np.empty((self.of.size + 1, len(passed)))
        given[:-1] = np.array([instant.state for instant in passed]).T[: self.of.size]
        given[-1] = [instant.current for instant in passed]
        return self.of.evaluated(group, self._constants_of(group)[0], given).T

    def _values(self, group: tuple[str, ...], y: Array, current: float) -> Array:
        (values,) = self.of.watch(*group).at.values(
            y[: self.of.size], np.array([current]), self._constants_of(group)[0]
        )
        return values

    def slopes(self, name: str, now: Instant) -> tuple[float, Array]:
        """Return a quantity at an instant, and its slopes; along directions beyond the run's the inputs stay."""
        group, place = self.of.together[name]
        values, slopes = self.slopes_together(group, now)
        return float(values[place]), slopes[place]

    def slopes_together(self, group: tuple[str, ...], now: Instant) -> tuple[Array, Array]:
        """Return quantities that are recorded together at an instant, and their slopes as `slopes` does."""
        (k, dk), size, further = self._constants_of(group), self.of.size, now.of_state.shape[1] - self.lanes
        if further:
            dk = np.hstack([dk, np.zeros((len(dk), further))])
        ((values, slopes),) = self.of.watch(*group).at.tangents(
            (now.state[:size], np.array([now.current]), k), (now.of_state[:size], now.of_current[None], dk)
        )
        return values, slopes

    def _constants_of(self, group: tuple[str, ...]) -> tuple[Array, Array]:
        if group not in self._given:
            ((k, dk),) = self.of.watch(*group).given.tangents([self.inputs], [self.along])
            self._given[group] = k, dk
        return self._given[group]

    def rates(self, now: Instant) -> Array:
        """Return the time derivative of the state."""
        (rates,) = self.motion.rates.values(now.state, np.array([now.current]), self.constants)
        return rates

    @cached_property
    def constants(self) -> Array:
        """Compute what the rates need that follows from the inputs."""
        first = self.motion.size + 1
        return self.registers[0][first : int(self.motion.rates.arguments[-1])]

    def _crossing(self, name: str, start: Instant, end: Instant, slope: float = 0.0) -> Instant:
        """Find the instant of an event between the ends of two steps, in which the current has a `slope`.

        The last step ends there: its length is sought by the secant method, and is one more direction.
        """
        whole = end.time - start.time
        here, there = self.rates(start) * whole, self.rates(end) * whole

        def between(share: float) -> Array:
            return hermite(share, start.state, end.state, here, there)

        def due(share: float) -> float:
            return self.value(name, between(share), start.current + slope * share * whole)

        share, steep = _root(due)
        length, steep = whole * share, steep / whole
        least, most, before, last = 0.0, 1.05 * whole, None, end
        for _ in range(MOST_TRIALS):
            last = self._last_step(start, length, slope, 0.4 * (between(length / whole) - start.state), 0)
            gap = self.value(name, last.state, last.current)
            if before is not None and length != before[0] and gap != before[1]:
                steep = (gap - before[1]) / (length - before[0])
            least, most = (length, most) if gap < 0.0 else (least, length)
            before, short = (length, gap), -gap / steep
            near = abs(short) <= NEAR * whole
            if least < length + short < most:
                length += short
            elif not near:
                length = 0.5 * (least + most)
            if near:
                break
        last = self._last_step(start, length, slope, 0.4 * (last.state - start.state), self.lanes)
        gap, slopes = self.slopes(name, last)
        short, longer = -gap / slopes[-1], -slopes / slopes[-1]
        longer[-1] = 0.0
        by_length, s = last.of_state[:, -1:].copy(), last.of_state
        s[:, -1] = 0.0
        of_current = last.of_current + slope * longer
        of_current[-1] = 0.0
        return replace(
            last, time=start.time + length + short, of_time=start.of_time + longer,
            state=last.state + short * by_length[:, 0], of_state=s + by_length * longer,
            current=last.current + slope * short, of_current=of_current,
        )  # fmt: skip

    def _last_step(self, start: Instant, length: float, slope: float, guess: Array, lanes: int) -> Instant:
        """Return the instant after a last step; the last of its `lanes` directions, if any, is its length."""
        y, s, longer = start.state.copy(), start.of_state[:, :lanes].copy(), np.zeros(lanes)
        longer[-1:] = 1.0
        u = start.current + slope * TIMES * length
        du = start.of_current[:lanes] + slope * TIMES[:, None] * longer
        step(self.motion.system, *self.registers, y, s, u, du, length, longer, guess)
        return Instant(start.time + length, longer, y, s, float(u[-1]), du[-1], start.step + 1)


class _Steps:
    """Room for the states of steps whose lengths and currents are given."""

    def __init__(
        self, start: Instant, lengths: Array, of_lengths: Array, u: Array | None = None, du: Array | None = None
    ) -> None:
        count, (size, lanes) = len(lengths), start.of_state.shape
        self.lengths, self.of_lengths = lengths, of_lengths
        self.states, self.tangents = np.empty((count + 1, size)), np.empty((count + 1, size, lanes))
        self.states[0], self.tangents[0] = start.state, start.of_state
        self.u = np.full((count, STAGES), start.current) if u is None else u
        self.du = np.broadcast_to(start.of_current, (count, STAGES, lanes)).copy() if du is None else du
        self.ahead = np.zeros(size)


def _root(function: Callable[[float], float]) -> tuple[float, float]:
    """Find where a function of a share of a step passes zero, about, and its slope: by regula falsi (Illinois)."""
    low, high, below, above = 0.0, 1.0, function(0.0), function(1.0)
    slope, share, side = above - below, 1.0, 0
    scale = ROUGH * slope
    for _ in range(12 if above > 0.0 else 0):
        share = (low * above - high * below) / (above - below)
        value = function(share)
        if abs(value) < scale or high - low < ROUGH:
            break
        if value < 0.0:
            low, below, above = share, value, above * (0.5 if side == -1 else 1.0)
            side = -1
        else:
            high, above, below = share, value, below * (0.5 if side == 1 else 1.0)
            side = 1
        slope = (above - below) / (high - low)
    return share, slope
