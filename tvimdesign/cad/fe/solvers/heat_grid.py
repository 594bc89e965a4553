"""Half an arc or half a vane of the module in cells, each of the part drawn there, on the lines of `heat_lines`.

A cell's part is that of the exported surfaces in which its middle lies, found by a ray upwards. Contacts are sheets
and slots between the parts.
"""

from typing import Any

import numpy as np
from heat_lines import PAD_FILM, Array, Grid, face_angle
from numpy.typing import NDArray

PADS = ("hot", "legs", "cold")
_ASIDE = 1.3e-4
"""Rays pass beside what was drawn on round numbers by this [mm]."""


def materials_of(grid: Grid, surfaces: Any) -> NDArray[np.str_]:
    """Return part each cell is of; `air` in gaps, nothing where the air is open. Surfaces are points and triangles."""
    mm, shape = grid.mm, (len(grid.along.middles), len(grid.around.middles), len(grid.up.middles))
    found = np.full(shape, "", dtype="U20")
    drawn = sorted({name.rsplit(".", 1)[0] for name in surfaces})
    for i, radius in enumerate(grid.along.middles):
        angles = grid.middle + grid.turned(grid.around.middles, np.full(shape[1], radius))
        for j, angle in enumerate(angles):
            place = radius * np.cos(angle) + _ASIDE, radius * np.sin(angle) - 0.7 * _ASIDE
            for name in drawn:
                levels = _crossed(surfaces[f"{name}.points"], surfaces[f"{name}.triangles"], *place)
                inside = np.searchsorted(levels, grid.up.middles) % 2 == 1
                found[i, j, inside] = _PARTS[name.rstrip("_0123456789")]
    _tell_pads_apart(grid, found)
    r, z = grid.along.middles[:, None, None], grid.up.middles[None, None, :]
    found[(found == "layer") & (z > mm["rotor_bottom_level"])] = "key"
    found[np.broadcast_to((z > mm["link_bottom_level"]) & (r < mm["core_radius"]), shape)] = "link"
    found[np.broadcast_to((z > mm["link_bottom_level"]) & (r > mm["core_radius"]), shape)] = ""
    found[(found == "") & _closed(grid, found)] = "air"
    _cut_slots(grid, found)
    return np.asarray(_with_sheets(grid, found))


_PARTS = {"housing": "housing", "rotor": "rotor", "pcl_arc": "layer", "pcl_block": "layer", "peltier_pad": "pad",
          "spreader": "spreader"}  # fmt: skip


