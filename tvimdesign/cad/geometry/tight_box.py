"""The tightest box around a shape, to the bit the kernel's own, without its search on fillets that lie within it."""

from __future__ import annotations

from math import pi

import cadquery as cq
from OCP.Bnd import Bnd_Box
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBndLib import BRepBndLib


def tight_box(shape: cq.Shape) -> cq.BoundBox:
    """The box around a shape [mm], the same as its `BoundingBox()`.

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
    """Whether all edges of a face lie inside a box."""
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
    """Whether a face curves both ways at each of its points: the inner half of a torus."""
    if face.geomType() != "TORUS":
        return False
    surface = BRepAdaptor_Surface(face.wrapped)
    ring = surface.Torus().MajorRadius() > surface.Torus().MinorRadius()
    return bool(ring and 0.5 * pi <= surface.FirstVParameter() <= surface.LastVParameter() <= 1.5 * pi)
