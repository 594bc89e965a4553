"""The thermistor by the layer: its bead stands at the outer end of the first pad or spreader, beside the block.

The pockets in the faces of a vane are open at its outer end. There the bead stands upright on the floor's level, as far
behind the face as it is thick by half, and touches the end of the pad, or of the spreader. Its wires go down through a
hole of the floor, through which it is put in.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.solids.shapes import NOTHING, Section, disc_at

places, weights, rules = QuantityGroup("Layout"), QuantityGroup("Size and weight"), QuantityGroup("Gaps")


@places.output("1")
def thermistor_count(_: Module) -> Scalar:
    """Thermistors by the layer: one at the end of the first pad."""
    return 1.0


@places.output("mm")
def thermistor_seat_diameter(m: Module) -> Scalar:
    """Diameter of the hole in the floor through which the thermistor is put in; zero without."""
    return np.fmin(m.thermistor_diameter + 2.0 * m.slip_clearance, 1e3 * m.thermistor_diameter)


@places.output("mm")
def thermistor_seat_radius(m: Module) -> Scalar:
    """Distance of the bead's axis from the module's: half a bead beyond the end of the pad, and behind its face."""
    half = 0.5 * m.thermistor_diameter
    return np.sqrt((m.pcl_outer_radius + half) ** 2 + half**2)


@weights.helper(default=NOTHING)
def thermistor_seat_section(m: Module) -> Section:
    """Plan view of the thermistor's hole in the floor."""
    return disc_at(0.5 * m.thermistor_seat_diameter, m.thermistor_seat_radius)


@weights.output("mm^3")
def thermistor_volume(m: Module) -> Scalar:
    """Volume of the thermistor's bead; zero without."""
    return 0.25 * np.pi * m.thermistor_diameter**2 * m.thermistor_length


@rules.output("mm", at_least(0.0, "the thermistor would be taller than the block: a shorter bead"))
def thermistor_height_gap(m: Module) -> Scalar:
    """Height of the block beyond the bead's, where there is one."""
    length = np.fmin(m.thermistor_length, 1e3 * m.thermistor_diameter)
    return np.fmax(m.vane_height - m.running_clearance, 0.0) - length


@rules.output("mm", at_least(0.0, "the thermistor does not reach the pad's end: a smaller bead"))
def thermistor_end_gap(m: Module) -> Scalar:
    """Thickness of the pad, or the spreader, beyond half of the bead's, which touches it there."""
    return (m.peltier_thickness if m.heater_form == CUT else m.spreader_depth) - 0.5 * m.thermistor_diameter


@rules.output(
    "mm", at_least(0.0, "the thermistor stands out beyond the rotor plate: a wider rotor_rim, or a smaller bead")
)
def thermistor_rim_gap(m: Module) -> Scalar:
    """Rim of the rotor plate beyond the blocks, under which the bead stands, less the bead."""
    return m.rotor_rim - m.thermistor_diameter


def _thermistor_azimuth(m: Module) -> Scalar:
    """Return the azimuth of the bead's axis [rad]: half a bead behind the face of the first vane that the first pad
    stands in."""
    half = 0.5 * m.thermistor_diameter
    return np.pi / m.vane_count + 0.5 * m.housing_vane_angle - np.arctan2(half, m.pcl_outer_radius + half)


@rules.output("mm", at_least(0.0, "the floor between the thermistor's hole and what is beside it is too thin"))
def thermistor_hole_gap(m: Module) -> Scalar:
    """Floor between the hole and the nearest spring's tang or adjuster's pocket, beyond the least wall where it is.

    Springs stand at azimuth 0 and evenly around, so the nearest is arccos(cos(n a))/n beside.
    """
    taken = np.fmax(m.spring_reach + m.tang_clearance, m.adjuster_radius + m.slip_clearance)
    beside = np.arccos(np.fmin(np.cos(m.spring_count * _thermistor_azimuth(m)), 1.0 - 1e-12)) / m.spring_count
    across = m.placement_radius * np.sin(beside)
    away = np.sqrt((m.placement_radius * np.cos(beside) - m.thermistor_seat_radius) ** 2 + across**2)
    room = np.fmax(away - taken, 0.0)
    return room - np.fmin(m.hole_wall + 0.5 * m.thermistor_seat_diameter, room + 1e3 * m.thermistor_seat_diameter)
