"""Shape factors of heat at edges, steps, ledges, fins and slabs, and of current under a comb of electrodes.

By separation of variables and maps of the plane (Carslaw and Jaeger, Conduction of Heat in Solids, ch. V; Incropera,
Fundamentals of Heat and Mass Transfer, ch. 3 and 4).

A heater's current passes a layer from finger to finger of a comb on one of its faces. Fingers of either pole alternate.
Beside its feet the current fills the depth, where the fingers are a depth apart or more. What a foot adds is found by
conformal mapping: zeta = cosh(pi z/t) takes half a finger's end of the layer to a half-plane, in which the finger is
the interval from 1 to cosh(pi b/t) and the far layer is infinity; the logarithmic capacity of an interval, a quarter of
its length, gives the resistance.

A slab may be one body: heat through one face, or a part of it, changes another's temperature (Fourier's parabola of an
evenly heated slab, ch. III).
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tvimdesign.physics.heat_flow.lumps import Link, Place, Surface, surface_coefficient

ZETA_3 = 1.2020569032
INTO_SLOT = 0.2619
"""Heat per length over k and excess that leaves a warm wall above the slot's mouth for the slot: ln(1/0.4392)/pi, where
0.4392 is the mouth's height in the map of `gap_end`, the root of sqrt(1 + u) = artanh(1/sqrt(1 + u))."""
BEFORE_SLOT = 0.27993
"""Loss of `gap_end_depth` by a narrow slot, per its width over the gap's: 2/pi^2 times the integral of p coth p up to
1.19968, where p = coth p."""
FALLING = 12.0  # Heat of a layer in all over its `gap_end_depth`, where it gives 2 (1 - y/t) of that at each height y/t


def gap_end(slot: Any) -> tuple[Any, Any]:
    """Return the shape factors [1] from the end of a gap to its two walls, heat per length over k and the end's excess.

    The end of a gap between walls of one temperature is warmer than they are by 1 at the one wall, falling evenly to 0
    at the other. Its series of sines, 2/(n pi) sin(n pi y/t), brings 2/pi (1 + 1/2 + 1/3 + ...) to the first wall and
    2/pi (1 - 1/2 + 1/3 - ...) = 2/pi ln 2 to the second (by separation of variables, Carslaw and Jaeger, Conduction of
    Heat in Solids, ch. V). The first sum has no end. It ends at the `slot` between the end and that wall's own edge,
    over t: by a Schwarz-Christoffel map a quarter plane g away from a warm wall takes 2/pi ln(pi R/(2 g)) over its face
    within R, which joined to the series is 2/pi ln(t/(2 g)); 0.26 more leave the end for the slot. Written with
    1 + (t/(2 g))^2, both together are within 1 % of conduction in two dimensions up to g = t/4, 3 % at 0.4 t.
    """
    return np.log(1.0 + 0.25 / slot**2) / np.pi + INTO_SLOT, 2.0 / np.pi * np.log(2.0)


def gap_end_depth(slot: Any) -> Any:
    """Return how much heat through the end of a gap lies deep in what ends there [1]: the integral of q y (t - y)/(2
    t^2) dy.

    A layer whose end loses the flux q(y) is colder in the mean by k_gap/k times that, times t over its width, than with
    q at its faces: its mean over the width has T'' = q/(k w), whatever its profile. The series of `gap_end` is
    cot(pi y/(2 t)); it gives 7 zeta(3)/(2 pi^3). Before a narrow slot g the map has the flux 1/(g s) at
    y = 2 g/pi (s - artanh(1/s)): less by 2/pi^2 times the integral of p coth p up to artanh(1/s) = s, 0.28 g/t.
    A fraction with both is within 2 % of conduction in two dimensions up to g = t/3, 3 % at 0.6 t.
    """
    whole = 3.5 * ZETA_3 / np.pi**3
    return whole / (1.0 + BEFORE_SLOT * slot / whole)


AT_WALL = 1.2  # Drop of a profile at the end where a wall takes its heat, below its mean: as `sink_of_slices` says


def sink_of_slices(deep: Any, colder: Any) -> Any:
    """Return what a layer's slices give to a wall at its end, over k/t and their excess, for the depth it comes from
    [1].

    `deep` is `WalledEnd.deep` over the layer's width w/t: how much colder its mean is than an even fall from near to
    far face. Slices that give x per excess have the profile sinh(x^1/2 (1 - y/t)), whose mean is below the even fall's
    by 1/2 - tanh(x^1/2/2)/x^1/2 = x/24 - x^2/240 + ..., here solved for x within 2 % up to 0.08. What is
    left of the excess follows from how much `colder` the layer is (`WalledEnd.colder` over the width), by a sheet too.
    """
    return 2.0 * FALLING * deep / (1.0 - 2.0 * AT_WALL * colder)


