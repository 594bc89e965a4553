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
def narrow_sides(
    vane_count: Scalar, block_width: Scalar, air_conductivity: Scalar, running_clearance: Scalar
) -> Scalar:
    """What the lower sides of all blocks give through the air of a running clearance [W/m K]; the upper ones as much.

    For a metre of their depth, or of the pads'.
    """
    return 2.0 * vane_count * block_width * air_conductivity / running_clearance


@quantities.helper()
def free_sides(open_sides: Scalar, narrow_sides: Scalar, block_depth: Scalar) -> Scalar:
    """Conductance from the blocks' inner, outer and lower sides to the housing [W/K]."""
    return (open_sides + narrow_sides) * block_depth


@quantities.helper()
def upper_sides(
    narrow_sides: Scalar,
    block_depth: Scalar,
    block_width: Scalar,
    vane_count: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
) -> Scalar:
    """Conductance from the blocks' upper sides to the rotor plate [W/K], through a running clearance and half of it."""
    above = 2.0 * vane_count * block_width * block_depth
    return lumps.in_series(narrow_sides * block_depth, 2.0 * structure_conductivity * above / rotor_thickness)


@quantities.helper()
def around_pads(
    open_sides: Scalar,
    narrow_sides: Scalar,
    peltier_thickness: Scalar,
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
    """What the free sides of blocks and pads face: the floor below them, and the housing.

    In plastic the first tenths of a millimetre warm up and then keep the heat in; metal is one body with the rest.
    """
    facing = 2.0 * vane_count * block_width * (block_depth + peltier_thickness)
    capacity = floor_thickness * structure_density * structure_specific_heat
    through = structure_conductivity * facing / floor_thickness
    first, *others = lumps.strip(facing, capacity, through, lumps.NOWHERE)
    outside = 2.0 * np.pi * housing_outer_radius * (rim_level + floor_thickness + foot_height)
    outside = outside + np.pi * housing_inner_radius**2
    housing = lumps.Lump(
        conductance=through,
        capacity=housing_mass * structure_specific_heat - capacity * facing,
        surface=lumps.Surface(outside, housing_coefficient, surface_emissivity),
    )
    edges = 0.5 * peltier_thickness * (open_sides + 2.0 * narrow_sides)
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
