"""Layout of a part's views: the sheet, its scale, each view's origin, and the table of features.

Numbers beside the plan, each with a leader to the feature of its row in the table; no leader crosses another.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import ceil, cos, dist, hypot, pi, radians, sin

import numpy as np
from scipy.spatial import cKDTree

from tvimdesign.cad.drawing.drawing_requirements import DATUM, DrawingRequirements, Seat
from tvimdesign.cad.drawing.drawing_sheet import MARGIN, SIZES, TITLE_WIDTH, DrawingSheet, figure
from tvimdesign.cad.drawing.feature_rows import FeatureRow
from tvimdesign.cad.drawing.iso_1101 import draw_frames
from tvimdesign.cad.drawing.placed_view import CuttingMark, PlacedView
from tvimdesign.cad.drawing.projection import Chain, View

_OVER_TITLE = 65.0  # Height on the sheet above which there is room over the title block [mm]
_LINE, _FRAME = 4.6, 5.2  # Height of its lines, and of those with tolerance frames [mm]
_OVER = 0.8  # Room over and below a feature with a second line [mm]
_SMALL, _TEXT = 1.8, 2.3
_INDENT = 9.0
_COLUMNS = (0.0, 5.0, 40.0, 59.0, 73.0, 102.0, 112.0)  # Where the columns of the seats begin [mm]
_SEATS = ("", "Seat", "fit", "limits µm", "limits of size", "Ra µm", "form and place")
_ABOUT = 42.0  # Where the frames of a feature begin, behind what it is for [mm]


def table_height(rows: Sequence[FeatureRow], requirements: DrawingRequirements) -> float:
    """Return the height on paper that both tables take [mm]."""
    features = sum(_LINE + (_FRAME + 2.0 * _OVER if _asks(row) else 0.0) for row in rows)
    return features + 2.0 * _LINE + (len(requirements.seats) * (_FRAME + 0.8) + _LINE if requirements.seats else 0.0)


def draw_tables(sheet: DrawingSheet, rows: Sequence[FeatureRow], requirements: DrawingRequirements) -> None:
    """Draw seats over the title block and features over them, the first number on top."""
    left = sheet.size[0] - MARGIN - TITLE_WIDTH
    level = _OVER_TITLE
    for seat in reversed(requirements.seats):
        _draw_seat(sheet, seat, (left, level))
        level += _FRAME + 0.8
    if requirements.seats:
        _cells(sheet, _SEATS, (left, level), _SMALL)
        level += _LINE + 2.0
    for index, row in reversed(list(enumerate(rows, start=1))):
        if _asks(row):
            level += _OVER
            sheet.text(row.asks, (left + _INDENT, level), _TEXT)
            draw_frames(sheet, row.frames, (left + _ABOUT, level - 0.8))
            level += _FRAME
        sheet.text(str(index), (left, level), _TEXT)
        sheet.text(row.text, (left + _INDENT, level), _TEXT, room=TITLE_WIDTH - _INDENT - 1.0)
        level += _LINE + (_OVER if _asks(row) else 0.0)
    if rows:
        sheet.text("Number in the plan, feature", (left, level), _SMALL)


def _asks(row: FeatureRow) -> bool:
    """Return whether a second line is needed."""
    return bool(row.asks or row.frames)


def _draw_seat(sheet: DrawingSheet, seat: Seat, at: tuple[float, float]) -> None:
    """Write the table's line of a seat."""
    left, level = at
    lower, upper = (f"{1e3 * limit:+.4g}" if limit else "0" for limit in seat.limits)
    limits = f"±{upper[1:]}" if seat.limits.lower == -seat.limits.upper else f"{upper} / {lower}"
    within = f"{seat.size + seat.limits.lower:.3f} to {seat.size + seat.limits.upper:.3f}"
    fitted = (f"⌀{figure(seat.size)} {seat.fit}", limits, within)
    cells = fitted if seat.fit else (f"⌀{figure(seat.drawn)}", "as drawn", "general")
    _cells(sheet, (seat.letter, seat.about, *cells, f"{seat.roughness:g}", seat.form), at, _TEXT)
    draw_frames(sheet, seat.frames, (left + _COLUMNS[-1], level - 0.8))


def _cells(sheet: DrawingSheet, texts: Sequence[str], at: tuple[float, float], height: float) -> None:
    for column, text in zip(_COLUMNS, texts, strict=True):
        if text:
            sheet.text(text, (at[0] + column, at[1]), height)


