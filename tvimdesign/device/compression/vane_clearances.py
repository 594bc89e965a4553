"""What must hold for the vanes, blocks, pads and slots of the compression module."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.clearances import MM, POCKET_WIDTH
from tvimdesign.device.core.clearances import quantities as shared
from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.fixtures.cutout import WITH_CUTOUT
from tvimdesign.device.table.quantity import Rule, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import between_planes
from tvimdesign.physics.layers import block

quantities = QuantityGroup(shared.group)


@quantities.output("mm", at_least(0.0, "blocks and vanes must clear the hub"))
def hub_block_gap(pcl_inner_radius: Scalar, hub_radius: Scalar, radial_clearance: Scalar) -> Scalar:
    """Room between the hub and the blocks and vanes beyond the radial clearance."""
    return pcl_inner_radius - hub_radius - radial_clearance


@quantities.output("mm", at_least(3.0 * MM, "blocks and pads need a width", 0.0))
def block_breadth(block_width: Scalar) -> Scalar:
    """Radial width of the blocks, held against the least that can be made."""
    return block_width


@quantities.output("mm", at_least(2.0 * MM, "air must pass between the two pads of a housing vane", 0.0))
def slot_opening(heater_form: str, housing_vane_angle: Scalar, slot_inner_radius: Scalar, pad_depth: Scalar) -> Scalar:
    """Distance of the two pads of a housing vane around the axis, at the inner end of the slot."""
    if heater_form == CUT:
        return slot_inner_radius * (housing_vane_angle - 2.0 * np.arcsin(pad_depth / slot_inner_radius))
    return between_planes(housing_vane_angle, pad_depth, slot_inner_radius)


@quantities.output("mm", at_least(1.0 * MM, "the pads' cold sides must be open somewhere", 0.0))
def slot_reach(slot_height: Scalar) -> Scalar:
    """Height of the pads' open cold sides, held against the least that lets air in."""
    return slot_height


@quantities.output("mm", at_least(0.0, "the housing's vanes must carry their pads beside the slot", 0.0))
def slot_web(heater_form: str, block_width: Scalar, tile_slot_pitch: Scalar, slot_width: Scalar) -> Scalar:
    """Radial width of what a housing vane has on either side of a slot; between two slots it has twice that."""
    return 0.5 * ((block_width if heater_form == CUT else tile_slot_pitch) - slot_width)


@quantities.output(
    "mm", at_least(0.0, "what carries the pads beside the slots is thinner than the process can make it")
)
def slot_web_margin(slot_web: Scalar, minimum_wall: Scalar) -> Scalar:
    """Housing vane on either side of its slot beyond the process's least wall."""
    return slot_web - minimum_wall


@quantities.output("mm")
def vane_root(rotor_vane_angle: Scalar, pcl_inner_radius: Scalar) -> Scalar:
    """Thickness of the rotor's vanes at their inner end, where they are thinnest."""
    return rotor_vane_angle * pcl_inner_radius


@quantities.output(
    "mm", at_least(0.0, "the rotor's vanes are thinner at their inner end than the process can make them")
)
def vane_root_margin(vane_root: Scalar, minimum_wall: Scalar) -> Scalar:
    """Rotor vanes at their inner end beyond the process's least wall."""
    return vane_root - minimum_wall


@quantities.output("mm", requires=WITH_CUTOUT)
def cutout_radius(slot_inner_radius: Scalar, slot_outer_radius: Scalar) -> Scalar:
    """Distance of the thermal cut-out's middle from the axis: below the middle of the slots; zero without."""
    return 0.5 * (slot_inner_radius + slot_outer_radius)


@quantities.output("mm", hidden=True)
def slot_top_level(running_clearance: Scalar, slot_height: Scalar) -> Scalar:
    """Upper end of the slots in the housing's vanes."""
    return running_clearance + slot_height


@quantities.helper()
def slot_reach_below(
    heater_form: str,
    corner_radius: Scalar,
    pad_depth: Scalar,
    pcl_mean_radius: Scalar,
    peltier_thickness: Scalar,
    lead_hole_diameter: Scalar,
    slot_corner_offset: Scalar,
) -> Scalar:
    """How far the slots reach under the pads [m]: by their rounded corners; under tiles to the leads between their
    plates.

    A corner that is rounded by q meets the slot's outer arc q a/r further behind the vane's face than its center lies,
    at the depth a and the radius r.
    """
    if heater_form == CUT:
        return corner_radius * (1.0 + pad_depth / pcl_mean_radius) + slot_corner_offset
    return np.fmax(corner_radius, 0.5 * (peltier_thickness + lead_hole_diameter))


