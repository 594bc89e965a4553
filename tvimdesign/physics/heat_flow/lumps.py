"""Bodies at one temperature each around the stack, what they give to one another, and surfaces that meet the air.

Surfaces lose heat by convection and grey radiation to surroundings at ambient temperature (Incropera, Fundamentals of
Heat and Mass Transfer, ch. 1). Two faces with a gap between them exchange it by conduction in the still air of the gap
and by radiation between parallel grey plates (ch. 13).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

STEFAN_BOLTZMANN = 5.670374419e-8  # W/(m^2 K^4), CODATA
STRIP, WAYS = (0.087, 0.247, 0.666), (0.029, 0.153, 0.395)
"""Three bodies in place of a strip that is heated at its edge: from that edge on their shares of it, and the way from
what comes before to each, as shares of its width.

With these a strip takes as much heat from an edge that warms up evenly as the heat equation says, within 0.6 % from a
hundredth of w^2/alpha on. Bodies with their means in their middles take 5 to 15 % too little until that time is over.
"""
BEYOND = 1.0 - sum(WAYS)
"""Way from the last of them to the strip's other edge; a steady flow has the whole width before it."""
AT_END = 1.0 - 0.5 * STRIP[-1] / BEYOND
"""Share of the way from the last of them to that edge at which their share of the strip has its mean temperature while
heat flows on steadily."""
INTO_SLOT = 0.2619
"""Heat per length over k and excess that leaves a warm wall above the slot's mouth for the slot: ln(1/0.4392)/pi, where
0.4392 is the mouth's height in the map of `gap_end`, the root of sqrt(1 + u) = artanh(1/sqrt(1 + u))."""
BEFORE_SLOT = 0.27993
"""What a narrow slot takes of `gap_end_depth` for its width over the gap's: 2/pi^2 times the integral of p coth p up to
1.19968, where p = coth p."""
FALLING = 12.0
"""What a layer gives in all over the `gap_end_depth` of it, where it gives 2 (1 - y/t) of that at each height y/t."""
ZETA_3 = 1.2020569032


class Surface(NamedTuple):
    """A surface that loses heat to ambient."""

    area: Any
    """[m^2]"""
    coefficient: Any
    """Convection [W/m^2 K]."""
    emissivity: Any = 0.0
    behind: Any = None
    """Resistance from where the body has its mean temperature to this face [m^2 K/W]; none where not given."""


NOWHERE = Surface(0.0, 0.0)


class Body(NamedTuple):
    """A body at one temperature."""

    capacity: Any
    """[J/K]"""
    surface: Surface


def less(whole: Body, parts: Sequence[Body], more_surface: Any) -> Body:
    """What is left of a body without parts that are bodies of their own, with a surface [m^2] that it has besides."""
    surface = whole.surface._replace(area=whole.surface.area + more_surface)
    return Body(whole.capacity - sum(part.capacity for part in parts), surface)


class Lump(NamedTuple):
    """A body at one temperature in a chain."""

    conductance: Any
    """To what comes before it: the plate, the lump before it, a sink's cold side [W/K]."""
    capacity: Any
    """[J/K]"""
    surface: Surface


Place = tuple[str, int]
"""Where a link ends: `ambient`, `cold`, `hot`, a `spreader` on that, `legs` (their half next to hot is 1, to cold 2),
`layer`, `liner` or `plate` of the column, the plate's first cell as its `face`, or a body `beside` or `around`, and
which."""


class Slope(NamedTuple):
    """How much warmer what the layer faces is at the layer's near end than at its far one, evenly between them."""

    warm: tuple[tuple[Place, Any], ...]
    """Places and the share of each in a mean [1]."""
    cool: Place
    share: Any
    """Of what the mean of `warm` is warmer than `cool` [1]."""


class Link(NamedTuple):
    """What conducts, and radiates, between two places; layer, liner and plate give heat evenly over their depth."""

    first: Place
    second: Place
    conductance: Any
    """[W/K]"""
    radiating_area: Any = 0.0
    """Area times exchange factor 1/(1/e + 1/e - 1) [m^2]."""
    of_layer: Any = None
    """Share of its heat [1] that the layer gives in place of `first`; none where not given."""
    slope: Slope | None = None
    """Of the second end along the layer, which is the first; even where not given."""


def surface_coefficient(surface: Surface, temperature: Any, ambient: Any) -> Any:
    """Convection and radiation together [W/m^2 K], h + e s (T^2 + T_a^2)(T + T_a), and what lies before them.

    The face is colder than the body then, by its share as with the body's temperature.
    """
    outside = surface.coefficient + _radiation(surface.emissivity, temperature, ambient)
    if surface.behind is None:
        return outside
    face = ambient + (temperature - ambient) / (1.0 + outside * surface.behind)
    outside = surface.coefficient + _radiation(surface.emissivity, face, ambient)
    return outside / (1.0 + outside * surface.behind)


