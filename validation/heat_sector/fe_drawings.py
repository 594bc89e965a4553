"""Drawings of the strip and of the ring for `fe.py`, made anew from the numbers of a module; nothing of `plane.py`.

A drawing has lines of a grid, what lies between them, what that is made of, what is exchanged over the lines between
two materials and which bodies of one temperature take part. Contacts are sheets a micrometre thick that conduct alike.
SI and degC, for one metre of edge or of width.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import log, pi

import numpy as np

SHEET = 1e-6
"""Thickness of what stands for a contact [m]."""
FILM = 1.0 / 12.0
"""Of either side of a pad, over its thickness; the legs are between."""
SIGMA = 5.670374419e-8
KELVIN = 273.15
GROWTH = 0.45
"""How much wider elements get, over the way from where they are narrow."""


@dataclass(frozen=True)
class Material:
    """A material: conductivities along the drawing and up, and heat capacity."""

    along: float
    up: float
    heat_capacity: float = 0.0
    shines: float = 0.0
    """Width of a gap whose faces radiate to one another upwards, times their exchange factor [m]."""


@dataclass(frozen=True)
class Body:
    """A body of one temperature, and its surface."""

    capacity: float
    surface: float = 0.0
    coefficient: float = 0.0
    emissivity: float = 0.0


@dataclass(frozen=True)
class Exchange:
    """Heat that leaves over a line, or out of a material's volume, to the air or to a body."""

    where: str
    coefficient: float
    emissivity: float = 0.0
    body: int | None = None
    of_volume: bool = False


@dataclass
class Drawing:
    """The drawing that `fe.py` heats. A line between two materials is `x:left>right` or `y:lower>upper`."""

    x: np.ndarray
    y: np.ndarray
    what: Callable[[float, float], str | None]
    materials: dict[str, Material]
    joule: float
    """Heat of the current for an area of pads [W/m2], evenly in their legs."""
    pumped: float
    """Seebeck coefficient times current for an area of pads [W/m2 K]."""
    film: float
    """Thickness of a pad's side [m]."""
    legs: float
    """Length of its legs [m]."""
    ambient: float
    exchanges: list[Exchange] = field(default_factory=list)
    bodies: list[Body] = field(default_factory=list)


def graded(ends: Sequence[tuple[float, float]], fine: float) -> np.ndarray:
    """Lines of a grid through places, each with the width of the elements beside it; they widen away from it."""
    lines = [np.array([ends[0][0]])]
    for (a, narrow_a), (b, narrow_b) in pairwise(ends):
        at = np.linspace(a, b, 2001)
        width = np.minimum(narrow_a + GROWTH * (at - a), narrow_b + GROWTH * (b - at)) / fine
        count = np.concatenate([[0.0], np.cumsum(0.5 * (1.0 / width[1:] + 1.0 / width[:-1]) * np.diff(at))])
        whole = max(1, int(np.ceil(count[-1])))
        lines.append(np.interp(np.arange(1, whole + 1) * count[-1] / whole, count, at))
        lines[-1][-1] = b
    return np.concatenate(lines)


