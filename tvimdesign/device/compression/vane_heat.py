"""What the vanes of rotor and housing pass to floor and rotor plate: through their roots, and through the clearance at
their other end.

A vane meets them in a strip, from which heat turns to the side as it comes in, as in a ledge (`ledge_ways`).
"""

from __future__ import annotations

from tvimdesign.device.compression.ring_heat import ABOVE_VANES, ABOVE_WALLS, BELOW_VANES, BELOW_WALLS, WALLS
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section
from tvimdesign.physics.heat_flow import lumps, shape_factors
from tvimdesign.physics.heat_flow.lumps import Link
from tvimdesign.physics.heat_flow.strip import STRIP
from tvimdesign.physics.polymers import polymer

quantities = QuantityGroup(shared.group)


@quantities.helper()
def through_clearance(
    running_clearance: Scalar,
    air_conductivity: Scalar,
    surface_emissivity: Scalar,
    pcl_melting: polymer.Melting,
    ambient_temperature: Scalar,
) -> Scalar:
    """What passes a running clearance [W/m^2 K]; a tenth is radiation, taken as where the PCL is molten."""
    gap = lumps.air_gap(1.0, running_clearance, air_conductivity, surface_emissivity, ("plate", 0), ("plate", 0))
    return lumps.link_conductance(gap, pcl_melting.end, ambient_temperature)


@quantities.helper()
def vane_ways(
    ring_width: Scalar,
    plate_depth: Scalar,
    rotor_vanes: Section,
    running_clearance: Scalar,
    block_height: Scalar,
    rotor_thickness: Scalar,
    floor_thickness: Scalar,
    structure_conductivity: Scalar,
    through_clearance: Scalar,
) -> tuple[Scalar, Scalar, Scalar]:
    """Conductances [W/K] from the rotor's vanes to the plate above, to the floor below, and from one to the other."""
    k, area = structure_conductivity, ring_width * plate_depth
    above, below = (_into(k * ring_width, plate_depth, depth) for depth in (rotor_thickness, floor_thickness))
    below = lumps.in_series(below, through_clearance * area)
    # The vane stands beside the clearance before it meets the plate.
    above = lumps.in_series(above, k * rotor_vanes.area / running_clearance)
    return lumps.heated_between(k * rotor_vanes.area / block_height, above, below)


@quantities.helper()
def vane_links(
    vane_ways: tuple[Scalar, Scalar, Scalar],
    pcl_area: Scalar,
    cold_area: Scalar,
    ring_width: Scalar,
    wall_depth: Scalar,
    running_clearance: Scalar,
    block_height: Scalar,
    floor_thickness: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
    through_clearance: Scalar,
) -> tuple[Link, ...]:
    """From the rotor's vanes to the floor, from the housing's to floor and rotor plate, but for the rotor's roots."""
    floor, plate = ("around", BELOW_VANES), ("beside", ABOVE_VANES)
    found = [Link(("plate", 0), floor, vane_ways[1]), Link(plate, floor, vane_ways[2])]
    k, area = structure_conductivity, ring_width * wall_depth
    whole = (pcl_area - cold_area) / pcl_area
    below = whole * lumps.in_series(_into(k * ring_width, wall_depth, floor_thickness), k * area / running_clearance)
    above = lumps.in_series(_into(k * ring_width, wall_depth, rotor_thickness), through_clearance * area)
    to_floor, to_plate, across = lumps.heated_between(k * whole * area / block_height, below, above)
    for places in zip(WALLS, BELOW_WALLS, ABOVE_WALLS, STRIP, strict=True):
        wall, floor, plate = (("around", i) for i in places[:3])
        ways = ((wall, floor, to_floor), (wall, plate, to_plate), (floor, plate, across))
        found += [Link(first, second, places[3] * conductance) for first, second, conductance in ways]
    return tuple(found)


def _into(sheet: Scalar, width: Scalar, depth: Scalar) -> Scalar:
    """Conductance [W/K] from a strip of a face to the mean of what lies before it, k L of its length."""
    return sheet / shape_factors.ledge_ways(width / depth)[0]
