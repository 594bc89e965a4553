"""Searches around a run of the optimizer: from constant currents, within a longer horizon; ends of ranges.

Where a coil has a whole turn more or less, its legs point as before: each turn has an optimum of its own. Springs and
layer share few limits, so one start may have found the best springs and another the best layer. A current may rest near
its least after the supply's ramp and rise with its first piece, or rise as fast as the supply can: both are optima.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from tvimdesign.device import Input
from tvimdesign.solve.nlp.problem import LATEST
from tvimdesign.solve.nlp.solution import SAME_OPTIMUM, Constant, Start, same_optimum
from tvimdesign.solve.nlp.solver_run import NO_DESIGN, Array, Ends, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Requirement, Study


class ConstantCurrentOptimum:
    """Optimum with constant currents. It is solved first: a search for profiles starts there and
    is compared with it.
    """

    def __init__(self, optimizer: Optimizer) -> None:
        """Set up; do nothing if no current follows a profile."""
        self.optimizer = optimizer.with_constant_currents()
        self.best: Run | None = None

    def beyond(self, begin: Array) -> Array:
        """Inputs of the optimum with constant currents from a start; the start itself where there is none."""
        if self.optimizer is None:
            return begin
        run = self.optimizer.solve(begin=begin)
        if not run.start.converged:
            return begin
        if self.best is None or run.start.objective < self.best.start.objective:
            self.best = run
        return run.inputs

    def optimum(self) -> Constant | None:
        """Return the best simulated optimum with constant currents; None if there is none."""
        if self.optimizer is None or self.best is None:
            return None
        cycle = self.optimizer.simulator.run(self.best.inputs)
        values = self.optimizer.model.values(self.best.inputs, cycle.values)
        inputs = {name: float(self.best.inputs[i]) for name, i in self.optimizer.model.index.items()}
        return Constant(self.best.start.objective, {**inputs, **values})


_AT_IT = 1e-5  # Share of that time within which an event comes as late as it may


def ending_in_time(study: Study, optimizer: Optimizer, run: Run) -> Study | None:
    """Return the study with limits on the times that a run has at the horizon; None if no times or no design."""
    latest = LATEST * float(optimizer.model.start[optimizer.model.index["horizon"]])
    limited = {limit.output for limit in study.require if limit.sense == "<=" and limit.limit <= latest}
    times = run.times
    late = [event for event, time in times.items() if time > latest * (1.0 - _AT_IT) and event not in limited]
    if not late or not run.start.converged:
        return None
    limits = [Requirement(output=event, sense="<=", limit=latest, text="within the horizon") for event in late]
    others = [limit for limit in study.require if limit.sense != "<=" or limit.output not in late]
    return study.model_copy(update={"require": (*others, *limits)})


_NEAR = 1e-3  # Room [of an unknown] beyond which a number is not taken to be at its end, however it presses
_WORSE = 1e-6  # Share by which the objective may rise, as rounding does: else the run is left as it was


def put_at_bounds(optimizer: Optimizer, run: Run) -> Run:
    """Return a converged run with the numbers that press on an end fixed at it and all others solved again.

    At an interior point the room times the multiplier is the barrier's parameter: what presses more than it has room is
    at its end. Multipliers stay those of the run as it was, as a number that is fixed has none.
    """
    pressed = _pressed(optimizer, run)
    if not run.start.converged or not pressed:
        return run
    fixed = optimizer.solve({**run.within, **pressed}, warm=run)
    before, after = run.start.objective, fixed.start.objective
    if not fixed.start.converged or after > before + _WORSE * abs(before):
        return run
    inputs = fixed.inputs.copy()
    for name, (end, _) in pressed.items():
        inputs[optimizer.model.index[name]] = end
    start = replace(run.start, end={**fixed.start.end, **{name: end for name, (end, _) in pressed.items()}})
    return replace(run, start=start, inputs=inputs, current_profiles=fixed.current_profiles, ends=fixed.ends)


def _pressed(optimizer: Optimizer, run: Run) -> dict[str, Ends]:
    """Return the ends that free numbers press on, each twice to fix the number; none that is already fixed."""
    pressed: dict[str, Ends] = {}
    lower, upper = optimizer.vector.bounds(run.within)
    for i, free in enumerate(optimizer.problem.free):
        ends = run.within.get(free.name, (free.lower, free.upper))
        rooms = (run.unknowns[i] - lower[i], upper[i] - run.unknowns[i])
        presses = (-run.bound_multipliers[i], run.bound_multipliers[i])
        for end, room, press in zip(ends, rooms, presses, strict=True):
            if ends[0] < ends[1] and room < min(press, _NEAR):
                pressed[free.name] = (end, end)
    return pressed


SHAKES, SHAKE = 3, 0.1
"""Searches beside the best optimum, and how far off they begin, as a share of each range. One study became 0.6 % better
by one."""
_MOST_CROSSED = 3  # Optima whose parts are put together with the best one's
_SMALLEST_STEP = 0.5  # Share of a period that must be left up to an end of the range for the end to be tried

_LEAST_RAMP = 0.5  # Share of its second node below which the first of a current is on its way there


class NeighboringOptima:
    """Tries what lies beside the ends of the starts, from the states that were found there."""

    def __init__(self, optimizer: Optimizer) -> None:
        self._optimizer = optimizer
        self._periods: dict[int, float] = {}  # By place among the free numbers
        self._parts: dict[str, list[int]] = {}  # Places of the free numbers that shape a part alone
        for place, free in enumerate(optimizer.free):
            row = optimizer.table.by_name.get(free.name)  # a record's share is in no table
            if isinstance(row, Input) and row.period is not None:
                self._periods[place] = row.period
            if isinstance(row, Input) and row.part:
                self._parts.setdefault(row.part, []).append(place)
        self._improved: list[tuple[Run, Run]] = []
        """Optima that starts came to, each with the best one that neighbors led to from there."""

    def improve(self, runs: list[Run]) -> list[Run]:
        """Return each run's best neighbor; if two of them together lead further, add that run."""
        if all(run.start.status == NO_DESIGN for run in runs) or self._optimizer.deadline.passed:
            return runs
        improved = [self._beside(run) for run in runs]
        crossed = self._crossed([run for run in improved if run.start.converged])
        reached = [*improved, crossed] if crossed else improved
        shaken = self._shaken([run for run in reached if run.start.converged])
        return [*reached, shaken] if shaken else reached

    def _shaken(self, optima: list[Run]) -> Run | None:
        """Return the best of random searches a little beside the best optimum; None if none is better.

        Source: Wales and Doye, J. Phys. Chem. A 101 (1997) 5111 (basin hopping).
        """
        optimizer, best = self._optimizer, min(optima, key=lambda run: run.start.objective, default=None)
        if best is None or optimizer.mixtures:
            return None
        random, better = np.random.default_rng(optimizer.study.solver.seed), best
        for _ in range(SHAKES):
            if optimizer.deadline.passed:
                break
            unknowns = optimizer.vector.shaken(better.unknowns, best.within, SHAKE, random)
            begin = optimizer.vector.inputs(unknowns)
            run = optimizer.solve(best.within, begin=begin, unknowns=unknowns, near=True)
            if _better(run, better):
                better = _with_work(run, better, better.start, run.start)
        return None if better is best else better

    def _beside(self, run: Run) -> Run:
        """Return the best run that steps of a period lead to; the run itself if none is better.

        Steps end at an optimum that others were taken from before.
        """
        best, left = run, set[tuple[int, int]]()
        while (end := self._known_end(best)) is None and (better := self._step(best, left)):
            best = better
        if end and not same_optimum(end.start, best.start):
            best = _with_work(end, best, best.start)
        self._improved += [(origin, best) for origin in (run, best) if origin.start.converged]
        return best

    def _known_end(self, run: Run) -> Run | None:
        """Return the best run reached by neighbors of a run's end; None if no steps were taken there."""
        known = (end for begin, end in self._improved if run.start.converged and same_optimum(run.start, begin.start))
        return next(known, None)

    def _step(self, run: Run, left: set[tuple[int, int]]) -> Run | None:
        """Return the first better run beside another, None if none is; do not return to a period that was `left`."""
        left |= {(place, self._periods_in(place, self._value(place, run))) for place in self._periods}
        for place, value in self._values_beside(run):
            if (place, self._periods_in(place, value)) in left or self._optimizer.deadline.passed:
                continue
            unknowns = run.unknowns.copy()
            unknowns[place] = self._optimizer.free[place].to_unknown(value)
            tried = self._optimizer.solve(begin=run.inputs, unknowns=unknowns, near=True)
            if _better(tried, run):
                return _with_work(tried, run, run.start, tried.start)
        return self._ramped_further(run)

    def _ramped_further(self, run: Run) -> Run | None:
        """Return the optimum whose ramps reach half of where currents rise after them; None if none is better.

        That bound, which presses on no optimum worth having, is left out again.
        """
        vector, fixed = self._optimizer.vector, {}
        for current, place in vector.places_of_currents():
            first, second = current.upper * run.unknowns[place][:2]
            if first < _LEAST_RAMP * second:
                fixed[current.row] = (_LEAST_RAMP * second, current.upper)
        if not fixed:
            return None
        bounded = self._optimizer.solve(fixed, begin=run.inputs)
        if not _better(bounded, run):
            return None
        tried = self._optimizer.solve(warm=bounded, begin=run.inputs)
        return _with_work(tried, run, run.start, bounded.start, tried.start) if _better(tried, run) else None

    def _values_beside(self, run: Run) -> Iterator[tuple[int, float]]:
        """Yield each periodic number a period below and above, or at the end of its range if half a period is left."""
        for place, period in self._periods.items():
            free, value = self._optimizer.free[place], self._value(place, run)
            for end, step in ((free.lower, -period), (free.upper, period)):
                room = abs(end - value)
                if room >= _SMALLEST_STEP * period:
                    yield place, value + step if room >= period else end

    def _value(self, place: int, run: Run) -> float:
        """Return the value of the free number at a place at the end of a run."""
        return float(run.inputs[self._optimizer.model.index[self._optimizer.free[place].name]])

    def _periods_in(self, place: int, value: float) -> int:
        return math.floor(value / self._periods[place])

    def _crossed(self, runs: list[Run]) -> Run | None:
        """Return the best design from parts of the best run and of another; None if none is better."""
        optima: list[Run] = []
        for run in sorted(runs, key=lambda run: run.start.objective):
            if not any(same_optimum(run.start, other.start) for other in optima):
                optima.append(run)
        better: Run | None = None
        for other in optima[1 : 1 + _MOST_CROSSED]:
            for whole, lender in ((optima[0], other), (other, optima[0])):
                for places in self._parts.values():
                    run = self._with_part(whole, lender, places)
                    if run.start.converged and _better(run := self._beside(run), better or optima[0]):
                        better = run
        return better

    def _with_part(self, whole: Run, lender: Run, places: list[int]) -> Run:
        """Return a run from the end of another, with one part taken from a third."""
        unknowns = whole.unknowns.copy()
        unknowns[places] = lender.unknowns[places]
        begin = self._optimizer.vector.inputs(unknowns)
        run = self._optimizer.solve(begin=begin, unknowns=unknowns, near=True)
        run.start = replace(run.start, crossed=True)
        return run


def _better(run: Run, other: Run) -> bool:
    """Return whether a run is a different and better optimum than the other."""
    if not (run.start.converged and other.start.converged):
        return run.start.converged
    return run.start.objective < other.start.objective - SAME_OPTIMUM * abs(other.start.objective)


def _with_work(run: Run, before: Run, *parts: Start) -> Run:
    """Return a run with the start of another and the work of the parts that led there."""
    start = replace(
        run.start, begin=before.start.begin, by_neighbor=True, crossed=before.start.crossed,
        iterations=sum(part.iterations for part in parts), seconds=sum(part.seconds for part in parts),
    )  # fmt: skip
    return replace(run, start=start)
