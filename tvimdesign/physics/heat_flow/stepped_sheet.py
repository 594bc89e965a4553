"""A sheet that is deeper over some of its width, as a plate is where a lip hangs from it: what its steps resist."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np


def step(share: Any) -> Any:
    """What a sheet resists more where its depth steps down to a `share` of it on one side, times k and length [1].

    With the shares a and 1 the map of a strip with a step (Schwarz-Christoffel; Carslaw and Jaeger, ch. XVI) gives

        ((a + 1/a) ln((1 + a)/(1 - a)) - 2 ln(4 a/(1 - a^2)))/pi

    beyond what both depths resist up to the step.
    """
    rise = np.log((1.0 + share) / (1.0 - share))
    return ((share + 1.0 / share) * rise - 2.0 * np.log(4.0 * share / (1.0 - share**2))) / np.pi


def reaches(width: Any, parts: Sequence[Any]) -> tuple[Any, ...]:
    """What of each of several parts in a row something of a `width` lies over, smoothly as it gets wider than one."""
    found: list[Any] = []
    for part in parts:
        found.append(part * np.tanh((width - sum(found)) / part))
    return tuple(found)
