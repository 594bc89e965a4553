"""What stands around the blocks of the compression module as bodies of one temperature, and what passes heat to them.

Blocks, pads and rotor vanes face floor and rotor plate through the still air of the running clearances, and the housing
through the chamber within and without. The pads lean against the housing's vanes. The floor below blocks and pads is
three bodies from its upper face on, as is the rotor plate above them; the floor below the vanes is one.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section
from tvimdesign.physics.heat_flow import lumps
from tvimdesign.physics.heat_flow.lumps import STRIP, Body, Link
from tvimdesign.physics.polymers import polymer

quantities = QuantityGroup(shared.group)

FLOOR = (0, 1, 2)
"""Places of the floor's bodies below blocks and pads, from its upper face on."""
WALLS, RIM, BELOW_VANES, HOUSING = 3, 4, 5, 6
TO_RIM = 0.1
"""Way from where a block has its mean temperature to its lower and upper side, as a share of half its height.

Calibrated to times of the compression modules in two dimensions (`docs/theory/heat.md`); 0.05 to 0.15 do about as well.
"""


@quantities.helper()
def wall_depth(
    pcl_mean_radius: Scalar, vane_count: Scalar, plate_depth: Scalar, block_depth: Scalar, peltier_thickness: Scalar
) -> Scalar:
    """Half the thickness of a housing vane, which a pad leans against [m]: what is left of the ring at its mean
    radius."""
    return np.pi * pcl_mean_radius / vane_count - plate_depth - block_depth - peltier_thickness


@quantities.helper()
def ring_width(vane_count: Scalar, block_width: Scalar) -> Scalar:
    """Width of all blocks together [m]: plan area of what stands in the ring over its depth."""
    return 2.0 * vane_count * block_width


