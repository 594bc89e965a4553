"""The shear module in the plane: along the stack, and from the middle of an arc through its edge to beside it.

A strip of half the width `half_width` (area of the arcs over the length of their edges) with plate and floor beside it,
as drawn: the pads lie in pockets of the floor, on a ledge around their window; the layer's free side meets the air of
the gap. The contact of the pads' edges and their pockets' walls is a slot of still air as wide as conducts alike;
beside a spreader adhesive fills it. Nothing passes the middle of the arc. Everything for one metre of edge.

Rigid modules cover the middle of the strip, as much of its width as of the arcs' area; a spreader of its whole width
lies on them, and beside them is still air over the floor. So each metre of edge has its share of modules, windows,
ledges and air. Along the strip the spreader conducts as much less as its way there is shorter than that as drawn,
solved in the spreader's own plane (`spreader.py`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import spreader
from plane import PAD_FILM, Array, Body, Border, Material, Plane, Polymer, Pump, drawn, lines

from tvimdesign.device import Table


@dataclass(frozen=True)
class Case:
    """A strip's materials and boundaries; SI and degC."""

    half_width: float
    beside: float
    layer_depth: float
    plate_depth: float
    pad_depth: float
    floor_depth: float
    gap: float
    conductivity_solid: float
    conductivity_melt: float
    density: float
    specific_heat_solid: float
    specific_heat_melt: float
    latent_heat: float
    melting_start: float
    melting_end: float
    structure_conductivity: float
    structure_heat_capacity: float
    """Per volume."""
    pad_conductivity: float
    """In the plane of the pad."""
    pad_heat_capacity: float
    """Per area, both sides together [J/m2 K]."""
    pad_edge_contact: float
    hot_contact: float
    rotor_contact: float
    seebeck: float
    """Of a pad or a module over its area [V/K m2], as are the next two."""
    resistance: float
    conductance: float
    tile_share: float
    """Of the strip's width that pads or modules cover; 1 for pads cut to the arcs."""
    window_share: float
    current: float
    ambient: float
    cold_coefficient: float
    rotor_coefficient: float
    floor_coefficient: float
    emissivity: float
    air_conductivity: float
    ledge: float
    """Width on which the pads lie around their window."""
    core_conductance: float
    """From the end of the plate's strip to core and link [W/m K]."""
    core_capacity: float
    """[J/m K]"""
    housing_conductance: float
    housing_capacity: float
    housing_surface: float
    """Outside of the housing for a metre of strip [m]."""
    spreader_depth: float = 0.0
    spreader_conductivity: float = 0.0
    spreader_along: float = 0.0
    """Its conductivity along the strip."""
    spreader_heat_capacity: float = 0.0
    """Per volume."""
    seat_contact: float = 0.0
    """Of the spreader's edges and the floor, a mean of adhesive along its rims and slots at its ends."""
    spreader_contact: float = 0.0
    """Of modules and spreader; layer and spreader have `hot_contact`."""
    sink_conductance: float = 0.0
    """From the cold side, where that has a sink in place of the air [W/m K]; none where it is zero."""
    sink_capacity: float = 1.0
    sink_surface: float = 0.0
    sink_coefficient: float = 0.0
    lip_height: float = 0.0
    """Of the plate's lip along the layer's edge; none where it is zero."""
    lip_width: float = 0.0
    liner_depth: float = 0.0
    """Of the recess for a liner in the plate above the layer, its film of adhesive in it; none where it is zero."""
    liner_conductivity: float = 0.0
    liner_heat_capacity: float = 0.0
    """Per volume, with that of the film, which counts none."""
    liner_bond: float = 0.0
    """Conductance of the film, which is around the liner too [W/m2 K]."""


