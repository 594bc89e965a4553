"""Pockets of pads and spreaders in the floor, and of liners in the rotor plate: wider than what lies in them.

A pocket has the outline of an arc, wider by `slip_clearance` on every side, so that what has that outline goes in.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.clearances import MM
from tvimdesign.device.core.clearances import quantities as gaps
from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.impedance.joint_impedance import quantities as impedance
from tvimdesign.device.core.layout import quantities as layout
from tvimdesign.device.table.quantity import Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section

places, rules = QuantityGroup(layout.group), QuantityGroup(gaps.group)
holds = QuantityGroup(impedance.group)
groups = (places, rules, holds)


@places.output("mm")
def pocket_inner_radius(pcl_inner_radius: Scalar, slip_clearance: Scalar) -> Scalar:
    """Inner radius of the pads' pockets."""
    return pcl_inner_radius - slip_clearance


@places.output("mm")
def pocket_outer_radius(pcl_outer_radius: Scalar, slip_clearance: Scalar) -> Scalar:
    """Outer radius of the pads' pockets."""
    return pcl_outer_radius + slip_clearance


@places.output("deg")
def pocket_span(arc_span: Scalar, slip_clearance: Scalar, pcl_inner_radius: Scalar) -> Scalar:
    """Angle a pad's pocket covers: at the arc's inner radius it is a slip clearance longer at each end."""
    return arc_span + 2.0 * slip_clearance / pcl_inner_radius


@rules.output("mm", at_least(0.0, "the floor between two pads' pockets is thinner than can be made: shorter arcs"))
def pocket_web_margin(
    arc_count: Scalar, pocket_span: Scalar, pocket_inner_radius: Scalar, minimum_wall: Scalar
) -> Scalar:
    """Floor between neighbouring pockets at their inner radius, beyond the process's least wall."""
    return (2.0 * np.pi / arc_count - pocket_span) * pocket_inner_radius - minimum_wall


@rules.output("mm", at_least(0.2 * MM, "a pad that lies against one wall of its pocket falls off the opposite ledge"))
def pad_ledge(heater_form: str, window_ledge: Scalar, slip_clearance: Scalar, tile_clearance: Scalar) -> Scalar:
    """Width of what a pad, or a tile, lies on beside its window when it is pushed away from there."""
    return window_ledge - (slip_clearance if heater_form == CUT else tile_clearance)


@holds.helper()
def ledge_area(
    heater_form: str, pad_section: Section, peltier_length: Scalar, peltier_width: Scalar, heater_count: Scalar,
    window_section: Section,
) -> Scalar:  # fmt: skip
    """What all pads, or tiles, lie on beside their windows [m^2]."""
    lying = pad_section.area if heater_form == CUT else heater_count * peltier_length * peltier_width
    return lying - window_section.area


@holds.output("MPa")
def ledge_tension(freezing_traction: Scalar, pcl_bond_strength: Scalar, pcl_area: Scalar, ledge_area: Scalar) -> Scalar:
    """Tension that holds the pads on their ledges while the layer freezes: the adhesive there has to bear it.

    The layer pulls with `freezing_traction`, its highest, over all of it, and with no more than its bond bears.
    """
    return np.fmin(freezing_traction, pcl_bond_strength) * pcl_area / ledge_area
