"""What must hold for the parts to go together, be made, and stay apart while they move: each quantity is a rule."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.quantity import Feature, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.springs.transmission import leg_direction, pin_distance

quantities = QuantityGroup("Gaps")


MM = 1e-3
POCKET_WIDTH = 2.1
"""Least width of a pocket over the radius of its corners [1]; assumed, 2.02 to 2.5: a cutter just as wide as its pocket
has no way to go to its size, and two round corners that meet leave no edge between them to draw."""


@quantities.output("mm", at_least(0.0, "the springs must clear the rotor plate"))
def rotor_spring_gap(
    placement_radius: Scalar, spring_reach: Scalar, rotor_radius: Scalar, radial_clearance: Scalar
) -> Scalar:
    """Room between the rotor plate and the springs beyond the radial clearance."""
    return placement_radius - spring_reach - rotor_radius - radial_clearance


@quantities.output("mm", at_least(0.0, "the rotor-side legs must pass above the rotor plate"))
def leg_rotor_gap(
    coil_end_level: Scalar, wire_diameter: Scalar, rotor_top_level: Scalar, axial_clearance: Scalar
) -> Scalar:
    """Room between the rotor-side legs and the rotor plate below them beyond the axial clearance."""
    return coil_end_level - 0.5 * wire_diameter - rotor_top_level - axial_clearance


@quantities.output("mm", at_least(0.0, "the pins must stand on the rotor plate"))
def pin_rim_gap(rotor_radius: Scalar, pin_radius: Scalar, pin_diameter: Scalar, radial_clearance: Scalar) -> Scalar:
    """Room between the pins and the rim of the rotor plate beyond the radial clearance."""
    return rotor_radius - pin_radius - 0.5 * pin_diameter - radial_clearance


@quantities.output("mm", at_least(0.0, "the legs must clear the core"))
def leg_core_gap(
    placement_radius: Scalar,
    pin_radius: Scalar,
    stroke: Scalar,
    leg_offset: Scalar,
    coil_diameter: Scalar,
    leg_length: Scalar,
    wire_diameter: Scalar,
    core_radius: Scalar,
    radial_clearance: Scalar,
) -> Scalar:
    """Room between the ends of the rotor-side legs and the core at full stroke beyond the radial clearance."""
    # At the end of the stroke that unwinds the spring its leg points nearest to the core. The axis lies `beside` the
    # leg's line and `ahead` of the leg's end, or nowhere ahead of it where the leg reaches past.
    along = leg_direction(pin_radius, placement_radius, stroke, leg_offset)
    beside = placement_radius * np.sin(along) + 0.5 * coil_diameter
    ahead = np.fmax(-placement_radius * np.cos(along) - leg_length, 0.0)
    return np.sqrt(beside**2 + ahead**2) - 0.5 * wire_diameter - core_radius - radial_clearance


@quantities.output("mm", at_least(0.5 * MM, "the leg would slip off its pin"))
def leg_overhang_margin(
    placement_radius: Scalar,
    pin_radius: Scalar,
    stroke: Scalar,
    leg_offset: Scalar,
    leg_arm: Scalar,
    leg_overhang: Scalar,
) -> Scalar:
    """Leg that is left beyond its pin at full stroke."""
    return leg_overhang + leg_arm - np.sqrt(pin_distance(pin_radius, placement_radius, stroke) ** 2 - leg_offset**2)


@quantities.output(
    "mm",
    at_least(0.0, "the tang would press on its hole as the coil winds and unwinds"),
    requires=(Feature("tang_hold", "bonded"),),
)
def tang_margin(
    tang_clearance: Scalar,
    coil_diameter: Scalar,
    coil_count: Scalar,
    spring_winding: Scalar,
    preload_angle: Scalar,
    spring_unwinding: Scalar,
) -> Scalar:
    """Play of the tang in its hole that the changing coil diameter leaves; zero where the tang is bonded."""
    turned = np.fmax(spring_winding - preload_angle, spring_unwinding)
    return tang_clearance - coil_diameter * turned / (4.0 * np.pi * coil_count)


@quantities.output("mm", at_least(1.0 * MM, "the leg must reach its pin", 0.0))
def leg_reach_gap(placement_radius: Scalar, pin_radius: Scalar, leg_offset: Scalar) -> Scalar:
    """Distance of pin and spring axis beyond the offset of the leg."""
    return placement_radius - pin_radius - leg_offset


@quantities.output("mm", at_least(0.0, "a spring needs a post inside it", 0.0))
def post_thickness(post_radius: Scalar) -> Scalar:
    """Radius of the spring posts."""
    return post_radius


@quantities.output("mm", at_least(0.0, "neighbouring springs must clear each other"))
def spring_spring_gap(
    placement_radius: Scalar, spring_count: Scalar, spring_reach: Scalar, radial_clearance: Scalar
) -> Scalar:
    """Room between neighbouring springs beyond the radial clearance."""
    return 2.0 * placement_radius * np.sin(np.pi / spring_count) - 2.0 * spring_reach - radial_clearance


@quantities.output("mm", at_least(0.0, "the retainer must stand above the ground"))
def retainer_gap(
    foot_height: Scalar,
    floor_thickness: Scalar,
    retainer_top_level: Scalar,
    retainer_thickness: Scalar,
    retainer_screw_head_height: Scalar,
) -> Scalar:
    """Room between the ground and the retainer with its screw's head."""
    return foot_height + floor_thickness + retainer_top_level - retainer_thickness - retainer_screw_head_height


@quantities.output("mm")
def link_screw_wall(
    core_radius: Scalar, journal_radius: Scalar, link_bolt_circle_radius: Scalar, link_screw_hole: Scalar
) -> Scalar:
    """Wall outside the link screws' holes of the core, and of its journal, into which they may reach."""
    return np.fmin(core_radius, journal_radius) - link_bolt_circle_radius - 0.5 * link_screw_hole


@quantities.output("mm", at_least(0.3 * MM, "the heads of the link screws must clear each other"))
def link_screw_gap(link_bolt_circle_radius: Scalar, link_screw_head: Scalar) -> Scalar:
    """Room between the heads of neighbouring link screws."""
    return np.sqrt(2.0) * link_bolt_circle_radius - link_screw_head


@quantities.output("mm", at_least(1.0 * MM, "the screw holes in the core must not meet"))
def core_web(
    link_bottom_level: Scalar,
    core_bottom_level: Scalar,
    link_screw_depth: Scalar,
    retainer_screw_depth: Scalar,
    drill_point_ratio: Scalar,
    link_screw_hole: Scalar,
    retainer_screw_hole: Scalar,
) -> Scalar:
    """Core between the holes of the link screws and that of the retainer's screw, a drill's points included."""
    points = drill_point_ratio * (link_screw_hole + retainer_screw_hole)
    return link_bottom_level - core_bottom_level - link_screw_depth - retainer_screw_depth - points


@quantities.output("mm", at_least(0.0, "the feet must stand inside the skirt"))
def mount_wall_gap(housing_inner_radius: Scalar, placement_radius: Scalar, mount_boss_radius: Scalar) -> Scalar:
    """Room between the mounting feet and the skirt."""
    return housing_inner_radius - placement_radius - mount_boss_radius
