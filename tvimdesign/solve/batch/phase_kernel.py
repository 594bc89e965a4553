"""One phase of the working cycle for a block of designs: compiled steps, events found by halving, paths added up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.solve.batch.elimination import newton_step
from tvimdesign.solve.batch.kernel import Kernel, stacked

Array = NDArray[np.float64]

Course: TypeAlias = list[tuple[float, Array]]
"""Moments [s] with the states at each, a column a design."""
GAMMA = 1.0 - np.sqrt(0.5)
"""Diagonal of SDIRK2 that makes it L-stable (Alexander, SIAM J. Numer. Anal. 14 (1977) 1006)."""
_LATE = 2.0
"""Times the pace after which steps grow, for the designs that have not ended."""
_GROWTH = 1.3
_NEWTON_OF_BALANCE = 12
_AT_REST = 1e-7


@dataclass(frozen=True)
class Steps:
    """How finely time is divided."""

    of_pace: int
    """Steps in the time the study's own design takes."""
    in_window: int
    """Steps after which events are looked for."""
    close: int
    """Steps into which the one with an event is divided again."""
    first: float = 1.0
    """Length of the first window's steps over the others'."""
    growth: float = 2.0
    """What each window makes the first one's steps longer by, until they are as long as the others."""
    newton: int = 1
    """Newton steps for each phase of the method."""


@dataclass
class Passage:
    """A block of designs at the end of a phase."""

    values: dict[str, Array]
    """Events, paths and steady rows by name."""
    end: Array
    """State at the event that ends the phase, a column each; NaN where that never happens."""


