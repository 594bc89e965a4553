"""Half an arc or half a vane of the module in cells along, around and up its axis, each of the part drawn there.

Lines are denser towards the edges of layer and pads. A cell's part is that of the exported surfaces in which its middle
lies, found by a ray upwards. Where parts have a contact of their own, a sheet of THIN stands between them.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
THIN = 5e-3
"""Thickness of the sheets that stand for contacts [mm]: clearances and layers are that much thicker at each."""
PAD_FILM = 1.0 / 12.0
"""Thickness of each side of a pad, over the pad's; assumed. The legs are between them."""
PADS = ("hot", "legs", "cold")
_ASIDE = 1.3e-4
"""Rays pass beside what was drawn on round numbers by this [mm]."""


@dataclass(frozen=True)
class Lines:
    """Ends of cells along one direction as drawn; two alike have a sheet between them."""

    ends: Array

    @property
    def middles(self) -> Array:
        """Middle of each cell."""
        return 0.5 * (self.ends[1:] + self.ends[:-1])

    @property
    def sheets(self) -> Array:
        """Which cells are sheets."""
        return np.asarray(np.diff(self.ends) == 0.0)

    @property
    def thickened(self) -> Array:
        """What the sheets before each end add to where it stands [mm]."""
        return THIN * np.concatenate([[0.0], np.cumsum(self.sheets)])


def lines(start: float, coarser: float, *parts: tuple[float, int, float]) -> Lines:
    """From a start, parts with their end, how many cells, and how much wider each is than the one before.

    A part with no cell is a sheet at its end. A part that begins where it ends, or beyond, is left out.
    """
    ends = [start]
    for end, count, ratio in parts:
        if count == 0:
            ends.append(ends[-1])
        elif end > ends[-1] + 1e-6:
            whole = max(1, round(count / coarser))
            widths = ratio ** (coarser * np.arange(whole))
            ends.extend(ends[-1] + (end - ends[-1]) * np.cumsum(widths) / widths.sum())
    return Lines(np.array(ends))


@dataclass(frozen=True)
class Grid:
    """Cells along (i), around (j) and up (k) the axis, drawn sizes in mm and rad."""

    along: Lines
    around: Lines
    up: Lines
    middle: float
    """Azimuth of the middle of the arc, or of the rotor's vane [rad]."""
    mm: dict[str, float]

    @property
    def upright(self) -> bool:
        """Whether pads stand beside blocks, and do not lie below arcs."""
        return self.mm.get("vane_count", 0.0) > 0.0

    def turned(self, way: Array, radius: Array) -> Array:
        """Angle [rad] from `middle` of a way around the axis: pads that stand have flat backs.

        In a pad and behind it the way of the line is that of a pad of the vane's angle at the inner radius.
        """
        if not self.upright:
            return way
        mm = self.mm
        face, end = face_angle(mm), np.pi / mm["vane_count"]
        inner = np.arcsin(mm["pad_depth"] / mm["pcl_inner_radius"])
        deep = np.sin(np.clip(way - face, 0.0, inner)) * mm["pcl_inner_radius"]
        back = np.arcsin(mm["pad_depth"] / np.maximum(radius, mm["pcl_inner_radius"]))
        within = face + np.arcsin(deep / np.maximum(radius, mm["pcl_inner_radius"]))
        behind = face + back + (way - face - inner) * (end - face - back) / (end - face - inner)
        return np.where(way <= face, way, np.where(way < face + inner, within, behind))

    def points(self) -> Array:
        """Corners of all cells [m], shape (along, around, up, 3)."""
        r, a, z = np.meshgrid(self.along.ends, self.around.ends, self.up.ends, indexing="ij")
        radius = r + self.along.thickened[:, None, None]
        angle = self.middle + self.turned(a, r) + self.around.thickened[None, :, None] / radius
        level = z + self.up.thickened[None, None, :]
        return 1e-3 * np.stack([radius * np.cos(angle), radius * np.sin(angle), level], axis=-1)


def face_angle(mm: dict[str, float]) -> float:
    """Angle [rad] from the middle of the rotor's vane to the face of the housing's."""
    return 0.5 * mm["rotor_vane_angle"] + mm["block_angle"]


def grid_of(mm: dict[str, float], coarser: float) -> Grid:
    """The cells of a module."""
    return (_around_a_vane if mm.get("vane_count", 0.0) > 0.0 else _around_an_arc)(mm, coarser)