def _radiation(emissivity: Any, temperature: Any, ambient: Any) -> Any:
    return emissivity * STEFAN_BOLTZMANN * (temperature**2 + ambient**2) * (temperature + ambient)


def surface_heat(surface: Surface, temperature: Any, ambient: Any) -> Any:
    """Heat lost by a surface [W]."""
    return surface.area * surface_coefficient(surface, temperature, ambient) * (temperature - ambient)


def air_gap(area: Any, width: Any, air_conductivity: Any, emissivity: Any, first: Place, second: Place) -> Link:
    """Gap of an area [m^2] and a width [m] between faces of one emissivity; its air does not move."""
    return Link(first, second, air_conductivity * area / width, area * emissivity / (2.0 - emissivity))


def link_conductance(link: Link, warm: Any, cool: Any) -> Any:
    """Conductance [W/K] of a link, k A/d + A_r s (T_1^2 + T_2^2)(T_1 + T_2), temperatures in kelvin."""
    return link.conductance + link.radiating_area * STEFAN_BOLTZMANN * (warm**2 + cool**2) * (warm + cool)


def link_heat(link: Link, warm: Any, cool: Any) -> Any:
    """Heat [W] a link passes from one temperature [K] to the other."""
    return link_conductance(link, warm, cool) * (warm - cool)


def linked(links: Sequence[Link], places: Mapping[str, Any], divided: Mapping[str, Any]) -> dict[str, list[Any]]:
    """Heat [W] that links bring to each of the `places`, by group, and to each cell of what is `divided` into cells.

    A link of what is divided takes from each cell in turn as much as that is warmer than the link's other end, and
    radiates as from their mean temperature. What the layer gives in place of a link's first end (`Link.of_layer`) comes
    from its cells, most from the first, falling evenly to nothing at its far face.
    """
    at = {**places, **{group: [np.mean(cells)] for group, cells in divided.items()}}
    if any("face" in (link.first[0], link.second[0]) for link in links):
        at["face"] = [divided["plate"][0]]
    found: dict[str, list[Any]] = {group: [0.0] * len(bodies) for group, bodies in at.items()}
    taking: dict[str, Any] = dict.fromkeys(divided, 0.0)
    for link in links:
        ends = [at[group][i] for group, i in (link.first, link.second)]
        conductance = link_conductance(link, *ends)
        for (group, i), own, other in ((link.first, *ends), (link.second, *reversed(ends))):
            if group in divided:
                found[group][0] = found[group][0] + conductance * other
                taking[group] = taking[group] + conductance
            else:
                found[group][i] = found[group][i] + conductance * (other - own)
    for group, cells in divided.items():
        found[group][0] = (found[group][0] - taking[group] * cells) / len(cells)
    if "face" in found:
        found["plate"][0] = found["plate"][0] + found["face"][0] * of_first(len(divided["plate"]))
    for link in links:
        if link.of_layer is not None:
            (group, i), count = link.first, len(divided["layer"])
            given = link.of_layer * link_heat(link, at[group][i], at[link.second[0]][link.second[1]])
            found[group][i] = found[group][i] + given
            found["layer"][0] = found["layer"][0] - given * _falling(count)
        if link.slope is not None:
            count = len(divided["layer"])
            conductance = link_conductance(link, at["layer"][0], at[link.second[0]][link.second[1]])
            found["layer"][0] = found["layer"][0] + conductance / count * risen(link.slope, at, count)
    return found


def risen(slope: Slope, places: Mapping[str, Any], count: int) -> Any:
    """How much warmer than its mean what a layer of so many cells faces is before each of them [K]."""
    warm, (group, k) = sum(share * places[of][i] for (of, i), share in slope.warm), slope.cool
    return slope.share * (warm - places[group][k]) * (0.5 - (np.arange(count) + 0.5) / count)


def of_first(count: int) -> Any:
    """One for the first of so many cells, nothing for the others."""
    return 1.0 * (np.arange(count) == 0)


def _falling(count: int) -> Any:
    """Shares of a layer's cells in what falls evenly over its depth to nothing."""
    return 2.0 * (1.0 - (np.arange(count) + 0.5) / count) / count


class Loss(NamedTuple):
    """A link by which what is beside the plate loses heat in the end."""

    link: Link
    """From a body beside the plate."""
    onward: Any
    """From the link's other end to the air [W/K]."""


