"""When a search has to come to its end, by the time limit of its study."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager

CLOCK = "TVIMDESIGN_CLOCK"
"""The environment's word for what time limits count: `processor`, or the time of day where nothing is said."""


def counts_processor_time() -> bool:
    """Whether the environment asks for that: such a limit means the same on a machine with other work."""
    return os.environ.get(CLOCK) == "processor"


def ipopt_limit() -> str:
    """IPOPT's name of a limit of the time that is counted."""
    return "max_cpu_time" if counts_processor_time() else "max_wall_time"


def _now() -> float:
    return time.process_time() if counts_processor_time() else time.monotonic()


class Deadline:
    """So many seconds from now on; whoever searches looks at it before the next run of the solver."""

    def __init__(self, seconds: float = math.inf) -> None:
        """Begin to count."""
        self.seconds = seconds
        self._end = _now() + seconds
        self.met = False
        """Whether anything was left undone because of it."""

    @property
    def remaining(self) -> float:
        """Seconds that are left, never less than nothing."""
        return max(self._end - _now(), 0.0)

    @property
    def passed(self) -> bool:
        """Whether the time is over; who asks leaves something undone then."""
        self.met = self.met or self.remaining == 0.0
        return self.met

    @contextmanager
    def paused(self) -> Iterator[None]:
        """Do not count what is done meanwhile."""
        began = _now()
        try:
            yield
        finally:
            self._end += _now() - began
