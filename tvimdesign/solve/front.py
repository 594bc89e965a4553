"""Fronts: how far one output can be had at the price of another, by epsilon-constraint on one built problem.

The two ends come first: the least of either output. Between them ceilings on the second output are spread evenly, and
under each the first is made small, from the neighbour. Weights and ceilings are parameters, so nothing is built
twice, for any pair of the outputs the trade-off was set up with.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.catalog import Catalog
from tvimdesign.device import Table
from tvimdesign.errors import SimulationError
from tvimdesign.solve.account import SWITCH_TOLERANCE
from tvimdesign.solve.goal import Goal
from tvimdesign.solve.limits import in_words, on_switch
from tvimdesign.solve.optimizer import ALGEBRAIC_TOLERANCE, EXPAND_FROM, Optimizer, Progress, Run
from tvimdesign.solve.solution import Solution
from tvimdesign.solve.statuses import meaning
from tvimdesign.study import Options, Requirement, Study
from tvimdesign.units import format_quantity

SIDE_WEIGHT = 1e-2
"""Weight of the other output against the one that is made small, both as ratios to the optimum: a front ends where a
hundredth of one buys less than a ten-thousandth of the other, and no point gives anything away."""
OUT_OF_THE_WAY = 100.0
"""A ceiling that is not to be felt, over the usual value of its output."""
ONE_POINT = 2e-3
"""Share by which the ends must differ in both outputs to be a front; less is the simulation's tolerance."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Point:
    """One design of a front. `bound` is its ceiling (SI) on the second output; None at an end and at the optimum."""

    bound: float | None
    values: dict[str, float]
    """Every input and output in SI by full name."""
    drives: dict[str, Any]


@dataclass(frozen=True)
class Failure:
    """A point that was asked for and has no design: its ceiling (SI; None at an end), and why."""

    bound: float | None
    reason: str


@dataclass(frozen=True)
class Front:
    """Designs none of which is better in both outputs, from the least of the first to the least of the second."""

    first: str
    second: str
    points: tuple[Point, ...]
    dominated: tuple[Point, ...] = ()
    """Points that were found and are no better in anything than another one."""
    failures: tuple[Failure, ...] = ()
    notes: tuple[str, ...] = field(default=())


