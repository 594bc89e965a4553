"""Second-order model of what a working cycle supplies, around one cycle."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CycleModel:
    """Second-order model of what the cycle supplies, in logarithms where it is positive."""

    at: Array
    values: Array
    slopes: Array
    """Of the logarithms, where `positive`."""
    curvatures: Array
    """One matrix for each value."""
    positive: NDArray[np.bool_]

    @classmethod
    def of(cls, x: Array, values: Array, slopes: Array, curvatures: Array) -> Self:
        """Take values and slopes of the cycle at the unknowns x."""
        positive = np.isfinite(values) & (values > 0.0)
        return cls(x, values, slopes / np.where(positive, values, 1.0)[:, None], curvatures, positive)

    def __call__(self, x: Array) -> tuple[Array, Array]:
        """Return values and slopes at other unknowns."""
        step = x - self.at
        turned = self.curvatures @ step
        change, slopes = self.slopes @ step + 0.5 * turned @ step, self.slopes + turned
        grown = self.values * np.exp(np.clip(change, -30.0, 30.0))
        values = np.where(self.positive, grown, self.values + change)
        return values, np.where(self.positive, grown, 1.0)[:, None] * slopes


class Curvatures:
    """Curvature of what the cycle supplies by the unknowns, learned from the slopes of one cycle after another."""

    def __init__(self, values: int, unknowns: int) -> None:
        self.matrices = np.zeros((values, unknowns, unknowns))

    def learn(self, before: CycleModel, after: CycleModel) -> None:
        """Update the curvatures so that they explain how slopes changed between two points."""
        step = after.at - before.at
        missing = after.slopes - before.slopes - self.matrices @ step
        along = missing @ step
        size = np.linalg.norm(missing, axis=1) * np.linalg.norm(step)
        sound = (before.positive == after.positive) & np.isfinite(along) & (np.abs(along) > 0.05 * size) & (size > 0.0)
        for i in np.flatnonzero(sound):
            self.matrices[i] += np.outer(missing[i], missing[i]) / along[i]
