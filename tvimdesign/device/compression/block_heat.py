"""What the heat passes in the compression module: along the blocks into half of a rotor vane, and up into the plate.

By symmetry no heat passes the middle of a rotor vane, which a block heats from either side. Blocks and pads lose heat
through their free sides: below and above through the air of a running clearance to floor and rotor plate, in and out
through the chamber to the housing.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.compression.block_impedance import blocks_moment
from tvimdesign.device.core.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section
from tvimdesign.physics.heat_flow import lumps
from tvimdesign.physics.layers import film

quantities = QuantityGroup(shared.group)

WALL, RIM, BELOW_VANE, HOUSING = 3, 4, 5, 6


@quantities.helper()
def cold_area(vane_count: Scalar, slot_width: Scalar, slot_height: Scalar) -> Scalar:
    """Open area of the pads' cold sides [m^2]: what of them the slots show."""
    return 2.0 * vane_count * slot_width * slot_height


@quantities.output("mm^2")
def heated_area(pcl_area: Scalar) -> Scalar:
    """Area of all Peltier modules towards the layer."""
    return pcl_area


@quantities.output("1")
def heater_strings() -> Scalar:
    """Strings of Peltier modules in parallel, which share the current."""
    return 1.0


@quantities.helper()
def pad_contact(hot_contact: Scalar) -> Scalar:
    """Conductance from the pads' hot side to the blocks [W/m^2 K]: that of their contact."""
    return hot_contact


@quantities.helper()
def spreader_capacity() -> Scalar:
    """Heat capacity of spreaders [J/K]: none, the blocks lie on their pads."""
    return 0.0


@quantities.helper(instant=True)
def moment_now(
    slice_moduli: tuple[Scalar, Scalar],
    shape_factor: Scalar,
    vane_count: Scalar,
    block_area: Scalar,
    pcl_mean_radius: Scalar,
) -> Scalar:
    """The blocks' moment at an instant [m^4], 3 (1 + 2 (S/p)^2) N A r^2, p the share of them that is soft."""
    share = film.soft_share(*slice_moduli)
    return blocks_moment(shape_factor / share, vane_count, block_area, pcl_mean_radius)


@quantities.helper()
def plate_depth(vane_thickness: Scalar) -> Scalar:
    """Thickness of what is behind a block [m]: half a rotor vane."""
    return 0.5 * vane_thickness


