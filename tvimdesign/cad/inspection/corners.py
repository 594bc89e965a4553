"""Upright inner corners and holes of a part, read off its faces and edges: what a round tool can cut, exactly."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import cadquery as cq
import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_State

from tvimdesign.cad.cad_report import SolidCheck
from tvimdesign.cad.export.mesh import Array
from tvimdesign.cad.geometry.features import Cylinder, upright_cylinders
from tvimdesign.cad.inspection.finding import at_most, finding

_BESIDE = 0.01
"""How far beside an edge it is looked whether there is material [mm]."""
_SMOOTH = 0.02
"""Sine of the angle between two faces up to which they pass into one another."""
_WIDEST = 12.0
"""A concave face of a larger radius [mm] is a wall, not the round corner of a pocket."""


class Corner(NamedTuple):
    """An upright corner a tool has to reach into."""

    radius: float
    """Zero where it is sharp [mm]."""
    depth: float
    place: Array


def corner_checks(part: str, solid: cq.Solid, corner_radius: float, corner_depth_ratio: float) -> list[SolidCheck]:
    """Hold the upright inner corners of a part against the radius a cutter has and how deep it cuts [mm]."""
    sharp, rounded = list(sharp_corners(solid)), list(round_corners(solid))
    worst = max(sharp, key=lambda one: one.depth, default=None)
    text = f"{len(sharp)} upright inner corners are sharp"
    if worst:
        text += (
            f", the deepest {worst.depth:.3g} mm: a cutter leaves {corner_radius:.3g} mm there, which nothing may need"
        )
    deepest = max(rounded, key=lambda one: one.depth / one.radius, default=None)
    ratio = deepest.depth / deepest.radius if deepest else 0.0
    reported = "no upright inner corner is round"
    if deepest:
        reported = f"a corner of {deepest.radius:.3g} mm is {deepest.depth:.3g} mm deep, {ratio:.3g} times its radius; "
        reported += f"a cutter reaches {corner_depth_ratio:.3g} times"
    return [
        finding(
            part, "sharp corners", len(sharp), 0.0, "", "warning" if sharp else "pass", text,
            place=worst.place if worst else None,
        ),
        finding(
            part, "corner depth", ratio, corner_depth_ratio, "", at_most(ratio, (1.0 + 1e-6) * corner_depth_ratio),
            reported,
            place=deepest.place if deepest else None,
        ),
    ]  # fmt: skip


def hole_check(part: str, drilled: Sequence[Cylinder], hole_depth_ratio: float) -> SolidCheck:
    """Hold the round upright holes of a part against how deep a drill goes."""
    deepest = max(drilled, key=lambda one: (one.top - one.bottom) / one.radius, default=None)
    if deepest is None:
        return finding(part, "hole", 0.0, hole_depth_ratio, "", "pass", "no holes")
    depth = deepest.top - deepest.bottom
    ratio = 0.5 * depth / deepest.radius
    text = f"of {len(drilled)} holes one of {2.0 * deepest.radius:.3g} mm is {depth:.3g} mm deep, {ratio:.3g} times; "
    text += f"the process drills {hole_depth_ratio:.3g} times"
    place = np.array([deepest.x, deepest.y, 0.5 * (deepest.bottom + deepest.top)])
    return finding(part, "hole", ratio, hole_depth_ratio, "", at_most(ratio, hole_depth_ratio), text, place=place)


def round_corners(solid: cq.Solid) -> Iterator[Corner]:
    """Upright concave cylinders that are no holes."""
    for one in upright_cylinders(solid):
        if one.concave and not one.is_round and one.radius < _WIDEST:
            middle = np.array([one.x, one.y, 0.5 * (one.bottom + one.top)])
            outwards = one.radius * np.array([np.cos(one.middle), np.sin(one.middle), 0.0])
            yield Corner(one.radius, one.top - one.bottom, middle + outwards)


def sharp_corners(solid: cq.Solid) -> Iterator[Corner]:
    """Upright straight edges with material on more than half of the way round."""
    classifier = BRepClass3d_SolidClassifier(solid.wrapped)
    for edge, faces in _edges_with_faces(solid):
        if edge.geomType() != "LINE" or len(faces) != 2 or abs(abs(edge.tangentAt(0.5).z) - 1.0) > 1e-6:
            continue
        middle = edge.positionAt(0.5)
        one, other = (face.normalAt(middle) for face in faces)
        if one.cross(other).Length < _SMOOTH:
            continue
        # Of a convex edge, what lies behind one face and before the other is outside.
        beside = middle + (one - other).normalized() * _BESIDE
        classifier.Perform(gp_Pnt(*beside.toTuple()), 1e-7)
        if classifier.State() == TopAbs_State.TopAbs_IN:
            yield Corner(0.0, edge.Length(), np.array(middle.toTuple()))


def _edges_with_faces(solid: cq.Solid) -> Iterator[tuple[cq.Edge, list[cq.Face]]]:
    """Every edge with the faces that meet there; not the seam of a closed face."""
    found: dict[cq.Edge, list[cq.Face]] = {}
    for face in solid.Faces():
        for edge in face.Edges():
            if not BRep_Tool.IsClosed_s(edge.wrapped, face.wrapped):
                found.setdefault(edge, []).append(face)
    yield from found.items()
