"""Whether a mill of three axes reaches all of a part: from which sides, what stays hidden, and how narrow it gets."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tvimdesign.cad.cad_report import SolidCheck
from tvimdesign.cad.export.mesh import CHORD, Array
from tvimdesign.cad.geometry.features import Cylinder
from tvimdesign.cad.inspection.across import across
from tvimdesign.cad.inspection.finding import at_most, finding
from tvimdesign.cad.inspection.rays import Triangles
from tvimdesign.cad.inspection.samples import Samples, samples

SPACING = 2.5
"""Between samples of the surface [mm]."""
_OFF = 2.0 * CHORD
"""How far from the surface a ray towards the tool starts [mm]."""
_STEEPEST = -0.3
"""A face may look away from the tool by this sine: triangles of a low curved face do. What is truly under cut hides
from the ray."""
_FLAT = 0.99
_NOTHING = 1.0
"""Hidden area [mm^2] that is no more than what the mesh leaves open at edges."""
_ABOVE = 2.0 * CHORD
"""How far above a floor its walls are looked for [mm]."""
_FLOORS = 800
"""Samples of floors, from above and from below, at which the way across is measured."""
SIDES = {
    "+z": np.array([0.0, 0.0, 1.0]), "-z": np.array([0.0, 0.0, -1.0]), "+x": np.array([1.0, 0.0, 0.0]),
    "-x": np.array([-1.0, 0.0, 0.0]), "+y": np.array([0.0, 1.0, 0.0]), "-y": np.array([0.0, -1.0, 0.0]),
}  # fmt: skip
"""From which a part can be milled; those along z are free, for every part has to be turned over."""
_FREE = 2


class Narrow(NamedTuple):
    """The worst of the ways down to a floor."""

    ratio: float
    """Depth over width."""
    width: float
    depth: float
    place: Array


def milling_checks(
    part: str, triangles: Triangles, drilled: Sequence[Cylinder], pocket_depth_ratio: float
) -> list[SolidCheck]:
    """Hold a part against what a mill of three axes reaches; `drilled` are its round holes, which are no pockets."""
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
    """Which samples a tool from that side reaches: they look towards it, and nothing of the part is in between."""
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
        side = max(upright or shows, key=lambda one: shows[one], default="")
        if not side or shows[side] <= _NOTHING:
            return chosen
        chosen.append(side)
        left &= ~seen[side]


def _pocket_check(
    part: str, triangles: Triangles, where: Samples, seen: dict[str, NDArray[np.bool_]], limit: float
) -> SolidCheck:
    found = [narrowest(triangles, where.of(seen[side]), side) for side in ("+z", "-z")]
    worst = max(filter(None, found), key=lambda one: one.ratio, default=None)
    if worst is None:
        return finding(part, "pocket", 0.0, limit, "", "pass", "no floor has walls on both sides", resolution=SPACING)
    text = f"a place {worst.width:.3g} mm wide is {worst.depth:.3g} mm deep, {worst.ratio:.3g} times; "
    text += f"the process cuts {limit:.3g} times"
    return finding(
        part, "pocket", worst.ratio, limit, "", at_most(worst.ratio, limit), text,
        place=worst.place, resolution=SPACING,
    )  # fmt: skip


def _inside(drilled: Sequence[Cylinder], points: Array) -> NDArray[np.bool_]:
    """Which points lie in or at a round hole."""
    inside = np.zeros(len(points), dtype=bool)
    for one in drilled:
        beside = np.hypot(points[:, 0] - one.x, points[:, 1] - one.y)
        level = (points[:, 2] > one.bottom - CHORD) & (points[:, 2] < one.top + CHORD)
        inside |= level & (beside < one.radius + CHORD)
    return inside


def narrowest(triangles: Triangles, seen: Samples, side: str) -> Narrow | None:
    """The floor seen from above or below that is deepest for the least way across it between walls."""
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
