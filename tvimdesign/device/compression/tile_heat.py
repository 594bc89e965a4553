"""What rigid Peltier modules and their spreaders pass to the blocks and lose beside them; how all modules are wired."""

from __future__ import annotations

from tvimdesign.device.core.heat.heater_form import CUT, WITH_TILES
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, spreader
from tvimdesign.physics.heat_flow.lumps import Link

quantities = QuantityGroup(shared.group)


@quantities.output("1")
def heater_strings(heater_wiring: str, vane_count: Scalar, heater_count: Scalar) -> Scalar:
    """Strings of Peltier modules in parallel, which share the current."""
    return {"series": 1.0, "vanes_parallel": vane_count, "all_parallel": heater_count}[heater_wiring]


@quantities.helper()
def cold_to_sink() -> Scalar:
    """Resistance along the cold sides to a sink [K/W]: not counted, as the slots leave most of them open."""
    return 0.0


@quantities.helper()
def cold_area(
    heater_form: str,
    vane_count: Scalar,
    slot_width: Scalar,
    slot_height: Scalar,
    heater_count: Scalar,
    tile_window: Scalar,
) -> Scalar:
    """Open area of the modules' cold sides [m^2]: what of them the slots show, rounds of their corners not counted."""
    if heater_form == CUT:
        return 2.0 * vane_count * slot_width * slot_height
    return heater_count * tile_window * slot_height


@quantities.output("K*mm^2/W", requires=WITH_TILES)
def spreader_resistance(
    block_width: Scalar,
    block_height: Scalar,
    tiles_per_block: Scalar,
    peltier_length: Scalar,
    peltier_width: Scalar,
    spreader_conductivity: Scalar,
    spreader_thickness: Scalar,
) -> Scalar:
    """Resistance of the way along the spreader to what its modules do not cover, times the layer's area.

    First upwards from the tiles' upper edges, as they stand at the spreader's lower one; then along the radius, from
    both sides of each tile. A thin plate solved in two dimensions resists 5 to 18 % less: heat takes both ways at once.
    """
    k, t, row = spreader_conductivity, spreader_thickness, tiles_per_block * peltier_length
    upright, covered = row * block_height, row * peltier_width
    upwards = spreader.spreading_resistance(upright, covered, row, k, t)
    edges = 2.0 * tiles_per_block * block_height
    sideways = spreader.spreading_resistance(block_width * block_height, upright, edges, k, t)
    return upwards * block_width / row + sideways


@quantities.helper(requires=WITH_TILES, default=())
def spreader_links(
    ring_width: Scalar,
    spreader_depth: Scalar,
    open_sides: Scalar,
    pcl_area: Scalar,
    heated_area: Scalar,
    peltier_thickness: Scalar,
    running_clearance: Scalar,
    air_conductivity: Scalar,
    surface_emissivity: Scalar,
    ring_places: tuple[lumps.Place, lumps.Place, lumps.Place, lumps.Place],
) -> tuple[Link, ...]:
    """From the spreaders' edges to floor, rotor plate and housing; from what tiles leave free of them into the vanes.

    The spreaders have the temperature of the modules' hot side. Beside the tiles their backs face the vane through the
    tiles' thickness of still air.
    """
    hot, (floor, above, walls, housing) = ("hot", 0), ring_places
    edges = [
        lumps.air_gap(ring_width * spreader_depth, running_clearance, air_conductivity, surface_emissivity, hot, face)
        for face in (floor, above)
    ]
    backs = lumps.air_gap(pcl_area - heated_area, peltier_thickness, air_conductivity, surface_emissivity, hot, walls)
    return (*edges, backs, Link(hot, housing, open_sides * spreader_depth))
