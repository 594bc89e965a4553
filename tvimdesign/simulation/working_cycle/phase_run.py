"""One run of a phase by the engine: its steps, its events, and what is asked of it.

The last step ends at the event, and the lengths of the others follow from the module smoothly. So every value is a
smooth function of the inputs, and its derivatives are those of the steps as they are taken.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.errors import SimulationError
from tvimdesign.engine.integrator import STAGES, TIMES, Motion, adapted, advance, newton_matrix, step
from tvimdesign.engine.interpreter import Array
from tvimdesign.engine.sparse_lu import solve_many
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile

if TYPE_CHECKING:
    from tvimdesign.simulation.working_cycle.phase_engine import PhaseEngine

TOLERANCE = 3e-3
"""Largest error of a step of second order in the scaled state, a third of a kelvin; steps are of third order. Event
times are within 3e-3 of CVODES's at 1e-9 (tests)."""
FIRST = 0.02
"""The first step, in times that the pads would need to heat the layer."""
MOST_STEPS, EXTRA, GROWTH = 5000, 40, 1.3
"""Steps of a phase at most; beyond those of the first run, and by how much each of these grows."""
STALLED = 1e-7
"""Change of the scaled state over the rest of the horizon below which nothing will happen any more."""
STANDING = -1e-12
"""Share of the mass in the matrix of a state that stays, so that integrals, which do not, leave it regular."""
NEAR, MOST_TRIALS = 1e-4, 12
"""Part of a step by which the last one may miss an event: what is left, its square, is made up by slopes."""


NARROW, MOST_PARABOLAS = 0.003, 5
"""Share of a step between the samples of a peak's second parabola, by which the last one moves it at most."""


@dataclass
class Grid:
    """The steps of a phase, by what its first run needed: each in times that the pads would need to heat the layer."""

    shares: list[float] = field(default_factory=list)
    events: dict[str, int] = field(default_factory=dict)
    """Step in which each event was due; -1 at the start."""


@dataclass(frozen=True)
class Instant:
    """State and current at an instant of a phase, with their tangents."""

    time: float
    of_time: Array
    state: Array
    of_state: Array
    current: float
    of_current: Array
    step: int = -1
    """The step that ends there; -1 at the start."""

    def without_length(self) -> Instant:
        """Leave out the last direction."""
        of_state = np.ascontiguousarray(self.of_state[:, :-1])
        return replace(self, of_time=self.of_time[:-1], of_state=of_state, of_current=self.of_current[:-1])


@dataclass(frozen=True)
class Drive:
    """A current that runs straight between given moments of a phase, with tangents; steps end at the moments."""

    moments: Array
    of_moments: Array
    currents: Array
    of_currents: Array
    steps: int
    """Of each piece."""

    def with_length(self) -> Drive:
        """Add the direction of a last step's length, along which nothing moves."""
        more = np.zeros((len(self.moments), 1))
        return replace(
            self, of_moments=np.hstack([self.of_moments, more]), of_currents=np.hstack([self.of_currents, more])
        )


@dataclass
class Found:
    """Values of a phase by name, with their derivatives."""

    values: dict[str, float] = field(default_factory=dict)
    slopes: dict[str, Array] = field(default_factory=dict)
    end: Instant | None = None
    short: float = 0.0
    """What the event that ends a driven phase still waits for at its end, and its derivatives."""
    of_short: Array = field(default_factory=lambda: np.zeros(1))
    samples: dict[str, tuple[Array, Array]] = field(default_factory=dict)
    """What the highest value of a driven phase is asked of, at the end of every step, with derivatives."""

    def without_length(self) -> Found:
        """Leave out the last direction."""
        end = self.end.without_length() if self.end is not None else None
        slopes = {name: one[:-1] for name, one in self.slopes.items()}
        samples = {name: (values, of_values[:, :-1]) for name, (values, of_values) in self.samples.items()}
        return Found(self.values, slopes, end, self.short, self.of_short[:-1], samples)

    def add(self, name: str, value: float, slopes: Array) -> None:
        """Add one."""
        self.values[name], self.slopes[name] = float(value), np.asarray(slopes)


