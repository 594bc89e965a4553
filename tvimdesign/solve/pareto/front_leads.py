"""Lead of one front over others: the study that does best in one output for each limit on the other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

ALIKE = 2e-3
"""Share within which two fronts count as one: the tolerance of the simulation their points come from."""

Curve = Sequence[tuple[float, float]]
"""(limit, what is reached under it) of a front's points, by rising limit."""


@dataclass(frozen=True)
class Lead:
    """A range of limits, and who does best in it."""

    lower: float
    upper: float
    """Infinite for the last one: a front stays where it ends, as a limit that does not bind costs nothing."""
    best: str | None
    """None where the best two are alike."""
    alone: bool
    """Whether no other one has a design there."""
    least: float
    """Least ratio of the next best to the best over the range; 1 where it is alone."""
    most: float
    """Largest such ratio."""


def leads(curves: Mapping[str, Curve]) -> list[Lead]:
    """Ranges of the limit by who does best, from the least limit that any one keeps on; straight between points."""
    curves = {label: sorted(curve) for label, curve in curves.items() if curve}
    leading: list[Lead] = []
    for lower, upper in _intervals(curves):
        ends = [lower, upper if math.isfinite(upper) else lower]
        inside = 0.5 * sum(ends)
        at = {label: reached(curve, inside) for label, curve in curves.items()}
        order = sorted((label for label in at if math.isfinite(at[label])), key=at.__getitem__)
        best = order[0]
        ratios = [1.0]
        if len(order) > 1:
            ratios = [reached(curves[order[1]], end) / reached(curves[best], end) for end in ends]
        from_template = len(order) > 1 and at[order[1]] / at[best] - 1.0 <= ALIKE
        now = Lead(lower, upper, None if from_template else best, len(order) == 1, min(ratios), max(ratios))
        if leading and (leading[-1].best, leading[-1].alone) == (now.best, now.alone):
            last = leading.pop()
            now = Lead(last.lower, upper, now.best, now.alone, min(last.least, now.least), max(last.most, now.most))
        leading.append(now)
    return leading


def reached(curve: Curve, limit: float) -> float:
    """Return the value that a front reaches under a limit; infinite below its first point."""
    limits, values = zip(*curve, strict=True)
    return math.inf if limit < limits[0] else float(np.interp(limit, limits, values))


def _intervals(curves: Mapping[str, Curve]) -> list[tuple[float, float]]:
    """Return intervals of limits in which every front is straight and none crosses another; the last is open."""
    marks = {limit for curve in curves.values() for limit, _ in curve}
    for lead, other in itertools.combinations(curves.values(), 2):
        for lower, upper in itertools.pairwise(sorted(marks)):
            gaps = [reached(lead, end) - reached(other, end) for end in (lower, upper)]
            if all(math.isfinite(gap) for gap in gaps) and gaps[0] * gaps[1] < 0.0:
                marks = marks | {lower + (upper - lower) * gaps[0] / (gaps[0] - gaps[1])}
    ordered = sorted(marks)
    return [*itertools.pairwise(ordered), (ordered[-1], math.inf)] if ordered else []
