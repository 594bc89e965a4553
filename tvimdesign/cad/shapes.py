"""Drawing aids: upright cylinders, rings, sectors and slots between two levels. Lengths in mm, angles in rad."""

from __future__ import annotations

from collections.abc import Iterable
from math import cos, pi, sin

import cadquery as cq
from OCP.StdFail import StdFail_NotDone

from tvimdesign.errors import GeometryError

Point = tuple[float, float]
_UP = cq.Vector(0, 0, 1)
_UPRIGHT = 0.999
"""Least upward part of the direction of an edge that counts as upright."""


def polar(radius: float, azimuth: float) -> Point:
    """Point at a radius and an azimuth."""
    return radius * cos(azimuth), radius * sin(azimuth)


def _require(**lengths: float) -> None:
    """Raise GeometryError for a size that is zero or negative; the kernel would draw it inside out, or crash."""
    for name, value in lengths.items():
        if not value > 0.0:
            raise GeometryError(f"{name.replace('_', ' ')} is {value:.4g}; it must be above zero to be drawn")


def cylinder(radius: float, bottom: float, top: float, at: Point = (0.0, 0.0)) -> cq.Solid:
    """Upright cylinder between two levels."""
    _require(radius=radius, height=top - bottom)
    return cq.Solid.makeCylinder(radius, top - bottom, cq.Vector(*at, bottom), _UP)


def block(along_x: Point, width: float, bottom: float, top: float) -> cq.Solid:
    """Upright block across the x axis, between two places on it and two levels."""
    start, end = along_x
    _require(length=end - start, width=width, height=top - bottom)
    return cq.Solid.makeBox(end - start, width, top - bottom, cq.Vector(start, -0.5 * width, bottom))


def ring(inner: float, outer: float, bottom: float, top: float) -> cq.Solid:
    """Upright ring about the axis between two levels."""
    _require(inner_radius=inner, width_of_a_ring=outer - inner, height=top - bottom)
    outside, inside = (cq.Wire.makeCircle(radius, cq.Vector(0, 0, bottom), _UP) for radius in (outer, inner))
    return cq.Solid.extrudeLinear(outside, [inside], cq.Vector(0, 0, top - bottom))


def sector(inner: float, outer: float, span: float, bottom: float, top: float) -> cq.Solid:
    """Upright annular sector about the axis, centred on the x axis, between two levels."""
    _require(inner_radius=inner, width_of_a_sector=outer - inner, span=span, height=top - bottom)
    first, last = -0.5 * span, 0.5 * span

    def at(radius: float, angle: float) -> cq.Vector:
        return cq.Vector(*polar(radius, angle), bottom)

    outline = cq.Wire.assembleEdges([
        cq.Edge.makeThreePointArc(at(outer, first), at(outer, 0.0), at(outer, last)),
        cq.Edge.makeLine(at(outer, last), at(inner, last)),
        cq.Edge.makeThreePointArc(at(inner, last), at(inner, 0.0), at(inner, first)),
        cq.Edge.makeLine(at(inner, first), at(outer, first)),
    ])  # fmt: skip
    return cq.Solid.extrudeLinear(outline, [], cq.Vector(0, 0, top - bottom))


def rounded(body: cq.Shape, radius: float) -> cq.Solid:
    """The one solid of a body with every upright edge rounded."""
    _require(corner_radius=radius)
    solid = body.Solids()[0]
    upright = [edge for edge in solid.Edges() if edge.geomType() == "LINE" and abs(edge.tangentAt(0.5).z) > _UPRIGHT]
    try:
        return cq.Solid(solid.fillet(radius, upright).Solids()[0].wrapped)
    except StdFail_NotDone as error:
        raise GeometryError(f"corners of {radius:.4g} mm do not fit; choose a smaller corner_radius") from error


def slot(half_width: float, length: float, bottom: float, top: float) -> cq.Solid:
    """Upright obround from the axis to `length` along x, with a half disc at each end."""
    _require(half_width=half_width, length=length, height=top - bottom)
    b = half_width
    corners = [cq.Vector(x, y, bottom) for x, y in ((0, -b), (length, -b), (length, b), (0, b))]
    far, near = cq.Vector(length + b, 0, bottom), cq.Vector(-b, 0, bottom)
    outline = cq.Wire.assembleEdges([
        cq.Edge.makeLine(corners[0], corners[1]),
        cq.Edge.makeThreePointArc(corners[1], far, corners[2]),
        cq.Edge.makeLine(corners[2], corners[3]),
        cq.Edge.makeThreePointArc(corners[3], near, corners[0]),
    ])  # fmt: skip
    return cq.Solid.extrudeLinear(outline, [], cq.Vector(0, 0, top - bottom))


def join(body: cq.Shape, others: Iterable[cq.Shape]) -> cq.Shape:
    """One body of several that overlap or touch, without the seams."""
    return body.fuse(*others).clean()


def turned(shape: cq.Shape, azimuth: float, beside: float = 0.0) -> cq.Shape:
    """The shape moved along y, then turned about the axis; the copy shares its geometry with the original."""
    return shape.moved(cq.Location(cq.Vector(*polar(beside, azimuth + 0.5 * pi)), _UP, azimuth * 180.0 / pi))
