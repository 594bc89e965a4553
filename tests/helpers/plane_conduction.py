"""Steady conduction in two dimensions by finite volumes: square cells of a conductivity of one, between walls."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, diags, eye, kron
from scipy.sparse.linalg import spsolve

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
BESIDE: list[tuple[Any, Any]] = [
    (np.s_[:-1], np.s_[1:]), (np.s_[1:], np.s_[:-1]), (np.s_[:, :-1], np.s_[:, 1:]), (np.s_[:, 1:], np.s_[:, :-1])
]  # fmt: skip
"""Cells, and those beside them, on all four sides."""


def along_a_row(count: int, length: float, first: float, last: float) -> Array:
    """Conduction along a row of cells; at either end 2 where it is held at 0, 0 where nothing passes."""
    diagonal = np.full(count, 2.0)
    diagonal[0], diagonal[-1] = 1.0 + first, 1.0 + last
    return (np.diag(diagonal) - np.eye(count, k=1) - np.eye(count, k=-1)) * (count / length) ** 2


def in_rectangle(source: Array, along: tuple[float, float, float], across: tuple[float, float, float]) -> Array:
    """Return temperatures of a rectangle of a heat source per area, of lengths and ends as of the two rows."""
    x, y = (along_a_row(count, *way) for count, way in zip(source.shape, (along, across), strict=True))
    inside = kron(x, eye(source.shape[1])) + kron(eye(source.shape[0]), y)
    return np.asarray(spsolve(inside.tocsc(), source.ravel())).reshape(source.shape)


def conducted(inside: Mask, walls_at: Array, source: Array | float = 0.0, contact: float = 0.0) -> Array:
    """Return temperatures of the cells inside; those outside are walls where `walls_at` is a number, half a cell away.

    A contact is as thick as so many cells more. Other walls let no heat pass. `source` is heat into each cell.
    """
    to_wall = 1.0 / (0.5 + contact)
    number = np.cumsum(inside).reshape(inside.shape) - 1
    diagonal, right, links = np.zeros(inside.shape), np.where(inside, source, 0.0), []
    for here, there in BESIDE:
        linked, walled = inside[here] & inside[there], inside[here] & ~inside[there] & np.isfinite(walls_at[there])
        diagonal[here] += linked + to_wall * walled
        right[here] += to_wall * np.where(walled, walls_at[there], 0.0)
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
