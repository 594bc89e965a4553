"""Volumes of what only the compression module has: blocks, vanes on rotor and housing, and slots."""

from __future__ import annotations

from tvimdesign.device.core.heat.heater_form import CUT, WITH_TILES
from tvimdesign.device.core.mass_properties import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import (
    Section,
    corners,
    corners_beyond,
    mean_square,
    radial_strip,
    sector,
    stacked,
    wedge,
    wedge_corners,
)

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
def peltier_volume(
    heater_form: str,
    pcl_area: Scalar,
    heater_count: Scalar,
    peltier_length: Scalar,
    peltier_width: Scalar,
    peltier_thickness: Scalar,
) -> Scalar:
    """Volume of all Peltier modules together: pads with the faces of the blocks, or rectangular tiles."""
    area = pcl_area if heater_form == CUT else heater_count * peltier_length * peltier_width
    return area * peltier_thickness


@quantities.output("mm^3", requires=WITH_TILES)
def spreader_volume(pcl_area: Scalar, spreader_depth: Scalar) -> Scalar:
    """Volume of all spreaders together, which have the faces of the blocks; zero without."""
    return pcl_area * spreader_depth


@quantities.helper()
def slot_section(
    heater_form: str,
    vane_count: Scalar,
    housing_vane_angle: Scalar,
    slot_inner_radius: Scalar,
    slot_outer_radius: Scalar,
    pcl_mean_radius: Scalar,
    pad_depth: Scalar,
    pad_seat: Scalar,
    corner_radius: Scalar,
    slot_count: Scalar,
    slot_width: Scalar,
    tile_slot_radius: Scalar,
    tile_slot_pitch: Scalar,
) -> Section:
    """Plan view of the slots beside the pads: sectors of the vanes, less the pads on either side and their corners.

    Behind tiles: what lies between the tiles of a vane, with flat ends.
    """
    if heater_form != CUT:
        row = wedge(housing_vane_angle, pad_depth, slot_width, tile_slot_radius, slot_count, tile_slot_pitch)
        return row.times(vane_count)
    whole = sector(housing_vane_angle, slot_inner_radius, slot_outer_radius).area
    pads = 2.0 * radial_strip(pad_depth, slot_inner_radius, slot_outer_radius)
    rounded = corners_beyond(corner_radius, slot_inner_radius, slot_outer_radius, pad_seat, pad_depth)
    area = vane_count * (whole - pads - rounded)
    return Section(area, area * pcl_mean_radius**2)


@quantities.helper()
def slot_foot_section(
    heater_form: str,
    vane_count: Scalar,
    housing_vane_angle: Scalar,
    slot_inner_radius: Scalar,
    slot_outer_radius: Scalar,
    pcl_mean_radius: Scalar,
    pad_seat: Scalar,
    corner_radius: Scalar,
    slot_count: Scalar,
    slot_width: Scalar,
    tile_slot_radius: Scalar,
    tile_slot_pitch: Scalar,
) -> Section:
    """Plan view of the slots below the pads: less what the pads stand on, corners rounded."""
    if heater_form != CUT:
        row = wedge(housing_vane_angle, pad_seat, slot_width, tile_slot_radius, slot_count, tile_slot_pitch)
        taken = slot_count * wedge_corners(corner_radius, housing_vane_angle)
        return (row - Section(taken, taken * tile_slot_radius**2)).times(vane_count)
    whole = sector(housing_vane_angle, slot_inner_radius, slot_outer_radius).area
    seats = 2.0 * radial_strip(pad_seat, slot_inner_radius, slot_outer_radius)
    rounded = corners(corner_radius, slot_inner_radius, slot_outer_radius, pad_seat)
    area = vane_count * (whole - seats - rounded)
    return Section(area, area * pcl_mean_radius**2)


@quantities.helper()
def housing_vanes_moments(
    vane_count: Scalar,
    housing_vane_angle: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    vane_height: Scalar,
    block_height: Scalar,
    slot_height: Scalar,
    pad_depth: Scalar,
    slot_section: Section,
    slot_foot_section: Section,
) -> Section:
    """Volume and its polar moment about the axis, of the housing's vanes less the pads let into them and their slots.

    A pad's moment is that of a plate without thickness.
    """
    whole = sector(housing_vane_angle, pcl_inner_radius, pcl_outer_radius)
    strip = 2.0 * radial_strip(pad_depth, pcl_inner_radius, pcl_outer_radius)
    pads = Section(strip, strip * mean_square(pcl_inner_radius, pcl_outer_radius))
    return stacked(
        (whole.times(vane_count), vane_height),
        (pads.times(vane_count), -block_height),
        (slot_section, -slot_height),
        (slot_foot_section, block_height - vane_height),
    )


@quantities.output("mm^3")
def housing_vanes_volume(housing_vanes_moments: Section) -> Scalar:
    """Volume of the housing's vanes, less the pads let into them and their slots."""
    return housing_vanes_moments.area


@quantities.helper()
def floor_openings(slot_foot_section: Section, thermistor_seat_section: Section, floor_thickness: Scalar) -> Section:
    """What the floor has not got, volume and its polar moment: the slots, and a hole for the thermistor."""
    return slot_foot_section.plus(thermistor_seat_section).times(floor_thickness)


@quantities.output("mm^3")
def floor_volume(floor_moments: Section) -> Scalar:
    """Volume of the housing's floor around the hub, less slots, tang holes and mounting holes."""
    return floor_moments.area


@quantities.helper()
def housing_moments(bare_housing_moments: Section, housing_vanes_moments: Section) -> Section:
    """Volume and its polar moment about the axis, of the housing with its vanes."""
    return bare_housing_moments.plus(housing_vanes_moments)


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
def rotor_moments(
    bare_rotor_moments: Section, rotor_vanes: Section, vane_height: Scalar, liner_recess: Section
) -> Section:
    """Volume and its polar moment about the axis, of the rotor with its vanes, less the recesses for liners."""
    return bare_rotor_moments.plus(rotor_vanes.times(vane_height)) - liner_recess
