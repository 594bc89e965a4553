"""Where everything is that all modes have: the design variables, and the radii and levels that follow.

The rotor axis is z. The floor's upper face is z = 0; the rotor plate stands above it, the PCL between the two, the
torsion springs around them with their axes parallel to z. Levels below the floor are negative.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.motor_choice import Motor
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup

quantities = QuantityGroup("Layout")

quantities.inputs()


@quantities.output("1")
def spring_count(spring_pairs: Scalar) -> Scalar:
    """Torsion springs, half of them of either hand."""
    return 2.0 * spring_pairs


# --- radii -----------------------------------------------------------------------------------------------------------


@quantities.output("mm")
def pin_radius(placement_radius: Scalar, pin_radius_ratio: Scalar) -> Scalar:
    """Distance of the rotor pins from the axis."""
    return pin_radius_ratio * placement_radius


@quantities.output("mm")
def tang_bend_radius(tang_bend_ratio: Scalar, wire_diameter: Scalar) -> Scalar:
    """Mean radius of the bend between a spring's coils and its tang."""
    return (tang_bend_ratio + 0.5) * wire_diameter


@quantities.output("mm")
def spring_reach(coil_diameter: Scalar, wire_diameter: Scalar, tang_bend_radius: Scalar) -> Scalar:
    """Radius of the circle around a spring's axis that holds its coils and its tang."""
    # The tang leaves the coil along the tangent and turns down over its bend.
    return np.sqrt((0.5 * coil_diameter) ** 2 + tang_bend_radius**2) + 0.5 * wire_diameter


@quantities.output("mm")
def leg_offset(coil_diameter: Scalar, wire_diameter: Scalar, pin_diameter: Scalar) -> Scalar:
    """Distance of the spring axis from the line through the pin along which the leg points."""
    return 0.5 * (coil_diameter + wire_diameter + pin_diameter)


@quantities.output("mm")
def leg_arm(placement_radius: Scalar, pin_radius: Scalar, leg_offset: Scalar) -> Scalar:
    """Length of the rotor-side leg from the coil to the pin."""
    return np.sqrt((placement_radius - pin_radius) ** 2 - leg_offset**2)


@quantities.output("mm")
def leg_length(leg_arm: Scalar, leg_overhang: Scalar) -> Scalar:
    """Length of the rotor-side leg."""
    return leg_arm + leg_overhang


@quantities.output("mm")
def rotor_radius(pcl_outer_radius: Scalar, rotor_rim: Scalar) -> Scalar:
    """Radius of the rotor plate."""
    return pcl_outer_radius + rotor_rim


@quantities.output("mm")
def housing_inner_radius(placement_radius: Scalar, spring_reach: Scalar, radial_clearance: Scalar) -> Scalar:
    """Inner radius of the housing wall."""
    return placement_radius + spring_reach + radial_clearance


@quantities.output("mm")
def housing_outer_radius(housing_inner_radius: Scalar, wall_thickness: Scalar) -> Scalar:
    """Outer radius of the housing."""
    return housing_inner_radius + wall_thickness


@quantities.output("mm")
def link_half_width(core_radius: Scalar, link_rim: Scalar) -> Scalar:
    """Half the width of the output link."""
    return core_radius + link_rim


@quantities.output("mm")
def link_length(housing_outer_radius: Scalar, link_half_width: Scalar) -> Scalar:
    """Distance of the output link's end hole from the axis; the link's round end is flush with the housing."""
    return housing_outer_radius - link_half_width


@quantities.output("mm")
def link_bolt_circle_radius(core_radius: Scalar, link_bolt_ratio: Scalar) -> Scalar:
    """Radius of the circle of the four link screws."""
    return link_bolt_ratio * core_radius


# --- levels ----------------------------------------------------------------------------------------------------------


@quantities.output("mm")
def coil_pitch(wire_diameter: Scalar, coil_gap: Scalar) -> Scalar:
    """Axial pitch of the coils."""
    return wire_diameter + coil_gap


@quantities.output("1")
def helix_slope(coil_pitch: Scalar, coil_diameter: Scalar) -> Scalar:
    """Rise of the wire over its way around the coil, tan of the helix angle."""
    return coil_pitch / (np.pi * coil_diameter)


@quantities.output("mm")
def coil_start_level(tang_bend_radius: Scalar, helix_slope: Scalar) -> Scalar:
    """Level of the wire's centre where the coils start; the tang's bend below it ends on the floor."""
    return tang_bend_radius / np.sqrt(1.0 + helix_slope**2)


@quantities.output("mm")
def coil_end_level(coil_start_level: Scalar, coil_pitch: Scalar, coil_count: Scalar, preload_angle: Scalar) -> Scalar:
    """Level of the wire's centre where the coils of the preloaded spring end and the rotor-side leg begins."""
    return coil_start_level + coil_pitch * (coil_count + preload_angle / (2.0 * np.pi))


