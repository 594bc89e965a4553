"""Load sharing of a bonded layer between sheets that stretch: at edges, over a window, and in a recess.

Sources: [V] Volkersen, Die Nietkraftverteilung in zugbeanspruchten Nietverbindungen mit konstanten
Laschenquerschnitten, Luftfahrtforschung 15 (1938) 41-47; the same differential equation for a sheet over a window,
with no support below.

A soft sheet in a recess of stiff metal is sheared by a layer on its face, and gives less at the recess's walls. It is
glued to the recess's bottom and walls. A layer of G_p/t_p per area shears its face along a wall, so that it moves as a
harmonic function: 0 on the bottom and at the wall, and on the face as heat goes through a surface resistance. With h =
(G_p/t_p)(t/G) of a sheet of the thickness t, the layer's traction at x t from the wall is

tau(x)/tau(far) = 1 + h sum_n c_n exp(-q_n x),  c_n = 2 (1 + h)/(q_n^2 + h^2 + h),  q_n cot q_n = -h.

Source: Carslaw and Jaeger, Conduction of Heat in Solids, 2nd edition, 1959, sections 3.9 and 5.3 (a strip with one face
that radiates, and its roots).
"""

from __future__ import annotations

from typing import Any

import numpy as np


def lag(layer: Any, first: Any, second: Any, width: Any) -> Any:
    """Return how far from stiff the sheets of a lap are [1], p: p^2 = k (a_1 + a_2) w^2 [V].

    `layer` is the stiffness k of the layer per area [Pa/m], `first` and `second` the compliance a of the sheets that
    load comes in and goes out by, 1/(G h) [1/(Pa*m)].
    """
    return np.sqrt(layer * (first + second)) * width


def edge_rise(layer: Any, first: Any, second: Any, width: Any) -> Any:
    """Return the traction where the second sheet leaves the lap, over its mean [1]: p ((1 - c) coth p + c/sinh p) [V].

    p is the `lag` and c = a_1/(a_1 + a_2).
    """
    reach = lag(layer, first, second, width)
    share = first / (first + second)
    return reach * ((1.0 - share) / np.tanh(reach) + share / np.sinh(reach))


WINDOWED = 3.09
"""Rise of a floor's compliance as a sheet as windows cut it; calibrated to validation/fe_structure."""


def arc_edge_rise(layer: Any, plate: Any, floor: Any, radii: tuple[Any, Any], held: Any) -> Any:
    """Return the traction along the outer edge of an arc over T r/J [1]: 1/held + (`edge_rise` - 1) (a/b)^3.

    The arc reaches from a to b, the `radii`. A torque turns a sheet by 1/r^3, so that at b it stretches less by (a/b)^3
    than at a. `held` is the share [1] of the layer that what lies below it holds: the rest is above windows and bears
    little. `plate` and `floor` are sheets as of `lag`; the floor's compliance counts 3.09 times. FE of 30 layers:
    within 7 %.
    """
    inner, outer = radii
    rise = edge_rise(held * layer, plate, WINDOWED * floor, outer - inner)
    return 1.0 / held + (rise - 1.0) * (inner / outer) ** 3


def borne_over_window(layer: Any, sheet: Any, half_width: Any) -> Any:
    """Return the share [1] of its load that a layer still bears above a window under its sheet, tanh(x)/x, x^2 = k a
    b^2.

    The sheet is held along both rims of the window alone, a width 2b apart; `layer` and `sheet` as of `edge_rise`.
    """
    reach = np.sqrt(layer * sheet * half_width**2 + 1e-12)
    return np.tanh(reach) / reach


FRINGE = 2.0 * np.log(2.0) / np.pi
"""Width over a pad's thickness that the rim of a wide window holds besides, where it is sheared along that rim."""


def end_fringe(shear_modulus: Any, bulk_modulus: Any) -> Any:
    """Return the fringe at an end of a window, where a pad is sheared across the rim [1]: 1 - 1.9 G/(K + 7 G/3).

    A pad that keeps its volume cannot be drawn in or pressed together there. Strips in plane strain, solved by numbers
    (validation/fe_structure/windows.csv): within 0.04, beside ledges of three thicknesses 0.06; K from 5 G/3, Poisson's
    ratio of a quarter, which is the least that counts.
    """
    bulk = np.fmax(bulk_modulus, 5.0 / 3.0 * shear_modulus)
    return 1.0 - 1.9 * shear_modulus / (bulk + 7.0 / 3.0 * shear_modulus)


def held_over_window(thickness: Any, half_width: Any, fringe: Any = FRINGE) -> Any:
    """Return the share of a pad [1] that is held as if no window were below it, 1 - ln cosh(x)/x, x = ln 2 b/(f t).

    A pad of the thickness t on the rims of a window 2b wide, sheared along the rims by what is stiff on it, moves as a
    harmonic function over its section: held below but for the window, which is free. The flow from a strip's upper face
    to the lower one beyond a free stretch is that to the middle of a strip line of no thickness; a free stretch takes
    of it what one of the width (2t/pi) ln cosh(x) does. Source: S. B. Cohn, IRE Trans. Microwave
    Theory Tech. 2 (1954) 52-57, whose fringe f of 2 ln 2/pi is that of a wide window. Sheared across them it has
    another (`end_fringe`).
    """
    reach = np.sqrt((np.log(2.0) * half_width / (fringe * thickness)) ** 2 + 1e-12)
    return 1.0 - (reach + np.log(0.5 + 0.5 * np.exp(-2.0 * reach))) / reach


TERMS = 12
"""Of the sum; what they leave out of a mean over a tenth of a thickness from the wall on is a five-hundredth of h."""
_PASSES = 4
"""Of the roots' iteration."""


def _terms(held: Any) -> list[tuple[Any, Any]]:
    """Return each c_n and q_n."""
    terms = []
    for number in range(TERMS):
        half = (number + 0.5) * np.pi
        root = half
        for _ in range(_PASSES):
            root = half + np.arctan(held / root)
        terms.append((2.0 * (1.0 + held) / (root**2 + held**2 + held), root))
    return terms


def rim_rise(held: Any, reach: Any) -> Any:
    """Return the layer's traction over that far from the wall, a mean from the wall to `reach` thicknesses of the sheet
    [1].

    `held` is h, what the sheet gives over what the layer gives [1].
    """
    shares = [share * (1.0 - np.exp(-root * reach)) / (root * reach) for share, root in _terms(held)]
    return 1.0 + held * sum(shares)


def rim_width(held: Any) -> Any:
    """Return the width over the sheet's thickness [1] of plain layer that bears as much as what is gained beside a
    wall."""
    return held * sum(share / root for share, root in _terms(held))
