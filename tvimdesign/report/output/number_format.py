"""How a number stands in a JSON file of results, and what each such file begins with.

One unit system: every bare number is in SI. A number that people read in another unit stands under `value`, `low` and
`high` with its `unit`, and under `si` once more in SI. What never happens is null.
"""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, with_config
from typing_extensions import TypedDict

FORMAT: Literal[1] = 1
"""Version of results.json, compare.json, findings.json and tolerances.json; a change that breaks a reader raises it."""
UNITS: Literal["SI"] = "SI"
closed = with_config(ConfigDict(extra="forbid"))
"""For an entry that has no other keys than its own."""


class Head(TypedDict):
    """What every JSON file of results begins with."""

    format: Literal[1]
    units: Literal["SI"]


def head() -> Head:
    """The first entries of a JSON file of results."""
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
    """A number in the unit people read, and in SI. `low` and `high` are None where nothing is said of a range."""

    value: float | None
    low: float | None
    high: float | None
    unit: str
    si: InSi
