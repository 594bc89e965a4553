"""The time limit of a command: one deadline, handed down to every step.

A step asks whether time is left before it starts, between its pieces, and in the solver between two iterations. What
is left out is noted on the deadline, and the first screen names it.
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable
from typing import TypeVar

from tvimdesign.base.errors import TimeOverError

CLOCK = "TVIMDESIGN_CLOCK"
"""The environment's word for what time limits count: `processor`, or the time of day by default."""


def _now() -> float:
    # A limit of processor time means the same on a machine with other work.
    return time.process_time() if os.environ.get(CLOCK) == "processor" else time.monotonic()


_Result = TypeVar("_Result")


class Deadline:
    """So many seconds from now on, or for ever."""

    def __init__(self, seconds: float = math.inf, now: Callable[[], float] = _now) -> None:
        """Start to count by the clock `now`."""
        self.seconds = seconds
        self._now = now
        self._end = now() + seconds
        self._whole, self._kept_back = self, 0.0
        self.met = False
        """True once a step was left undone because of it."""
        self.left_out: list[str] = []
        """The steps that were skipped or not finished, in words."""

    def leaving(self, seconds: float) -> Deadline:
        """Return the deadline of a part that leaves so many seconds, half of what is left at most, to what follows."""
        part = self._part()
        part.leave(seconds)
        return part

    @property
    def late(self) -> Deadline:
        """The deadline of what follows this part and may be skipped: it leaves half as much to what must follow."""
        part = self._part()
        part._kept_back = 0.5 * self._kept_back
        return part

    def _part(self) -> Deadline:
        part = Deadline(self.seconds, self._now)
        part._whole, part.left_out = self._whole, self.left_out
        return part

    def leave(self, seconds: float) -> None:
        """End so many seconds before the whole, but let no more pass than half of what that has left."""
        if math.isfinite(self.seconds):
            self._kept_back = max(self._kept_back, min(seconds, 0.5 * self._whole.remaining))

    @property
    def whole(self) -> Deadline:
        """The deadline of the command that this one is a part of."""
        return self._whole

    @property
    def remaining(self) -> float:
        """Seconds that are left, never less than nothing."""
        return max(self._whole._end - self._kept_back - self._now(), 0.0)

    @property
    def passed(self) -> bool:
        """True once the time is over; a caller that asks leaves something undone then."""
        self.met = self.met or self.remaining == 0.0
        return self.met

    def check(self, step: str) -> None:
        """Raise TimeOverError where the time is over: `step` is not done, or not finished."""
        if self.passed:
            raise TimeOverError(step, self.seconds)

    def leave_out(self, step: str) -> None:
        """Note a step that is skipped or not finished."""
        self.met = True
        if step not in self.left_out:
            self.left_out.append(step)

    def attempt(self, step: str, do: Callable[[], _Result]) -> _Result | None:
        """Return what a step comes to; where the time is over before, note the step and return None."""
        try:
            self.check(step)
            return do()
        except TimeOverError:
            self.leave_out(step)
            return None


NEVER = Deadline()  # The deadline of what has no time limit