def strip(c: Mapping[str, float], fine: float) -> Drawing:
    """Draw the shear module from the middle of an arc through its edge; the layer's face at the pads is y = 0."""
    w, top, pad = c["half_width"], c["layer_depth"], c["pad_depth"]
    film, slot, inside = FILM * pad, c["air_conductivity"] / c["pad_edge_contact"], c["window_share"] * w
    spread, tile, tip = c["spreader_depth"], c["tile_share"] * w, top - c["lip_height"]
    hot = -SHEET - (spread + SHEET if spread else 0.0)
    under = hot - pad
    heights = [(under + film, "cold"), (hot - film, "legs"), (hot, "hot"), (top, "layer"), (top + SHEET, "far")]
    heights[3:3] = [(hot + SHEET, "joint"), (-SHEET, "spreader"), (0.0, "near")] if spread else [(0.0, "near")]
    face, lined = top + SHEET, top + SHEET + c["liner_depth"]

    def what(x: float, y: float) -> str | None:
        if y > face:
            return in_recess(x, y) if lined > face and x < w + SHEET and y < lined + SHEET else "plate"
        if x > w and y > 0.0:
            return at_lip(x, y)
        if x > w:
            return in_slot(y) if y > under and x < w + slot else "floor"
        if y < under:
            return "ledge" if x > inside else None
        beside = spread and x > tile and y < hot + SHEET
        return "beside tiles" if beside else next(name for height, name in heights if y < height)

    def in_slot(y: float) -> str:
        return "seat" if spread and y > hot + SHEET else "slot"

    def in_recess(x: float, y: float) -> str:
        if x > w:
            return "bond beside"
        return "bond" if y > lined else "liner"

    def at_lip(x: float, y: float) -> str:
        if x > w + c["lip_width"]:
            return "air"
        if y < tip:
            return "below lip"
        return "side" if x < w + SHEET else "lip"

    rim, wide, thin, deep = 0.2 * slot, 0.12 * w, 0.25 * film, 0.06 * top
    bend = 0.1 * min(w - inside, 5.0 * slot)
    tiled = [(tile, bend)] if spread and inside < tile < w else []
    lip = [(w + c["lip_width"], 0.3 * (top - tip))] if c["lip_height"] else []
    crowded = [(tip, 0.1 * tip)] if lip else [(0.9 * top, deep)]
    wall = [(w + SHEET, rim)] if lip or lined > face else []
    x = graded([(0.0, wide), (inside, bend), *tiled, (w, rim), *wall, (w + slot, rim), *lip,
                (w + c["beside"], 0.15 * c["beside"])], fine)  # fmt: skip
    sheets = [(hot + SHEET, 0.2 * spread), (-SHEET, 0.2 * spread)] if spread else []
    liner = [(lined, 0.1 * (lined - face)), (lined + SHEET, 0.1 * (lined - face))] if lined > face else []
    y = graded([(-c["floor_depth"], 0.2 * (c["floor_depth"] + under)), (under, thin), (under + film, 2.0 * thin),
                (hot - film, thin), (hot, thin), *sheets, (0.0, rim), (min(0.1 * top, 0.5 * tip), deep), *crowded,
                (top, 0.5 * deep), (face, deep), *liner, (face + c["plate_depth"], 0.3 * c["plate_depth"])],
               fine)  # fmt: skip
    return Drawing(x, y, what, _strip_s_materials(c), c["current"] ** 2 * c["resistance"],
                   c["seebeck"] * c["current"], film, pad - 2.0 * film, c["ambient"], _strip_s_exchanges(c, inside),
                   [Body(c["core_capacity"]),
                    Body(c["housing_capacity"], c["housing_surface"], c["floor_coefficient"], c["emissivity"]),
                    Body(c["sink_capacity"], c["sink_surface"], c["sink_coefficient"], c["emissivity"])])  # fmt: skip


def _strip_s_materials(c: Mapping[str, float]) -> dict[str, Material]:
    solid = Material(c["structure_conductivity"], c["structure_conductivity"], c["structure_heat_capacity"])
    heat, legs = c["pad_heat_capacity"] / c["pad_depth"], (1.0 - 2.0 * FILM) * c["pad_depth"]
    side = Material(c["pad_conductivity"], 100.0, heat)
    air, exchange = c["air_conductivity"], c["emissivity"] / (2.0 - c["emissivity"])
    spread = Material(c["spreader_along"], c["spreader_conductivity"], c["spreader_heat_capacity"])
    seat = c["seat_contact"] * air / c["pad_edge_contact"]
    return {
        "plate": solid, "lip": solid, "floor": solid, "ledge": solid, "hot": side, "cold": side,
        "legs": Material(c["pad_conductivity"], c["conductance"] * legs, heat),
        "near": Material(1e-9, c["hot_contact"] * SHEET), "far": Material(1e-9, c["rotor_contact"] * SHEET),
        "side": Material(c["rotor_contact"] * SHEET, 1e-9), "air": Material(air, air, 0.0, c["gap"] * exchange),
        "below lip": Material(air, air, 0.0, (c["gap"] - c["lip_height"]) * exchange),
        "slot": Material(air, air), "seat": Material(seat, seat), "spreader": spread,
        "joint": Material(1e-9, c["spreader_contact"] * SHEET),
        "liner": Material(c["liner_conductivity"], c["liner_conductivity"], c["liner_heat_capacity"]),
        "bond": Material(1e-9, c["liner_bond"] * SHEET), "bond beside": Material(c["liner_bond"] * SHEET, 1e-9),
        "beside tiles": Material(air, air, 0.0, c["pad_depth"] * exchange),
    }  # fmt: skip


