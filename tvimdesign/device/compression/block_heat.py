"""What the heat passes in the compression module: along the blocks into half of a rotor vane, and up into the plate.

By symmetry no heat passes the middle of a rotor vane, which a block heats from either side. Blocks and pads lose heat
through their free sides to the housing, above and below through a running clearance, in and out through the chamber.
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


@quantities.helper()
def cold_area(vane_count: Scalar, slot_width: Scalar, slot_height: Scalar) -> Scalar:
    """Open area of the pads' cold sides [m^2]: what of them the slots show."""
    return 2.0 * vane_count * slot_width * slot_height


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
    block_width: Scalar,
    block_height: Scalar,
    plate_depth: Scalar,
    rotor_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> lumps.Surface:
    """Rims of the rotor's vanes, inner, outer and lower, which lose heat; as a share of the blocks' faces."""
    share = (2.0 * block_height + block_width) * plate_depth / block_area
    return lumps.Surface(pcl_area, share * rotor_coefficient, share * surface_emissivity)


@quantities.helper()
def plate_mass(
    rotor_radius: Scalar, rotor_thickness: Scalar, rotor_vanes: Section, vane_height: Scalar, structure_density: Scalar
) -> Scalar:
    """Mass of the rotor plate with its vanes [kg]."""
    return (np.pi * rotor_radius**2 * rotor_thickness + rotor_vanes.area * vane_height) * structure_density


@quantities.helper()
def rotor_beside(
    plate_mass: Scalar,
    pcl_area: Scalar,
    plate_depth: Scalar,
    rotor_radius: Scalar,
    rotor_vanes: Section,
    vane_height: Scalar,
    structure_conductivity: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    rotor_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> tuple[lumps.Lump, ...]:
    """Rotor plate above the vanes, heated through their roots.

    A fin heated evenly over its faces: its mean temperature is a third of its height away from the root (Incropera,
    Fundamentals of Heat and Mass Transfer, ch. 3, even generation).
    """
    above = lumps.Lump(
        conductance=3.0 * structure_conductivity * rotor_vanes.area / vane_height,
        capacity=(plate_mass - pcl_area * plate_depth * structure_density) * structure_specific_heat,
        surface=lumps.Surface(np.pi * rotor_radius**2, rotor_coefficient, surface_emissivity),
    )
    return (above,)


@quantities.output("mm")
def edge_length(vane_count: Scalar, block_width: Scalar, block_height: Scalar) -> Scalar:
    """Length of the edges of all blocks together: those of the pads are as long."""
    return 2.0 * vane_count * 2.0 * (block_width + block_height)


@quantities.helper()
def side_coefficient(
    block_width: Scalar,
    block_height: Scalar,
    running_clearance: Scalar,
    air_conductivity: Scalar,
    housing_coefficient: Scalar,
    surface_emissivity: Scalar,
    ambient_temperature: Scalar,
) -> Scalar:
    """What free sides give to the housing [W/m^2 K], the mean over all four.

    Above and below through the still air of a running clearance, in and out by convection and radiation.
    """
    open_side = lumps.surface_coefficient(
        lumps.Surface(1.0, housing_coefficient, surface_emissivity), ambient_temperature, ambient_temperature
    )
    narrow = air_conductivity / running_clearance
    return (block_width * narrow + block_height * open_side) / (block_width + block_height)


@quantities.helper()
def free_sides(side_coefficient: Scalar, edge_length: Scalar, block_depth: Scalar) -> Scalar:
    """Conductance from the blocks' free sides to what they face [W/K]."""
    return side_coefficient * edge_length * block_depth


@quantities.helper()
def around_pads(
    side_coefficient: Scalar,
    peltier_thickness: Scalar,
    edge_length: Scalar,
    block_depth: Scalar,
    block_width: Scalar,
    vane_count: Scalar,
    housing_inner_radius: Scalar,
    housing_outer_radius: Scalar,
    rim_level: Scalar,
    foot_height: Scalar,
    floor_thickness: Scalar,
    housing_mass: Scalar,
    structure_conductivity: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    housing_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> tuple[lumps.Lump, ...]:
    """What the free sides of blocks and pads face: floor and plate next to them, as thick as the floor; the housing.

    In plastic the first tenths of a millimetre warm up and then keep the heat in; metal is one body with the rest.
    """
    facing = 4.0 * vane_count * block_width * (block_depth + peltier_thickness)
    first, *others = lumps.strip(
        facing,
        floor_thickness * structure_density * structure_specific_heat,
        structure_conductivity * facing / floor_thickness,
        lumps.NOWHERE,
    )
    outside = 2.0 * np.pi * housing_outer_radius * (rim_level + floor_thickness + foot_height)
    outside = outside + np.pi * housing_inner_radius**2
    housing = lumps.Lump(
        conductance=structure_conductivity * facing / floor_thickness,
        capacity=housing_mass * structure_specific_heat,
        surface=lumps.Surface(outside, housing_coefficient, surface_emissivity),
    )
    edges = 0.5 * side_coefficient * peltier_thickness * edge_length
    return (first._replace(conductance=lumps.in_series(edges, first.conductance)), *others, housing)


@quantities.helper()
def air_gaps(
    rotor_radius: Scalar,
    rotor_vanes: Section,
    vane_height: Scalar,
    air_conductivity: Scalar,
    surface_emissivity: Scalar,
) -> tuple[lumps.Gap, ...]:
    """Air of the chamber between the rotor plate beside its vanes and the floor."""
    area = np.pi * rotor_radius**2 - rotor_vanes.area
    return (lumps.air_gap(area, vane_height, air_conductivity, surface_emissivity, (0, len(lumps.STRIP))),)
