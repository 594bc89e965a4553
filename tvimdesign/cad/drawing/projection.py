"""Views of a solid as plane curves: from above, and from the front with the near half cut away."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from math import degrees, dist

import cadquery as cq
import numpy as np
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepLib import BRepLib
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.HLRAlgo import HLRAlgo_Projector
from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape
from OCP.TopoDS import TopoDS_Shape

from tvimdesign.cad.geometry.features import tight_box

Array = NDArray[np.float64]
Point = tuple[float, float]
_CHORD = 0.01  # Largest distance [mm] of a chain of lines from the curve it stands for
_DIGITS = 5
_UPRIGHT = 1.0 - 1e-6
"""Least share of a plane's normal along y for a face that may lie in the section; a box of it tells."""
_VISIBLE = ("VCompound", "OutLineVCompound", "Rg1LineVCompound")
_HIDDEN = ("HCompound", "OutLineHCompound")


@dataclass(frozen=True, order=True)
class Arc:
    """Part of a circle, counter-clockwise between two angles [deg]; all of it where they are 360 apart."""

    centre: Point
    radius: float
    start: float
    end: float


@dataclass(frozen=True, order=True)
class Chain:
    """Straight lines from point to point."""

    points: tuple[Point, ...]


@dataclass(frozen=True)
class View:
    """View of a solid, in its own millimetres: x to the right, y (or z) upwards."""

    arcs: tuple[Arc, ...]
    chains: tuple[Chain, ...]
    hidden: tuple[Arc | Chain, ...] = ()
    """What lies behind: arcs as arcs, so that their dashes do not begin anew at every point of a chain."""
    cut: tuple[tuple[Chain, ...], ...] = ()  # Faces in the plane of a section, each its outline and then its holes

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Least and largest x, least and largest y."""
        points = [point for chain in self.chains for point in chain.points]
        points += [
            (arc.centre[0] + right * arc.radius, arc.centre[1] + up * arc.radius)
            for arc in self.arcs
            for right, up in ((1, 0), (-1, 0), (0, 1), (0, -1))
            if _is_on(arc, degrees(float(np.arctan2(up, right))))
        ]
        x, y = np.array(points).T
        return float(x.min()), float(x.max()), float(y.min()), float(y.max())

    def at_scale(self, factor: float) -> "View":
        """Return the visible curves, that many times as large."""
        arcs = (Arc((factor * arc.centre[0], factor * arc.centre[1]), factor * arc.radius, arc.start, arc.end)
                for arc in self.arcs)  # fmt: skip
        chains = (Chain(tuple((factor * x, factor * y) for x, y in chain.points)) for chain in self.chains)
        return View(tuple(arcs), tuple(chains))


def from_above(solid: cq.Solid) -> View:
    """Return plan view, with what lies behind."""
    visible, hidden = _edges(solid, (0, 0, 1))
    arcs, chains = _curves(visible)
    hidden_arcs, hidden_chains = _curves(hidden)
    behind: tuple[Arc | Chain, ...] = (*hidden_arcs, *hidden_chains)
    in_front: set[Arc | Chain] = {*arcs, *chains}
    return View(arcs, chains, tuple(curve for curve in behind if curve not in in_front))


def seen(shape: cq.Shape, towards_viewer: tuple[float, float, float]) -> View:
    """Return the view of one or more solids from a direction, without what lies behind; the viewer's right is x."""
    return View(*_curves(_edges(shape, towards_viewer)[0]))


def from_below(solid: cq.Solid) -> View:
    """Return the view from below of what is turned over about x, without what lies behind."""
    return seen(solid, (0, 0, -1))


def seen_lines(shape: cq.Shape, towards_viewer: tuple[float, float, float]) -> tuple[Chain, ...]:
    """Return what is seen of one or more solids from a direction, arcs as chains, too; the viewer's right is x."""
    return tuple(sorted({_chain(edge) for edge in _edges(shape, towards_viewer)[0]}))


def section(solid: cq.Solid) -> View:
    """Return front view of the half behind the plane y = 0, with its faces in that plane."""
    size = _room(solid)
    return _front(solid.intersect(cq.Solid.makeBox(size, size, size, cq.Vector(-0.5 * size, 0, -0.5 * size))))


def half_section(solid: cq.Solid, azimuth: float) -> View:
    """Return what `section` shows from the axis to the right, of the solid cut at an azimuth [rad] instead of x."""
    size = _room(solid)
    turned = solid.rotate(cq.Vector(), cq.Vector(0, 0, 1), -degrees(azimuth))
    view = _front(turned.intersect(cq.Solid.makeBox(size, size, size, cq.Vector(0, 0, -0.5 * size))))
    # The cut along the axis is no edge of the part: the axis is drawn there.
    edges = tuple(chain for chain in view.chains if any(abs(x) > 1e-4 for x, _ in chain.points))
    return View(view.arcs, edges, cut=view.cut)


@lru_cache(maxsize=1)
def _room(solid: cq.Solid) -> float:
    """Return the side of a cube about the origin that holds the solid with room to spare."""
    box = tight_box(solid)
    return float(2.0 * (box.DiagonalLength + box.center.Length))


