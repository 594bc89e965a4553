"""Parts of a problem: free numbers and currents, parameters of a run, values at a point, model of the cycle."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from tvimdesign.device import Path

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Free:
    """One number that may change: its name, bounds (SI), and whether its unknown is a logarithm."""

    name: str
    lower: float
    upper: float
    reference: float

    @property
    def logarithmic(self) -> bool:
        """Return whether the unknown is log(value/reference) rather than value/reference."""
        return self.lower > 0.0

    def to_unknown(self, value: float) -> float:
        """Unknown of a value."""
        return float(np.log(value / self.reference)) if self.logarithmic else value / self.reference

    def to_value(self, unknown: Any) -> Any:
        """Value of an unknown; floats and symbols."""
        return self.reference * (np.exp(unknown) if self.logarithmic else unknown)


@dataclass(frozen=True)
class FreeCurrent:
    """The current of one phase, free at the nodes of its pieces, between `lower` and `upper` [A] in size."""

    phase: str
    row: str
    pieces: int
    lower: float
    upper: float
    slew: float  # How fast it may change [A/s]

    @property
    def nodes(self) -> int:
        """Count of its currents, over `upper`; one more unknown is the time of its pieces."""
        return self.pieces + 1


class Peak(NamedTuple):
    """Highest value over a driven phase."""

    row: Path
    current: FreeCurrent

    @property
    def scale(self) -> float:
        """Order of magnitude: kelvins are hundreds, watts and volts tens."""
        return 100.0 if self.row.unit == "degC" else 10.0


@dataclass(frozen=True)
class Parameters:
    """The numbers of one run that are no unknowns."""

    inputs: Array
    weights: Array  # Of what is minimised
    factors: Array  # Of each bound (a row) on each traded output (a column)


class Places(NamedTuple):
    """Places by name: of wanted outputs among each other, of events among what the cycle supplies."""

    outputs: Mapping[str, int]
    events: Mapping[str, int]
    minimized: Integers  # Among the outputs, of those that are minimised and traded
    traded: Integers
    late: Integers  # Among what the cycle supplies, of events without a time limit


class Point(NamedTuple):
    """The problem at one point; derivatives by the unknowns."""

    objective: float
    gradient: Array
    rows: Array
    jacobian: Array
    places: Places
    outputs: Array  # The wanted outputs, and their slopes
    of_outputs: Array
    cycle: Array  # Supplied values in the order of the model's `switch_names`, and slopes
    of_cycle: Array

    @property
    def values(self) -> dict[str, float]:
        """Return the wanted outputs by name."""
        return dict(zip(self.places.outputs, self.outputs.tolist(), strict=True))

    @property
    def gradients(self) -> dict[str, Array]:
        """Return their gradients by name."""
        return dict(zip(self.places.outputs, self.of_outputs, strict=True))

    @property
    def times(self) -> dict[str, float]:
        """Return the time [s] of each event the problem needs."""
        return {name: float(self.cycle[place]) for name, place in self.places.events.items()}


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

    weights: Mapping[str, float]  # Weight of each minimised output over its reference
    bounds: Sequence[Bound] = field(default_factory=tuple)  # No more of them than the problem has traded outputs

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


@dataclass(frozen=True)
class CycleModel:
    """Second-order model of what the cycle supplies, in logarithms where it is positive."""

    at: Array
    values: Array
    slopes: Array  # Of the logarithms, where `positive`
    curvatures: Array  # One matrix for each value
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
        grown = self.values * np.exp(np.minimum(np.maximum(change, -30.0), 30.0))
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
