"""Inputs that spread or are unmeasured.

Unmeasured inputs, known only within a range: of records, or the table's defaults.

A study's tolerances at one design: which inputs spread, and how far [SI].
"""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.record import Entry, Record
from tvimdesign.device import Input
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.solve.nlp import spread
from tvimdesign.solve.nlp.constraints import Constraint
from tvimdesign.study import Tolerance

Array = NDArray[np.float64]

DECADE = 10.0
"""High over low from which a range is drawn evenly in its logarithm: a contact of 1e3 to 1e5 W/m^2 K is known by its
order only."""


@dataclass(frozen=True)
class UnmeasuredInput:
    """An input with its value as drawn and the range in which it may lie; SI."""

    name: str
    value: float
    low: float
    high: float
    status: str
    """How the value is known: assumed, calibrated, handbook, datasheet, measured."""
    before: tuple[float, float] | None = None
    """Of one that a user's record has measured, the range in the record that is based on."""

    @property
    def logarithmic(self) -> bool:
        """Return whether only the order of magnitude is known."""
        return self.low > 0.0 and self.high >= DECADE * self.low

    def ppf(self, share: Any) -> Array:
        """Return the value below which a share of the range lies: even over the range, or over its logarithm."""
        share = np.asarray(share, dtype=float)
        if self.logarithmic:
            drawn: Array = self.low * np.exp(share * math.log(self.high / self.low))
        else:
            drawn = self.low + share * (self.high - self.low)
        return drawn


def unmeasured_inputs(resolved: ResolvedModule) -> list[UnmeasuredInput]:
    """Return the inputs that still have the value of a record, or of the table, that comes with a range.

    A value that the study sets is the study's own. One that was `measured` counts with the interval its record has, and
    is known where it has none.
    """
    unmeasured = []
    for row in resolved.table.inputs:
        if row.per_point or row.integer:
            continue
        known = _of_record(row, resolved) if row.record else _of_table(row, resolved)
        if known is not None and known.low < known.high:
            unmeasured.append(known)
    return unmeasured


def _of_record(row: Input, resolved: ResolvedModule) -> UnmeasuredInput | None:
    assert row.record is not None
    entry = _entry(resolved.values[row.record[0]], row.record[1])
    if entry is None:
        return _of_table(row, resolved)
    if entry.low is None or entry.high is None:
        return None
    known = _within(row, resolved, entry.value, (entry.low, entry.high), entry.status)
    before = _before(row, resolved.values[row.record[0]], row.record[1])
    if known is None or before is None:
        return known
    return replace(known, before=(max(before[0], row.lower), min(before[1], row.upper)))


def before_measuring(inputs: Sequence[UnmeasuredInput]) -> list[UnmeasuredInput]:
    """Return the inputs with their ranges before measurements; values outside move to the nearer end."""
    return [
        quantity
        if quantity.before is None
        else replace(
            quantity, low=min(quantity.before[0], quantity.value), high=max(quantity.before[1], quantity.value)
        )
        for quantity in inputs
    ]


def _before(row: Input, record: Any, field: str) -> tuple[float, float] | None:
    """Return the range of a measured value in the record it is based on, if nobody had measured it there.

    Of a record that is based on none, the range the input has without a record.
    """
    entry = _entry(record, field)
    if entry is None or entry.status != "measured":
        return None
    if record.based_on is None:
        return None if row.low is None or row.high is None else (row.low, row.high)
    earlier = record.based_on.entries.get(field)
    if earlier is None or earlier.status == "measured" or earlier.low is None or earlier.high is None:
        return None
    return earlier.low, earlier.high


def _of_table(row: Input, resolved: ResolvedModule) -> UnmeasuredInput | None:
    ends, status = (row.low, row.high), row.source.partition(": ")[0]
    if row.range_of is not None:
        entry = _entry(resolved.values[row.range_of[0]], row.range_of[1])
        if entry is None or entry.share_of_range is None:
            return None
        ends, status = entry.share_of_range, entry.status
    if ends[0] is None or ends[1] is None or row.default is None:
        return None
    return _within(row, resolved, row.default, (ends[0], ends[1]), status)


def _entry(record: Any, field: str) -> Entry | None:
    return record.entries.get(field) if isinstance(record, Record) else None


def _within(
    row: Input, resolved: ResolvedModule, value: float, ends: tuple[float, float], status: str
) -> UnmeasuredInput | None:
    """Return the input if its value is still that of the range, and a number that counts."""
    if row.name in resolved.study.module or resolved.values[row.name] != value:
        return None
    return UnmeasuredInput(row.name, value, max(ends[0], row.lower), min(ends[1], row.upper), status)


FREE_ANGLE = "preload_angle"
"""The input that a spring's free angle adds to."""
_ALLOWS_FOR = {"free_angle_margin": FREE_ANGLE}
"""Rules of a design that allow for the spread of an input: no limits of modules in which that input is drawn."""
_OF_THE_DRAWING = frozenset(("adjuster_ledge_margin",))
"""Rules against steps and slivers that are drawn: what a module as made has there is its spread."""


def judges_modules(limit: Constraint, spreading: Collection[str]) -> bool:
    """Return whether a limit is one of modules as made, in which some inputs spread, and not of the drawing alone."""
    drawn_alone = limit.output in _OF_THE_DRAWING or _ALLOWS_FOR.get(limit.output) in spreading
    return limit.origin == "require" or not drawn_alone


def contributors_of(resolved: ResolvedModule, adjusted: bool | None = None) -> list[spread.Contributor]:
    """Return the study's tolerances at this design; `adjusted` decides on all those that can be adjusted.

    A constant current in whose place one follows a profile spreads nothing.
    """
    contributors = []
    for name, tolerance in resolved.study.tolerances.items():
        if name in resolved.replaced:
            continue
        row = resolved.table.quantity(name)
        assert isinstance(row, Input)  # the reader sees to that
        value = float(resolved.values[name])
        size = plus_minus(resolved, value, tolerance)
        can_be = tolerance.adjustable or tolerance.adjusted_to is not None
        if tolerance.adjustable if adjusted is None else adjusted and can_be:
            size = min(size, tolerance.adjusted_to or 0.0)
        if size > 0.0:
            kind, sigma = tolerance.distribution, tolerance.sigma
            contributors.append(spread.Contributor(name, value, size, kind, sigma, row.lower, row.upper))
    return contributors


def plus_minus(resolved: ResolvedModule, value: float, tolerance: Tolerance) -> float:
    """Return a tolerance to either side [SI] of an input with this value."""
    if tolerance.row is not None:
        return float(resolved.quantity(tolerance.row))
    return abs(value) * tolerance.share if tolerance.share is not None else float(tolerance.plus_minus or 0.0)