def behind(link: Link, conductance: Any, ambient: Any) -> Link:
    """A link with a `conductance` [W/K] in series, which takes the share it has near ambient temperature."""
    share = 1.0 / (1.0 + link_conductance(link, ambient, ambient) / conductance)
    return link._replace(conductance=share * link.conductance, radiating_area=share * link.radiating_area)


def straightened(link: Link, warm: Any, cool: Any) -> Link:
    """A link that radiates as it does between these two temperatures [K] at all others as well."""
    return link._replace(conductance=link_conductance(link, warm, cool), radiating_area=0.0)


def cooled_through(loss: Loss, lump: Lump, ambient: Any) -> Lump:
    """A lump that also loses heat to ambient by a loss that begins at it, as near ambient temperature."""
    more = in_series(link_conductance(loss.link, ambient, ambient), loss.onward) / lump.surface.area
    return lump._replace(surface=lump.surface._replace(coefficient=lump.surface.coefficient + more))


def gap_end(slot: Any) -> tuple[Any, Any]:
    """Shape factors [1] from the end of a gap to its two walls, heat per length over k and the end's excess.

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
    """How much heat through the end of a gap lies deep in what ends there [1]: the integral of q y (t - y)/(2 t^2) dy.

    A layer whose end loses the flux q(y) is colder in the mean by k_gap/k times that, times t over its width, than with
    q at its faces: its mean over the width has T'' = q/(k w), whatever its profile. The series of `gap_end` is
    cot(pi y/(2 t)), of which 7 zeta(3)/(2 pi^3) comes. Before a narrow slot g the map has the flux 1/(g s) at
    y = 2 g/pi (s - artanh(1/s)): less by 2/pi^2 times the integral of p coth p up to artanh(1/s) = s, 0.28 g/t.
    A fraction with both is within 2 % of conduction in two dimensions up to g = t/3, 3 % at 0.6 t.
    """
    whole = 3.5 * ZETA_3 / np.pi**3
    return whole / (1.0 + BEFORE_SLOT * slot / whole)


AT_WALL = 1.2
"""How much colder a profile is at the end where a wall takes its heat than in the mean: as `sink_of_slices` says."""


def sink_of_slices(deep: Any, colder: Any) -> Any:
    """What a layer's slices give to a wall at its end, over k/t and their excess, for the depth it comes from [1].

    `deep` is `WalledEnd.deep` over the layer's width w/t: how much colder its mean is than an even fall from near to
    far face. Slices that give x per excess have the profile sinh(x^1/2 (1 - y/t)), the mean of which is below the even
    fall's by 1/2 - tanh(x^1/2/2)/x^1/2 = x/24 - x^2/240 + ..., here solved for x within 2 % up to 0.08. What is
    left of the excess follows from how much `colder` the layer is (`WalledEnd.colder` over the width), by a sheet too.
    """
    return 2.0 * FALLING * deep / (1.0 - 2.0 * AT_WALL * colder)


def ledge_ways(slenderness: Any) -> tuple[Any, Any]:
    """Ways [1] from a ledge's upper face to its mean, and on to its root, over its height: T k L/Q, heat Q, length L.

    A strip of the height h is heated evenly over its upper face from its free end to the width w = r h, its root, and
    goes on beyond. Its mean lies w/3 before the root. By separation of variables (Carslaw and Jaeger, ch. V) the face
    is warmer than that by the sum of 2/(n pi)^2/r - (1 - exp(-2 n pi r))/((n pi)^3 r^2), which is

        1/(3 r) - (zeta(3) - sum exp(-2 n pi r)/n^3)/(pi^3 r^2).
    """
    falling = sum(np.exp(-2.0 * n * np.pi * slenderness) / n**3 for n in (1, 2, 3))
    onto = 1.0 / (3.0 * slenderness) - (ZETA_3 - falling) / (np.pi**3 * slenderness**2)
    return onto, slenderness / 3.0


def constriction(share: Any, sheet: Any = 0.0, depth: Any = np.inf) -> Any:
    """What a slab resists more where only a `share` of its face up to one side is heated, evenly, times k and length.

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
    """Shape factor [1] of a corner of a solid, over its conductivity, that takes heat along one face as `gap_end` does.

    The flux goes as 1/r from the corner on over a range of ln(R/r) = L = pi/2 of the `shape`. What comes in within r
    passes the quarter circle at r: the flux's mean of the temperature is 2 L/(3 pi k) per heat and length.
    """
    return 3.0 / shape


def strip(area: Any, heat_capacity: Any, across: Any, surface: Surface) -> tuple[Lump, ...]:
    """A strip heated along its edge, in three bodies in a row from the edge on.

    Its area [m^2], its heat capacity per area [J/m^2 K], k t L/w [W/K], which conducts across its whole width, and
    what it loses to the air, for an area of one. The first body's conductance is from the edge itself.
    """
    return tuple(
        Lump(across / way, share * area * heat_capacity, surface._replace(area=share * area * surface.area))
        for share, way in zip(STRIP, WAYS, strict=True)
    )


