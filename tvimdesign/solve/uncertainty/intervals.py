"""Intervals of outputs from ranges of unmeasured inputs: one at a time, all together, and what to measure first.

A function takes one row for each input and one column a module, and returns one row for each output; nothing here knows
what a module is. All together, inputs are drawn evenly from their ranges, each for itself: nothing is known of their
distributions, and nothing of how they hang together.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.solve.nlp.spread import Columns
from tvimdesign.solve.uncertainty.uncertain_inputs import UnmeasuredInput

Array = NDArray[np.float64]

COVERED = 0.95
"""Share of what is drawn that an interval holds."""
_BINS = 8
"""Groups of equal size into which the draws are sorted by an input, to see how much of the variance lies between."""
_QUARTER = 0.25
"""Share of the variance that is left of an interval of half the width."""
_LEAST = 0.02
"""Least share of a variance that some hundred draws separate from none."""


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
    high: float
    """Between these lie 95 % of the modules with all inputs anywhere in their ranges."""
    swings: tuple[Swing, ...]
    """One input at a time, the largest first; those that move nothing are left out."""
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
