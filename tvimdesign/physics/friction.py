"""Friction between clamped faces."""

from __future__ import annotations

from typing import Any


def disc_torque(friction: Any, force: Any, inner_radius: Any, outer_radius: Any) -> Any:
    """Torque [N*m] at which a clamped ring slips, evenly pressed: 2/3 mu F (R^3 - r^3)/(R^2 - r^2).

    `friction` [1], `force` [N], radii [m]. Shigley, Mechanical Engineering Design, section 16-5, uniform pressure.
    """
    lever = (outer_radius**3 - inner_radius**3) / (outer_radius**2 - inner_radius**2)
    return 2.0 / 3.0 * friction * force * lever