def strip_end(surface: Surface, along: Any, onward: Any, ambient: Any) -> tuple[Surface, Any, Any]:
    """Surface of a strip's last body, its conductance [W/K] to what takes heat at the strip's end, and surface [m^2]
    that counts there.

    `along` is the conductance from the body to the end, `onward` from there. The body's part of the strip is colder
    than the body while heat flows on, by `AT_END` of what the end is: that share of its surface is at the end, which
    has a temperature between body and onward (star to delta).
    """
    end = AT_END * surface.area
    total = along + onward + end * surface_coefficient(surface, ambient, ambient)
    own = surface.area - end * (1.0 - along / total)
    return surface._replace(area=own), along * onward / total, end * onward / total


def way_to_faces(slenderness: Any) -> Any:
    """Way from where a bar has its mean temperature to its two faces, as a share of half its height H.

    A bar of the depth D = `slenderness` H that loses heat evenly over both faces, its two ends each of one temperature.
    By separation of variables (Carslaw and Jaeger, ch. V) the faces are colder than the mean by q H/k times

        sum 2/(n pi)^2 (1 - 2H/(n pi D) tanh(n pi D/(2H))),

    a third where the bar is long. From the fourth term on the hyperbolic tangent is one.
    """
    found = 2.0 / np.pi**2 * (np.pi**2 / 6.0 - sum(n**-2.0 for n in (1, 2, 3)))
    found = found - 4.0 / (np.pi**3 * slenderness) * (ZETA_3 - sum(n**-3.0 for n in (1, 2, 3)))
    for n in (1, 2, 3):
        half = 0.5 * n * np.pi * slenderness
        found = found + 2.0 / (n * np.pi) ** 2 * (1.0 - np.tanh(half) / half)
    return found


def way_in_fin(slenderness: Any) -> Any:
    """Way from where a fin that is heated through its face has its mean temperature to its root, over its length w.

    k t T'' = h (T - T_0) with T'(0) = 0 (Incropera, Fundamentals of Heat and Mass Transfer, ch. 3): the mean of the
    profile cosh is coth x/x - 1/x^2 from the root, x = w (h/k t)^(1/2); a third where the face feeds it evenly.
    """
    return 1.0 / (slenderness * np.tanh(slenderness)) - slenderness**-2.0


def uneven_way(slenderness: Any) -> Any:
    """Way into a strip for what differs over its height from the mean there, over that height [1]: 1/(pi tanh(pi r)).

    The first cosine over the height h, cos(pi y/h), falls as cosh(pi x/h) to the strip's other end at w = r h, which no
    heat passes (by separation of variables, Carslaw and Jaeger, ch. V).
    """
    return 1.0 / (np.pi * np.tanh(np.pi * slenderness))


def heated_between(across: Any, first: Any, second: Any) -> tuple[Any, Any, Any]:
    """Conductances [W/K] from the mean of an evenly heated slab to what is behind either face, and between these.

    `across` is k A/H of the whole slab, `first` and `second` lead on from its faces. A parabola from face to face with
    the mean T_m gives q_1 = 6 (T_m - T_1) - 2 (T_2 - T_1) over k A/H to the first: a star of 1/2, 1/2 and -1/6.
    """
    one, other = in_series(2.0 * across, first), in_series(2.0 * across, second)
    mean = -6.0 * across
    total = mean + one + other
    return mean * one / total, mean * other / total, one * other / total


def in_series(*conductances: Any) -> Any:
    """Conductance [W/K] of what heat passes one after the other."""
    return 1.0 / sum(1.0 / conductance for conductance in conductances)


def kept(lumps: Sequence[Lump], temperatures: Any, inflow: Any, ambient: Any) -> list[Any]:
    """Heat [W] each lump of a chain keeps when `inflow` [W] comes into the first, less what surfaces lose."""
    left = []
    for i, lump in enumerate(lumps):
        onward: Any = 0.0
        if i + 1 < len(lumps):
            onward = lumps[i + 1].conductance * (temperatures[i] - temperatures[i + 1])
        left.append(inflow - onward - surface_heat(lump.surface, temperatures[i], ambient))
        inflow = onward
    return left


def heating(lumps: Sequence[Lump | Body], watts: Sequence[Any], empty: Any) -> Any:
    """Rate [K/s] at which each lump's temperature rises; `empty` is an array of none."""
    rates = empty
    for lump, heat in zip(lumps, watts, strict=True):
        rates = np.append(rates, heat / lump.capacity)
    return rates
