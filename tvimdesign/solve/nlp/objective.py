"""Objective and reserves of one run of a built problem: the parameters of a trade-off."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bound:
    """A sum of outputs that must not exceed a limit: `factors` by output, in whatever unit makes the sum one."""

    factors: Mapping[str, float]
    limit: float

    def residual(self, values: Mapping[str, float]) -> float:
        """Return the violation, satisfied if <= 0."""
        return sum(factor * values[name] for name, factor in self.factors.items()) - self.limit


@dataclass(frozen=True)
class Objective:
    """Weights and bounds of one run; both are numbers the solver is given, nothing is built for them."""

    weights: Mapping[str, float]
    """Weight of each minimised output over its reference."""
    bounds: Sequence[Bound] = field(default_factory=tuple)
    """No more of them than the problem has traded outputs."""

    def factors(self, objectives: Sequence[str]) -> Array:
        """Factors of every bound (a row) on every traded output (a column); rows that bound nothing are zero."""
        matrix = np.zeros((len(objectives), len(objectives)))
        for row, bound in zip(matrix, self.bounds, strict=False):
            row[:] = [bound.factors.get(name, 0.0) for name in objectives]
        return matrix

    def room(self, objectives: Sequence[str]) -> Array:
        """Largest sum of every bound; infinite where a row bounds nothing."""
        limits = [bound.limit for bound in self.bounds]
        return np.array(limits + [np.inf] * (len(objectives) - len(limits)))
