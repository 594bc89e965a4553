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


def conducted(inside: Mask, kept: Array, source: Array | float = 0.0) -> Array:
    """Temperatures of the cells inside; those outside are walls where `kept` is a number, half a cell away.

    Other walls let no heat pass. `source` is heat into each cell.
    """
    number = np.cumsum(inside).reshape(inside.shape) - 1
    diagonal, right, links = np.zeros(inside.shape), np.where(inside, source, 0.0), []
    for here, there in BESIDE:
        linked, walled = inside[here] & inside[there], inside[here] & ~inside[there] & np.isfinite(kept[there])
        diagonal[here] += linked + 2.0 * walled
        right[here] += 2.0 * np.where(walled, kept[there], 0.0)
        links.append((number[here][linked], number[there][linked]))
    rows, columns = np.concatenate(links, axis=1)
    off = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(np.sum(inside),) * 2)
    found = np.full(inside.shape, np.nan)
    found[inside] = spsolve((diags(diagonal[inside]) - off).tocsc(), right[inside])
    return found


def given_off(walls: Mask, found: Array, kept: Array) -> float:
    """Heat that comes out of some walls into the cells beside them."""
    walls = walls & np.isnan(found)
    return float(sum(np.nansum(2.0 * (kept[there] - found[here])[walls[there]]) for here, there in BESIDE))
