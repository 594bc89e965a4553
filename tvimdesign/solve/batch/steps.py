"""Division of the time of a phase into steps, and its dependence on the design."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_LATE, _GROWTH = 2.0, 1.07
"""Times the pace after which steps grow, for the designs that have not ended, and by how much each."""
LONGEST = 2.0
"""How much longer or shorter than another a design is taken to be at most."""


@dataclass(frozen=True)
class Steps:
    """Division of time into steps."""

    of_pace: int
    """Steps in the time the study's own design takes."""
    first: float
    """Length of the first step over the others'."""
    growth: float
    """What each of the first steps is longer by, until they are as long as the others."""

    def lengths(self, pace: float, horizon: float) -> Array:
        """Return the lengths of all steps up to the horizon."""
        usual = pace / self.of_pace
        step, time, taken = self.first * usual, 0.0, list[float]()
        while time < horizon:
            taken.append(min(step, horizon - time))
            time += taken[-1]
            step = step * _GROWTH if time > _LATE * pace else min(self.growth * step, usual)
        return np.array(taken)


@dataclass(frozen=True)
class Fit:
    """Course of designs near a given one through a phase."""

    steps: Steps
    about: Array
    """Moving inputs of that one."""
    slopes: Array
    """By how much the time of a phase changes with each, both as shares."""
    shares: Mapping[str, float]
    """When each event happens, as a share of that time."""

    def scales(self, columns: Array) -> Array:
        """About how long designs take, as a share of the time of that one."""
        off = np.divide(columns, self.about[:, None], out=np.ones(columns.shape), where=self.about[:, None] != 0.0)
        factors: Array = np.clip(1.0 + (self.slopes[:, None] * (off - 1.0)).sum(axis=0), 1.0 / LONGEST, LONGEST)
        return factors