def with_datum(rows: Sequence[FeatureRow]) -> list[FeatureRow]:
    """Return the rows with the first arc about the axis as datum: for a part without a round face about it."""
    marked = list(rows)
    for index, row in enumerate(rows):
        if row.place.startswith("about the axis"):
            marked[index] = replace(row, asks=f"datum {DATUM}: its axis")
            break
    return marked


Room = tuple[float, float, float, float]
SCALES = (20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1)  # Of ISO 5455
_LARGE = 2.0  # Scale from which the smaller sheet will do
FIRST, NEXT = 8.0, 6.5  # Height of the first dimension over a section, and of each further one over that [mm]
_LEFT, _LEVELS, _BETWEEN, _BELOW = 24.0, 36.0, 24.0, 18.0
"""Room left of the views, right of a section for its heights, between section and plan, and below the plan [mm]."""
_NOTES = 44.0  # Height that notes take over the tables [mm]


@dataclass(frozen=True)
class Layout:
    """Places of the views' origins on a sheet [mm]."""

    form: str
    scale: float
    plan: tuple[float, float]
    front: tuple[float, float]
    half: tuple[float, float]  # Of the half section beside the front view
    room: Room  # Where numbers may stand around the plan: least and largest x, then y


def layout(plan: View, front: View, half: View | None, diameters: int, table: float) -> Layout:
    """Return the largest standard scale on the smallest sheet that shows the part doubled, or on the larger sheet."""
    over = FIRST + NEXT * (diameters + 1)
    best = [(_scale_on(size, plan, front, half, over, table), name) for name, size in SIZES.items()]
    scale, form = next((fit for fit in best if fit[0] >= _LARGE), max(best, key=lambda fit: fit[0]))
    scale = scale or SCALES[-1]
    wide, high = _needed(plan, front, half, over, scale)
    right, top = SIZES[form][0] - MARGIN - TITLE_WIDTH - 6.0, SIZES[form][1] - MARGIN
    start = MARGIN + 0.5 * max(right - MARGIN - wide, 0.0) + _LEFT
    level = MARGIN + 0.5 * max(top - MARGIN - high, 0.0) + _BELOW
    x = start - min(plan.bounds[0], front.bounds[0]) * scale
    plan_at = (x, level - plan.bounds[2] * scale)
    front_at = (x, plan_at[1] + plan.bounds[3] * scale + _BETWEEN - front.bounds[2] * scale)
    half_x = x + front.bounds[1] * scale + _LEVELS - (min(half.bounds[0], 0.0) * scale if half else 0.0)
    bottom_of_front = front_at[1] + front.bounds[2] * scale
    room = (MARGIN + 4.0, right - 2.0, MARGIN + 4.0, bottom_of_front - 10.0)
    return Layout(form, scale, plan_at, front_at, (half_x, front_at[1]), room)


def _needed(plan: View, front: View, half: View | None, over: float, scale: float) -> tuple[float, float]:
    """Return width and height on paper of all views with their dimensions."""
    section = (front.bounds[1] - front.bounds[0] + (half.bounds[1] if half else 0.0)) * scale + _LEVELS
    wide = _LEFT + max(section, (plan.bounds[1] - plan.bounds[0]) * scale + _LEFT)
    high = (plan.bounds[3] - plan.bounds[2] + front.bounds[3] - front.bounds[2]) * scale
    return wide, high + _BELOW + _BETWEEN + over


def _scale_on(
    size: tuple[float, float], plan: View, front: View, half: View | None, over: float, table: float
) -> float:
    """Return the largest scale at which a sheet has room for views and table; 0 where it has none."""
    width, height = size[0] - 2.0 * MARGIN - TITLE_WIDTH - 6.0, size[1] - 2.0 * MARGIN
    if _OVER_TITLE - MARGIN + table + _NOTES > height:
        return 0.0
    for scale in SCALES:
        wide, high = _needed(plan, front, half, over, scale)
        if wide <= width and high <= height:
            return scale
    return 0.0


Point = tuple[float, float]
Line = tuple[Point, Point]
RADIUS = 2.7  # Of the circle around a number [mm]
_REACHES = (7.0, 9.0, 12.0, 15.0, 19.0, 24.0, 30.0, 38.0, 48.0, 60.0, 75.0, 95.0)
"""Lengths of leaders that are tried [mm]."""
_WAYS = 48
_COVERED = 10.0  # Length of a leader [mm] that a number is moved for each point of an outline that it would cover
_STEP = 1.0  # Distance of the points of outlines that are looked at [mm]
_FREE = 1.6  # Least distance of a number and a leader from what others point at [mm]
_ARROW = 1.4  # Least distance of a number's circle from a section's mark [mm], whose arrow is 0.8 wide to either side


