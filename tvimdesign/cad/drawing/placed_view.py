"""A view on a drawing's sheet: its outlines, axes and the line of its section."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot

from tvimdesign.cad.drawing.drawing_sheet import DrawingSheet
from tvimdesign.cad.drawing.projection import View
from tvimdesign.cad.geometry.features import Cylinder


@dataclass(frozen=True)
class PlacedView:
    """A view on a sheet, its own origin at a place on paper."""

    sheet: DrawingSheet
    view: View
    origin: tuple[float, float]

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Where a point of the view is in the drawing's coordinates."""
        left, bottom = self.sheet.at(self.origin)
        return left + x, bottom + y

    def paper(self, length: float) -> float:
        """A length on paper [mm] in the drawing's coordinates."""
        return length / self.sheet.scale

    def draw(self) -> None:
        """Draw outlines and hatching."""
        space, outline = self.sheet.space, {"layer": "OUTLINE"}
        for chain in self.view.hidden:
            space.add_lwpolyline([self.at(*point) for point in chain.points], dxfattribs={"layer": "HIDDEN"})
        for arc in self.view.arcs:
            if arc.end - arc.start == 360.0:
                space.add_circle(self.at(*arc.centre), arc.radius, dxfattribs=outline)
            else:
                space.add_arc(self.at(*arc.centre), arc.radius, arc.start, arc.end, dxfattribs=outline)
        for chain in self.view.chains:
            space.add_lwpolyline([self.at(*point) for point in chain.points], dxfattribs=outline)
        for outlines in self.view.cut:
            hatch = space.add_hatch(dxfattribs={"layer": "HATCH"})
            hatch.set_pattern_fill("ANSI31", scale=0.8 / self.sheet.scale)
            for index, one in enumerate(outlines):
                points = [self.at(*point) for point in one.points]
                hatch.paths.add_polyline_path(points, is_closed=True, flags=1 if index == 0 else 16)

    def line(self, start: tuple[float, float], end: tuple[float, float], layer: str = "CENTRE") -> None:
        """Draw a line between two points of the view."""
        self.sheet.space.add_line(self.at(*start), self.at(*end), dxfattribs={"layer": layer})

    def axis(self) -> None:
        """Draw the axis of the module in a view from the front."""
        over = self.paper(3.0)
        self.line((0.0, self.view.bounds[2] - over), (0.0, self.view.bounds[3] + over))

    def centre_lines(self, rounds: Sequence[Cylinder]) -> None:
        """Draw a cross at the axis, the circles on which holes and pins stand, and a cross at each of those."""
        left, right, bottom, top = self.view.bounds
        over = self.paper(3.0)
        self.line((left - over, 0.0), (right + over, 0.0))
        self.line((0.0, bottom - over), (0.0, top + over))
        beside = [one for one in rounds if not one.is_central]
        pitches = [round(hypot(one.x, one.y), 4) for one in beside]
        for pitch in sorted({pitch for pitch in pitches if pitches.count(pitch) > 1}):
            self.sheet.space.add_circle(self.at(0.0, 0.0), pitch, dxfattribs={"layer": "CENTRE"})
        for x, y, radius in sorted({(one.x, one.y, one.radius) for one in beside}):
            arm = radius + self.paper(1.5)
            self.line((x - arm, y), (x + arm, y))
            self.line((x, y - arm), (x, y + arm))

    def cutting_line(self) -> None:
        """Mark where the section above is taken, with arrows in the direction of view."""
        left, right = self.view.bounds[:2]
        for x, side in ((left, -1.0), (right, 1.0)):
            start, end = x + side * self.paper(3.0), x + side * self.paper(8.0)
            self.line((start, 0.0), (end, 0.0), "OUTLINE")
            tip, half = self.paper(5.0), self.paper(0.8)
            self.line((end, 0.0), (end, tip), "FINE")
            self.sheet.space.add_solid(
                [self.at(end - half, 0.55 * tip), self.at(end + half, 0.55 * tip), self.at(end, tip)],
                dxfattribs={"layer": "FINE"},
            )
            paper_x = self.origin[0] + end * self.sheet.scale
            self.sheet.text("A", (paper_x, self.origin[1] - 3.5), 3.5, "MIDDLE_CENTER")

    def datum(self, letter: str, end: tuple[float, float], x: float) -> None:
        """Mark what is dimensioned with an arrow at `end` as a datum by ISO 5459: its letter in a box at `x`."""
        half, tall, beside = self.paper(1.2), self.paper(2.0), self.paper(2.2)
        foot = (end[0] - self.paper(3.2), end[1])
        self.sheet.space.add_solid(
            [self.at(end[0], end[1] + half), self.at(end[0], end[1] - half), self.at(end[0] - tall, end[1])],
            dxfattribs={"layer": "FINE"},
        )
        self.line(foot, (x + beside, end[1]), "FINE")
        corners = [
            (x + right * beside, end[1] + up * beside) for right, up in ((1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1))
        ]
        self.sheet.space.add_lwpolyline([self.at(*corner) for corner in corners], dxfattribs={"layer": "FINE"})
        place = self.origin[0] + x * self.sheet.scale, self.origin[1] + end[1] * self.sheet.scale
        self.sheet.text(letter, place, 2.8, "MIDDLE_CENTER")


def apart(wanted: Sequence[float], least: float) -> list[float]:
    """Places in ascending order, at least so far apart, as near as possible to those wanted."""
    groups: list[tuple[float, int]] = []
    for place in wanted:
        groups.append((place, 1))
        while len(groups) > 1 and groups[-1][0] - groups[-2][0] < 0.5 * least * (groups[-1][1] + groups[-2][1]):
            (one, few), (other, more) = groups[-2:]
            groups[-2:] = [((one * few + other * more) / (few + more), few + more)]
    return [middle + (index - 0.5 * (count - 1)) * least for middle, count in groups for index in range(count)]
