"""Steady conduction in two dimensions by finite volumes: square cells of a conductivity of one, between walls."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import spsolve

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
BESIDE: list[tuple[Any, Any]] = [
    (np.s_[:-1], np.s_[1:]), (np.s_[1:], np.s_[:-1]), (np.s_[:, :-1], np.s_[:, 1:]), (np.s_[:, 1:], np.s_[:, :-1])
]  # fmt: skip
"""Cells, and those beside them, on all four sides."""


def conducted(inside: Mask, walls_at: Array, source: Array | float = 0.0) -> Array:
    """Return temperatures of the cells inside; those outside are walls where `walls_at` is a number, half a cell away.

    Other walls let no heat pass. `source` is heat into each cell.
    """
    number = np.cumsum(inside).reshape(inside.shape) - 1
    diagonal, right, links = np.zeros(inside.shape), np.where(inside, source, 0.0), []
    for here, there in BESIDE:
        linked, walled = inside[here] & inside[there], inside[here] & ~inside[there] & np.isfinite(walls_at[there])
        diagonal[here] += linked + 2.0 * walled
        right[here] += 2.0 * np.where(walled, walls_at[there], 0.0)
        links.append((number[here][linked], number[there][linked]))
    rows, columns = np.concatenate(links, axis=1)
    off = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(np.sum(inside),) * 2)
    temperatures = np.full(inside.shape, np.nan)
    temperatures[inside] = spsolve((diags(diagonal[inside]) - off).tocsc(), right[inside])
    return temperatures


def given_off(walls: Mask, temperatures: Array, walls_at: Array) -> float:
    """Return the heat that comes out of some walls into the cells beside them."""
    walls = walls & np.isnan(temperatures)
    return float(sum(np.nansum(2.0 * (walls_at[there] - temperatures[here])[walls[there]]) for here, there in BESIDE))
