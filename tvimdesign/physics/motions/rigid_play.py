"""How far things turn that are held with play: a loose spring on its post, a clearance joint, a loose shaft.

Rigid bodies and small angles (textbook kinematics); lengths in metres, angles in radians, to one side of the middle.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def spring_play(
    tang_clearance: Any, tang_length: Any, tang_lever: Any, post_clearance: Any, levels: tuple[Any, Any], leg_arm: Any
) -> Any:
    """Angle [rad] by which the force at the leg's end turns a loose spring at most before hole and post hold it.

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
    """Angle [rad] a part turns to either side until its pegs, on a circle of a radius, meet their holes: gap/radius."""
    return gap / radius


def overhung_shift(clearance: Any, spread: Any, height: Any, largest_tilt: Any) -> Any:
    """How far a shaft moves aside [m] at a height above its upper support, c + min(2 c/s, tilt) h.

    `clearance` is its radial play in two supports, `spread` their distance, `largest_tilt` [rad] what else stops it.
    """
    return clearance + np.fmin(2.0 * clearance / spread, largest_tilt) * height
