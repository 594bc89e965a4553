"""Reads off a solid what a drawing dimensions and a print compensates: upright cylinders, and levels."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan2, pi

import cadquery as cq
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_Orientation

_DIGITS = 6
"""Decimals of a millimetre to which two faces are of one cylinder."""
_SHRUNK = 0.999
_ROUND = 2.0 * pi - 1e-6


@dataclass(frozen=True, order=True)
class Cylinder:
    """An upright cylindrical face, or several that make up one; lengths in mm."""

    radius: float
    x: float
    y: float
    bottom: float
    top: float
    concave: bool
    """Whether material is outside: a hole or a bore, not a pin."""
    span: float
    """How much of the circle there is [rad]."""
    middle: float
    """Azimuth of the middle of what there is, seen from its own axis [rad]."""

    @property
    def is_round(self) -> bool:
        """Whether it goes all the way round."""
        return self.span > _ROUND

    @property
    def is_central(self) -> bool:
        """Whether its axis is the module's."""
        return abs(self.x) < 1e-6 and abs(self.y) < 1e-6


def upright_cylinders(solid: cq.Solid) -> list[Cylinder]:
    """Cylindrical faces whose axis is parallel to z, in a fixed order; patches that make up a whole one are one."""
    patches: dict[tuple[object, ...], list[Cylinder]] = {}
    for face in solid.Faces():
        one = _cylinder(face) if face.geomType() == "CYLINDER" else None
        if one:
            patches.setdefault((one.radius, one.x, one.y, one.bottom, one.top, one.concave), []).append(one)
    found = []
    for group in patches.values():
        span = sum(one.span for one in group)
        found += [replace(group[0], span=span, middle=0.0)] if span > _ROUND else group
    return sorted(found)


def _cylinder(face: cq.Face) -> Cylinder | None:
    """What a cylindrical face is; None where it does not stand upright."""
    adaptor = BRepAdaptor_Surface(face.wrapped)
    surface = adaptor.Cylinder()
    axis, place = surface.Axis().Direction(), surface.Location()
    if abs(abs(axis.Z()) - 1.0) > 1e-9:
        return None
    from_u, to_u, from_v, to_v = BRepTools.UVBounds_s(face.wrapped)
    bottom, top = sorted(place.Z() + axis.Z() * along for along in (from_v, to_v))
    middle = adaptor.Value(0.5 * (from_u + to_u), from_v)
    # The normal points away from the axis of a right-handed cylinder, into the material where the face is reversed.
    is_reversed = face.wrapped.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
    return Cylinder(
        radius=_round(surface.Radius()), x=_round(place.X()), y=_round(place.Y()),
        bottom=_round(bottom), top=_round(top),
        concave=is_reversed == surface.Position().Direct(), span=to_u - from_u,
        middle=atan2(middle.Y() - place.Y(), middle.X() - place.X()),
    )  # fmt: skip


def _round(value: float) -> float:
    return round(value, _DIGITS) + 0.0


def holes(solid: cq.Solid, at: tuple[float, float] | None = None) -> list[Cylinder]:
    """Round upright holes: cylinders with material around and none inside; with `at` those about a place."""
    inside_out = [one for one in upright_cylinders(solid) if one.concave and one.is_round]
    if at is not None:
        inside_out = [one for one in inside_out if abs(one.x - at[0]) < 1e-4 and abs(one.y - at[1]) < 1e-4]
    return [one for one in inside_out if _is_empty(solid, one)]


def _is_empty(solid: cq.Solid, one: Cylinder) -> bool:
    plug = cq.Solid.makeCylinder(
        _SHRUNK * one.radius, one.top - one.bottom, cq.Vector(one.x, one.y, one.bottom), cq.Vector(0, 0, 1)
    )
    return bool(plug.intersect(solid).Volume() < 1e-6 * plug.Volume())


def levels(solid: cq.Solid) -> list[float]:
    """Heights of the flat faces that lie level, from below."""
    found = set()
    for face in solid.Faces():
        if face.geomType() == "PLANE" and abs(abs(face.normalAt().z) - 1.0) < 1e-9:
            found.add(_round(face.Center().z))
    return sorted(found)
