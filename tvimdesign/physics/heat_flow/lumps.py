"""Bodies at one temperature each around the stack, what they give to one another, and surfaces that meet the air.

Surfaces lose heat by convection and grey radiation to surroundings at ambient temperature (Incropera, Fundamentals of
Heat and Mass Transfer, ch. 1). Two faces with a gap between them exchange it by conduction in the still air of the gap
and by radiation between parallel grey plates (ch. 13).

A strip that is heated along its edge is three bodies in a row.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

STEFAN_BOLTZMANN = 5.670374419e-8  # W/(m^2 K^4), CODATA


class Surface(NamedTuple):
    """A surface that loses heat to ambient."""

    area: Any  # [m^2]
    coefficient: Any  # Convection [W/m^2 K]
    emissivity: Any = 0.0
    behind: Any = None
    """Resistance from where the body has its mean temperature to this face [m^2 K/W]; none where not given."""


NOWHERE = Surface(0.0, 0.0)


class Body(NamedTuple):
    """A body at one temperature."""

    capacity: Any  # [J/K]
    surface: Surface


def less(whole: Body, parts: Sequence[Body], more_surface: Any) -> Body:
    """Return what is left of a body without parts that are bodies of their own, with a surface [m^2] that it has
    besides."""
    surface = whole.surface._replace(area=whole.surface.area + more_surface)
    return Body(whole.capacity - sum(part.capacity for part in parts), surface)


class Lump(NamedTuple):
    """A body at one temperature in a chain."""

    conductance: Any  # To what comes before it: the plate, the lump before it, a sink's cold side [W/K]
    capacity: Any  # [J/K]
    surface: Surface


Place = tuple[str, int]
"""Where a link ends: `ambient`, `cold`, `hot`, a `spreader` on that, `legs` (their half next to hot is 1, to cold 2),
`layer`, `liner` or `plate` of the column, the plate's first cell as its `face`, or a body `beside` or `around`, and
which."""


class Slope(NamedTuple):
    """Rise of the temperature that the layer faces, from its far end to its near one, even between them."""

    warm: tuple[tuple[Place, Any], ...]  # Places and the share of each in a mean [1]
    cool: Place
    share: Any  # Of what the mean of `warm` is warmer than `cool` [1]


class Link(NamedTuple):
    """Conduction and radiation between two places; layer, liner and plate give heat evenly over their depth."""

    first: Place
    second: Place
    conductance: Any  # [W/K]
    radiating_area: Any = 0.0  # Area times exchange factor 1/(1/e + 1/e - 1) [m^2]
    of_layer: Any = None  # Share of its heat [1] that the layer gives in place of `first`; none where not given
    slope: Slope | None = None  # Of the second end along the layer, which is the first; even where not given


def surface_coefficient(surface: Surface, temperature: Any, ambient: Any) -> Any:
    """Return the convection and radiation together [W/m^2 K], h + e s (T^2 + T_a^2)(T + T_a), and what lies before
    them.

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
    """Return the heat lost by a surface [W]."""
    return surface.area * surface_coefficient(surface, temperature, ambient) * (temperature - ambient)


def air_gap(area: Any, width: Any, air_conductivity: Any, emissivity: Any, first: Place, second: Place) -> Link:
    """Return the gap of an area [m^2] and a width [m] between faces of one emissivity; its air does not move."""
    return Link(first, second, air_conductivity * area / width, area * emissivity / (2.0 - emissivity))


def link_conductance(link: Link, warm: Any, cool: Any) -> Any:
    """Return the conductance [W/K] of a link, k A/d + A_r s (T_1^2 + T_2^2)(T_1 + T_2), temperatures in kelvin."""
    return link.conductance + link.radiating_area * STEFAN_BOLTZMANN * (warm**2 + cool**2) * (warm + cool)


def link_heat(link: Link, warm: Any, cool: Any) -> Any:
    """Return the heat [W] a link passes from one temperature [K] to the other."""
    return link_conductance(link, warm, cool) * (warm - cool)


def linked(links: Sequence[Link], places: Mapping[str, Any], divided: Mapping[str, Any]) -> dict[str, list[Any]]:
    """Return the heat [W] that links bring to each of the `places`, by group, and to each cell of what is `divided`
    into cells.

    A link of what is divided takes from each cell in turn as much as that is warmer than the link's other end, and
    radiates as from their mean temperature. What the layer gives in place of a link's first end (`Link.of_layer`) comes
    from its cells, most from the first, falling evenly to nothing at its far face.
    """
    at = {**places, **{group: [np.mean(cells)] for group, cells in divided.items()}}
    if any("face" in (link.first[0], link.second[0]) for link in links):
        at["face"] = [divided["plate"][0]]
    heats: dict[str, list[Any]] = {group: [0.0] * len(bodies) for group, bodies in at.items()}
    taking: dict[str, Any] = dict.fromkeys(divided, 0.0)
    for link in links:
        ends = [at[group][i] for group, i in (link.first, link.second)]
        conductance = link_conductance(link, *ends)
        for (group, i), own, other in ((link.first, *ends), (link.second, *reversed(ends))):
            if group in divided:
                heats[group][0] = heats[group][0] + conductance * other
                taking[group] = taking[group] + conductance
            else:
                heats[group][i] = heats[group][i] + conductance * (other - own)
    for group, cells in divided.items():
        heats[group][0] = (heats[group][0] - taking[group] * cells) / len(cells)
    if "face" in heats:
        heats["plate"][0] = heats["plate"][0] + heats["face"][0] * of_first(len(divided["plate"]))
    for link in links:
        if link.of_layer is not None:
            (group, i), count = link.first, len(divided["layer"])
            given = link.of_layer * link_heat(link, at[group][i], at[link.second[0]][link.second[1]])
            heats[group][i] = heats[group][i] + given
            falling = 2.0 * (1.0 - (np.arange(count) + 0.5) / count) / count  # evenly over the depth to nothing
            heats["layer"][0] = heats["layer"][0] - given * falling
        if link.slope is not None:
            count = len(divided["layer"])
            conductance = link_conductance(link, at["layer"][0], at[link.second[0]][link.second[1]])
            heats["layer"][0] = heats["layer"][0] + conductance / count * risen(link.slope, at, count)
    return heats


