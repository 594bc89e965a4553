"""One problem, built once and solved again, warm, as its limits, ranges, weights and fixed numbers move."""

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tvimdesign.base.deadline import Deadline
from tvimdesign.device import Input
from tvimdesign.solve.nlp.constraints import Constraint, constraints_of
from tvimdesign.solve.nlp.decision_vector import DecisionVector
from tvimdesign.solve.nlp.problem_parts import Free, Objective
from tvimdesign.solve.nlp.solver_run import Array, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Range, Study, given

AT_END = 1e-4  # Share of the range, or of a limit's scale, within which a number counts as at its end
_PRESSES = 1e-6  # Multiplier over the objective above which a limit costs something


@dataclass(frozen=True)
class Moved:
    """Optimum of a moved problem and its active constraints."""

    run: Run
    active: tuple[str, ...]
    """Limits that press, by name (`holding_torque >=`), each with the requirement it is part of, if it is of one."""
    ends: dict[str, str]  # Variables that press against an end of their range: `lower` or `upper`

    @property
    def converged(self) -> bool:
        """Return the solver's verdict that this is an optimum."""
        return self.run.start.converged


class ParametricOptimizer:
    """A study's problem; it takes every study that differs in numbers alone."""

    def __init__(self, study: Study) -> None:
        """Build the problem. Raises InfeasibleError and InputError as `Optimizer` does."""
        self.study = study
        self.optimizer = Optimizer(study)
        self._limits = {limit.name: limit for limit in self.optimizer.problem.limits}
        self._shape = _shape(study)

    def fits(self, study: Study) -> bool:
        """Return whether only numbers differ from the study that was built."""
        return _shape(study) == self._shape

    def solve(
        self,
        study: Study,
        last: Run | None = None,
        reference: Mapping[str, float] | None = None,
        near: Mapping[str, float] | None = None,
    ) -> Moved:
        """Return the optimum of a study from the `last` one; minimised outputs are divided by `reference`.

        Where there is no last one it is looked for from the variables `near` [SI], and then from the study's start.
        Limits that nothing free can change are no part of the problem, and whoever asks has to look after them.
        """
        optimizer = self._moved(study, reference)
        optimizer.deadline = Deadline(study.solver.time_limit)
        own = {current.row for current in optimizer.currents}
        ranges = {name: varied for name, varied in study.vary.items() if isinstance(varied, Range) and name not in own}
        within = {name: (ends.lower, ends.upper) for name, ends in ranges.items()}
        goal = Objective(study.minimize)
        if last is None and near:
            begin = self._clipped(near, optimizer, ranges)
            run = optimizer.solve(within, objective=goal, begin=begin, near=True)
            if run.start.converged:
                return Moved(run, self._binding(run, optimizer), _ends(run, optimizer))
        run = optimizer.solve(within, last, objective=goal)
        if last is not None and not run.start.converged:
            begin = self._clipped(last.start.end, optimizer, ranges)
            run = optimizer.solve(within, objective=goal, begin=begin, near=True)
        return Moved(run, self._binding(run, optimizer), _ends(run, optimizer))

    @staticmethod
    def _clipped(at: Mapping[str, float], optimizer: Optimizer, ranges: Mapping[str, Range]) -> Array:
        """Return a design within the present ranges, to start at without an optimum's multipliers."""
        inside = {name: min(max(at[name], ends.lower), ends.upper) for name, ends in ranges.items() if name in at}
        return optimizer.model.inputs({**at, **inside})

    def _moved(self, study: Study, reference: Mapping[str, float] | None) -> Optimizer:
        """Return the built optimizer with other parameters; nothing compiled changes."""
        built = self.optimizer
        numbers = given(study)
        moved, model, problem = copy(built), copy(built.model), copy(built.problem)
        model.start = np.array([float(numbers[name]) for name in model.names])
        problem.free = tuple(_within(free, study) for free in built.problem.free)
        moved.study, moved.model, moved.problem = study, model, problem
        moved.reference = {**built.reference, **(reference or {})}
        moved.margins = self._margins(constraints_of(study, study.table, model.words))
        moved.vector = DecisionVector(problem, model)
        return moved

    def _margins(self, limits: list[Constraint]) -> dict[str, float]:
        """Return the margins within the built limits that satisfy the moved ones."""
        margins = {}
        for moved in limits:
            built = self._limits.get(moved.name)
            if built is not None:
                tighter = built.limit - moved.limit if built.sense == "<=" else moved.limit - built.limit
                margins[moved.name] = tighter / built.scale
        return margins

    def _binding(self, run: Run, optimizer: Optimizer) -> tuple[str, ...]:
        """Limits whose multiplier costs something."""
        first = optimizer.problem.equation_count
        prices = run.multipliers[first : first + len(optimizer.problem.limits)]
        least = _PRESSES * abs(run.start.objective or 1.0)
        return tuple(limit.name for limit, price in zip(optimizer.problem.limits, prices, strict=True) if price > least)


def _within(free: Free, study: Study) -> Free:
    """Return a free number between its present ends; its unknown keeps its divisor."""
    ends = study.vary[free.name]
    return replace(free, lower=ends.lower, upper=ends.upper) if isinstance(ends, Range) else free


def _ends(run: Run, optimizer: Optimizer) -> dict[str, str]:
    """Free numbers at an end of their range that presses."""
    ends = {}
    least = _PRESSES * abs(run.start.objective or 1.0)
    for free, price in zip(optimizer.problem.free, run.bound_multipliers, strict=False):
        value = run.inputs[optimizer.model.index[free.name]]
        room = AT_END * (free.upper - free.lower)
        if price > least and value >= free.upper - room:
            ends[free.name] = "upper"
        elif price < -least and value <= free.lower + room:
            ends[free.name] = "lower"
    return ends


def _shape(study: Study) -> dict[str, Any]:
    """Return the parts of a study that its problem is built from: words, whole numbers, limits, signs of ranges."""
    table = study.table
    numbers = {row.name for row in table.inputs if isinstance(row, Input) and not row.integer}
    values = given(study)
    return {
        "words": {name: value for name, value in values.items() if name.partition("@")[0] not in numbers},
        "limits": [limit.name for limit in constraints_of(study, table, values)],
        "vary": {name: r.lower > 0.0 if isinstance(r, Range) else r for name, r in study.vary.items()},
        "minimize": list(study.minimize),
        "rest": (study.mode, tuple(study.operating_points), study.profile, study.robust, study.solver),
    }
