"""A search in boxes: within a small one around a point, then in a wider one around where that ended.

Started at a feasible design, IPOPT may leave it and not reach another one: it moves all numbers off their
limits at once, and looks for the limits from far away. Within a box it stays near, and an optimum of a box that no side
holds is one of the whole problem.
Source: A. Conn, N. Gould, P. Toint, Trust-Region Methods (2000), sections 6.1 and 15.2.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from tvimdesign.solve.nlp.solver_run import Array, Ends, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.statuses import FEASIBLE, NO_DESIGN

_FIRST, _WIDEST, _NARROWEST = 0.05, 0.5, 2e-3
"""Half the width of a box, as a share of each range: of the first one, the most, and the least worth a run."""
_WIDER, _NARROWER = 2.0, 0.25
"""The next box's width over the last one's: where that led on, and where IPOPT lost its way in it."""
_MOST_BOXES = 20
_AT_A_SIDE = 1e-4
"""Share of its range within which a number is held by a side of the box."""


class BoxSearch:
    """Searches from points, with some free numbers within ends of their own."""

    def __init__(
        self,
        optimizer: Optimizer,
        within: Mapping[str, Ends] | None = None,
        leads_away: Callable[[Run], bool] = lambda _: False,
    ) -> None:
        """Start with nothing solved; a search ends, and reports it, at an optimum of a box that `leads_away`."""
        self._optimizer, self._within, self._leads_away = optimizer, dict(within or {}), leads_away
        self.runs: list[Run] = []
        """What each run of the solver came to."""

    def run(self, begin: Array) -> Run:
        """Return the end of a search in boxes from some inputs: converged if it is an optimum of the whole problem."""
        inputs, unknowns, width = begin, self._optimizer.guess(begin), _FIRST
        best: Run | None = None
        held = True
        for _ in range(_MOST_BOXES):
            box = self._box(inputs, width)
            run = self._solved(box, inputs, unknowns)
            # A box without a design leads on as long as none is known: its end is where the limits are broken least.
            if run.start.converged or (best is None and run.start.status == NO_DESIGN):
                best = run if run.start.converged else None
                inputs, unknowns, width = run.inputs, run.unknowns, min(width * _WIDER, _WIDEST)
                held = self._held(run, box)
                if best and self._leads_away(best):
                    return best
            else:
                width *= _NARROWER
            if not held or width < _NARROWEST or self._optimizer.deadline.passed:
                break
        result = self._whole(best, held=held) if best else self.runs[-1]
        result.start = replace(result.start, iterations=sum(run.start.iterations for run in self.runs))
        return result

    def _solved(self, within: Mapping[str, Ends], inputs: Array, unknowns: Array) -> Run:
        run = self._optimizer.solve(within, begin=inputs, unknowns=unknowns, beginning="near")
        self.runs.append(run)
        return run

    def _box(self, inputs: Array, width: float) -> dict[str, Ends]:
        """Ends of every free number, so far around some inputs and no further than what they are to be within."""
        ends = {}
        for free in self._optimizer.free:
            low, high = self._within.get(free.name, (free.lower, free.upper))
            room = width * (free.to_unknown(free.upper) - free.to_unknown(free.lower))
            middle = free.to_unknown(min(max(inputs[self._optimizer.model.index[free.name]], low), high))
            ends[free.name] = (
                max(low, float(free.to_value(middle - room))),
                min(high, float(free.to_value(middle + room))),
            )
        return ends

    def _held(self, run: Run, box: Mapping[str, Ends]) -> bool:
        """Return whether a side of the box stops a number that might go on."""
        for place, free in enumerate(self._optimizer.free):
            near = _AT_A_SIDE * (free.to_unknown(free.upper) - free.to_unknown(free.lower))
            for side, end in zip(box[free.name], self._within.get(free.name, (free.lower, free.upper)), strict=True):
                if side != end and abs(run.unknowns[place] - free.to_unknown(side)) < near:
                    return True
        return False

    def _whole(self, best: Run, *, held: bool) -> Run:
        """Return the optimum of the whole problem from that of the last box; else a design that is no optimum."""
        result = self._optimizer.solve(self._within, warm=best)
        self.runs.append(result)
        if result.start.converged:
            return result
        if held:
            result = self._solved(self._within, best.inputs, best.unknowns)
            best.start = replace(best.start, status=FEASIBLE, converged=False)
        return result if result.start.converged else replace(best, within=self._within)
