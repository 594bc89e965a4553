"""What a user's measurements buy: the values of a run whose intervals are narrower than before them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from tvimdesign.report.output.tables import number
from tvimdesign.report.run.first_screen.layout import listed

_TOLD = 3
"""Values that the screen tells; summary.txt has all."""
_LEAST = 0.05
"""Share of an interval that must be gone for it to be told."""
_NOTHING = 1e-3
"""Width of an interval, as a share of its value, that is none."""


def measured_lines(uncertainty: Mapping[str, Any], width: int) -> list[str]:
    """What was measured, and the intervals that shrink most by it, before and after."""
    names = [one["name"] for one in uncertainty.get("unmeasured", ()) if one["status"] == "measured"]
    gains = shrunk(uncertainty.get("intervals", {}))
    if not names or not gains:
        return []
    said = [f"{name} {now}, before {before}" for name, before, now, _ in gains[:_TOLD]]
    return listed("Measured", [f"{', '.join(names)}: {'; '.join(said)}"], width)


def shrunk(intervals: Mapping[str, Any]) -> Sequence[tuple[str, str, str, float]]:
    """(output, interval before, now, share of its width that is gone) of those that shrink, the most first."""
    found = []
    for name, entry in intervals.items():
        before = entry.get("before")
        if before is None or None in (entry["low"], entry["high"]):
            continue
        wide = float("inf") if before["high"] is None else _width(before)
        if wide > _NOTHING * abs(entry["value"]) and (gone := 1.0 - _width(entry) / wide) >= _LEAST:
            found.append((name, ends_in_words(before), f"{ends_in_words(entry)} {entry['unit']}".rstrip(), gone))
    return sorted(found, key=lambda one: -one[3])


def _width(entry: Mapping[str, Any]) -> float:
    return float(entry["high"] - entry["low"])


def ends_in_words(entry: Mapping[str, Any]) -> str:
    """`38 to 104`, the low and the high end of an interval."""
    low, high = ("never" if end is None else number(end, 3) for end in (entry["low"], entry["high"]))
    return f"{low} to {high}"