def case_of(table: Table, values: Mapping[str, Any]) -> Case:
    """Return the strip of a shear module from its inputs in SI."""
    v = values
    wanted = ("pcl_area", "edge_length", "rotor_radius", "pcl_melting", "cold_area", "core_and_link", "around_pads",
              "housing_ring", "heater_mass", "pcl_depth", "sink", "heated_area", "heater_strings",
              "spreader_depth", "melt_lip_height", "liner_depth")  # fmt: skip
    outputs = table.evaluate(v, wanted)
    area, edge, melting = outputs["pcl_area"], outputs["edge_length"], outputs["pcl_melting"]
    core, housing = outputs["core_and_link"], outputs["around_pads"][-1]
    cooled, spread = {}, {}
    if v["heater_form"] != "flexible":
        spread = {
            "spreader_depth": outputs["spreader_depth"], "spreader_conductivity": v["spreader_conductivity"],
            "spreader_heat_capacity": v["spreader_density"] * v["spreader_specific_heat"],
            "spreader_contact": v["spreader_contact"], "spreader_along": _along_strip(table, v, outputs),
            "seat_contact": _seat_contact(v, outputs["edge_length"]),
        }  # fmt: skip
    lip = {}
    if v["melt_lip"] != "none":
        lip = {"lip_height": outputs["melt_lip_height"], "lip_width": v["rotor_rim"]}
    lined = {}
    if v["liner_material"] != "none":
        deep, film = outputs["liner_depth"], v["liner_film"]
        held = v["liner_density"] * v["liner_specific_heat"] * v["liner_thickness"] / deep
        lined = {
            "liner_depth": deep, "liner_conductivity": v["liner_conductivity"] * deep / v["liner_thickness"],
            "liner_heat_capacity": held, "liner_bond": v["liner_film_conductivity"] / film,
        }  # fmt: skip
    if outputs["sink"] is not None:
        cooled = {
            "sink_conductance": v["sink_contact"] * outputs["cold_area"] / edge,
            "sink_capacity": outputs["sink"].capacity / edge,
            "sink_surface": outputs["sink"].surface.area / edge, "sink_coefficient": v["sink_coefficient"],
        }  # fmt: skip
    return Case(
        half_width=area / edge, beside=(np.pi * outputs["rotor_radius"] ** 2 - area) / edge,
        layer_depth=outputs["pcl_depth"], plate_depth=v["rotor_thickness"], pad_depth=v["heater_thickness"],
        floor_depth=v["floor_thickness"], gap=v["pcl_thickness"], conductivity_solid=v["pcl_conductivity_solid"],
        conductivity_melt=v["pcl_conductivity_melt"], density=v["pcl_density"],
        specific_heat_solid=melting.specific_heat_solid, specific_heat_melt=melting.specific_heat_melt,
        latent_heat=melting.latent_heat, melting_start=melting.start - 273.15, melting_end=melting.end - 273.15,
        structure_conductivity=v["structure_conductivity"],
        structure_heat_capacity=v["structure_density"] * v["structure_specific_heat"],
        pad_conductivity=v["pad_conductivity"], pad_edge_contact=v["pad_edge_contact"],
        pad_heat_capacity=outputs["heater_mass"] * v["heater_specific_heat"] / outputs["heated_area"],
        hot_contact=v["hot_contact"], rotor_contact=v["rotor_contact"],
        seebeck=v["heater_seebeck"] / v["heater_area"],
        resistance=v["heater_resistance"] / v["heater_area"],
        conductance=v["heater_conductance"] / v["heater_area"], tile_share=outputs["heated_area"] / area,
        window_share=outputs["cold_area"] / area, current=v["current"] / outputs["heater_strings"],
        ambient=v["ambient_temperature"] - 273.15, cold_coefficient=v["cold_side_coefficient"],
        rotor_coefficient=v["rotor_coefficient"], floor_coefficient=v["housing_coefficient"],
        emissivity=v["surface_emissivity"], air_conductivity=v["air_conductivity"],
        ledge=v["window_ledge"], core_conductance=core.conductance / edge,
        core_capacity=core.capacity / edge, housing_conductance=outputs["housing_ring"] / edge,
        housing_capacity=housing.capacity / edge, housing_surface=housing.surface.area / edge,
        **spread, **cooled, **lip, **lined,
    )  # fmt: skip


def _along_strip(table: Table, v: Mapping[str, Any], sizes: Mapping[str, Any]) -> float:
    """Return the conductivity with which a strip's spreader rises as much beside its modules as that of the arc."""
    beside = 1.0 - sizes["heated_area"] / sizes["pcl_area"]
    width = beside * sizes["pcl_area"] / sizes["edge_length"]
    rise = spreader.mean_rise(v, **table.evaluate(v, ("tile_pitch", "tile_radius")))
    return float(v["spreader_conductivity"] * beside * width**2 / (3.0 * rise))