def ledge_ways(slenderness: Any) -> tuple[Any, Any]:
    """Return the ways [1] from a ledge's upper face to its mean, and on to its root, over its height: T k L/Q, heat Q,
    length L.

    A strip of the height h is heated evenly over its upper face from its free end to the width w = r h, its root, and
    goes on beyond. Its mean lies w/3 before the root. By separation of variables (Carslaw and Jaeger, ch. V) the face
    is warmer than that by the sum of 2/(n pi)^2/r - (1 - exp(-2 n pi r))/((n pi)^3 r^2), which is

        1/(3 r) - (zeta(3) - sum exp(-2 n pi r)/n^3)/(pi^3 r^2).
    """
    falling = sum(np.exp(-2.0 * n * np.pi * slenderness) / n**3 for n in (1, 2, 3))
    onto = 1.0 / (3.0 * slenderness) - (ZETA_3 - falling) / (np.pi**3 * slenderness**2)
    return onto, slenderness / 3.0


def constriction(share: Any, sheet: Any = 0.0, depth: Any = np.inf) -> Any:
    """Return what a slab resists more where only a `share` of its face up to one side is heated, evenly, times k and
    length.

    By separation of variables (Carslaw and Jaeger, ch. V) the heated share is warmer than the mean of the face by the
    sum of 2 sin^2(n pi f)/((n pi)^3 f^2), heat over k and length, in a slab deeper than a third of its height. One of a
    `depth`, over its height, has the tanh(n pi depth) less of heat along it; a `sheet` on its face, over k and height,
    n pi as much more.
    """
    waves = [n * np.pi for n in range(1, 9)]
    along = [np.tanh(wave * depth) + wave * sheet for wave in waves]
    return sum(
        2.0 * np.sin(wave * share) ** 2 / (wave**3 * share**2 * more) for wave, more in zip(waves, along, strict=True)
    )


def corner_shape(shape: Any) -> Any:
    """Return the shape factor [1] of a corner of a solid, over its conductivity, that takes heat along one face as
    `gap_end` does.

    The flux goes as 1/r from the corner on over a range of ln(R/r) = L = pi/2 of the `shape`. What comes in within r
    passes the quarter circle at r: the flux's mean of the temperature is 2 L/(3 pi k) per heat and length.
    """
    return 3.0 / shape


def way_to_faces(slenderness: Any) -> Any:
    """Return the way from where a bar has its mean temperature to its two faces, as a share of half its height H.

    A bar of the depth D = `slenderness` H that loses heat evenly over both faces, its two ends each of one temperature.
    By separation of variables (Carslaw and Jaeger, ch. V) the faces are colder than the mean by q H/k times

        sum 2/(n pi)^2 (1 - 2H/(n pi D) tanh(n pi D/(2H))),

    a third where the bar is long. From the fourth term on the hyperbolic tangent is one.
    """
    way = 2.0 / np.pi**2 * (np.pi**2 / 6.0 - sum(n**-2.0 for n in (1, 2, 3)))
    way = way - 4.0 / (np.pi**3 * slenderness) * (ZETA_3 - sum(n**-3.0 for n in (1, 2, 3)))
    for n in (1, 2, 3):
        half = 0.5 * n * np.pi * slenderness
        way = way + 2.0 / (n * np.pi) ** 2 * (1.0 - np.tanh(half) / half)
    return way


def way_in_fin(slenderness: Any) -> Any:
    """Return the way from where a fin that is heated through its face has its mean temperature to its root, over its
    length w.

    k t T'' = h (T - T_0) with T'(0) = 0 (Incropera, Fundamentals of Heat and Mass Transfer, ch. 3): the mean of the
    profile cosh is coth x/x - 1/x^2 from the root, x = w (h/k t)^(1/2); a third where the face feeds it evenly.
    """
    return 1.0 / (slenderness * np.tanh(slenderness)) - slenderness**-2.0


def uneven_way(slenderness: Any) -> Any:
    """Return the way into a strip for what differs over its height from the mean there, over that height [1]: 1/(pi
    tanh(pi r)).

    The first cosine over the height h, cos(pi y/h), falls as cosh(pi x/h) to the strip's other end at w = r h, which no
    heat passes (by separation of variables, Carslaw and Jaeger, ch. V).
    """
    return 1.0 / (np.pi * np.tanh(np.pi * slenderness))