@quantities.helper()
def plate_outside(
    pcl_area: Scalar,
    block_area: Scalar,
    block_height: Scalar,
    plate_depth: Scalar,
    rotor_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> lumps.Surface:
    """Inner and outer rims of the rotor's vanes, which lose heat; as a share of the blocks' faces."""
    share = 2.0 * block_height * plate_depth / block_area
    return lumps.Surface(pcl_area, share * rotor_coefficient, share * surface_emissivity)


@quantities.helper()
def plate_mass(
    rotor_radius: Scalar, rotor_thickness: Scalar, rotor_vanes: Section, vane_height: Scalar, structure_density: Scalar
) -> Scalar:
    """Mass of the rotor plate with its vanes [kg]."""
    return (np.pi * rotor_radius**2 * rotor_thickness + rotor_vanes.area * vane_height) * structure_density


@quantities.helper()
def faced_area(
    block_width: Scalar, vane_count: Scalar, plate_depth: Scalar, block_depth: Scalar, peltier_thickness: Scalar
) -> Scalar:
    """Plan area of rotor's vanes, blocks and pads [m^2]: what of floor and rotor plate they heat."""
    return 2.0 * vane_count * block_width * (plate_depth + block_depth + peltier_thickness)


@quantities.helper()
def vane_share(plate_depth: Scalar, block_depth: Scalar, peltier_thickness: Scalar) -> Scalar:
    """Share of that area that is the rotor's vanes [1]."""
    return plate_depth / (plate_depth + block_depth + peltier_thickness)


@quantities.helper()
def rotor_beside(
    faced_area: Scalar,
    rotor_thickness: Scalar,
    rotor_vanes: Section,
    vane_height: Scalar,
    structure_conductivity: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    rotor_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> tuple[lumps.Lump, ...]:
    """Rotor plate above vanes, blocks and pads, in three bodies from its lower face on, heated by the vanes' roots.

    A fin heated evenly over its faces: its mean temperature is a third of its height away from the root (Incropera,
    Fundamentals of Heat and Mass Transfer, ch. 3, even generation).
    """
    capacity = rotor_thickness * structure_density * structure_specific_heat
    across = structure_conductivity * faced_area / rotor_thickness
    first, *others = lumps.strip(faced_area, capacity, across, lumps.NOWHERE)
    root = 3.0 * structure_conductivity * rotor_vanes.area / vane_height
    above = lumps.Surface(faced_area, rotor_coefficient, surface_emissivity)
    others[-1] = others[-1]._replace(surface=above)
    return (first._replace(conductance=lumps.in_series(root, first.conductance)), *others)


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
def uneven_sideways(rotor_beside: tuple[lumps.Lump, ...]) -> Scalar:
    """Conductance to the plate above for what a vane's temperature differs over its depth from its mean [W/K]."""
    return rotor_beside[0].conductance


@quantities.helper()
def wall_depth(pcl_mean_radius: Scalar, vane_count: Scalar, plate_depth: Scalar, block_depth: Scalar, peltier_thickness: Scalar) -> Scalar:
    """Thickness of half a housing vane at the mean radius [m], which a pad leans against."""
    return np.pi * pcl_mean_radius / vane_count - plate_depth - block_depth - peltier_thickness


@quantities.helper()
def around_pads(
    pcl_area: Scalar,
    cold_area: Scalar,
    wall_depth: Scalar,
    faced_area: Scalar,
    vane_share: Scalar,
    block_width: Scalar,
    vane_count: Scalar,
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
) -> tuple[lumps.Body, ...]:
    """Floor below vanes, blocks and pads in three bodies from its upper face on, the housing's vanes with the floor
    below them, the rotor plate beside the ring, the rest of the housing."""
    volumetric = structure_density * structure_specific_heat
    open_air = lumps.Surface(1.0, housing_coefficient, surface_emissivity)
    heated = (1.0 - vane_share) * faced_area
    floor = [lumps.Body(share * heated * floor_thickness * volumetric, lumps.NOWHERE) for share in lumps.STRIP]
    floor[-1] = floor[-1]._replace(surface=open_air._replace(area=heated))
    foot = 2.0 * vane_count * block_width * wall_depth
    wall = lumps.Body(((pcl_area - cold_area) * wall_depth + foot * floor_thickness) * volumetric,
                      open_air._replace(area=foot))  # fmt: skip
    rim_volume = plate_mass / structure_density - rotor_vanes.area * vane_height - faced_area * rotor_thickness
    rim = lumps.Body(rim_volume * volumetric,
                     lumps.Surface(rim_volume / rotor_thickness, rotor_coefficient, surface_emissivity))  # fmt: skip
    outside = 2.0 * np.pi * housing_outer_radius * (rim_level + floor_thickness + foot_height)
    outside = outside + np.pi * housing_inner_radius**2 - faced_area - foot
    vane = lumps.Body(vane_share * faced_area * floor_thickness * volumetric,
                      open_air._replace(area=vane_share * faced_area))  # fmt: skip
    rest = housing_mass * structure_specific_heat - wall.capacity - sum(body.capacity for body in (*floor, vane))
    return (*floor, wall, rim, vane, lumps.Body(rest, open_air._replace(area=outside)))


@quantities.helper()
def floor_links(
    faced_area: Scalar,
    vane_share: Scalar,
    wall_depth: Scalar,
    floor_thickness: Scalar,
    pcl_outer_radius: Scalar,
    pcl_mean_radius: Scalar,
    block_width: Scalar,
    vane_count: Scalar,
    housing_inner_radius: Scalar,
    structure_conductivity: Scalar,
) -> tuple[lumps.Link, ...]:
    """Within the floor and out to the housing."""
    k = structure_conductivity
    heated = (1.0 - vane_share) * faced_area
    found = []
    for i in range(2):
        way = 0.5 * (lumps.STRIP[i] + lumps.STRIP[i + 1]) * floor_thickness
        found.append(lumps.Link(("around", i), ("around", i + 1), k * heated / way))
    out = 2.0 * np.pi * k * floor_thickness / np.log(housing_inner_radius / pcl_outer_radius)
    ring = 2.0 * np.pi * pcl_mean_radius * block_width
    share = heated / ring
    vane = vane_share * faced_area / ring
    found += [lumps.Link(("around", i), ("around", HOUSING), part * share * out) for i, part in enumerate(lumps.STRIP)]
    # Walls through which the floor below blocks meets that below vanes and housing's vanes, a block's depth away.
    return (
        *found,
        lumps.Link(("around", WALL), ("around", HOUSING), (1.0 - share - vane) * out),
        lumps.Link(("around", BELOW_VANE), ("around", HOUSING), vane * out),
        *(lumps.Link(("around", i), ("around", BELOW_VANE), 4.0 * vane_count * part * k * floor_thickness * block_width / (heated+vane_share*faced_area) * (2.0*vane_count*block_width)) for i, part in enumerate(lumps.STRIP)),
    )


@quantities.helper()
def air_links(
    vane_count: Scalar,
    block_width: Scalar,
    block_depth: Scalar,
    peltier_thickness: Scalar,
    plate_depth: Scalar,
    wall_depth: Scalar,
    running_clearance: Scalar,
    air_conductivity: Scalar,
    surface_emissivity: Scalar,
    floor_thickness: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
    ambient_temperature: Scalar,
) -> tuple[lumps.Link, ...]:
    """Through the air of the running clearances below and above blocks, pads and vanes."""
    floor, above = ("around", 0), ("beside", 0)
    below_face = 0.5 * lumps.STRIP[0] * floor_thickness / structure_conductivity
    above_face = 0.5 * lumps.STRIP[0] * rotor_thickness / structure_conductivity
    half = 0.5 * peltier_thickness
    found = []
    for place, depth, faces in (
        (("layer", 0), block_depth, (floor, above)), (("hot", 0), half, (floor, above)),
        (("cold", 0), half, (floor, above)), (("plate", 0), plate_depth, (("around", BELOW_VANE),)),
        (("around", WALL), wall_depth, (above,)),
    ):
        for face in faces:
            area = 2.0 * vane_count * block_width * depth
            gap = lumps.air_gap(area, running_clearance, air_conductivity, surface_emissivity, place, face)
            behind = {floor: below_face, above: above_face}.get(face, floor_thickness / 3.0 / structure_conductivity) / area
            share = 1.0 / (1.0 + behind * lumps.link_conductance(gap, ambient_temperature, ambient_temperature))
            found.append(gap._replace(conductance=share * gap.conductance, radiating_area=share * gap.radiating_area))
    return tuple(found)


@quantities.helper()
def side_links(
    open_sides: Scalar,
    block_depth: Scalar,
    peltier_thickness: Scalar,
    pcl_area: Scalar,
    cold_area: Scalar,
    wall_depth: Scalar,
    structure_conductivity: Scalar,
) -> tuple[lumps.Link, ...]:
    """From inner and outer sides through the chamber to the housing; from the cold sides into the housing's vanes."""
    housing = ("around", HOUSING)
    half = 0.5 * peltier_thickness * open_sides
    into_wall = 3.0 * structure_conductivity * (pcl_area - cold_area) / wall_depth
    return (lumps.Link(("layer", 0), housing, open_sides * block_depth), lumps.Link(("hot", 0), housing, half),
            lumps.Link(("cold", 0), housing, half), lumps.Link(("cold", 0), ("around", WALL), into_wall))  # fmt: skip


@quantities.helper()
def air_gaps(
    around_pads: tuple[lumps.Body, ...],
    pcl_outer_radius: Scalar,
    rotor_radius: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
    ambient_temperature: Scalar,
) -> tuple[tuple[lumps.Link, Scalar], ...]:
    """From the rotor plate above the ring out to its rim; and what that loses [W/K]."""
    out = pcl_outer_radius + (rotor_radius - pcl_outer_radius) / 3.0
    conductance = 2.0 * np.pi * structure_conductivity * rotor_thickness / np.log(out / pcl_outer_radius)
    rim = around_pads[RIM].surface
    onward = rim.area * lumps.surface_coefficient(rim, ambient_temperature, ambient_temperature)
    return ((lumps.Link(("beside", 2), ("around", RIM), conductance), onward),)


@quantities.helper()
def heat_links(
    floor_links: tuple[lumps.Link, ...],
    air_links: tuple[lumps.Link, ...],
    side_links: tuple[lumps.Link, ...],
    air_gaps: tuple[tuple[lumps.Link, Scalar], ...],
) -> tuple[lumps.Link, ...]:
    """What passes heat between the stack and the bodies beside and around it, and among these."""
    return (*floor_links, *air_links, *side_links, *(gap for gap, _ in air_gaps))
