"""Interval arithmetic on arrays of boxes, rounded outwards: what a result can be, wherever its operands lie.

`low` and `high` hold one end for each box; results contain every value of the exact operation and of the rounded one.
Where an operand leaves the domain of an operation, the result is everything and is no longer `whole`.
Source: Moore, Kearfott and Cloud, Introduction to Interval Analysis (2009), ch. 2 and 5.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.simulation.casadi_setup import ca

Array = NDArray[np.float64]
_LIBRARY = 8.0
"""Units in the last place by which a library's exp, log or sine may be off, generously; the C library's are below 2."""


@dataclass(frozen=True)
class Interval:
    """An interval for each box."""

    low: Array
    high: Array
    whole: NDArray[np.bool_]
    """Where everything it was computed from is defined throughout the box, and without jumps."""


def point(value: float) -> Interval:
    """One number, the same in every box."""
    number = np.array([value])
    return Interval(number, number, np.array([True]))


def _outwards(low: Array, high: Array, whole: NDArray[np.bool_]) -> Interval:
    """Ends of an operation that is rounded to the nearest number: the next one beyond, everything where undefined."""
    low, high = np.nextafter(low, -np.inf), np.nextafter(high, np.inf)
    return Interval(np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high), whole)


def _library(low: Array, high: Array, whole: NDArray[np.bool_]) -> Interval:
    """Ends of a function that the library computes to a few units in the last place."""
    with np.errstate(invalid="ignore"):
        return _outwards(low - _LIBRARY * np.spacing(np.abs(low)), high + _LIBRARY * np.spacing(np.abs(high)), whole)


def add(a: Interval, b: Interval) -> Interval:
    """a + b."""
    return _outwards(a.low + b.low, a.high + b.high, a.whole & b.whole)


def subtract(a: Interval, b: Interval) -> Interval:
    """a - b."""
    return _outwards(a.low - b.high, a.high - b.low, a.whole & b.whole)


def negative(a: Interval) -> Interval:
    """-a."""
    return Interval(-a.high, -a.low, a.whole)


def _corners(a: Interval, b: Interval, operation: Callable[[Array, Array], Array]) -> tuple[Array, Array]:
    """Least and largest of an operation at the four corners; 0 times infinity is 0: such an end is not reached."""
    found = [operation(x, y) for x in (a.low, a.high) for y in (b.low, b.high)]
    found = [np.where(np.isnan(one), 0.0, one) for one in found]
    return (
        np.minimum(np.minimum(found[0], found[1]), np.minimum(found[2], found[3])),
        np.maximum(np.maximum(found[0], found[1]), np.maximum(found[2], found[3])),
    )


def multiply(a: Interval, b: Interval) -> Interval:
    """a b."""
    return _outwards(*_corners(a, b, np.multiply), a.whole & b.whole)


def square(a: Interval) -> Interval:
    """a^2, which is never negative."""
    ends = a.low**2, a.high**2
    low = np.where((a.low <= 0.0) & (a.high >= 0.0), 0.0, np.minimum(*ends))
    found = _outwards(low, np.maximum(*ends), a.whole)
    return Interval(np.maximum(found.low, 0.0), found.high, found.whole)


def twice(a: Interval) -> Interval:
    """2 a."""
    return Interval(2.0 * a.low, 2.0 * a.high, a.whole)


def divide(a: Interval, b: Interval) -> Interval:
    """a/b."""
    apart = (b.low > 0.0) | (b.high < 0.0)
    low, high = _corners(a, b, np.divide)
    return _outwards(np.where(apart, low, np.nan), np.where(apart, high, np.nan), a.whole & b.whole & apart)


def inverse(a: Interval) -> Interval:
    """1/a."""
    return divide(point(1.0), a)


def _rising(
    function: Callable[[Array], Array], least: float = -np.inf, most: float = np.inf
) -> Callable[[Interval], Interval]:
    """A function that rises between the ends of its domain."""

    def applied(a: Interval) -> Interval:
        inside = (a.low >= least) & (a.high <= most)
        none = (a.high < least) | (a.low > most)
        low, high = function(np.clip(a.low, least, most)), function(np.clip(a.high, least, most))
        return _library(np.where(none, np.nan, low), np.where(none, np.nan, high), a.whole & inside)

    return applied


square_root = _rising(np.sqrt, least=0.0)
exponential = _rising(np.exp)
logarithm = _rising(np.log, least=0.0)
logarithm_of_one_more = _rising(np.log1p, least=-1.0)
arcsine = _rising(np.arcsin, -1.0, 1.0)
arctangent = _rising(np.arctan)


def power(a: Interval, b: Interval) -> Interval:
    """a^b of a positive a; everything where a may be zero or less."""
    positive = a.low > 0.0
    low, high = _corners(
        Interval(np.where(positive, a.low, 1.0), np.where(positive, a.high, 1.0), a.whole), b, np.power
    )
    return _library(np.where(positive, low, np.nan), np.where(positive, high, np.nan), a.whole & b.whole & positive)


def cosine(a: Interval) -> Interval:
    """cos a: 1 where a full turn lies within, -1 where half a turn does."""
    ends = np.cos(a.low), np.cos(a.high)
    # A turn more than there is can only widen the result; the margin covers the rounding of a/(2 pi).
    low = np.where(_has_turn(a, 0.5), -1.0, np.minimum(*ends))
    high = np.where(_has_turn(a, 0.0), 1.0, np.maximum(*ends))
    found = _library(low, high, a.whole)
    return Interval(np.maximum(found.low, -1.0), np.minimum(found.high, 1.0), found.whole)


def _has_turn(a: Interval, share: float) -> NDArray[np.bool_]:
    """Whether whole turns and a share of one more lie within, or next to, an interval of angles."""
    turns = a.low / (2.0 * np.pi) - share, a.high / (2.0 * np.pi) - share
    margin = 1e-12 * (1.0 + np.maximum(np.abs(turns[0]), np.abs(turns[1])))
    return np.asarray(np.floor(turns[1] + margin) >= np.ceil(turns[0] - margin))


_QUARTER = Interval(np.array([np.pi / 2.0]), np.nextafter(np.array([np.pi / 2.0]), 2.0), np.array([True]))


def sine(a: Interval) -> Interval:
    """sin a = cos(a - pi/2)."""
    return cosine(subtract(a, _QUARTER))


def arctangent_of(a: Interval, b: Interval) -> Interval:
    """atan2(a, b) of a positive b; anything else is a full turn and not whole."""
    right = b.low > 0.0
    low, high = _corners(a, b, np.arctan2)
    return _library(np.where(right, low, -np.pi), np.where(right, high, np.pi), a.whole & b.whole & right)


def least(a: Interval, b: Interval) -> Interval:
    """The lesser of two. CasADi's fmin passes over what is no number, so that the other may be the result."""
    high = np.where(a.whole & b.whole, np.minimum(a.high, b.high), np.maximum(_passed(a, b), _passed(b, a)))
    return Interval(np.minimum(a.low, b.low), high, a.whole & b.whole)


