"""A body without heat capacity that arms join to places of the stack: its temperature, and links in its place.

Each arm ends at a mean of places (`Arm.ends`), as a body may lean on an edge that has a temperature between two. Each
of them gives or takes its weight of the arm's heat g (m - sum w T), as that comes from g (m - sum w T)^2/2: what heats
one place from another heats back as well. Without the body, its arms are links between their places (star to mesh).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from tvimdesign.physics.heat_flow.lumps import Link, Place


class Arm(NamedTuple):
    """What conducts between the body and a mean of places."""

    conductance: Any
    """[W/K]"""
    ends: tuple[tuple[Place, float], ...]
    """Places and their weights, which sum to one."""


def temperature(arms: Sequence[Arm], at: Callable[[Place], Any]) -> Any:
    """Temperature of the body, by that of the places its arms end at."""
    given = sum(arm.conductance * sum(weight * at(place) for place, weight in arm.ends) for arm in arms)
    return given / sum(arm.conductance for arm in arms)


def meshed(arms: Sequence[Arm]) -> tuple[Link, ...]:
    """Links between the places that pass what the body passes between them."""
    whole = sum(arm.conductance for arm in arms)
    found: dict[tuple[Place, Place], Any] = {}
    for one, other in itertools.combinations(arms, 2):
        between = one.conductance * other.conductance / whole
        weights = dict(one.ends)
        for place, weight in other.ends:
            weights[place] = weights.get(place, 0.0) - weight
        for (first, a), (second, b) in itertools.combinations(weights.items(), 2):
            pair = (first, second) if (first, second) in found or (second, first) not in found else (second, first)
            found[pair] = found.get(pair, 0.0) - between * a * b
    return tuple(Link(*pair, conductance) for pair, conductance in found.items())