def step(share: Any) -> Any:
    """Return what a sheet resists more where its depth steps down to a `share` of it on one side, times k and length
    [1].

    With the shares a and 1 the map of a strip with a step (Schwarz-Christoffel; Carslaw and Jaeger, ch. XVI) gives

        ((a + 1/a) ln((1 + a)/(1 - a)) - 2 ln(4 a/(1 - a^2)))/pi

    beyond what both depths resist up to the step.
    """
    rise = np.log((1.0 + share) / (1.0 - share))
    return ((share + 1.0 / share) * rise - 2.0 * np.log(4.0 * share / (1.0 - share**2))) / np.pi


def reaches(width: Any, parts: Sequence[Any]) -> tuple[Any, ...]:
    """Return what of each of several parts in a row something of a `width` lies over, smoothly as it gets wider than
    one."""
    covered: list[Any] = []
    for part in parts:
        covered.append(part * np.tanh((width - sum(covered)) / part))
    return tuple(covered)


def electrode_foot(half_width: Any, depth: Any) -> Any:
    """Return the length [m] by which the way through the depth t is longer for a foot b wide: b - 2 t/pi ln(sinh(pi
    b/(2 t))).

    From the middle of a finger to its edge; 2 ln 2/pi of the depth for a wide one. Lengths in metres.
    """
    return half_width - 2.0 * depth / np.pi * np.log(np.sinh(0.5 * np.pi * half_width / depth))


def comb_resistance(resistivity: Any, depth: Any, area: Any, gap: Any, width: Any) -> Any:
    """Return the resistance [ohm] of a layer over a comb of fingers `width` wide and a `gap` apart, r (g + 2 f) (g +
    w)/(t A).

    Gaps of the length A/(g + w) lie side by side; f is what a foot adds. Resistivity [ohm*m], lengths [m], area [m^2].
    """
    way = gap + 2.0 * electrode_foot(0.5 * width, depth)
    return resistivity * way * (gap + width) / (depth * area)


AMBIENT = ("ambient", 0)
ACROSS = 1.0 / 6.0
"""Drop of a slab's face below its mean for heat that comes in by the other, over that heat times depth over
conductivity."""


def ledge_across(slenderness: Any) -> Any:
    """Return how much colder than its mean a ledge's lower face is for heat that comes in evenly by its upper one.

    Over heat over k and length, as `shape_factors.ledge_ways`: the sum of those terms with alternating signs,

        1/(6 r) - (3/4 zeta(3) - sum (-1)^(n + 1) exp(-2 n pi r)/n^3)/(pi^3 r^2).
    """
    falling = sum((-1.0) ** (n + 1) * np.exp(-2.0 * n * np.pi * slenderness) / n**3 for n in (1, 2, 3))
    return 1.0 / (6.0 * slenderness) - (0.75 * ZETA_3 - falling) / (np.pi**3 * slenderness**2)


def through_faces(
    above: Place, body: Place, surface: Surface, ambient: Any, onto: Any, across: Any
) -> tuple[Link, Link, Link]:
    """Return the links of a body that is heated over its upper face and loses heat over its lower one, a `surface` of
    its own.

    `onto` leads from what is above to its mean [K/W]. The lower face is colder by `across` [K/W] for what comes in
    above, and the upper one warmer by as much for what leaves below:

        T_above - T = onto q + across p,    p = U (T - across q - T_ambient),

    U the surface's conductance near ambient temperature. Star to mesh; beside the surface's own loss there are links to
    the air; the one from above is negative.
    """
    outside = surface.area * surface_coefficient(surface, ambient, ambient)
    crossed = across * outside
    whole = onto - across * crossed
    return (
        Link(above, body, (1.0 + crossed) / whole),
        Link(above, AMBIENT, -crossed / whole),
        Link(body, AMBIENT, (1.0 + crossed) * crossed / whole),
    )


def beyond_constriction(share: Any, begin: Any, width: Any) -> Any:
    """Return how much warmer than its mean over the height that slab is at that side, from a place on over a width.

    Lengths over the slab's height, heat over k and length: the heated share's field is the sum of
    2 sin(n pi f)/((n pi)^2 f) exp(-n pi x) cos(n pi y).
    """
    total = 0.0
    for n in range(1, 9):
        falls = n * np.pi * width + 1e-9
        mean = np.exp(-n * np.pi * begin) * (1.0 - np.exp(-falls)) / falls
        total = total + 2.0 * np.sin(n * np.pi * share) / ((n * np.pi) ** 2 * share) * mean
    return total
