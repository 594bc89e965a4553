"""Where vanes, blocks, pads and slots of the compression module stand; drawn in words in this folder's docstring."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.layout import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import between_planes

quantities = QuantityGroup(shared.group)


@quantities.output("mm", hidden=True)
def rotor_bottom_level(block_height: Scalar, running_clearance: Scalar) -> Scalar:
    """Lower face of the rotor plate: a running clearance below and above the blocks."""
    return block_height + 2.0 * running_clearance


@quantities.output("mm")
def vane_height(block_height: Scalar, running_clearance: Scalar) -> Scalar:
    """Height of the vanes of rotor and housing, which keep a running clearance from floor and plate."""
    return block_height + running_clearance


@quantities.helper()
def plate_lean(running_clearance: Scalar, hub_radius: Scalar, pcl_outer_radius: Scalar) -> Scalar:
    """Angle at which the leaning rotor's vanes are down on the floor [rad], its other side held at the hub."""
    return running_clearance / (hub_radius + pcl_outer_radius)


@quantities.helper()
def pcl_depth(block_depth: Scalar) -> Scalar:
    """Way of heat and load through the PCL [m]."""
    return block_depth


@quantities.output("mm")
def block_width(pcl_outer_radius: Scalar, pcl_inner_radius: Scalar) -> Scalar:
    """Radial width of blocks, pads and vanes."""
    return pcl_outer_radius - pcl_inner_radius


@quantities.output("mm", hidden=True)
def pocket_inner_radius(pcl_inner_radius: Scalar) -> Scalar:
    """Inner radius of the pads' pockets: open there, as the vanes are."""
    return pcl_inner_radius


@quantities.output("mm", hidden=True)
def pocket_outer_radius(pcl_outer_radius: Scalar) -> Scalar:
    """Outer radius of the pads' pockets: open there, as the vanes are."""
    return pcl_outer_radius


@quantities.output("deg")
def block_angle(block_depth: Scalar, pcl_mean_radius: Scalar) -> Scalar:
    """Angle each block covers."""
    return block_depth / pcl_mean_radius


@quantities.output("deg")
def rotor_vane_angle(vane_thickness: Scalar, pcl_mean_radius: Scalar) -> Scalar:
    """Angle each vane of the rotor covers."""
    return vane_thickness / pcl_mean_radius


@quantities.output("deg")
def housing_vane_angle(vane_count: Scalar, block_angle: Scalar, rotor_vane_angle: Scalar) -> Scalar:
    """Angle each vane of the housing covers, pads included: what blocks and rotor vanes leave of the circle."""
    return 2.0 * np.pi / vane_count - 2.0 * block_angle - rotor_vane_angle


@quantities.output("mm")
def slot_width(
    heater_form: str, slot_share: Scalar, block_width: Scalar, tile_window: Scalar, housing_vane_angle: Scalar
) -> Scalar:
    """Radial width of each slot in the housing's vanes."""
    if heater_form == CUT:
        return slot_share * block_width
    return tile_window * np.cos(0.5 * housing_vane_angle)


@quantities.output("mm")
def slot_inner_radius(
    heater_form: str,
    pcl_mean_radius: Scalar,
    slot_width: Scalar,
    tile_slot_radius: Scalar,
    tile_slot_pitch: Scalar,
    slot_count: Scalar,
) -> Scalar:
    """Inner radius of the slots in the housing's vanes."""
    if heater_form == CUT:
        return pcl_mean_radius - 0.5 * slot_width
    return tile_slot_radius - 0.5 * (slot_count - 1.0) * tile_slot_pitch - 0.5 * slot_width


@quantities.output("mm")
def slot_outer_radius(
    heater_form: str,
    pcl_mean_radius: Scalar,
    slot_width: Scalar,
    tile_slot_radius: Scalar,
    tile_slot_pitch: Scalar,
    slot_count: Scalar,
    housing_vane_angle: Scalar,
    pad_seat: Scalar,
) -> Scalar:
    """Outer radius of the slots in the housing's vanes; of flat ends, that of their corners."""
    if heater_form == CUT:
        return pcl_mean_radius + 0.5 * slot_width
    far = tile_slot_radius + 0.5 * (slot_count - 1.0) * tile_slot_pitch + 0.5 * slot_width
    return np.sqrt(far**2 + (0.5 * between_planes(housing_vane_angle, pad_seat, far)) ** 2)


@quantities.output("mm")
def slot_height(heater_form: str, block_height: Scalar, peltier_width: Scalar, window_ledge: Scalar) -> Scalar:
    """Height over which the pads' cold sides are open to the slots."""
    return (block_height if heater_form == CUT else peltier_width) - window_ledge


@quantities.helper()
def slot_angle(housing_vane_angle: Scalar, pad_depth: Scalar, pcl_mean_radius: Scalar) -> Scalar:
    """Angle between the cold sides of a housing vane's two pads at the mean radius [rad]."""
    return housing_vane_angle - 2.0 * np.arcsin(pad_depth / pcl_mean_radius)