def _crossed(points: Array, triangles: Any, x: float, y: float) -> Array:
    """Return the levels at which an upright line passes a closed surface, from below."""
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    reach = [(np.minimum(np.minimum(a, b), c)[:, axis], np.maximum(np.maximum(a, b), c)[:, axis]) for axis in (0, 1)]
    near = np.ones(len(a), dtype=bool)
    for (least, most), at in zip(reach, (x, y), strict=True):
        near &= (least <= at) & (at <= most)
    a, b, c = a[near], b[near], c[near]
    (ux, uy), (vx, vy) = (b - a)[:, :2].T, (c - a)[:, :2].T
    area = ux * vy - uy * vx
    kept = np.abs(area) > 1e-12
    wx, wy = x - a[:, 0], y - a[:, 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        s, t = (wx * vy - wy * vx) / area, (ux * wy - uy * wx) / area
        inside = kept & (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0)
    a, b, c, s, t = (one[inside] for one in (a, b, c, s, t))
    return np.sort(a[:, 2] + s * (b - a)[:, 2] + t * (c - a)[:, 2])


def _tell_pads_apart(grid: Grid, found: Any) -> None:
    """Part the sides of the pads from the legs between them."""
    mm = grid.mm
    if grid.upright:
        thick = np.arcsin(mm["pad_depth"] / mm["pcl_inner_radius"])
        share = ((grid.around.middles - face_angle(mm)) / thick)[None, :, None]
    else:
        share = ((-mm["spreader_depth"] - grid.up.middles) / (mm["pad_depth"] - mm["spreader_depth"]))[None, None, :]
    share = np.broadcast_to(share, found.shape)
    pad = found == "pad"
    for name, side in zip(PADS, (share < PAD_FILM, share >= PAD_FILM, share > 1.0 - PAD_FILM), strict=True):
        found[pad & side] = name


def _cut_slots(grid: Grid, found: Any) -> None:
    """Part pads and spreaders from the housing beside or below their rims, and the layer from the rotor's lips."""
    mm, slot = grid.mm, grid.slot
    r, a, z = _places(grid)
    if grid.upright:
        low = mm["rotor_bottom_level"] - mm["vane_height"]
        row = int(np.searchsorted(grid.up.ends, low - 0.5 * slot)) - 1
        stands = (found[:, :, row] == "housing") & np.isin(found[:, :, row + 1], PADS)
        found[:, :, row][stands] = "edge"
        return
    inner, outer = mm["pcl_inner_radius"], mm["pcl_outer_radius"]
    near = (r > inner - slot) & (r < outer + slot) & (a < 0.5 * mm["arc_span"] + 2.0 * slot / (inner + outer))
    within = (r > inner) & (r < outer) & (a < 0.5 * mm["arc_span"])
    beside = (z < 0.0) & (z > -mm["pad_depth"]) & ~within & _in_pocket(grid)
    found[beside & (found == "")] = "housing"  # the slot is as wide as its contact says, whatever the pocket is
    found[near & (z < 0.0) & (z > -mm["pad_depth"]) & (found == "housing")] = "edge"
    along_rims = (a < 0.5 * mm["arc_span"]) & ((r < inner) | (r > outer)) & (z > -mm["spreader_depth"])
    found[along_rims & (found == "edge")] = "seat"
    for beside, column in ((1, inner - 0.5 * slot), (-1, outer + 0.5 * slot)):
        i = int(np.searchsorted(grid.along.ends, column)) - 1
        found[i][(found[i] == "rotor") & (found[i + beside] == "layer")] = "lip"


def _in_pocket(grid: Grid) -> Any:
    """Return what a pocket takes of the floor, its clearance around the pad included."""
    mm = grid.mm
    r, a, _ = _places(grid)
    return (r > mm["pocket_inner_radius"]) & (r < mm["pocket_outer_radius"]) & (a < 0.5 * mm["pocket_span"])


def _places(grid: Grid) -> tuple[Array, Array, Array]:
    """Return the middles of the cells along, around and up, each along its own axis."""
    return (grid.along.middles[:, None, None], grid.around.middles[None, :, None], grid.up.middles[None, None, :])


def _closed(grid: Grid, found: Any) -> Any:
    """Return where the air cannot move: the gap below the plate, or the clearances above and below what stands on a
    ring."""
    mm = grid.mm
    r, z = grid.along.middles[:, None, None], grid.up.middles[None, None, :]
    between = (z > 0.0) & (z < mm["rotor_bottom_level"])
    if not grid.upright:
        return between & (r > mm["seat_radius"]) & (r < mm["rotor_radius"]) & np.ones_like(found, dtype=bool) | (
            (z < 0.0) & (z > -mm["pad_depth"]) & (r > mm["pcl_inner_radius"]) & (r < mm["pcl_outer_radius"])
            & (grid.around.middles < 0.5 * mm["arc_span"])[None, :, None]
        )  # fmt: skip
    floor = int(np.searchsorted(grid.up.ends, -0.5 * mm["floor_thickness"])) - 1
    covered = (found[:, :, floor] == "housing")[:, :, None]
    ring = (r > mm["pcl_inner_radius"]) & (r < mm["pcl_outer_radius"])
    return between & ring & covered & ((z < mm["rotor_bottom_level"] - mm["vane_height"]) | (z > mm["vane_height"]))


def enclosed(grid: Grid, names: NDArray[np.str_]) -> NDArray[np.str_]:
    """Return what air is that no cell has: the `chamber` around blocks that stand, their vanes' `slot`, the `room` of
    the
    springs within the housing's wall, else the ambient's."""
    found, mm = np.full(names.shape, "", dtype="U7"), grid.mm
    r, a = grid.along.middles[:, None, None], grid.around.middles[None, :, None]
    z = grid.up.middles[None, None, :]
    room = (z > 0.0) & (r < mm["housing_inner_radius"]) & np.ones_like(a, dtype=bool)
    found[(names == "") & room] = "room"
    if not grid.upright:
        return found
    slot = (r > mm["slot_inner_radius"]) & (r < mm["slot_outer_radius"]) & (z < mm["slot_top_level"])
    chamber = (z > 0.0) & (z < mm["rotor_bottom_level"]) & (r > mm["hub_radius"]) & (r < mm["rotor_radius"])
    found[(names == "") & chamber & np.ones_like(a, dtype=bool)] = "chamber"
    found[(names == "") & slot & (a > face_angle(mm))] = "slot"
    return found


def _with_sheets(grid: Grid, found: Any) -> Any:
    """Name the sheets by what they part: nothing beside nothing, air beside air, else both names."""
    for axis, one in ((2, grid.up), (1, grid.around), (0, grid.along)):
        moved = np.moveaxis(found, axis, 0)
        for at in np.flatnonzero(one.sheets):
            moved[at] = np.vectorize(_sheet, otypes=["U20"])(moved[at - 1], moved[at + 1])
    return found


CONTACTS = {
    ("hot", "layer"): "near", ("layer", "rotor"): "far", ("hot", "spreader"): "spread", ("layer", "spreader"): "near",
    ("layer", "key"): "key",
}  # fmt: skip
SHEETS = {"near", "far", "spread", "edge", "seat", "lip"}


def _sheet(before: str, after: str) -> str:
    if before == after or "" in (before, after):
        return before if before == after else ""
    if "air" in (before, after):
        # The housing's face stays a sheet away from air that a warm edge heats: else it would be as warm there.
        return "housing" if "housing" in (before, after) else "air"
    if {before, after} & SHEETS:
        return "edge"  # where two sheets cross: a solid there would join what both part
    return CONTACTS.get((before, after)) or CONTACTS.get((after, before)) or str(before)
