"""Linear systems in time, exactly: the matrix exponential carries the state from each sample to the next.

Samples come in stretches of one step each. Steps that double from stretch to stretch resolve microseconds and hours in
a few hundred samples, and no step is too long for a stiff system.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Stretch = tuple[float, int]
"""(step [s], count of steps)."""
PER_STRETCH = 24  # samples of one doubling of time


def matrix_of(rates: Callable[..., Iterable[Array]], size: int) -> Array:
    """Matrix of linear equations x' = A x, read off them at the unit vectors; `rates` takes one argument a state."""
    return np.array([np.broadcast_to(row, size) for row in rates(*np.eye(size))])


def doubling(first: float, last: float) -> list[Stretch]:
    """Stretches from 0 to `last`: the first of step `first`, each later one of twice the step before."""
    found: list[Stretch] = []
    time, step = 0.0, min(first, last / PER_STRETCH)
    while time < last * (1.0 - 1e-9):
        count = min(PER_STRETCH, int(np.ceil((last - time) / step - 1e-9)))
        found.append((min(step, (last - time) / count), count))
        time, step = time + found[-1][0] * count, 2.0 * step
    return found


def times_of(stretches: Iterable[Stretch]) -> Array:
    """Sample times [s] of stretches, from 0 on."""
    return np.concatenate([[0.0], np.cumsum([step for step, count in stretches for _ in range(count)])])


def propagate(matrix: Array, start: Array, stretches: Iterable[Stretch]) -> Array:
    """States of x' = A x, one column a sample, from the start on."""
    from scipy.linalg import expm

    columns, known, last = [start], 0.0, np.eye(len(start))
    for step, count in stretches:
        if step != known:
            known, last = step, expm(matrix * step)
        for _ in range(count):
            columns.append(last @ columns[-1])
    return np.column_stack(columns)