def _passed(a: Interval, b: Interval) -> Array:
    """The upper end of what is left where the other may be no number."""
    return np.where(b.whole, -np.inf, a.high)


def largest(a: Interval, b: Interval) -> Interval:
    """The larger of two."""
    return negative(least(negative(a), negative(b)))


def size(a: Interval) -> Interval:
    """|a|."""
    apart = np.maximum(np.maximum(a.low, -a.high), 0.0)
    return Interval(apart, np.maximum(np.abs(a.low), np.abs(a.high)), a.whole)


def at_most(a: Interval, b: Interval) -> Interval:
    """1 where a <= b, 0 elsewhere; where both happen, all between, which is a kink's slope."""
    low, high = np.where((a.high <= b.low) & a.whole & b.whole, 1.0, 0.0), np.where(a.low <= b.high, 1.0, 0.0)
    return Interval(low, high, a.whole & b.whole)


def negation(a: Interval) -> Interval:
    """1 where a is 0, 0 elsewhere, and all between."""
    return Interval(1.0 - np.minimum(a.high, 1.0), 1.0 - np.maximum(a.low, 0.0), a.whole)


def sign(a: Interval) -> Interval:
    """-1, 0 or 1, and all between where zero lies within."""
    return Interval(np.where(a.low > 0.0, 1.0, -1.0), np.where(a.high < 0.0, -1.0, 1.0), a.whole)


def anything(*operands: Interval) -> Interval:
    """What is known of an operation that has no rule here: nothing."""
    shape = np.broadcast_shapes(*(operand.low.shape for operand in operands))
    return Interval(np.full(shape, -np.inf), np.full(shape, np.inf), np.zeros(shape, dtype=bool))


OPERATIONS: dict[int, Callable[..., Interval]] = {
    ca.OP_ASSIGN: lambda a: a,
    ca.OP_ADD: add, ca.OP_SUB: subtract, ca.OP_MUL: multiply, ca.OP_DIV: divide,
    ca.OP_NEG: negative, ca.OP_SQ: square, ca.OP_TWICE: twice, ca.OP_INV: inverse,
    ca.OP_SQRT: square_root, ca.OP_EXP: exponential, ca.OP_LOG: logarithm, ca.OP_LOG1P: logarithm_of_one_more,
    ca.OP_POW: power, ca.OP_CONSTPOW: power,
    ca.OP_SIN: sine, ca.OP_COS: cosine, ca.OP_ASIN: arcsine, ca.OP_ATAN: arctangent, ca.OP_ATAN2: arctangent_of,
    ca.OP_FMIN: least, ca.OP_FMAX: largest, ca.OP_FABS: size, ca.OP_LE: at_most, ca.OP_NOT: negation,
    ca.OP_SIGN: sign,
}  # fmt: skip
"""What each of CasADi's scalar operations does to intervals; for others nothing is claimed."""
