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

A bonded ring between sheets; a torque enters one at the inner edge: a lap joint in the round.

With F the share of the torque T that a layer of the stiffness k has handed over from one sheet to the next, up to r,
and the compliances a of its sheets, F'' - 3 F'/r = k (a_below M_below - a_above M_above)/T; F is 0 at the inner edge
and 1 at the outer, l^2 = k (a_above + a_below).
Sources: Volkersen, Luftfahrtforschung 15 (1938) 41-47, the same of a straight lap. F, but for what it is far from the
edges, is r^2 times the modified Bessel functions of order 2, here by the first term of their uniform expansion,
e^(+-p)/sqrt(q), q^2 = 4 + l^2 r^2, p' = q/r (NIST Digital Library of Mathematical Functions, 10.41), which is exact
for stiff sheets.
"""

from typing import Any, NamedTuple

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


WINDOWED = 3.09  # Rise of a floor's compliance as a sheet as windows cut it; calibrated to validation/fe_structure


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
_PASSES = 4  # Of the roots' iteration


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


NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


class Mode(NamedTuple):
    """A part of the torque that comes over from the upper sheet, besides what has far from the edges."""

    lag: Any  # Rate at which it comes over [1/m], l
    at_inner: Any  # Its share of the torque [1] at the inner edge
    at_outer: Any  # Its share at the outer edge


class AnnularLap(NamedTuple):
    """A ring over which a sheet hands a torque on."""

    modes: tuple[Mode, ...]  # Load that comes over: one mode for each layer between sheets
    upper_torque: Any  # Share n of the torque [1] that would stay in the upper sheet of a long lap
    inner: Any  # Inner radius [m]
    outer: Any  # Outer radius [m]


def annular_lap(layer: Any, upper: Any, lower: Any, radii: tuple[Any, Any], inward: Any = 0.0) -> AnnularLap:
    """Return the lap of a layer of the stiffness k per area [Pa/m] between sheets of the compliances 1/(G h)
    [1/(Pa*m)].

    Each counts with the share of the circle that it takes up. The lower sheet hands the share `inward` of the torque on
    at its inner edge, where the upper one has all of it.
    """
    both = upper + lower
    upper_torque = (1.0 - inward) * lower / both
    return AnnularLap((Mode(np.sqrt(layer * both), upper_torque - 1.0, upper_torque),), upper_torque, *radii)


def edge_rises(lap: AnnularLap, depth: Any) -> tuple[Any, Any]:
    """Return the traction at the inner and at the outer edge over T r_o/J, J the layer's polar moment, means over a
    `depth` in from them [1]."""
    a, b = lap.inner, lap.outer
    even = 0.75 * (b**4 - a**4) / b
    inner = (_upper_torque(lap, a) - _upper_torque(lap, a + depth)) / ((a + depth) ** 3 - a**3)
    outer = (_upper_torque(lap, b - depth) - _upper_torque(lap, b)) / (b**3 - (b - depth) ** 3)
    return inner * even, outer * even


def end_rise(layer: Any, sheet: Any, arc: Any, gap: Any) -> Any:
    """Return the traction at an arc's ends over its mean along a rim [1]: s (1 + m g coth(m l)), s = l/(l + g).

    A sheet that is loaded evenly all around hangs on arcs. What comes in over a gap between them goes to their ends, as
    in a bar on a foundation [V]: m^2 = k/(E h). `layer` is its k [Pa/m], `sheet` the E h [Pa*m], `arc` half the length
    l of an arc and `gap` half that of a gap, g [m].
    """
    rate = np.sqrt(layer / sheet)
    return (1.0 + rate * gap / np.tanh(rate * arc)) * arc / (arc + gap)


def upper_share(lap: AnnularLap) -> Any:
    """Return the compliance of the upper sheet over that of its ring turned inner edge against outer [1]."""
    worked = sum(weight * (torque / radius) ** 2 for weight, radius, torque, _ in _nodes(lap))  # it turns by M/r^3
    return worked * lap.inner**2 / (0.5 * (1.0 - (lap.inner / lap.outer) ** 2))


def unevenness(lap: AnnularLap) -> Any:
    """Return the mean square of the layer's traction over that of one in proportion to the radius, of the same torque
    [1]."""
    worked = sum(weight * (slope / radius) ** 2 for weight, radius, _, slope in _nodes(lap))
    return worked * (lap.outer**4 - lap.inner**4) / 4.0


def _nodes(lap: AnnularLap) -> list[tuple[Any, Any, Any, Any]]:
    """Return the weight of dr/r, radius, M/T of the upper sheet and its slope [1/m] at nodes between both edges."""
    a, b, nodes = lap.inner, lap.outer, []
    for node, weight in zip(0.5 * (1.0 + NODES), 0.5 * WEIGHTS * np.log(b / a), strict=True):
        radius = a * np.exp(node * np.log(b / a))
        stays = [_still(mode, (a, b), radius) for mode in lap.modes]
        torque = lap.upper_torque + sum(still for still, _ in stays)
        nodes.append((weight, radius, torque, sum(slope for _, slope in stays) / radius))
    return nodes


def _upper_torque(lap: AnnularLap, radius: Any) -> Any:
    """Return the share of the torque in the upper sheet at a radius [1]."""
    return lap.upper_torque + sum(_still(mode, (lap.inner, lap.outer), radius)[0] for mode in lap.modes)


def _still(mode: Mode, edges: tuple[Any, Any], radius: Any) -> tuple[Any, Any]:
    """Return what a mode leaves in the upper sheet at a radius, over the torque, and r times its slope [1]."""
    (lag, at_inner, at_outer), (a, b) = mode, edges
    ends, here, slope = (_reach(lag * a), _reach(lag * b)), _reach(lag * radius), _slope(lag * radius)
    whole = np.sinh(ends[1] - ends[0])
    came = -at_inner * (radius / a) ** 2 * np.sqrt(_slope(lag * a) / slope) / whole
    stays = at_outer * (radius / b) ** 2 * np.sqrt(_slope(lag * b) / slope) / whole
    still = came * np.sinh(ends[1] - here) - stays * np.sinh(here - ends[0])
    falls = (came * np.cosh(ends[1] - here) + stays * np.cosh(here - ends[0])) * slope
    return still, still * (2.0 - 0.5 * (lag * radius / slope) ** 2) - falls


def _slope(x: Any) -> Any:
    """Return r p' [1] at l r = x."""
    return np.sqrt(4.0 + x**2)


def _reach(x: Any) -> Any:
    """Return p [1] at l r = x, but for what does not depend on x."""
    return _slope(x) + 2.0 * np.log(x / (2.0 + _slope(x)))
