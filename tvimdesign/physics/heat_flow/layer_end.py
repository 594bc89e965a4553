"""Layer's end that a wall closes but for a free height at its near face, and rooms of still air beside a layer.

The layer conducts between a warm near face and a cold far one; the wall is as cold as the far face. Lengths are over
the layer's thickness, heat over conductivity, length of the end and excess of the near face.

With w = cosh(pi z/t) the layer is half of a plane: its near face w > 1, its free end cos(pi f) < w < 1, wall and far
face the rest. Between two such half lines the heat from the gap's end on is arcosh(u)/pi, with u the place from the
gap's middle over half the gap (conformal maps: Carslaw and Jaeger, Conduction of Heat in Solids, ch. XVI).

Where a sheet lies on the layer, before what is cold, both are one to the wall: lengths are over the thickness of both.

Rooms of still air have a warm and a cold wall. By separation of variables (Carslaw and Jaeger, Conduction of Heat in
Solids, ch. V) and by conformal maps (ch. XVI); walls that meet at two temperatures have a slot between them, as in
`shape_factors.gap_end`.

A lip of the plate at the layer's end has no heat capacity. Heat comes to it through the polymer, from slices at their
height and from the pads, and through its other arms (a star). Between two temperatures the polymer passes as much as
the mean of its conductivity between them says (Kirchhoff's transform, `conduction`), whatever its shape: molten it
gives less than frozen.

A star is a body that arms join to places of the stack. Each arm ends at a mean of places (`Arm.ends`), as a body may
lean on an edge that has a temperature between two, and at a `share` of the body, as what the arm touches may have only
that much of its temperature. Each end gives or takes its weight of the arm's heat g (m - s T), as that comes from g (m
- s T)^2/2: what heats one place from another heats back as well.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.heat_flow.lumps import Place
from tvimdesign.physics.heat_flow.shape_factors import gap_end

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_FROM_FREE = 0.5 * (1.0 + _NODES)
_PASSED, _SHARES = _FROM_FREE * (2.0 - _FROM_FREE), _WEIGHTS * (1.0 - _FROM_FREE)
"""Shares of the wall's heat that come into it before a place, and what of it each place stands for: dense at the far
face, where the heat falls to nothing."""


class WalledEnd(NamedTuple):
    """Heat that a wall at the end of a layer takes."""

    near: Any  # Heat that the near face gives for it [1]
    wall: Any  # Heat that comes into the wall beside the layer [1]; beyond `near` it is what the far face does not get
    deep: Any
    """Depth in the layer that the heat comes from: the integral of q y (t - y)/(2 t^2) dy [1].

    The layer is colder in the mean by that over its width, whatever its profile, as in `gap_end_depth`. Below a
    sheet this is what a layer without one would have that gives as much for each height and kelvin."""
    colder: Any  # Drop of the layer's mean below an even fall, times its width, over twice the mean of that [1]
    rim: Any = 0.0  # Heat that comes into the wall beside a sheet on the layer [1]
    sheet_colder: Any = 0.0  # Drop of that sheet's mean below an even fall, times its width [1]


def walled_end(free: Any) -> WalledEnd:
    """Return the heat at an end of whose height a share is `free`, 0 < free < 1."""
    near, wall, edge = _ends(free)
    deep = wall * _mean([0.5 * y * (1.0 - y) for y in _heights(edge, wall)])
    return WalledEnd(near, wall, deep, deep)


def sheeted_end(free: Any, layer: Any) -> WalledEnd:
    """Return the heat at an end of layer and sheet; the `layer` is a share a of their height, 0 < free < a < 1.

    Heat q out of the end at a height y makes the mean of the layer colder by y (1 - a/2) - y^2/(2 a) from within it, by
    a (1 - y)/2 from the sheet; what goes out evenly by the excess 1 - y over the layer by (8 a^2 - 11 a^3 + 4 a^4)/24.
    The sheet is colder by y (1 - a)/2 from the layer. Its own heat falls about evenly to nothing at the far face: with
    b = 1 - a the layer is colder by a b/3 for that, the sheet by b (5 - 4 b)/12.
    """
    near, wall, edge = _ends(free)
    place = (1.0 + edge - 2.0 * np.cos(np.pi * layer)) / (1.0 - edge)
    beside = np.log(place + np.sqrt(place**2 - 1.0)) / np.pi
    heights, sheet = _heights(edge, beside), 1.0 - layer
    colder = beside * _mean([y * (1.0 - 0.5 * layer) - 0.5 * y**2 / layer for y in heights])
    rim = wall - beside
    return WalledEnd(
        near=near,
        wall=beside,
        deep=colder / (8.0 * layer**2 - 11.0 * layer**3 + 4.0 * layer**4),
        colder=(colder + rim * layer * sheet / 3.0) / (2.0 - layer),
        rim=rim,
        sheet_colder=beside * _mean(heights) * 0.5 * sheet + _by_rim(rim, sheet),
    )


def sheet_end(layer: Any) -> WalledEnd:
    """Return the heat at an end of layer and sheet where the wall is beside the sheet alone."""
    rim = walled_end(layer).wall
    return WalledEnd(0.0, 0.0, 0.0, 0.0, rim, _by_rim(rim, 1.0 - layer))


def _by_rim(rim: Any, sheet: Any) -> Any:
    return rim * sheet * (5.0 - 4.0 * sheet) / 12.0


def _ends(free: Any) -> tuple[Any, Any, Any]:
    """Return what near face and wall pass, and the place of the wall's tip."""
    near, wall = (-2.0 / np.pi * np.log(ratio) for ratio in (np.sin(0.5 * np.pi * free), np.tan(0.25 * np.pi * free)))
    return near, wall, np.cos(np.pi * free)


