"""The thermistor by the layer: where its bead stands, and the seat it takes out of the floor.

Below a pad of an arc's outline there is no room, so a hole goes through the floor at the end of the first arc, its
middle on the end of the pad's pocket. Half of it lies beside the pocket: there the bead stands, touching the pad's end,
its top flush with the floor, below the end of the layer. Its wires go down through the hole. Tiles leave room of their
own: the bead stands below the spreader of each arc, over the hole that is there for its wires.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.solids.shapes import NOTHING, Section, disc_at, stacked

ROOM = 2.3
"""Diameter of the seat over that of the bead: twice the bead, which stands in half of it, and what it is glued in."""

places, weights, rules = QuantityGroup("Layout"), QuantityGroup("Size and weight"), QuantityGroup("Gaps")


@places.output("1")
def thermistor_count(m: Module) -> Scalar:
    """Thermistors by the layer: one at the end of the first arc, or below the spreader of each."""
    return 1.0 if m.heater_form == CUT else m.arc_count


@places.output("mm")
def thermistor_seat_diameter(m: Module) -> Scalar:
    """Diameter of the hole for the thermistor at the end of an arc; zero without, and where tiles leave it room."""
    return ROOM * m.thermistor_diameter if m.heater_form == CUT else 0.0


@places.output("mm")
def thermistor_seat_radius(m: Module) -> Scalar:
    """Distance of that hole from the axis: the middle of the arc's width."""
    return 0.5 * (m.pcl_inner_radius + m.pcl_outer_radius)


@weights.helper(default=NOTHING)
def thermistor_seat_moments(m: Module) -> Section:
    """Volume of the thermistor's seat in the floor, half of it beside the pocket, and its polar moment.

    The end of a pocket points to the axis, so either half of the hole has half of its polar moment.
    """
    whole = disc_at(0.5 * m.thermistor_seat_diameter, m.thermistor_seat_radius)
    return stacked((whole.times(0.5), m.pad_depth), (whole, m.floor_web))


@weights.output("mm^3")
def thermistor_volume(m: Module) -> Scalar:
    """Volume of all thermistor beads together; zero without."""
    return m.thermistor_count * 0.25 * np.pi * m.thermistor_diameter**2 * m.thermistor_length


@rules.output(
    "mm",
    at_least(0.0, "the thermistor's seat leaves too thin a web to the window: a smaller bead, or a wider window_ledge"),
)
def thermistor_window_gap(m: Module) -> Scalar:
    """Web between the thermistor's seat and the window below the pad, beyond the least wall where there is a seat."""
    ledge = m.thermistor_seat_radius * np.sin((m.window_ledge + m.slip_clearance) / m.pcl_inner_radius)
    wall = np.fmin(m.hole_wall, m.thermistor_seat_diameter)
    return np.fmax(ledge, wall) - wall - 0.5 * m.thermistor_seat_diameter


@rules.output(
    "mm", at_least(0.0, "the thermistor's seat leaves too thin a web to the next arc: a smaller bead, or shorter arcs")
)
def thermistor_arc_gap(m: Module) -> Scalar:
    """Web between the thermistor's seat and the next arc's pocket, beyond the least wall where there is a seat."""
    to_next = m.thermistor_seat_radius * np.sin(np.fmin(2.0 * np.pi / m.arc_count - m.pocket_span, 0.5 * np.pi))
    wall = np.fmin(m.hole_wall, m.thermistor_seat_diameter)
    return np.fmax(to_next, wall) - wall - 0.5 * m.thermistor_seat_diameter