def _around_an_arc(mm: dict[str, float], coarser: float) -> Grid:
    inner, outer, ledge, half = (
        mm["pcl_inner_radius"], mm["pcl_outer_radius"], mm["window_ledge"], 0.5 * mm["arc_span"],
    )  # fmt: skip
    core, clear = mm["core_radius"], max(mm["seat_radius"], mm["core_radius"] + 0.1)
    along = lines(
        0.3 * core, coarser, (core, 2, 0.8), (clear, 1, 1.0), (mm["hub_radius"], 1, 1.0),
        (mm["melt_lip_inner_radius"], 3, 0.65), (inner, 3, 0.65), (inner, 0, 1.0),
        (inner + ledge, 3, 1.3), (outer - ledge, 4, 1.0), (outer, 3, 1 / 1.3), (outer, 0, 1.0),
        (mm["rotor_radius"], 3, 1.4), (mm["housing_inner_radius"], 4, 1.5), (mm["housing_outer_radius"], 1, 1.0),
    )  # fmt: skip
    end = half - ledge / inner
    around = lines(0.0, coarser, (end, 4, 0.8), (half, 3, 0.75), (half, 0, 1.0), (np.pi / mm["arc_count"], 4, 1.5))
    pad, sheet = mm["pad_depth"] - mm["spreader_depth"], mm["spreader_depth"]
    film, low = PAD_FILM * pad, -mm["pad_depth"]
    spreader = [(-sheet, 0, 1.0), (0.0, 2, 1.0)] if sheet else []
    top = mm["rotor_bottom_level"]
    hub = min(mm["hub_top_level"], top)
    lips = [(mm["running_clearance"], 1, 1.0)] if mm["melt_lip_height"] else []
    up = lines(
        -mm["floor_thickness"], coarser, (low, 3, 0.7), (low + film, 1, 1.0), (-sheet - film, 3, 1.0), (-sheet, 1, 1.0),
        *spreader, (0.0, 0, 1.0), *lips, (hub, 6, 1.0), (top, 1, 1.0), (top, 0, 1.0), (mm["rotor_top_level"], 5, 1.3),
        (mm["link_bottom_level"], 3, 1.5), (mm["link_bottom_level"] + 1.0, 1, 1.0),
    )  # fmt: skip
    return Grid(along, around, up, np.pi / mm["spring_count"], mm)


def _around_a_vane(mm: dict[str, float], coarser: float) -> Grid:
    inner, outer, core = mm["pcl_inner_radius"], mm["pcl_outer_radius"], mm["core_radius"]
    clear = max(mm["seat_radius"], core + 0.1)
    along = lines(
        0.3 * core, coarser, (core, 2, 0.8), (clear, 1, 1.0), (mm["hub_radius"], 1, 1.0), (inner, 2, 1.0),
        (mm["slot_inner_radius"], 3, 1.3), (mm["slot_outer_radius"], 4, 1.0), (outer, 3, 1 / 1.3),
        (mm["rotor_radius"], 4, 1.4), (mm["housing_inner_radius"], 4, 1.6), (mm["housing_outer_radius"], 1, 1.0),
    )  # fmt: skip
    pad = np.arcsin(mm["pad_depth"] / inner)
    vane, face = 0.5 * mm["rotor_vane_angle"], face_angle(mm)
    around = lines(
        0.0, coarser, (vane, 4, 0.8), (vane, 0, 1.0), (face, 8, 1.0), (face, 0, 1.0),
        (face + PAD_FILM * pad, 1, 1.0), (face + (1.0 - PAD_FILM) * pad, 3, 1.0), (face + pad, 1, 1.0),
        (np.pi / mm["vane_count"], 3, 1.4),
    )  # fmt: skip
    low, high = mm["rotor_bottom_level"] - mm["vane_height"], mm["vane_height"]
    middle, top = 0.5 * (low + high), mm["rotor_bottom_level"]
    up = lines(
        -mm["floor_thickness"], coarser, (0.0, 4, 0.7), (low, 1, 1.0), (low, 0, 1.0), (middle, 4, 1.3),
        (mm["slot_top_level"], 3, 0.8), (high, 2, 0.8), (min(mm["hub_top_level"], top), 1, 1.0), (top, 1, 1.0),
        (mm["rotor_top_level"], 4, 1.4), (mm["link_bottom_level"], 3, 1.5), (mm["link_bottom_level"] + 1.0, 1, 1.0),
    )  # fmt: skip
    return Grid(along, around, up, 0.0, mm)


def materials_of(grid: Grid, surfaces: Any) -> NDArray[np.str_]:
    """The part each cell is of; `air` in gaps, nothing where the air is open. Surfaces are points and triangles."""
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
    return np.asarray(_with_sheets(grid, found))


_PARTS = {"housing": "housing", "rotor": "rotor", "pcl_arc": "layer", "pcl_block": "layer", "peltier_pad": "pad",
          "spreader": "spreader"}  # fmt: skip


def _crossed(points: Array, triangles: Any, x: float, y: float) -> Array:
    """Levels at which an upright line passes a closed surface, from below."""
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
    """The sides of the pads, and the legs between them."""
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


def _closed(grid: Grid, found: Any) -> Any:
    """Where the air cannot move: the gap below the plate, or the clearances above and below what stands on a ring."""
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
    """What air is that no cell has: the `chamber` around blocks that stand, their vanes' `slot`, the `room` of the
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
    **{(pad, "housing"): "edge" for pad in PADS}, ("housing", "spreader"): "edge", ("layer", "key"): "key",
}  # fmt: skip


def _sheet(before: str, after: str) -> str:
    if before == after or "" in (before, after):
        return before if before == after else ""
    if "air" in (before, after):
        return "air"
    if {before, after} & (set(CONTACTS.values()) - {"key"}):
        return "edge"  # where two sheets cross: a solid there would join what both part
    return CONTACTS.get((before, after)) or CONTACTS.get((after, before)) or str(before)
