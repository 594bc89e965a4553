"""The compression module in the plane around its axis: from the middle of a rotor vane to that of a housing vane.

Along the ring at its mean radius half a rotor vane, a block, its pad and half a housing vane; upwards the floor, a
running clearance, these, a clearance and the rotor plate. Blocks and pads stand in still air below and above and face
the chamber within and without. Plate and floor go on beyond the ring as bodies. Everything for one metre of width.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from plane import PAD_FILM, STEFAN_BOLTZMANN, Body, Border, Material, Plane, Polymer, Pump, drawn, lines

from tvimdesign.device import Table

WANTED = ("pcl_area", "block_width", "pcl_mean_radius", "pcl_melting", "cold_area", "core_and_link", "around_pads",
          "heater_mass", "rotor_radius", "housing_inner_radius", "housing_mass", "slot_width", "slot_height",
          "sink", "spreader_depth", "heated_area", "heater_strings")  # fmt: skip

PAD_CONDUCTIVITY = 6.0
"""Of the pads in their plane [W/m K], the default in shear; the compression module's table does not have it."""


def plane(table: Table, values: Mapping[str, Any], fine: float = 1.0) -> Plane:
    """Draw the ring of a module from its inputs in SI; `fine` divides each cell along either side."""
    v = {**values, **table.evaluate(values, WANTED)}
    gap, height, pad = v["running_clearance"], v["block_height"], v["heater_thickness"]
    vane, block = 0.5 * v["vane_thickness"], 0.5 * v["vane_thickness"] + v["block_depth"]
    hot, tile = block + v["spreader_depth"], gap + height * (v["heated_area"] / v["pcl_area"])
    film, end = PAD_FILM * pad, np.pi * v["pcl_mean_radius"] / v["vane_count"]
    low, high, plate = gap, gap + height, 2.0 * gap + height
    spreader = [(block, hot, 5, 1.0)] if v["spreader_depth"] else []
    inside = _heights(low, high, tile)

    x = lines((0.0, vane, 6, 0.85), (vane, block, 24, 1.0), *spreader, (hot, hot + film, 2, 1.0),
              (hot + film, hot + pad - film, 5, 1.0), (hot + pad - film, hot + pad, 2, 1.0),
              (hot + pad, end, 6, 1.3), fine=fine)  # fmt: skip
    y = lines((-v["floor_thickness"], 0.0, 7, 0.75), (0.0, low, 5, 1.0), *inside, (high, plate, 5, 1.0),
              (plate, plate + v["rotor_thickness"], 7, 1.3), fine=fine)  # fmt: skip

    heated = ((block, "layer"), (hot, "spreader"), (hot + film, "hot"), (hot + pad - film, "legs"), (hot + pad, "cold"))
    bare = ((block, "layer"), (hot, "spreader"), (hot + pad, "beside tiles"))

    def what(a: float, b: float) -> str:
        if b < 0.0 or b > plate:
            return "floor" if b < 0.0 else "plate"
        if a < vane:
            return "vane" if b > low else "air"
        if a > hot + pad:
            return "air" if b > high else "wall" if b < tile else "upper wall"
        if b < low or b > high:
            return "air"
        return next(name for right, name in (bare if b > tile else heated) if a < right)

    contacts = {("hot", "layer"): "hot_contact", ("spreader", "layer"): "hot_contact",
                ("spreader", "hot"): "spreader_contact", ("layer", "vane"): "rotor_contact"}  # fmt: skip
    return _with_borders(Plane(
        x, y, drawn(x, y, what), _materials(v), _polymer(v), _pump(v), False,
        {frozenset(pair): v[name] for pair, name in contacts.items() if "spreader" not in pair or spreader},
        v["ambient_temperature"] - 273.15,
    ), v)  # fmt: skip


def _heights(low: float, high: float, tile: float) -> list[tuple[float, float, int, float]]:
    """Rows of cells of what stands in the ring, narrow at its faces and at the tiles' upper edge."""
    if tile >= high:
        middle = 0.5 * (low + high)
        return [(low, middle, 9, 1.3), (middle, high, 9, 1.0 / 1.3)]
    middle, above = 0.5 * (low + tile), 0.5 * (tile + high)
    return [(low, middle, 9, 1.3), (middle, tile, 9, 1.0 / 1.3), (tile, above, 5, 1.3), (above, high, 5, 1.0 / 1.3)]


def _materials(v: Mapping[str, Any]) -> dict[str, Material]:
    capacity = v["structure_density"] * v["structure_specific_heat"]
    solid = Material(v["structure_conductivity"], v["structure_conductivity"], capacity)
    whole = 1.0 - v["cold_area"] / v["heated_area"]
    wall = Material(whole * solid.along, whole * solid.up, whole * capacity)
    pad_heat = v["heater_mass"] * v["heater_specific_heat"] / (v["heated_area"] * v["heater_thickness"])
    pad = Material(100.0, PAD_CONDUCTIVITY, pad_heat)
    through = v["heater_conductance"] / v["heater_area"] * (1.0 - 2.0 * PAD_FILM) * v["heater_thickness"]
    legs = Material(through, PAD_CONDUCTIVITY, pad_heat)
    exchange = v["surface_emissivity"] / (2.0 - v["surface_emissivity"])
    air = Material(v["air_conductivity"], v["air_conductivity"], 0.0, v["running_clearance"] * exchange)
    materials = {"floor": solid, "plate": solid, "vane": solid, "wall": wall, "hot": pad, "legs": legs, "cold": pad,
             "air": air}  # fmt: skip
    if v["spreader_depth"]:
        sheet = v["spreader_conductivity"]
        materials["spreader"] = Material(sheet, sheet, v["spreader_density"] * v["spreader_specific_heat"])
        materials["upper wall"] = solid
        # The gap behind a spreader lies along the ring; it radiates there as between the melt and what is cold.
        warm, cool = v["pcl_melting"].end, v["ambient_temperature"]
        shine = v["heater_thickness"] * exchange * STEFAN_BOLTZMANN * (warm**2 + cool**2) * (warm + cool)
        materials["beside tiles"] = Material(air.along + shine, air.up, 0.0)
    return materials


