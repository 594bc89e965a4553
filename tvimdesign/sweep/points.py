"""Positions of a sweep's cells: the values of each axis as a study would write them, cell by cell."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.units import from_si, parse_quantity
from tvimdesign.study.sections.sweep_block import SweepBlock, SweptAxis, SweptRange

Texts = tuple[str, ...]
_DIGITS = 12
"""Of a number between two ends: as many as parse to the same value to 1e-12, and a table still shows."""


def written(axis: SweptAxis, value: float) -> str:
    """Return a number of an axis (SI) as a study would write it: `>= 12.5 N*m`."""
    text = f"{from_si(value, axis.unit):.{_DIGITS}g}"
    unit = "" if axis.unit == "1" else f" {axis.unit}"
    return f"{axis.sense} {text}{unit}".strip()


def axis_value(axis: SweptAxis, text: str) -> float | str:
    """Return a number of an axis in its unit, of a limit as well; a word as it is written."""
    if is_words(axis):
        return text
    return rounded(from_si(parse_quantity(text.lstrip("<>= "), axis.unit), axis.unit))


def is_words(axis: SweptAxis) -> bool:
    """Return whether an axis has no one number: words, settings, limits in both senses."""
    return not axis.unit or len(senses(axis)) > 1


def senses(axis: SweptAxis) -> set[str]:
    """Return `<=` and `>=`, as far as an axis has them."""
    if axis.range:
        return {axis.sense} if axis.sense else set()
    return {text.value.strip()[:2] for text in axis.values} & {"<=", ">="}


def rounded(value: float) -> float:
    """Round to twelve digits: a conversion of units adds noise in the sixteenth."""
    return float(f"{value:.{_DIGITS}g}") if math.isfinite(value) else value


@dataclass(frozen=True)
class CellPoints:
    """The cells of a sweep in their order: of a grid the last axis changes fastest."""

    block: SweepBlock

    @cached_property
    def count(self) -> int:
        """Return how many cells there are."""
        if self.block.method == "list":
            return len(self.block.rows)
        return self.block.count or math.prod(_length(axis) for axis in self.block.axes)

    def texts(self, cell: int) -> Texts:
        """Return what each axis is set to in a cell, by its number from 0."""
        axes = self.block.axes
        if self.block.method == "list":
            return tuple(text.value for text in self.block.rows[cell])
        if self.block.method == "grid":
            return tuple(_nth(axis, place) for axis, place in zip(axes, self._places(cell), strict=True))
        return tuple(_at_share(axis, share) for axis, share in zip(axes, self._shares[cell], strict=True))

    def _places(self, cell: int) -> Sequence[int]:
        places = []
        for axis in reversed(self.block.axes):
            cell, place = divmod(cell, _length(axis))
            places.append(place)
        return places[::-1]

    @cached_property
    def _shares(self) -> NDArray[np.float64]:
        """A row a cell of a sample, each number from 0 up to 1."""
        from scipy.stats import qmc

        axes, count, seed = len(self.block.axes), self.block.count, self.block.seed
        if self.block.method == "sobol":  # of a power of two, so that the sequence is balanced; the first are taken
            return qmc.Sobol(axes, rng=seed).random_base2(max(count - 1, 1).bit_length())[:count]
        return qmc.LatinHypercube(axes, rng=seed).random(count)

    def __getstate__(self) -> dict[str, SweepBlock]:
        """Return what a pickle holds; a sample is drawn again where it is read."""
        return {"block": self.block}


def _length(axis: SweptAxis) -> int:
    return axis.range.count if axis.range else len(axis.values)


def _nth(axis: SweptAxis, place: int) -> str:
    """Return a value of a grid: one of the list, or evenly between the ends."""
    if axis.range is None:
        return axis.values[place].value
    return written(axis, _between(axis.range, place / (axis.range.count - 1) if axis.range.count > 1 else 0.0))


def _at_share(axis: SweptAxis, share: float) -> str:
    """Return a value of a sample: each of a list, or each whole number, as often as the others."""
    span = axis.range
    if span is None:
        return axis.values[int(share * len(axis.values))].value
    if axis.whole:
        return written(axis, span.lower + math.floor(share * (span.upper - span.lower + 1.0)))
    return written(axis, _between(span, share))


def _between(span: SweptRange, share: float) -> float:
    if span.logarithmic:
        return float(span.lower * (span.upper / span.lower) ** share)
    return span.lower + share * (span.upper - span.lower)
