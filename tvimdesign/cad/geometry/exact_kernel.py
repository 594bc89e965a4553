"""Outlines of upright bodies, what a kernel makes of them, and the exact kernel, which is CadQuery. Lengths in mm."""

from collections.abc import Sequence
from math import pi, sqrt
from typing import Any, Protocol

import cadquery as cq
import numpy as np
from numpy.typing import NDArray
from OCP.StdFail import StdFail_NotDone

from tvimdesign.base.errors import GeometryError

Point = tuple[float, float]
Segment = tuple[Point, Point] | tuple[Point, Point, Point]  # A line from point to point, or an arc through three
Arc = tuple[Sequence[float], Sequence[float], Sequence[float], float]
"""An arc in space: its start, a point on the axis that it turns about, that axis, and the angle [rad]."""
Outline = float | Sequence[Segment]  # A circle about the axis by its radius, or segments that close


class Kernel(Protocol):
    """Draws upright bodies between two levels. What it draws has `cut`, `fuse`, `clean` and `moved`, as CadQuery's."""

    def cylinder(self, radius: float, bottom: float, top: float, at: Point) -> Any:
        """Draw a cylinder about an upright axis through a point."""

    def block(self, along_x: Point, width: float, bottom: float, top: float) -> Any:
        """Draw a block across the x axis, between two places on it."""

    def cone(self, radius: float, base: float, tip: float, at: Point) -> Any:
        """Draw a cone about an upright axis through a point, from a disc at one level to its tip at another."""

    def foot(self, radius: float, fillet: float, level: float, at: Point) -> Any:
        """Draw a cylinder about an upright axis through a point, from a level as high as its fillet there is wide."""

    def prism(self, outside: Outline, inside: Sequence[Outline], bottom: float, top: float) -> Any:
        """Draw what lies within an outline, less what lies within others."""

    def tube(self, radius: float, path: Sequence[Arc]) -> Any:
        """Draw a round wire along arcs that follow each other without a kink."""

    def rounded(self, body: Any, radius: float) -> Any:
        """Draw a body with every upright edge rounded. Raises GeometryError where that does not fit."""


def placement(location: cq.Location) -> NDArray[np.float64]:
    """Return 4 x 4 matrix of a location."""
    place_of = location.wrapped.Transformation()
    rows = [[place_of.Value(row, column) for column in range(1, 5)] for row in range(1, 4)]
    return np.array([*rows, [0.0, 0.0, 0.0, 1.0]])


_UP = cq.Vector(0, 0, 1)
_UPRIGHT = 0.999  # Least upward part of the direction of an edge that counts as upright
_LINE = 2  # Points of a segment that is a line


class ExactKernel:
    """The CAD kernel."""

    def cylinder(self, radius: float, bottom: float, top: float, at: Point) -> cq.Solid:
        """Draw a cylinder about an upright axis through a point."""
        return cq.Solid.makeCylinder(radius, top - bottom, cq.Vector(*at, bottom), _UP)

    def block(self, along_x: Point, width: float, bottom: float, top: float) -> cq.Solid:
        """Draw a block across the x axis, between two places on it."""
        start, end = along_x
        return cq.Solid.makeBox(end - start, width, top - bottom, cq.Vector(start, -0.5 * width, bottom))

    def cone(self, radius: float, base: float, tip: float, at: Point) -> cq.Solid:
        """Draw a cone about an upright axis through a point, from a disc at one level to its tip at another."""
        way = cq.Vector(0, 0, 1 if tip > base else -1)
        return cq.Solid.makeCone(radius, 0.0, abs(tip - base), cq.Vector(*at, base), way)

    def foot(self, radius: float, fillet: float, level: float, at: Point) -> cq.Solid:
        """Draw a cylinder about an upright axis through a point, from a level as high as its fillet there is wide."""
        wide, half = radius + fillet, fillet * sqrt(0.5)
        corners = [cq.Vector(*point) for point in ((0, 0, 0), (wide, 0, 0), (radius, 0, fillet), (0, 0, fillet))]
        middle = cq.Vector(wide - half, 0, fillet - half)
        lines = [cq.Edge.makeLine(*pair) for pair in zip(corners[2:], [corners[3], corners[0]], strict=True)]
        arc = cq.Edge.makeThreePointArc(corners[1], middle, corners[2])
        outline = cq.Wire.assembleEdges([cq.Edge.makeLine(corners[0], corners[1]), arc, *lines])
        return cq.Solid.revolve(outline, [], 360.0, cq.Vector(), _UP).moved(cq.Location(cq.Vector(*at, level)))

    def prism(self, outside: Outline, inside: Sequence[Outline], bottom: float, top: float) -> cq.Solid:
        """Draw what lies within an outline, less what lies within others."""
        inner = [_wire(outline, bottom) for outline in inside]
        return cq.Solid.extrudeLinear(_wire(outside, bottom), inner, cq.Vector(0, 0, top - bottom))

    def tube(self, radius: float, path: Sequence[Arc]) -> cq.Solid:
        """Draw a round wire along arcs that follow each other without a kink."""
        bends = []
        for start, centre, axis, angle in path:
            at, middle, along = (cq.Vector(*point) for point in (start, centre, axis))
            ring = cq.Wire.makeCircle(radius, at, along.cross(at - middle))
            bends.append(cq.Solid.revolve(ring, [], angle * 180.0 / pi, middle, middle + along))
        return bends[0].fuse(*bends[1:]) if len(bends) > 1 else bends[0]

    def rounded(self, body: cq.Shape, radius: float) -> cq.Solid:
        """Draw one solid of a body with every upright edge rounded. Raises GeometryError where that does not fit."""
        solid = body.Solids()[0]
        upright = [
            edge for edge in solid.Edges() if edge.geomType() == "LINE" and abs(edge.tangentAt(0.5).z) > _UPRIGHT
        ]
        try:
            return cq.Solid(solid.fillet(radius, upright).Solids()[0].wrapped)
        except StdFail_NotDone as error:
            raise GeometryError(f"corners of {radius:.4g} mm do not fit; choose a smaller corner_radius") from error


def _wire(outline: Outline, level: float) -> cq.Wire:
    if isinstance(outline, float | int):
        return cq.Wire.makeCircle(outline, cq.Vector(0, 0, level), _UP)
    if all(len(segment) == _LINE for segment in outline):
        return cq.Wire.makePolygon([cq.Vector(*segment[0], level) for segment in outline], close=True)
    return cq.Wire.assembleEdges([_edge(segment, level) for segment in outline])


def _edge(segment: Segment, level: float) -> cq.Edge:
    points = [cq.Vector(*point, level) for point in segment]
    return cq.Edge.makeLine(*points) if len(points) == _LINE else cq.Edge.makeThreePointArc(*points)
