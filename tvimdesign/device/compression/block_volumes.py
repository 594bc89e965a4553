"""Volumes of blocks, vanes and slots, which only the compression module has, and the gap of a freezing block.

A block has free sides, so it shrinks alike in each direction. It stays on its pad and leaves the
rotor's vane; what the springs press into the gap while it is soft is not taken off, so the gap is an upper bound. The
rotor need not come down with the blocks: a running clearance is below and above them.
"""

from __future__ import annotations

from tvimdesign.device.core.heat.heater_form import CUT, WITH_TILES
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import transitions
from tvimdesign.physics.solids.shapes import (
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

quantities = QuantityGroup("Size and weight")


@quantities.output("mm^2")
def block_area(m: Module) -> Scalar:
    """Face of one block, and of one Peltier pad."""
    return m.block_width * m.block_height


@quantities.output("mm^2", headline=True)
def pcl_area(m: Module) -> Scalar:
    """Area of all PCL blocks together towards their pads."""
    return 2.0 * m.vane_count * m.block_area


@quantities.output("mm^3")
def pcl_volume(m: Module) -> Scalar:
    """Volume of all PCL blocks together; a sector has its depth at the mean radius throughout."""
    return m.pcl_area * m.block_depth


@quantities.output("mm^3")
def peltier_volume(m: Module) -> Scalar:
    """Volume of all Peltier modules together: pads with the faces of the blocks, or rectangular tiles."""
    area = m.pcl_area if m.heater_form == CUT else m.heater_count * m.peltier_length * m.peltier_width
    return area * m.peltier_thickness


@quantities.output("mm^3", requires=WITH_TILES)
def spreader_volume(m: Module) -> Scalar:
    """Volume of all spreaders together, which have the faces of the blocks; zero without."""
    return m.pcl_area * m.spreader_depth


def _slot_section(m: Module) -> Section:
    """Return the plan view of the slots beside the pads: sectors of the vanes, less the pads on either side and their
    corners.

    Behind tiles: what lies between the tiles of a vane, with flat ends.
    """
    if m.heater_form != CUT:
        row = wedge(
            m.housing_vane_angle, m.pad_depth, m.slot_width, m.tile_slot_radius, m.slot_count, m.tile_slot_pitch
        )
        return row.times(m.vane_count)
    whole = sector(m.housing_vane_angle, m.slot_inner_radius, m.slot_outer_radius).area
    pads = 2.0 * radial_strip(m.pad_depth, m.slot_inner_radius, m.slot_outer_radius)
    rounded = corners_beyond(m.corner_radius, m.slot_inner_radius, m.slot_outer_radius, m.pad_seat, m.pad_depth)
    area = m.vane_count * (whole - pads - rounded)
    return Section(area, area * m.pcl_mean_radius**2)


@quantities.helper()
def slot_foot_section(m: Module) -> Section:
    """Plan view of the slots below the pads: less what the pads stand on, corners rounded."""
    if m.heater_form != CUT:
        row = wedge(m.housing_vane_angle, m.pad_seat, m.slot_width, m.tile_slot_radius, m.slot_count, m.tile_slot_pitch)
        taken = m.slot_count * wedge_corners(m.corner_radius, m.housing_vane_angle)
        return (row - Section(taken, taken * m.tile_slot_radius**2)).times(m.vane_count)
    whole = sector(m.housing_vane_angle, m.slot_inner_radius, m.slot_outer_radius).area
    seats = 2.0 * radial_strip(m.pad_seat, m.slot_inner_radius, m.slot_outer_radius)
    rounded = corners(m.corner_radius, m.slot_inner_radius, m.slot_outer_radius, m.pad_seat)
    area = m.vane_count * (whole - seats - rounded)
    return Section(area, area * m.pcl_mean_radius**2)


@quantities.helper()
def housing_vanes_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the housing's vanes less the pads let into them and their slots.

    A pad's moment is that of a plate without thickness.
    """
    whole = sector(m.housing_vane_angle, m.pcl_inner_radius, m.pcl_outer_radius)
    strip = 2.0 * radial_strip(m.pad_depth, m.pcl_inner_radius, m.pcl_outer_radius)
    pads = Section(strip, strip * mean_square(m.pcl_inner_radius, m.pcl_outer_radius))
    return stacked(
        (whole.times(m.vane_count), m.vane_height),
        (pads.times(m.vane_count), -m.block_height),
        (_slot_section(m), -m.slot_height),
        (m.slot_foot_section, m.block_height - m.vane_height),
    )


@quantities.helper()
def floor_openings(m: Module) -> Section:
    """Volume of the floor's openings and its polar moment: the slots, and a hole for the thermistor."""
    return m.slot_foot_section.plus(m.thermistor_seat_section).times(m.floor_thickness)


@quantities.helper()
def housing_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the housing with its vanes."""
    return m.bare_housing_moments.plus(m.housing_vanes_moments)


@quantities.helper()
def rotor_vanes(m: Module) -> Section:
    """Plan view of the rotor's vanes."""
    return sector(m.rotor_vane_angle, m.pcl_inner_radius, m.pcl_outer_radius).times(m.vane_count)


@quantities.helper()
def rotor_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the rotor with its vanes, less the recesses for liners."""
    return m.bare_rotor_moments.plus(m.rotor_vanes.times(m.vane_height)) - m.liner_recess


places, shrinkages = QuantityGroup("Layout"), QuantityGroup("Axial play")


@places.output("mm")
def freezing_travel(m: Module) -> Scalar:
    """Axial travel of the rotor as the PCL freezes: zero, blocks have clearance above and below."""
    return 0.0 * m.melting_growth


@shrinkages.output("mm")
def freezing_gap(m: Module) -> Scalar:
    """Depth that a freezing block loses, and leaves beside its vane."""
    return m.block_depth * transitions.linear_share(m.freezing_shrinkage)


@shrinkages.output("deg")
def freezing_backlash(m: Module) -> Scalar:
    """Angle between a block's touch on either side of a rotor vane, after freezing at rest without load."""
    return 2.0 * m.freezing_gap / m.pcl_mean_radius
