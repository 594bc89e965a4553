"""A round peg across a joint: the force at which it shears off, and the one at which it presses into its hole."""

from __future__ import annotations

from typing import Any

import numpy as np


def shear_force(shear_strength: Any, diameter: Any) -> Any:
    """Force [N] at which a peg shears off in one plane: F = tau pi d^2/4, strength [Pa] evenly over the section.

    Shigley, Mechanical Engineering Design, section 8-12, fasteners loaded in shear.
    """
    return shear_strength * 0.25 * np.pi * diameter**2


def bearing_force(pressure: Any, diameter: Any, depth: Any) -> Any:
    """Force [N] at which a peg presses into its hole: F = p d h, pressure [Pa] on the projected area.

    Shigley, Mechanical Engineering Design, section 8-12, bearing of members.
    """
    return pressure * diameter * depth


def twist_torque(shear_strength: Any, diameter: Any, depth: Any) -> Any:
    """Torque [N*m] about its own axis at which a bonded peg turns in its hole: T = tau pi d^2 h/2.

    Shear stress [Pa] evenly over the peg's surface (textbook; as a shaft's bonded sleeve in Shigley, section 9-9).
    """
    return shear_strength * 0.5 * np.pi * diameter**2 * depth
