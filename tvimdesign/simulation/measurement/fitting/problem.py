"""A problem: parameters, channels of data with the equations that predict them, quantities that follow; compiled."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.simulation.working_cycle.symbols import ca

Array = NDArray[np.float64]
Values = Mapping[str, Any]  # Parameters by name, in SI: numbers or CasADi symbols
_LARGEST = 700.0  # the exponential of more is no number
_FARTHEST, _STEEPEST = 1e6, 1e30  # beyond these a trial of the solver is merely bad
_REMEMBERED = 8  # Last points at which the equations' numbers are stored: a fit asks for its best ones again and again
FAR = 1e6  # A positive parameter is looked for between its start over this and its start times this


@dataclass(frozen=True)
class Parameter:
    """An unknown of the equations; a positive one is fitted by its logarithm."""

    name: str
    unit: str
    meaning: str
    start: float
    positive: bool = True
    scale: float = 1.0  # Size of a usual change [SI] of one that may be negative
    least: float = -np.inf  # Smallest value [SI]: 0 for a friction that may not be there
    most: float = np.inf  # Largest value [SI]
    profiled: bool = True  # True if its interval is read off a profile of the likelihood; off the covariance otherwise
    nuisance: bool = False
    """Whether it is of this measurement alone, such as a baseline: fitted with the others, not reported."""

    def inner(self, value: float) -> float:
        """Return the number the solver sees."""
        return float(np.log(value)) if self.positive else value / self.scale

    def outer(self, inner: Any) -> Any:
        """Return the value [SI] of the solver's number; symbols too."""
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
    """Return a parameter that may be zero, such as a friction that may not be there; `start` is a usual size too."""
    return Parameter(name, unit, meaning, start, positive=False, scale=start, least=0.0)


@dataclass(frozen=True)
class Channel:
    """Values that were measured, and what predicts them."""

    name: str
    unit: str
    measured: Array  # [SI]
    predicted: Callable[[Values], Any]
    """A column as long as the values, from the parameters: CasADi expressions through the product's equations."""
    at: Array  # Abscissa [SI]
    at_name: str
    at_unit: str
    relative: bool = False  # True if the error is a share of the value: then the logarithms are compared
    step: float = 0.0
    """Step of the last digit of the values, in SI or as a share: their noise is no less than what rounding makes."""
    noise_of: str = ""  # Channels of one word here err alike; a channel without one has a noise of its own
    zero_drifts: bool = False  # True if the sensor's zero drifts, though its noise is a share of the value

    sensors: int = 1  # Sensors whose values stand one after the other, as many of each

    def drifts(self, predicted: Array) -> Array:
        """Return what a drift by the whole range, or by the value itself, adds to the values; a column a sensor."""
        count = len(self.at) // self.sensors
        over = self.at[:count] - self.at[0] if self.at_name == "time" else np.arange(float(count))
        sizes = predicted.reshape(self.sensors, count)
        whole = np.ptp(sizes, axis=1, keepdims=True)
        by_share = whole / sizes if self.zero_drifts else np.ones_like(sizes)
        sizes = by_share if self.relative else np.broadcast_to(whole, sizes.shape)
        courses = np.zeros((self.sensors, count, self.sensors))
        courses[range(self.sensors), :, range(self.sensors)] = sizes * over / (float(over[-1]) or 1.0)
        return courses.reshape(-1, self.sensors)


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


class Residuals:
    """Measured less predicted, channel after channel, as functions of the solver's numbers."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        inner = ca.MX.sym("x", len(problem.parameters))
        values: Values = {parameter.name: parameter.outer(inner[i]) for i, parameter in enumerate(problem.parameters)}
        predicted = [ca.vec(ca.MX(channel.predicted(values))) for channel in problem.channels]
        compared = [
            ca.log(value) if c.relative else value for value, c in zip(predicted, problem.channels, strict=True)
        ]
        self._values = _remembering(ca.Function("values", [inner], [ca.vertcat(*compared)]))
        slopes = ca.jacobian(ca.vertcat(*compared), inner)
        self._jacobian = _remembering(ca.Function("jacobian", [inner], [slopes]))
        following = [ca.log(ca.MX(quantity.formula(values))) for quantity in problem.derived]
        out = ca.vertcat(*following) if following else ca.MX(0, 1)
        self._derived = ca.Function("derived", [inner], [out, ca.jacobian(out, inner)])
        measured = [np.log(c.measured) if c.relative else c.measured for c in problem.channels]
        self._measured = np.concatenate(measured)
        self._most = _FARTHEST * (1.0 + float(np.max(np.abs(self._measured))))
        ends = np.cumsum([0, *(len(c.measured) for c in problem.channels)])
        self.parts = [slice(int(a), int(b)) for a, b in pairwise(ends)]  # Where each channel stands in the whole
        words = [channel.noise_of or f"channel {i}" for i, channel in enumerate(problem.channels)]
        self.alike = [[j for j, word in enumerate(words) if word == mine] for mine in words]
        """Of each channel those that err as it does, itself among them."""
        self.groups = [alike for i, alike in enumerate(self.alike) if alike[0] == i]
        """Channels that err alike, each group once."""

    def at(self, inner: Array) -> Array:
        """Return residuals, in the units of the channels, or as a share of the value.

        No larger than `_FARTHEST` times the largest value measured, where the equations give less or no number.
        """
        differences: Array = self._measured - self._values(inner).ravel()
        numbers = np.nan_to_num(differences, nan=self._most, posinf=self._most, neginf=-self._most)
        clipped: Array = np.clip(numbers, -self._most, self._most)
        return clipped

    def jacobian(self, inner: Array) -> Array:
        """Return the residuals' derivatives by the solver's numbers."""
        slopes = np.nan_to_num(self._jacobian(inner), posinf=0.0, neginf=0.0)
        clipped: Array = np.clip(-slopes, -_STEEPEST, _STEEPEST)
        return clipped

    def derived(self, inner: Array) -> tuple[Array, Array]:
        """Return logarithms of what follows, and their derivatives."""
        values, slopes = self._derived(inner)
        return np.asarray(values).ravel(), np.asarray(slopes.full())

    def predicted(self, inner: Array) -> list[Array]:
        """Return the fitted values of each channel [SI]."""
        values = self._values(inner).ravel()
        return [
            np.exp(values[part]) if channel.relative else values[part]
            for part, channel in zip(self.parts, self.problem.channels, strict=True)
        ]


def _remembering(function: Any) -> Callable[[Array], Array]:
    """Return a CasADi function of a column as one of an array that computes nothing twice at its last points."""

    @lru_cache(maxsize=_REMEMBERED)
    def dense(numbers: bytes) -> Array:
        return np.asarray(function(np.frombuffer(numbers)).full())

    return lambda inner: dense(inner.tobytes())
