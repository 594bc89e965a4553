"""Resistance of a layer that its heater's current passes from finger to finger of a comb on one of its faces.

Fingers of either pole alternate. Beside its feet the current fills the depth, where the fingers are a depth apart or
more. What a foot adds is found by conformal mapping: zeta = cosh(pi z/t) takes half a finger's end of the layer to a
half-plane, in which the finger is the interval from 1 to cosh(pi b/t) and the far layer is infinity; the logarithmic
capacity of an interval, a quarter of its length, gives the resistance.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def foot(half_width: Any, depth: Any) -> Any:
    """Length [m] by which the way through the depth t is longer for a foot b wide: b - 2 t/pi ln(sinh(pi b/(2 t))).

    From the middle of a finger to its edge; 2 ln 2/pi of the depth for a wide one. Lengths in metres.
    """
    return half_width - 2.0 * depth / np.pi * np.log(np.sinh(0.5 * np.pi * half_width / depth))


def comb_resistance(resistivity: Any, depth: Any, area: Any, gap: Any, width: Any) -> Any:
    """Resistance [ohm] of a layer over a comb of fingers `width` wide and a `gap` apart, r (g + 2 f) (g + w)/(t A).

    Gaps of the length A/(g + w) lie side by side; f is what a foot adds. Resistivity [ohm*m], lengths [m], area [m^2].
    """
    way = gap + 2.0 * foot(0.5 * width, depth)
    return resistivity * way * (gap + width) / (depth * area)
