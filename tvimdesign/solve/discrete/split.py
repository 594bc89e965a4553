"""A problem split in arithmetic and switch, with a price for what they share: what each combination costs at least.

With prices p on the unknowns u of the free numbers, no design of a combination can cost less than

    min [A(u) + p u | its sizes, the arithmetic limits]  +  min [S(u) - p u | all limits, sizes between their ends],

A the goal's arithmetic and S what of it hangs on the switch. The second is one problem for all combinations, its sizes
free; the first has a dozen unknowns and is solved for all of them side by side. With the prices that A and its limits
pay at an optimum, both together come to that optimum, unless one of them is cheaper elsewhere. Both minima are local
ones, the least from some starts.
Source: Guignard and Kim, Mathematical Programming 39 (1987) 215, Lagrangean decomposition.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.simulation.casadi_setup import ca
from tvimdesign.solve.discrete.discrete_choices import Sizes
from tvimdesign.solve.discrete.side_by_side import SideBySide
from tvimdesign.solve.nlp.constraints import on_cycle
from tvimdesign.solve.nlp.ipopt import NLP, solver_of
from tvimdesign.solve.nlp.objective import Objective
from tvimdesign.solve.nlp.solver_run import Array, Run
from tvimdesign.solve.optimizer.arithmetic import Arithmetic
from tvimdesign.solve.optimizer.optimizer import ALGEBRAIC_TOLERANCE, Optimizer


class Split:
    """Both shares of one choice of records; the study frees something that it does not list."""

    def __init__(self, optimizer: Optimizer, sizes: Sizes) -> None:
        """Nothing is built yet."""
        self.optimizer, self.sizes = optimizer, sizes
        self.boxes = list(sizes.each())
        self._arithmetic = Arithmetic(optimizer)
        names = [free.name for free in optimizer.free]
        self._listed = [names.index(name) for name in sizes.names]
        self.rest = [i for i in range(len(names)) if i not in self._listed]
        """Places of the free numbers that are not listed."""
        table, minimize = optimizer.table, optimizer.study.minimize
        self._goal = Objective({name: weight for name, weight in minimize.items() if on_cycle(table, name)})

    @cached_property
    def _scalar(self) -> Any:
        """The function unknowns of the free numbers -> arithmetic share of the goal, residuals of its limits."""
        unknowns = ca.MX.sym("free", len(self.optimizer.free))
        return ca.Function("arithmetic", [unknowns], list(self._arithmetic.values(unknowns))).expand()

    @cached_property
    def _push(self) -> Any:
        """The function (unknowns, multipliers of its limits) -> the arithmetic share, and how it pushes on them."""
        u, multipliers = ca.SX.sym("u", len(self.optimizer.free)), ca.SX.sym("mu", len(self._arithmetic.limits))
        goal, residuals = self._scalar(u)
        return ca.Function("push", [u, multipliers], [goal, ca.gradient(goal + ca.dot(multipliers, residuals), u)])

    def prices(self, run: Run) -> tuple[Array, float]:
        """The prices at an optimum, and what the switch's share comes to there."""
        problem = self.optimizer.problem
        of_limits = run.multipliers[problem.equation_count :][: len(problem.limits)]
        mine = [problem.limits.index(limit) for limit in self._arithmetic.limits]
        u = run.unknowns[: len(problem.free)]
        goal, push = self._push(u, of_limits[mine])
        prices = -np.asarray(push).ravel()
        return prices, run.start.objective - float(goal) - float(prices @ u)

    # --- the switch's share ---

    @cached_property
    def _solver(self) -> Any:
        written, count = self.optimizer.problem.function, len(self.optimizer.free)
        prices = ca.MX.sym("prices", count)
        function = ca.Function(
            "share", [written["x"], ca.vertcat(written["p"], prices)],
            [written["f"] - ca.dot(prices, written["x"][:count]), written["g"]], *NLP,
        )  # fmt: skip
        return solver_of(function, self.optimizer.study.solver)

    def of_switch(self, prices: Array, begins: Iterable[Array]) -> Iterator[tuple[float, Array]]:
        """What the switch's share comes to from several unknowns, and with which, for searches that converged."""
        parameters = np.append(self.optimizer.parameters(self._goal), prices)
        for begin in begins:
            answer = self._solver(x0=begin, p=parameters, **self.optimizer.ends({}, self._goal))
            if self._solver.stats()["success"]:
                yield float(answer["f"]), np.asarray(answer["x"]).ravel()

    # --- the share of arithmetic ---

    @cached_property
    def _form(self) -> SideBySide:
        """The small problem: what is not listed is unknown; what is, and the prices, are numbers of its own."""
        count, listed = len(self.optimizer.free), len(self._listed)
        u, own = ca.SX.sym("u", len(self.rest)), ca.SX.sym("own", listed + count)
        every = ca.SX(count, 1)
        for place, entry in zip(self.rest + self._listed, ca.vertsplit(ca.vertcat(u, own[:listed])), strict=True):
            every[place] = entry
        goal, residuals = self._scalar(every)
        return SideBySide(ca.Function("form", [u, own], [goal + ca.dot(own[listed:], every), residuals]))

    @cached_property
    def _combinations(self) -> Array:
        """Unknowns of the listed numbers, a column for each combination."""
        free, ends = self.optimizer.free, [self.sizes.ends(box) for box in self.boxes]
        return np.array([[free[i].to_unknown(one[free[i].name][0]) for one in ends] for i in self._listed])

    def of_arithmetic(self, prices: Array, which: NDArray[np.int64]) -> tuple[Array, NDArray[np.bool_]]:
        """The least of some combinations, from the study's start and from the middle of the ranges; whether its limits
        cannot be kept. Minus infinity where neither search converged.
        """
        free, model, count = self.optimizer.free, self.optimizer.model, len(which)
        lower, upper = (ends[: len(free)] for ends in self.optimizer.vector.bounds({}))
        as_drawn = np.array([one.to_unknown(model.start[model.index[one.name]]) for one in free])
        own = np.vstack([self._combinations[:, which], np.tile(prices[:, None], count)])
        low, high = (np.tile(one[self.rest, None], count) for one in (lower, upper))
        least, broken = np.full(count, np.inf), np.ones(count, dtype=bool)
        for begin in (as_drawn, 0.5 * (lower + upper)):
            found = self._form.solve(np.tile(begin[self.rest, None], count), own, low, high)
            least = np.where(found.converged, np.minimum(least, found.values), least)
            broken &= found.converged & (found.broken > ALGEBRAIC_TOLERANCE)
        return np.where(np.isfinite(least), least, -np.inf), broken
