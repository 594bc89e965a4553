"""Inputs that spread by a study's tolerances, or are unmeasured; intervals of outputs, and what to measure first.

A function takes one row for each input and one column a module, and returns one row for each output; nothing here knows
what a module is. All together, inputs are drawn evenly from their ranges, each for itself: nothing is known of their
distributions, and nothing of how they hang together.
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
from tvimdesign.solve.nlp.spread import Columns
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
    status: str  # How the value is known: assumed, calibrated, handbook, datasheet, measured
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


FREE_ANGLE = "preload_angle"  # The input that a spring's free angle adds to
_ALLOWS_FOR = {"free_angle_margin": FREE_ANGLE}
"""Rules of a design that allow for the spread of an input: no limits of modules in which that input is drawn."""


def judges_modules(limit: Constraint, spreading: Collection[str]) -> bool:
    """Return whether a limit is one of modules as made, in which some inputs spread, and not of the drawing alone."""
    return limit.origin == "require" or _ALLOWS_FOR.get(limit.output) not in spreading


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


COVERED = 0.95  # Share of what is drawn that an interval holds
_BINS = 8
"""Groups of equal size into which the draws are sorted by an input, to see how much of the variance lies between."""
_QUARTER = 0.25  # Share of the variance that is left of an interval of half the width
_LEAST = 0.02  # Least share of a variance that some hundred draws separate from none


@dataclass(frozen=True)
class Swing:
    """Output with one input at the low and at the high end of its range, all else as drawn; SI."""

    moved: UnmeasuredInput
    at_low: float
    at_high: float

    @property
    def size(self) -> float:
        """Largest change between the ends; infinite where the output never happens at one of them."""
        change = abs(self.at_high - self.at_low)
        return float(change) if np.isfinite(change) else np.inf


@dataclass(frozen=True)
class Interval:
    """Range of an output under unmeasured inputs; SI, infinite if it may never happen."""

    nominal: float
    low: float
    high: float  # Between these lie 95 % of the modules with all inputs anywhere in their ranges
    swings: tuple[Swing, ...]  # One input at a time, the largest first; those that move nothing are left out
    shares: dict[str, float]
    """Share of the variance within the interval that knowing one input would take away, the largest first."""

    @property
    def one_at_a_time(self) -> tuple[float, float]:
        """Least and largest value with one input at an end of its range."""
        ends = [end for swing in self.swings for end in (swing.at_low, swing.at_high)]
        return min([self.nominal, *ends]), max([self.nominal, *ends])

    @property
    def first(self) -> str:
        """The input to measure first: that with the largest share; empty where none stands out."""
        return next(iter(self.shares), "")

    @property
    def to_halve(self) -> tuple[str, ...]:
        """The fewest inputs that must be known to halve the interval; empty where their shares do not add up to it."""
        measured, left = [], 1.0
        for name, share in self.shares.items():
            measured.append(name)
            left -= share
            if left <= _QUARTER:
                return tuple(measured)
        return ()


def one_at_a_time(function: Columns, inputs: Sequence[UnmeasuredInput]) -> tuple[Array, Array]:
    """Outputs as drawn, one each; and with each input at its low and its high end: (outputs, inputs, 2)."""
    drawn = np.array([quantity.value for quantity in inputs])
    columns = np.repeat(drawn[:, None], 2 * len(inputs) + 1, axis=1)
    for i, quantity in enumerate(inputs):
        columns[i, 1 + 2 * i], columns[i, 2 + 2 * i] = quantity.low, quantity.high
    values = function(columns)
    return values[:, 0], values[:, 1:].reshape(len(values), len(inputs), 2)


def draw(inputs: Sequence[UnmeasuredInput], count: int, seed: int) -> Array:
    """Return a Latin hypercube over all ranges, one input a row; a seed gives the same points.

    Every input is as even as in Sobol points, and no two go together: some pairs of the fiftieth coordinates of a few
    hundred Sobol points do, and one input would carry the share of another.
    """
    (rng,) = np.random.default_rng(seed).spawn(1)  # as scipy's, half a second of import
    within = rng.uniform(size=(count, len(inputs))).T  # of each of `count` equal parts of a range, which is drawn once
    parts = np.tile(np.arange(1, count + 1), (len(inputs), 1))
    for row in parts:
        rng.shuffle(row)
    points = (parts - within) / count
    return np.array([quantity.ppf(row) for quantity, row in zip(inputs, points, strict=True)])


def intervals(
    function: Columns, inputs: Sequence[UnmeasuredInput], drawn: Array, values: Array, instead: float
) -> list[Interval]:
    """Return the interval of each output. `values` are outputs of `drawn`; `instead` replaces what never happens."""
    nominal, ends = one_at_a_time(function, inputs)
    return [
        _interval(inputs, float(as_drawn), at_ends, drawn, row, instead)
        for as_drawn, at_ends, row in zip(nominal, ends, values, strict=True)
    ]


def _interval(
    inputs: Sequence[UnmeasuredInput], nominal: float, ends: Array, drawn: Array, row: Array, instead: float
) -> Interval:
    happens = np.where(np.isnan(row), np.inf, row)
    low, high = covered(row)
    moved = [Swing(quantity, _or_never(a), _or_never(b)) for quantity, (a, b) in zip(inputs, ends, strict=True)]
    swings = sorted((swing for swing in moved if swing.at_low != swing.at_high), key=lambda swing: -swing.size)
    most = high if np.isfinite(high) else max(instead, low)
    within = np.clip(np.where(np.isfinite(happens), happens, instead), low, most)
    moving = {swing.moved.name for swing in swings}
    shares = {
        quantity.name: share_of_variance(column, within)
        for quantity, column in zip(inputs, drawn, strict=True)
        if quantity.name in moving
    }
    large = {name: share for name, share in shares.items() if share >= _LEAST}
    low, high = min(low, nominal), max(high, nominal)  # a value at an end of its range is none the less possible
    return Interval(nominal, low, high, tuple(swings), dict(sorted(large.items(), key=lambda item: -item[1])))


def covered(row: Array) -> tuple[float, float]:
    """Between what `COVERED` of the draws of an output lie; infinite where too many never happen."""
    happens = np.where(np.isnan(row), np.inf, row)
    outside = 0.5 * (1.0 - COVERED)
    low, high = (float(end) for end in np.quantile(happens, [outside, 1.0 - outside], method="inverted_cdf"))
    return low, high


def _or_never(value: float) -> float:
    return float("inf") if np.isnan(value) else float(value)


def share_of_variance(column: Array, values: Array) -> float:
    """First-order Sobol index from given draws: variance between groups of equal size, sorted by one input, over all.

    This is the correlation ratio, less what as many groups of a column of noise would have.
    """
    with np.errstate(over="ignore"):
        total, mean = float(np.var(values)), float(np.mean(values))
    if not 1e-18 * mean * mean < total < np.inf or len(values) < 2 * _BINS:  # the square of a large mean is infinite
        return 0.0
    groups = np.array_split(values[np.argsort(column, kind="stable")], _BINS)
    sizes, means = np.array([len(group) for group in groups]), np.array([np.mean(group) for group in groups])
    between = float(np.sum(sizes * (means - np.mean(values)) ** 2) / len(values))
    chance = (_BINS - 1.0) / (len(values) - 1.0)
    return max((between / total - chance) / (1.0 - chance), 0.0)
