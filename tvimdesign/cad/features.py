"""Reads off a solid what a drawing dimensions and a print compensates: upright cylinders, and levels."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import cadquery as cq
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_Orientation

_DIGITS = 6
"""Decimals of a millimetre to which two faces are of one cylinder."""
_SHRUNK = 0.999


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

    @property
    def is_round(self) -> bool:
        """Whether it goes all the way round."""
        return self.span > 2.0 * pi - 1e-6

    @property
    def is_central(self) -> bool:
        """Whether its axis is the module's."""
        return abs(self.x) < 1e-6 and abs(self.y) < 1e-6


def upright_cylinders(solid: cq.Solid) -> list[Cylinder]:
    """Cylindrical faces whose axis is parallel to z, in a fixed order; patches of one cylinder are put together."""
    spans: dict[tuple[float, float, float, float, float, bool], float] = {}
    for face in solid.Faces():
        if face.geomType() != "CYLINDER":
            continue
        surface = BRepAdaptor_Surface(face.wrapped).Cylinder()
        axis, place = surface.Axis().Direction(), surface.Location()
        if abs(abs(axis.Z()) - 1.0) > 1e-9:
            continue
        from_u, to_u, from_v, to_v = BRepTools.UVBounds_s(face.wrapped)
        ends = sorted(place.Z() + axis.Z() * along for along in (from_v, to_v))
        numbers = [round(value, _DIGITS) + 0.0 for value in (surface.Radius(), place.X(), place.Y(), *ends)]
        # The normal points away from the axis of a right-handed cylinder, into the material where the face is reversed.
        reversed_face = face.wrapped.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
        key = (*numbers, reversed_face == surface.Position().Direct())
        spans[key] = spans.get(key, 0.0) + to_u - from_u
    return sorted(Cylinder(*key, span=span) for key, span in spans.items())


def holes(solid: cq.Solid) -> list[Cylinder]:
    """Round upright holes: cylinders with material around and none inside."""
    inside_out = [one for one in upright_cylinders(solid) if one.concave and one.is_round]
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
            found.add(round(face.Center().z, _DIGITS) + 0.0)
    return sorted(found)
