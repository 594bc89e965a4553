"""Spigot of the link: a bar across the core's end with two tapered flanks, drawn into a slot by one screw on the axis.

The core is whole below its slot, and the torque acts as far out as it goes. A square in the link's eye has a third of
the core's section, and its corners bear 3 to 10 times the pressure on its flanks (plane FE). A flank may lie half of
`slip_clearance` to either side of its place. By as much over the tangent of its angle, `spigot_room`, the link sits
higher or lower: so far above core and slot it is drawn. Torques count with what of the flanks touches at its highest.
"""

import numpy as np

from tvimdesign.device.components.dowels import CLEARANCE, DOWELS
from tvimdesign.device.table import Feature, Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics.motions.contacts import tightened_force
from tvimdesign.physics.solids import shapes, structure
from tvimdesign.physics.solids.shapes import NOTHING, Section

WITH_SPIGOT = (Feature("link_fit", DOWELS), Feature("link_fit", CLEARANCE))
places = QuantityGroup("Layout", WITH_SPIGOT)
weights = QuantityGroup("Size and weight", WITH_SPIGOT)
strengths = QuantityGroup("Impedance", WITH_SPIGOT)
rules = QuantityGroup("Gaps", WITH_SPIGOT)


places.formulas("spigot")


@places.output("mm", hidden=True)
def spigot_room(m: Module) -> Scalar:
    """Gap between link and core, and below the spigot, so that the flanks bear first; zero without."""
    return 0.5 * m.slip_clearance / np.tan(m.spigot_angle)


@places.output("mm", hidden=True)
def spigot_end_width(m: Module) -> Scalar:
    """Width of the spigot at its end; zero without."""
    return m.spigot_width - 2.0 * m.spigot_height * np.tan(m.spigot_angle)


@weights.helper(default=NOTHING)
def spigot_moments(m: Module) -> Section:
    """Volume of the spigot, by its mean width, less its screw's hole, and its polar moment about the axis."""
    bar = shapes.rectangle_at(2.0 * m.spigot_reach, 0.5 * (m.spigot_width + m.spigot_end_width), 0.0)
    return (bar - shapes.ring(0.0, 0.5 * m.link_screw_clearance)).times(m.spigot_height)


@weights.helper(default=NOTHING)
def spigot_slot_moments(m: Module) -> Section:
    """Volume of the slot in the core, by Simpson's rule, and its polar moment about the axis."""
    widths = (m.spigot_width, 0.5 * (m.spigot_width + m.spigot_end_width), m.spigot_end_width)
    first, middle, last = (shapes.bar_across(0.5 * (width - m.slip_clearance), m.core_radius) for width in widths)
    return first.plus(middle.times(4.0), last).times(m.spigot_height / 6.0)


@strengths.helper()
def spigot_stubs(m: Module) -> tuple[tuple[Scalar, ...], tuple[Scalar, ...]]:
    """Lever, width, depth of half the spigot, less its hole, and half the core to a side of the mean slot [m]."""
    lever = 2.0 * m.spigot_room + 0.5 * m.spigot_engagement
    slot = shapes.bar_across(0.5 * (m.spigot_end_width - m.slip_clearance), m.core_radius)
    beside = (np.pi * m.core_radius**2 - slot.area) / (4.0 * m.spigot_reach)
    return (lever, m.spigot_width, m.spigot_reach - 0.5 * m.link_screw_clearance), (lever, beside, m.spigot_reach)


@strengths.helper()
def wedge_stress(m: Module) -> Scalar:
    """Stress of the core beside the slot under the tightened screw, which presses both halves of either flank [Pa]."""
    force = tightened_force(m.link_clamp_stress, m.link_screw_diameter)
    force /= 4.0 * (np.sin(m.spigot_angle) + m.link_friction * np.cos(m.spigot_angle))
    return structure.stub_stress(force, *m.spigot_stubs[1])


strengths.after("core_holding_torque")
ARM = 4.0 / 3.0  # Torque over force on half of each flank and reach: a stiff bar's pressure rises evenly to its ends


@strengths.output("N*m")
def spigot_flank_holding_torque(m: Module) -> Scalar:
    """Torque that the joint hands on by `holding_safety` below the one at which the flanks' ends press in."""
    return 0.5 * ARM * m.cold_strength * m.spigot_engagement * m.spigot_reach**2 / m.holding_safety


@strengths.output("N*m")
def spigot_root_holding_torque(m: Module) -> Scalar:
    """Torque that the joint hands on by `holding_safety` below the one at which the spigot yields at the link."""
    return ARM * m.spigot_reach * m.cold_layer_strength / structure.stub_stress(m.holding_safety, *m.spigot_stubs[0])


@strengths.output("N*m")
def spigot_slot_holding_torque(m: Module) -> Scalar:
    """Torque that the joint hands on by `holding_safety` below the one at which the core yields beside the slot."""
    left = m.cold_layer_strength - m.wedge_stress
    return ARM * m.spigot_reach * left / structure.stub_stress(m.holding_safety, *m.spigot_stubs[1])


@strengths.helper()
def spigot_longer(m: Module) -> Scalar:
    """Length of core that gives as much as spigot and core beside the slot, as they bend [m]; zero without."""
    moduli = m.structure_youngs_modulus, m.structure_shear_modulus
    bent = sum(structure.stub_compliance(*moduli, *stub) for stub in m.spigot_stubs)
    return 2.0 * bent / (ARM * m.spigot_reach) ** 2 * structure.shaft_stiffness(moduli[1], m.core_radius, 1.0)


@rules.gap("the spigot's flanks would not meet: a larger spigot_height or spigot_angle")
def spigot_engagement(m: Module) -> Scalar:
    """Height of the flanks that touch when the link sits highest; zero without."""
    return m.spigot_height - 2.0 * m.spigot_room


@rules.output("1", at_least(1.0, "the screw would split the core: lower spigot_ratio, thinner screw"), default=1.0)
def spigot_wedge_safety(m: Module) -> Scalar:
    """Strength of the core beside the slot, across layers, over its stress as the screw is tightened; one without."""
    return m.cold_layer_strength / m.wedge_stress


@rules.gap("walls beside the spigot's screw or slot, or below it, are too thin, or no cutter reaches in")
def spigot_wall_margin(m: Module) -> Scalar:
    """Least wall of spigot and core beyond what is made, core above its fillet, and a cutter's reach; zero without."""
    end, below = m.spigot_end_width - m.slip_clearance, m.link_screw_mouth_level - m.rotor_top_level - m.foot_fillet
    of_core = np.fmin(np.fmin(m.core_radius - 0.5 * m.spigot_width, m.core_web) - m.minimum_wall, below)
    of_spigot = 0.5 * (end - np.fmax(m.link_screw_clearance, m.link_screw_hole)) - m.hole_wall
    return np.fmin(np.fmin(of_core, of_spigot), m.pocket_depth_ratio * end - m.spigot_height)


@rules.gap("the link screw would not hold where the link sits highest: choose a longer one")
def spigot_thread_margin(m: Module) -> Scalar:
    """Thread of the link screw beyond what holds, as the link sits highest; zero without."""
    return m.link_thread_margin - 2.0 * m.spigot_room