def _heights(edge: Any, heat: Any) -> list[Any]:
    """Return the heights at which shares of the heat have come into the wall, from its tip at arccos(edge)/pi on."""
    return [np.arccos(0.5 * (1.0 + edge - (1.0 - edge) * np.cosh(np.pi * passed * heat))) / np.pi for passed in _PASSED]


def fallen(free: Any, away: Any, height: Any) -> Any:
    """Return what of its excess over the wall a layer has lost at a place [1], where far from the wall it falls evenly.

    At the distance x/t from the wall and the height y/t: with u = (2 cosh(pi z/t) - 1 - a)/(1 - a), a = cos(pi f), the
    temperature is 1 - arccos((|u + 1| - |u - 1|)/2)/pi of the near face's excess, and 1 - y/t far from the wall. Far
    away both sizes are nearly alike, so that their sum stands in place of their difference: 2 Re u/(|u + 1| + |u - 1|).
    """
    return 1.0 - (1.0 - np.arccos(_along_and_off(free, away, height)[0]) / np.pi) / (1.0 - height)


def cooled_end(free: Any, away: Any, height: Any) -> Any:
    """Return how much colder a place is for heat that leaves the free end, over that heat and length, times k [1].

    With u = cos(a + i b) the free end is 0 < a < pi at b = 0, near face and wall are a = 0 and pi: heat that leaves as
    sin a makes it colder by half of sin a exp(-b). The near face gives half of that heat, the wall misses the rest;
    the whole is over what the near face gives.
    """
    along, off = _along_and_off(free, away, height)
    return np.sqrt(1.0 - along**2) * (off - np.sqrt(off**2 - 1.0))


def _along_and_off(free: Any, away: Any, height: Any) -> tuple[Any, Any]:
    """Return cos a and cosh b of a place, u = cos(a + i b): along the free end and off it."""
    edge = np.cos(np.pi * free)
    real = 2.0 * np.cosh(np.pi * away) * np.cos(np.pi * height) - 1.0 - edge
    imaginary = 2.0 * np.sinh(np.pi * away) * np.sin(np.pi * height)
    right, left = ((real + sign * (1.0 - edge)) ** 2 + imaginary**2 for sign in (1.0, -1.0))
    both = np.sqrt(right) + np.sqrt(left)
    return 2.0 * real / both, both / (2.0 * (1.0 - edge))


def _mean(values: list[Any]) -> Any:
    """Return the mean over the wall's heat of what is at the places where it comes in."""
    return sum(share * value for share, value in zip(_SHARES, values, strict=True))


ROOM_TERMS = 6
AT_LIP, AT_EDGE, AT_FLOOR = 0.41, 0.16, 0.294
"""Heat that the end of a clearance takes from the pads for the lip above it, far from a floor and less before one; and
less for the floor than if it were as warm as the pads all over, the integral of 2/pi arcsin(y) cot(pi y/2)."""


class Room(NamedTuple):
    """Heat that a room beside tiles passes beyond an even fall from its warm ceiling to its floor."""

    ceiling: Any  # Heat of the ceiling to the cold wall, beyond the even fall
    floor: Any  # Heat that the wall gets in place of the floor
    tile: Any  # Heat of the tile's side to the cold wall


def room(width: Any, slot: Any) -> Room:
    """Return a room of a `width`, over its height, between a tile's side, which falls evenly from ceiling to floor, and
    a wall as cold as the floor, which a `slot` divides from the ceiling.

    The wall takes what falls evenly there, 1 - y/t = sum 2/(n pi) sin(n pi y/t). With x = n pi r of each term comes
    2/(n pi) tanh(x/2) from the ceiling, that with alternating signs from the floor's, and 4/(n pi)/sinh x of the odd
    ones from the tile. A wide room is the end of a gap.
    """
    ceiling, floor = gap_end(slot)
    tile = 0.0
    for n in range(1, ROOM_TERMS + 1):
        left = 2.0 / (n * np.pi) * (1.0 - np.tanh(0.5 * n * np.pi * width))
        ceiling, floor = ceiling - left, floor + (-1.0) ** n * left
        tile = tile + (n % 2) * 4.0 / (n * np.pi * np.sinh(n * np.pi * width))
    return Room(ceiling, floor, tile)


