"""Drawing aids: upright cylinders, rings, sectors and slots between two levels. Lengths in mm, angles in rad."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import acos, cos, pi, sin, sqrt, tan

import cadquery as cq
from OCP.StdFail import StdFail_NotDone

from tvimdesign.base.errors import GeometryError

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


def wedge(along_x: Point, span: float, inset: float, bottom: float, top: float) -> cq.Solid:
    """Upright trapezoid about the x axis, between two places on it, its legs `inset` within a sector of that span."""
    _require(length=along_x[1] - along_x[0], span=span, height=top - bottom)
    halves = [x * tan(0.5 * span) - inset / cos(0.5 * span) for x in along_x]
    _require(width_of_a_wedge=min(halves))
    (near, far), (start, end) = halves, along_x
    corners = [(start, -near), (end, -far), (end, far), (start, near)]
    outline = cq.Wire.makePolygon([cq.Vector(*corner, bottom) for corner in corners], close=True)
    return cq.Solid.extrudeLinear(outline, [], cq.Vector(0, 0, top - bottom))


def spoked_disc(
    radius: float, half_width: float, length: float, corner: float, azimuths: Sequence[float], levels: Point
) -> cq.Solid:
    """Upright disc about the axis with spokes to `length` that end in half discs, and fillets where they begin."""
    bottom, top = levels
    _require(radius=radius, half_width=half_width, corner=corner, height=top - bottom)
    # The centre of a fillet touches disc and spoke.
    along = sqrt((radius + corner) ** 2 - (half_width + corner) ** 2)
    touch, beside = radius / (radius + corner), half_width + corner

    def at(x: float, y: float, azimuth: float) -> cq.Vector:
        return cq.Vector(x * cos(azimuth) - y * sin(azimuth), x * sin(azimuth) + y * cos(azimuth), bottom)

    def fillet(side: float, azimuth: float) -> tuple[cq.Vector, cq.Vector, cq.Vector]:
        """Where it touches the disc, its middle, and where it touches the spoke."""
        inwards = cq.Vector(-along, -side * beside, 0.0).normalized() + cq.Vector(0.0, -side, 0.0)
        half = inwards.normalized() * corner
        return (
            at(touch * along, side * touch * beside, azimuth),
            at(along + half.x, side * beside + half.y, azimuth),
            at(along, side * half_width, azimuth),
        )

    edges = []
    for azimuth, following in zip(azimuths, [*azimuths[1:], azimuths[0] + 2.0 * pi], strict=True):
        before, after, later = fillet(-1.0, azimuth), fillet(1.0, azimuth), fillet(-1.0, following)
        near, far = at(length, -half_width, azimuth), at(length, half_width, azimuth)
        edges += [
            cq.Edge.makeThreePointArc(*before),
            cq.Edge.makeLine(before[2], near),
            cq.Edge.makeThreePointArc(near, at(length + half_width, 0.0, azimuth), far),
            cq.Edge.makeLine(far, after[2]),
            cq.Edge.makeThreePointArc(*reversed(after)),
            cq.Edge.makeThreePointArc(after[0], at(radius, 0.0, 0.5 * (azimuth + following)), later[0]),
        ]
    return cq.Solid.extrudeLinear(cq.Wire.assembleEdges(edges), [], cq.Vector(0, 0, top - bottom))


def bossed_ring(radii: Point, boss: float, corner: float, azimuths: Sequence[float], levels: Point) -> cq.Solid:
    """Upright ring between two radii, with discs of radius `boss` on its inner circle and fillets beside them.

    Its inner outline is drawn arc by arc, for the kernel's own fillet between two cylinders is no cylinder.
    """
    (inner, outer), (bottom, top) = radii, levels
    _require(inner_radius=inner, width_of_a_ring=outer - inner, boss=boss, corner=corner, height=top - bottom)
    rim, reach = inner - corner, boss + corner
    # The centre of a fillet touches disc and circle: the law of cosines gives its azimuth beside the disc's.
    beside = acos((inner**2 + rim**2 - reach**2) / (2.0 * inner * rim))

    def at(radius: float, azimuth: float) -> cq.Vector:
        return cq.Vector(*polar(radius, azimuth), bottom)

    def fillet(azimuth: float, side: float) -> tuple[cq.Vector, cq.Vector, cq.Vector]:
        """Where it touches the circle, its middle, and where it touches the disc."""
        centre, out = at(rim, azimuth + side * beside), at(1.0, azimuth + side * beside) - at(0.0, 0.0)
        towards = (at(inner, azimuth) - centre).normalized()
        return centre + out * corner, centre + (out + towards).normalized() * corner, centre + towards * corner

    edges = []
    for azimuth, following in zip(azimuths, [*azimuths[1:], azimuths[0] + 2.0 * pi], strict=True):
        before, after, later = fillet(azimuth, -1.0), fillet(azimuth, 1.0), fillet(following, -1.0)
        edges += [
            cq.Edge.makeThreePointArc(*before),
            cq.Edge.makeThreePointArc(before[2], at(inner - boss, azimuth), after[2]),
            cq.Edge.makeThreePointArc(*reversed(after)),
            cq.Edge.makeThreePointArc(after[0], at(inner, 0.5 * (azimuth + following)), later[0]),
        ]
    outside = cq.Wire.makeCircle(outer, cq.Vector(0, 0, bottom), _UP)
    return cq.Solid.extrudeLinear(outside, [cq.Wire.assembleEdges(edges)], cq.Vector(0, 0, top - bottom))


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
