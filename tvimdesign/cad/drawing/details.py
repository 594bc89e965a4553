"""Details of a section at a larger scale: what is dimensioned and too small to be read in it (ISO 128-3)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import cos, dist, radians, sin, sqrt

from tvimdesign.cad.drawing.drawing_sheet import MARGIN, TITLE_WIDTH, DrawingSheet, figure, ratio
from tvimdesign.cad.drawing.placed_view import PlacedView
from tvimdesign.cad.drawing.projection import Arc, Point, View
from tvimdesign.cad.drawing.sheet_layout import OVER_TITLE

_SIDES = 72
"""Of the polygon that stands for a circle where areas are cut."""
_STEP = 5.0
"""Of an arc's chords [deg]."""


def lines_within(view: View, centre: Point, radius: float) -> list[tuple[Point, Point]]:
    """Return the parts of a view's outlines that lie within a circle."""
    chains = [*(chain.points for chain in view.chains), *map(_chords, view.arcs)]
    return [part for points in chains for line in pairwise(points) for part in _cut(*line, centre, radius)]


def area_within(outline: Sequence[Point], centre: Point, radius: float) -> list[Point]:
    """Return a closed outline cut at a circle; empty outside. By Sutherland and Hodgman (1974), a side at a time."""
    corners = list(outline)
    turns = [radians(360.0 * index / _SIDES) for index in range(_SIDES)]
    for turn in turns:
        out = (cos(turn), sin(turn))
        corners = _on_this_side(corners, centre, radius, out)
    return corners


def _on_this_side(corners: list[Point], centre: Point, radius: float, out: Point) -> list[Point]:
    """Return an outline as far as it lies within a tangent of the circle."""

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
    """Yield the part of a line within a circle."""
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


_SMALL, _TOUCH = 1.0, 1e-3
"""Steps below this length are shown in a detail, unless the sheet shows them so large [mm]; what is as good as none."""
_READ = 5.0
"""Length on paper [mm] from which a step needs no detail, and which it has in one."""
_SCALES = (2.0, 5.0, 10.0, 20.0, 50.0)
"""Of ISO 5455."""
_RADIUS = 17.0
"""Of a detail's circle on paper [mm]."""
_SEEN, _AWAY = 1.2, 6.0
"""Least radius of a detail's circle in the section, and how far from it its letter is [mm on paper]."""
_TURNS = (225.0, 135.0, 180.0, 270.0, 90.0, 45.0, 315.0)
"""Where the letter of a detail may stand beside its circle [deg], heights being told to its right."""
_LETTERS = "XY"
"""Of details: sections and datums have the first letters. As many details as letters."""
HEIGHT = 2.0 * _RADIUS + 16.0
"""That details take over the tables [mm]."""


@dataclass(frozen=True)
class Step:
    """A short upright edge of a cut face, between two heights that are dimensioned."""

    low: Point
    high: Point
    view: int = 0
    """Which of the sections shows it."""

    @property
    def height(self) -> float:
        """Its length [mm]."""
        return self.high[1] - self.low[1]

    @property
    def middle(self) -> Point:
        """Place where its detail is taken."""
        return self.low[0], 0.5 * (self.low[1] + self.high[1])


def small_steps(views: Sequence[View], heights: Sequence[float], scale: float) -> list[Step]:
    """Return smallest steps of the sections that a sheet of this scale shows too small, one for each pair of heights.

    Of those alike the one of the first view, outermost to the right, is taken.
    """
    found: dict[tuple[float, float], Step] = {}
    for index, view in enumerate(views):
        for step in _steps(view, index, min(_SMALL, _READ / scale)):
            pair = round(step.low[1], 3), round(step.high[1], 3)
            known = found.get(pair)
            further = known is None or (known.view == index and step.low[0] > known.low[0])
            if further and all(any(abs(end - height) < _TOUCH for height in heights) for end in pair):
                found[pair] = step
    return sorted(found.values(), key=lambda step: step.height)[: len(_LETTERS)]


def _steps(view: View, index: int, longest: float) -> Iterator[Step]:
    """Yield short upright edges of what a view cuts."""
    for outlines in view.cut:
        for outline in outlines:
            for one, other in pairwise([*outline.points, outline.points[0]]):
                low, high = sorted((one, other), key=lambda point: point[1])
                if _TOUCH < high[1] - low[1] < longest and abs(low[0] - high[0]) < _TOUCH:
                    yield Step(low, high, index)


