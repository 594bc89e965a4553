"""The least each combination of listed sizes can cost: split bounds with the prices at every optimum that is known.

Where the switch's share is cheaper elsewhere than at the optimum whose prices it is given, either the bound falls short
or there is another optimum. So the problem is solved again from there, and what it comes to joins the optima.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.discrete.split import Split
from tvimdesign.solve.nlp.solution import SAME_OPTIMUM
from tvimdesign.solve.nlp.solver_run import Array, Run
from tvimdesign.solve.optimizer.multistart import Multistart

_MORE_STARTS = 4
"""Points of its own at which the switch's share is begun, so that it does not rest on the search's starts alone."""
_GAP = 1e-3
"""How far the switch's share may be below that at an optimum before another one is looked for [objectives]."""


class LeastCost:
    """Bounds of all combinations of one tree."""

    def __init__(self, relaxation: Relaxation) -> None:
        """Nothing is solved yet."""
        self._tree, self._split = relaxation, Split(relaxation.optimizer, relaxation.sizes)
        self.boxes = self._split.boxes
        self.bounds: Array = np.full(len(self.boxes), -np.inf)
        """Of every combination; minus infinity where nothing is known."""
        self.broken: NDArray[np.bool_] = np.zeros(len(self.boxes), dtype=bool)
        """Combinations whose arithmetic limits cannot be kept."""
        self._ends: list[Array] = []
        """Where the switch's share was least with other prices."""

    def find(self, cutoff: float) -> None:
        """Bound all combinations, and with the prices of further optima those that may be below a `cutoff`.

        None is where the search has come to no optimum, or where everything free is listed.
        """
        priced: list[Run] = []
        while self._split.rest:
            waiting = [run for run in self._tree.optima if run not in priced]
            if not waiting:
                return
            self.price_at(waiting[0], cutoff, self._ends if priced else self._more_beginnings)
            priced.append(waiting[0])

    def price_at(self, run: Run, cutoff: float, more: Sequence[Array] = ()) -> None:
        """Raise the bounds that are below a cutoff with the prices at a design; `more` is where to begin as well."""
        which = np.flatnonzero((self.bounds < cutoff) & ~self.broken)
        if not len(which):
            return
        prices, own = self._split.prices(run)
        begins = [run.unknowns, *(one.unknowns for one in self._tree.optima if one is not run), *more]
        found = min(self._split.of_switch(prices, begins), key=lambda one: one[0], default=None)
        if found is None:
            return
        share, unknowns = found
        values, broken = self._split.of_arithmetic(prices, which)
        self.bounds[which] = np.maximum(self.bounds[which], values + share)
        self.broken[which] |= broken
        if share < own - _GAP:
            self._ends.append(unknowns)
            self._look_at(unknowns)

    def _look_at(self, unknowns: Array) -> None:
        """Solve the problem with all sizes free from somewhere; another optimum joins those of the tree."""
        optimizer, optima = self._tree.optimizer, self._tree.optima
        run = optimizer.solve(begin=optimizer.vector.inputs(unknowns), unknowns=unknowns)
        self._tree.work.count(run.start, warm=False)
        objective = run.start.objective
        if run.start.converged and all(
            abs(objective - one.start.objective) > SAME_OPTIMUM * abs(objective) for one in optima
        ):
            optima.append(run)
            optima.sort(key=lambda one: one.start.objective)

    @cached_property
    def _more_beginnings(self) -> list[Array]:
        """The unknowns at the study's start and at points that the search has not begun at."""
        optimizer, asked = self._tree.optimizer, self._tree.optimizer.study.solver
        options = asked.model_copy(update={"starts": _MORE_STARTS + 1, "seed": asked.seed + 1})
        points = Multistart(optimizer.problem, optimizer.model, optimizer.simulator, options, lambda _: None).points()
        return [optimizer.guess(point) for point in points]
