"""A certified lower bound on what a study minimises, and the gap to the best design known.

The limits on times are left out, which only adds designs, and what of the goal hangs on a simulation counts as the
least it can be: nothing, for a time. So the bound is certain, and weak where times matter.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tvimdesign.solve.infeasibility.infeasibility_proof import Ranges
from tvimdesign.solve.infeasibility.interval_search import Objective, Paver
from tvimdesign.solve.nlp.constraints import on_cycle
from tvimdesign.solve.optimizer.optimizer import ALGEBRAIC_TOLERANCE, Optimizer


@dataclass(frozen=True)
class LowerBound:
    """What no design can be below."""

    bound: float
    """Of the objective; minus infinity where nothing is certain."""
    best: float | None
    """Objective of the best design known."""
    left_out: tuple[str, ...]
    """Minimised outputs that hang on a simulation, counted as the least they can be."""
    boxes: int

    @property
    def gap(self) -> float | None:
        """How much better than the best known a design could at most be, as a share of it; None without one."""
        if self.best is None or not np.isfinite(self.bound):
            return None
        return (self.best - self.bound) / abs(self.best)


def lower_bound(optimizer: Optimizer, ranges: Ranges, best: float | None, seconds: float) -> LowerBound:
    """Bound the objective for about so many seconds of processor time."""
    minimize = optimizer.study.minimize
    weights = {name: weight / optimizer.reference[name] for name, weight in minimize.items()}
    left_out = tuple(name for name in minimize if on_cycle(optimizer.table, name))
    rest = _rest(ranges, {name: weights[name] for name in left_out})
    algebraic = {name: weight for name, weight in weights.items() if name not in left_out}
    if not np.isfinite(rest) or not algebraic or not ranges.free:
        return LowerBound(rest, best, left_out, 0)
    outputs = dict.fromkeys([*(limit.output for limit in ranges.limits), *algebraic])
    paver = Paver(ranges.enclosure(list(outputs)), ranges.limits, ALGEBRAIC_TOLERANCE, Objective(algebraic, rest))
    below = np.inf if best is None else best + ALGEBRAIC_TOLERANCE * abs(best)
    paved = paver.pave(ranges.low, ranges.high, seconds, below=below)
    return LowerBound(paved.bound, best, left_out, paved.boxes)


def _rest(ranges: Ranges, weights: dict[str, float]) -> float:
    """The least that outputs which hang on a simulation can add, knowing of it only that times are not negative."""
    if not weights:
        return 0.0
    found = ranges.enclosure(list(weights)).natural(ranges.low[None], ranges.high[None])
    signs = np.array(list(weights.values()))
    return float(np.sum(signs * np.where(signs > 0.0, found.low[0], found.high[0])))
