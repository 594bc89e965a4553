"""Stress of a plate beside the core that turns it, a mean over its thickness and a length outwards.

Sources: equilibrium; [T] Timoshenko and Goodier, Theory of Elasticity, 3rd ed. What is calibrated follows FE of the
drawn parts (validation/fe_structure).
"""

from __future__ import annotations

from typing import Any

import numpy as np

POINTS = (np.arange(64) + 0.5) / 64
"""Of the length outwards, evenly."""
ENTERS, GOES_AROUND = 1.03, 0.75
"""Rise of a plate's highest stress beside a core as the torque enters it from its face, and with the share of the polar
moment that holes cost at the core's foot (`structure.felt_at_foot`); FE of 21 plates within 6 %."""


def shear_beside_core(torque: Any, thickness: Any, radius: Any, over: Any) -> Any:
    """Return the mean shear [Pa] of a flat plate turned by a core, from its `radius` on outwards `over` a length [m].

    By equilibrium tau(r) = T/(2 pi r^2 h); its mean is T/(2 pi h r (r + l)).
    """
    return torque / (2.0 * np.pi * thickness * radius * (radius + over))


def mean_with_bending(even: Any, bent: Any) -> Any:
    """Return the mean over a plate's thickness of (s^2 + (b u)^2)^(1/2), u from 0 in its middle to 1 on its faces [Pa].

    `even` s is the same through the thickness, `bent` b is that of bending on the faces, across it; their squares add.
    The integral is ((s^2 + b^2)^(1/2) + s^2/b arsinh(b/s))/2.
    """
    ratio = bent / even
    return 0.5 * even * (np.sqrt(1.0 + ratio**2) + np.arcsinh(ratio) / ratio)


def thicker_by_fillet(thickness: float, fillet: float, over: float) -> float:
    """Return the stress of a plate `over` a length [m] outwards from a core with a fillet over that of one with a sharp
    foot [1].

    What stands on the plate bears with it, so that the stress at x is h/(h + y) of what it was, y(x) the height of a
    fillet of the radius q, q - (q^2 - (q - x)^2)^(1/2) up to x = q; its mean. Source: equilibrium.
    """
    left = np.maximum(fillet - over * POINTS, 0.0)
    return float(np.mean(thickness / (thickness + fillet - np.sqrt(fillet**2 - left**2))))


def highest_around(felt: Any) -> Any:
    """Return the highest stress around a core over the mean shear of the plate there [1]: 1.03 (1 + 0.75 w)."""
    return ENTERS * (1.0 + GOES_AROUND * felt)