def _strip_s_exchanges(c: Mapping[str, float], inside: float) -> list[Exchange]:
    shine = c["emissivity"]
    window = Exchange("y:>cold", c["cold_coefficient"], shine)
    if c["sink_conductance"]:
        window = Exchange("y:>cold", c["sink_conductance"] / inside, 0.0, 2)
    return [
        window, Exchange("y:plate>", c["rotor_coefficient"], shine),
        Exchange("y:>floor", c["floor_coefficient"], shine), Exchange("y:>ledge", c["floor_coefficient"], shine),
        Exchange("x:plate>", c["core_conductance"] / c["plate_depth"], body=0),
        Exchange("x:floor>", c["housing_conductance"] / c["floor_depth"], body=1),
    ]  # fmt: skip


def ring(c: Mapping[str, float], fine: float) -> Drawing:
    """Draw the compression module along its ring, from the middle of a rotor vane to that of a housing vane.

    x = 0 is the middle of the rotor's vane, y = 0 the floor's face.
    """
    gap, height, pad = c["running_clearance"], c["block_height"], c["heater_thickness"]
    film, vane, spread = FILM * pad, 0.5 * c["vane_thickness"], c["spreader_depth"]
    block, more = vane + SHEET + c["block_depth"], spread + SHEET if spread else 0.0
    hot, end = block + SHEET + more, pi * c["pcl_mean_radius"] / c["vane_count"] + 2.0 * SHEET + more - spread
    low, high, plate = gap, gap + height, 2.0 * gap + height
    tile = low + height * c["heated_area"] / c["pcl_area"]
    places = [(vane + SHEET, "far"), (block, "layer"), (block + SHEET, "near"), (hot + film, "hot"),
              (hot + pad - film, "legs"), (hot + pad, "cold")]  # fmt: skip
    places[3:3] = [(hot - SHEET, "spreader"), (hot, "joint")] if spread else []

    def what(x: float, y: float) -> str:
        if y < 0.0 or y > plate:
            return "floor" if y < 0.0 else "plate"
        if x < vane:
            return "vane" if y > low else "air"
        if x > hot + pad:
            return "air" if y > high else "upper wall" if spread and y > tile else "wall"
        if y < low or y > high:
            return "air"
        beside = spread and y > tile and x > hot - SHEET
        return "beside tiles" if beside else next(name for place, name in places if x < place)

    deep, thin, crowd = 0.06 * c["block_depth"], 0.5 * film, 0.25 * gap
    sheets = [(block + SHEET, 0.2 * spread), (hot - SHEET, 0.2 * spread)] if spread else []
    rows = [(0.5 * (low + tile), 0.08 * height), (tile, crowd)] if spread and tile < high else []
    x = graded([(0.0, 0.3 * vane), (vane, 0.5 * deep), (vane + SHEET, 0.5 * deep), (block, 0.3 * deep), *sheets,
                (hot, thin), (hot + film, thin), (hot + pad - film, thin), (hot + pad, thin),
                (end, 0.3 * (end - hot - pad))], fine)  # fmt: skip
    y = graded([(-c["floor_thickness"], 0.3 * c["floor_thickness"]), (0.0, crowd), (low, crowd),
                *(rows or [(0.5 * (low + high), 0.08 * height)]), (high, crowd), (plate, crowd),
                (plate + c["rotor_thickness"], 0.3 * c["rotor_thickness"])], fine)  # fmt: skip
    area = c["heater_area"]
    current = c["current"] / c["heater_strings"]
    return Drawing(x, y, what, _ring_s_materials(c), current**2 * c["heater_resistance"] / area,
                   c["heater_seebeck"] / area * current, film, pad - 2.0 * film, c["ambient"],
                   *_ring_s_exchanges(c))  # fmt: skip