class PhaseKernel:
    """One phase of one model as a function of its moving inputs, compiled."""

    def __init__(
        self,
        model: DeviceFunctions,
        phase: PhaseFunctions,
        moving: Sequence[str],
        events: Sequence[str],
        paths: Sequence[str],
        steadies: Sequence[str],
        steps: Steps,
        often: bool = False,
        deadline: Deadline = NEVER,
    ) -> None:
        """Write and compile the Newton step, what is watched, and what stays the same all through the phase.

        Many more designs go through a phase that is gone through `often` than through others.
        """
        self._deadline = deadline
        self.steps, self.after, self.size = steps, phase.phase.after, phase.state_size
        self.events, self.paths, self.steadies = list(events), list(paths), list(steadies)
        reduced = np.array([row.reduce for row in phase.paths if row.name in paths], dtype=str)
        self.integrals, self.maxima, self.lasts = (reduced == one for one in ("integral", "maximum", "end"))
        self.ends = self.events.index(phase.phase.ends) if phase.phase.ends in self.events else None
        self.horizon = float(model.start[model.index["horizon"]])
        free = ca.SX.sym("moving", len(moving))
        inputs = ca.SX(ca.DM(model.start))
        for i, name in enumerate(moving):
            inputs[model.index[name]] = free[i]
        self._write(phase, free, inputs, phase.phase.sign * inputs[model.index[phase.phase.current_input]], often)

    def _write(self, phase: PhaseFunctions, free: Any, inputs: Any, profile: Any, often: bool) -> None:
        state, base, step = ca.SX.sym("state", self.size), ca.SX.sym("base", self.size), ca.SX.sym("step")
        watched = [_inlined(phase.watch(names), state, profile, inputs) for names in (self.events, self.paths)]
        rates = _inlined(phase.rates, state, profile, inputs)
        every, symbols, expressions = ca.extract_parametric(ca.vertcat(rates, *watched), free)
        bare = [symbol for symbol in ca.symvar(every) if ca.which_depends(symbol, free, 1, True)[0]]
        constants = ca.vertcat(*symbols, *bare)
        last = self.size + len(self.events)
        rates, gaps, samples = every[: self.size], every[self.size : last], every[last:]
        after = newton_step(state, state - base - step * rates)
        before = ca.SX.sym("before", phase.begin.numel_in(0)) if self.after else ca.SX(0, 1)
        begin = (
            phase.begin.call([before, inputs], True, False)[0]
            if self.after
            else phase.initial.call([inputs], True, False)[0]
        )
        self._constants = self._kernel([free], ca.vertcat(*expressions, *bare))
        self._begin = self._kernel([free, before], begin)
        self._newton = self._kernel([state, base, step, constants], after, often)
        # A kernel for each event: one costs a hundred times as much as another, and is asked for until it has come.
        self._gaps = [self._kernel([state, constants], gaps[i]) for i in range(len(self.events))]
        self._samples = self._kernel([state, constants], samples) if self.paths else None
        if self.steadies:
            self._balance(phase, free, inputs)

    def _kernel(self, arguments: Sequence[Any], result: Any, often: bool = False) -> Kernel:
        return Kernel(ca.Function("kernel", list(arguments), [result], {"cse": True}), often, self._deadline)

    def _balance(self, phase: PhaseFunctions, free: Any, inputs: Any) -> None:
        """One Newton step to the steady state in which the ending event stays at zero, and the rows there."""
        unknowns = ca.SX.sym("unknowns", self.size + 1)
        state, profile = unknowns[: self.size], unknowns[self.size]
        equations = ca.vertcat(
            _inlined(phase.rates, state, profile, inputs),
            _inlined(phase.watch([phase.phase.ends]), state, profile, inputs),
        )
        self._rest = self._kernel([unknowns, free], newton_step(unknowns, equations))
        self._steady = self._kernel([unknowns, free], _inlined(phase.watch(self.steadies), state, profile, inputs))

    def run(
        self, columns: Array, before: Array | None, pace: float, balance: Array | None, keep: Course | None = None
    ) -> Passage:
        """Go through the phase; `before` are the states it starts from, where that is not everything at ambient.

        Every step on the way is added to `keep`.
        """
        count = columns.shape[1]
        constants = self._constants(columns)
        state = self._begin(columns if before is None else stacked(columns, before))
        integrate = _March(self, state, constants)
        times = np.full((len(self.events), count), np.inf)
        passage = Passage({}, np.full((self.size, count), np.nan))
        sums = np.full((len(self.paths), count), np.inf)
        lost = np.isnan(state[0])
        begun = integrate.gaps(np.full(times.shape, fill_value=True)) >= 0.0
        times[begun] = 0.0
        if self.ends is not None:
            passage.end[:, begun[self.ends]] = state[:, begun[self.ends]]
            sums[:, begun[self.ends]] = integrate.sums[:, begun[self.ends]]
        usual = pace / self.steps.of_pace
        step = self.steps.first * usual
        while integrate.time < self.horizon and not np.all(np.isfinite(times) | lost):
            open_still = np.isinf(times) & ~lost
            window = integrate.window(min(step, (self.horizon - integrate.time) / self.steps.in_window), open_still)
            if keep is not None:
                keep += [(window.begin + i * window.step, one) for i, one in enumerate(window.states[:-1])]
            passed = open_still & (window.gaps >= 0.0)
            for event in np.flatnonzero(passed.any(axis=1)).tolist():
                here = np.flatnonzero(passed[event])
                found = integrate.close(window, event, here, paths=event == self.ends)
                times[event, here] = found.times
                if event == self.ends:
                    passage.end[:, here], sums[:, here] = found.states, found.sums
            lost |= np.isnan(integrate.state[0])
            step = step * _GROWTH if integrate.time > _LATE * pace else min(self.steps.growth * step, usual)
        # A maximum is one even of a phase that never ends, as in the simulator.
        highest = np.maximum(integrate.sums, -np.inf)
        sums = np.where(np.isinf(sums) & self.maxima[:, None], highest, sums) if self.paths else sums
        passage.values |= dict(zip(self.events, times, strict=True)) | dict(zip(self.paths, sums, strict=True))
        if self.steadies:
            passage.values |= self._at_rest(columns, balance, passage.end)
        return passage

    def _at_rest(self, columns: Array, balance: Array | None, end: Array) -> dict[str, Array]:
        """Steady rows, from the balance of the study's own design; infinite where Newton finds none."""
        count = columns.shape[1]
        if balance is None:
            return dict.fromkeys(self.steadies, np.full(count, np.inf))
        now = np.repeat(balance[:, None], count, axis=1)
        for _ in range(_NEWTON_OF_BALANCE):
            last, now = now, self._rest(stacked(now, columns))
        with np.errstate(invalid="ignore"):
            exists = (np.max(np.abs(now - last), axis=0) < _AT_REST) & ~np.isnan(end[0])
        found = self._steady(stacked(now, columns))
        return {name: np.where(exists, found[i], np.inf) for i, name in enumerate(self.steadies)}


@dataclass
class _Window:
    """Some steps of all designs: states and sums before each, and what the events have come to after the last."""

    begin: float
    step: float
    states: list[Array]
    sums: list[Array]
    gaps: Array


@dataclass
class _Close:
    """What was found where an event is passed, for the designs that passed it."""

    times: Array
    states: Array
    sums: Array