@quantities.helper()
def around_pads(
    pcl_area: Scalar,
    cold_area: Scalar,
    wall_depth: Scalar,
    ring_width: Scalar,
    faced_area: Scalar,
    plate_depth: Scalar,
    plate_mass: Scalar,
    rotor_vanes: Section,
    vane_height: Scalar,
    rotor_thickness: Scalar,
    housing_inner_radius: Scalar,
    housing_outer_radius: Scalar,
    rim_level: Scalar,
    foot_height: Scalar,
    floor_thickness: Scalar,
    housing_mass: Scalar,
    rotor_coefficient: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    housing_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> tuple[Body, ...]:
    """Floor below blocks and pads, housing vanes, rotor plate beside the ring, floor below vanes, the rest."""
    volumetric = structure_density * structure_specific_heat
    in_air = lumps.Surface(1.0, housing_coefficient, surface_emissivity)
    heated = faced_area - ring_width * plate_depth
    unheated = ring_width * (plate_depth + wall_depth)
    first, second, third = (Body(share * heated * floor_thickness * volumetric, lumps.NOWHERE) for share in STRIP)
    floor = (first, second, third._replace(surface=in_air._replace(area=heated)))
    walls = Body((pcl_area - cold_area) * wall_depth * volumetric, lumps.NOWHERE)
    rim_area = (plate_mass / structure_density - rotor_vanes.area * vane_height) / rotor_thickness - faced_area
    rim_volume = plate_mass / structure_density - pcl_area * plate_depth - faced_area * rotor_thickness
    rim = Body(rim_volume * volumetric, lumps.Surface(rim_area, rotor_coefficient, surface_emissivity))
    below_vanes = Body(unheated * floor_thickness * volumetric, in_air._replace(area=unheated))
    outside = 2.0 * np.pi * housing_outer_radius * (rim_level + floor_thickness + foot_height)
    outside = outside + np.pi * housing_inner_radius**2 - heated - unheated
    rest = housing_mass * structure_specific_heat - sum(body.capacity for body in (*floor, walls, below_vanes))
    return (*floor, walls, rim, below_vanes, Body(rest, in_air._replace(area=outside)))


@quantities.helper()
def floor_links(
    pcl_area: Scalar,
    cold_area: Scalar,
    block_height: Scalar,
    faced_area: Scalar,
    plate_depth: Scalar,
    wall_depth: Scalar,
    ring_width: Scalar,
    floor_thickness: Scalar,
    pcl_outer_radius: Scalar,
    housing_inner_radius: Scalar,
    structure_conductivity: Scalar,
) -> tuple[Link, ...]:
    """Within the floor, out to the housing's wall, and from the housing's vanes into it.

    Below a block it goes to either side, from middle to middle: to a rotor vane's floor and to a housing vane's.
    """
    heated = faced_area - ring_width * plate_depth
    unheated = ring_width * (plate_depth + wall_depth)
    found = []
    for i in FLOOR[1:]:
        way = 0.5 * (STRIP[i - 1] + STRIP[i]) * floor_thickness
        found.append(_link(i - 1, i, structure_conductivity * heated / way))
    out = 2.0 * np.pi * structure_conductivity * floor_thickness / np.log(housing_inner_radius / pcl_outer_radius)
    length = heated / ring_width
    ways = 0.5 * (length + plate_depth), 0.5 * (length + wall_depth)
    sideways = structure_conductivity * floor_thickness * ring_width * sum(1.0 / way for way in ways)
    for i in FLOOR:
        found.append(_link(i, HOUSING, STRIP[i] * out * heated / (heated + unheated)))
        found.append(_link(i, BELOW_VANES, STRIP[i] * sideways))
    found.append(_link(BELOW_VANES, HOUSING, out * unheated / (heated + unheated)))
    foot = ring_width * wall_depth * (pcl_area - cold_area) / pcl_area
    root = 3.0 * structure_conductivity * foot / (block_height + floor_thickness)
    return (*found, _link(WALLS, BELOW_VANES, root))


def _link(first: int, second: int, conductance: Scalar) -> Link:
    return Link(("around", first), ("around", second), conductance)


@quantities.helper()
def stack_links(
    ring_width: Scalar,
    block_depth: Scalar,
    peltier_thickness: Scalar,
    plate_depth: Scalar,
    wall_depth: Scalar,
    running_clearance: Scalar,
    block_height: Scalar,
    pcl_conductivity_melt: Scalar,
    air_conductivity: Scalar,
    surface_emissivity: Scalar,
    floor_thickness: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
    ambient_temperature: Scalar,
    pcl_melting: polymer.Melting,
) -> tuple[Link, ...]:
    """Through the running clearances below and above blocks, pads and vanes, with what lies on either side of them.

    Of what passes a clearance a tenth is radiation, which from blocks and vanes is taken as where the PCL is molten.
    """
    floor, vanes, above = ("around", FLOOR[0]), ("around", BELOW_VANES), ("beside", 0)
    faces = {floor: 0.5 * STRIP[0] * floor_thickness, vanes: floor_thickness / 3.0,
             above: 0.5 * STRIP[0] * rotor_thickness}  # fmt: skip
    half = 0.5 * peltier_thickness
    found = []
    for place, depth, faced in (
        (("layer", 0), block_depth, (floor, above)),
        (("hot", 0), half, (floor, above)),
        (("cold", 0), half, (floor, above)),
        (("plate", 0), plate_depth, (vanes,)),
        (("around", WALLS), wall_depth, (above,)),
    ):
        area = ring_width * depth
        for face in faced:
            gap = lumps.air_gap(area, running_clearance, air_conductivity, surface_emissivity, place, face)
            walls = structure_conductivity * area / faces[face]
            if place == ("layer", 0):
                walls = lumps.in_series(walls, pcl_conductivity_melt * area / (TO_RIM * 0.5 * block_height))
            through = lumps.behind(gap, walls, ambient_temperature)
            if place[0] in ("layer", "plate"):
                through = lumps.straightened(through, pcl_melting.end, ambient_temperature)
            found.append(through)
    return tuple(found)


@quantities.helper()
def open_sides(
    block_height: Scalar,
    vane_count: Scalar,
    housing_coefficient: Scalar,
    surface_emissivity: Scalar,
    ambient_temperature: Scalar,
) -> Scalar:
    """What the inner and outer sides of all blocks give to the chamber, by convection and radiation [W/m K].

    For a metre of their depth, or of the pads'.
    """
    chamber = lumps.Surface(2.0 * vane_count * 2.0 * block_height, housing_coefficient, surface_emissivity)
    return chamber.area * lumps.surface_coefficient(chamber, ambient_temperature, ambient_temperature)


@quantities.helper()
def side_links(
    open_sides: Scalar,
    block_depth: Scalar,
    peltier_thickness: Scalar,
    pcl_area: Scalar,
    cold_area: Scalar,
    wall_depth: Scalar,
    structure_conductivity: Scalar,
) -> tuple[Link, ...]:
    """From inner and outer sides through the chamber to the housing; from the cold sides into the housing's vanes."""
    housing, half = ("around", HOUSING), 0.5 * peltier_thickness * open_sides
    into_walls = 3.0 * structure_conductivity * (pcl_area - cold_area) / wall_depth
    return (
        Link(("layer", 0), housing, open_sides * block_depth),
        Link(("hot", 0), housing, half),
        Link(("cold", 0), housing, half),
        Link(("cold", 0), ("around", WALLS), into_walls),
    )


@quantities.helper()
def plate_losses(
    around_pads: tuple[Body, ...],
    pcl_outer_radius: Scalar,
    rotor_radius: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
    ambient_temperature: Scalar,
) -> tuple[lumps.Loss, ...]:
    """From the rotor plate above the ring to what is beside it, to a third of the way to the rim; and the air there."""
    third = (rotor_radius - pcl_outer_radius) / 3.0
    out = 2.0 * np.pi * structure_conductivity * rotor_thickness / np.log((pcl_outer_radius + third) / pcl_outer_radius)
    rim = around_pads[RIM].surface
    onward = rim.area * lumps.surface_coefficient(rim, ambient_temperature, ambient_temperature)
    return (lumps.Loss(Link(("beside", 2), ("around", RIM), out), onward),)