def _front(behind: cq.Shape) -> View:
    """Return front view of what is behind the plane y = 0, with its faces in that plane."""
    arcs, chains = _curves(edge for half in behind.Solids() for edge in _edges(half, (0, -1, 0))[0])
    faces = [face for face in behind.Faces() if _lies_in_section(face)]
    cut = sorted(
        (tuple(_outline(wire) for wire in (face.outerWire(), *face.innerWires())) for face in faces),
        key=lambda outlines: outlines[0],
    )
    return View(arcs, chains, cut=tuple(cut))


def _lies_in_section(face: cq.Face) -> bool:
    if face.geomType() != "PLANE":
        return False
    if abs(BRepAdaptor_Surface(face.wrapped).Plane().Axis().Direction().Y()) < _UPRIGHT:
        return False
    box = face.BoundingBox()
    return bool(max(abs(box.ymin), abs(box.ymax)) < 1e-6)


def _edges(solid: cq.Shape, towards_viewer: tuple[float, float, float]) -> tuple[list[cq.Edge], list[cq.Edge]]:
    """Return visible and hidden edges of a solid, projected; the viewer's right is x."""
    algorithm = HLRBRep_Algo()
    algorithm.Add(solid.wrapped)
    algorithm.Projector(HLRAlgo_Projector(gp_Ax2(gp_Pnt(), gp_Dir(*towards_viewer), gp_Dir(1, 0, 0))))
    algorithm.Update()
    algorithm.Hide()
    shapes = HLRBRep_HLRToShape(algorithm)
    visible = [edge for which in _VISIBLE for edge in _drawn(getattr(shapes, which)())]
    return visible, [edge for which in _HIDDEN for edge in _drawn(getattr(shapes, which)())]


def _drawn(shape: TopoDS_Shape | None) -> list[cq.Edge]:
    """Return edges of one kind, none where the view has none of it."""
    if shape is None or shape.IsNull():
        return []
    BRepLib.BuildCurves3d_s(shape)
    return list(cq.Shape.cast(shape).Edges())


def _curves(edges: Iterable[cq.Edge]) -> tuple[tuple[Arc, ...], tuple[Chain, ...]]:
    """Return edges in the plane of the view as arcs and chains, each once and in a fixed order."""
    arcs, chains = set(), set()
    for edge in edges:
        if edge.geomType() == "CIRCLE":
            arcs.add(_arc(edge))
        else:
            chains.add(_chain(edge))
    return tuple(sorted(arcs)), tuple(sorted(chains))


def _chain(edge: cq.Edge) -> Chain:
    """Return an edge as lines, the same whichever way it runs."""
    points = _sampled(edge)
    return Chain(min(points, points[::-1]))


def _arc(edge: cq.Edge) -> Arc:
    centre, radius = edge.arcCenter(), edge.radius()
    if edge.IsClosed():
        return Arc((_round(centre.x), _round(centre.y)), _round(radius), 0.0, 360.0)
    ends = [edge.positionAt(share) - centre for share in (0.0, 0.5, 1.0)]
    first, middle, last = (degrees(float(np.arctan2(at.y, at.x))) for at in ends)
    forward = (middle - first) % 360.0 < (last - first) % 360.0
    start, end = (first, last) if forward else (last, first)
    return Arc((_round(centre.x), _round(centre.y)), _round(radius), _round(start % 360.0), _round(end % 360.0))


def _sampled(edge: cq.Edge) -> tuple[Point, ...]:
    """Return points of an edge, so many that lines between them keep to it."""
    if edge.geomType() == "LINE":
        return tuple((_round(end.x), _round(end.y)) for end in (edge.startPoint(), edge.endPoint()))
    count = 5 if edge.IsClosed() else 2
    while count < 257:
        shares = np.linspace(0.0, 1.0, 2 * count - 1).tolist()
        finer = np.array([edge.positionAt(share).toTuple()[:2] for share in shares])
        points, between = finer[::2], finer[1::2]
        if np.max(_beside(between, points[:-1], points[1:])) < _CHORD:
            break
        count = 2 * count - 1
    return tuple((_round(x), _round(y)) for x, y in points.tolist())


def _beside(points: Array, start: Array, end: Array) -> Array:
    """Return the distance of points from the lines between two others."""
    along = end - start
    length = np.maximum(np.hypot(*along.T), 1e-12)
    away = points - start
    return np.asarray(np.abs(along[:, 0] * away[:, 1] - along[:, 1] * away[:, 0]) / length)


def _outline(wire: cq.Wire) -> Chain:
    """Return a closed wire in the section's plane: x and z."""
    flat = wire.rotate(cq.Vector(), cq.Vector(1, 0, 0), -90.0)
    pieces = [list(_sampled(edge)) for edge in flat.Edges()]
    points = pieces.pop(0)
    while pieces:
        here = points[-1]
        piece = min(pieces, key=lambda candidate: min(dist(candidate[0], here), dist(candidate[-1], here)))
        pieces.remove(piece)
        points += piece[1:] if dist(piece[0], here) <= dist(piece[-1], here) else piece[-2::-1]
    return Chain(tuple(points))


def _is_on(arc: Arc, angle: float) -> bool:
    """Return whether an arc passes an angle [deg]."""
    span = (arc.end - arc.start) % 360.0 or 360.0
    return (angle - arc.start) % 360.0 <= span


def _round(value: float) -> float:
    return round(value, _DIGITS) + 0.0
