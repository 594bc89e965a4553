"""Checks of a part as it lies on the print bed: overhangs that need support, bridges, and room on the bed."""

from collections.abc import Sequence
from math import degrees, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from tvimdesign.cad.cad_report import SolidCheck, at_least, finding
from tvimdesign.cad.export.mesh import Array, Mesh
from tvimdesign.cad.inspection.rays import Index, Triangles, across, samples

SPACING = 2.0  # Between samples of a face that overhangs [mm]; of a large one, further, so that there are about `_MANY`
_MANY = 100
_ON_BED = 0.05  # How far above the bed a face still lies on it [mm]
_BELOW = 0.1  # How far below a ceiling its walls are looked for [mm]
_LEVEL = 0.999
_EDGES = 8  # Ways are looked for along so many of a ceiling's edges, the longest
_NOTHING = 1.0  # Overhanging area [mm^2] that needs no word
_TURNED_OVER = np.array([1.0, -1.0, -1.0])


class Overhang(NamedTuple):
    """One connected face, or several, that lean further than the process lets them."""

    area: float  # [mm^2]
    span: float
    """Longest of the shortest ways between walls across it [mm]; infinite where it ends in the air, or leans."""
    middle: Array
    levels: tuple[float, float]  # Between which it lies [mm]


def lying(mesh: Mesh, down: str) -> Mesh:
    """Return the mesh as it is printed: as it stands in the module, or turned over about x."""
    return Mesh(mesh.vertices * _TURNED_OVER, mesh.faces) if down == "top" else mesh


def printing_checks(
    part: str,
    mesh: Mesh,
    down: str,
    overhang_angle: float,
    bridge_span: float,
    bed: tuple[float, float, float],
    supported: Sequence[tuple[float, float]] = (),
) -> list[SolidCheck]:
    """Compare a part as it is printed with the process: angle from upright [rad], lengths [mm].

    `supported` are levels of the module between which faces stand on support: that is reported, and no fault.
    """
    triangles = Triangles(lying(mesh, down))
    leaning = overhangs(triangles, overhang_angle)
    back = _TURNED_OVER if down == "top" else np.ones(3)
    bridges = [patch for patch in leaning if patch.span <= bridge_span]
    hanging = [patch for patch in leaning if patch.span > bridge_span]
    area = sum(patch.area for patch in hanging)
    worst = max(hanging, key=lambda patch: patch.area, default=None)
    is_open = all(any(_within(patch, back[2], between) for between in supported) for patch in hanging)
    angle = f"{degrees(overhang_angle):.3g} deg"
    text = f"{area:.4g} mm2 lean more than {angle} and are no bridge of {bridge_span:.3g} mm or less"
    if worst:
        text += f": they need support, {_places(len(hanging))}, the largest {worst.area:.4g} mm2"
    span = max((patch.span for patch in bridges), default=0.0)
    longest = max(bridges, key=lambda patch: patch.span, default=None)
    bridged = f"{len(bridges)} bridges, the longest {span:.3g} mm" if bridges else "nothing is bridged"
    return [
        finding(
            part, "overhang", area, _NOTHING, "mm^2", "pass" if is_open else "warning", text,
            place=worst.middle * back if worst else None, resolution=SPACING,
        ),
        finding(
            part, "bridge", span, bridge_span, "mm", "pass", bridged,
            place=longest.middle * back if longest else None, resolution=SPACING,
        ),
        bed_check(part, triangles.upper - triangles.lower, bed),
    ]  # fmt: skip


def _within(overhang: Overhang, back: float, between: tuple[float, float]) -> bool:
    """Return whether all of an overhang is between two levels of the module.

    `back` is -1 where the part is turned over.
    """
    low, high = sorted(back * level for level in overhang.levels)
    return low > between[0] - _ON_BED and high < between[1] + _ON_BED


def bed_check(part: str, size: Array, bed: tuple[float, float, float]) -> SolidCheck:
    """Compare a part's box, turned about z as suits it, with what the machine can make [mm]."""
    need, have = sorted(size[:2]), sorted(bed[:2])
    room = min(have[0] - need[0], have[1] - need[1], bed[2] - size[2])
    text = " x ".join(f"{length:.4g}" for length in size) + " mm on a machine for "
    text += " x ".join(f"{length:.4g}" for length in bed) + " mm"
    return finding(part, "bed", room, 0.0, "mm", at_least(room, 0.0), text)


def overhangs(triangles: Triangles, overhang_angle: float) -> list[Overhang]:
    """Find what leans more than an angle from upright [rad] and does not lie on the bed."""
    above = triangles.corners[:, :, 2].max(axis=1) > triangles.lower[2] + _ON_BED
    leaning = -triangles.normal[:, 2] > sin(overhang_angle) + 1e-6
    chosen = np.flatnonzero(above & leaning)
    patches = [_overhang(triangles, group) for group in _connected(triangles.corners, chosen)]
    return [patch for patch in patches if patch.area > _NOTHING]


def _connected(corners: Array, chosen: Index) -> list[Index]:
    if not len(chosen):
        return []
    points = np.round(corners[chosen].reshape(-1, 3), 4) + 0.0
    _, corner = np.unique(points, axis=0, return_inverse=True)
    owner = np.repeat(np.arange(len(chosen)), 3)
    links = coo_matrix((np.ones(len(owner)), (owner, len(chosen) + corner.ravel())), shape=(4 * len(chosen),) * 2)
    _, label = connected_components(links, directed=False)
    return [chosen[label[: len(chosen)] == number] for number in np.unique(label[: len(chosen)])]


def _overhang(triangles: Triangles, group: Index) -> Overhang:
    area = float(triangles.area[group].sum())
    where = samples(triangles, max(SPACING, sqrt(area / _MANY)), group)
    level = bool(np.all(-triangles.normal[group, 2] > _LEVEL))
    down = np.array([0.0, 0.0, -1.0])
    spans = np.full(len(where), np.inf)
    if level:
        spans = across(triangles, where.point + _BELOW * down, down, _edge_directions(triangles.corners[group]))[0]
    worst = int(np.argmax(spans))
    heights = triangles.corners[group][:, :, 2]
    return Overhang(area, float(spans[worst]), where.point[worst], (float(heights.min()), float(heights.max())))


def _edge_directions(corners: Array) -> list[float]:
    """Return azimuths [rad] of the longest outer edges of level triangles.

    Beside an edge where a ceiling ends in the air, only a bridge that runs along it has both its ends on walls.
    """
    points, number = np.unique(np.round(corners[:, :, :2].reshape(-1, 2), 4) + 0.0, axis=0, return_inverse=True)
    around = number.reshape(-1, 3)
    start, end = around.ravel(), around[:, [1, 2, 0]].ravel()
    outer = ~np.isin(start * len(points) + end, end * len(points) + start)
    way = (points[end] - points[start])[outer]
    longest_first = way[np.argsort(-np.hypot(*way.T), kind="stable")]
    azimuths = np.arctan2(longest_first[:, 1], longest_first[:, 0]) % pi
    _, first = np.unique(np.round(azimuths, 3), return_index=True)
    return [float(azimuth) for azimuth in azimuths[np.sort(first)[:_EDGES]]]


def _places(count: int) -> str:
    return "in one place" if count == 1 else f"in {count} places"
