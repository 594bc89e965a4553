"""Rules for the vanes, blocks, pads and slots of the compression module."""

import numpy as np

from tvimdesign.device.core.clearances import MM, POCKET_WIDTH
from tvimdesign.device.core.heater_form import CUT
from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics.layers import block
from tvimdesign.physics.solids.shapes import between_planes

quantities, places = QuantityGroup("Gaps"), QuantityGroup("Layout")


quantities.margins("vane_clearances")


@quantities.output("mm", at_least(3.0 * MM, "blocks and pads need a width", 0.0))
def block_breadth(m: Module) -> Scalar:
    """Radial width of the blocks, compared with the least that can be made."""
    return m.block_width


@quantities.output("mm", at_least(2.0 * MM, "air must pass between the two pads of a housing vane", 0.0))
def slot_opening(m: Module) -> Scalar:
    """Distance of the two pads of a housing vane around the axis, at the inner end of the slot."""
    if m.heater_form == CUT:
        return m.slot_inner_radius * (m.housing_vane_angle - 2.0 * np.arcsin(m.pad_depth / m.slot_inner_radius))
    return between_planes(m.housing_vane_angle, m.pad_depth, m.slot_inner_radius)


@quantities.output("mm", at_least(1.0 * MM, "the pads' cold sides must be open somewhere", 0.0))
def slot_reach(m: Module) -> Scalar:
    """Height of the pads' open cold sides, compared with the least that lets air in."""
    return m.slot_height


@quantities.output("mm", at_least(0.0, "the housing's vanes must carry their pads beside the slot", 0.0))
def slot_web(m: Module) -> Scalar:
    """Radial width of what a housing vane has on either side of a slot; between two slots it has twice that."""
    return 0.5 * ((m.block_width if m.heater_form == CUT else m.tile_slot_pitch) - m.slot_width)


@quantities.output("mm")
def vane_root(m: Module) -> Scalar:
    """Thickness of the rotor's vanes at their inner end, where they are thinnest."""
    return m.rotor_vane_angle * m.pcl_inner_radius


@places.output("mm", hidden=True)
def slot_top_level(m: Module) -> Scalar:
    """Upper end of the slots in the housing's vanes."""
    return m.running_clearance + m.slot_height


def _slot_reach_below(m: Module) -> Scalar:
    """Return the reach of the slots under the pads [m]: their rounded corners; under tiles the leads between their
    plates.

    A corner that is rounded by q meets the slot's outer arc q a/r further behind the vane's face than its center lies,
    at the depth a and the radius r.
    """
    if m.heater_form == CUT:
        return m.corner_radius * (1.0 + m.pad_depth / m.pcl_mean_radius) + m.slot_corner_offset
    return np.fmax(m.corner_radius, 0.5 * (m.heater_thickness + m.lead_hole_diameter))


@quantities.gap("the slots' roofs are too long a bridge to print: a smaller slot_share")
def slot_bridge_margin(m: Module) -> Scalar:
    """Longest bridge of the process beyond that along the pads, where the slots' roofs end in the air."""
    if m.heater_form != CUT:
        return m.bridge_span - m.tile_window
    return (
        m.bridge_span
        - np.sqrt(m.slot_outer_radius**2 - m.pad_depth**2)
        + np.sqrt(m.slot_inner_radius**2 - m.pad_depth**2)
    )


_NARROW = "a slot must be wider than the cutter of its corners: widen it, or choose a smaller corner_radius"


@quantities.gap(_NARROW)
def slot_width_margin(m: Module) -> Scalar:
    """Radial width of the slots beyond what their corners need."""
    return m.slot_width - POCKET_WIDTH * m.corner_radius


_PRESSED_OUT = "what is squeezed out of the blocks' places could reach the springs, were all of it to go outwards"


@quantities.output("mm", advice=(at_least(0.0, _PRESSED_OUT),))
def squeezed_block_gap(m: Module) -> Scalar:
    """Room between springs and blocks squeezed at the stops, which bulge outwards, beyond the radial clearance."""
    # A block squeezed by half needs half its own volume beside its place. Some of that goes inwards, and into the
    # running clearances; so this is advice.
    squeezed = block.squeezed_outer_radius(m.pcl_inner_radius, m.pcl_outer_radius, m.block_angle, m.stop_angle)
    return m.placement_radius - m.spring_reach - squeezed - m.radial_clearance


_FALLS = "slots are wider below the pads, by the radius of their corners, and leave these nothing to stand on"


@places.output("mm", at_least(0.2 * MM, _FALLS, 0.0))
def pad_seat(m: Module) -> Scalar:
    """Width of what a pad, or a spreader with its tiles, stands on beside its slot."""
    return m.pad_depth - _slot_reach_below(m)
