"""The problems that a search over listed choices goes through: one for each family of records, built once.

Combinations that a search among mixed records came to are solved as the problem of their own records alone. For a
comparison with branch and bound every combination can be solved, each warm from the one before, which is its neighbour.
Each optimum with all sizes free begins a chain of its own, so that a worse optimum of one chain does not hide a better
one of another.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import InfeasibleError, InputError, SimulationError, TimeOverError
from tvimdesign.solve.discrete.discrete_choices import Box, Sizes
from tvimdesign.solve.discrete.record_families import Family, possible
from tvimdesign.solve.discrete.relaxation import Relaxation, order
from tvimdesign.solve.nlp.mixture import Mixture, with_records
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import Array, Progress, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Study


@dataclass
class ExactCombinations:
    """The problems of single combinations of records, each built once when first asked for."""

    build: Callable[[Mapping[str, str]], Optimizer]  # The problem with some records chosen
    sizes: Sizes  # The listed numbers
    _built: dict[tuple[str, ...], Relaxation] = field(init=False, default_factory=dict)

    def of(self, mixed: Relaxation, box: Box) -> Relaxation:
        """Return the problem of the records of one combination; the tree's own if it mixes none."""
        if not mixed.sizes.mixtures:
            return mixed
        records = {name: word for name, word in mixed.choices(box).items() if isinstance(word, str)}
        key = tuple(records.values())
        if key not in self._built:
            self._built[key] = Relaxation(len(self._built), self.build(records), records, self.sizes, SolverEffort())
        return self._built[key]

    def solved(self, mixed: Relaxation, box: Box, run: Run) -> tuple[Relaxation, Run]:
        """Return the best design of a combination from its relaxed run: warm, cold, or unchanged if time is up."""
        exact = self.of(mixed, box)
        if exact is mixed:
            return mixed, run
        ends = exact.sizes.ends(box[: len(exact.sizes.names)])
        begin = _inputs(mixed.optimizer, exact.optimizer, run)
        carried = _carried(mixed.optimizer, exact.optimizer, run, begin)
        runs = []
        if not exact.optimizer.deadline.passed:
            runs.append(exact.optimizer.solve(ends, warm=carried, begin=begin))
        if runs and not runs[0].start.converged:
            runs.append(exact.optimizer.solve(ends, begin=begin))
        best = min([*runs, carried], key=lambda candidate: not candidate.start.converged)
        choices = exact.choices(box[: len(exact.sizes.names)])
        best = replace(best, within=ends, start=replace(best.start, choices=choices, relaxed=False))
        return exact, best

    def closest(self, mixed: Relaxation, box: Box) -> tuple[Relaxation, Run]:
        """Return the solver's end for one combination, feasible or not."""
        exact = self.of(mixed, box)
        return exact, exact.closest(box[: len(exact.sizes.names)])

    def between(self, exact: Relaxation, run: Run) -> Run | None:
        """Return the best design with the same records and every size free, from the listed sizes; None if none."""
        if not exact.sizes.names:
            return None
        free_run = exact.optimizer.solve(warm=run)
        if not free_run.start.converged:
            free_run = exact.optimizer.solve(begin=run.inputs)
        return free_run if free_run.start.converged else None


def _inputs(mixed: Optimizer, exact: Optimizer, run: Run) -> Array:
    """Return a mixed problem's end as inputs of the exact problem, whose records bring their own numbers."""
    names = [*(free.name for free in exact.free), *(current.row for current in exact.currents)]
    return exact.model.inputs({name: run.inputs[mixed.model.index[name]] for name in names})


def _carried(mixed: Optimizer, exact: Optimizer, run: Run, begin: Array) -> Run:
    """Return a mixed problem's end as a run of the exact problem, which has no shares of records."""
    # Mixed problem's end as the exact problem's: without shares and their equations, with the limits left
    common = np.r_[0 : len(exact.free), len(mixed.free) : mixed.problem.unknown_count]
    unknowns = run.unknowns[common]
    unknowns[: len(exact.free)] = [free.to_unknown(begin[exact.model.index[free.name]]) for free in exact.free]
    first = mixed.problem.equation_count
    places = {limit.name: first + i for i, limit in enumerate(mixed.problem.limits)}
    limits = [places[limit.name] for limit in exact.problem.limits]
    bounds = range(first + len(mixed.problem.limits), len(run.multipliers))
    rows = [*range(first - len(mixed.mixtures)), *limits, *bounds]
    start = replace(run.start, begin=exact.vector.free_values(begin), end=exact.vector.free_values(begin))
    return replace(
        run, start=start, inputs=begin, unknowns=unknowns, multipliers=run.multipliers[rows],
        bound_multipliers=run.bound_multipliers[common],
    )  # fmt: skip


AFRESH = 16  # Combinations after which chains begin anew, so that none is led far astray