def _seat_contact(v: dict[str, Any], edges: float) -> float:
    """Return the mean conductance from a spreader's edges to the floor: adhesive along rims, slots of air at ends."""
    rims = v["arc_count"] * v["arc_span"] * (v["pcl_inner_radius"] + v["pcl_outer_radius"])
    adhesive = v["heater_adhesive_conductivity"] / v["spreader_gap"]
    return float((rims * adhesive + (edges - rims) * v["pad_edge_contact"]) / edges)


def plane(case: Case, fine: float = 1.0) -> Plane:
    """Draw the strip of a case; `fine` divides each cell along either side, twice as often with a liner."""
    c, w, fine = case, case.half_width, fine * (2.0 if case.liner_depth else 1.0)
    film, slot = PAD_FILM * c.pad_depth, c.air_conductivity / c.pad_edge_contact
    x, y = _grid(c, slot, fine)
    inside, tile, top = c.window_share * w, c.tile_share * w, c.layer_depth
    hot, cold = -c.spreader_depth, -c.spreader_depth - c.pad_depth

    def what(a: float, b: float) -> str | None:
        if b > top:
            return "liner" if a < w and b < top + c.liner_depth else "plate"
        if b > 0.0:
            return "layer" if a < w else beside(a, b)
        if a > w:
            within = b > cold and a < w + slot
            return ("seat" if b > hot and c.spreader_depth else "slot") if within else "floor"
        if b < cold:
            return "ledge" if a > inside else None
        return "beside tiles" if a > tile and b < hot else upright(b)

    def beside(a: float, b: float) -> str:
        if a > w + c.lip_width:
            return "air"
        return "lip" if b > top - c.lip_height else "below lip"

    def upright(b: float) -> str:
        heights = ((hot, "spreader"), (hot - film, "hot"), (cold + film, "legs"))
        return next((name for low, name in heights if b > low), "cold")

    contacts = {
        frozenset(("hot", "layer")): c.hot_contact, frozenset(("layer", "plate")): c.rotor_contact,
        frozenset(("layer", "lip")): c.rotor_contact,
    }  # fmt: skip
    if c.liner_depth:
        contacts[frozenset(("layer", "liner"))] = c.rotor_contact
        contacts[frozenset(("liner", "plate"))] = c.liner_bond
    if c.spreader_depth:
        contacts[frozenset(("spreader", "layer"))] = c.hot_contact
        contacts[frozenset(("spreader", "hot"))] = c.spreader_contact
    drawing = Plane(
        x, y, drawn(x, y, what), _materials(c),
        Polymer(c.density, c.conductivity_solid, c.conductivity_melt, c.specific_heat_solid, c.specific_heat_melt,
                c.latent_heat, c.melting_start, c.melting_end),
        Pump(c.seebeck, c.resistance, c.conductance, c.current), True, contacts, c.ambient,
        [Body(c.core_capacity), Body(c.housing_capacity, c.housing_surface, c.floor_coefficient, c.emissivity),
         Body(c.sink_capacity, c.sink_surface, c.sink_coefficient, c.emissivity)],
    )  # fmt: skip
    _borders(drawing, case)
    return drawing