class Tradeoff:
    """One study's problem, built once for some outputs, any of which can be made small under ceilings on the others."""

    def __init__(
        self, study: Study, catalog: Catalog, table: Table, solution: Solution, outputs: Sequence[str],
        progress: Progress = lambda _: None, built: Optimizer | None = None,
    ) -> None:  # fmt: skip
        """Build it around a study's optimum, where every search begins; listed sizes and records stay those found.

        Where what was `built` to find the optimum has a ceiling on every output (`with_ceilings`), it serves again.
        """
        self.table, self.outputs, self.progress = table, tuple(outputs), progress
        self.listed = [name for name, vary in study.vary.items() if isinstance(vary, Options)]
        reference = {name: abs(solution.values[name]) or 1.0 for name in self.outputs}
        if built is None or self.listed or not _serves(built, self.outputs):
            asked = _for_tradeoff(study, solution, self.outputs, self.listed)
            built = Optimizer(asked, catalog, table, EXPAND_FROM, reference)
        self._optimizer = built
        # Weights are over what the problem was built with; a front weighs ratios to the optimum.
        self._weights = {name: built.reference[name] / reference[name] for name in self.outputs}
        self._ceilings = {
            name: min((r.limit for r in study.require if (r.output, r.sense) == (name, "<=")), default=math.inf)
            for name in self.outputs
        }
        index = solution.model.index
        optima = self._optima(solution)
        self._begins = optima if len(optima) > 1 else [self._optimizer.model.start, *optima]
        inputs = {name: float(solution.inputs[i]) for name, i in index.items()}
        drives = {stage: drive.plain() for stage, drive in solution.drives.items()}
        self._optimum = Point(None, {**inputs, **solution.values}, drives)
        self._found = [self._optimum]
        self._ends: dict[str, Point] = {}

    def front(self, first: str, second: str, count: int) -> Front:
        """Trade `second` for `first` at `count` points, both ends included."""
        ends = {name: self._end(name, other) for name, other in ((second, first), (first, second))}
        failed = tuple(end for end in ends.values() if isinstance(end, Failure))
        found = [end for end in ends.values() if isinstance(end, Point)]
        if failed:
            return Front(first, second, tuple(found), failures=failed, notes=("an end has no design",))
        light, quick = found
        if all(_close(light.values[name], quick.values[name]) for name in (first, second)):
            return Front(first, second, (quick,), notes=self._notes(f"one point: {first} and {second} do not conflict"))
        between = self._between(quick, light, first, second, count)
        points = [quick, *(one for one in between if isinstance(one, Point)), light]
        kept, dominated = self._with_optimum(points, first, second)
        failures = tuple(one for one in between if isinstance(one, Failure))
        return Front(first, second, kept, dominated, failures, self._notes())

    def _end(self, name: str, other: str) -> Point | Failure:
        """The least of an output; where another front has that end, from there."""
        known = self._ends.get(name)
        end = self._least(name, other, None, known)
        if isinstance(end, Point):
            self._ends[name] = end
        return end

    def _between(self, quick: Point, light: Point, first: str, second: str, count: int) -> list[Point | Failure]:
        """Points under ceilings spread evenly, each from its quicker neighbour; then back from the light end.

        The two ends may lie in different optima. The way back goes on as long as it finds better.
        """
        bounds = [float(bound) for bound in np.linspace(quick.values[second], light.values[second], count)[1:-1]]
        between: list[Point | Failure] = []
        near = quick
        for number, bound in enumerate(bounds):
            self.progress(f"front of {first} against {second}: point {number + 2} of {count}")
            between.append(self._least(first, second, bound, near))
            near = one if isinstance(one := between[-1], Point) else near
        near = light
        for place in reversed(range(len(bounds))):
            again, there = self._least(first, second, bounds[place], near), between[place]
            if isinstance(again, Failure) or (isinstance(there, Point) and not _better(again, there, first)):
                break
            between[place] = near = again
        return between

    def _with_optimum(
        self, points: Sequence[Point], first: str, second: str
    ) -> tuple[tuple[Point, ...], tuple[Point, ...]]:
        """The points none is better than, and the rest; the study's own optimum joins them where it is one of them."""
        kept, dominated = undominated([*points, self._optimum], (first, second))
        ordered = sorted(kept, key=lambda point: -point.values[second])
        return tuple(ordered), tuple(point for point in dominated if point is not self._optimum)

    def _notes(self, *more: str) -> tuple[str, ...]:
        held = (f"{', '.join(self.listed)} as in the optimum: listed sizes and records are not traded",)
        return (*more, *(held if self.listed else ()))

    def _optima(self, solution: Solution) -> list[Array]:
        """Inputs of every optimum the study's starts came to, the best one first."""
        names, index = self._optimizer.model.names, solution.model.index
        best = np.array([solution.inputs[index[name]] for name in names])
        optima = []
        for start in solution.distinct_optima():
            values = {**dict(zip(names, best, strict=True)), **start.end}
            optima.append(np.array([values[name] for name in names]))
        return [best, *optima[1:]]

    def _least(self, name: str, other: str, bound: float | None, near: Point | None = None) -> Point | Failure:
        """The least of an output below a ceiling on the other one.

        From a point nearby; without one, or where that fails, from all the study's optima, and its start where there is
        one alone. Where a design that was found before keeps the ceiling and is better, this has ended in a worse
        optimum: then also from there.
        """
        ceilings = {**self._ceilings}
        if bound is not None:
            ceilings[other] = min(bound, ceilings[other])
        goal = Goal({name: self._weights[name], other: SIDE_WEIGHT * self._weights[other]}, ceilings)
        found: Point | Failure = Failure(bound, "")
        if near is not None:
            found = self._from([self._inputs(near)], goal, bound)
        if isinstance(found, Failure):
            found = self._from(self._begins, goal, bound)
        keeping = [one for one in self._found if one.values[other] <= ceilings[other]]
        best = min(keeping, key=lambda one: one.values[name], default=None)
        if best and (isinstance(found, Failure) or _better(best, found, name)):
            again = self._from([self._inputs(best)], goal, bound)
            found = again if isinstance(again, Point) else found
        if isinstance(found, Point):
            self._found.append(found)
        return found

    def _inputs(self, point: Point) -> Array:
        return np.array([point.values[name] for name in self._optimizer.model.names])

    def _from(self, begins: Sequence[Array], goal: Goal, bound: float | None) -> Point | Failure:
        """The best design that runs from several inputs come to, or why there is none."""
        runs = [self._optimizer.solve(begin=begin, goal=goal) for begin in begins]
        reason = f"not converged: {meaning(runs[-1].start.status).words}"
        for run in sorted((run for run in runs if run.start.converged), key=lambda run: run.start.objective):
            checked = self._checked(run, goal, bound)
            if isinstance(checked, Point):
                return checked
            reason = checked
        return Failure(bound, reason)

    def _checked(self, run: Run, goal: Goal, bound: float | None) -> Point | str:
        """The design simulated and held against every limit again; in words which one it breaks."""
        optimizer = self._optimizer
        try:
            switch = optimizer.simulator.run(run.inputs, run.drives)
        except SimulationError as error:
            return str(error)
        values = optimizer.model.values(run.inputs, switch.values)
        limits = optimizer.problem.limits
        for limit, room in zip(limits, goal.room(limits), strict=True):
            tolerance = SWITCH_TOLERANCE if on_switch(self.table, limit.output) else ALGEBRAIC_TOLERANCE
            if not limit.residual(values[limit.output]) <= room + tolerance:
                value = format_quantity(values[limit.output], self.table.unit(limit.output))
                return f"converged, but simulated it breaks {in_words(limit, self.table)}: {value}"
        inputs = {name: float(run.inputs[i]) for name, i in optimizer.model.index.items()}
        return Point(bound, {**inputs, **values}, {stage: drive.plain() for stage, drive in run.drives.items()})


