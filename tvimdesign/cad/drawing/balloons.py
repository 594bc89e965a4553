"""Numbers beside the plan, each with a leader to the feature of its row in the table; no leader crosses another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import ceil, cos, dist, hypot, pi, radians, sin

import numpy as np
from scipy.spatial import cKDTree

from tvimdesign.cad.drawing.feature_rows import FeatureRow
from tvimdesign.cad.drawing.placed_view import CuttingMark, PlacedView
from tvimdesign.cad.drawing.projection import Chain

Point = tuple[float, float]
Line = tuple[Point, Point]
_RADIUS = 2.7
"""Of the circle around a number [mm]."""
_REACHES = (7.0, 9.0, 12.0, 15.0, 19.0, 24.0, 30.0, 38.0, 48.0, 60.0, 75.0, 95.0)
"""Lengths of leaders that are tried [mm]."""
_WAYS = 48
_COVERED = 10.0
"""Length of a leader [mm] that a number is moved for each point of an outline that it would cover."""
_STEP = 1.0
"""Distance of the points of outlines that are looked at [mm]."""
_FREE = 1.6
"""Least distance of a number and a leader from what others point at [mm]."""
_ARROW = 1.4
"""Least distance of a number's circle from a section's mark [mm], whose arrow is 0.8 wide to either side."""


@dataclass
class _Placed:
    """Lines and numbers that are on paper already."""

    feet: dict[int, list[Point]]
    """Where each row can be pointed at."""
    outlines: cKDTree
    """Points of the plan's lines."""
    circles: list[Point] = field(default_factory=list)
    leaders: list[Line] = field(default_factory=list)
    strokes: list[Line] = field(default_factory=list)
    """Of the marks where sections are taken."""


def draw_balloons(
    plan: PlacedView, rows: Sequence[FeatureRow], room: tuple[float, float, float, float], marks: Sequence[CuttingMark]
) -> None:
    """Number the rows in the plan.

    `room` is where numbers may stand on paper: least and largest x, then y [mm]; `marks` are where sections are taken.
    """
    scale, (left, bottom) = plan.sheet.scale, plan.origin
    feet = {
        index: [(left + x * scale, bottom + y * scale) for x, y in row.points]
        for index, row in enumerate(rows, start=1)
    }
    strokes = [stroke for mark in marks for stroke in pairwise(mark.corners)]
    placed = _Placed(feet, _outlines(plan), [mark.letter for mark in marks], strokes=strokes)
    # Those with the fewest places to point at choose first.
    for index in sorted(feet, key=lambda one: (len(feet[one]), one)):
        leader = next((one for one in _leaders(placed, index, room) if _is_free(placed, one)), None)
        if leader:
            placed.circles.append(leader[1])
            placed.leaders.append(leader)
            _draw(plan, index, leader)


def _outlines(plan: PlacedView) -> cKDTree:
    """Return points of the plan's visible and hidden lines on paper."""
    view, scale = plan.view, plan.sheet.scale
    points: list[Point] = []
    for curve in (*view.arcs, *view.chains, *view.hidden):
        if isinstance(curve, Chain):
            for start, end in pairwise(curve.points):
                count = max(2, ceil(dist(start, end) * scale / _STEP))
                points += [(float(x), float(y)) for x, y in np.linspace(start, end, count)]
        else:
            count = max(2, ceil(radians(curve.end - curve.start) * curve.radius * scale / _STEP))
            angles = np.radians(np.linspace(curve.start, curve.end, count))
            x, y = curve.centre
            points += [(x + curve.radius * cos(angle), y + curve.radius * sin(angle)) for angle in angles]
    return cKDTree(np.array(points) * scale + np.array(plan.origin))


def _leaders(placed: _Placed, index: int, room: tuple[float, float, float, float]) -> Iterator[Line]:
    """Yield the leaders of a row from foot to number, those first that are short and whose number covers few lines."""
    left, right, bottom, top = room
    angles = 2.0 * pi * (np.arange(_WAYS) + 0.5) / _WAYS
    reaches, feet = np.array(_REACHES), np.array(placed.feet[index]).reshape(-1, 2)
    away = reaches[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    numbers = (feet[:, None, None, :] + away).reshape(-1, 2)
    inside = (numbers > (left, bottom)).all(axis=1) & (numbers < (right, top)).all(axis=1)
    covered = placed.outlines.query_ball_point(numbers, _RADIUS + 0.7, return_length=True)
    cost = np.broadcast_to(reaches[None, :, None], (len(feet), len(reaches), _WAYS)).ravel() + _COVERED * covered
    for one in np.argsort(np.where(inside, cost, np.inf), kind="stable")[: int(inside.sum())].tolist():
        foot = feet[one // (len(reaches) * _WAYS)]
        yield (float(foot[0]), float(foot[1])), (float(numbers[one][0]), float(numbers[one][1]))


def _is_free(placed: _Placed, leader: Line) -> bool:
    foot, number = leader
    edge = _towards(number, foot)
    return (
        all(dist(number, other) > 2.0 * _RADIUS + 0.8 for other in placed.circles)
        and all(_away(other, (foot, edge)) > _RADIUS + 0.6 for other in placed.circles)
        and all(_away(number, (line[0], _towards(line[1], line[0]))) > _RADIUS + 0.6 for line in placed.leaders)
        and all(_away(number, stroke) > _RADIUS + _ARROW for stroke in placed.strokes)
        and not any(_crosses((foot, edge), line) for line in (*placed.leaders, *placed.strokes))
        and all(_away(end, (foot, edge)) > _FREE for stroke in placed.strokes for end in stroke)
        and all(dist(foot, line[0]) > _FREE for line in placed.leaders)
    )


def _towards(number: Point, foot: Point) -> Point:
    """Return where a leader ends at the circle around its number."""
    reach = dist(number, foot)
    share = (reach - _RADIUS) / reach
    return foot[0] + share * (number[0] - foot[0]), foot[1] + share * (number[1] - foot[1])


def _away(point: Point, line: Line) -> float:
    """Return the distance of a point from a line between two others."""
    (x, y), (to_x, to_y) = line
    along_x, along_y = to_x - x, to_y - y
    share = ((point[0] - x) * along_x + (point[1] - y) * along_y) / (along_x**2 + along_y**2)
    share = min(1.0, max(0.0, share))
    return hypot(point[0] - x - share * along_x, point[1] - y - share * along_y)


def _crosses(one: Line, other: Line) -> bool:
    """Return whether two lines have a point in common."""

    def side(line: Line, point: Point) -> float:
        (x, y), (to_x, to_y) = line
        return (to_x - x) * (point[1] - y) - (to_y - y) * (point[0] - x)

    apart = side(one, other[0]) * side(one, other[1]) > 0.0
    return not apart and side(other, one[0]) * side(other, one[1]) <= 0.0


def _draw(plan: PlacedView, index: int, leader: Line) -> None:
    sheet, (foot, number) = plan.sheet, leader
    layer = {"layer": "DIMENSION"}
    sheet.space.add_line(sheet.at(foot), sheet.at(_towards(number, foot)), dxfattribs=layer)
    sheet.space.add_circle(sheet.at(foot), 0.4 / sheet.scale, dxfattribs=layer)
    sheet.space.add_circle(sheet.at(number), _RADIUS / sheet.scale, dxfattribs=layer)
    sheet.text(str(index), number, 2.5, "MIDDLE_CENTER")
