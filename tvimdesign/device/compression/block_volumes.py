"""Volumes of what only the compression module has: blocks, vanes on rotor and housing, and slots."""

from __future__ import annotations

from tvimdesign.device.core.mass_properties import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section, corners, radial_strip, sector

quantities = QuantityGroup(shared.group)


@quantities.output("mm^2")
def block_area(block_width: Scalar, block_height: Scalar) -> Scalar:
    """Face of one block, and of one Peltier pad."""
    return block_width * block_height


@quantities.output("mm^2", headline=True)
def pcl_area(vane_count: Scalar, block_area: Scalar) -> Scalar:
    """Area of all PCL blocks together towards their pads."""
    return 2.0 * vane_count * block_area


@quantities.output("mm^3")
def pcl_volume(pcl_area: Scalar, block_depth: Scalar) -> Scalar:
    """Volume of all PCL blocks together; a sector has its depth at the mean radius throughout."""
    return pcl_area * block_depth


@quantities.output("mm^3")
def peltier_volume(pcl_area: Scalar, peltier_thickness: Scalar) -> Scalar:
    """Volume of all Peltier pads together; they have the faces of the blocks."""
    return pcl_area * peltier_thickness


@quantities.output("g")
def spreader_mass() -> Scalar:
    """Mass of all spreaders together; zero without."""
    return 0.0


@quantities.output("g")
def thermistor_mass() -> Scalar:
    """Mass of all thermistor beads together: none is drawn."""
    return 0.0


@quantities.helper()
def slot_section(
    vane_count: Scalar,
    housing_vane_angle: Scalar,
    slot_inner_radius: Scalar,
    slot_outer_radius: Scalar,
    peltier_thickness: Scalar,
) -> Scalar:
    """Area of the slots in plan view beside the pads [m^2]: sectors of the vanes, less the pads on either side."""
    whole = sector(housing_vane_angle, slot_inner_radius, slot_outer_radius).area
    pads = 2.0 * radial_strip(peltier_thickness, slot_inner_radius, slot_outer_radius)
    return vane_count * (whole - pads)


@quantities.helper()
def slot_foot_section(
    vane_count: Scalar,
    housing_vane_angle: Scalar,
    slot_inner_radius: Scalar,
    slot_outer_radius: Scalar,
    pad_seat: Scalar,
    corner_radius: Scalar,
) -> Scalar:
    """Area of the slots in plan view below the pads [m^2]: less what the pads stand on, corners rounded."""
    whole = sector(housing_vane_angle, slot_inner_radius, slot_outer_radius).area
    seats = 2.0 * radial_strip(pad_seat, slot_inner_radius, slot_outer_radius)
    rounded = corners(corner_radius, slot_inner_radius, slot_outer_radius, pad_seat)
    return vane_count * (whole - seats - rounded)


@quantities.output("mm^3")
def housing_vanes_volume(
    vane_count: Scalar,
    housing_vane_angle: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    vane_height: Scalar,
    block_height: Scalar,
    slot_height: Scalar,
    peltier_thickness: Scalar,
    slot_section: Scalar,
    slot_foot_section: Scalar,
) -> Scalar:
    """Volume of the housing's vanes, less the pads let into them and their slots."""
    whole = sector(housing_vane_angle, pcl_inner_radius, pcl_outer_radius).area * vane_height
    pads = 2.0 * radial_strip(peltier_thickness, pcl_inner_radius, pcl_outer_radius) * block_height
    slots = slot_section * slot_height + slot_foot_section * (vane_height - block_height)
    return vane_count * (whole - pads) - slots


@quantities.helper()
def floor_openings(slot_foot_section: Scalar, pcl_mean_radius: Scalar, floor_thickness: Scalar) -> Section:
    """What the floor has not got, volume and its polar moment: the slots, at their mean radius."""
    return Section(slot_foot_section, slot_foot_section * pcl_mean_radius**2).times(floor_thickness)


@quantities.output("mm^3")
def floor_volume(floor_moments: Section) -> Scalar:
    """Volume of the housing's floor around the hub, less slots, tang holes and mounting holes."""
    return floor_moments.area


@quantities.helper()
def housing_moments(
    bare_housing_moments: Section, housing_vanes_volume: Scalar, pcl_inner_radius: Scalar, pcl_outer_radius: Scalar
) -> Section:
    """Volume and its polar moment about the axis, of the housing with its vanes, spread over their sectors."""
    spread = 0.5 * (pcl_inner_radius**2 + pcl_outer_radius**2)
    return bare_housing_moments.plus(Section(housing_vanes_volume, housing_vanes_volume * spread))


@quantities.output("mm^3")
def housing_volume(housing_moments: Section) -> Scalar:
    """Volume of the housing: skirt and floor, wall, hub, spring posts and vanes."""
    return housing_moments.area


@quantities.helper()
def rotor_vanes(
    vane_count: Scalar, rotor_vane_angle: Scalar, pcl_inner_radius: Scalar, pcl_outer_radius: Scalar
) -> Section:
    """Plan view of the rotor's vanes."""
    return sector(rotor_vane_angle, pcl_inner_radius, pcl_outer_radius).times(vane_count)


@quantities.helper()
def rotor_moments(bare_rotor_moments: Section, rotor_vanes: Section, vane_height: Scalar) -> Section:
    """Volume and its polar moment about the axis, of the rotor with its vanes."""
    return bare_rotor_moments.plus(rotor_vanes.times(vane_height))