def with_ceilings(study: Study, outputs: Iterable[str], usual: Mapping[str, float]) -> Study:
    """The study with a ceiling far above the usual value (SI) of each output that has none, for a front to lower."""
    own = {r.output for r in study.require if r.sense == "<="}
    added = tuple(
        Requirement(output=name, sense="<=", limit=OUT_OF_THE_WAY * usual[name], text="a ceiling of the front")
        for name in outputs
        if name not in own
    )
    return study.model_copy(update={"require": (*study.require, *added)})


def _serves(built: Optimizer, outputs: Iterable[str]) -> bool:
    """Whether a built problem can trade some outputs: fast enough for many runs, each minimised and under a ceiling."""
    under = {limit.output for limit in built.problem.limits if limit.sense == "<="}
    return built.many and set(outputs) <= under & set(built.problem.minimize)


def _for_tradeoff(study: Study, solution: Solution, outputs: Iterable[str], listed: Sequence[str]) -> Study:
    """The study with a ceiling on every output and its listed choices held."""
    own = {r.output for r in study.require if r.sense == "<="}
    added = tuple(
        Requirement(output=name, sense="<=", limit=abs(solution.values[name]) or 1.0, text="a ceiling of the front")
        for name in outputs
        if name not in own
    )
    words, index = solution.model.words, solution.model.index
    held = {
        name: float(solution.inputs[index[name]]) if name in index else getattr(words[name], "name", words[name])
        for name in listed
    }
    return study.model_copy(
        update={
            "module": {**study.module, **held},
            "vary": {name: vary for name, vary in study.vary.items() if name not in held},
            "require": (*study.require, *added),
            "minimize": dict.fromkeys(outputs, 1.0),
        }
    )


def _better(one: Point, other: Point, name: str) -> bool:
    """Whether a point has less of an output than another, by more than the simulation's tolerance."""
    return one.values[name] < other.values[name] * (1.0 - ONE_POINT)


def _close(a: float, b: float) -> bool:
    return abs(a - b) <= ONE_POINT * max(abs(a), abs(b))


def undominated(points: Sequence[Point], names: Sequence[str]) -> tuple[tuple[Point, ...], tuple[Point, ...]]:
    """The points no other one is as good as in every named output (less is better), and the rest; in their order.

    Of points that are equal in all of them the first stays.
    """
    kept: list[Point] = []
    dominated: list[Point] = []
    for i, point in enumerate(points):
        mine = [point.values[name] for name in names]
        others = [[other.values[name] for name in names] for j, other in enumerate(points) if j != i]
        earlier = [[other.values[name] for name in names] for other in points[:i]]
        worse = any(o != mine and all(a <= b for a, b in zip(o, mine, strict=True)) for o in others)
        (dominated if worse or mine in earlier else kept).append(point)
    return tuple(kept), tuple(dominated)
