"""A view on a drawing's sheet: its outlines, axes and the line of its section."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import atan2, cos, degrees, dist, hypot, sin

from tvimdesign.cad.drawing.drawing_sheet import DrawingSheet
from tvimdesign.cad.drawing.projection import Arc, Chain, View
from tvimdesign.cad.geometry.features import Cylinder

_ANSI31 = 3.175  # Distance of the lines of that pattern [mm]
_CLEAR = 4.5  # Least distance of the letters and strokes of two sections [mm]: letters are 3.5 high


@dataclass(frozen=True)
class CuttingMark:
    """Marks on paper of where a section is taken [mm]."""

    letter: tuple[float, float]  # Middle of its letter
    corners: tuple[tuple[float, float], ...]
    """From the inner end of the thick stroke over the corner to the arrow's tip."""
    barbs: tuple[tuple[float, float], ...]  # Both ends of the arrow's back

    def lies_on(self, other: "CuttingMark") -> bool:
        """Return whether it is so near to another that letters or strokes touch."""
        return any(dist(near, far) < _CLEAR for near in self._points for far in other._points)

    @property
    def _points(self) -> tuple[tuple[float, float], ...]:
        middles = (((x + far) / 2.0, (y + high) / 2.0) for (x, y), (far, high) in pairwise(self.corners))
        return (self.letter, *self.corners, *middles)


