"""A lip of the plate at the end of the layer, and the star: bodies without heat capacity that arms heat.

Heat comes to it through the polymer, from slices at their height and from the pads, and through its other arms
(a star). Between two temperatures the polymer passes as much as the mean of its conductivity between them says
(Kirchhoff's transform, `conduction`), whatever its shape: molten it gives less than frozen.

A star is a body that arms join to places of the stack. Each arm ends at a mean of places (`Arm.ends`), as a body may
lean on an edge that has a temperature between two, and at a `share` of the body, as what the arm touches may have only
that much of its temperature. Each end gives or takes its weight of the arm's heat g (m - s T), as that comes from g (m
- s T)^2/2: what heats one place from another heats back as well."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.heat_flow.lumps import Place

HOT, LAYER = ("hot", 0), ("layer", 0)


class Lip(NamedTuple):
    """Connections of a lip; the polymer's conductances [W/K] are of the mean conductivity of both phases."""

    slices: Any
    """From the layer's slices, by their mean excess over the lip."""
    pads: Any
    """From the pads' hot side through the layer, by its excess."""
    arms: tuple[Arm, ...]
    """Other bodies that heat and cool it."""


class WarmLip(NamedTuple):
    """A lip at one instant."""

    temperature: Any
    """[K]"""
    from_layer: Any
    """Heat [W] that each polymer cell gives it."""
    from_places: dict[Place, Any]
    """Heat [W] that other places give it."""
    residuals: tuple[Any, Any] = (0.0, 0.0)
    """Differences [K] of the temperatures given from those that follow."""


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


def _pads(lip: Lip, of_pads: Any) -> Arm:
    return Arm(of_pads * lip.pads, ((HOT, 1.0),))


def _temperature(lip: Lip, cells: Any, at: Callable[[Place], Any], of_cells: Any, of_pads: Any) -> Any:
    mean = np.mean(of_cells)
    layer = Arm(lip.slices * mean, ((LAYER, 1.0),))
    seen = np.mean(of_cells * cells) / mean
    arms = (layer, _pads(lip, of_pads), *lip.arms)
    return star_temperature(arms, lambda place: seen if place == LAYER else at(place))


class Arm(NamedTuple):
    """Conductor between the body and a mean of places."""

    conductance: Any
    """[W/K]"""
    ends: tuple[tuple[Place, Any], ...]
    """Places and their weights, which sum to the `share`."""
    share: Any = 1.0
    """Of the body's temperature that the mean is compared with."""


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
