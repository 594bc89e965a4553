"""What rigid Peltier modules and their spreaders pass to the blocks and lose beside them; how all modules are wired."""

from __future__ import annotations

from tvimdesign.device.core.heat.heater_form import CUT, WITH_TILES
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, peltier
from tvimdesign.physics.heat_flow.lumps import Link

quantities = QuantityGroup(shared.group)


@quantities.output("1")
def heater_strings(m: Module) -> Scalar:
    """Strings of Peltier modules in parallel, which share the current."""
    return {"series": 1.0, "vanes_parallel": m.vane_count, "all_parallel": m.heater_count}[m.heater_wiring]


@quantities.helper()
def cold_to_sink(_: Module) -> Scalar:
    """Resistance along the cold sides to a sink [K/W]: not counted, as the slots leave most of them open."""
    return 0.0


@quantities.helper()
def cold_area(m: Module) -> Scalar:
    """Open area of the modules' cold sides [m^2]: what of them the slots show, rounds of their corners not counted."""
    if m.heater_form == CUT:
        return 2.0 * m.vane_count * m.slot_width * m.slot_height
    return m.heater_count * m.tile_window * m.slot_height


@quantities.output("K*mm^2/W", requires=WITH_TILES)
def spreader_resistance(m: Module) -> Scalar:
    """Resistance of the way along the spreader to what its modules do not cover, times the layer's area.

    First upwards from the tiles' upper edges, as they stand at the spreader's lower one; then along the radius, from
    both sides of each tile. A thin plate solved in two dimensions resists 5 to 18 % less: heat takes both ways at once.
    """
    k, t, row = m.spreader_conductivity, m.spreader_thickness, m.tiles_per_block * m.peltier_length
    upright, covered = row * m.block_height, row * m.peltier_width
    upwards = peltier.spreading_resistance(upright, covered, row, k, t)
    edges = 2.0 * m.tiles_per_block * m.block_height
    sideways = peltier.spreading_resistance(m.block_width * m.block_height, upright, edges, k, t)
    return upwards * m.block_width / row + sideways


@quantities.helper(requires=WITH_TILES, default=())
def spreader_links(m: Module) -> tuple[Link, ...]:
    """From the spreaders' edges to floor, rotor plate and housing; from what tiles leave free of them into the vanes.

    The spreaders have the temperature of the modules' hot side. Beside the tiles their backs face the vane through the
    tiles' thickness of still air.
    """
    hot, (floor, above, walls, housing) = ("hot", 0), m.ring_places
    edges = [
        lumps.air_gap(
            m.ring_width * m.spreader_depth, m.running_clearance, m.air_conductivity, m.surface_emissivity, hot, face
        )
        for face in (floor, above)
    ]
    backs = lumps.air_gap(
        m.pcl_area - m.heated_area, m.peltier_thickness, m.air_conductivity, m.surface_emissivity, hot, walls
    )
    return (*edges, backs, Link(hot, housing, m.open_sides * m.spreader_depth))
