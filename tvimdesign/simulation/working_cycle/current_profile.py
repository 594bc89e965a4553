"""The current through the pads over one phase: constant, or straight between given moments."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CurrentProfile:
    """Current [A] at some moments [s] from the phase's start, straight between them; the last one lasts."""

    moments: tuple[float, ...]  # Rising from zero
    currents: tuple[float, ...]

    @classmethod
    def constant(cls, current: float) -> Self:
        """Return a profile of one constant current."""
        return cls((0.0,), (current,))

    @classmethod
    def in_pieces(cls, ramp: float, duration: float, currents: Sequence[float]) -> Self:
        """Ramp from zero in some seconds to the first of `currents`, which follow evenly spaced over `duration`
        seconds; without a ramp the first is there from the start."""
        evenly = ramp + np.linspace(0.0, duration, len(currents))
        if ramp == 0.0:
            return cls(tuple(evenly.tolist()), tuple(currents))
        return cls((0.0, *evenly.tolist()), (0.0, *currents))

    @classmethod
    def from_plain(cls, data: Mapping[str, Any]) -> Self:
        """Return the drive that `plain` describes."""
        return cls(*(tuple(float(number) for number in data[name]) for name in ("moments", "currents")))

    def plain(self) -> dict[str, Any]:
        """Return plain data, SI."""
        return {"moments": list(self.moments), "currents": list(self.currents)}

    def at(self, times: Array) -> Array:
        """Return the current at some times."""
        return np.asarray(np.interp(times, self.moments, self.currents))

    def next_corner(self, time: float) -> float:
        """Return the first moment after `time` at which the current changes its slope; infinite where there is none."""
        soon = 1e-9 * self.moments[-1]
        return next((moment for moment in self.moments if moment > time + soon), np.inf)

    @property
    def steepest(self) -> float:
        """Fastest change [A/s]."""
        return float(np.max(np.abs(np.diff(self.currents)) / np.diff(self.moments), initial=0.0))

    @property
    def mean(self) -> float:
        """Mean current up to its last moment."""
        if len(self.currents) == 1:
            return self.currents[0]
        return float(np.trapezoid(self.currents, self.moments) / self.moments[-1])


def ramp_time(size: Any, slew: Any) -> Any:
    """Return the time [s] a supply needs to a current of some size [A]; floats and symbols.

    A current is cut at once, and its direction changed while there is none: every phase begins at zero.
    """
    return size / slew
