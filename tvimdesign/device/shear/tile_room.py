"""Air beside rigid modules, below their spreader: a room that tiles, ledge and the pocket's wall close."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.shear.floor_heat import CORNER, LEDGES, LEGS, SPREADER, UPPER
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, shape_factors
from tvimdesign.physics.heat_flow.lumps import Link
from tvimdesign.physics.heat_flow.still_air import room

quantities = QuantityGroup(shared.group)

BELOW = ("around", LEDGES)
WALL = (("around", CORNER), ("around", UPPER[0]))


@quantities.helper()
def tile_links(m: Module) -> tuple[Link, ...]:
    """From the spreader's back and the tiles' sides through that room; none where pads are cut to the arcs.

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
    found = room(width, evenly / (m.pad_edge_contact * m.peltier_thickness))
    through = evenly * m.edge_length
    corner = m.structure_conductivity * m.edge_length * shape_factors.corner_shape(found.ceiling)
    to_wall = lumps.in_series((found.ceiling + found.floor) * through, corner)
    sides = [Link(LEGS, place, found.tile * through) for place in WALL]
    return (
        down._replace(conductance=down.conductance - found.floor * through),
        Link(SPREADER, WALL[0], to_wall),
        *sides,
    )
