"""Friction between clamped faces and in bearings, and play of loose springs, joints and shafts.

Play: rigid bodies and small angles (textbook kinematics); lengths in metres, angles in radians, to one side of the
middle."""

from typing import Any

import numpy as np


def disc_torque(friction: Any, force: Any, inner_radius: Any, outer_radius: Any) -> Any:
    """Return the torque [N*m] at which a clamped ring slips, evenly pressed: 2/3 mu F (R^3 - r^3)/(R^2 - r^2).

    `friction` [1], `force` [N], radii [m]. Shigley, Mechanical Engineering Design, section 16-5, uniform pressure.
    """
    lever = (outer_radius**3 - inner_radius**3) / (outer_radius**2 - inner_radius**2)
    return 2.0 / 3.0 * friction * force * lever


def sliding_torque(friction: Any, force: Any, slip: Any) -> Any:
    """Return the torque [N*m] by which a sliding contact resists a rotation, mu F |ds/dtheta|.

    `force` [N] presses the contact together, `slip` [m/rad] is how far it slides for each radian. Virtual work: what
    the torque does is what the friction takes.
    """
    return friction * force * slip


def worn_volume(coefficient: Any, force: Any, way: Any) -> Any:
    """Return the volume [m^3] that a sliding contact wears off, k F s (Archard, J. Appl. Phys. 24 (1953) 981).

    `coefficient` [m^2/N] is the volume for each newton and metre, `force` [N], `way` [m] slid in all.
    """
    return coefficient * force * way


def crossed_groove_depth(volume: Any, radius: Any, other_radius: Any) -> Any:
    """Return the depth [m] of the groove that a round wire of a radius wears across a pin, sqrt(V/(pi sqrt(r R))).

    Near their contact crossed cylinders are x^2/2r + y^2/2R apart: up to a depth h lies the volume pi h^2 sqrt(r R).
    """
    return np.sqrt(volume / (np.pi * np.sqrt(radius * other_radius)))


def bolted_torque(friction: Any, force: Any, count: Any, radius: Any) -> Any:
    """Return the torque [N*m] at which a flange slips under its screws, n mu F r; each clamps with `force` [N] at
    `radius` [m].

    Shigley, Mechanical Engineering Design, section 8-12: a joint that holds by friction.
    """
    return count * friction * force * radius


def tightened_force(stress: Any, diameter: Any) -> Any:
    """Return the force [N] of a screw tightened to a stress [Pa] over its nominal section, sigma pi d^2/4."""
    return stress * 0.25 * np.pi * diameter**2


def tightening_torque(force: Any, diameter: Any, nut_factor: Any) -> Any:
    """Return the torque [N*m] that tightens a screw to a force, K F d.

    `force` [N], nominal `diameter` [m], `nut_factor` K [1]. Shigley, Mechanical Engineering Design, 10th ed., eq. 8-27.
    """
    return nut_factor * force * diameter


def journal_torque(friction: Any, force: Any, diameter: Any) -> Any:
    """Return the torque [N*m] with which a loaded bearing or bore resists turning, 0.5 mu F d.

    `friction` [1], `force` [N], `diameter` of the bearing's bore [m]. SKF, Rolling bearings (catalogue), friction: the
    estimate with a constant coefficient; for a plain bore Coulomb's law.
    """
    return 0.5 * friction * force * diameter


def equivalent_damping(torque: Any, angular_frequency: Any, amplitude: Any) -> Any:
    """Return the viscous damping that loses as much in a cycle as a friction torque, 4 T/(pi omega theta) [N*m*s/rad].

    Den Hartog, Mechanical Vibrations, section 8-9; `angular_frequency` [rad/s], `amplitude` [rad].
    """
    return 4.0 * torque / (np.pi * angular_frequency * amplitude)


def loaded_damping(share: Any, stiffness: Any, loss_stiffness: Any, angular_frequency: Any) -> Any:
    """Return the viscous damping that loses as much in a cycle as friction that grows with the load [N*m*s/rad].

    The friction torque is `share` [1] of the load's |K theta_0 sin(omega t + delta)|, delta = atan(K''/K'). Times the
    speed and summed up over a cycle that is 2 share |K| theta_0^2 (cos delta + delta sin delta): half of what a
    constant friction takes where the load is a spring, pi/4 of it where the load is a dashpot.
    """
    phase = np.arctan2(loss_stiffness, stiffness)
    size = np.sqrt(stiffness**2 + loss_stiffness**2)
    return 2.0 * share * size * (np.cos(phase) + phase * np.sin(phase)) / (np.pi * angular_frequency)


def spring_play(
    tang_clearance: Any, tang_length: Any, tang_lever: Any, post_clearance: Any, levels: tuple[Any, Any], leg_arm: Any
) -> Any:
    """Return the angle [rad] by which the force at the leg's end turns a loose spring at most before hole and post hold
    it.

    (c + e + a z_0)/R + e/l with the lean a = min(2 c/L, 2 e/(z_1 - z_0)). The tang, at R from the axis, has the play c
    to each side over its length L; the coil has e around its post between the levels z_0 and z_1 above the hole; the
    leg bears at the arm l. The first term turns the coil: tang against its hole, lower coil against the post, and
    both apart by the lean. The second moves its upper end across the post towards the pin. An upper bound, each term
    at its largest; rigid without lean it is (c + e)/R.
    """
    start, end = levels
    lean = np.fmin(2.0 * tang_clearance / tang_length, 2.0 * post_clearance / (end - start))
    return (tang_clearance + post_clearance + lean * start) / tang_lever + post_clearance / leg_arm


def joint_play(gap: Any, radius: Any) -> Any:
    """Return the angle [rad] a part turns to either side until its pegs, on a circle of a radius, meet their holes:
    gap/radius."""
    return gap / radius


def overhung_shift(clearance: Any, spread: Any, height: Any, largest_tilt: Any) -> Any:
    """Return how far a shaft moves aside [m] at a height above its upper support, c + min(2 c/s, tilt) h.

    `clearance` is its radial play in two supports, `spread` their distance, `largest_tilt` [rad] what else stops it.
    """
    return clearance + np.fmin(2.0 * clearance / spread, largest_tilt) * height