@quantities.output("mm", at_least(0.0, "the slots are too narrow for their depth: the cutter cannot reach their ends"))
def slot_pocket_margin(
    slot_opening: Scalar,
    pocket_depth_ratio: Scalar,
    floor_thickness: Scalar,
    slot_top_level: Scalar,
) -> Scalar:
    """Depth the slots, milled from below, may have for their width beyond the one they have."""
    return pocket_depth_ratio * slot_opening - (floor_thickness + slot_top_level)


@quantities.output("mm", at_least(0.0, "the slots are too deep, the cutter cannot reach into their corners so far"))
def slot_corner_margin(
    corner_radius: Scalar,
    corner_depth_ratio: Scalar,
    floor_thickness: Scalar,
    slot_top_level: Scalar,
) -> Scalar:
    """Depth the corners of the slots, milled from below, may have beyond the one they have."""
    return corner_depth_ratio * corner_radius - (floor_thickness + slot_top_level)


@quantities.output("mm", at_least(0.0, "the slots' roofs are too long a bridge to print: a smaller slot_share"))
def slot_bridge_margin(
    heater_form: str,
    slot_inner_radius: Scalar,
    slot_outer_radius: Scalar,
    pad_depth: Scalar,
    tile_window: Scalar,
    bridge_span: Scalar,
) -> Scalar:
    """Longest bridge of the process beyond that along the pads, where the slots' roofs end in the air."""
    if heater_form != CUT:
        return bridge_span - tile_window
    return bridge_span - np.sqrt(slot_outer_radius**2 - pad_depth**2) + np.sqrt(slot_inner_radius**2 - pad_depth**2)


_NARROW = "a slot must be wider than the cutter of its corners: widen it, or choose a smaller corner_radius"


@quantities.output("mm", at_least(0.0, _NARROW))
def slot_width_margin(slot_width: Scalar, corner_radius: Scalar) -> Scalar:
    """Radial width of the slots beyond what their corners need."""
    return slot_width - POCKET_WIDTH * corner_radius


@quantities.helper()
def solid_floor(floor_thickness: Scalar) -> Scalar:
    """Floor that may be drilled into from below [m]: all of it, pads stand in the vanes."""
    return floor_thickness


@quantities.helper()
def floor_opening_radius(slot_inner_radius: Scalar) -> Scalar:
    """Radius at which the openings of the floor begin [m]: the slots."""
    return slot_inner_radius


_PRESSED_OUT = "what is squeezed out of the blocks' places could reach the springs, were all of it to go outwards"


@quantities.output("mm", advice=(Rule(sense=">=", value=0.0, reason=_PRESSED_OUT),))
def squeezed_block_gap(
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    block_angle: Scalar,
    stroke: Scalar,
    placement_radius: Scalar,
    spring_reach: Scalar,
    radial_clearance: Scalar,
) -> Scalar:
    """Room between springs and fully squeezed blocks, all of which gives way outwards, beyond the radial clearance."""
    # A block squeezed by half needs half its own volume beside its place. Some of that goes inwards, and into the
    # running clearances; so this is advice.
    squeezed = block.squeezed_outer_radius(pcl_inner_radius, pcl_outer_radius, block_angle, stroke)
    return placement_radius - spring_reach - squeezed - radial_clearance


@quantities.output("mm", at_least(0.0, "the feet must clear the slots"))
def mount_slot_gap(
    placement_radius: Scalar, mount_boss_radius: Scalar, slot_outer_radius: Scalar, radial_clearance: Scalar
) -> Scalar:
    """Room between the mounting feet and the slots in the floor beyond the radial clearance."""
    return placement_radius - mount_boss_radius - slot_outer_radius - radial_clearance


_FALLS = "slots are wider below the pads, by the radius of their corners, and leave these nothing to stand on"


@quantities.output("mm", at_least(0.2 * MM, _FALLS, 0.0))
def pad_seat(pad_depth: Scalar, slot_reach_below: Scalar) -> Scalar:
    """Width of what a pad, or a spreader with its tiles, stands on beside its slot."""
    return pad_depth - slot_reach_below


_SEAT = "pads stand on too thin a wall beside their slots: a smaller slot_corner_offset or lead_hole_diameter"


@quantities.output("mm", at_least(0.0, _SEAT))
def pad_seat_margin(pad_seat: Scalar, minimum_wall: Scalar) -> Scalar:
    """Width of what a pad stands on beside its slot beyond the process's least wall."""
    return pad_seat - minimum_wall


_SHARP = "the slot's corners leave sharp edges beside the pads: a larger slot_corner_offset"


@quantities.output("mm", at_least(0.0, _SHARP))
def slot_edge_margin(slot_corner_offset: Scalar, corner_radius: Scalar) -> Scalar:
    """Offset of the slots' corners beyond the one at which the edges they leave beside the pads have 60 degrees."""
    return slot_corner_offset + 0.5 * corner_radius
