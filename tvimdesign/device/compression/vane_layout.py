"""Layout of vanes, blocks, pads and slots of the compression module; the folder's docstring draws it in words."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.solids.shapes import between_planes

quantities = QuantityGroup("Layout")


@quantities.output("mm", hidden=True)
def rotor_bottom_level(m: Module) -> Scalar:
    """Lower face of the rotor plate: a running clearance below and above the blocks."""
    return m.block_height + 2.0 * m.running_clearance


@quantities.output("mm")
def vane_height(m: Module) -> Scalar:
    """Height of the vanes of rotor and housing, which keep a running clearance from floor and plate."""
    return m.block_height + m.running_clearance


@quantities.helper()
def plate_lean(m: Module) -> Scalar:
    """Angle at which the leaning rotor's vanes are down on the floor [rad], its other side held at the hub."""
    return m.running_clearance / (m.hub_radius + m.pcl_outer_radius)


@quantities.helper()
def pcl_depth(m: Module) -> Scalar:
    """Way of heat and load through the PCL [m]."""
    return m.block_depth


@quantities.output("mm")
def block_width(m: Module) -> Scalar:
    """Radial width of blocks, pads and vanes."""
    return m.pcl_outer_radius - m.pcl_inner_radius


@quantities.output("mm", hidden=True)
def pocket_inner_radius(m: Module) -> Scalar:
    """Inner radius of the pads' pockets: open there, as the vanes are."""
    return m.pcl_inner_radius


@quantities.output("mm", hidden=True)
def pocket_outer_radius(m: Module) -> Scalar:
    """Outer radius of the pads' pockets: open there, as the vanes are."""
    return m.pcl_outer_radius


@quantities.output("deg")
def block_angle(m: Module) -> Scalar:
    """Angle each block covers."""
    return m.block_depth / m.pcl_mean_radius


@quantities.output("deg")
def rotor_vane_angle(m: Module) -> Scalar:
    """Angle each vane of the rotor covers."""
    return m.vane_thickness / m.pcl_mean_radius


@quantities.output("deg")
def housing_vane_angle(m: Module) -> Scalar:
    """Angle each vane of the housing covers, pads included: what blocks and rotor vanes leave of the circle."""
    return 2.0 * np.pi / m.vane_count - 2.0 * m.block_angle - m.rotor_vane_angle


@quantities.output("mm")
def slot_width(m: Module) -> Scalar:
    """Radial width of each slot in the housing's vanes."""
    if m.heater_form == CUT:
        return m.slot_share * m.block_width
    return m.tile_window * np.cos(0.5 * m.housing_vane_angle)


@quantities.output("mm")
def slot_inner_radius(m: Module) -> Scalar:
    """Inner radius of the slots in the housing's vanes."""
    if m.heater_form == CUT:
        return m.pcl_mean_radius - 0.5 * m.slot_width
    return m.tile_slot_radius - 0.5 * (m.slot_count - 1.0) * m.tile_slot_pitch - 0.5 * m.slot_width


@quantities.output("mm")
def slot_outer_radius(m: Module) -> Scalar:
    """Outer radius of the slots in the housing's vanes; of flat ends, that of their corners."""
    if m.heater_form == CUT:
        return m.pcl_mean_radius + 0.5 * m.slot_width
    far = m.tile_slot_radius + 0.5 * (m.slot_count - 1.0) * m.tile_slot_pitch + 0.5 * m.slot_width
    return np.sqrt(far**2 + (0.5 * between_planes(m.housing_vane_angle, m.pad_seat, far)) ** 2)


@quantities.output("mm")
def slot_height(m: Module) -> Scalar:
    """Height over which the pads' cold sides are open to the slots."""
    return (m.block_height if m.heater_form == CUT else m.peltier_width) - m.window_ledge


@quantities.helper()
def slot_angle(m: Module) -> Scalar:
    """Angle between the cold sides of a housing vane's two pads at the mean radius [rad]."""
    return m.housing_vane_angle - 2.0 * np.arcsin(m.pad_depth / m.pcl_mean_radius)
