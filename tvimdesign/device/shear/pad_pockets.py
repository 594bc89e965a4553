"""Pockets of pads and spreaders in the floor, and of liners in the rotor plate, and the level of that plate.

A pocket has the outline of an arc, wider by `slip_clearance` on every side, so that what has that outline goes in.

The rotor plate stands on the PCL layer, which lies on the floor.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.clearances import MM
from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup

places, rules = QuantityGroup("Layout"), QuantityGroup("Gaps")
holds = QuantityGroup("Impedance")


@places.output("mm")
def pocket_inner_radius(m: Module) -> Scalar:
    """Inner radius of the pads' pockets."""
    return m.pcl_inner_radius - m.slip_clearance


@places.output("mm")
def pocket_outer_radius(m: Module) -> Scalar:
    """Outer radius of the pads' pockets."""
    return m.pcl_outer_radius + m.slip_clearance


@places.output("deg")
def pocket_span(m: Module) -> Scalar:
    """Angle a pad's pocket covers: at the arc's inner radius it is a slip clearance longer at each end."""
    return m.arc_span + 2.0 * m.slip_clearance / m.pcl_inner_radius


@rules.output("mm", at_least(0.0, "the floor between two pads' pockets is thinner than can be made: shorter arcs"))
def pocket_web_margin(m: Module) -> Scalar:
    """Floor between neighbouring pockets at their inner radius, beyond the process's least wall."""
    return (2.0 * np.pi / m.arc_count - m.pocket_span) * m.pocket_inner_radius - m.minimum_wall


@rules.output("mm", at_least(0.2 * MM, "a pad that lies against one wall of its pocket falls off the opposite ledge"))
def pad_ledge(m: Module) -> Scalar:
    """Width of what a pad, or a tile, lies on beside its window when it is pushed away from there."""
    return m.window_ledge - (m.slip_clearance if m.heater_form == CUT else m.tile_clearance)


def _ledge_area(m: Module) -> Scalar:
    """Return what all pads, or tiles, lie on beside their windows [m^2]."""
    lying = m.pad_section.area if m.heater_form == CUT else m.heater_count * m.cold_plate_length * m.peltier_width
    return lying - m.window_section.area


@holds.output("MPa")
def ledge_tension(m: Module) -> Scalar:
    """Tension that holds the pads on their ledges while the layer freezes: the adhesive there has to bear it.

    The layer pulls with `freezing_traction`, its highest, over all of it, and with no more than its bond bears.
    """
    return np.fmin(m.freezing_traction, m.pcl_bond_strength) * m.pcl_area / _ledge_area(m)


levels = QuantityGroup("Layout")


@levels.output("mm", hidden=True)
def rotor_bottom_level(m: Module) -> Scalar:
    """Lower face of the rotor plate, which lies on the layer."""
    return m.pcl_thickness


@levels.helper()
def pcl_depth(m: Module) -> Scalar:
    """Way of heat and load through the PCL [m]."""
    return m.pcl_thickness
