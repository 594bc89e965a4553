"""Records of the catalogue with which conflicting limits can hold: each was tried, as far as arithmetic can."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import numpy as np

from tvimdesign.base.errors import TvimError
from tvimdesign.device import Choice
from tvimdesign.solve.nlp.solution import ConflictSet
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Study, given

_TRIED = 3
"""Records of a choice with which a design is sought: those that violate all limits least at the nearest design."""
_PROMISING = 0.7
"""Share of the way that conflicting limits must move which a record has to go at the nearest design."""


def curing_records(optimizer: Optimizer, nearest: Run, conflict_set: ConflictSet) -> dict[str, str]:
    """Return, by choice, a record in place of the chosen one with which all limits of the problem can hold.

    Parameters
    ----------
    optimizer : Optimizer
        The problem whose limits conflict, without the working cycle.
    nearest : Run
        Its design of least violation.
    conflict_set : ConflictSet
        The limits that conflict. Only choices that they depend on are tried.
    """
    cures: dict[str, str] = {}
    now = _values(optimizer, optimizer.study, nearest)
    for choice in _behind(optimizer, conflict_set):
        promising: list[tuple[float, str, Study]] = []
        for name in optimizer.study.catalog.names(str(choice.category)):
            module = {**optimizer.study.module, choice.name: name}
            study = optimizer.study.model_copy(update={"module": module})
            values = _values(optimizer, study, nearest)
            if values and _way(optimizer, conflict_set, now, values) >= _PROMISING:
                broken = (float(limit.residual(values[limit.output])) for limit in optimizer.problem.limits)
                promising.append((sum(max(by, 0.0) for by in broken), name, study))
        for _, name, study in sorted(promising, key=lambda record: record[:2])[:_TRIED]:
            if not optimizer.deadline.passed and _has_design(study, optimizer, nearest):
                cures[choice.name] = name
                break
    return cures


def _behind(optimizer: Optimizer, conflict_set: ConflictSet) -> list[Choice]:
    """Return the choices of bought parts and materials that the limits depend on and the study does not vary.

    Those that bring the fewest numbers along come first: they change the module least.
    """
    table, words = optimizer.table, optimizer.model.words
    behind = set().union(*(table.ancestors(side.text.split(" ")[0]) for side in conflict_set.sides))
    behind |= {row.record[0] for row in table.inputs if row.record and row.name in behind}
    records = [
        row for row in table.choices
        if row.name in behind and row.category and row.name not in optimizer.study.vary
        and not (row.record or row.stock_record or words[row.name] in row.options)
    ]  # fmt: skip
    brought = Counter(row.record[0] for row in table.inputs if row.record)
    return sorted(records, key=lambda row: brought[row.name])


def _values(optimizer: Optimizer, study: Study, nearest: Run) -> dict[str, float]:
    """Return what is limited at the nearest design in a study with another record; empty if there is no module."""
    limits = optimizer.problem.limits
    names = dict.fromkeys(name for limit in limits for name in (limit.output, limit.part_of) if name)
    free = {free.name: float(nearest.inputs[optimizer.model.index[free.name]]) for free in optimizer.free}
    try:
        with np.errstate(all="ignore"):
            return dict(optimizer.table.evaluate({**given(study), **free}, list(names)))
    except (TvimError, ArithmeticError):
        return {}


def _way(
    optimizer: Optimizer, conflict_set: ConflictSet, now: Mapping[str, float], values: Mapping[str, float]
) -> float:  # fmt: skip
    """Return how much of the move that conflicting limits need some values make up for, to first order."""
    limits = {f"{limit.part_of or limit.output} {limit.sense}": limit.limit for limit in optimizer.problem.limits}
    way = 0.0
    for side in conflict_set.sides:
        name, sense = side.text.split(" ")[:2]
        if side.move_to is not None:
            way += (values[name] - now[name]) / (limits[f"{name} {sense}"] - side.move_to)
    return way


def _has_design(study: Study, optimizer: Optimizer, nearest: Run) -> bool:
    """Return whether a design satisfies all limits, sought from the nearest one with another record."""
    try:
        other = Optimizer(study, without_cycle=True, deadline=optimizer.deadline)
    except TvimError:  # no module at its start, or a limit that nothing free can mend
        return False
    return other.solve(unknowns=nearest.unknowns, beginning="feasible").start.converged
