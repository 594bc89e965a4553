"""Peltier modules and a spreader on them in shear: strings, spreading resistance, compliance, air and cold sides.

Beside rigid modules, below their spreader, is a room of air that tiles, ledge and the pocket's wall close. Ledges touch
a share of the pads' cold sides, a sink the rest. The legs conduct k_x along and k_y up: a slab of the mean k = (k_x
k_y)^(1/2), its depth stretched by (k_x/k_y)^(1/2). The side itself is a sheet on it. Half of a pad's width is the
slab's height (`constriction`). Air in the open windows takes too little heat to count."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT, WITH_TILES
from tvimdesign.device.shear.floor_heat import CORNER, LEDGES, LEGS, SPREADER, UPPER
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, peltier, shape_factors
from tvimdesign.physics.heat_flow.layer_end import room
from tvimdesign.physics.heat_flow.lumps import Link
from tvimdesign.physics.heat_flow.peltier import SIDE_SHARE
from tvimdesign.physics.solids import structure

quantities = QuantityGroup("Switch")

INCOMPRESSIBLE = 3.0
"""Young's modulus of a pad over its shear modulus: pellets in a soft sheet, or ceramic taken alike."""


@quantities.output("1")
def heater_strings(m: Module) -> Scalar:
    """Strings of Peltier modules in parallel, which share the current."""
    return {"series": 1.0, "arcs_parallel": m.arc_count, "all_parallel": m.heater_count}[m.heater_wiring]


@quantities.output("K*mm^2/W", requires=WITH_TILES)
def spreader_resistance(m: Module) -> Scalar:
    """Resistance of the way along the spreader to what its modules do not cover, times the layer's area."""
    outlines = 2.0 * m.heater_count * (m.peltier_length + m.peltier_width)
    return peltier.spreading_resistance(
        m.pcl_area, m.heated_area, outlines, m.spreader_conductivity, m.spreader_thickness
    )


@quantities.helper()
def pad_compliance(m: Module) -> Scalar:
    """Compliance of the pads in shear about the axis [rad/(N*m)]: modules, and the spreader on them."""
    if m.heater_form == CUT:
        return m.peltier_thickness / (m.peltier_shear_modulus * m.held_pads)
    tiles = m.peltier_thickness / (m.peltier_shear_modulus * m.tile_section.polar)
    return tiles + m.spreader_depth / (m.spreader_shear_modulus * m.held_pads)


@quantities.helper()
def pad_foundation(m: Module) -> Scalar:
    """Tension on the layer over how far pads and spreader stretch under it [Pa/m]; a pad has E = 3 G."""
    pad = INCOMPRESSIBLE * m.peltier_shear_modulus / m.peltier_thickness
    if m.heater_form == CUT:
        return pad
    return structure.series(m.heater_coverage * pad, m.spreader_youngs_modulus / m.spreader_thickness)


BELOW = ("around", LEDGES)
WALL = (("around", CORNER), ("around", UPPER[0]))


@quantities.helper()
def tile_links(m: Module) -> tuple[Link, ...]:
    """Links from the spreader's back and the tiles' sides through that room; none where pads are cut to the arcs.

    As wide as what the tiles leave of the strip, and as the slot beside the spreader. It conducts better up than along,
    as in `layer_end.air_beside`. The tiles' sides have the mean temperature of their legs.
    """
    if m.heater_form == CUT:
        return ()
    down = lumps.air_gap(
        m.pcl_area - m.heated_area, m.peltier_thickness, m.air_conductivity, m.surface_emissivity, SPREADER, BELOW
    )
    across = lumps.air_gap(1.0, m.peltier_thickness, m.air_conductivity, m.surface_emissivity, SPREADER, BELOW)
    up = m.peltier_thickness * lumps.link_conductance(across, m.pcl_melting.end, m.ambient_temperature)
    evenly, slot = np.sqrt(m.air_conductivity * up), m.air_conductivity / m.pad_edge_contact
    width = ((m.pcl_area - m.heated_area) / m.edge_length + slot) / m.peltier_thickness * up / evenly
    beside = room(width, evenly / (m.pad_edge_contact * m.peltier_thickness))
    through = evenly * m.edge_length
    corner = m.structure_conductivity * m.edge_length * shape_factors.corner_shape(beside.ceiling)
    to_wall = lumps.in_series((beside.ceiling + beside.floor) * through, corner)
    sides = [Link(LEGS, place, beside.tile * through) for place in WALL]
    return (
        down._replace(conductance=down.conductance - beside.floor * through),
        Link(SPREADER, WALL[0], to_wall),
        *sides,
    )


class ColdSide(NamedTuple):
    """Legs and cold side of the pads as a slab with a sheet on its face."""

    conductance: Scalar
    """Mean conductivity of the legs times the length of the pads' edges [W/K]."""
    sheet: Scalar
    """Of the side, over that conductivity and half of a pad's width [1]."""
    depth: Scalar
    """Of the legs, over half of a pad's width [1]."""


@quantities.helper()
def cold_side_slab(m: Module) -> ColdSide:
    """Legs and cold side, by the pads' conductance up and their conductivity along."""
    width = m.heated_area / m.edge_length
    up = m.pads.conductance / m.heated_area * m.peltier_thickness
    mean = np.sqrt(m.pad_conductivity * up)
    sheet = SIDE_SHARE * m.peltier_thickness * m.pad_conductivity / (mean * width)
    depth = (1.0 - 2.0 * SIDE_SHARE) * m.peltier_thickness * np.sqrt(m.pad_conductivity / up) / width
    return ColdSide(mean * m.edge_length, sheet, depth)


@quantities.helper()
def cold_to_ledges(m: Module) -> Scalar:
    """Resistance from where the cold sides have their mean temperature to the ledges they lie on [K/W]."""
    share = (m.heated_area - m.cold_area) / m.heated_area
    return (
        shape_factors.constriction(share, m.cold_side_slab.sheet, m.cold_side_slab.depth) / m.cold_side_slab.conductance
    )


@quantities.helper()
def cold_to_sink(m: Module) -> Scalar:
    """Resistance from where the cold sides have their mean temperature to a sink in the windows [K/W]."""
    share = m.cold_area / m.heated_area
    return (
        shape_factors.constriction(share, m.cold_side_slab.sheet, m.cold_side_slab.depth) / m.cold_side_slab.conductance
    )
