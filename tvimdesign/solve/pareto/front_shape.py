"""The shape of a front, in numbers: which points are beaten, how even they are, where the knee is, where to go next.

Outputs are counted from the least that any end has (0) to the most (1). All points of a front are seen along the
direction in which every output falls alike, as by normal-boundary intersection (Das and Dennis, SIAM J. Optim. 8,
1998): what is left is a line (two outputs) or a plane (three), and lines in that direction meet a front once.
"""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from tvimdesign.solve.nlp.problem_parts import Array, Bound

Values = Mapping[str, float]

FLAT = 0.03  # Greatest distance from the chord, or the plane of the ends, of a front that has no knee
SPAN = 0.03  # Share of an output's least by which it must differ over a front for there to be a trade to speak of
_THIN = 0.1  # Width over length of the hull of the ends below which a front is a curve
_STEPS = 24  # Steps along the edge of a triangle in which places between ends are looked for


@dataclass(frozen=True)
class Frame:
    """The scale of a front: its outputs, the least and the range of each over the ends (SI)."""

    names: tuple[str, ...]
    least: Array
    ranges: Array

    @classmethod
    def of(cls, names: Sequence[str], ends: Sequence[Values]) -> Self:
        """Return the frame of the ends of a front."""
        numbers = np.array([[end[name] for name in names] for end in ends])
        return cls(tuple(names), numbers.min(axis=0), np.ptp(numbers, axis=0))

    def shares(self, values: Values) -> Array:
        """Return a design's outputs, scaled from 0 to 1."""
        return (np.array([values[name] for name in self.names]) - self.least) / self.ranges

    def place(self, values: Values) -> Array:
        """Return the place of a design, seen along the direction in which every output falls alike."""
        shares = self.shares(values)
        return np.asarray(shares - shares.mean())

    def bounds(self, place: Array, reference: Values) -> tuple[Bound, ...]:
        """Return bounds that hold a design to the line through a place: no output lies further above the first.

        The sums are in shares of the output's reference, so that they are as large as the solver's other rows.
        """
        sizes = self.ranges / np.array([reference[name] for name in self.names])
        lines = []
        for i, name in enumerate(self.names[1:], start=1):
            scale = float(min(sizes[0], sizes[i]))
            factors = {name: scale / float(self.ranges[i]), self.names[0]: -scale / float(self.ranges[0])}
            limit = place[i] - place[0] + self.least[i] / self.ranges[i] - self.least[0] / self.ranges[0]
            lines.append(Bound(factors, scale * float(limit)))
        return tuple(lines)


def efficient(rows: Array) -> list[int]:
    """Places of the rows that no other is as good as in every column (less is better); of equal ones the first."""
    places = []
    for i, row in enumerate(rows):
        better = np.all(rows <= row, axis=1) & np.any(rows < row, axis=1)
        if not better.any() and not np.all(rows[:i] == row, axis=1).any():
            places.append(i)
    return places


def spread(shares: Array) -> float:
    """Return the largest gap between neighbours over the mean one; 1 is even. The shortest tree joins neighbours."""
    gaps = neighbours(shares)
    return max(gap for *_, gap in gaps) / (sum(gap for *_, gap in gaps) / len(gaps)) if gaps else 1.0


def neighbours(shares: Array) -> list[tuple[int, int, float]]:
    """Pairs of points that the shortest tree through all of them joins, and how far apart they are."""
    from scipy.sparse.csgraph import minimum_spanning_tree

    if len(shares) < 2:
        return []
    distances = np.linalg.norm(shares[:, None, :] - shares[None, :, :], axis=2)
    relaxation = minimum_spanning_tree(distances).tocoo()
    return sorted(
        (int(min(i, j)), int(max(i, j)), float(d))
        for i, j, d in zip(relaxation.row, relaxation.col, relaxation.data, strict=True)
    )