def every_combination(
    trees: Sequence[Relaxation], known: Mapping[tuple[int, Box], Run]
) -> tuple[dict[tuple[int, Box], Run], SolverEffort]:
    """Solve every combination until the time is over; return all designs, by tree and box, and what that took.

    Where a design is `known` already, the better of the two is returned.
    """
    count, began, number = sum(tree.sizes.count for tree in trees), time.perf_counter(), 0
    runs, chains, work = dict(known), list[Run | None](), SolverEffort()
    for tree in trees:
        own, tree.work = tree.work, SolverEffort()
        for position in range(tree.sizes.count):
            if tree.optimizer.deadline.passed:
                break
            if position % AFRESH == 0:
                chains = [*tree.optima] or [None]
                left = (
                    f", about {(time.perf_counter() - began) / number * (count - number):.0f} s left" if number else ""
                )
                tree.optimizer.progress(f"choosing from lists: {number} of {count} combinations solved{left}")
            box, number = tree.sizes.combination(position), number + 1
            for place, near in enumerate(chains):
                run, certain = tree.exactly(box, near)
                if run is None:
                    if certain:  # by arithmetic, or from everywhere: the other chains would find no more
                        break
                    continue
                chains[place] = run
                if (tree.place, box) not in runs or order(run) < order(runs[tree.place, box]):
                    runs[tree.place, box] = run
        work, tree.work = SolverEffort.total([work, tree.work]), own
    return runs, work


MAX_COMBINATIONS = 1_000_000
MAX_FAMILIES = 60  # Families of records: each is searched on its own, from every start
MAX_MIXED = 100  # Records that are mixed in one problem: each is one of its free numbers


@dataclass
class Trees:
    """Builds the problems of one search, all of whose objectives are over the same reference."""

    study: Study
    reference: dict[str, float] | None
    progress: Progress
    objectives: Sequence[str]
    deadline: Deadline
    sizes: Sizes

    def of(self, families: Sequence[Family]) -> list[Relaxation]:
        """Return the problem of each family.

        Raises InfeasibleError where every family violates a limit that nothing free can cure, TimeOverError where the
        time is over before the first problem is built.
        """
        trees: list[Relaxation] = []
        refused: list[InfeasibleError] = []
        for whole in families:
            if trees and self.deadline.passed:
                break
            if refused:
                self.deadline.check("a family of records was found that no fixed limit excludes")
            try:
                family = possible(self.study, whole)
                optimizer = self._built(family)
            except InfeasibleError as error:  # a limit that nothing free can mend, with these records
                refused.append(error)
                continue
            except TimeOverError:
                if trees:
                    break
                raise
            self.reference = optimizer.reference
            sizes = self.sizes.mixed(family.mixtures)
            trees.append(Relaxation(len(trees), optimizer, family.fixed, sizes, SolverEffort()))
        if not trees:
            raise refused[0]
        return trees

    def exact(self) -> ExactCombinations:
        """Return the problems of single combinations of records, over the reference of the families."""
        return ExactCombinations(self._optimizer, self.sizes)

    def _built(self, family: Family) -> Optimizer:
        if not family.mixtures:
            return self._optimizer(family.records)
        error: SimulationError | None = None
        for first in _beginnings(family.mixtures):
            records = dict(family.records)
            for mixture in first:
                records |= mixture.records[0]
            try:
                return self._optimizer(records, first)
            except SimulationError as failed:  # the start has another module with other records
                error = error or failed
        assert error is not None
        raise error

    def _optimizer(self, records: Mapping[str, str], mixtures: Sequence[Mixture] = ()) -> Optimizer:
        study = with_records(self.study, records)
        return Optimizer(
            study, self.reference, self.progress, objectives=self.objectives, deadline=self.deadline, mixtures=mixtures
        )


def refuse_too_many(families: Sequence[Family], sizes: Sizes) -> None:
    """Raise InputError where there are more choices than a search can go through."""
    combinations = sizes.count * sum(family.count for family in families)
    if combinations > MAX_COMBINATIONS:
        raise InputError(
            f"vary: {combinations} combinations of listed choices; the limit is {MAX_COMBINATIONS}; "
            "narrow a list with from and to, take a longer step, or give a range in place of a list"
        )
    if len(families) > MAX_FAMILIES:
        raise InputError(
            f"vary: {len(families)} combinations of records and options that make modules of different structure; the "
            f"limit is {MAX_FAMILIES}, as each is searched on its own; choose among fewer"
        )
    mixed = max(sum(len(mixture.records) for mixture in family.mixtures) for family in families)
    if mixed > MAX_MIXED:
        raise InputError(
            f"vary: {mixed} records to choose from; the limit is {MAX_MIXED}; choose among fewer, or in two studies"
        )


def _beginnings(mixtures: Sequence[Mixture]) -> list[tuple[Mixture, ...]]:
    """Return the mixtures as they are, then with another record of one of them first."""
    beginnings = [tuple(mixtures)]
    for place, mixture in enumerate(mixtures):
        for first in range(1, len(mixture.records)):
            others = [i for i in range(len(mixture.records)) if i != first]
            beginnings.append((*mixtures[:place], mixture.in_order([first, *others]), *mixtures[place + 1 :]))
    return beginnings