class PhaseRun:
    """One run of a phase, at given inputs."""

    def __init__(
        self, phase: PhaseEngine, motion: Motion, registers: tuple[Array, Array, Array], inputs: Array, along: Array
    ) -> None:
        """Nothing is stepped yet; `registers` have the constants in place."""
        self.of, self.motion, self.registers = phase, motion, registers
        self.inputs, self.along, self.lanes = inputs, along, along.shape[1]
        self.instants: list[Instant] = []
        self._seen: dict[tuple[str, ...], Array] = {}
        """Quantities at the ends of the steps, by those that are recorded together."""

    # --- steps ---

    def first(self, start: Instant, pace: float, sought: list[str], horizon: float, tolerance: float) -> Grid:
        """Step as far as the events that are sought, each step as long as its error allows."""
        constant = CurrentProfile.constant(start.current)
        found, _ = self.simulate(start, pace, sought, horizon, constant, tolerance, seek=False)
        times = np.array([one.time for one in self.instants])
        return Grid((np.diff(times) / pace).tolist(), {name: one.step for name, one in found.items()})

    def simulate(
        self, start: Instant, pace: float, sought: list[str], horizon: float, profile: CurrentProfile,
        tolerance: float, deadline: Deadline = NEVER, *, seek: bool = True, throughout: bool = False,
    ) -> tuple[dict[str, Instant], bool]:  # fmt: skip
        """Step as far as the events that are sought, or `throughout`, each step as long as its error allows.

        Returns the instants of the events (with `seek`; else those before the steps in which they are due), and whether
        nothing will change any more. Raises SimulationError where not even the first step can be taken.
        """
        start = replace(start, current=float(profile.at(np.zeros(1))[0]))
        found = {name: start for name in sought if self._gap(name, start.state, start.current) >= 0.0}
        self.instants, h = [start], FIRST * pace
        y, ahead, one = start.state.copy(), np.zeros(start.state.size), start
        nothing, settled = np.zeros((y.size, self.lanes)), False
        while one.time < horizon and len(self.instants) <= MOST_STEPS and not settled:
            if len(found) == len(sought) and not throughout:
                break
            deadline.check("the working cycle of a design was simulated")
            room = min(profile.next_corner(one.time), horizon) - one.time
            least, whole = (room, False) if h > 0.999 * room else (h, True)
            end = float(profile.at(np.array([one.time + least]))[0])
            slope = (end - one.current) / least
            length, following = adapted(
                self.motion.system, self.registers[2], y, one.current, slope, least, tolerance, ahead
            )
            if length == 0.0:
                if len(self.instants) == 1:
                    name = self.of.phase.phase.name
                    raise SimulationError(f"the {name} of this design cannot be simulated; check its inputs")
                break
            h = following if whole or length < least else max(following, h)
            current = one.current + slope * length
            other = Instant(one.time + length, one.of_time, y.copy(), nothing, current, one.of_current, one.step + 1)
            self.instants.append(other)
            for name in sought:
                if name not in found and self._gap(name, other.state, current) >= 0.0:
                    found[name] = self._crossing(name, one, other, slope) if seek else other
            if slope == 0.0 and not throughout and np.isinf(profile.next_corner(other.time)):
                settled = bool(np.max(np.abs(self._rates(other)[: self.of.size])) * (horizon - other.time) < STALLED)
            one = other
        return found, settled

    def search(self, start: Instant, pace: float, dpace: Array, sought: list[str], grid: Grid) -> dict[str, Instant]:
        """Step along a grid to where each event first is due."""
        shares = np.array(grid.shares)
        if len(shares):
            shares = np.append(shares, shares[-1] * GROWTH ** np.arange(1, EXTRA + 1))
        self.instants = [start]
        steps = _Steps(start, shares * pace, shares[:, None] * dpace)
        found: dict[str, Instant] = {}
        for name in sorted(sought, key=grid.events.__getitem__):
            k = grid.events[name]
            while 0 <= k < len(shares):
                if not self._advanced(steps, k + 1):
                    return found
                if self._gap_at(name, k) >= 0.0:
                    k -= 1
                elif self._gap_at(name, k + 1) < 0.0:
                    k += 1
                else:
                    found[name] = self._crossing(name, self.instants[k], self.instants[k + 1])
                    break
            if k < 0:
                found[name] = start
        return found

    def _advanced(self, steps: _Steps, count: int) -> bool:
        """Whether so many steps could be taken."""
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

    # --- events ---

    def _gap(self, name: str, y: Array, current: float) -> float:
        return self.of.value(name, y, current, self.inputs)

    def _gap_at(self, name: str, k: int) -> float:
        return self._gap(name, self.instants[k].state, self.instants[k].current)

    def _rates(self, now: Instant) -> Array:
        (rates,) = self.motion.rates.values(now.state, np.array([now.current]), self._constants)
        return rates

    @cached_property
    def _constants(self) -> Array:
        first = self.motion.size + 1
        return self.registers[0][first : int(self.motion.rates.arguments[-1])]

    def _crossing(self, name: str, one: Instant, other: Instant, slope: float = 0.0) -> Instant:
        """The instant at which an event is due, between the ends of two steps in which the current has a `slope`.

        The last step ends there: its length is sought by Newton's method, whose slope is one more direction.
        """
        whole = other.time - one.time
        here, there = self._rates(one) * whole, self._rates(other) * whole

        def between(share: float) -> Array:
            return _hermite(share, one.state, other.state, here, there)

        length = whole * _root(lambda share: self._gap(name, between(share), one.current + slope * share * whole))
        least, most = 0.0, 1.05 * whole
        nowhere = np.zeros((len(self.inputs), 1))
        last = other
        for _ in range(MOST_TRIALS):
            guess = 0.4 * (between(length / whole) - one.state)
            last = self._last_step(one, length, slope, guess, self._of_length)
            gap, slopes = self.of.slopes(name, last, self.inputs, nowhere)
            least, most = (length, most) if gap < 0.0 else (least, length)
            short = -gap / slopes[0]
            if abs(short) <= NEAR * whole:
                if self.lanes > 1 and length + short > 0.0:  # values miss the square of what is left, slopes all of it
                    length += short
                break
            length = length + short if least < length + short < most else 0.5 * (least + most)
        if self.lanes > 1:
            last = self._last_step(one, length, slope, 0.4 * (last.state - one.state), self.registers)
        gap, slopes = self.of.slopes(name, last, self.inputs, self.along)
        short, longer = -gap / slopes[-1], -slopes / slopes[-1]
        longer[-1] = 0.0
        by_length, s = last.of_state[:, -1:].copy(), last.of_state
        s[:, -1] = 0.0
        of_current = last.of_current + slope * longer
        of_current[-1] = 0.0
        return replace(
            last, time=one.time + length + short, of_time=one.of_time + longer,
            state=last.state + short * by_length[:, 0], of_state=s + by_length * longer,
            current=last.current + slope * short, of_current=of_current,
        )  # fmt: skip

    @cached_property
    def _of_length(self) -> tuple[Array, Array, Array]:
        """Registers for the length of the last step as the one direction."""
        return self.motion.registers(self._constants, np.zeros((len(self._constants), 1)))

    def _last_step(
        self, one: Instant, length: float, slope: float, guess: Array, registers: tuple[Array, Array, Array]
    ) -> Instant:
        """The instant after a last step; the last direction is its length."""
        lanes = registers[1].shape[1]
        y, s = one.state.copy(), one.of_state[:, -lanes:].copy()
        longer = np.zeros(lanes)
        longer[-1] = 1.0
        u = one.current + slope * TIMES * length
        du = one.of_current[-lanes:] + slope * TIMES[:, None] * longer
        step(self.motion.system, *registers, y, s, u, du, length, longer, guess)
        return Instant(one.time + length, longer, y, s, float(u[-1]), du[-1], one.step + 1)

    # --- what is asked of the phase ---

    def add_paths(self, found: Found, wanted: Collection[str] | None) -> None:
        """Add what the phase adds up to, is at its end, or reaches; of a phase without an end, what it reaches."""
        end = found.end or self.instants[-1]
        passed = self.passed(end)
        self._seen = {}
        for row in self.of.phase.paths:
            if (wanted is not None and row.name not in wanted) or (row.reduce != "maximum" and found.end is None):
                continue
            if row.reduce == "integral":
                place = self.of.size + self.of.lip + self.of.integrals.index(row.name)
                found.add(row.name, end.state[place], end.of_state[place])
            elif row.reduce == "end":
                found.add(row.name, *self.of.slopes(row.name, end, self.inputs, self.along))
            else:
                found.add(row.name, *self._highest(row.name, passed))

    def add_samples(self, found: Found, wanted: Collection[str] | None) -> None:
        """Add every quantity whose highest value is asked of, at the end of every step."""
        for row in self.of.phase.paths:
            if row.reduce == "maximum" and (wanted is None or row.name in wanted):
                every = [self.of.slopes(row.name, one, self.inputs, self.along) for one in self.instants]
                values, slopes = zip(*every, strict=True)
                found.samples[row.name] = np.array(values), np.array(slopes)

    def _highest(self, name: str, passed: list[Instant]) -> tuple[float, Array]:
        """The maximum of a quantity up to the end; between two steps it is looked for along cubics."""
        group, place = self.of.together[name]
        if group not in self._seen:
            self._seen[group] = self.of.values(group, passed, self.inputs)
        values = self._seen[group][:, place].copy()
        k = int(np.argmax(values))
        best = passed[k]
        if k < len(passed) - 1:
            for first in range(max(k - 1, 0), k + 1):
                one, other = passed[first], passed[first + 1]
                share, value = _peak(self._along_cubic(name, one, other))
                if value > values[k]:
                    best, values[k] = self._between(one, other, share), value
        return self.of.slopes(name, best, self.inputs, self.along)

    def passed(self, end: Instant) -> list[Instant]:
        """The ends of the steps up to an instant."""
        return [*self.instants[: end.step + 1], end] if end.step >= 0 else [end]

    def sampled(self, end: Instant, least: int) -> tuple[Array, Array, Array]:
        """Times, states (a column each) and currents up to an instant, no fewer than so many: cubics between steps."""
        passed = self.passed(end)
        each = max(-(-least // max(len(passed) - 1, 1)), 1)
        shares = np.arange(each) / each
        times, states, currents = [], [], []
        for one, other in pairwise(passed):
            length = other.time - one.time
            here, there = self._rates(one) * length, self._rates(other) * length
            for share in shares:
                times.append(one.time + share * length)
                states.append(_hermite(share, one.state, other.state, here, there))
                currents.append(one.current + share * (other.current - one.current))
        times, states, currents = [*times, end.time], [*states, end.state], [*currents, end.current]
        return np.array(times), np.array(states).T[: self.of.size], np.array(currents)

    def _along_cubic(self, name: str, one: Instant, other: Instant) -> Callable[[float], float]:
        """A quantity as a function of the share of a step."""
        length, rise = other.time - one.time, other.current - one.current
        here, there = self._rates(one) * length, self._rates(other) * length
        return lambda share: self._gap(
            name, _hermite(share, one.state, other.state, here, there), one.current + share * rise
        )

    def _between(self, one: Instant, other: Instant, share: float) -> Instant:
        """The instant at a share of a step, along cubics."""
        length, of_length = other.time - one.time, other.of_time - one.of_time
        rates = [self._moving(now) for now in (one, other)]
        here, there = (rate * length for rate, _ in rates)
        of_here, of_there = (of_rate * length + rate[:, None] * of_length for rate, of_rate in rates)
        return Instant(
            one.time + share * length, one.of_time + share * of_length,
            _hermite(share, one.state, other.state, here, there),
            _hermite(share, one.of_state, other.of_state, of_here, of_there),
            one.current + share * (other.current - one.current),
            one.of_current + share * (other.of_current - one.of_current), one.step,
        )  # fmt: skip

    def _moving(self, now: Instant) -> tuple[Array, Array]:
        """Rates at an instant, and their tangents."""
        (pair,) = self.motion.rates.tangents(
            (now.state, np.array([now.current]), self._constants),
            (now.of_state, now.of_current[None], self._of_constants),
        )
        return pair

    @property
    def _of_constants(self) -> Array:
        return self.registers[1][self.motion.size + 1 : int(self.motion.rates.arguments[-1])]

    def add_steadies(self, found: Found, wanted: Collection[str] | None) -> None:
        """Add what it takes to stay where the phase has ended."""
        rows = [row.name for row in self.of.phase.steadies if wanted is None or row.name in wanted]
        standing = self.standing(found.end) if rows and found.end is not None else None
        if standing is None:
            return
        for name in rows:
            found.add(name, *self.of.slopes(name, standing, self.inputs, self.along))

    def standing(self, end: Instant) -> Instant | None:
        """State and current that stay, with their tangents; None where there are none.

        The current is sought at which the event that ends the phase stays due; at each, the state that stays. Newton's
        method is kept between currents that are too small and too large, and their middle is taken where it gains
        little: what stays may change steeply where a part of the layer melts.
        """
        ends, size = self.of.phase.phase.ends, self.of.size
        y, current = end.state.copy(), end.current
        of_current = np.append(np.zeros(self.lanes), 1.0)
        along = np.column_stack([self.along, np.zeros(len(self.along))])
        too_small, too_large, before = np.nan, np.nan, np.inf
        for _ in range(60):
            settled = self._settle(y, current)
            if settled is None:  # with so much current it never stops heating up
                least = 0.0 if np.isnan(too_small) else too_small
                if abs(current - least) < 1e-3:
                    return None
                too_large, current = current, 0.5 * (least + current)
                continue
            y, s = settled
            now = Instant(0.0, of_current, y, s, current, of_current)
            gap, slopes = self.of.slopes(ends, now, self.inputs, along)
            if not np.isfinite(gap) or slopes[-1] == 0.0:
                return None
            room = 0.5 * abs(current) + 0.05
            change = float(np.clip(-gap / slopes[-1], -room, room))
            if abs(change) < 1e-9 * max(1.0, abs(current)):
                moved = -slopes[:-1] / slopes[-1]
                return Instant(0.0, moved, y, s[:, :-1] + s[:, -1:] * moved, current, moved)
            too_small, too_large = (current, too_large) if gap < 0.0 else (too_small, current)
            inside = min(too_small, too_large) < current + change < max(too_small, too_large)
            if abs(change) > 0.5 * before or not inside:
                middle = 0.5 * (too_small + too_large) - current
                change = change if np.isnan(middle) else middle
            y[:size] += change * s[:size, -1]
            current, before = current + change, abs(change)
        return None

    def _settle(self, y: Array, current: float) -> tuple[Array, Array] | None:
        """The state that stays at a current, and its tangents; along the current as the last."""
        m, (_, _, v) = self.motion.system, self.registers
        entries, size = np.empty(m.pattern.size), self.of.size + self.of.lip
        order = m.pattern.order
        y = y.copy()

        def solved(right: Array) -> Array:
            b = np.ascontiguousarray(right[order])
            b[order >= size] = 0.0
            solve_many(m.pattern, entries, b)
            found = np.empty_like(b)
            found[order] = b
            found[size:] = 0.0
            return found

        for _ in range(40):
            newton_matrix(m, v, y, current, STANDING, -1.0, entries)
            change = solved(-v[m.slope_rates][:, None])[:, 0]
            if not np.all(np.isfinite(change)):
                return None
            largest = float(np.max(np.abs(change)))
            y += change * min(1.0, 0.5 / max(largest, 1e-12))
            if largest < 1e-9:
                break
        else:
            return None
        nothing, of_current = np.zeros((y.size, self.lanes + 1)), np.append(np.zeros(self.lanes), 1.0)[None]
        of_constants = np.column_stack([self._of_constants, np.zeros(len(self._of_constants))])
        ((_, by),) = self.motion.rates.tangents(
            (y, np.array([current]), self._constants), (nothing, of_current, of_constants)
        )
        newton_matrix(m, v, y, current, STANDING, -1.0, entries)
        return y, solved(-by)


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


def _hermite(share: float, one: Array, other: Array, here: Array, there: Array) -> Array:
    """A cubic between two states, whose slopes over the step are given."""
    left = 1.0 - share
    whole = one * left**2 * (1.0 + 2.0 * share) + other * share**2 * (3.0 - 2.0 * share)
    return np.asarray(whole + share * left * (here * left - there * share))


def _root(function: Callable[[float], float]) -> float:
    """Where a function of a share of a step passes zero, about: by regula falsi (Illinois)."""
    low, high, below, above = 0.0, 1.0, function(0.0), function(1.0)
    if above <= 0.0:
        return 1.0
    share, side = 1.0, 0
    for _ in range(12):
        share = (low * above - high * below) / (above - below)
        value = function(share)
        if abs(value) < 1e-6 * (above - below) or high - low < 1e-6:
            return share
        if value < 0.0:
            low, below, above = share, value, above * (0.5 if side == -1 else 1.0)
            side = -1
        else:
            high, above, below = share, value, below * (0.5 if side == 1 else 1.0)
            side = 1
    return share


def _peak(function: Callable[[float], float]) -> tuple[float, float]:
    """Where a function of a share of a step is highest, and how high: by samples, then by ever narrower parabolas.

    There the function hardly changes with the share, so that its slope at a share that stays is that of the peak.
    """
    shares = np.linspace(0.0, 1.0, 9)
    values = np.array([function(one) for one in shares])
    k = int(np.argmax(values))
    share, value, width = float(shares[k]), float(values[k]), 0.125
    if 0 < k < 8:
        below, above = float(values[k - 1]), float(values[k + 1])
        for _ in range(MOST_PARABOLAS):
            bend = 2.0 * value - below - above
            if not bend > 0.0:
                break
            moved = 0.5 * width * (above - below) / bend
            share, width = share + moved, NARROW
            value = function(share)
            if not abs(moved) > NARROW:
                break
            below, above = function(share - width), function(share + width)
        if value > values[k]:
            return share, value
    return float(shares[k]), float(values[k])
