"""What the vanes of rotor and housing pass to floor and rotor plate: through their roots, and through the clearance at
their other end.

A vane meets them in a strip, from which heat turns to the side as it comes in, as in a ledge (`ledge_ways`).
"""

from __future__ import annotations

from tvimdesign.device.compression.ring_heat import ABOVE_VANES, ABOVE_WALLS, BELOW_VANES, BELOW_WALLS, WALLS
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, shape_factors
from tvimdesign.physics.heat_flow.lumps import STRIP, Link

quantities = QuantityGroup(shared.group)


@quantities.helper()
def through_clearance(m: Module) -> Scalar:
    """What passes a running clearance [W/m^2 K]; a tenth is radiation, taken as where the PCL is molten."""
    gap = lumps.air_gap(1.0, m.running_clearance, m.air_conductivity, m.surface_emissivity, ("plate", 0), ("plate", 0))
    return lumps.link_conductance(gap, m.pcl_melting.end, m.ambient_temperature)


@quantities.helper()
def vane_ways(m: Module) -> tuple[Scalar, Scalar, Scalar]:
    """Conductances [W/K] from the rotor's vanes to the plate above, to the floor below, and from one to the other."""
    k, area = m.structure_conductivity, m.ring_width * m.plate_depth
    above, below = (_into(k * m.ring_width, m.plate_depth, depth) for depth in (m.rotor_thickness, m.floor_thickness))
    below = lumps.in_series(below, m.through_clearance * area)
    # The vane stands beside the clearance before it meets the plate.
    above = lumps.in_series(above, k * m.rotor_vanes.area / m.running_clearance)
    return lumps.heated_between(k * m.rotor_vanes.area / m.block_height, above, below)


@quantities.helper()
def vane_links(m: Module) -> tuple[Link, ...]:
    """From the rotor's vanes to the floor, from the housing's to floor and rotor plate, but for the rotor's roots."""
    floor, plate = ("around", BELOW_VANES), ("beside", ABOVE_VANES)
    found = [Link(("plate", 0), floor, m.vane_ways[1]), Link(plate, floor, m.vane_ways[2])]
    k, area = m.structure_conductivity, m.ring_width * m.wall_depth
    whole = (m.pcl_area - m.cold_area) / m.pcl_area
    below = whole * lumps.in_series(
        _into(k * m.ring_width, m.wall_depth, m.floor_thickness), k * area / m.running_clearance
    )
    above = lumps.in_series(_into(k * m.ring_width, m.wall_depth, m.rotor_thickness), m.through_clearance * area)
    to_floor, to_plate, across = lumps.heated_between(k * whole * area / m.block_height, below, above)
    for places in zip(WALLS, BELOW_WALLS, ABOVE_WALLS, STRIP, strict=True):
        wall, floor, plate = (("around", i) for i in places[:3])
        ways = ((wall, floor, to_floor), (wall, plate, to_plate), (floor, plate, across))
        found += [Link(first, second, places[3] * conductance) for first, second, conductance in ways]
    return tuple(found)


def _into(sheet: Scalar, width: Scalar, depth: Scalar) -> Scalar:
    """Conductance [W/K] from a strip of a face to the mean of what lies before it, k L of its length."""
    return sheet / shape_factors.ledge_ways(width / depth)[0]
