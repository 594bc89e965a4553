"""What must hold for the arcs of the shear module, the pads under them and the windows below those."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.clearances import MM, POCKET_WIDTH
from tvimdesign.device.core.clearances import quantities as shared
from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.fixtures.cutout import WITH_CUTOUT
from tvimdesign.device.fixtures.liner import WITH_LINER
from tvimdesign.device.table.quantity import Rule, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup

quantities = QuantityGroup(shared.group)


quantities.after("leg_reach_gap")


@quantities.output("mm", at_least(0.0, "the PCL arcs must clear the hub"))
def hub_arc_gap(pcl_inner_radius: Scalar, hub_radius: Scalar, radial_clearance: Scalar) -> Scalar:
    """Room between hub and PCL arcs beyond the radial clearance."""
    return pcl_inner_radius - hub_radius - radial_clearance


@quantities.output("mm", at_least(3.0 * MM, "the floor needs a web between two Peltier pads", 0.0))
def arc_gap(arc_count: Scalar, arc_span: Scalar, pcl_inner_radius: Scalar) -> Scalar:
    """Web between neighbouring PCL arcs at their inner radius."""
    return (2.0 * np.pi / arc_count - arc_span) * pcl_inner_radius


@quantities.output("mm", at_least(5.0 * MM, "the Peltier pad needs its ledges and a window for its cold side", 0.0))
def arc_width(pcl_outer_radius: Scalar, pcl_inner_radius: Scalar) -> Scalar:
    """Radial width of the PCL arcs."""
    return pcl_outer_radius - pcl_inner_radius


@quantities.output("mm", at_least(0.0, "a Peltier pad needs a window behind its ledges for its cold side", 0.0))
def window_depth(heater_form: str, peltier_width: Scalar, arc_width: Scalar, window_ledge: Scalar) -> Scalar:
    """Radial width of the windows below the Peltier modules."""
    return (arc_width if heater_form == CUT else peltier_width) - 2.0 * window_ledge


@quantities.output("mm", at_least(0.0, "there must be a floor below a Peltier pad", 0.0))
def floor_web(floor_thickness: Scalar, pad_depth: Scalar) -> Scalar:
    """Thickness of the floor below the Peltier pads."""
    return floor_thickness - pad_depth


@quantities.output("mm", at_least(0.0, "the floor below a Peltier pad is thinner than the process can make it"))
def floor_web_margin(floor_web: Scalar, minimum_wall: Scalar) -> Scalar:
    """Floor below the Peltier pads beyond the process's least wall."""
    return floor_web - minimum_wall


@quantities.helper()
def solid_floor(floor_web: Scalar) -> Scalar:
    """Floor that may be drilled into from below [m]: what is left below the pads, wherever these are."""
    return floor_web


@quantities.helper()
def floor_opening_radius(pcl_inner_radius: Scalar, window_ledge: Scalar) -> Scalar:
    """Radius at which the openings of the floor begin [m]: the windows."""
    return pcl_inner_radius + window_ledge


quantities.after("retainer_gap")


@quantities.output("mm", at_least(2.0 * MM, "the window below a Peltier pad must have a width", 0.0))
def window_width(
    heater_form: str, peltier_length: Scalar, arc_span: Scalar, pcl_inner_radius: Scalar, window_ledge: Scalar
) -> Scalar:
    """Width of the windows below the Peltier modules, along the arc: of an arc's at its inner radius."""
    return (arc_span * pcl_inner_radius if heater_form == CUT else peltier_length) - 2.0 * window_ledge


quantities.after("mount_wall_gap")


@quantities.output("mm", at_least(0.0, "the feet must clear the Peltier pads"))
def mount_pad_gap(
    placement_radius: Scalar, mount_boss_radius: Scalar, pcl_outer_radius: Scalar, radial_clearance: Scalar
) -> Scalar:
    """Room between the mounting feet and the Peltier pads beyond the radial clearance."""
    return placement_radius - mount_boss_radius - pcl_outer_radius - radial_clearance


@quantities.output("mm", requires=WITH_CUTOUT)
def cutout_radius(heater_form: str, tile_radius: Scalar, pcl_inner_radius: Scalar, pcl_outer_radius: Scalar) -> Scalar:
    """Distance of the thermal cut-out's middle from the axis: below the middle of the window; zero without."""
    return 0.5 * (pcl_inner_radius + pcl_outer_radius) if heater_form == CUT else tile_radius


@quantities.output("mm", requires=WITH_LINER)
def liner_web(backing_depth: Scalar) -> Scalar:
    """Rotor plate above a liner; zero without."""
    return backing_depth


_KEYED = "keys of the PCL would stand in the liner: key_count 0, or liner_material: none"


@quantities.output("1", Rule(sense="<=", value=0.5, reason=_KEYED), requires=WITH_LINER)
def keys_in_liner(key_count: Scalar) -> Scalar:
    """Keys of an arc that would have to go through its liner; zero without."""
    return key_count


_CORNER = "the cutter cannot reach into its corners so deep: choose a larger corner_radius"


@quantities.output("mm", at_least(0.0, f"a pad's pocket is too deep, {_CORNER}"))
def pad_pocket_margin(corner_radius: Scalar, corner_depth_ratio: Scalar, pad_depth: Scalar) -> Scalar:
    """Depth the corners of the pads' pockets may have beyond the one they have."""
    return corner_depth_ratio * corner_radius - pad_depth


@quantities.output("mm", at_least(0.0, f"the floor below a pad is too thick, {_CORNER}"))
def window_corner_margin(corner_radius: Scalar, corner_depth_ratio: Scalar, floor_web: Scalar) -> Scalar:
    """Depth the corners of the windows may have beyond the one they have."""
    return corner_depth_ratio * corner_radius - floor_web


@quantities.output("mm", at_least(0.0, f"a liner's recess is too deep, {_CORNER}"), requires=WITH_LINER)
def liner_recess_margin(corner_radius: Scalar, corner_depth_ratio: Scalar, liner_depth: Scalar) -> Scalar:
    """Depth the corners of the liners' recesses may have beyond the one they have; zero without."""
    return corner_depth_ratio * corner_radius - liner_depth


_NARROW = "a window must be wider than the cutter of its corners: widen it, or choose a smaller corner_radius"


@quantities.output("mm", at_least(0.0, _NARROW))
def window_width_margin(window_width: Scalar, corner_radius: Scalar) -> Scalar:
    """Width of the windows at their inner radius beyond what their corners need."""
    return window_width - POCKET_WIDTH * corner_radius


@quantities.output("mm", at_least(0.0, _NARROW))
def window_depth_margin(window_depth: Scalar, corner_radius: Scalar) -> Scalar:
    """Radial width of the windows beyond what their corners need."""
    return window_depth - POCKET_WIDTH * corner_radius


@quantities.output("mm", at_least(0.0, "the windows are too narrow for the cutter to go through the floor"))
def window_pocket_margin(window_depth: Scalar, pocket_depth_ratio: Scalar, floor_web: Scalar) -> Scalar:
    """Depth the windows may have for their radial width beyond the one they have."""
    return pocket_depth_ratio * window_depth - floor_web
