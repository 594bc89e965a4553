"""Format of numbers in JSON files of results, and the head that each such file begins with.

One unit system: every bare number is in SI. A number that people read in another unit stands under `value`, `low` and
`high` with its `unit`, and under `si` once more in SI. What never happens is null.
"""

from __future__ import annotations

import math
from typing import Literal

from pydantic import ConfigDict, with_config
from typing_extensions import TypedDict

from tvimdesign.base.units import from_si, pretty, si_unit

FORMAT: Literal[1] = 1
"""Version of results.json, compare.json, findings.json and tolerances.json; a change that breaks a reader raises it."""
UNITS: Literal["SI"] = "SI"
closed = with_config(ConfigDict(extra="forbid"))
"""For an entry that has no other keys than its own."""


class Head(TypedDict):
    """The first entries of every JSON file of results."""

    format: Literal[1]
    units: Literal["SI"]


def head() -> Head:
    """Return the first entries of a JSON file of results."""
    return {"format": FORMAT, "units": UNITS}


@closed
class InSi(TypedDict):
    """A number and what it may lie between, in SI."""

    value: float | None
    low: float | None
    high: float | None
    unit: str


@closed
class NumberEntry(TypedDict):
    """A number in the unit people read, and in SI. `low` and `high` are None where no range is known."""

    value: float | None
    low: float | None
    high: float | None
    unit: str
    si: InSi


Ends = tuple[float | None, float | None]


def number_entry(value: float, unit: str, ends: Ends | None = None) -> NumberEntry:
    """Return a number (SI) of a quantity people read in `unit`, with its range (SI) if that is known."""
    low, high = ends or (None, None)

    def shown(number: float | None) -> float | None:
        return None if number is None else finite(from_si(number, unit))

    return {
        "value": shown(value),
        "low": shown(low),
        "high": shown(high),
        "unit": pretty(unit),
        "si": {"value": finite(value), "low": finite(low), "high": finite(high), "unit": pretty(si_unit(unit))},
    }


def finite(value: float | None) -> float | None:
    """Return a number, or None for what never happens: JSON has no infinity."""
    return value if value is not None and math.isfinite(value) else None
