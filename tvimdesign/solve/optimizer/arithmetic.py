"""What of a problem depends on no switch: its share of the goal and its limits, as functions of the free numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from tvimdesign.simulation.casadi_setup import ca
from tvimdesign.solve.nlp.constraints import Constraint, on_cycle
from tvimdesign.solve.optimizer.optimizer import Optimizer


class Arithmetic:
    """The outputs of one study that are arithmetic; limits' reserves for what spreads are left out."""

    def __init__(self, optimizer: Optimizer) -> None:
        """Sort the goal's outputs and the limits."""
        self._optimizer, table = optimizer, optimizer.table
        self.limits: list[Constraint] = [
            limit for limit in optimizer.problem.limits if not on_cycle(table, limit.output)
        ]
        self.weights = {
            name: weight / optimizer.reference[name]
            for name, weight in optimizer.study.minimize.items() if not on_cycle(table, name)
        }  # fmt: skip

    def values(self, unknowns: Any) -> tuple[Any, Any]:
        """Its share of the goal, and the limits' residuals, at the free numbers' unknowns (MX)."""
        problem, model = self._optimizer.problem, self._optimizer.model
        wanted = list(dict.fromkeys([*(limit.output for limit in self.limits), *self.weights]))
        if not wanted:
            return ca.MX(0.0), ca.MX(0, 1)
        inputs = problem.with_unknowns(ca.MX(ca.DM(model.start)), unknowns)
        values = model.outputs(wanted)(inputs, np.full(len(model.switch_names), np.nan))  # read by none of them
        found = dict(zip(wanted, ca.vertsplit(values), strict=True))
        goal = sum((weight * found[name] for name, weight in self.weights.items()), ca.MX(0.0))
        return goal, ca.vertcat(*(limit.residual(found[limit.output]) for limit in self.limits))