def below_lip(slot: Any) -> tuple[Any, Any]:
    """Return the heat to lip and floor, from pads and layer, through the clearance below a lip at the layer's end.

    The end falls from the pads' temperature to the lip's as a layer does that a wall closes but for a small free height
    c (`walled_end`): e = 1 - 2/pi arcsin(y/c). Below it the wall is warm, and the floor's own edge a slot of the width
    g = `slot` c away. What the end gives comes from the pads by e, and from what the lip would take through the layer
    by the rest. For an end as warm as the pads the map of a bend (dz/dw = c/pi ((w - g^2/c^2)/(w + 1))^(1/2)/w) brings
    the floor, beyond what passes the slot, 2/pi arctan(g/c) c/g - 1/pi ln(4 g^2/(g^2 + c^2)), and the lip by
    1/pi ln(1 + g^2/c^2) more than without a slot. The rest of both follows conduction in two dimensions, within 0.04 up
    to g = 2 c.
    """
    floor = 2.0 / np.pi * np.arctan(slot) / slot - np.log(4.0 * slot**2 / (1.0 + slot**2)) / np.pi
    lip = AT_LIP - AT_EDGE * np.exp(-2.5 * slot) + np.log(1.0 + slot**2) / np.pi
    return lip, floor - AT_FLOOR / (1.0 + 2.0 * slot**2)


SPREADER, LAYER = ("spreader", 0), ("layer", 0)


class Lip(NamedTuple):
    """Connections of a lip; the polymer's conductances [W/K] are of the mean conductivity of both phases."""

    slices: Any  # From the layer's slices, by their mean excess over the lip
    pads: Any  # From the pads' hot side through the layer, by its excess
    arms: "tuple[Arm, ...]"  # Other bodies that heat and cool it


class WarmLip(NamedTuple):
    """A lip at one instant."""

    temperature: Any  # [K]
    from_layer: Any  # Heat [W] that each polymer cell gives it
    from_places: dict[Place, Any]  # Heat [W] that other places give it
    residuals: tuple[Any, Any] = (0.0, 0.0)  # Differences [K] of the temperatures given from those that follow


def warm_lip(
    lip: Lip,
    cells: Any,
    at: Callable[[Place], Any],
    conducting: Callable[[Any], tuple[Any, Any]],
    given: tuple[Any, Any] | None = None,
) -> WarmLip:
    """Return a lip beside polymer `cells` [K], other places being `at` theirs.

    `conducting` says how well the polymer conducts between each cell and a temperature, and between the pads and it,
    over the mean of both phases. It is asked at the temperature that the lip has where all conducts as that mean.
    That temperature and the lip's own may be `given` [K], to be solved for with the rest of a network.
    """
    follows = _temperature(lip, cells, at, 1.0 + 0.0 * cells, 1.0)
    alike = follows if given is None else given[0]
    of_cells, of_pads = conducting(alike)
    settled = _temperature(lip, cells, at, of_cells, of_pads)
    residuals = (0.0, 0.0) if given is None else (follows - alike, settled - given[1])
    warm = settled if given is None else given[1]
    from_places = star_heat((_pads(lip, of_pads), *lip.arms), warm, at)
    return WarmLip(warm, lip.slices / len(cells) * of_cells * (cells - warm), from_places, residuals)


def _pads(lip: Lip, of_pads: Any) -> "Arm":
    return Arm(of_pads * lip.pads, ((SPREADER, 1.0),))


def _temperature(lip: Lip, cells: Any, at: Callable[[Place], Any], of_cells: Any, of_pads: Any) -> Any:
    mean = np.mean(of_cells)
    layer = Arm(lip.slices * mean, ((LAYER, 1.0),))
    seen = np.mean(of_cells * cells) / mean
    arms = (layer, _pads(lip, of_pads), *lip.arms)
    return star_temperature(arms, lambda place: seen if place == LAYER else at(place))


class Arm(NamedTuple):
    """Conductor between the body and a mean of places."""

    conductance: Any  # [W/K]
    ends: tuple[tuple[Place, Any], ...]  # Places and their weights, which sum to the `share`
    share: Any = 1.0  # Of the body's temperature that the mean is compared with


def arm_mean(arm: Arm, at: Callable[[Place], Any]) -> Any:
    """Return the mean of the places that an arm ends at [K], its share of a temperature."""
    return sum(weight * at(place) for place, weight in arm.ends)


def star_temperature(arms: Sequence[Arm], at: Callable[[Place], Any]) -> Any:
    """Return the temperature of the body [K], by that of the places its arms end at."""
    given = sum(arm.conductance * arm.share * arm_mean(arm, at) for arm in arms)
    return given / sum(arm.conductance * arm.share**2 for arm in arms)


def star_heat(arms: Sequence[Arm], body: Any, at: Callable[[Place], Any]) -> dict[Place, Any]:
    """Return the heat [W] that arms of a body of a temperature [K] take from each place."""
    taken: dict[Place, Any] = {}
    for arm in arms:
        heat = arm.conductance * (arm_mean(arm, at) - arm.share * body)
        for place, weight in arm.ends:
            taken[place] = taken.get(place, 0.0) + weight * heat
    return taken
