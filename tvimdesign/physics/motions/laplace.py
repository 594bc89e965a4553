"""Back from a Laplace transform to time, by a weighted sum of its values at a few real places.

For what fades, or creeps, without ringing. Floats, arrays and symbols alike; no integration and no eigenvalues.
Source: Stehfest, Communications of the ACM 13 (1970) 47 and 624, algorithm 368.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import factorial, log
from typing import Any

import numpy as np

TERMS = 10
"""Terms of the sum, even. Each more pair brings a digit and takes one of rounding: within 4e-4 (tests), 1e-10."""


@cache
def weights(terms: int = TERMS) -> tuple[float, ...]:
    """Return the weights V_i of the transform at i ln(2)/t [1]; exact integers over integers, their sum is zero."""
    half = terms // 2
    weights = []
    for i in range(1, terms + 1):
        total = sum(
            k**half * factorial(2 * k)
            / (factorial(half - k) * factorial(k) * factorial(k - 1) * factorial(i - k) * factorial(2 * k - i))
            for k in range((i + 1) // 2, min(i, half) + 1)
        )  # fmt: skip
        weights.append((-1.0) ** (half + i) * total)
    return tuple(weights)


def inverse(transform: Callable[[Any], tuple[Any, ...]], time: Any, axes: int = 0) -> tuple[Any, ...]:
    """Return the values at a time [s] of what has the transforms F(s), s in 1/s: f(t) = ln(2)/t sum V_i F(i ln(2)/t).

    The transforms take all s at once, along the first axis; `axes` says how many axes the numbers in them have: none of
    floats and symbols.
    """
    along = (TERMS, *(1,) * axes)
    rate = log(2.0) / time
    places = np.reshape(np.arange(1.0, TERMS + 1.0), along) * rate
    scale = np.reshape(np.array(weights()), along)
    return tuple(rate * np.sum(scale * values, axis=0) for values in transform(places))
