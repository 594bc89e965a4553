"""One study with its records chosen, searched over its listed sizes: its free optima, and the runs within a box."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import islice
from typing import Any

import numpy as np

from tvimdesign.solve.discrete.discrete_choices import Box, Sizes, is_one
from tvimdesign.solve.infeasibility import feasibility_screen
from tvimdesign.solve.infeasibility.conflict_set import second_try
from tvimdesign.solve.infeasibility.feasibility_screen import FeasibilityScreen
from tvimdesign.solve.nlp.mixture import MixedDevice
from tvimdesign.solve.nlp.solution import SAME_OPTIMUM, SolverEffort, same_optimum
from tvimdesign.solve.nlp.solver_run import FEASIBLE, NO_DESIGN, NO_MODULE, TIME_OVER, Array, Ends, Run
from tvimdesign.solve.optimizer.multistart import FEW
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.refinements import ConstantCurrentOptimum, NeighboringOptima, ending_in_time

_CLOSE = 0.02
"""Share of its scale by which the run nearby may violate a limit in the box for a warm run to be tried before it is
asked whether the limits can be met there at all."""


_SAME_RECORDS = 0.5  # Change of a record's share from which on multipliers of a run nearby say nothing any more


@dataclass(eq=False)
class Relaxation:
    """The problem of one choice of records, its free optima, and the work that was done on it."""

    place: int  # Among the trees of a search
    optimizer: Optimizer
    records: dict[str, str]
    sizes: Sizes
    work: SolverEffort
    constant_current_optimum: ConstantCurrentOptimum = field(init=False)
    optima: list[Run] = field(init=False, default_factory=list)
    """A run for each different optimum that the starts came to with every size free, the best first."""
    best: Run | None = field(init=False, default=None)
    """The best run so far that converged with every size from its list."""
    ends: list[Run] = field(init=False, default_factory=list)
    """Where the starts came to instead, if none of them came to an optimum."""
    _runs: dict[tuple[Any, ...], Run] = field(init=False, default_factory=dict)  # Runs by ends and beginning

    def __post_init__(self) -> None:
        self.constant_current_optimum = ConstantCurrentOptimum(self.optimizer)

    @cached_property
    def _screen(self) -> FeasibilityScreen:
        return FeasibilityScreen(self.optimizer)

    def start_infeasible(self) -> bool:
        """Return whether a search from the study's own start finds no design that satisfies the arithmetic limits."""
        return self._screen.impossible({}, [self.optimizer.model.start])

    def starts(self, most: int | None = None) -> list[Run]:
        """Return a run from every start, or `most` of them, with every size free; note which optima differ."""
        runs = NeighboringOptima(self.optimizer).improve(self._from_starts(most))
        self._take(runs)
        return runs

    def _from_starts(self, most: int | None) -> list[Run]:
        runs: list[Run] = []
        count = self.optimizer.study.solver.starts
        for number, begin in enumerate(islice(self.optimizer.multistart.points(), most)):
            if runs and self.optimizer.deadline.passed:
                break
            best = min((earlier.start.objective for earlier in runs if earlier.start.converged), default=None)
            so_far = "" if best is None else f", objective {best:.5g} so far"
            self.optimizer.progress(f"searching: start {number + 1} of {count}{so_far}")
            run = self._from_one_of_each(self.constant_current_optimum.beyond(begin))
            if not run.start.converged and count > FEW and any(earlier.start.converged for earlier in runs):
                run = second_try(self.optimizer, run)
            run.start = replace(run.start, begin=self.optimizer.vector.free_values(begin))
            runs.append(run)
            if not self.sizes.names:
                run.start = replace(run.start, choices=dict(self.records))
                self.note(run)
        return runs

    def from_all_over(self) -> list[Run]:
        """Return runs from designs all over the ranges that keep the arithmetic limits, until two end alike."""
        runs: list[Run] = []
        designs = feasibility_screen.designs_all_over(self.optimizer, lambda inputs: self._mixed(inputs, {}))
        for begin in designs:
            optima = [run.start for run in runs if run.start.converged]
            if self.optimizer.deadline.passed or any(map(same_optimum, optima, optima[1:])):
                break
            run = self._solved({}, begin=begin)
            run.start = replace(run.start, begin=self.optimizer.vector.free_values(begin))
            runs.append(run)
            if ending_in_time(self.optimizer.study, self.optimizer, run) is not None:
                # the switch ends beyond the horizon: the whole search begins again, with a limit
                break
        if any(run.start.converged for run in runs):
            self._take(runs)
        return runs

    def from_other_records(self, others: "Iterable[Relaxation]") -> list[Run]:
        """Return a run from the best optimum with other records, if no start reached an optimum with these.

        Without an optimum every box of sizes is searched, from where the starts broke their limits least.
        """
        best = min((run for other in others for run in other.optima), key=order, default=None)
        if self.optima or best is None or self.optimizer.deadline.passed:
            return []
        ends = best.start.end
        within = [free for free in self.optimizer.free if free.name in ends]
        begin = self.optimizer.model.inputs({f.name: min(max(ends[f.name], f.lower), f.upper) for f in within})
        run = self._from_one_of_each(self._mixed(begin, {}))
        if run.start.converged:
            self._take([run])
        return [run]

    def _take(self, runs: list[Run]) -> None:
        """Keep what different optima some runs came to, or where they ended if they came to none."""
        for run in runs:
            run.start = replace(run.start, choices=dict(self.records), relaxed=bool(self.sizes.names))
        for run in sorted((run for run in runs if run.start.converged), key=order):
            objective = run.start.objective
            if all(abs(objective - o.start.objective) > SAME_OPTIMUM * abs(objective) for o in self.optima):
                self.optima.append(run)
        self.ends = [] if self.optima else runs
        self._sort_records()

    def _from_one_of_each(self, begin: Array) -> Run:
        """Return the best design from a start: first with the records of the largest shares, then with all.

        A search that begins in the middle of a mixture takes several times as long, and ends in worse optima.
        """
        optimizer = self.optimizer
        if not self.sizes.mixtures:
            return optimizer.solve(begin=begin)
        index = optimizer.model.index
        point, ends = begin.copy(), dict[str, Ends]()
        for mixture in self.sizes.mixtures:
            most = max(mixture.shares, key=lambda name: begin[index[name]])
            ends |= {name: (float(name == most),) * 2 for name in mixture.shares}
        for name, (share, _) in ends.items():
            point[index[name]] = share
        point = self._mixed(point, ends)
        alone = optimizer.solve(ends, begin=point)
        if not alone.start.converged:
            return optimizer.solve(begin=begin)
        run = optimizer.solve(begin=alone.inputs, unknowns=alone.unknowns, near=True)
        return run if run.start.converged else optimizer.solve(begin=alone.inputs)

    def _sort_records(self) -> None:
        """Put first the records that the best optimum would have, then those that would cost it least.

        What a share costs is what presses on its lower end: to first order, what an optimum with more of it loses.
        """
        if not self.optima:
            return
        places = {free.name: i for i, free in enumerate(self.optimizer.free)}
        press = self.optima[0].bound_multipliers
        mixtures = []
        for mixture in self.sizes.mixtures:
            costs = [-press[places[name]] for name in mixture.shares]
            mixtures.append(mixture.in_order(sorted(range(len(costs)), key=lambda i: (costs[i], i))))
        self.sizes = self.sizes.mixed(mixtures)

    def choices(self, box: Box) -> dict[str, str | float]:
        """Records and sizes of a box of one."""
        chosen = {**self.records, **self.sizes.records(box)}
        records = {name: chosen[name] for name in self.optimizer.study.module if name in chosen}
        return {**records, **{name: low for name, (low, _) in self.sizes.numbers(box).items()}}

    def values(self, run: Run) -> dict[str, float]:
        """Return the listed numbers at the end of a run, and its place among the records."""
        return self.sizes.values(self._named_inputs(run.inputs))

    @property
    def start_values(self) -> dict[str, float]:
        """Those of the study's start."""
        return self.sizes.values(self._named_inputs(self.optimizer.model.start))

    def _named_inputs(self, inputs: Array) -> dict[str, float]:
        return dict(zip(self.optimizer.model.names, inputs.tolist(), strict=True))

    def best_within(self, box: Box, near: Run | None) -> tuple[Run | None, bool]:
        """Return the best design within a box, warm from a run nearby; if there is none, whether that is certain.

        Certain means that limits which depend on no switch cannot be kept, or that searches from the run nearby and
        from every free optimum all came to points where nothing brings the limits nearer. A warm run that is over
        before it came to such a point leaves a box of several combinations to be divided; of a single one the search
        that begins afresh where it began tells more. A box that will be divided unless a design is found in it is
        searched from one more place: its halves are asked the same.
        """
        ends = self.sizes.ends(box)
        begins = self._begins(ends, near)
        close = near is not None and self._screen.broken(begins[0]) <= _CLOSE
        if not close and self._screened(ends, begins):
            return None, True
        statuses = []
        if near is not None:
            run = self._beside(ends, near, begins[0])
            if run.start.converged:
                return run, True
            if not is_one(box):
                statuses.append(run.start.status)
        if close and self._screened(ends, begins):
            return None, True
        for begin in self._modules(begins):
            divided = not is_one(box) and not {NO_DESIGN, NO_MODULE}.issuperset(statuses)
            run = self._solved(ends, begin=begin)
            if run.start.converged:
                return run, True
            statuses.append(run.start.status)
            if divided and run.start.status != NO_MODULE:
                break
        if all(status == NO_MODULE for status in statuses):
            return self._from_elsewhere(ends)
        return None, all(status == NO_DESIGN for status in statuses)

    def _from_elsewhere(self, ends: Mapping[str, Ends]) -> tuple[Run | None, bool]:
        """Return the best design within some ends if no run could start, from the end of differential evolution.
        If there is none, return whether that is certain: no module exists, or none satisfies the arithmetic limits.
        """
        if self.sizes.mixtures or self.optimizer.deadline.passed:
            return None, False
        seed = self.optimizer.study.solver.seed
        begin, worst = feasibility_screen.least_broken(self.optimizer, self._screen, seed, ends)
        if self.optimizer.deadline.passed:
            return None, False
        if worst >= feasibility_screen.NOWHERE or self._screened(ends, [begin]):
            return None, True
        run = self._solved(ends, begin=begin)
        return (run, True) if run.start.converged else (None, run.start.status == NO_DESIGN)

    def closest(self, box: Box) -> Run:
        """Return a run for one combination, feasible or not."""
        best = self.optima[0] if self.optima else None
        return self._named(self._solved(self.sizes.ends(box), warm=best), box)

    def exactly(self, box: Box, near: Run | None) -> tuple[Run | None, bool]:
        """Return the best design of one combination, its choices named; if there is none, whether that is certain."""
        run, certain = self.best_within(box, near)
        return (run and self._named(run, box)), certain

    def thoroughly(self, box: Box, near: Run | None) -> Run | None:
        """Return the best design of one combination: warm from a run nearby, cold from optima and start.

        A walk from neighbour to neighbour may end in a worse optimum and stay there; what begins afresh does not.
        """
        ends = self.sizes.ends(box)
        begins = self._begins(ends, None)
        runs = [self._solved(ends, warm=near)] if near else []
        runs += [self._solved(ends, begin=begin) for begin in begins]
        best = min(runs, key=order)
        return self._named(best, box) if best.start.converged else None

    def _modules(self, begins: Sequence[Array]) -> list[Array]:
        """Those of some inputs at which there is a module, all where there is at none: no search begins at others."""
        return [begin for begin in begins if np.isfinite(self._screen.broken(begin))] or list(begins)

    def _screened(self, ends: Mapping[str, Ends], begins: Sequence[Array]) -> bool:
        """Return whether the limits that depend on no switch cannot be satisfied from any of some inputs.

        Nor from the best of many points drawn in the box: other optima mostly lie outside it, and are put to its edge.
        """
        if not self._screen.impossible(ends, self._modules(begins)):
            return False
        begin, worst = feasibility_screen.best_drawn(self.optimizer, self._screen, ends)
        if worst <= 0.0 or not self._screen.impossible(ends, [self._mixed(begin, ends)]):
            return False
        self.work.screened += 1
        return True

    def _named(self, run: Run, box: Box) -> Run:
        run.start = replace(run.start, choices=self.choices(box))
        self.note(run)
        return run

    def note(self, run: Run) -> None:
        """Keep the best."""
        if run.start.converged and (self.best is None or order(run) < order(self.best)):
            self.best = run

    def _begins(self, ends: Mapping[str, Ends], near: Run | None) -> list[Array]:
        """Inputs to start from, moved into the ends: those of the run nearby, of the optima, of the study's start."""
        known = (*self.optima, *self.ends)
        others = [run for run in known if near is None or not np.array_equal(run.unknowns, near.unknowns)]
        points = [*(run.inputs for run in ([near] if near else []) + others), self.optimizer.model.start]
        moved = []
        for inputs in points:
            point = inputs.copy()
            for name, (low, high) in ends.items():
                place = self.optimizer.model.index[name]
                point[place] = min(max(point[place], low), high)
            moved.append(self._mixed(point, ends))
        return moved

    def _mixed(self, point: Array, ends: Mapping[str, Ends]) -> Array:
        """Inputs whose shares add up to one: the first record in the ends alone where the point has none of them."""
        if not isinstance(self.optimizer.model, MixedDevice):
            return point
        for mixture in self.sizes.mixtures:
            places = [self.optimizer.model.index[name] for name in mixture.shares]
            if not np.any(point[places]):
                first = next(i for i, name in enumerate(mixture.shares) if ends[name][1] > 0.0)
                point[places[first]] = 1.0
        return self.optimizer.model.mixed(point)

    def _beside(self, ends: Mapping[str, Ends], near: Run, point: Array) -> Run:
        """Return a run within some ends from one nearby: warm, or from its states alone if its records lie outside."""
        index, shares = self.optimizer.model.index, [name for mixture in self.sizes.mixtures for name in mixture.shares]
        places = [index[name] for name in shares]
        if np.all(np.abs(near.inputs[places] - point[places]) < _SAME_RECORDS):
            return self._solved(ends, warm=near)
        unknowns = near.unknowns.copy()
        for i, free in enumerate(self.optimizer.free):
            unknowns[i] = free.to_unknown(point[index[free.name]])
        run = self.optimizer.solve(ends, begin=point, unknowns=unknowns, near=True)
        self.work.count(run.start, warm=True)
        return run

    def _solved(self, ends: Mapping[str, Ends], warm: Run | None = None, begin: Array | None = None) -> Run:
        """Return a run within some ends; the same one again where it is asked again, by a box or by its halves."""
        numbers = (None if warm is None else warm.unknowns, begin)
        margined = (*sorted(ends.items()), *sorted(self.optimizer.margins.items()))
        key = (*margined, *(None if part is None else part.tobytes() for part in numbers))
        if key not in self._runs:
            run = self.optimizer.solve(ends, warm=warm, begin=begin)
            self.work.count(run.start, warm=warm is not None)
            if run.start.status == TIME_OVER:
                return run
            self._runs[key] = run
        return replace(self._runs[key])


def order(run: Run) -> tuple[bool, bool, float]:
    """Rank converged runs first, then those with a feasible design; the best of each first."""
    failed = not run.start.converged
    return (failed, failed and run.start.status != FEASIBLE, run.start.objective)
