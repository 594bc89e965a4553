"""Checks for a mill of three axes: sides it reaches a part from, hidden and narrow places, corners and holes."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import cadquery as cq
import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_State

from tvimdesign.cad.cad_report import SolidCheck, at_most, finding
from tvimdesign.cad.export.mesh import CHORD, Array
from tvimdesign.cad.geometry.features import Cylinder, upright_cylinders
from tvimdesign.cad.inspection.rays import Samples, Triangles, across, samples

_BESIDE = 0.01  # How far beside an edge it is looked whether there is material [mm]
_SMOOTH = 0.02  # Sine of the angle between two faces up to which they pass into one another
_WIDEST = 12.0  # A concave face of a larger radius [mm] is a wall, not the round corner of a pocket


class Corner(NamedTuple):
    """An upright corner a tool has to reach into."""

    radius: float  # Zero where it is sharp [mm]
    depth: float
    place: Array


def corner_checks(part: str, solid: cq.Solid, corner_radius: float, corner_depth_ratio: float) -> list[SolidCheck]:
    """Compare the upright inner corners of a part with the radius a cutter has and how deep it cuts [mm]."""
    sharp, rounded = list(sharp_corners(solid)), list(round_corners(solid))
    worst = max(sharp, key=lambda corner: corner.depth, default=None)
    text = f"{len(sharp)} upright inner corners are sharp"
    if worst:
        text += (
            f", the deepest {worst.depth:.3g} mm: a cutter leaves {corner_radius:.3g} mm there, which nothing may need"
        )
    deepest = max(rounded, key=lambda corner: corner.depth / corner.radius, default=None)
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
    """Compare the round upright holes of a part with how deep a drill goes."""
    deepest = max(drilled, key=lambda hole: (hole.top - hole.bottom) / hole.radius, default=None)
    if deepest is None:
        return finding(part, "hole", 0.0, hole_depth_ratio, "", "pass", "no holes")
    depth = deepest.top - deepest.bottom
    ratio = 0.5 * depth / deepest.radius
    text = f"of {len(drilled)} holes one of {2.0 * deepest.radius:.3g} mm is {depth:.3g} mm deep, {ratio:.3g} times; "
    text += f"the process drills {hole_depth_ratio:.3g} times"
    place = np.array([deepest.x, deepest.y, 0.5 * (deepest.bottom + deepest.top)])
    return finding(part, "hole", ratio, hole_depth_ratio, "", at_most(ratio, hole_depth_ratio), text, place=place)


def round_corners(solid: cq.Solid) -> Iterator[Corner]:
    """Yield upright concave cylinders that are no holes."""
    for cylinder in upright_cylinders(solid):
        if cylinder.concave and not cylinder.is_round and cylinder.radius < _WIDEST:
            middle = np.array([cylinder.x, cylinder.y, 0.5 * (cylinder.bottom + cylinder.top)])
            outwards = cylinder.radius * np.array([np.cos(cylinder.middle), np.sin(cylinder.middle), 0.0])
            yield Corner(cylinder.radius, cylinder.top - cylinder.bottom, middle + outwards)


def sharp_corners(solid: cq.Solid) -> Iterator[Corner]:
    """Yield upright straight edges with material on more than half of the way round."""
    classifier = BRepClass3d_SolidClassifier(solid.wrapped)
    for edge, faces in _edges_with_faces(solid):
        if edge.geomType() != "LINE" or len(faces) != 2 or abs(abs(edge.tangentAt(0.5).z) - 1.0) > 1e-6:
            continue
        middle = edge.positionAt(0.5)
        normal, other = (face.normalAt(middle) for face in faces)
        if normal.cross(other).Length < _SMOOTH:
            continue
        # Of a convex edge, what lies behind one face and before the other is outside.
        beside = middle + (normal - other).normalized() * _BESIDE
        classifier.Perform(gp_Pnt(*beside.toTuple()), 1e-7)
        if classifier.State() == TopAbs_State.TopAbs_IN:
            yield Corner(0.0, edge.Length(), np.array(middle.toTuple()))


def _edges_with_faces(solid: cq.Solid) -> Iterator[tuple[cq.Edge, list[cq.Face]]]:
    """Yield every edge with the faces that meet there; not the seam of a closed face."""
    faces: dict[cq.Edge, list[cq.Face]] = {}
    for face in solid.Faces():
        for edge in face.Edges():
            if not BRep_Tool.IsClosed_s(edge.wrapped, face.wrapped):
                faces.setdefault(edge, []).append(face)
    yield from faces.items()


SPACING = 2.5  # Between samples of the surface [mm]
_OFF = 2.0 * CHORD  # How far from the surface a ray towards the tool starts [mm]
_STEEPEST = -0.3
"""A face may look away from the tool by this sine: triangles of a low curved face do. What is truly under cut hides
from the ray."""
_FLAT = 0.99
_NOTHING = 1.0  # Hidden area [mm^2] that is no more than what the mesh leaves open at edges
_ABOVE = 2.0 * CHORD  # How far above a floor its walls are looked for [mm]
_FLOORS = 800  # Samples of floors, from above and from below, at which the way across is measured
SIDES = {
    "+z": np.array([0.0, 0.0, 1.0]), "-z": np.array([0.0, 0.0, -1.0]), "+x": np.array([1.0, 0.0, 0.0]),
    "-x": np.array([-1.0, 0.0, 0.0]), "+y": np.array([0.0, 1.0, 0.0]), "-y": np.array([0.0, -1.0, 0.0]),
}  # fmt: skip
"""From which a part can be milled; those along z are free, for every part has to be turned over."""
_FREE = 2


class Narrow(NamedTuple):
    """The worst of the ways down to a floor."""

    ratio: float  # Depth over width
    width: float
    depth: float
    place: Array


def milling_checks(
    part: str, triangles: Triangles, drilled: Sequence[Cylinder], pocket_depth_ratio: float
) -> list[SolidCheck]:
    """Compare a part with what a mill of three axes reaches; `drilled` are its round holes, which are no pockets."""
    everywhere = samples(triangles, SPACING)
    seen = {side: reached(triangles, everywhere, tool) for side, tool in SIDES.items()}
    chosen = set_ups(everywhere, seen)
    hidden = everywhere.of(~np.logical_or.reduce([seen[side] for side in chosen]))
    area = float(hidden.area.sum())
    holes = _inside(drilled, everywhere.point)
    words = f"{len(chosen)} set-ups ({', '.join(chosen)})"
    undercut = f"{area:.3g} mm2 are reached in none of {words}"
    return [
        finding(
            part, "set-ups", len(chosen), _FREE, "", "pass" if len(chosen) <= _FREE else "warning",
            f"reached in {words}", resolution=SPACING,
        ),
        finding(
            part, "undercut", area, _NOTHING, "mm^2", at_most(area, _NOTHING), undercut,
            place=hidden.point[int(np.argmax(hidden.area))] if area > _NOTHING else None, resolution=SPACING,
        ),
        _pocket_check(part, triangles, everywhere, {side: seen[side] & ~holes for side in SIDES}, pocket_depth_ratio),
    ]  # fmt: skip


def reached(triangles: Triangles, where: Samples, tool: Array) -> NDArray[np.bool_]:
    """Return which samples a tool from that side reaches: they look towards it, and nothing of the part is in
    between."""
    facing = where.normal @ tool >= _STEEPEST
    some = where.of(facing)
    hits = triangles.first_hits(some.point + _OFF * some.normal, np.tile(tool, (len(some), 1)))
    seen = np.zeros(len(where), dtype=bool)
    seen[np.flatnonzero(facing)[hits.missed]] = True
    return seen


def set_ups(where: Samples, seen: dict[str, NDArray[np.bool_]]) -> list[str]:
    """Choose sides to mill from: above and below where that is of use, then whichever shows most of what is left."""
    left = np.ones(len(where), dtype=bool)
    chosen: list[str] = []
    while True:
        shows = {side: float(where.area[left & seen[side]].sum()) for side in SIDES if side not in chosen}
        upright = {side: area for side, area in shows.items() if side.endswith("z") and area > _NOTHING}
        side = max(upright or shows, key=lambda candidate: shows[candidate], default="")
        if not side or shows[side] <= _NOTHING:
            return chosen
        chosen.append(side)
        left &= ~seen[side]


def _pocket_check(
    part: str, triangles: Triangles, where: Samples, seen: dict[str, NDArray[np.bool_]], limit: float
) -> SolidCheck:
    places = [narrowest(triangles, where.of(seen[side]), side) for side in ("+z", "-z")]
    worst = max(filter(None, places), key=lambda place: place.ratio, default=None)
    if worst is None:
        return finding(part, "pocket", 0.0, limit, "", "pass", "no floor has walls on both sides", resolution=SPACING)
    text = f"a place {worst.width:.3g} mm wide is {worst.depth:.3g} mm deep, {worst.ratio:.3g} times; "
    text += f"the process cuts {limit:.3g} times"
    return finding(
        part, "pocket", worst.ratio, limit, "", at_most(worst.ratio, limit), text, place=worst.place, resolution=SPACING
    )


def _inside(drilled: Sequence[Cylinder], points: Array) -> NDArray[np.bool_]:
    """Return which points lie in or at a round hole."""
    inside = np.zeros(len(points), dtype=bool)
    for hole in drilled:
        beside = np.hypot(points[:, 0] - hole.x, points[:, 1] - hole.y)
        level = (points[:, 2] > hole.bottom - CHORD) & (points[:, 2] < hole.top + CHORD)
        inside |= level & (beside < hole.radius + CHORD)
    return inside


def narrowest(triangles: Triangles, seen: Samples, side: str) -> Narrow | None:
    """Return the floor seen from above or below that is deepest for the least way across it between walls."""
    tool = SIDES[side]
    floors = seen.of(seen.normal @ tool > _FLAT)
    floors = floors.of(np.arange(0, len(floors), max(1, len(floors) // _FLOORS)))
    if not len(floors):
        return None
    width, height = across(triangles, floors.point + _ABOVE * tool, tool)
    enclosed = np.flatnonzero(np.isfinite(width))
    if not len(enclosed):
        return None
    ratio = height[enclosed] / width[enclosed]
    worst = enclosed[int(np.argmax(ratio))]
    return Narrow(float(height[worst] / width[worst]), float(width[worst]), float(height[worst]), floors.point[worst])
