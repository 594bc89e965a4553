"""What of a view lies within a circle: lines cut at it, and areas."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import cos, dist, radians, sin, sqrt

from tvimdesign.cad.drawing.projection import Arc, Point, View

_SIDES = 72
"""Of the polygon that stands for a circle where areas are cut."""
_STEP = 5.0
"""Of an arc's chords [deg]."""


def lines_within(view: View, centre: Point, radius: float) -> list[tuple[Point, Point]]:
    """The parts of a view's outlines that lie within a circle."""
    chains = [*(chain.points for chain in view.chains), *map(_chords, view.arcs)]
    return [part for points in chains for line in pairwise(points) for part in _cut(*line, centre, radius)]


def area_within(outline: Sequence[Point], centre: Point, radius: float) -> list[Point]:
    """A closed outline cut at a circle; empty outside. By Sutherland and Hodgman (1974), a side at a time."""
    corners = list(outline)
    turns = [radians(360.0 * index / _SIDES) for index in range(_SIDES)]
    for turn in turns:
        out = (cos(turn), sin(turn))
        corners = _on_this_side(corners, centre, radius, out)
    return corners


def _on_this_side(corners: list[Point], centre: Point, radius: float, out: Point) -> list[Point]:
    """An outline as far as it lies within a tangent of the circle."""

    def beyond(point: Point) -> float:
        return (point[0] - centre[0]) * out[0] + (point[1] - centre[1]) * out[1] - radius

    kept: list[Point] = []
    for here, there in zip(corners, [*corners[1:], *corners[:1]], strict=True):
        one, other = beyond(here), beyond(there)
        if one <= 0.0:
            kept.append(here)
        if one * other < 0.0:
            share = one / (one - other)
            kept.append((here[0] + share * (there[0] - here[0]), here[1] + share * (there[1] - here[1])))
    return kept


def _cut(start: Point, end: Point, centre: Point, radius: float) -> Iterator[tuple[Point, Point]]:
    """The part of a line within a circle."""
    length = dist(start, end)
    if length == 0.0:
        return
    along = ((end[0] - start[0]) / length, (end[1] - start[1]) / length)
    to = (centre[0] - start[0], centre[1] - start[1])
    nearest = to[0] * along[0] + to[1] * along[1]
    aside = to[0] * along[1] - to[1] * along[0]
    if abs(aside) >= radius:
        return
    half = sqrt(radius**2 - aside**2)
    first, last = max(nearest - half, 0.0), min(nearest + half, length)
    if first < last:
        yield (
            (start[0] + first * along[0], start[1] + first * along[1]),
            (start[0] + last * along[0], start[1] + last * along[1]),
        )


def _chords(arc: Arc) -> list[Point]:
    count = max(int((arc.end - arc.start) % 360.0 / _STEP), 1) if arc.end - arc.start != 360.0 else int(360.0 / _STEP)
    span = (arc.end - arc.start) % 360.0 or 360.0
    turns = [radians(arc.start + span * index / count) for index in range(count + 1)]
    return [(arc.centre[0] + arc.radius * cos(turn), arc.centre[1] + arc.radius * sin(turn)) for turn in turns]
