"""How long work that counts itself still takes, from what it says: `start 2 of 3`."""

from __future__ import annotations

import re

_COUNTED = re.compile(r"(?P<of>.*?)(?P<done>\d+) of (?:about )?(?P<all>\d+)")


class RemainingTime:
    """What is left of a series, by the mean time of those of its steps that are done; unknown before the first is.

    What is said between two steps belongs to the one before it; after the last step it is something else.
    """

    def __init__(self) -> None:
        """Nothing has been said."""
        self._series: tuple[str, str] | None = None
        self._first, self._began = 0, 0.0
        self._end: float | None = None
        self._last = False

    def heard(self, text: str, now: float) -> None:
        """Take what is said at a time [s]: a step that begins says its number."""
        found = _COUNTED.match(text)
        if found is None:
            self._end = None if self._last else self._end
            return
        number, last = int(found["done"]), int(found["all"])
        self._last = number >= last
        if self._series != (found["of"], found["all"]) or number < self._first:
            self._series = (found["of"], found["all"])
            self._first, self._began, self._end = number, now, None
        elif self._first < number <= last:
            each = (now - self._began) / (number - self._first)
            self._end = now + each * (last - number + 1)

    def left(self, now: float) -> float | None:
        """Seconds that are left; None where nothing can be said of it."""
        return None if self._end is None else max(self._end - now, 0.0)


def clock(elapsed: float, left: float | None) -> str:
    """`12 s, about 30 s left`; nothing within the first second."""
    if elapsed < 1.0:
        return ""
    return duration(elapsed) + ("" if left is None or left < 1.0 else f", about {duration(left)} left")


def duration(seconds: float) -> str:
    """`8 s`, `2 min 05 s`, `1 h 12 min`."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    return f"{whole // 3600} h {whole % 3600 // 60:02d} min"