def _grid(c: Case, slot: float, fine: float) -> tuple[Array, Array]:
    """Ends of the cells: narrow towards the edges of pad, layer and ledge and the corner of the floor, where heat
    crowds."""
    w, inside, tile = c.half_width, c.window_share * c.half_width, c.tile_share * c.half_width
    end = w + c.beside
    beside = tile if tile < w else inside
    rim = beside + 0.3 * (w - beside)
    ledge = [(inside, tile, 8, 1.0)] if tile < w else []
    onward = [(w + slot, end, 22, 1.3)]
    if c.lip_height:
        onward = [(w + slot, w + c.lip_width, 8, 1.2), (w + c.lip_width, end, 18, 1.3)]
    x = lines((0.0, inside, 6, 0.6), *ledge, (beside, rim, 6, 1.6), (rim, w, 10, 0.62), (w, w + 0.5 * slot, 5, 1.5),
              (w + 0.5 * slot, w + slot, 5, 1.0 / 1.5), *onward, fine=fine)  # fmt: skip
    top, low, film, hot = c.layer_depth, 0.125 * c.layer_depth, PAD_FILM * c.pad_depth, -c.spreader_depth
    layer, tip = [(low, top, 24, 1.0)], top - c.lip_height
    if c.lip_height:
        low = min(low, 0.5 * tip)
        layer = [(low, tip, 8, 0.75), (tip, 0.5 * (tip + top), 12, 1.3), (0.5 * (tip + top), top, 8, 1.0)]
    cold, spreader = hot - c.pad_depth, [(hot, 0.0, 5, 1.0)] if c.spreader_depth else []
    liner = [(top, top + c.liner_depth, 12, 1.0)] if c.liner_depth else []
    y = lines((-c.floor_depth, cold, 9, 0.75), (cold, cold + film, 2, 1.5), (cold + film, hot - film, 6, 1.0),
              (hot - film, hot, 4, 0.6), *spreader, (0.0, low, 8, 1.5), *layer, *liner,
              (top + c.liner_depth, top + c.plate_depth, 8, 1.15), fine=fine)  # fmt: skip
    return x, y


def _materials(c: Case) -> dict[str, Material]:
    """Return the materials of the strip's parts."""
    solid = Material(c.structure_conductivity, c.structure_conductivity, c.structure_heat_capacity)
    pad = Material(c.pad_conductivity, 100.0, c.pad_heat_capacity / c.pad_depth)
    through = c.conductance * (1.0 - 2.0 * PAD_FILM) * c.pad_depth
    shine = c.emissivity / (2.0 - c.emissivity)
    materials = {"plate": solid, "lip": solid, "floor": solid, "ledge": solid, "hot": pad, "cold": pad,
             "legs": Material(c.pad_conductivity, through, pad.heat_capacity),
             "air": Material(c.air_conductivity, c.air_conductivity, 0.0, c.gap * shine),
             "below lip": Material(c.air_conductivity, c.air_conductivity, 0.0, (c.gap - c.lip_height) * shine),
             "slot": Material(c.air_conductivity, c.air_conductivity, 0.0)}  # fmt: skip
    if c.liner_depth:
        materials["liner"] = Material(c.liner_conductivity, c.liner_conductivity, c.liner_heat_capacity)
    if c.spreader_depth:
        sheet = Material(c.spreader_along, c.spreader_conductivity, c.spreader_heat_capacity)
        still = Material(c.air_conductivity, c.air_conductivity, 0.0, c.pad_depth * shine)
        seat = c.seat_contact * c.air_conductivity / c.pad_edge_contact
        materials |= {"spreader": sheet, "beside tiles": still, "seat": Material(seat, seat, 0.0)}
    return materials


def _borders(drawing: Plane, c: Case) -> None:
    """Faces to the air, to core, housing and sink."""
    cold, below = drawing.facing("cold", "below")
    share = c.window_share * c.half_width / np.sum(below)
    if c.sink_conductance:
        drawing.borders.append(Border(cold, below, c.sink_conductance / np.sum(below), body=2))
    else:
        drawing.borders.append(Border(cold, share * below, c.cold_coefficient, c.emissivity))
    for name, side, coefficient in (("plate", "above", c.rotor_coefficient), ("floor", "below", c.floor_coefficient),
                                    ("ledge", "below", c.floor_coefficient)):  # fmt: skip
        drawing.meets(name, side, coefficient, c.emissivity)
    ends = (("plate", c.core_conductance / c.plate_depth, 0), ("floor", c.housing_conductance / c.floor_depth, 1))
    for name, coefficient, body in ends:
        drawing.meets(name, "right", coefficient, body=body)


def columns(drawing: Plane, name: str, low: float = -np.inf, high: float = np.inf) -> tuple[Array, Array]:
    """Cells of a material between two places by column, from below, and the columns' shares of their width.

    A plate's columns above the layer are shorter where a liner lies in it.
    """
    own = drawing.cells(name)
    own = own[(drawing.middle[0][own] > low) & (drawing.middle[0][own] < high)]
    places, first = np.unique(drawing.i[own], return_index=True)
    widths = drawing.dx[own][first]
    return np.array([own[drawing.i[own] == i] for i in places]), widths / np.sum(widths)
