"""Reads off a solid what a drawing dimensions and a print compensates: upright cylinders, and levels."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import atan2, hypot, pi
from typing import Self

import cadquery as cq
from OCP.Bnd import Bnd_Box
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_Orientation
from OCP.TopoDS import TopoDS_Shape


def tight_box(shape: cq.Shape) -> cq.BoundBox:
    """Return the box around a shape [mm], the same as its `BoundingBox()`.

    The kernel searches each fillet around a pin's foot for its extremes, 12 ms each, and knows those of planes and
    cylinders at once. No coordinate has an extreme inside such a fillet: its edges say whether it lies within the rest.
    """
    faces = shape.Faces()
    fillets = [face for face in faces if _is_saddle(face)]
    if not fillets or len(fillets) == len(faces):
        return shape.BoundingBox()
    box = Bnd_Box()
    for face in faces:
        if face not in fillets:
            BRepBndLib.AddOptimal_s(face.wrapped, box)
    for face in fillets:
        if not _is_within(face, box):
            BRepBndLib.AddOptimal_s(face.wrapped, box)
    return cq.BoundBox(box)


def _is_within(face: cq.Face, box: Bnd_Box) -> bool:
    """Return whether all edges of a face lie inside a box."""
    edges = Bnd_Box()
    for edge in face.Edges():
        BRepBndLib.AddOptimal_s(edge.wrapped, edges)
    low, high = box.CornerMin(), box.CornerMax()
    least, most = edges.CornerMin(), edges.CornerMax()
    return all(
        getattr(low, axis)() < getattr(least, axis)() and getattr(most, axis)() < getattr(high, axis)()
        for axis in ("X", "Y", "Z")
    )


def _is_saddle(face: cq.Face) -> bool:
    """Return whether a face curves both ways at each of its points: the inner half of a torus."""
    if face.geomType() != "TORUS":
        return False
    surface = BRepAdaptor_Surface(face.wrapped)
    ring = surface.Torus().MajorRadius() > surface.Torus().MinorRadius()
    return bool(ring and 0.5 * pi <= surface.FirstVParameter() <= surface.LastVParameter() <= 1.5 * pi)


_DIGITS = 6  # Decimals of a millimetre to which two faces are of one cylinder
_SHRUNK = 0.999
_ROUND = 2.0 * pi - 1e-6
_UPRIGHT = 1e-9
_BOX = 1e-5
"""How much two boxes must share [mm]: the kernel's are wider than a face by some 1e-7, places are rounded to 1e-6."""


@dataclass(frozen=True, order=True)
class Cylinder:
    """An upright cylindrical face, or several that make up one; lengths in mm."""

    radius: float
    x: float
    y: float
    bottom: float
    top: float
    concave: bool  # True if material is outside: a hole or a bore, not a pin
    span: float  # How much of the circle there is [rad]
    middle: float  # Azimuth of the middle of what there is, seen from its own axis [rad]

    @property
    def is_round(self) -> bool:
        """True if it goes all the way round."""
        return self.span > _ROUND

    @property
    def is_central(self) -> bool:
        """True if its axis is the module's."""
        return abs(self.x) < 1e-6 and abs(self.y) < 1e-6


def upright_cylinders(solid: cq.Solid) -> list[Cylinder]:
    """Return cylindrical faces whose axis is parallel to z, in a fixed order.

    Patches that make up a whole one are one.
    """
    patches: dict[tuple[object, ...], list[Cylinder]] = {}
    for face in solid.Faces():
        patch = _cylinder(face) if face.geomType() == "CYLINDER" else None
        if patch:
            key = patch.radius, patch.x, patch.y, patch.bottom, patch.top, patch.concave
            patches.setdefault(key, []).append(patch)
    cylinders = []
    for group in patches.values():
        span = sum(patch.span for patch in group)
        cylinders += [replace(group[0], span=span, middle=0.0)] if span > _ROUND else group
    return sorted(cylinders)


def _cylinder(face: cq.Face) -> Cylinder | None:
    """Return what a cylindrical face is; None where it does not stand upright."""
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
    """Return round upright holes: cylinders with material around and none inside; with `at` those about a place."""
    inside_out = [cylinder for cylinder in upright_cylinders(solid) if cylinder.concave and cylinder.is_round]
    if at is not None:
        inside_out = [hole for hole in inside_out if abs(hole.x - at[0]) < 1e-4 and abs(hole.y - at[1]) < 1e-4]
    faces = [_Face.of(face) for face in solid.Faces()] if inside_out else []
    return [hole for hole in inside_out if _is_empty(solid, faces, hole)]