@dataclass(frozen=True)
class PlacedView:
    """A view on a sheet, its own origin at a place on paper."""

    sheet: DrawingSheet
    view: View
    origin: tuple[float, float]

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Return where a point of the view is in the drawing's coordinates."""
        left, bottom = self.sheet.at(self.origin)
        return left + x, bottom + y

    def on_paper(self, x: float, y: float) -> tuple[float, float]:
        """Return where a point of the view is on paper [mm]."""
        return self.origin[0] + x * self.sheet.scale, self.origin[1] + y * self.sheet.scale

    def paper(self, length: float) -> float:
        """Return a length on paper [mm] in the drawing's coordinates."""
        return length / self.sheet.scale

    def draw(self) -> None:
        """Draw outlines and hatching."""
        for behind in self.view.hidden:
            self.curve(behind, "HIDDEN")
        for arc in self.view.arcs:
            self.curve(arc, "OUTLINE")
        for chain in self.view.chains:
            self.curve(chain, "OUTLINE")
        for outlines in self.view.cut:
            self.hatch(outlines)

    def hatch(self, outlines: Sequence[Chain], turned: float = 0.0, spacing: float = 2.54) -> None:
        """Hatch a cut face within its outline, outside its holes: lines at 45° and more [deg], so far apart [mm]."""
        hatch = self.sheet.space.add_hatch(dxfattribs={"layer": "HATCH"})
        hatch.set_pattern_fill("ANSI31", scale=spacing / _ANSI31 / self.sheet.scale, angle=turned)
        for index, outline in enumerate(outlines):
            points = [self.at(*point) for point in outline.points]
            hatch.paths.add_polyline_path(points, is_closed=True, flags=1 if index == 0 else 16)

    def curve(self, curve: Arc | Chain, layer: str) -> None:
        """Draw an arc or a chain of the view."""
        space, of = self.sheet.space, {"layer": layer}
        if isinstance(curve, Chain):
            # Bit 128: dashes run on through the corners.
            space.add_lwpolyline([self.at(*point) for point in curve.points], dxfattribs=of | {"flags": 128})
        elif curve.end - curve.start == 360.0:
            space.add_circle(self.at(*curve.centre), curve.radius, dxfattribs=of)
        else:
            space.add_arc(self.at(*curve.centre), curve.radius, curve.start, curve.end, dxfattribs=of)

    def line(self, start: tuple[float, float], end: tuple[float, float], layer: str = "CENTRE") -> None:
        """Draw a line between two points of the view."""
        self.sheet.space.add_line(self.at(*start), self.at(*end), dxfattribs={"layer": layer})

    def axis(self) -> None:
        """Draw the axis of the module in a view from the front."""
        over = self.paper(3.0)
        if self.has_axis:
            self.line((0.0, self.view.bounds[2] - over), (0.0, self.view.bounds[3] + over))

    @property
    def has_axis(self) -> bool:
        """True if the module's axis goes through the part: of a segment beside it, it may lie off the sheet."""
        return self.view.bounds[0] <= 0.0 <= self.view.bounds[1]

    def centre_lines(self, rounds: Sequence[Cylinder]) -> None:
        """Draw a cross at the axis, the circles on which holes and pins stand, and a cross at each of those.

        Of a part beside the axis only as much of each circle as its holes are on, and no cross.
        """
        left, right, bottom, top = self.view.bounds
        over = self.paper(3.0)
        self.line((left - over, 0.0), (right + over, 0.0))
        if self.has_axis:
            self.line((0.0, bottom - over), (0.0, top + over))
        beside = [hole for hole in rounds if not hole.is_central]
        pitches = [round(hypot(hole.x, hole.y), 4) for hole in beside]
        for pitch in sorted({pitch for pitch in pitches if pitches.count(pitch) > 1}):
            if self.has_axis:
                self.sheet.space.add_circle(self.at(0.0, 0.0), pitch, dxfattribs={"layer": "CENTRE"})
                continue
            there = [degrees(atan2(hole.y, hole.x)) for hole in beside if abs(hypot(hole.x, hole.y) - pitch) < 1e-3]
            more = degrees(over / pitch)
            self.sheet.space.add_arc(
                self.at(0.0, 0.0), pitch, min(there) - more, max(there) + more, dxfattribs={"layer": "CENTRE"}
            )
        for x, y, radius in sorted({(hole.x, hole.y, hole.radius) for hole in beside}):
            arm = radius + self.paper(1.5)
            self.line((x - arm, y), (x + arm, y))
            self.line((x, y - arm), (x, y + arm))

    def cutting_mark(
        self, letter: str, azimuth: float, reach: float, others: Sequence[CuttingMark] = (), *, on_left: bool = False
    ) -> CuttingMark:
        """Mark where a section is taken, `reach` from the axis at an azimuth [rad]: an arrow as it is looked at.

        Further out, where it would lie on one of the others; `on_left` if the section has that half left of the axis.
        """
        mark = self._mark_at(azimuth, reach, on_left)
        while any(mark.lies_on(other) for other in others):
            reach += self.paper(1.0)
            mark = self._mark_at(azimuth, reach, on_left)
        inner, corner, tip = (self.sheet.at(point) for point in mark.corners)
        self.sheet.space.add_line(inner, corner, dxfattribs={"layer": "OUTLINE"})
        self.sheet.space.add_line(corner, tip, dxfattribs={"layer": "FINE"})
        self.sheet.space.add_solid([*map(self.sheet.at, mark.barbs), tip], dxfattribs={"layer": "FINE"})
        self.sheet.text(letter, mark.letter, 3.5, "MIDDLE_CENTER")
        return mark

    def _mark_at(self, azimuth: float, reach: float, on_left: bool) -> CuttingMark:
        out, way = (cos(azimuth), sin(azimuth)), -1.0 if on_left else 1.0
        beside = (-way * sin(azimuth), way * cos(azimuth))

        def at(along: float, aside: float) -> tuple[float, float]:
            far = reach + self.paper(along)
            across = self.paper(aside)
            return self.on_paper(far * out[0] + across * beside[0], far * out[1] + across * beside[1])

        corners = (at(3.0, 0.0), at(8.0, 0.0), at(8.0, 5.0))
        return CuttingMark(at(8.0, -3.5), corners, (at(7.2, 2.75), at(8.8, 2.75)))

    def threads(self, screws: Sequence[tuple[float, float, float]]) -> None:
        """Draw threads of holes from above, three quarters of a thin circle each (ISO 6410-1).

        Of each hole: x, y and the screw's diameter.
        """
        for x, y, wide in screws:
            centre = self.at(x, y)
            self.sheet.space.add_arc(centre, 0.5 * wide, 100.0, 10.0, dxfattribs={"layer": "FINE"})

    def cut_thread(self, x: float, wide: float, mouth: float, end: float) -> None:
        """Draw the thread of a hole in the plane of a section: thin lines to its end, a thick one there."""
        half = 0.5 * wide
        for side in (-half, half):
            self.line((x + side, mouth), (x + side, end), "FINE")
        self.line((x - half, end), (x + half, end), "OUTLINE")

    def ground(self, letter: str) -> None:
        """Mark the lowest face as a datum by ISO 5459, on its extension to the left."""
        left, bottom = self.view.bounds[0], self.view.bounds[2]
        x, half, tall = left - self.paper(3.5), self.paper(1.2), self.paper(2.0)
        self.line((left, bottom), (left - self.paper(6.0), bottom), "FINE")
        self.sheet.space.add_solid(
            [self.at(x - half, bottom - tall), self.at(x + half, bottom - tall), self.at(x, bottom)],
            dxfattribs={"layer": "FINE"},
        )
        box, middle = self.paper(2.2), bottom - self.paper(6.2)
        self.line((x, bottom - tall), (x, middle + box), "FINE")
        self._boxed(letter, x, middle)

    def datum(self, letter: str, end: tuple[float, float], x: float) -> None:
        """Mark what is dimensioned with an arrow at `end` as a datum by ISO 5459: its letter in a box at `x`."""
        half, tall, beside = self.paper(1.2), self.paper(2.0), self.paper(2.2)
        foot = (end[0] - self.paper(3.2), end[1])
        self.sheet.space.add_solid(
            [self.at(end[0], end[1] + half), self.at(end[0], end[1] - half), self.at(end[0] - tall, end[1])],
            dxfattribs={"layer": "FINE"},
        )
        self.line(foot, (x + beside, end[1]), "FINE")
        self._boxed(letter, x, end[1])

    def _boxed(self, letter: str, x: float, y: float) -> None:
        half = self.paper(2.2)
        corners = [(x + right * half, y + up * half) for right, up in ((1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1))]
        self.sheet.space.add_lwpolyline([self.at(*corner) for corner in corners], dxfattribs={"layer": "FINE"})
        self.sheet.text(letter, self.on_paper(x, y), 2.8, "MIDDLE_CENTER")


def apart(wanted: Sequence[float], least: float) -> list[float]:
    """Return the places in ascending order, at least so far apart, as near as possible to those wanted."""
    groups: list[tuple[float, int]] = []
    for place in wanted:
        groups.append((place, 1))
        while len(groups) > 1 and groups[-1][0] - groups[-2][0] < 0.5 * least * (groups[-1][1] + groups[-2][1]):
            (lower, few), (upper, more) = groups[-2:]
            groups[-2:] = [((lower * few + upper * more) / (few + more), few + more)]
    return [middle + (index - 0.5 * (count - 1)) * least for middle, count in groups for index in range(count)]
