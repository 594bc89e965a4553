"""Lost motion: the angle the link turns to either side of its rest before the joint takes notice, by source.

What counts is there in every module from the first turn on: friction between legs and pins, play between link and
core, and play of core or bearings in the hub. Other play is reported apart. Play of a spring's tang is lost
preload, as every spring is wound one way only (`spring_play`, subtracted in `preload_margin`). Blocks leave a gap that
depends on the hold before, its load and its temperature (`backlash`). Keys lie loose in their pockets only once the
bond is gone (`key_play`).
"""

from typing import NamedTuple

import numpy as np

from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_most
from tvimdesign.physics.motions import contacts
from tvimdesign.physics.spring import pin_slip

quantities = QuantityGroup("Lost motion")

quantities.inputs()
quantities.formulas("lost_motion")


@quantities.helper(sprung=True)
def leg_friction(m: Module) -> Scalar:
    """Friction between a leg and the pin it bears on, of the rotor's material or of steel."""
    return m.pin_friction if isinstance(m.leg_pin, str) else m.leg_pin_friction


@quantities.helper(sprung=True)
def leg_wear_coefficient(m: Module) -> Scalar:
    """Volume worn off for each force and way slid [m^2/N], of such a pin."""
    return m.pin_wear_coefficient if isinstance(m.leg_pin, str) else m.leg_pin_wear_coefficient


@quantities.output("N*m", sprung=True)
def pin_friction_torque(m: Module) -> Scalar:
    """Torque by which the friction of all legs on their pins resists the rotor.

    At rest; over the stroke one hand presses harder by as much as the other presses less.
    """
    slip = pin_slip(m.pin_radius, m.placement_radius, m.leg_offset, m.pin_diameter)
    return m.spring_count * contacts.sliding_torque(m.leg_friction, m.pin_force, slip)


WEAR_STROKES = 1e6  # Full strokes to both sides for which wear counts, as fatigue does [1]


@quantities.output("mm", advice=(at_most(1e-4, "legs wear into their pins: grease them"),), sprung=True)
def pin_wear(m: Module) -> Scalar:
    """Depth that a leg wears into its pin in 1e6 full strokes to both sides, all of the wear on the pin.

    Archard's law, with the force at rest; the preload falls by this depth over the leg's arm.
    """
    slip = pin_slip(m.pin_radius, m.placement_radius, m.leg_offset, m.pin_diameter)
    volume = contacts.worn_volume(m.leg_wear_coefficient, m.pin_force, 4.0 * WEAR_STROKES * m.stroke * slip)
    return contacts.crossed_groove_depth(volume, 0.5 * m.wire_diameter, 0.5 * m.pin_diameter)


@quantities.output("1", advice=(at_most(0.5, "friction holds the soft joint far off its rest"),), sprung=True)
def friction_share(m: Module) -> Scalar:
    """Friction torque over the springs' torque at full stroke; beyond one the springs do not bring the joint back."""
    return m.friction_torque / m.spring_torque_full_stroke


class Support(NamedTuple):
    """Guide of the core in the hub [m, rad]."""

    clearance: Scalar  # Radial play in either support
    spread: Scalar  # Distance of the supports
    top: Scalar  # Level of the upper one
    tilt: Scalar  # Angle by which plate and retainer let the core lean


@quantities.helper()
def core_support(m: Module) -> Support:
    """Play and distance of what guides the core: the bore's ends, or the middles of two bearings.

    In a plain bore the plate on the hub and the retainer below stop the lean, the latter a running clearance away.
    With a wave spring between plate and hub it is the flat spring and the retainer. What reaches down from the plate
    towards the floor may touch before (`plate_lean`).
    """
    length = m.hub_top_level - m.hub_bottom_level
    if isinstance(m.bearing, str):
        free = m.running_clearance if isinstance(m.axial_preload, str) else m.stop_play + m.preload_way
        lean = np.fmin(free / (2.0 * m.hub_radius), m.plate_lean)
        return Support(m.running_clearance, length, m.hub_top_level, lean)
    # Loose in the seat outside, on the journal inside, and between the rings.
    play = 2.0 * m.seat_clearance + 0.5 * m.bearing_internal_clearance
    return Support(play, length - m.bearing_width, m.hub_top_level - 0.5 * m.bearing_width, np.inf)


@quantities.output("rad")
def bearing_play(m: Module) -> Scalar:
    """Angle a force at the link's end turns the link as the core moves aside in its bore or bearings.

    The core's shift at half the link's thickness, over the link's length.
    """
    height = m.link_bottom_level + 0.5 * m.link_thickness - m.core_support.top
    shift = contacts.overhung_shift(m.core_support.clearance, m.core_support.spread, height, m.core_support.tilt)
    return contacts.joint_play(shift, m.link_length)


@quantities.output("rad", headline=True)
def lost_motion(m: Module) -> Scalar:
    """Angle the link's end moves to either side of rest before springs or layer resist, all sources at their largest.

    Friction on the pins, play of the link on the core, and play of the core in the hub.
    """
    return m.friction_play + m.link_play + m.bearing_play


@quantities.output("1", advice=(at_most(0.5, "half the stroke may move nothing"),))
def lost_motion_share(m: Module) -> Scalar:
    """Share of the stroke that is lost motion, to either side of rest."""
    return m.lost_motion / m.stroke
