"""One phase of the working cycle for a block of designs, stepped together, each to its own events."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tvimdesign.engine import lane_events, lanes
from tvimdesign.engine.lane_events import NOWHERE
from tvimdesign.engine.lanes import evaluate, lanes_of
from tvimdesign.engine.tape import Tape
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_engine import Watch
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions

Array = NDArray[np.float64]

Course: TypeAlias = list[tuple[float, Array]]  # Moments [s] with the states at each, a column a design
_WINDOW = 2  # Steps after which events are looked for, once the study's own design would have ended


@dataclass
class Passage:
    """A block of designs at the end of a phase."""

    values: dict[str, Array]  # Events, paths and steady rows by name
    end: Array  # State at the event that ends the phase, a column each; NaN where that never happens


class PhaseKernel:
    """One phase of one model as a function of its moving inputs."""

    def __init__(
        self, model: DeviceFunctions, phase: PhaseFunctions, moving: Sequence[str], events: Sequence[str],
        paths: Sequence[str], steadies: Sequence[str], steps: "Steps",
    ) -> None:  # fmt: skip
        """Record the motion, and what is looked at: all of it, as threads share it later."""
        self.engine, self.steps, self.after = model.engines[phase.phase.name], steps, phase.phase.after
        self.events, self.steadies = list(events), list(steadies)
        reduced = {row.name: row.reduce for row in phase.paths if row.name in paths}
        self.integrals, self.highest, self.at_end = (
            [name for name, reduce in reduced.items() if reduce == reduction]
            for reduction in ("integral", "maximum", "end")
        )
        self.ends = phase.phase.ends if phase.phase.ends in self.events else None
        self.horizon = float(model.start[model.index["horizon"]])
        self.start = model.start
        self._moving = np.array([model.index[name] for name in moving], dtype=np.int64)
        self.size = self.engine.size
        self._current = model.index[phase.phase.current_input], phase.phase.sign
        self.motion, self._given = self.engine.recorded
        self._begin = self.engine.start if self.after else None
        for names in (*([name] for name in self.events), self.highest, self.at_end, self.steadies):
            if names:
                self.engine.watch(*names)

    def begin(self, columns: Array, before: Array | None) -> tuple[Array, Array, Array]:
        """Return current, constants of the motion and first states of some designs."""
        results = self._evaluated(self._given, columns, self._moving, 0)
        count = len(self._given.results[0])
        constants, first = results[:count], results[count + 1 :]
        if before is not None and self._begin is not None:
            size = int(self._begin.arguments[1])
            places = np.concatenate([np.arange(size), size + self._moving])
            first = self._evaluated(self._begin, np.concatenate([before[:size], columns]), places, size)
        place, sign = self._current
        moved = np.flatnonzero(self._moving == place)
        current = columns[moved[:1]] if len(moved) else np.full((1, columns.shape[1]), self.start[place])
        return sign * current, constants, first

    def _evaluated(self, tape: Tape, given: Array, places: NDArray[np.int64], inputs_from: int | None = None) -> Array:
        """Results of a tape one below the other; its inputs may begin at a register, as drawn where not given."""
        w = lanes_of(tape)
        if inputs_from is not None:
            w[inputs_from : inputs_from + len(self.start)] = self.start[:, None]
        results = np.concatenate(tape.results)
        evaluated = np.empty((len(results), given.shape[1]))
        evaluate(tape.code, w, places, given, results, evaluated, 0, given.shape[1])
        return evaluated

    def watched(self, names: Sequence[str], states: Array, currents: Array, columns: Array) -> Array:
        """Quantities of designs at an instant, or at some one after the other, a row each."""
        watch, instants = self.engine.watch(*names), states.shape[1] // columns.shape[1]
        constants = np.concatenate([currents, self.constants(watch, columns)])
        given = np.concatenate([states[: self.size], np.tile(constants, instants)])
        return self._evaluated(watch.at, given, np.arange(len(given)))

    def constants(self, watch: Watch, columns: Array) -> Array:
        """Return what quantities take from the inputs of some designs."""
        return self._evaluated(watch.given, columns, self._moving, 0)

    def run(
        self, columns: Array, before: Array | None, pace: float, balance: Array | None, fit: "Fit | None" = None,
        keep: Course | None = None, until: float = np.inf,
    ) -> Passage:  # fmt: skip
        """Go through the phase; `before` are the states it starts from, where that is not everything at ambient.

        Every step on the way is added to `keep`. Designs that have not ended `until` then are given up.
        """
        lengths = (fit.steps if fit else self.steps).lengths(pace, LONGEST * min(self.horizon, until))
        run = _Run(self, columns, before, lengths, fit.scales(columns) if fit else np.ones(columns.shape[1]))
        shares = fit.shares if fit else {}
        run.go(
            {name: int(np.searchsorted(run.times[1:], 0.999 * pace * shares.get(name, 1.0))) for name in self.events}
        )
        if keep is not None:
            keep += [(float(run.times[k] * run.scales[0]), run.states[k, : self.size]) for k in range(run.reached + 1)]
        values = {name: run.at[name] for name in self.events}
        values |= run.reduced()
        if self.steadies:
            values |= self._at_rest(run, balance)
        return Passage(values, run.end[: self.size])

    def _at_rest(self, run: "_Run", balance: Array | None) -> dict[str, Array]:
        """Steady rows, from the balance of the study's own design; infinite where Newton finds none."""
        count = run.count
        if balance is None or self.ends is None:
            return dict.fromkeys(self.steadies, np.full(count, np.inf))
        staying = self.size + self.engine.lip
        state, currents = np.nan_to_num(run.end[:staying]), np.full(count, balance[-1])
        state[: self.size] = balance[:-1, None]
        exists, watch = np.zeros(count, dtype=bool), run.watches[self.ends]
        lane_events.settle(
            run.motion.system, run.room.slopes, run.room.rates, run.places, run.given, watch.code, watch.registers,
            watch.result, watch.places, watch.given, self.size, state, currents, exists,
        )  # fmt: skip
        steady = self.watched(self.steadies, state, currents[None], run.columns)
        exists &= ~np.isnan(run.end[0])
        return {name: np.where(exists, steady[i], np.inf) for i, name in enumerate(self.steadies)}


