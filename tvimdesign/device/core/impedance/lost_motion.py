"""Lost motion: the angle the link turns to either side of its rest before the joint takes notice, by source.

What counts is there in every module from the first turn on: friction between legs and pins, play between link and
core, and play of core or bearings in the hub. What shows otherwise is told apart. Play of a spring's tang is lost
preload, as every spring is wound one way only (`spring_play`, subtracted in `preload_margin`). Blocks leave a gap that
depends on the hold before, its load and its temperature (`backlash`). Keys lie loose in their pockets only once the
bond is gone (`key_play`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tvimdesign.base.record import Record
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.motions.friction import sliding_torque
from tvimdesign.physics.motions.rigid_play import joint_play, overhung_shift
from tvimdesign.physics.springs.transmission import pin_slip

quantities = QuantityGroup("Lost motion")

quantities.inputs()


@quantities.output("N")
def pin_force(held_spring_rate: Scalar, preload_angle: Scalar, leg_arm: Scalar) -> Scalar:
    """Force of a spring's leg on its pin at rest."""
    return held_spring_rate * preload_angle / leg_arm


@quantities.output("N*m")
def pin_friction_torque(
    spring_count: Scalar,
    pin_friction: Scalar,
    pin_force: Scalar,
    pin_radius: Scalar,
    placement_radius: Scalar,
    leg_offset: Scalar,
    pin_diameter: Scalar,
) -> Scalar:
    """Torque by which the friction of all legs on their pins resists the rotor.

    At rest; over the stroke one hand presses harder by as much as the other presses less.
    """
    slip = pin_slip(pin_radius, placement_radius, leg_offset, pin_diameter)
    return spring_count * sliding_torque(pin_friction, pin_force, slip)


@quantities.output("rad")
def friction_play(pin_friction_torque: Scalar, spring_stiffness: Scalar) -> Scalar:
    """Angle from rest within which the springs do not overcome the friction on their pins, the PCL molten."""
    return pin_friction_torque / spring_stiffness


class Support(NamedTuple):
    """How the core is guided in the hub [m, rad]."""

    clearance: Scalar
    """Radial play in either support."""
    spread: Scalar
    """Distance of the supports."""
    top: Scalar
    """Level of the upper one."""
    tilt: Scalar
    """Angle by which plate and retainer let the core lean."""


@quantities.helper()
def core_support(
    bearing: Record | str,
    axial_preload: Record | str,
    running_clearance: Scalar,
    stop_play: Scalar,
    preload_way: Scalar,
    seat_clearance: Scalar,
    bearing_internal_clearance: Scalar,
    hub_top_level: Scalar,
    hub_bottom_level: Scalar,
    bearing_width: Scalar,
    hub_radius: Scalar,
    plate_lean: Scalar,
) -> Support:
    """Play and distance of what guides the core: the bore's ends, or the middles of two bearings.

    In a plain bore the plate on the hub and the retainer below stop the lean, the latter a running clearance away.
    With a wave spring between plate and hub it is the flat spring and the retainer. What reaches down from the plate
    towards the floor may touch before (`plate_lean`).
    """
    length = hub_top_level - hub_bottom_level
    if isinstance(bearing, str):
        free = running_clearance if isinstance(axial_preload, str) else stop_play + preload_way
        lean = np.fmin(free / (2.0 * hub_radius), plate_lean)
        return Support(running_clearance, length, hub_top_level, lean)
    # Loose in the seat outside, on the journal inside, and between the rings.
    play = 2.0 * seat_clearance + 0.5 * bearing_internal_clearance
    return Support(play, length - bearing_width, hub_top_level - 0.5 * bearing_width, np.inf)


@quantities.output("rad")
def core_lean(core_support: Support) -> Scalar:
    """Angle by which the core can lean to one side in its bore or bearings."""
    return np.fmin(2.0 * core_support.clearance / core_support.spread, core_support.tilt)


@quantities.output("rad")
def bearing_play(
    core_support: Support, link_bottom_level: Scalar, link_thickness: Scalar, link_length: Scalar
) -> Scalar:
    """Angle a force at the link's end turns the link as the core moves aside in its bore or bearings.

    The core's shift at half the link's thickness, over the link's length.
    """
    height = link_bottom_level + 0.5 * link_thickness - core_support.top
    shift = overhung_shift(core_support.clearance, core_support.spread, height, core_support.tilt)
    return joint_play(shift, link_length)


@quantities.output("rad", headline=True)
def lost_motion(friction_play: Scalar, link_play: Scalar, bearing_play: Scalar) -> Scalar:
    """Angle the link's end moves to either side of rest without the joint taking notice, all sources at their largest.

    Friction on the pins, play of the link on the core, and play of the core in the hub.
    """
    return friction_play + link_play + bearing_play