@quantities.output("mm")
def leg_top_level(coil_end_level: Scalar, helix_slope: Scalar, leg_length: Scalar, wire_diameter: Scalar) -> Scalar:
    """Highest point of a rotor-side leg, which keeps rising as the coil does."""
    return coil_end_level + helix_slope * leg_length + 0.5 * wire_diameter


@quantities.output("mm")
def rotor_top_level(rotor_bottom_level: Scalar, rotor_thickness: Scalar) -> Scalar:
    """Upper face of the rotor plate."""
    return rotor_bottom_level + rotor_thickness


@quantities.output("mm")
def pin_top_level(leg_top_level: Scalar, axial_clearance: Scalar) -> Scalar:
    """Upper end of the rotor pins."""
    return leg_top_level + axial_clearance


LEAST_FILLET = 1e-4
"""Fillet [m] that is drawn where there is no room for one: what a nozzle or an edge of a cutter leaves anyway."""
EVENED = 3e-4
"""Difference [m] of two rooms for the fillet below which it is smaller than either. What the fillet bears would have a
kink where one room becomes less than the other, and IPOPT went to and fro over it for 300 iterations from each start of
the study in the README."""


def evened_least(first: Scalar, second: Scalar) -> Scalar:
    """The less of two lengths [m]; where these are within w, `EVENED`, of one another, less than that by up to w/6.

    Two derivatives have no jump: min(a, b) - w/6 (1 - |a - b|/w)^3.
    """
    near = np.fmax(1.0 - np.fabs(first - second) / EVENED, 0.0)
    return np.fmin(first, second) - EVENED / 6.0 * near**3


@quantities.output("mm")
def foot_fillet(
    largest_foot_fillet: Scalar,
    coil_end_level: Scalar,
    wire_diameter: Scalar,
    rotor_top_level: Scalar,
    running_clearance: Scalar,
    rotor_radius: Scalar,
    pin_radius: Scalar,
    pin_diameter: Scalar,
    core_radius: Scalar,
) -> Scalar:
    """Radius of the fillets at the feet of the core and of the pins on the rotor plate.

    As large as is asked for, but below the legs by a running clearance, and a tenth of a millimetre short of the
    plate's rim and of half of the way between core and pins: where two circles touch no mesh closes. Where two of these
    are within 0.3 mm of one another it is up to 0.05 mm smaller (`evened_least`).
    """
    below_legs = coil_end_level - 0.5 * wire_diameter - rotor_top_level - running_clearance
    to_rim = rotor_radius - pin_radius - 0.5 * pin_diameter
    between = 0.5 * (pin_radius - 0.5 * pin_diameter - core_radius)
    room = evened_least(below_legs, evened_least(to_rim, between) - LEAST_FILLET)
    return np.fmax(evened_least(largest_foot_fillet, room), LEAST_FILLET)


@quantities.output("mm")
def link_bottom_level(rim_level: Scalar, cover_height: Scalar, axial_clearance: Scalar) -> Scalar:
    """Lower face of the output link and upper end of the core."""
    return rim_level + cover_height + axial_clearance


@quantities.output("mm")
def post_radius(spring_wound_diameter: Scalar, wire_diameter: Scalar) -> Scalar:
    """Radius of a spring's post: 90 % of the inner radius of the fully wound spring."""
    # Shigley, section 10-12: mandrel about 10 % under the inner diameter at full deflection.
    return 0.45 * (spring_wound_diameter - wire_diameter)


# --- envelope --------------------------------------------------------------------------------------------------------


@quantities.output("mm", headline=True)
def envelope_diameter(drive_motor: Motor | None, housing_outer_radius: Scalar, motor_outer_radius: Scalar) -> Scalar:
    """Diameter of the module, or of its motor where that is wider."""
    return 2.0 * (housing_outer_radius if drive_motor is None else np.fmax(housing_outer_radius, motor_outer_radius))


@quantities.output("mm", headline=True)
def envelope_height(
    foot_height: Scalar,
    floor_thickness: Scalar,
    link_bottom_level: Scalar,
    link_thickness: Scalar,
    link_screw_head_height: Scalar,
    drive_height: Scalar,
) -> Scalar:
    """Height of the module from the ground, below a motor, to the heads of the link screws."""
    below = drive_height + foot_height + floor_thickness
    return below + link_bottom_level + link_thickness + link_screw_head_height


@quantities.output("cm^3", headline=True)
def envelope_volume(envelope_diameter: Scalar, envelope_height: Scalar) -> Scalar:
    """Volume of the cylinder that holds the module."""
    return 0.25 * np.pi * envelope_diameter**2 * envelope_height
