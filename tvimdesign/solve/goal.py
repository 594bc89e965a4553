"""What one run of a built problem is to make small, and below what it is to keep: the parameters of a trade-off."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tvimdesign.solve.limits import Limit

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Goal:
    """Weights and ceilings of one run; both are numbers the solver is given, nothing is built for them."""

    weights: Mapping[str, float]
    """Weight of each minimised output over its reference."""
    ceilings: Mapping[str, float] = field(default_factory=dict)
    """Upper limits (SI) in place of those the problem was built with, by output; infinite where there is none."""

    def room(self, limits: Sequence[Limit]) -> Array:
        """Largest residual of each limit: zero, or what another ceiling leaves."""
        return np.array([
            float(limit.residual(self.ceilings[limit.output]))
            if limit.sense == "<=" and limit.output in self.ceilings else 0.0
            for limit in limits
        ])  # fmt: skip