@dataclass(frozen=True)
class _Face:
    """Bounds of a face that show, without the kernel, that it does not reach into an upright plug [mm]."""

    shape: TopoDS_Shape
    low: tuple[float, float, float]
    high: tuple[float, float, float]  # Corners of a box around it
    upright: tuple[float, float, float] | None  # Of an upright cylinder: its axis and radius
    plane: tuple[float, float, float] | None
    """Of an upright plane: its normal, and how far it is from the origin along that."""

    @classmethod
    def of(cls, face: cq.Face) -> Self:
        """Read it off a face."""
        box = Bnd_Box()
        BRepBndLib.Add_s(face.wrapped, box, False)
        ends = box.Get()
        surface, kind = BRepAdaptor_Surface(face.wrapped), face.geomType()
        upright = plane = None
        if kind == "CYLINDER" and abs(abs(surface.Cylinder().Axis().Direction().Z()) - 1.0) < _UPRIGHT:
            place = surface.Cylinder().Location()
            upright = (place.X(), place.Y(), surface.Cylinder().Radius())
        if kind == "PLANE" and abs(surface.Plane().Axis().Direction().Z()) < _UPRIGHT:
            place, normal = surface.Plane().Location(), surface.Plane().Axis().Direction()
            plane = (normal.X(), normal.Y(), normal.X() * place.X() + normal.Y() * place.Y())
        return cls(face.wrapped, ends[:3], ends[3:], upright, plane)

    def misses(self, hole: Cylinder, radius: float) -> bool:
        """Return whether it surely has no point within a radius of a cylinder's axis and between its ends, touching
        aside."""
        start, end = (hole.x - radius, hole.y - radius, hole.bottom), (hole.x + radius, hole.y + radius, hole.top)
        boxed = zip(self.low, self.high, start, end, strict=True)
        if any(low >= last - _BOX or high <= first + _BOX for low, high, first, last in boxed):
            return True
        if self.upright:
            x, y, own = self.upright
            return abs(hypot(hole.x - x, hole.y - y) - own) >= radius
        if self.plane:
            across, up, distance = self.plane
            return abs(across * hole.x + up * hole.y - distance) >= radius
        return False


def _is_empty(solid: cq.Solid, faces: Sequence[_Face], hole: Cylinder) -> bool:
    """Return whether a plug that nearly fills a cylinder has nothing in common with the solid.

    Where no face reaches into the plug it is all inside or all outside; else the kernel says what they share.
    """
    radius = _SHRUNK * hole.radius
    near = [face for face in faces if not face.misses(hole, radius)]
    axis = cq.Edge.makeLine(cq.Vector(hole.x, hole.y, hole.bottom), cq.Vector(hole.x, hole.y, hole.top)).wrapped
    if all(BRepExtrema_DistShapeShape(axis, face.shape).Value() >= radius for face in near):
        return not solid.isInside(cq.Vector(hole.x, hole.y, 0.5 * (hole.bottom + hole.top)))
    foot, height = cq.Vector(hole.x, hole.y, hole.bottom), hole.top - hole.bottom
    plug = cq.Solid.makeCylinder(radius, height, foot, cq.Vector(0, 0, 1))
    return bool(plug.intersect(solid).Volume() < 1e-6 * plug.Volume())


def levels(solid: cq.Solid) -> list[float]:
    """Return the heights of the flat faces that lie level, from below."""
    heights = set()
    for face in solid.Faces():
        if face.geomType() == "PLANE" and abs(abs(face.normalAt().z) - 1.0) < 1e-9:
            heights.add(_round(face.Center().z))
    return sorted(heights)


def boxes_meet(first: cq.BoundBox, second: cq.BoundBox, room: float = 0.0) -> bool:
    """Return whether two boxes share more than a face, or come nearer to each other than `room` [mm]."""
    return all(
        getattr(first, f"{axis}min") < getattr(second, f"{axis}max") + room
        and getattr(second, f"{axis}min") < getattr(first, f"{axis}max") + room
        for axis in "xyz"
    )
