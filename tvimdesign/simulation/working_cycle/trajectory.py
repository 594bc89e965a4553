"""Result of a simulation: the trajectory of a phase, and all phases of a cycle with the values they supply."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Trajectory:
    """A phase over time, sampled: `times` [s], `states` one column a time, `currents` [A]."""

    times: Array
    states: Array
    currents: Array

    def at(self, fractions: Array) -> Array:
        """Interpolate states at fractions of the last time, linearly between the samples."""
        wanted = fractions * self.times[-1]
        return np.array([np.interp(wanted, self.times, row) for row in self.states])


@dataclass(frozen=True)
class Cycle:
    """Result of a cycle: event, path and steady values by name (infinite where something never happens)."""

    values: dict[str, float]
    trajectories: dict[str, Trajectory]
    """By phase, each from its start to the event that ends it, or as far as it goes if that never happens."""
    balances: dict[str, Array]
    """By phase, state and current that stay where the phase ended; none where there is no such state."""

    @property
    def trajectory(self) -> Trajectory:
        """The first phase."""
        return next(iter(self.trajectories.values()))
