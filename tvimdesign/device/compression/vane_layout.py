"""Layout of vanes, blocks, pads and slots of the compression module; the folder's docstring draws it in words.

A block has free sides, so it shrinks alike in each direction. It stays on its pad and leaves the
rotor's vane; what the springs press into the gap while it is soft is not taken off, so the gap is an upper bound. The
rotor need not come down with the blocks: a running clearance is below and above them.
"""

import numpy as np

from tvimdesign.device.core.heater_form import CUT
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.solids import shapes
from tvimdesign.physics.solids.shapes import Section

places = QuantityGroup("Layout")


places.formulas("vane_layout")


places.same("pcl_depth", "block_depth", "Way of heat and load through the PCL [m]")


@places.output("deg")
def housing_vane_angle(m: Module) -> Scalar:
    """Angle each vane of the housing covers, pads included: what blocks and rotor vanes leave of the circle."""
    return 2.0 * np.pi / m.vane_count - 2.0 * m.block_angle - m.rotor_vane_angle


@places.output("mm")
def slot_width(m: Module) -> Scalar:
    """Radial width of each slot in the housing's vanes."""
    if m.heater_form == CUT:
        return m.slot_share * m.block_width
    return m.tile_window * np.cos(0.5 * m.housing_vane_angle)


@places.output("mm")
def slot_inner_radius(m: Module) -> Scalar:
    """Inner radius of the slots in the housing's vanes."""
    if m.heater_form == CUT:
        return m.pcl_mean_radius - 0.5 * m.slot_width
    return m.tile_slot_radius - 0.5 * (m.slot_count - 1.0) * m.tile_slot_pitch - 0.5 * m.slot_width


@places.output("mm")
def slot_outer_radius(m: Module) -> Scalar:
    """Outer radius of the slots in the housing's vanes; of flat ends, that of their corners."""
    if m.heater_form == CUT:
        return m.pcl_mean_radius + 0.5 * m.slot_width
    far = m.tile_slot_radius + 0.5 * (m.slot_count - 1.0) * m.tile_slot_pitch + 0.5 * m.slot_width
    return np.sqrt(far**2 + (0.5 * shapes.between_planes(m.housing_vane_angle, m.pad_seat, far)) ** 2)


@places.output("mm")
def slot_height(m: Module) -> Scalar:
    """Height over which the pads' cold sides are open to the slots."""
    return (m.block_height if m.heater_form == CUT else m.heater_width) - m.window_ledge


@places.helper()
def slot_angle(m: Module) -> Scalar:
    """Angle between the cold sides of a housing vane's two pads at the mean radius [rad]."""
    return m.housing_vane_angle - 2.0 * np.arcsin(m.pad_depth / m.pcl_mean_radius)


weights = QuantityGroup("Size and weight")


@weights.output("mm^2")
def block_area(m: Module) -> Scalar:
    """Face of one block, and of one heater."""
    return m.block_width * m.block_height


weights.formulas("vane_layout.weights")


@weights.output("mm^3")
def heater_volume(m: Module) -> Scalar:
    """Volume of all heaters together: pads with the faces of the blocks, or rectangular tiles."""
    area = m.pcl_area if m.heater_form == CUT else m.heater_count * m.heater_length * m.heater_width
    return area * m.heater_thickness


def _slot_section(m: Module) -> Section:
    """Return the plan view of the slots beside the pads: sectors of the vanes, less the pads on either side and their
    corners.

    Behind tiles: what lies between the tiles of a vane, with flat ends.
    """
    if m.heater_form != CUT:
        row = shapes.wedge(
            m.housing_vane_angle, m.pad_depth, m.slot_width, m.tile_slot_radius, m.slot_count, m.tile_slot_pitch
        )
        return row.times(m.vane_count)
    whole = shapes.sector(m.housing_vane_angle, m.slot_inner_radius, m.slot_outer_radius).area
    pads = 2.0 * shapes.radial_strip(m.pad_depth, m.slot_inner_radius, m.slot_outer_radius)
    rounded = shapes.corners_beyond(m.corner_radius, m.slot_inner_radius, m.slot_outer_radius, m.pad_seat, m.pad_depth)
    area = m.vane_count * (whole - pads - rounded)
    return Section(area, area * m.pcl_mean_radius**2)


@weights.helper()
def slot_foot_section(m: Module) -> Section:
    """Plan view of the slots below the pads: less what the pads stand on, corners rounded."""
    if m.heater_form != CUT:
        row = shapes.wedge(
            m.housing_vane_angle, m.pad_seat, m.slot_width, m.tile_slot_radius, m.slot_count, m.tile_slot_pitch
        )
        taken = m.slot_count * shapes.wedge_corners(m.corner_radius, m.housing_vane_angle)
        return (row - Section(taken, taken * m.tile_slot_radius**2)).times(m.vane_count)
    whole = shapes.sector(m.housing_vane_angle, m.slot_inner_radius, m.slot_outer_radius).area
    seats = 2.0 * shapes.radial_strip(m.pad_seat, m.slot_inner_radius, m.slot_outer_radius)
    rounded = shapes.corners(m.corner_radius, m.slot_inner_radius, m.slot_outer_radius, m.pad_seat)
    area = m.vane_count * (whole - seats - rounded)
    return Section(area, area * m.pcl_mean_radius**2)


@weights.helper()
def housing_vanes_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the housing's vanes less the pads let into them and their slots.

    A pad's moment is that of a plate without thickness.
    """
    whole = shapes.sector(m.housing_vane_angle, m.pcl_inner_radius, m.pcl_outer_radius)
    strip = 2.0 * shapes.radial_strip(m.pad_depth, m.pcl_inner_radius, m.pcl_outer_radius)
    pads = Section(strip, strip * shapes.mean_square(m.pcl_inner_radius, m.pcl_outer_radius))
    return shapes.stacked(
        (whole.times(m.vane_count), m.vane_height),
        (pads.times(m.vane_count), -m.block_height),
        (_slot_section(m), -m.slot_height),
        (m.slot_foot_section, m.block_height - m.vane_height),
    )


@weights.helper()
def floor_openings(m: Module) -> Section:
    """Volume of the floor's openings and its polar moment: the slots, and a hole for the thermistor."""
    return m.slot_foot_section.plus(m.thermistor_seat_section).times(m.floor_thickness)


@weights.helper()
def housing_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the housing with its vanes."""
    return m.bare_housing_moments.plus(m.housing_vanes_moments)


@weights.helper()
def rotor_vanes(m: Module) -> Section:
    """Plan view of the rotor's vanes."""
    return shapes.sector(m.rotor_vane_angle, m.pcl_inner_radius, m.pcl_outer_radius).times(m.vane_count)


@weights.helper()
def rotor_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the rotor with its vanes, less the recesses for liners."""
    return m.bare_rotor_moments.plus(m.rotor_vanes.times(m.vane_height)) - m.liner_recess
