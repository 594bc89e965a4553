"""Stress of tightened screws, and forces of round pegs across a joint.

A screw is loaded along and across (VDI 2230-1:2015), by its stress section. A screw's pitch follows from its tapping
drill, P = d - d_t (ISO 2306)."""

from typing import Any

import numpy as np

PITCH_DIAMETER, STRESS_DIAMETER = 0.6495, 0.9382
"""By how many pitches pitch and stress diameter are below the nominal one (ISO 724; ISO 898-1)."""
LEFT_TWIST = 0.5  # Share of the tightening's twist that counts in service, k_tau (VDI 2230-1:2015, section 5.5.2)


def stress_diameter(diameter: Any, pitch: Any) -> Any:
    """Return the diameter d_s [m] of the section that counts, d - 0.9382 P (ISO 898-1)."""
    return diameter - STRESS_DIAMETER * pitch


def stress_area(diameter: Any, pitch: Any) -> Any:
    """Return its area [m^2], pi d_s^2/4."""
    return 0.25 * np.pi * stress_diameter(diameter, pitch) ** 2


def thread_friction(nut_factor: Any, diameter: Any, pitch: Any, head_diameter: Any) -> Any:
    """Return the friction of thread and head alike [1] for which tightening takes K F d.

    M = F (0.16 P + 0.58 d_2 mu + D_h mu/2), VDI 2230-1:2015, eq. R13; `head_diameter` D_h [m] is the mean one of the
    face under the head.
    """
    flank = 0.58 * (diameter - PITCH_DIAMETER * pitch) + 0.5 * head_diameter
    return np.fmax(nut_factor * diameter - 0.16 * pitch, 0.0) / flank


def thread_torque(force: Any, diameter: Any, pitch: Any, friction: Any) -> Any:
    """Return the part of the tightening torque [N*m] that twists the screw, F (0.16 P + 0.58 d_2 mu)."""
    return force * (0.16 * pitch + 0.58 * (diameter - PITCH_DIAMETER * pitch) * friction)


def twist_stress(torque: Any, diameter: Any, pitch: Any) -> Any:
    """Return the largest shear [Pa] of a screw that is twisted, elastic, 16 M/(pi d_s^3)."""
    return 16.0 * torque / (np.pi * stress_diameter(diameter, pitch) ** 3)


def combined_stress(force: Any, across: Any, twist: Any, diameter: Any, pitch: Any) -> Any:
    """Return the equivalent stress [Pa] in service, (sigma^2 + 3 (k_tau tau + tau_q)^2)^(1/2).

    `force` [N] along the screw, tightening included; `across` [N] what friction leaves to its section, evenly over it;
    `twist` [Pa] of the tightening.
    """
    area = stress_area(diameter, pitch)
    shear = LEFT_TWIST * twist + across / area
    return np.sqrt((force / area) ** 2 + 3.0 * shear**2)


def peg_shear_force(shear_strength: Any, diameter: Any) -> Any:
    """Return the force [N] at which a peg shears off in one plane: F = tau pi d^2/4, strength [Pa] evenly over the
    section.

    Shigley, Mechanical Engineering Design, section 8-12, fasteners loaded in shear.
    """
    return shear_strength * 0.25 * np.pi * diameter**2


def peg_bearing_force(pressure: Any, diameter: Any, depth: Any) -> Any:
    """Return the force [N] at which a peg presses into its hole: F = p d h, pressure [Pa] on the projected area.

    Shigley, Mechanical Engineering Design, section 8-12, bearing of members.
    """
    return pressure * diameter * depth


def peg_rocking_force(pressure: Any, diameter: Any, height: Any, depth: Any) -> Any:
    """Return the force [N] at a `height` [m] above the mouth at which a stiff peg presses into its hole there.

    F = p d h^2/(4 h + 6 a): pressure [Pa] that rises evenly towards the mouth holds force and moment in balance
    (statics; the same as below an eccentrically loaded footing). A negative depth, no hole, gives a negative force.
    """
    deep = np.fabs(depth)
    return pressure * diameter * depth * deep / (4.0 * deep + 6.0 * height)


def peg_twist_torque(shear_strength: Any, diameter: Any, depth: Any) -> Any:
    """Return the torque [N*m] about its own axis at which a bonded peg turns in its hole: T = tau pi d^2 h/2.

    Shear stress [Pa] evenly over the peg's surface (textbook; as a shaft's bonded sleeve in Shigley, section 9-9).
    """
    return shear_strength * 0.5 * np.pi * diameter**2 * depth
