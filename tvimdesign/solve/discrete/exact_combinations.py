"""Combinations that a search among mixed records came to, each solved as the problem of its own records alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from tvimdesign.solve.discrete.discrete_choices import Box, Sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import Array, Run, Trace
from tvimdesign.solve.optimizer.optimizer import Optimizer


@dataclass
class ExactCombinations:
    """The problems of single combinations of records, each built once when first asked for."""

    build: Callable[[Mapping[str, str]], Optimizer]
    """The problem with some records chosen."""
    sizes: Sizes
    """The listed numbers."""
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
    inputs = exact.model.start.copy()
    for free in exact.free:
        inputs[exact.model.index[free.name]] = run.inputs[mixed.model.index[free.name]]
    for current in exact.currents:
        inputs[exact.model.index[current.row]] = run.inputs[mixed.model.index[current.row]]
    return inputs


def _carried(mixed: Optimizer, exact: Optimizer, run: Run, begin: Array) -> Run:
    """Return a mixed problem's end as a run of the exact problem, which has no shares of records."""
    trace = _trace(mixed, exact, run, begin)
    start = replace(run.start, begin=exact.vector.free_values(begin), end=exact.vector.free_values(begin))
    return replace(
        run, start=start, inputs=begin, unknowns=trace.unknowns, multipliers=trace.multipliers,
        bound_multipliers=trace.bound_multipliers,
    )  # fmt: skip


def _trace(mixed: Optimizer, exact: Optimizer, run: Run, begin: Array) -> Trace:
    """Return a mixed problem's end as the exact problem's: without shares and their equations, with the limits left."""
    common = np.r_[0 : len(exact.free), len(mixed.free) : mixed.problem.unknown_count]
    unknowns = run.unknowns[common]
    unknowns[: len(exact.free)] = [free.to_unknown(begin[exact.model.index[free.name]]) for free in exact.free]
    first = mixed.problem.equation_count
    places = {limit.name: first + i for i, limit in enumerate(mixed.problem.limits)}
    limits = [places[limit.name] for limit in exact.problem.limits]
    bounds = range(first + len(mixed.problem.limits), len(run.multipliers))
    rows = [*range(first - len(mixed.mixtures)), *limits, *bounds]
    return Trace(unknowns, run.multipliers[rows], run.bound_multipliers[common])
