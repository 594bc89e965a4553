"""Lines between the cells of half an arc or half a vane: along, around and up the axis.

Cells are narrow where heat crowds: at the edges of layer and pads. Where parts have a contact of their own, a sheet of
THIN stands between them; between a pad's rim and what that leans against, a slot of still air that conducts as their
contact does, so that no corner is at two temperatures.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Part = tuple[float, int, float]
THIN = 5e-3
"""Thickness of the sheets that stand for contacts [mm]: clearances and layers are that much thicker at each."""
SLOT = 0.02, 0.3
"""Least and most width of the slot at a pad's rim [mm]."""
PAD_FILM = 1.0 / 12.0
"""Thickness of each side of a pad, over the pad's; assumed. The legs are between them."""
EDGE, WIDER, WIDEST = 0.2, 0.5, 2.0
"""Width of cells at an edge [mm], how much wider they are for each millimetre from there, and at most."""
BESIDE = 0.4
"""Part of a cell's width in which lines that lie so near each other are one: tiles end near their windows' ledge."""


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
        """Thickness that the sheets before each end add to where it stands [mm]."""
        return THIN * np.concatenate([[0.0], np.cumsum(self.sheets)])


def lines(start: float, coarser: float, *parts: Part) -> Lines:
    """Return from a start, parts with their end, how many cells, and how much wider each is than the one before.

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


def graded(stops: Iterable[float], edges: Sequence[float], radius: float, coarser: float) -> list[Part]:
    """Return the parts of one cell each between stops, narrow at edges.

    In rad at a radius [mm], or in mm at the radius 1.
    """
    rising = sorted(stops)
    kept = [rising[0]]
    for stop in rising[1:-1]:
        if min(stop - kept[-1], rising[-1] - stop) * radius > BESIDE * _width(stop, edges, radius):
            kept.append(stop)
    kept.append(rising[-1])
    found: list[Part] = []
    for low, high in pairwise(kept):
        places = np.linspace(low, high, 201)
        per_way = radius / (coarser * np.array([_width(place, edges, radius) for place in places]))
        cells = np.concatenate([[0.0], np.cumsum(0.5 * (per_way[1:] + per_way[:-1]) * np.diff(places))])
        whole = max(1, round(cells[-1]))
        ends = np.interp(np.arange(1, whole + 1) / whole * cells[-1], cells, places)
        found += [(float(end), 1, 1.0) for end in ends]
    return found


def _width(place: float, edges: Sequence[float], radius: float) -> float:
    """Return width a cell should have at a place [mm]."""
    return min(WIDEST, EDGE + WIDER * radius * min(abs(place - edge) for edge in edges))


@dataclass(frozen=True)
class Grid:
    """Cells along (i), around (j) and up (k) the axis, drawn sizes in mm and rad."""

    along: Lines
    around: Lines
    up: Lines
    middle: float
    """Azimuth of the middle of the arc, or of the rotor's vane [rad]."""
    mm: dict[str, float]
    slot: float
    """Width of the slot at a pad's rim [mm]."""

    @property
    def upright(self) -> bool:
        """True if pads stand beside blocks, and do not lie below arcs."""
        return self.mm.get("vane_count", 0.0) > 0.0

    def turned(self, way: Array, radius: Array) -> Array:
        """Return angle [rad] from `middle` of a way around the axis: pads that stand have flat backs.

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
        """Return the corners of all cells [m], shape (along, around, up, 3)."""
        r, a, z = np.meshgrid(self.along.ends, self.around.ends, self.up.ends, indexing="ij")
        radius = r + self.along.thickened[:, None, None]
        angle = self.middle + self.turned(a, r) + self.around.thickened[None, :, None] / radius
        level = z + self.up.thickened[None, None, :]
        return 1e-3 * np.stack([radius * np.cos(angle), radius * np.sin(angle), level], axis=-1)


def face_angle(mm: dict[str, float]) -> float:
    """Return angle [rad] from the middle of the rotor's vane to the face of the housing's."""
    return 0.5 * mm["rotor_vane_angle"] + mm["block_angle"]


def grid_of(mm: dict[str, float], coarser: float, slot: float) -> Grid:
    """Return the cells of a module, with a slot as wide as that [mm], within bounds, at the rims of its pads."""
    return (_around_a_vane if mm.get("vane_count", 0.0) > 0.0 else _around_an_arc)(
        mm, coarser, float(np.clip(slot, *SLOT))
    )


def _around_an_arc(mm: dict[str, float], coarser: float, slot: float) -> Grid:
    inner, outer, half = mm["pcl_inner_radius"], mm["pcl_outer_radius"], 0.5 * mm["arc_span"]
    core, clear = mm["core_radius"], max(mm["seat_radius"], mm["core_radius"] + 0.1)
    along_stops, around_stops = (_tiled if mm["spreader_depth"] else _windowed)(mm)
    along = lines(
        0.3 * core, coarser, (core, 2, 0.8), (clear, 1, 1.0), (mm["hub_radius"], 1, 1.0),
        (mm["melt_lip_inner_radius"], 2, 0.65), (inner - slot, 4, 0.6), (inner, 1, 1.0),
        *graded((inner, *along_stops, outer), (inner, outer), 1.0, coarser), (outer + slot, 1, 1.0),
        (mm["rotor_radius"], 4, 1.6), (mm["housing_inner_radius"], 4, 1.5), (mm["housing_outer_radius"], 1, 1.0),
    )  # fmt: skip
    mean = 0.5 * (inner + outer)
    around = lines(
        0.0, coarser, *graded((0.0, *around_stops, half), (half,), mean, coarser), (half + slot / mean, 1, 1.0),
        (np.pi / mm["arc_count"], 4, 1.5),
    )  # fmt: skip
    pad, sheet = mm["pad_depth"] - mm["spreader_depth"], mm["spreader_depth"]
    film, low = PAD_FILM * pad, -mm["pad_depth"]
    spreader = [(-sheet, 0, 1.0), (0.0, 2, 1.0)] if sheet else []
    top = mm["rotor_bottom_level"]
    hub = min(mm["hub_top_level"], top)
    lips = [(mm["running_clearance"], 1, 1.0)] if mm["melt_lip_height"] else []
    up = lines(
        -mm["floor_thickness"], coarser, (low, 3, 0.7), (low + film, 1, 1.0), (-sheet - film, 4, 1.0), (-sheet, 1, 1.0),
        *spreader, (0.0, 0, 1.0), *lips, (hub, 8, 1.2), (top, 1, 1.0), (top, 0, 1.0), (mm["rotor_top_level"], 5, 1.3),
        (mm["link_bottom_level"], 3, 1.5), (mm["link_bottom_level"] + 1.0, 1, 1.0),
    )  # fmt: skip
    return Grid(along, around, up, np.pi / mm["spring_count"], mm, slot)


def _windowed(mm: dict[str, float]) -> tuple[list[float], list[float]]:
    """Return where the window below a pad ends, along and around."""
    inner, outer, ledge = mm["pcl_inner_radius"], mm["pcl_outer_radius"], mm["window_ledge"]
    return [inner + ledge, outer - ledge], [0.5 * mm["arc_span"] - ledge / inner]


def _tiled(mm: dict[str, float]) -> tuple[list[float], list[float]]:
    """Return where rigid modules and the windows below them end, along and around."""
    ledge, place, count = mm["window_ledge"], mm["tile_radius"], round(mm["tiles_per_arc"])
    along, around = [], []
    for less, length in ((0.0, "peltier_length"), (ledge, "cold_plate_length")):
        deep, long = 0.5 * mm["peltier_width"] - less, 0.5 * mm[length] - less
        middles = [mm["tile_pitch"] * (tile - 0.5 * (count - 1)) for tile in range(count)]
        along += [place - deep, place + deep]
        around += [
            one for middle in middles for side in (-1, 1) if (one := middle + side * np.arctan2(long, place)) > 0
        ]
    return along, around


def _around_a_vane(mm: dict[str, float], coarser: float, slot: float) -> Grid:
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
        0.0, coarser, (vane, 4, 0.8), (vane, 0, 1.0),
        *graded((vane, face), (face,), 0.5 * (inner + outer), coarser), (face, 0, 1.0),
        (face + PAD_FILM * pad, 1, 1.0), (face + (1.0 - PAD_FILM) * pad, 4, 1.0), (face + pad, 1, 1.0),
        (np.pi / mm["vane_count"], 3, 1.4),
    )  # fmt: skip
    low, high = mm["rotor_bottom_level"] - mm["vane_height"], mm["vane_height"]
    slot, middle, top = min(slot, 0.5 * low), 0.5 * (low + high), mm["rotor_bottom_level"]
    up = lines(
        -mm["floor_thickness"], coarser, (0.0, 4, 0.7), (low - slot, 3, 0.7), (low, 1, 1.0),
        (middle, 4, 1.5), (mm["slot_top_level"], 3, 0.8), (high, 3, 0.7), (min(mm["hub_top_level"], top), 2, 1.5),
        (top, 2, 1.5), (mm["rotor_top_level"], 4, 1.4), (mm["link_bottom_level"], 3, 1.5),
        (mm["link_bottom_level"] + 1.0, 1, 1.0),
    )  # fmt: skip
    return Grid(along, around, up, 0.0, mm, slot)