def draw_details(placed: Sequence[PlacedView], steps: Sequence[Step], table: float) -> None:
    """Draw the steps' surroundings over the tables, enlarged, and mark in the sections where each is."""
    for index, (letter, step) in enumerate(zip(_LETTERS, steps, strict=False)):
        view = placed[step.view]
        sheet = view.sheet
        left = sheet.size[0] - MARGIN - TITLE_WIDTH
        scale = next((one for one in _SCALES if one * step.height >= _READ), _SCALES[-1])
        at = (left + 8.0 + _RADIUS + index * 0.5 * TITLE_WIDTH, OVER_TITLE + table + 6.0 + _RADIUS)
        _mark(view, step.middle, _RADIUS / scale, letter)
        _draw(sheet, view.view, step, scale, at)
        sheet.text(f"{letter} ({ratio(scale)})", (at[0], at[1] + _RADIUS + 4.5), 3.5, "MIDDLE_CENTER")


def _mark(front: PlacedView, middle: Point, radius: float, letter: str) -> None:
    """Draw a thin circle around a place of the section, a leader, and its letter where no face is cut."""
    seen = max(radius, front.paper(_SEEN))
    front.sheet.space.add_circle(front.at(*middle), seen, dxfattribs={"layer": "FINE"})
    turns = [radians(turn) for turn in _TURNS]
    away, half = seen + front.paper(_AWAY), front.paper(1.8)
    ends = [(middle[0] + away * cos(turn), middle[1] + away * sin(turn)) for turn in turns]
    free = next((index for index, end in enumerate(ends) if not _meets_cut(front.view, end, half)), 0)
    start = (middle[0] + seen * cos(turns[free]), middle[1] + seen * sin(turns[free]))
    short = 1.0 - 1.6 * half / (away - seen)
    (x, y), (far, high) = start, ends[free]
    front.line(start, (x + short * (far - x), y + short * (high - y)), "FINE")
    front.sheet.text(letter, front.on_paper(far, high), 3.5, "MIDDLE_CENTER")


def _meets_cut(view: View, middle: Point, half: float) -> bool:
    """Return whether a square lies on a cut face."""
    shifts = ((0.0, 0.0), (half, half), (half, -half), (-half, half), (-half, -half))
    return any(_is_cut(view, (middle[0] + right, middle[1] + up)) for right, up in shifts)


def _is_cut(view: View, point: Point) -> bool:
    """Return whether a point lies in a cut face: outlines to its right are crossed an odd number of times."""
    crossed = 0
    for outlines in view.cut:
        for outline in outlines:
            for (x, y), (far, high) in pairwise([*outline.points, outline.points[0]]):
                if (y > point[1]) != (high > point[1]):
                    crossed += point[0] < x + (point[1] - y) * (far - x) / (high - y)
    return crossed % 2 == 1


def _draw(sheet: DrawingSheet, view: View, step: Step, scale: float, at: Point) -> None:
    """Draw what is around a step, enlarged about its middle, with the step's height to the right."""
    radius = _RADIUS / scale
    more = scale / sheet.scale
    x, y = sheet.at(at)

    def placed(point: Point) -> Point:
        return x + more * (point[0] - step.middle[0]), y + more * (point[1] - step.middle[1])

    for start, end in lines_within(view, step.middle, radius):
        sheet.space.add_line(placed(start), placed(end), dxfattribs={"layer": "OUTLINE"})
    for outlines in view.cut:
        cut = [area_within(one.points, step.middle, radius) for one in outlines]
        if not cut[0]:
            continue
        hatch = sheet.space.add_hatch(dxfattribs={"layer": "HATCH"})
        hatch.set_pattern_fill("ANSI31", scale=0.8 / sheet.scale)
        for index, corners in enumerate(one for one in cut if one):
            hatch.paths.add_polyline_path(
                [placed(one) for one in corners], is_closed=True, flags=1 if index == 0 else 16
            )
    sheet.space.add_circle((x, y), _RADIUS / sheet.scale, dxfattribs={"layer": "FINE"})
    ends = placed(step.low), placed(step.high)
    base = sheet.at((at[0] + _RADIUS + 7.0, at[1]))
    sheet.space.add_linear_dim(
        base, *ends, angle=90, text=figure(step.height), dimstyle="SHEET",
        override={"dimlfac": 1.0 / more}, dxfattribs={"layer": "DIMENSION"},
    ).render()  # fmt: skip