class _Event:
    """An event that a block of designs is watched for."""

    def __init__(self, phase: PhaseKernel, name: str, current: Array, columns: Array) -> None:
        watch, count = phase.engine.watch(name), columns.shape[1]
        self.code, self.result = watch.at.code, int(watch.at.results[0][0])
        self.registers = lanes_of(watch.at)
        self.given = np.concatenate([current, phase.constants(watch, columns)])  # Current and constants of each design
        self.places = phase.size + np.arange(len(self.given))
        self.low, self.high = np.full(count, -1), np.full(count, NOWHERE)
        """The last step after which it has not happened, the first after which it has, by design."""
        self.below, self.above = np.full(count, np.nan), np.full(count, np.nan)


class _Run:
    """A block of designs on its way through a phase."""

    def __init__(self, phase: PhaseKernel, columns: Array, before: Array | None, lengths: Array, scales: Array) -> None:
        self.phase, self.lengths, self.scales = phase, lengths, scales
        self.times = np.concatenate([[0.0], np.cumsum(lengths)])
        self.motion = phase.motion
        self.room = lanes.Room(self.motion)
        self.count = columns.shape[1]
        current, constants, first = phase.begin(columns, before)
        self.given = np.concatenate([current, constants])
        self.places = np.arange(self.motion.size, self.motion.size + len(self.given))
        self.current, self.columns = current, columns
        self.states = np.zeros((1, self.motion.size, self.count))  # By step, as far as `reached`
        self.states[0, : phase.size] = first
        self.reached = 0
        self.lost = np.isnan(first[0])
        self.watches = {name: _Event(phase, name, current, columns) for name in phase.events}
        self.at: dict[str, Array] = {}  # When each event happens, infinite where it never does
        self.end = np.full((self.motion.size, self.count), np.nan)
        self.last = np.full(self.count, NOWHERE)  # The step in which the phase ends; -1 at the start

    def go(self, expected: Mapping[str, int]) -> None:
        """Step until every design has come to all events, or is lost, most of them at a step; find when."""
        open_still, last = ~self.lost, max(expected.values(), default=0) + 1
        while self.reached < len(self.lengths) and open_still.any():
            self._march(min(max(_WINDOW, last - self.reached), len(self.lengths) - self.reached), open_still)
            self.lost |= np.isnan(self.states[self.reached, 0])
            waiting = np.zeros(self.count, dtype=bool)
            for name, watch in self.watches.items():
                lane_events.search(
                    watch.code, watch.registers, watch.result, watch.places, watch.given, self.states,
                    self.phase.size, self.reached, expected[name], watch.low, watch.high, watch.below, watch.above,
                )  # fmt: skip
                waiting |= watch.high == NOWHERE
            open_still = waiting & ~self.lost
        for name, watch in self.watches.items():
            self._cross(name, watch)

    def _march(self, steps: int, busy: NDArray[np.bool_]) -> None:
        if self.reached + steps >= len(self.states):
            longer = np.empty((self.reached + steps + 1 + len(self.states) // 2, *self.states.shape[1:]))
            longer[: len(self.states)] = self.states
            self.states = longer
        lanes.march(
            self.motion.system, self.room.slopes, self.places, self.given, self.states, self.lengths, self.scales,
            self.reached, self.reached + steps, busy,
        )  # fmt: skip
        self.reached += steps

    def _cross(self, name: str, watch: _Event) -> None:
        """Find when an event happens in the step that it happens in."""
        started, passed = watch.high == 0, (watch.high != NOWHERE) & (watch.high > 0)
        shares, ends = np.zeros(self.count), np.empty(self.states.shape[1:])
        ends[:, started] = self.states[0][:, started]
        lane_events.cross(
            self.motion.system, self.room.slopes, self.room.rates, self.places, self.given, self.states,
            self.lengths[: self.reached], self.scales, watch.code, watch.registers, watch.result, watch.places,
            watch.given, self.phase.size, passed, watch.low, watch.below, watch.above, shares, ends,
        )  # fmt: skip
        step = np.clip(watch.low, 0, len(self.lengths) - 1)
        times = np.where(started, 0.0, self.scales * (self.times[step] + shares * self.lengths[step]))
        passed &= times <= self.phase.horizon
        self.at[name] = np.where(started | passed, times, np.inf)
        if name == self.phase.ends:
            ended = started | passed
            self.end[:, ended], self.last[ended] = ends[:, ended], watch.low[ended]

    def reduced(self) -> dict[str, Array]:
        """Paths by name: what they add up to or are at the end, and what they reach on the way."""
        phase, never = self.phase, np.isnan(self.end[0])
        first = phase.size + phase.engine.lip
        values_by_name = {name: self.end[first + phase.engine.integrals.index(name)] for name in phase.integrals}
        if phase.at_end:
            ended = phase.watched(phase.at_end, self.end, self.current, self.columns)
            values_by_name |= dict(zip(phase.at_end, ended, strict=True))
        values_by_name = {name: np.where(never, np.inf, values) for name, values in values_by_name.items()}
        if phase.highest:
            values_by_name |= dict(zip(phase.highest, self._highest(), strict=True))
        return values_by_name

    def _highest(self) -> Array:
        """Return the highest values of quantities up to the end of the phase, or on their way if it has no end.
        Between two steps they follow a parabola.
        """
        phase, steps = self.phase, self.reached + 1
        states = np.concatenate([*self.states[:steps], self.end], axis=1)
        values = phase.watched(phase.highest, states, self.current, self.columns).reshape(-1, steps + 1, self.count)
        ended = ~np.isnan(self.end[0])
        after = np.arange(steps)[:, None] > np.where(ended, self.last, steps)
        values[:, :-1] = np.where(after, values[:, -1:], values[:, :-1])
        values[:, -1] = np.where(ended, values[:, -1], values[:, -2])
        end = np.where(ended, self.at[phase.ends] if phase.ends else np.inf, self.times[self.reached] * self.scales)
        times = np.concatenate([np.where(after, end, self.times[:steps, None] * self.scales), end[None]])
        return np.where(self.lost & ~ended, np.inf, _peak(times, values))


def _peak(times: Array, values: Array) -> Array:
    """Return the maximum of samples, one moment a row, by a parabola through the highest and its two neighbours."""
    k = np.argmax(values, axis=1)[:, None]
    middle = np.clip(k, 1, values.shape[1] - 2)
    (a, u), (b, v), (c, w) = (
        (np.take_along_axis(times[None], middle + i, 1), np.take_along_axis(values, middle + i, 1)) for i in (-1, 0, 1)
    )
    with np.errstate(all="ignore"):
        rising, falling = (v - u) / (b - a), (w - v) / (c - b)
        bend = (falling - rising) / (c - a)
        slope = rising + bend * (b - a)
        over = np.where((k == middle) & (bend < 0.0) & (c > b), -0.25 * slope**2 / bend, 0.0)
    peaks: Array = (np.take_along_axis(values, k, 1) + over)[:, 0]
    return peaks


_LATE, _GROWTH = 2.0, 1.07
"""Times the pace after which steps grow, for the designs that have not ended, and by how much each."""
LONGEST = 2.0  # How much longer or shorter than another a design is taken to be at most


@dataclass(frozen=True)
class Steps:
    """Division of time into steps."""

    of_pace: int  # Steps in the time the study's own design takes
    first: float  # Length of the first step over the others'
    growth: float  # Ratio of each of the first steps to the one before

    def lengths(self, pace: float, horizon: float) -> Array:
        """Return the lengths of all steps up to the horizon."""
        usual = pace / self.of_pace
        step, time, taken = self.first * usual, 0.0, list[float]()
        while time < horizon:
            taken.append(min(step, horizon - time))
            time += taken[-1]
            step = step * _GROWTH if time > _LATE * pace else min(self.growth * step, usual)
        return np.array(taken)


@dataclass(frozen=True)
class Fit:
    """Course of designs near a given one through a phase."""

    steps: Steps
    about: Array  # Moving inputs of that one
    slopes: Array  # By how much the time of a phase changes with each, both as shares
    shares: Mapping[str, float]  # When each event happens, as a share of that time

    def scales(self, columns: Array) -> Array:
        """About how long designs take, as a share of the time of that one."""
        off = np.divide(columns, self.about[:, None], out=np.ones(columns.shape), where=self.about[:, None] != 0.0)
        factors: Array = np.clip(1.0 + (self.slopes[:, None] * (off - 1.0)).sum(axis=0), 1.0 / LONGEST, LONGEST)
        return factors
