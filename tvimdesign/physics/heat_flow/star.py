"""A body without heat capacity that arms join to places of the stack: its temperature, and what its arms take.

Each arm ends at a mean of places (`Arm.ends`), as a body may lean on an edge that has a temperature between two, and at
a `share` of the body, as what the arm touches may have only that much of its temperature. Each end gives or takes its
weight of the arm's heat g (m - s T), as that comes from g (m - s T)^2/2: what heats one place from another heats back
as well.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from tvimdesign.physics.heat_flow.lumps import Place


class Arm(NamedTuple):
    """What conducts between the body and a mean of places."""

    conductance: Any
    """[W/K]"""
    ends: tuple[tuple[Place, Any], ...]
    """Places and their weights, which sum to the `share`."""
    share: Any = 1.0
    """Of the body's temperature that the mean is held against."""


def mean(arm: Arm, at: Callable[[Place], Any]) -> Any:
    """Mean of the places that an arm ends at [K], its share of a temperature."""
    return sum(weight * at(place) for place, weight in arm.ends)


def temperature(arms: Sequence[Arm], at: Callable[[Place], Any]) -> Any:
    """Temperature of the body [K], by that of the places its arms end at."""
    given = sum(arm.conductance * arm.share * mean(arm, at) for arm in arms)
    return given / sum(arm.conductance * arm.share**2 for arm in arms)


def taken(arms: Sequence[Arm], body: Any, at: Callable[[Place], Any]) -> dict[Place, Any]:
    """Heat [W] that arms of a body of a temperature [K] take from each place."""
    found: dict[Place, Any] = {}
    for arm in arms:
        heat = arm.conductance * (mean(arm, at) - arm.share * body)
        for place, weight in arm.ends:
            found[place] = found.get(place, 0.0) + weight * heat
    return found