def little_traded(numbers: Array) -> list[int]:
    """Return the columns of outputs (SI, a row a point) that hardly change over a front; none for a single point."""
    if len(numbers) < 2:
        return []
    least = np.min(np.abs(numbers), axis=0)
    return [int(i) for i in np.flatnonzero(np.ptp(numbers, axis=0) < SPAN * least)]


def knee(shares: Array) -> int | None:
    """Return the point furthest below the chord or plane of the ends; None if no point lies far from it.

    The end of an output is the point that has the least of it.
    """
    if len(shares) < 3:
        return None
    ends = shares[np.argmin(shares, axis=0)]
    across = ends[1:] - ends[0]
    normal = np.ones(shares.shape[1])
    if np.linalg.matrix_rank(across, tol=1e-6) == len(across):
        normal = np.linalg.svd(across)[2][-1]
    normal = normal * np.sign(normal.sum() or 1.0) / np.linalg.norm(normal)
    depths = (ends[0] - shares) @ normal
    deepest = int(np.argmax(depths))
    return deepest if depths[deepest] > FLAT else None


def affine(places: Array, target: Array) -> Array:
    """Weights, of sum one, with which places make up a target as nearly as they can, with the smallest numbers."""
    to_target = (places[1:] - places[0]).T
    weights = np.linalg.lstsq(to_target, target - places[0], rcond=1e-3)[0]
    return np.concatenate([[1.0 - weights.sum()], weights])


def thin(places: Array) -> bool:
    """Return whether places lie nearly on a line: a front of three outputs that is a curve."""
    sizes = np.linalg.svd(places - places.mean(axis=0), compute_uv=False)
    return bool(sizes[1] < _THIN * sizes[0])


def candidates(ends: Array) -> Array:
    """Places all over the hull of those of the ends, in the plane: in three outputs."""
    axes = np.array([[1.0, -1.0, 0.0], [1.0, 1.0, -2.0]]) / np.sqrt([[2.0], [6.0]])
    corners = _corners(ends @ axes.T)
    triangles = [(corners[0], corner, other) for corner, other in itertools.pairwise(corners[1:])]
    steps = [(i, j) for i in range(_STEPS + 1) for j in range(_STEPS + 1 - i)]
    flat = [a + (i * (b - a) + j * (c - a)) / _STEPS for a, b, c in triangles for i, j in steps]
    return np.array(flat) @ axes


def farthest(places: Array, taken: Array) -> tuple[Array, float]:
    """Return the place farthest from all taken ones, and its distance."""
    distances = np.linalg.norm(places[:, None, :] - taken[None, :, :], axis=2).min(axis=1)
    best = int(np.argmax(distances))
    return places[best], float(distances[best])


def _corners(points: Array) -> list[Array]:
    """Corners of the convex hull of points of a plane that are not in line, counter-clockwise from the leftmost."""
    from scipy.spatial import ConvexHull

    ordered = points[np.lexsort((points[:, 1], points[:, 0]))]
    around = ConvexHull(ordered).vertices
    return list(ordered[np.roll(around, -int(np.argmin(around)))])


ALIKE = 2e-3  # Share within which two fronts count as one: the tolerance of the simulation their points come from

Curve = Sequence[tuple[float, float]]  # (limit, what is reached under it) of a front's points, by rising limit


@dataclass(frozen=True)
class Lead:
    """A range of limits, and who does best in it."""

    lower: float
    upper: float  # Infinite for the last one: a front stays where it ends, as a limit that is not active costs nothing
    best: str | None  # None where the best two are alike
    alone: bool  # True if no other one has a design there
    least: float  # Least ratio of the next best to the best over the range; 1 where it is alone
    most: float  # Largest such ratio


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
        alike = len(order) > 1 and at[order[1]] / at[best] - 1.0 <= ALIKE
        now = Lead(lower, upper, None if alike else best, len(order) == 1, min(ratios), max(ratios))
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
