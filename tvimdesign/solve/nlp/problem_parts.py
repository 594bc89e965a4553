"""Parts of a problem: its free numbers and currents, the parameters of a run, and its values at a point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tvimdesign.device import Path

Array = NDArray[np.float64]


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
    slew: float
    """How fast it may change [A/s]."""

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
    weights: Array
    """Of what is minimised."""
    factors: Array
    """Of each bound (a row) on each traded output (a column)."""


class Point(NamedTuple):
    """The problem at one point; derivatives by the unknowns."""

    objective: float
    gradient: Array
    rows: Array
    jacobian: Array
    values: dict[str, float]
    """The wanted outputs."""
    gradients: dict[str, Array]
    times: dict[str, float]
    """Time [s] of each event the problem needs."""