def _polymer(v: Mapping[str, Any]) -> Polymer:
    melting = v["pcl_melting"]
    return Polymer(
        v["pcl_density"], v["pcl_conductivity_solid"], v["pcl_conductivity_melt"], melting.specific_heat_solid,
        melting.specific_heat_melt, melting.latent_heat, melting.start - 273.15, melting.end - 273.15,
    )  # fmt: skip


def _pump(v: Mapping[str, Any]) -> Pump:
    whole = v["heater_area"]
    return Pump(v["heater_seebeck"] / whole, v["heater_resistance"] / whole, v["heater_conductance"] / whole,
                v["current"] / v["heater_strings"])  # fmt: skip


def _with_borders(drawing: Plane, v: Mapping[str, Any]) -> Plane:
    """Add the bodies plate and floor go on in, and the faces towards the air."""
    wide = 2.0 * v["vane_count"] * v["block_width"]
    ring = wide * drawing.x[-1]
    _bodies(drawing, v, wide, ring)
    cold = drawing.cells("cold")
    last = cold[drawing.i[cold] == np.max(drawing.i[cold])]
    shown = drawing.dy[last] * v["cold_area"] / v["heated_area"]
    if v["sink"] is None:
        drawing.borders.append(Border(last, shown, v["cold_side_coefficient"], v["surface_emissivity"]))
    else:
        drawing.borders.append(Border(last, shown, v["sink_contact"], body=4))
    drawing.meets("plate", "above", v["rotor_coefficient"], v["surface_emissivity"])
    drawing.meets("floor", "below", v["housing_coefficient"], v["surface_emissivity"])
    # Inner and outer sides of what stands in the chamber, which give their heat to the housing around it.
    sides = v["housing_coefficient"] + 4.0 * STEFAN_BOLTZMANN * v["surface_emissivity"] * v["ambient_temperature"] ** 3
    for name in ("layer", "spreader", "hot", "legs", "cold", "vane"):
        own = drawing.cells(name)
        drawing.borders.append(Border(own, 2.0 * drawing.volume[own] / v["block_width"], sides, body=2))
    return drawing


def _heat(drawing: Plane, name: str) -> float:
    """Heat capacity of what is drawn of a material [J/K]."""
    return float(drawing.materials[name].heat_capacity * np.sum(drawing.volume[drawing.cells(name)]))


def _bodies(drawing: Plane, v: Mapping[str, Any], wide: float, ring: float) -> None:
    """Core, rim of the plate, housing, sink; plate and floor conduct to them around the axis."""
    k, capacity = v["structure_conductivity"], v["structure_density"] * v["structure_specific_heat"]
    height, depth = v["rotor_thickness"], v["floor_thickness"]
    inner, outer, rotor = v["pcl_inner_radius"], v["pcl_outer_radius"], v["rotor_radius"]
    middle, core, around = np.pi * inner**2, v["core_and_link"], v["around_pads"][-1]
    rim = max(np.pi * rotor**2 - ring - middle, 1e-6)
    walls = sum(_heat(drawing, name) for name in ("wall", "upper wall") if name in drawing.materials)
    drawing.bodies.extend([
        Body(core.capacity / wide),
        Body(rim * height * capacity / wide, rim / wide, v["rotor_coefficient"], v["surface_emissivity"]),
        # The housing's vanes are in the drawing.
        Body((v["housing_mass"] * v["structure_specific_heat"] - ring * depth * capacity) / wide - walls,
             around.surface.area / wide, v["housing_coefficient"], v["surface_emissivity"]),
        Body(middle * height * capacity / wide, (middle - np.pi * v["core_radius"] ** 2) / wide,
             v["rotor_coefficient"], v["surface_emissivity"]),
    ])  # fmt: skip
    if v["sink"] is not None:
        surface = v["sink"].surface
        drawing.bodies.append(
            Body(v["sink"].capacity / wide, surface.area / wide, surface.coefficient, surface.emissivity)
        )
    drawing.size = drawing.count + len(drawing.bodies)
    # The mean temperature of a fin that heats evenly is a third of its width away.
    outwards = 2.0 * np.pi * k * height / np.log((outer + max(rotor - outer, 1e-4) / 3.0) / outer)
    inwards = 2.0 * np.pi * k * height / np.log(inner / (inner - (inner - v["core_radius"]) / 3.0))
    floor = 2.0 * np.pi * k * depth / np.log(max(v["housing_inner_radius"], outer + 1e-4) / outer)
    for name, conductance, body in (("plate", core.conductance, 0), ("plate", outwards, 1), ("floor", floor, 2),
                                    ("plate", inwards, 3)):  # fmt: skip
        own = drawing.cells(name)
        drawing.borders.append(
            Border(own, drawing.volume[own] / np.sum(drawing.volume[own]), conductance / wide, body=body)
        )


def rows(drawing: Plane, name: str) -> tuple[Any, Any]:
    """Cells of a material by row, along the ring, and the rows' shares of its height."""
    own = drawing.cells(name)
    places, first = np.unique(drawing.j[own], return_index=True)
    heights = drawing.dy[own][first]
    return np.array([own[drawing.j[own] == j] for j in places]), heights / np.sum(heights)
