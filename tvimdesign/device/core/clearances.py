"""Rules for the parts to go together, be made, and stay apart while they move."""

import numpy as np

from tvimdesign.device.core.layout import LEAST_FILLET
from tvimdesign.device.table import Feature, Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics.spring import leg_direction, pin_distance

quantities = QuantityGroup("Gaps")
_FOUR = (Feature("link_fit", "spigot"),)  # Link screws: a spigot has one

MM = 1e-3
POCKET_WIDTH = 2.1
"""Least width of a pocket over the radius of its corners [1]; assumed, 2.02 to 2.5: a cutter just as wide as its pocket
has no way to go to its size, and two round corners that meet leave no edge between them to draw."""


quantities.margins("clearances")


@quantities.gap("the pins must stand on the rotor plate", sprung=True)
def pin_rim_gap(m: Module) -> Scalar:
    """Room between the pins and the rotor plate's rim beyond the radial clearance, or a boss and its fillet."""
    taken = np.fmax(0.5 * m.pin_diameter + m.radial_clearance, 0.5 * m.pin_foot_diameter + 2.0 * LEAST_FILLET)
    return m.rotor_radius - m.pin_radius - taken


@quantities.gap("the legs must clear the core", sprung=True)
def leg_core_gap(m: Module) -> Scalar:
    """Room between the ends of the rotor-side legs and the core at the stops beyond the radial clearance."""
    # At the stop that unwinds the spring its leg points nearest to the core. The axis lies `beside` the
    # leg's line and `ahead` of the leg's end, or nowhere ahead of it where the leg reaches past.
    along = leg_direction(m.pin_radius, m.placement_radius, m.stop_angle, m.leg_offset)
    beside = m.placement_radius * np.sin(along) + 0.5 * m.coil_diameter
    ahead = np.fmax(-m.placement_radius * np.cos(along) - m.leg_length, 0.0)
    return np.sqrt(beside**2 + ahead**2) - 0.5 * m.wire_diameter - m.core_radius - m.radial_clearance


@quantities.output("mm", at_least(0.5 * MM, "the leg would slip off its pin"), sprung=True)
def leg_overhang_margin(m: Module) -> Scalar:
    """Leg that is left beyond its pin at the stops."""
    return (
        m.leg_overhang
        + m.leg_arm
        - np.sqrt(pin_distance(m.pin_radius, m.placement_radius, m.stop_angle) ** 2 - m.leg_offset**2)
    )


@quantities.gap(
    "the tang would press on its hole as the coil winds and unwinds",
    requires=(Feature("tang_hold", "bonded"),),
    sprung=True,
)
def tang_margin(m: Module) -> Scalar:
    """Play of the tang in its hole that the changing coil diameter leaves; zero where the tang is bonded."""
    turned = np.fmax(m.spring_winding - m.preload_angle, m.spring_unwinding)
    return m.tang_clearance - m.coil_diameter * turned / (4.0 * np.pi * m.coil_count)


@quantities.output("mm", at_least(1.0 * MM, "the leg must reach its pin", 0.0), sprung=True)
def leg_reach_gap(m: Module) -> Scalar:
    """Distance of pin and spring axis beyond the offset of the leg."""
    return m.placement_radius - m.pin_radius - m.leg_offset


@quantities.output("mm", at_least(0.0, "a spring needs a post inside it", 0.0), sprung=True)
def post_thickness(m: Module) -> Scalar:
    """Radius of the spring posts."""
    return m.post_radius


@quantities.gap("neighbouring springs must clear each other", sprung=True)
def spring_spring_gap(m: Module) -> Scalar:
    """Room between neighbouring springs beyond the radial clearance."""
    return 2.0 * m.placement_radius * np.sin(np.pi / m.spring_count) - 2.0 * m.spring_reach - m.radial_clearance


@quantities.output("mm")
def link_screw_wall(m: Module) -> Scalar:
    """Wall outside the link screws' holes of the core, and of its journal, into which they may reach."""
    return np.fmin(m.core_radius, m.journal_radius) - m.link_bolt_circle_radius - 0.5 * m.link_screw_hole


@quantities.output("mm", at_least(0.3 * MM, "the heads of the link screws must clear each other"), requires=_FOUR)
def link_screw_gap(m: Module) -> Scalar:
    """Room between the heads of neighbouring link screws; zero of a single one."""
    return np.sqrt(2.0) * m.link_bolt_circle_radius - m.link_screw_head


@quantities.output("mm", at_least(1.0 * MM, "the screw holes in the core must not meet"))
def core_web(m: Module) -> Scalar:
    """Core between the holes of the link screws and that of the retainer's screw, a drill's points included."""
    points = m.drill_point_ratio * (m.link_screw_hole + m.retainer_screw_hole)
    return m.link_screw_mouth_level - m.core_bottom_level - m.link_screw_depth - m.retainer_screw_depth - points
