"""Whether any design within some ends keeps the limits that depend on no switch: a small problem, asked first.

The switch makes nearly all of the unknowns of a study's problem, and IPOPT takes longest where there is no design. The
limits of arithmetic alone are a few dozen functions of the free numbers; what cannot keep those keeps no more of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.interrupts import raise_pending
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE, on_cycle
from tvimdesign.solve.nlp.ipopt import NLP
from tvimdesign.solve.nlp.solver_run import Ends
from tvimdesign.solve.optimizer.optimizer import Optimizer

_IPOPT = {"print_level": 0, "sb": "yes", "max_iter": 100, "tol": 1e-9, "mu_init": 1e-2}
NOWHERE = 1e3
"""What a point counts as breaking a limit by at which there is no module."""

Array = NDArray[np.float64]


class FeasibilityScreen:
    """The arithmetic limits of one problem, and the least by which the worst of them is broken within some ends."""

    def __init__(self, optimizer: Optimizer) -> None:
        """Write the problem; nothing is solved yet."""
        self._optimizer = optimizer
        unknowns, worst = ca.MX.sym("free", len(optimizer.free)), ca.MX.sym("worst")
        residuals = self._residuals(unknowns)
        inputs = optimizer.problem.with_unknowns(ca.MX(ca.DM(optimizer.model.start)), unknowns)
        rows = ca.vertcat(optimizer.problem.shares_less_one(inputs), residuals - worst)
        function = ca.Function("screen", [ca.vertcat(unknowns, worst), ca.MX.sym("none", 0)], [worst, rows], *NLP)
        self._count = residuals.numel()
        options: dict[str, Any] = {"ipopt": _IPOPT, "print_time": False, "show_eval_warnings": False}
        self._at: Any = ca.Function("residuals", [unknowns], [residuals]).expand()
        self._solver: Any = ca.nlpsol("screen", "ipopt", function.expand(), options)

    def broken(self, inputs: Array) -> float:
        """The most by which some inputs break a limit, as a share of its scale; infinite at no geometry."""
        optimizer = self._optimizer
        unknowns = [free.to_unknown(inputs[optimizer.model.index[free.name]]) for free in optimizer.free]
        residuals = np.asarray(self._at(unknowns)).ravel()
        return float(np.max(residuals, initial=-np.inf)) if np.all(np.isfinite(residuals)) else np.inf

    def worst(self, unknowns: Array) -> Array:
        """The most by which designs break a limit, a column of the free numbers' unknowns each."""
        residuals = np.asarray(self._at(unknowns)).reshape(self._count, np.shape(unknowns)[1])  # there may be no limit
        worst: Array = np.max(residuals, axis=0, initial=-1.0)
        return np.nan_to_num(worst, nan=NOWHERE, posinf=NOWHERE)

    def _residuals(self, unknowns: Any) -> Any:
        """Those of the arithmetic limits at the free numbers' unknowns; margins for what spreads are left out."""
        problem, model = self._optimizer.problem, self._optimizer.model
        limits = [limit for limit in problem.limits if not on_cycle(self._optimizer.table, limit.output)]
        wanted = list(dict.fromkeys(limit.output for limit in limits))
        if not wanted:
            return ca.MX(0, 1)
        inputs = problem.with_unknowns(ca.MX(ca.DM(model.start)), unknowns)
        values = model.outputs(wanted)(inputs, np.full(len(model.switch_names), np.nan))  # read by none of them
        return ca.vertcat(*(limit.residual(values[wanted.index(limit.output)]) for limit in limits))

    def impossible(self, within: Mapping[str, Ends], begin: Array) -> bool:
        """Whether the limits are broken at the best point that a search from some inputs comes to.

        A search that does not converge says nothing. Raises KeyboardInterrupt where an interrupt ended it.
        """
        optimizer = self._optimizer
        count = len(optimizer.free)
        lower, upper = (ends[:count] for ends in optimizer.vector.bounds(within))
        start = np.array([free.to_unknown(begin[optimizer.model.index[free.name]]) for free in optimizer.free])
        least, largest = optimizer.with_room_where_decided(np.zeros(len(optimizer.mixtures)), within)
        found = self._solver(
            x0=np.append(np.clip(start, lower, upper), 0.1), lbg=np.append(least, np.full(self._count, -np.inf)),
            ubg=np.append(largest, np.zeros(self._count)), lbx=np.append(lower, 0.0), ubx=np.append(upper, np.inf),
        )  # fmt: skip
        raise_pending()
        return bool(self._solver.stats()["success"]) and float(found["f"]) > ALGEBRAIC_TOLERANCE
