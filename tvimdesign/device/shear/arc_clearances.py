"""Rules for the arcs of the shear module, the pads under them and the windows below those."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.components.cutout import WITH_CUTOUT
from tvimdesign.device.components.liner import WITH_LINER
from tvimdesign.device.core.clearances import MM, POCKET_WIDTH
from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Rule, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup

quantities = QuantityGroup("Gaps")


quantities.after("leg_reach_gap")


@quantities.output("mm", at_least(0.0, "the PCL arcs must clear the hub"))
def hub_arc_gap(m: Module) -> Scalar:
    """Room between hub and PCL arcs beyond the radial clearance."""
    return m.pcl_inner_radius - m.hub_radius - m.radial_clearance


@quantities.output("mm", at_least(3.0 * MM, "the floor needs a web between two Peltier pads", 0.0))
def arc_gap(m: Module) -> Scalar:
    """Web between neighbouring PCL arcs at their inner radius."""
    return (2.0 * np.pi / m.arc_count - m.arc_span) * m.pcl_inner_radius


@quantities.output("mm", at_least(5.0 * MM, "the Peltier pad needs its ledges and a window for its cold side", 0.0))
def arc_width(m: Module) -> Scalar:
    """Radial width of the PCL arcs."""
    return m.pcl_outer_radius - m.pcl_inner_radius


@quantities.output("mm", at_least(0.0, "a Peltier pad needs a window behind its ledges for its cold side", 0.0))
def window_depth(m: Module) -> Scalar:
    """Radial width of the windows below the Peltier modules."""
    return (m.arc_width if m.heater_form == CUT else m.peltier_width) - 2.0 * m.window_ledge


@quantities.output("mm", at_least(0.0, "there must be a floor below a Peltier pad", 0.0))
def floor_web(m: Module) -> Scalar:
    """Thickness of the floor below the Peltier pads."""
    return m.floor_thickness - m.pad_depth


@quantities.output("mm", at_least(0.0, "the floor below a Peltier pad is thinner than the process can make it"))
def floor_web_margin(m: Module) -> Scalar:
    """Floor below the Peltier pads beyond the process's least wall."""
    return m.floor_web - m.minimum_wall


@quantities.helper()
def solid_floor(m: Module) -> Scalar:
    """Floor that may be drilled into from below [m]: what is left below the pads, wherever these are."""
    return m.floor_web


@quantities.helper()
def floor_opening_radius(m: Module) -> Scalar:
    """Radius at which the openings of the floor begin [m]: the windows."""
    return m.pcl_inner_radius + m.window_ledge


quantities.after("retainer_gap")


@quantities.output("mm", at_least(2.0 * MM, "the window below a Peltier pad must have a width", 0.0))
def window_width(m: Module) -> Scalar:
    """Width of the windows below the Peltier modules, along the arc: of an arc's at its inner radius."""
    return (m.arc_span * m.pcl_inner_radius if m.heater_form == CUT else m.cold_plate_length) - 2.0 * m.window_ledge


quantities.after("mount_wall_gap")


@quantities.output("mm", at_least(0.0, "the feet must clear the Peltier pads"))
def mount_pad_gap(m: Module) -> Scalar:
    """Room between the mounting feet and the Peltier pads beyond the radial clearance."""
    return m.placement_radius - m.mount_boss_radius - m.pcl_outer_radius - m.radial_clearance


@quantities.output("mm", requires=WITH_CUTOUT)
def cutout_radius(m: Module) -> Scalar:
    """Distance of the thermal cut-out's middle from the axis: below the middle of the window; zero without."""
    return 0.5 * (m.pcl_inner_radius + m.pcl_outer_radius) if m.heater_form == CUT else m.tile_radius


@quantities.output("mm", requires=WITH_LINER)
def liner_web(m: Module) -> Scalar:
    """Rotor plate above a liner; zero without."""
    return m.backing_depth


_KEYED = "keys of the PCL would stand in the liner: key_count 0, or liner_material: none"


@quantities.output("1", Rule(sense="<=", value=0.5, reason=_KEYED), requires=WITH_LINER)
def keys_in_liner(m: Module) -> Scalar:
    """Keys of an arc that would have to go through its liner; zero without."""
    return m.key_count


_CORNER = "the cutter cannot reach into its corners so deep: choose a larger corner_radius"


@quantities.output("mm", at_least(0.0, f"a pad's pocket is too deep, {_CORNER}"))
def pad_pocket_margin(m: Module) -> Scalar:
    """Depth the corners of the pads' pockets may have beyond the one they have."""
    return m.corner_depth_ratio * m.corner_radius - m.pad_depth


@quantities.output("mm", at_least(0.0, f"the floor below a pad is too thick, {_CORNER}"))
def window_corner_margin(m: Module) -> Scalar:
    """Depth the corners of the windows may have beyond the one they have."""
    return m.corner_depth_ratio * m.corner_radius - m.floor_web


@quantities.output("mm", at_least(0.0, f"a liner's recess is too deep, {_CORNER}"), requires=WITH_LINER)
def liner_recess_margin(m: Module) -> Scalar:
    """Depth the corners of the liners' recesses may have beyond the one they have; zero without."""
    return m.corner_depth_ratio * m.corner_radius - m.liner_depth


_NARROW = "a window must be wider than the cutter of its corners: widen it, or choose a smaller corner_radius"


@quantities.output("mm", at_least(0.0, _NARROW))
def window_width_margin(m: Module) -> Scalar:
    """Width of the windows at their inner radius beyond what their corners need."""
    return m.window_width - POCKET_WIDTH * m.corner_radius


@quantities.output("mm", at_least(0.0, _NARROW))
def window_depth_margin(m: Module) -> Scalar:
    """Radial width of the windows beyond what their corners need."""
    return m.window_depth - POCKET_WIDTH * m.corner_radius


@quantities.output("mm", at_least(0.0, "the windows are too narrow for the cutter to go through the floor"))
def window_pocket_margin(m: Module) -> Scalar:
    """Depth the windows may have for their radial width beyond the one they have."""
    return m.pocket_depth_ratio * m.window_depth - m.floor_web
