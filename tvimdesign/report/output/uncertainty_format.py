"""How the intervals of a result stand in results.json: what each value may be, and what to measure first."""

from __future__ import annotations

from typing import Literal

from typing_extensions import TypedDict

from tvimdesign.report.output.number_format import NumberEntry, closed

Shares = dict[str, float | None]


@closed
class IntervalEntry(NumberEntry):
    """What an output may be, given what nobody has measured: between `low` and `high` with 95 %, all moved together."""

    one_at_a_time: NumberEntry
    """Least and largest with one input at an end of its range."""
    shares: dict[str, float]
    """Share of the variance that knowing one input would take away; the first is what to measure first."""
    to_halve: list[str]
    """The fewest inputs to measure for half the width; none where no few do it."""
    before: NumberEntry | None
    """The same by the ranges that inputs had before a user's records measured them; none where none did."""


@closed
class UnmeasuredEntry(NumberEntry):
    """An input that nobody has measured, and the range it was moved in."""

    name: str
    status: str


@closed
class ShareEntry(TypedDict):
    """A share of what was drawn, and between what it lies with 95 %."""

    share: float
    low: float
    high: float


@closed
class UncertaintyEntry(TypedDict):
    """How sure a design is: what varies from part to part, and, apart from it, what nobody has measured."""

    parts_yield: ShareEntry | None
    """Modules that keep the limits, parts within their tolerances and all else as assumed."""
    modules: int
    limits: int
    left_out: list[str]
    tolerances: Literal["study", "standard"]
    ranges_hold: ShareEntry | None
    """Share of the ranges of what nobody has measured in which every limit is kept, parts as drawn."""
    draws: int
    held: dict[str, float]
    """That share for each limit that is not always kept, the least first."""
    intervals: dict[str, IntervalEntry]
    unmeasured: list[UnmeasuredEntry]