@dataclass
class _Placed:
    """Lines and numbers that are on paper already."""

    feet: dict[int, list[Point]]  # Where each row can be pointed at
    outlines: cKDTree  # Points of the plan's lines
    circles: list[Point] = field(default_factory=list)
    leaders: list[Line] = field(default_factory=list)
    strokes: list[Line] = field(default_factory=list)  # Of the marks where sections are taken


def draw_balloons(plan: PlacedView, rows: Sequence[FeatureRow], room: Room, marks: Sequence[CuttingMark]) -> None:
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
    for index in sorted(feet, key=lambda number: (len(feet[number]), number)):
        leader = next((line for line in _leaders(placed, index, room) if _is_free(placed, line)), None)
        if leader:
            placed.circles.append(leader[1])
            placed.leaders.append(leader)
            draw_balloon(plan.sheet, index, leader)


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


def _leaders(placed: _Placed, index: int, room: Room) -> Iterator[Line]:
    """Yield the leaders of a row from foot to number, those first that are short and whose number covers few lines."""
    left, right, bottom, top = room
    angles = 2.0 * pi * (np.arange(_WAYS) + 0.5) / _WAYS
    reaches, feet = np.array(_REACHES), np.array(placed.feet[index]).reshape(-1, 2)
    away = reaches[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    numbers = (feet[:, None, None, :] + away).reshape(-1, 2)
    inside = (numbers > (left, bottom)).all(axis=1) & (numbers < (right, top)).all(axis=1)
    covered = placed.outlines.query_ball_point(numbers, RADIUS + 0.7, return_length=True)
    cost = np.broadcast_to(reaches[None, :, None], (len(feet), len(reaches), _WAYS)).ravel() + _COVERED * covered
    for place in np.argsort(np.where(inside, cost, np.inf), kind="stable")[: int(inside.sum())].tolist():
        foot = feet[place // (len(reaches) * _WAYS)]
        yield (float(foot[0]), float(foot[1])), (float(numbers[place][0]), float(numbers[place][1]))


def _is_free(placed: _Placed, leader: Line) -> bool:
    foot, number = leader
    edge = towards(number, foot)
    return (
        all(dist(number, other) > 2.0 * RADIUS + 0.8 for other in placed.circles)
        and all(clearance(other, (foot, edge)) > RADIUS + 0.6 for other in placed.circles)
        and all(clearance(number, (line[0], towards(line[1], line[0]))) > RADIUS + 0.6 for line in placed.leaders)
        and all(clearance(number, stroke) > RADIUS + _ARROW for stroke in placed.strokes)
        and not any(crosses((foot, edge), line) for line in (*placed.leaders, *placed.strokes))
        and all(clearance(end, (foot, edge)) > _FREE for stroke in placed.strokes for end in stroke)
        and all(dist(foot, line[0]) > _FREE for line in placed.leaders)
    )


def towards(number: Point, foot: Point) -> Point:
    """Return where a leader ends at the circle around its number."""
    reach = dist(number, foot)
    share = (reach - RADIUS) / reach
    return foot[0] + share * (number[0] - foot[0]), foot[1] + share * (number[1] - foot[1])


def clearance(point: Point, line: Line) -> float:
    """Return the distance of a point from a line between two others."""
    (x, y), (to_x, to_y) = line
    along_x, along_y = to_x - x, to_y - y
    share = ((point[0] - x) * along_x + (point[1] - y) * along_y) / (along_x**2 + along_y**2)
    share = min(1.0, max(0.0, share))
    return hypot(point[0] - x - share * along_x, point[1] - y - share * along_y)


def crosses(leader: Line, other: Line) -> bool:
    """Return whether two lines have a point in common."""

    def side(line: Line, point: Point) -> float:
        (x, y), (to_x, to_y) = line
        return (to_x - x) * (point[1] - y) - (to_y - y) * (point[0] - x)

    apart = side(leader, other[0]) * side(leader, other[1]) > 0.0
    return not apart and side(other, leader[0]) * side(other, leader[1]) <= 0.0


def draw_balloon(sheet: DrawingSheet, index: int, leader: Line) -> None:
    """Draw a number in a circle at the end of a leader, and a dot where that starts: places on paper [mm]."""
    foot, number = leader
    layer = {"layer": "DIMENSION"}
    sheet.space.add_line(sheet.at(foot), sheet.at(towards(number, foot)), dxfattribs=layer)
    sheet.space.add_circle(sheet.at(foot), 0.4 / sheet.scale, dxfattribs=layer)
    sheet.space.add_circle(sheet.at(number), RADIUS / sheet.scale, dxfattribs=layer)
    sheet.text(str(index), number, 2.5, "MIDDLE_CENTER")
