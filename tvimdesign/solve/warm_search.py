"""Searches studies that differ in fixed numbers alone, one after another, each from where the last one ended."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tvimdesign.device import Input, Table
from tvimdesign.solve.discrete.discrete_choices import discrete_sizes
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.nlp.solver_run import Progress, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.record_choices import discrete_records
from tvimdesign.solve.optimizer.statuses import OPTIMAL
from tvimdesign.solve.optimizer.verify_optimum import verify_optimum
from tvimdesign.solve.search import Keep, optimize
from tvimdesign.study import Study


class WarmSearch:
    """Stands in place of `optimize`. The problem is built once, and solved again from the last optimum.

    A study is searched from every start as usual where it is the first, where more than fixed numbers differ from the
    last one, where something is chosen from a list, and where the warm solve ends without an optimum.
    """

    def __init__(self, reference: dict[str, float] | None) -> None:
        """Nothing is built yet. All studies' outputs are divided by the `reference`, so that all minimise the same."""
        self.warm_solves = 0
        self._study: Study | None = None
        self._optimizer: Optimizer | None = None
        self._last: Run | None = None
        self._reference = reference

    def __call__(
        self, study: Study, progress: Progress, reference: dict[str, float] | None,
        keep: Keep, objectives: Sequence[str],
    ) -> Solution:  # fmt: skip
        """Find the best design of a study. Raises InputError, InfeasibleError."""
        solution = self._warm(study, study.table)
        if solution:
            return solution

        def remember(optimizer: Optimizer, runs: list[Run]) -> None:
            converged = [run for run in runs if run.start.converged]
            self._study, self._optimizer = study, optimizer
            self._last = min(converged, key=lambda run: run.start.objective, default=None)
            keep(optimizer, runs)

        return optimize(study, progress, reference or self._reference, remember, objectives)

    def _warm(self, study: Study, table: Table) -> Solution | None:
        """The optimum sought from the last one; None where that cannot be done, or comes to none."""
        if self._optimizer is None or self._last is None or self._study is None:
            return None
        if not _alike(study, self._study, table) or _has_lists(study, table) or study.robust or study.profile.pieces():
            return None
        optimizer = self._optimizer.with_records(study)
        if optimizer is None:
            return None
        run = optimizer.solve(warm=self._last.trace)
        if not run.start.converged:
            return None
        solution = verify_optimum(optimizer, run, (run.start,), optimizer.seconds)
        if solution.status != OPTIMAL:
            return None
        self._last = run
        self.warm_solves += 1
        return solution


def _has_lists(study: Study, table: Table) -> bool:
    """Whether anything is chosen from a list."""
    return bool(discrete_sizes(study, table).names) or len(discrete_records(study, table)) > 1


def _alike(study: Study, other: Study, table: Table) -> bool:
    """Whether two studies differ in fixed numbers alone: neither in words, nor in whole numbers, which are shapes."""
    return _problem(study, table) == _problem(other, table)


def _problem(study: Study, table: Table) -> dict[str, Any]:
    """All of a study but its name and its fixed numbers."""
    shape = {name: value for name, value in study.module.items() if not _is_number(name, table)}
    points = tuple(study.operating_points)
    kept = study.model_dump(exclude={"name", "description", "module", "operating_points", "write", "tolerances"})
    return {**kept, "module": shape, "points": points}


def _is_number(name: str, table: Table) -> bool:
    row = table.quantity(name)
    return isinstance(row, Input) and not row.integer
