"""The thermistor by the layer: where its bead stands, and the seat it takes out of the floor.

Below a pad of an arc's outline there is no room, so a hole goes through the floor at the end of the first arc, its
middle on the end of the pad's pocket. Half of it lies beside the pocket: there the bead stands, touching the pad's end,
its top flush with the floor, below the end of the layer. Its wires go down through the hole. Tiles leave room of their
own: the bead stands below the spreader of each arc, over the hole that is there for its wires.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.clearances import quantities as gaps
from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.layout import quantities as layout
from tvimdesign.device.core.mass_properties import quantities as bodies
from tvimdesign.device.table.quantity import Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import NOTHING, Section, disc_at, stacked

ROOM = 2.3
"""Diameter of the seat over that of the bead: twice the bead, which stands in half of it, and what it is glued in."""

places, weights, rules = QuantityGroup(layout.group), QuantityGroup(bodies.group), QuantityGroup(gaps.group)
groups = (places, weights, rules)


@places.output("1")
def thermistor_count(heater_form: str, arc_count: Scalar) -> Scalar:
    """Thermistors by the layer: one at the end of the first arc, or below the spreader of each."""
    return 1.0 if heater_form == CUT else arc_count


@places.output("mm")
def thermistor_seat_diameter(heater_form: str, thermistor_diameter: Scalar) -> Scalar:
    """Diameter of the hole for the thermistor at the end of an arc; zero without, and where tiles leave it room."""
    return ROOM * thermistor_diameter if heater_form == CUT else 0.0


@places.output("mm")
def thermistor_seat_radius(pcl_inner_radius: Scalar, pcl_outer_radius: Scalar) -> Scalar:
    """Distance of that hole from the axis: the middle of the arc's width."""
    return 0.5 * (pcl_inner_radius + pcl_outer_radius)


@weights.helper(default=NOTHING)
def thermistor_seat_moments(
    thermistor_seat_diameter: Scalar, thermistor_seat_radius: Scalar, pad_depth: Scalar, floor_web: Scalar
) -> Section:
    """What the seat takes out of the floor: the half beside the pocket, and below the pocket all of it.

    The end of a pocket points to the axis, so either half of the hole has half of its polar moment.
    """
    whole = disc_at(0.5 * thermistor_seat_diameter, thermistor_seat_radius)
    return stacked((whole.times(0.5), pad_depth), (whole, floor_web))


@weights.output("mm^3")
def thermistor_volume(thermistor_count: Scalar, thermistor_diameter: Scalar, thermistor_length: Scalar) -> Scalar:
    """Volume of all thermistor beads together; zero without."""
    return thermistor_count * 0.25 * np.pi * thermistor_diameter**2 * thermistor_length


@weights.output("g")
def thermistor_mass(thermistor_volume: Scalar, thermistor_density: Scalar) -> Scalar:
    """Mass of all thermistor beads together; zero without."""
    return thermistor_volume * thermistor_density


@rules.output(
    "mm",
    at_least(0.0, "the thermistor's seat leaves too thin a web to the window: a smaller bead, or a wider window_ledge"),
)
def thermistor_window_gap(
    window_ledge: Scalar,
    slip_clearance: Scalar,
    pcl_inner_radius: Scalar,
    thermistor_seat_radius: Scalar,
    thermistor_seat_diameter: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Web between the thermistor's seat and the window below the pad, beyond the least wall where there is a seat."""
    ledge = thermistor_seat_radius * np.sin((window_ledge + slip_clearance) / pcl_inner_radius)
    wall = np.fmin(minimum_wall, thermistor_seat_diameter)
    return np.fmax(ledge, wall) - wall - 0.5 * thermistor_seat_diameter


@rules.output(
    "mm", at_least(0.0, "the thermistor's seat leaves too thin a web to the next arc: a smaller bead, or shorter arcs")
)
def thermistor_arc_gap(
    arc_count: Scalar,
    pocket_span: Scalar,
    thermistor_seat_radius: Scalar,
    thermistor_seat_diameter: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Web between the thermistor's seat and the next arc's pocket, beyond the least wall where there is a seat."""
    to_next = thermistor_seat_radius * np.sin(np.fmin(2.0 * np.pi / arc_count - pocket_span, 0.5 * np.pi))
    wall = np.fmin(minimum_wall, thermistor_seat_diameter)
    return np.fmax(to_next, wall) - wall - 0.5 * thermistor_seat_diameter
