"""When a search has to come to its end, by the time limit of its study."""

from __future__ import annotations

import math
import time


class Deadline:
    """So many seconds from now on; whoever searches looks at it before the next run of the solver."""

    def __init__(self, seconds: float = math.inf) -> None:
        """Begin to count."""
        self.seconds = seconds
        self._end = time.monotonic() + seconds
        self.met = False
        """Whether anything was left undone because of it."""

    @property
    def remaining(self) -> float:
        """Seconds that are left, never less than nothing."""
        return max(self._end - time.monotonic(), 0.0)

    @property
    def passed(self) -> bool:
        """Whether the time is over; who asks leaves something undone then."""
        self.met = self.met or self.remaining == 0.0
        return self.met
