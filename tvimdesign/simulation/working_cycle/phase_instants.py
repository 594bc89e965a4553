"""Parts of a run of a phase: its steps, an instant, a current that follows a profile, and the results."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from tvimdesign.engine.interpreter import Array


@dataclass
class Grid:
    """The steps of a phase, by what its first run needed: each in times that the pads would need to heat the layer."""

    shares: list[float] = field(default_factory=list)
    events: dict[str, int] = field(default_factory=dict)  # Step in which each event was due; -1 at the start


@dataclass(frozen=True)
class Instant:
    """State and current at an instant of a phase, with their tangents."""

    time: float
    of_time: Array
    state: Array
    of_state: Array
    current: float
    of_current: Array
    step: int = -1  # The step that ends there; -1 at the start

    def without_length(self) -> Instant:
        """Leave out the last direction."""
        of_state = np.ascontiguousarray(self.of_state[:, :-1])
        return replace(self, of_time=self.of_time[:-1], of_state=of_state, of_current=self.of_current[:-1])


@dataclass(frozen=True)
class Drive:
    """A current that runs straight between given moments of a phase, with tangents; steps end at the moments."""

    moments: Array
    of_moments: Array
    currents: Array
    of_currents: Array
    steps: int  # Of each piece

    def with_length(self) -> Drive:
        """Add the direction of a last step's length, along which nothing moves."""
        more = np.zeros((len(self.moments), 1))
        return replace(
            self, of_moments=np.hstack([self.of_moments, more]), of_currents=np.hstack([self.of_currents, more])
        )


@dataclass
class PhaseOutputs:
    """Values of a phase by name, with their derivatives."""

    values: dict[str, float] = field(default_factory=dict)
    slopes: dict[str, Array] = field(default_factory=dict)
    end: Instant | None = None
    short: float = 0.0  # Rest of the event that ends a driven phase, at its end, and its derivatives
    of_short: Array = field(default_factory=lambda: np.zeros(1))
    samples: dict[str, tuple[Array, Array]] = field(default_factory=dict)
    """What the highest value of a driven phase is asked of, at the end of every step, with derivatives."""

    def without_length(self) -> PhaseOutputs:
        """Leave out the last direction."""
        end = self.end.without_length() if self.end is not None else None
        slopes = {name: slope[:-1] for name, slope in self.slopes.items()}
        samples = {name: (values, of_values[:, :-1]) for name, (values, of_values) in self.samples.items()}
        return PhaseOutputs(self.values, slopes, end, self.short, self.of_short[:-1], samples)

    def add(self, name: str, value: float, slopes: Array) -> None:
        """Add one."""
        self.values[name], self.slopes[name] = float(value), np.asarray(slopes)


def hermite(share: float, before: Array, after: Array, here: Array, there: Array) -> Array:
    """Interpolate between two states along a cubic, whose slopes over the step are given."""
    left = 1.0 - share
    whole = before * left**2 * (1.0 + 2.0 * share) + after * share**2 * (3.0 - 2.0 * share)
    return np.asarray(whole + share * left * (here * left - there * share))
