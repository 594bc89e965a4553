"""Air beside rigid modules, below their spreader: a room that tiles, ledge and the pocket's wall close."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.shear.floor_heat import CORNER, LEDGES, LEGS, SPREADER, UPPER
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, shape_factors
from tvimdesign.physics.heat_flow.lumps import Link
from tvimdesign.physics.heat_flow.still_air import room
from tvimdesign.physics.polymers import polymer

quantities = QuantityGroup(shared.group)

BELOW = ("around", LEDGES)
WALL = (("around", CORNER), ("around", UPPER[0]))


@quantities.helper()
def tile_links(
    heater_form: str,
    pcl_area: Scalar,
    heated_area: Scalar,
    edge_length: Scalar,
    peltier_thickness: Scalar,
    pad_edge_contact: Scalar,
    air_conductivity: Scalar,
    surface_emissivity: Scalar,
    structure_conductivity: Scalar,
    ambient_temperature: Scalar,
    pcl_melting: polymer.Melting,
) -> tuple[Link, ...]:
    """From the spreader's back and the tiles' sides through that room; none where pads are cut to the arcs.

    As wide as what the tiles leave of the strip, and as the slot beside the spreader. It conducts better up than along,
    as in `layer_end.air_beside`. The tiles' sides have the mean temperature of their legs.
    """
    if heater_form == CUT:
        return ()
    down = lumps.air_gap(
        pcl_area - heated_area, peltier_thickness, air_conductivity, surface_emissivity, SPREADER, BELOW
    )
    across = lumps.air_gap(1.0, peltier_thickness, air_conductivity, surface_emissivity, SPREADER, BELOW)
    up = peltier_thickness * lumps.link_conductance(across, pcl_melting.end, ambient_temperature)
    evenly, slot = np.sqrt(air_conductivity * up), air_conductivity / pad_edge_contact
    width = ((pcl_area - heated_area) / edge_length + slot) / peltier_thickness * up / evenly
    found = room(width, evenly / (pad_edge_contact * peltier_thickness))
    through = evenly * edge_length
    corner = structure_conductivity * edge_length * shape_factors.corner_shape(found.ceiling)
    to_wall = lumps.in_series((found.ceiling + found.floor) * through, corner)
    sides = [Link(LEGS, place, found.tile * through) for place in WALL]
    return (
        down._replace(conductance=down.conductance - found.floor * through),
        Link(SPREADER, WALL[0], to_wall),
        *sides,
    )
