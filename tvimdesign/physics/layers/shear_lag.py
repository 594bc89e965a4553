"""How a bonded layer shares its load between sheets that stretch: at its edges, and over a window in a sheet's support.

Sources: [V] Volkersen, Die Nietkraftverteilung in zugbeanspruchten Nietverbindungen mit konstanten
Laschenquerschnitten, Luftfahrtforschung 15 (1938) 41-47; the same differential equation for a sheet over a window,
with no support below.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def edge_rise(layer: Any, first: Any, second: Any, width: Any) -> Any:
    """Traction where the second sheet leaves the lap, over its mean [1]: p ((1 - c) coth p + c/sinh p) [V].

    p^2 = k (a_1 + a_2) w^2 and c = a_1/(a_1 + a_2). `layer` is the stiffness k of the layer per area [Pa/m], `first`
    and `second` the compliance a of the sheets that load comes in and goes out by, 1/(G h) [1/(Pa*m)].
    """
    reach = np.sqrt(layer * (first + second)) * width
    share = first / (first + second)
    return reach * ((1.0 - share) / np.tanh(reach) + share / np.sinh(reach))


def borne_over_window(layer: Any, sheet: Any, half_width: Any) -> Any:
    """Share [1] of its load that a layer still bears above a window under its sheet, tanh(x)/x, x^2 = k a b^2.

    The sheet is held along both rims of the window alone, a width 2b apart; `layer` and `sheet` as of `edge_rise`.
    """
    reach = np.sqrt(layer * sheet * half_width**2 + 1e-12)
    return np.tanh(reach) / reach
