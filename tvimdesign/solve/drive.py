"""The current through the pads over one stage: constant, or straight pieces between evenly spaced moments."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Drive:
    """Current [A] at evenly spaced moments from the start to `duration` [s], straight between; the last one lasts."""

    duration: float
    currents: tuple[float, ...]

    @classmethod
    def constant(cls, current: float) -> Drive:
        """One current for good."""
        return cls(np.inf, (current,))

    @classmethod
    def from_plain(cls, data: Mapping[str, Any]) -> Drive:
        """The drive that `plain` describes."""
        return cls(float(data["duration"]), tuple(float(current) for current in data["currents"]))

    def plain(self) -> dict[str, Any]:
        """As plain data, SI."""
        return {"duration": self.duration, "currents": list(self.currents)}

    def at(self, times: Array) -> Array:
        """Current at some times."""
        if len(self.currents) == 1:
            return np.full(np.shape(times), self.currents[0])
        return np.asarray(np.interp(times, np.linspace(0.0, self.duration, len(self.currents)), self.currents))

    def next_corner(self, time: float) -> float:
        """The first moment after `time` at which the current changes its slope; infinite where there is none."""
        if len(self.currents) == 1:
            return np.inf
        step = self.duration / (len(self.currents) - 1)
        corner = (np.floor(time / step + 1e-9) + 1.0) * step
        return float(corner) if corner <= self.duration * (1.0 + 1e-9) else np.inf

    @property
    def mean(self) -> float:
        """Mean current over the duration."""
        if len(self.currents) == 1:
            return self.currents[0]
        return float(np.mean(0.5 * (np.array(self.currents[1:]) + np.array(self.currents[:-1]))))
