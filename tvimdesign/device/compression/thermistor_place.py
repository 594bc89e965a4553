"""The thermistor by the layer: its bead stands at the outer end of the first pad or spreader, beside the block.

The pockets in the faces of a vane are open at its outer end. There the bead stands upright on the floor's level, as far
behind the face as it is thick by half, and touches the end of the pad, or of the spreader. Its wires go down through a
hole of the floor, through which it is put in.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.clearances import quantities as gaps
from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.layout import quantities as layout
from tvimdesign.device.core.mass_properties import quantities as bodies
from tvimdesign.device.table.quantity import Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import NOTHING, Section, disc_at

places, weights, rules = QuantityGroup(layout.group), QuantityGroup(bodies.group), QuantityGroup(gaps.group)
groups = (places, weights, rules)


@places.output("1")
def thermistor_count() -> Scalar:
    """Thermistors by the layer: one at the end of the first pad."""
    return 1.0


@places.output("mm")
def thermistor_seat_diameter(thermistor_diameter: Scalar, slip_clearance: Scalar) -> Scalar:
    """Diameter of the hole in the floor through which the thermistor is put in; zero without."""
    return np.fmin(thermistor_diameter + 2.0 * slip_clearance, 1e3 * thermistor_diameter)


@places.output("mm")
def thermistor_seat_radius(pcl_outer_radius: Scalar, thermistor_diameter: Scalar) -> Scalar:
    """Distance of the bead's axis from the module's: half a bead beyond the end of the pad, and behind its face."""
    half = 0.5 * thermistor_diameter
    return np.sqrt((pcl_outer_radius + half) ** 2 + half**2)


@weights.helper(default=NOTHING)
def thermistor_seat_section(thermistor_seat_diameter: Scalar, thermistor_seat_radius: Scalar) -> Section:
    """What the floor has not got for the thermistor."""
    return disc_at(0.5 * thermistor_seat_diameter, thermistor_seat_radius)


@weights.output("mm^3")
def thermistor_volume(thermistor_diameter: Scalar, thermistor_length: Scalar) -> Scalar:
    """Volume of the thermistor's bead; zero without."""
    return 0.25 * np.pi * thermistor_diameter**2 * thermistor_length


@weights.output("g")
def thermistor_mass(thermistor_volume: Scalar, thermistor_density: Scalar) -> Scalar:
    """Mass of the thermistor's bead; zero without."""
    return thermistor_volume * thermistor_density


@rules.output("mm", at_least(0.0, "the thermistor would be taller than the block: a shorter bead"))
def thermistor_height_gap(
    vane_height: Scalar, running_clearance: Scalar, thermistor_diameter: Scalar, thermistor_length: Scalar
) -> Scalar:
    """Height of the block beyond the bead's, where there is one."""
    length = np.fmin(thermistor_length, 1e3 * thermistor_diameter)
    return np.fmax(vane_height - running_clearance, 0.0) - length


@rules.output("mm", at_least(0.0, "the thermistor does not reach the pad's end: a smaller bead"))
def thermistor_end_gap(
    heater_form: str, peltier_thickness: Scalar, spreader_depth: Scalar, thermistor_diameter: Scalar
) -> Scalar:
    """Thickness of the pad, or the spreader, beyond half of the bead's, which touches it there."""
    return (peltier_thickness if heater_form == CUT else spreader_depth) - 0.5 * thermistor_diameter


@rules.output(
    "mm", at_least(0.0, "the thermistor stands out beyond the rotor plate: a wider rotor_rim, or a smaller bead")
)
def thermistor_rim_gap(rotor_rim: Scalar, thermistor_diameter: Scalar) -> Scalar:
    """Rim of the rotor plate beyond the blocks, under which the bead stands, less the bead."""
    return rotor_rim - thermistor_diameter


@rules.helper()
def thermistor_azimuth(
    vane_count: Scalar, housing_vane_angle: Scalar, pcl_outer_radius: Scalar, thermistor_diameter: Scalar
) -> Scalar:
    """Azimuth of the bead's axis [rad]: half a bead behind the face of the first vane that the first pad stands in."""
    half = 0.5 * thermistor_diameter
    return np.pi / vane_count + 0.5 * housing_vane_angle - np.arctan2(half, pcl_outer_radius + half)


@rules.output("mm", at_least(0.0, "the floor between the thermistor's hole and what is beside it is too thin"))
def thermistor_hole_gap(
    placement_radius: Scalar,
    spring_count: Scalar,
    spring_reach: Scalar,
    adjuster_radius: Scalar,
    slip_clearance: Scalar,
    tang_clearance: Scalar,
    thermistor_azimuth: Scalar,
    thermistor_seat_radius: Scalar,
    thermistor_seat_diameter: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Floor between the hole and the nearest spring's tang or adjuster's pocket, beyond the least wall where it is.

    Springs stand at azimuth 0 and evenly around, so the nearest is arccos(cos(n a))/n beside.
    """
    taken = np.fmax(spring_reach + tang_clearance, adjuster_radius + slip_clearance)
    beside = np.arccos(np.fmin(np.cos(spring_count * thermistor_azimuth), 1.0 - 1e-12)) / spring_count
    across = placement_radius * np.sin(beside)
    away = np.sqrt((placement_radius * np.cos(beside) - thermistor_seat_radius) ** 2 + across**2)
    room = np.fmax(away - taken, 0.0)
    return room - np.fmin(minimum_wall + 0.5 * thermistor_seat_diameter, room + 1e3 * thermistor_seat_diameter)