def risen(slope: Slope, places: Mapping[str, Any], count: int) -> Any:
    """Return how much warmer than its mean what a layer of so many cells faces is before each of them [K]."""
    warm, (group, k) = sum(share * places[of][i] for (of, i), share in slope.warm), slope.cool
    return slope.share * (warm - places[group][k]) * (0.5 - (np.arange(count) + 0.5) / count)


def of_first(count: int) -> Any:
    """Return one for the first of so many cells, nothing for the others."""
    return 1.0 * (np.arange(count) == 0)


class Loss(NamedTuple):
    """A link by which what is beside the plate loses heat in the end."""

    link: Link  # From a body beside the plate
    onward: Any  # From the link's other end to the air [W/K]


def behind(link: Link, conductance: Any, ambient: Any) -> Link:
    """Return a link with a `conductance` [W/K] in series, which takes the share it has near ambient temperature."""
    share = 1.0 / (1.0 + link_conductance(link, ambient, ambient) / conductance)
    return link._replace(conductance=share * link.conductance, radiating_area=share * link.radiating_area)


def straightened(link: Link, warm: Any, cool: Any) -> Link:
    """Return a link that radiates as it does between these two temperatures [K] at all others as well."""
    return link._replace(conductance=link_conductance(link, warm, cool), radiating_area=0.0)


def cooled_through(loss: Loss, lump: Lump, ambient: Any) -> Lump:
    """Return a lump that also loses heat to ambient by a loss that begins at it, as near ambient temperature."""
    more = in_series(link_conductance(loss.link, ambient, ambient), loss.onward) / lump.surface.area
    return lump._replace(surface=lump.surface._replace(coefficient=lump.surface.coefficient + more))


def heated_between(across: Any, first: Any, second: Any) -> tuple[Any, Any, Any]:
    """Return the conductances [W/K] from the mean of an evenly heated slab to what is behind either face, and between
    these.

    `across` is k A/H of the whole slab, `first` and `second` lead on from its faces. A parabola from face to face with
    the mean T_m gives q_1 = 6 (T_m - T_1) - 2 (T_2 - T_1) over k A/H to the first: a star of 1/2, 1/2 and -1/6.
    """
    to_first, to_second = in_series(2.0 * across, first), in_series(2.0 * across, second)
    mean = -6.0 * across
    total = mean + to_first + to_second
    return mean * to_first / total, mean * to_second / total, to_first * to_second / total


def in_series(*conductances: Any) -> Any:
    """Return the conductance [W/K] of what heat passes one after the other."""
    return 1.0 / sum(1.0 / conductance for conductance in conductances)


def chain_heat(lumps: Sequence[Lump], temperatures: Any, inflow: Any, ambient: Any) -> list[Any]:
    """Return the heat [W] each lump of a chain keeps when `inflow` [W] comes into the first, less what surfaces
    lose."""
    left = []
    for i, lump in enumerate(lumps):
        onward: Any = 0.0
        if i + 1 < len(lumps):
            onward = lumps[i + 1].conductance * (temperatures[i] - temperatures[i + 1])
        left.append(inflow - onward - surface_heat(lump.surface, temperatures[i], ambient))
        inflow = onward
    return left


def heating(lumps: Sequence[Lump | Body], watts: Sequence[Any], empty: Any) -> Any:
    """Return the rate [K/s] at which each lump's temperature rises; `empty` is an array of none."""
    rates = empty
    for lump, heat in zip(lumps, watts, strict=True):
        rates = np.append(rates, heat / lump.capacity)
    return rates


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


def strip_bodies(area: Any, heat_capacity: Any, across: Any, surface: Surface) -> tuple[Lump, ...]:
    """Return a strip heated along its edge, in three bodies in a row from the edge on.

    Its area [m^2], its heat capacity per area [J/m^2 K], k t L/w [W/K], which conducts across its whole width, and
    what it loses to the air, for an area of one. The first body's conductance is from the edge itself.
    """
    return tuple(
        Lump(across / way, share * area * heat_capacity, surface._replace(area=share * area * surface.area))
        for share, way in zip(STRIP, WAYS, strict=True)
    )


def strip_end(surface: Surface, along: Any, onward: Any, ambient: Any) -> tuple[Surface, Any, Any]:
    """Return the surface of a strip's last body, its conductance [W/K] to what takes heat at the strip's end, and
    surface [m^2] that counts there.

    `along` is the conductance from the body to the end, `onward` from there. The body's part of the strip is colder
    than the body while heat flows on, by `AT_END` of what the end is: that share of its surface is at the end, which
    has a temperature between body and onward (star to delta).
    """
    at_end = AT_END * surface.area
    total = along + onward + at_end * surface_coefficient(surface, ambient, ambient)
    own = surface.area - at_end * (1.0 - along / total)
    return surface._replace(area=own), along * onward / total, at_end * onward / total
