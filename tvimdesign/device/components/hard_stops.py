"""Hard stops: two teeth of the rotor plate turn between posts of the floor, a margin beyond the stroke to either side.

They stand opposite each other, midway between springs, inside the screws that fix the housing. Posts and teeth are
sectors about the axis, so that their faces meet flat. They take the room there is, up to `stop_depth` and
`stop_length`. The stops bear the torque that the frozen joint holds, up to `load_torque`: a load that the joint bears
frozen drives it there when it softens. Two opposite posts share it: the rotor moves in its hub until both bear.
"""

import numpy as np

from tvimdesign.device.core.layout import evened_least
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.solids import structure
from tvimdesign.physics.solids.shapes import Section, sector, tooth

places = QuantityGroup("Layout")
weights = QuantityGroup("Size and weight")
strengths = QuantityGroup("Impedance")
rules = QuantityGroup("Gaps")

STOPS = 2  # Teeth of the rotor, each between two posts
SLIVER = 1e-4  # Size [m] that posts have where there is no room for them, so that the search may pass there


places.formulas("hard_stops")


@places.output("mm")
def stop_width(m: Module) -> Scalar:
    """Radial width of the stops' faces: `stop_depth`, or what the feet's holes in the cover leave."""
    room = m.placement_radius - m.mount_boss_radius - m.stop_inner_radius
    return np.fmax(evened_least(m.stop_depth, room), SLIVER)


@places.helper(sprung=True)
def stop_spring_angle(m: Module) -> Scalar:
    """Angle between a spring's azimuth and the nearest place for a stop [rad].

    At the posts' outer radius the spring with its clearance, or its adjuster's pocket, takes that much.
    """
    pocket = m.adjuster_radius + m.slip_clearance + m.minimum_running_clearance
    taken = np.fmax(m.spring_reach + m.radial_clearance, pocket)
    cosine = m.placement_radius**2 + m.stop_outer_radius**2 - taken**2
    return np.arccos(np.fmin(cosine / (2.0 * m.placement_radius * m.stop_outer_radius), 1.0 - 1e-6))


@places.output("deg")
def stop_post_span(m: Module) -> Scalar:
    """Angle that a post covers: `stop_length`, or what the springs leave."""
    room = np.pi / m.spring_count - m.stop_spring_angle - m.stop_angle - 0.5 * m.stop_tooth_span
    length = evened_least(m.stop_length, room * m.stop_contact_radius)
    return np.fmax(length, SLIVER) / m.stop_contact_radius


@weights.helper()
def stop_posts_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the stops' posts."""
    post = sector(m.stop_post_span, m.stop_inner_radius, m.stop_outer_radius)
    return post.times(2.0 * STOPS * m.rotor_top_level)


@weights.helper()
def stop_teeth_section(m: Module) -> Section:
    """Plan view of the rotor's teeth."""
    return tooth(m.stop_tooth_span, m.rotor_radius, m.stop_outer_radius, m.corner_radius).times(STOPS)


strengths.formulas("hard_stops.strengths")


@strengths.output("N")
def stop_force(m: Module) -> Scalar:
    """Force on each of two opposite posts under the torque that the frozen joint bears."""
    return m.borne_torque / (STOPS * m.stop_contact_radius)


@strengths.output("MPa")
def stop_post_stress(m: Module) -> Scalar:
    """Stress at the foot of a post under that torque: bending as a short beam, and mean shear."""
    height = m.rotor_top_level - 0.5 * m.rotor_thickness
    return structure.stub_stress(m.stop_force, height, m.stop_post_length, m.stop_width)


@strengths.output("MPa")
def stop_tooth_stress(m: Module) -> Scalar:
    """Stress at the root of a tooth under that torque: bending as a short beam, and mean shear."""
    lever = m.stop_contact_radius - m.rotor_radius
    return structure.stub_stress(m.stop_force, lever, m.stop_tooth_width, m.rotor_thickness)


PARTS = ("stop_face_safety", "stop_post_safety", "stop_tooth_safety")


strengths.margins("hard_stops.strengths")
rules.margins("hard_stops")


@rules.gap("the springs leave no room for the stops: fewer springs, or less stop_tooth_width")
def stop_length_margin(m: Module) -> Scalar:
    """Length of a post, or width of a tooth where that is less, beyond the process's least wall."""
    return np.fmin(m.stop_post_length, m.stop_tooth_width) - m.minimum_wall
