"""What is fitted to what: parameters, channels of data with the equations that predict them, quantities that follow."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Values = Mapping[str, Any]
"""Parameters by name, in SI: numbers or CasADi symbols."""
_LARGEST = 700.0  # the exponential of more is no number
FAR = 1e6
"""A positive parameter is looked for between its start over this and its start times this."""


@dataclass(frozen=True)
class Parameter:
    """An unknown of the equations; a positive one is fitted by its logarithm."""

    name: str
    unit: str
    meaning: str
    start: float
    positive: bool = True
    scale: float = 1.0
    """Size of a usual change [SI] of one that may be negative."""
    least: float = -np.inf
    """Smallest value [SI]: 0 for a friction that may not be there."""
    most: float = np.inf
    """Largest value [SI]."""
    profiled: bool = True
    """Whether its interval is read off a profile of the likelihood; off the covariance otherwise."""
    nuisance: bool = False
    """Whether it is of this measurement alone, such as a baseline: fitted with the others, not reported."""

    def inner(self, value: float) -> float:
        """The number the solver sees."""
        return float(np.log(value)) if self.positive else value / self.scale

    def outer(self, inner: Any) -> Any:
        """The value [SI] of the solver's number; symbols too."""
        if not self.positive:
            return inner * self.scale
        return np.exp(min(inner, _LARGEST)) if isinstance(inner, float) else np.exp(inner)

    @property
    def bounds(self) -> tuple[float, float]:
        """Of the solver's number."""
        if not self.positive:
            return self.least / self.scale, self.most / self.scale
        least, most = max(self.least, self.start / FAR), min(self.most, self.start * FAR)
        return float(np.log(least)), float(np.log(most))


def from_zero(name: str, unit: str, meaning: str, start: float) -> Parameter:
    """A parameter that may be zero, such as a friction that may not be there; `start` is a usual size too."""
    return Parameter(name, unit, meaning, start, positive=False, scale=start, least=0.0)


@dataclass(frozen=True)
class Channel:
    """Values that were measured, and what predicts them."""

    name: str
    unit: str
    measured: Array
    """[SI]"""
    predicted: Callable[[Values], Any]
    """A column as long as the values, from the parameters: CasADi expressions through the product's equations."""
    at: Array
    """What they are drawn over [SI]."""
    at_name: str
    at_unit: str
    relative: bool = False
    """Whether the error is a share of the value: then the logarithms are compared."""
    noise_of: str = ""
    """Channels of one word here err alike; a channel without one has a noise of its own."""


@dataclass(frozen=True)
class Derived:
    """A positive quantity that follows from the parameters."""

    name: str
    unit: str
    meaning: str
    formula: Callable[[Values], Any]


@dataclass(frozen=True)
class Problem:
    """Parameters, channels and what follows."""

    parameters: Sequence[Parameter]
    channels: Sequence[Channel]
    derived: Sequence[Derived] = field(default_factory=tuple)

    @property
    def count(self) -> int:
        """Values measured."""
        return sum(len(channel.measured) for channel in self.channels)