class _March:
    """A block of designs on its way through time, all at the same moment."""

    def __init__(self, phase: PhaseKernel, state: Array, constants: Array) -> None:
        self.phase, self.state, self.constants, self.time = phase, state, constants, 0.0
        self.samples = self._sampled(state, constants)
        integrals = phase.integrals[:, None]
        self.sums = np.where(integrals, 0.0, self.samples)

    def watched(self, state: Array, constants: Array | None = None) -> Array:
        """What the kernels of gaps and samples take."""
        return stacked(state, self.constants if constants is None else constants)

    def _sampled(self, state: Array, constants: Array) -> Array:
        kernel = self.phase._samples
        return kernel(self.watched(state, constants)) if kernel else np.empty((0, state.shape[1]))

    def gaps(self, asked: NDArray[np.bool_]) -> Array:
        """What the events have come to, a row each; no numbers of those that nobody has `asked` of any design."""
        found, watched = np.full(asked.shape, np.nan), self.watched(self.state)
        for event in np.flatnonzero(asked.any(axis=1)).tolist():
            found[event] = self.phase._gaps[event](watched)[0]
        return found

    def window(self, step: float, asked: NDArray[np.bool_]) -> _Window:
        """Go on by some steps; `asked` are the events to look at, by design."""
        begin, states, sums = self.time, [], []
        for _ in range(self.phase.steps.in_window):
            states.append(self.state)
            sums.append(self.sums)
            self.state = self._step(self.state, self.constants, np.full(self.state.shape[1], step))
            before, self.samples = self.samples, self._sampled(self.state, self.constants)
            self.sums = self._added(self.sums, before, self.samples, step)
        self.time = begin + step * self.phase.steps.in_window
        states.append(self.state)
        sums.append(self.sums)
        return _Window(begin, step, states, sums, self.gaps(asked))

    def _added(self, sums: Array, before: Array, now: Array, step: Array | float) -> Array:
        """Integrals by the trapezoid, maxima of the samples, and of what is wanted at the end the last sample."""
        reached = np.where(self.phase.lasts[:, None], now, np.maximum(sums, now))
        return np.where(self.phase.integrals[:, None], sums + 0.5 * step * (before + now), reached)

    def _step(self, state: Array, constants: Array, step: Array) -> Array:
        """One step of SDIRK2: two implicit phases, the second is the result."""
        size, newton = self.phase.size, self.phase._newton
        given = stacked(state, state, GAMMA * step[None, :], constants)
        after = np.empty(state.shape)
        for _ in range(self.phase.steps.newton):
            newton.run(given, after)
            given[:size] = after
        rise = (after - state) / GAMMA
        np.add(state, (1.0 - GAMMA) * rise, out=given[size : 2 * size])
        np.add(state, rise, out=given[:size])
        for _ in range(self.phase.steps.newton):
            newton.run(given, after)
            given[:size] = after
        return after

    def close(self, window: _Window, event: int, here: NDArray[np.intp], paths: bool) -> _Close:
        """Find the moment in a window at which some designs pass an event: halve, then go in smaller steps."""
        constants = self.constants[:, here]
        states = np.array([state[:, here] for state in window.states])
        low = self._halved(states, constants, event)
        column = np.arange(len(here))
        count = self.phase.steps.close
        step = np.full(len(here), window.step / count)
        fine = [states[low, :, column].T]
        for _ in range(count):
            fine.append(self._step(fine[-1], constants, step))
        steps = np.array(fine)
        at = self._halved(steps, constants, event)
        a, b = (self._gap(steps[at + k, :, column].T, constants, event) for k in (0, 1))
        part = np.clip(np.divide(a, a - b, out=np.zeros_like(a), where=a < b), 0.0, 1.0)
        before, after = (steps[at + k, :, column].T for k in (0, 1))
        state = before + part * (after - before)
        times = window.begin + window.step * low + step * (at + part)
        sums = np.array([s[:, here] for s in window.sums])[low, :, column].T
        return _Close(times, state, self._sum_up(sums, steps, at, part, step, state, constants) if paths else sums)

    def _sum_up(
        self, sums: Array, steps: Array, at: Array, part: Array, step: Array, state: Array, constants: Array
    ) -> Array:
        """Sums from the begin of a step that was divided to the event within it."""
        if not len(sums):
            return sums
        samples = [self._sampled(one, constants) for one in steps]
        for k in range(len(samples) - 1):
            sums = np.where(k < at, self._added(sums, samples[k], samples[k + 1], step), sums)
        first = np.array(samples)[at, :, np.arange(len(at))].T
        return self._added(sums, first, self._sampled(state, constants), part * step)

    def _halved(self, states: Array, constants: Array, event: int) -> Array:
        """Index of the last of the states, one after the other, before an event that rises passes zero."""
        count = states.shape[2]
        low, high = np.zeros(count, dtype=int), np.full(count, len(states) - 1)
        while np.any(high - low > 1):
            middle = (low + high) // 2
            passed = self._gap(states[middle, :, np.arange(count)].T, constants, event) >= 0.0
            open_still = high - low > 1
            high = np.where(open_still & passed, middle, high)
            low = np.where(open_still & ~passed, middle, low)
        return low

    def _gap(self, states: Array, constants: Array, event: int) -> Array:
        found: Array = self.phase._gaps[event](self.watched(states, constants))[0]
        return found


def _inlined(function: Any, *arguments: Any) -> Any:
    return ca.densify(function.call(list(arguments), True, False)[0])