def _ring_s_materials(c: Mapping[str, float]) -> dict[str, Material]:
    k, heat = c["structure_conductivity"], c["structure_density"] * c["structure_specific_heat"]
    whole = 1.0 - c["cold_area"] / c["heated_area"]
    pad = c["heater_mass"] * c["heater_specific_heat"] / (c["heated_area"] * c["heater_thickness"])
    legs = c["heater_conductance"] / c["heater_area"] * (1.0 - 2.0 * FILM) * c["heater_thickness"]
    air, shine = (
        c["air_conductivity"],
        c["running_clearance"] * c["surface_emissivity"] / (2.0 - c["surface_emissivity"]),
    )
    solid, side = Material(k, k, heat), Material(100.0, c["pad_conductivity"], pad)
    warm, cool = c["melting_end"] + KELVIN, c["ambient"] + KELVIN
    # The gap behind a spreader lies along the ring; it radiates there as between the melt and what is cold.
    behind = c["heater_thickness"] * shine / c["running_clearance"] * SIGMA * (warm**2 + cool**2) * (warm + cool)
    metal = c["spreader_conductivity"]
    return {
        "floor": solid, "plate": solid, "vane": solid, "wall": Material(whole * k, whole * k, whole * heat),
        "hot": side, "cold": side, "legs": Material(legs, c["pad_conductivity"], pad),
        "air": Material(air, air, 0.0, shine),
        "near": Material(c["hot_contact"] * SHEET, 1e-9), "far": Material(c["rotor_contact"] * SHEET, 1e-9),
        "upper wall": solid, "beside tiles": Material(air + behind, air),
        "spreader": Material(metal, metal, c["spreader_density"] * c["spreader_specific_heat"]),
        "joint": Material(c["spreader_contact"] * SHEET, 1e-9),
    }  # fmt: skip


def _ring_s_exchanges(c: Mapping[str, float]) -> tuple[list[Exchange], list[Body]]:
    """Return the ring's links to air, core, rim and middle of the plate, housing and sink."""
    wide = 2.0 * c["vane_count"] * c["block_width"]
    length = pi * c["pcl_mean_radius"] / c["vane_count"]
    k, heat = c["structure_conductivity"], c["structure_density"] * c["structure_specific_heat"]
    plate, floor, shine = c["rotor_thickness"], c["floor_thickness"], c["surface_emissivity"]
    inner, outer, rotor, core = c["pcl_inner_radius"], c["pcl_outer_radius"], c["rotor_radius"], c["core_radius"]
    middle = pi * inner**2
    rim = max(pi * rotor**2 - wide * length - middle, 1e-6)
    vane = length - 0.5 * c["vane_thickness"] - c["block_depth"] - c["heater_thickness"]
    vane -= c["spreader_depth"]
    whole = 1.0 - c["cold_area"] / c["heated_area"]
    low, height = c["running_clearance"], c["block_height"]
    tiled = height * (c["heated_area"] / c["pcl_area"] if c["spreader_depth"] else 1.0)
    walls = heat * vane * (whole * (low + tiled) + height - tiled)
    housing = c["housing_mass"] * c["structure_specific_heat"] / wide - length * floor * heat - walls
    air = c["rotor_coefficient"], c["housing_coefficient"]
    bodies = [
        Body(c["core_capacity"] / wide),
        Body(rim * plate * heat / wide, rim / wide, air[0], shine),
        Body(housing, c["housing_surface"] / wide, air[1], shine),
        Body(middle * plate * heat / wide, (middle - pi * core**2) / wide, air[0], shine),
    ]  # fmt: skip
    outwards = 2.0 * pi * k * plate / log(1.0 + max(rotor - outer, 1e-4) / (3.0 * outer))
    inwards = 2.0 * pi * k * plate / log(inner / (inner - (inner - core) / 3.0))
    through = 2.0 * pi * k * floor / log(max(c["housing_inner_radius"], outer + 1e-4) / outer)
    spread = [("plate", c["core_conductance"], 0), ("plate", outwards, 1), ("floor", through, 2), ("plate", inwards, 3)]
    depth = {"plate": plate, "floor": floor}
    sides = 2.0 / c["block_width"] * (air[1] + 4.0 * SIGMA * shine * (c["ambient"] + KELVIN) ** 3)
    shown = c["cold_area"] / c["heated_area"]
    exchanges = [
        Exchange("x:cold>wall", shown * c["cold_coefficient"], shown * shine),
        Exchange("y:plate>", air[0], shine), Exchange("y:>floor", air[1], shine),
        *(Exchange(name, g / (wide * length * depth[name]), 0.0, body, True) for name, g, body in spread),
        *(Exchange(name, sides, 0.0, 2, True) for name in ("layer", "spreader", "hot", "legs", "cold", "vane")),
    ]  # fmt: skip
    if c["sink_contact"]:
        exchanges[0] = Exchange("x:cold>wall", shown * c["sink_contact"], 0.0, 4)
        bodies.append(
            Body(c["sink_capacity"] / wide, c["sink_surface"] / wide, c["sink_coefficient"], c["sink_emissivity"])
        )
    return exchanges, bodies


DRAWINGS = {"strip": strip, "ring": ring}
