"""Factor matrices of one sparsity pattern without pivoting, and solve for many right-hand sides.

The pattern is gone through once, in Python: an order of little fill-in (Markowitz), and the list of what to subtract
where. Matrices here are `mass - h J` of a heat network, which are diagonally dominant for every step length.
Source: Davis, Direct Methods for Sparse Linear Systems (2006), ch. 6 and 7.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class Pattern(NamedTuple):
    """A square pattern with its fill-in. Rows and columns are in the order of elimination."""

    order: Integers  # Row and column of the matrix that is eliminated at each place
    size: int  # Count of entries, fill-in included
    diagonal: Integers  # Entry of each pivot
    below: Integers  # Entries below the pivots, column after column; `below_start` says where each column starts
    below_start: Integers
    target: Integers
    """Entries that elimination changes, pivot after pivot: `target -= left * upper`; `update_start` by pivot."""
    left: Integers
    upper: Integers
    update_start: Integers
    lower_entry: Integers  # Entries left of the diagonal, row after row, and their columns; `lower_start` by row
    lower_column: Integers
    lower_start: Integers
    upper_entry: Integers
    upper_column: Integers
    upper_start: Integers


def pattern_of(size: int, rows: Integers, columns: Integers) -> tuple[Pattern, Integers, Integers]:
    """Return the pattern of a matrix with these entries and a full diagonal.

    Then the entry of the factored matrix that each given one, and each one of the diagonal, is added to.
    """
    filled = np.eye(size, dtype=bool)
    filled[rows, columns] = True
    order = _order(filled.copy())
    place = np.empty(size, np.int64)
    place[order] = np.arange(size)
    filled = filled[np.ix_(order, order)]
    for k in range(size):
        filled[k + 1 :, k + 1 :] |= np.outer(filled[k + 1 :, k], filled[k, k + 1 :])
    entry = np.full((size, size), -1, np.int64)
    entry[filled] = np.arange(np.count_nonzero(filled))
    below = [entry[k + 1 + np.flatnonzero(filled[k + 1 :, k]), k] for k in range(size)]
    updates: list[tuple[Integers, Integers, Integers]] = []
    for k in range(size):
        i, j = k + 1 + np.flatnonzero(filled[k + 1 :, k]), k + 1 + np.flatnonzero(filled[k, k + 1 :])
        row, column = (part.ravel() for part in np.meshgrid(i, j, indexing="ij"))
        updates.append((entry[row, column], entry[row, k], entry[k, column]))
    lower, upper = np.tril(filled, -1), np.triu(filled, 1)
    target, left, upper_of = (np.concatenate([part[i] for part in updates]) for i in range(3))
    # Contiguous and writable whatever the size: of another layout, numba would compile every step anew.
    pattern = Pattern(
        order, int(np.count_nonzero(filled)), np.diagonal(entry).copy(),
        np.concatenate(below), _starts([len(part) for part in below]),
        target, left, upper_of, _starts([len(part[0]) for part in updates]),
        entry[lower], np.nonzero(lower)[1].copy(), _starts(lower.sum(axis=1).tolist()),
        entry[upper], np.nonzero(upper)[1].copy(), _starts(upper.sum(axis=1).tolist()),
    )  # fmt: skip
    return pattern, entry[place[rows], place[columns]], entry[place, place]


def _starts(counts: Sequence[int]) -> Integers:
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)


def _order(filled: NDArray[np.bool_]) -> Integers:
    """Return an order of elimination: next is always the diagonal entry that fills in least."""
    size = len(filled)
    left = np.ones(size, dtype=bool)
    order = np.empty(size, np.int64)
    for k in range(size):
        cost = (filled[:, left].sum(axis=1) - 1) * (filled[left].sum(axis=0) - 1)
        cost[~left] = np.iinfo(np.int64).max
        pivot = int(np.argmin(cost))
        order[k], left[pivot] = pivot, False
        filled |= np.outer(filled[:, pivot] & left, filled[pivot] & left)
    return order


@njit(cache=True, error_model="numpy")
def factor(p: Pattern, w: Array) -> None:
    """Factor the entries in place; pivots become their inverses."""
    for k in range(p.diagonal.size):
        inverse = 1.0 / w[p.diagonal[k]]
        w[p.diagonal[k]] = inverse
        for r in range(p.below_start[k], p.below_start[k + 1]):
            w[p.below[r]] *= inverse
        for r in range(p.update_start[k], p.update_start[k + 1]):
            w[p.target[r]] -= w[p.left[r]] * w[p.upper[r]]


@njit(cache=True, error_model="numpy")
def solve(p: Pattern, w: Array, b: Array) -> None:
    """Solve in place for one right-hand side in the order of elimination."""
    for i in range(b.size):
        value = b[i]
        for r in range(p.lower_start[i], p.lower_start[i + 1]):
            value -= w[p.lower_entry[r]] * b[p.lower_column[r]]
        b[i] = value
    for i in range(b.size - 1, -1, -1):
        value = b[i]
        for r in range(p.upper_start[i], p.upper_start[i + 1]):
            value -= w[p.upper_entry[r]] * b[p.upper_column[r]]
        b[i] = value * w[p.diagonal[i]]


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def solve_many(p: Pattern, w: Array, b: Array) -> None:
    """Solve in place for the columns of `b`."""
    lanes = b.shape[1]
    for i in range(b.shape[0]):
        to = b[i]
        for r in range(p.lower_start[i], p.lower_start[i + 1]):
            share, at = w[p.lower_entry[r]], b[p.lower_column[r]]
            for j in range(lanes):
                to[j] -= share * at[j]
    for i in range(b.shape[0] - 1, -1, -1):
        to = b[i]
        for r in range(p.upper_start[i], p.upper_start[i + 1]):
            share, at = w[p.upper_entry[r]], b[p.upper_column[r]]
            for j in range(lanes):
                to[j] -= share * at[j]
        inverse = w[p.diagonal[i]]
        for j in range(lanes):
            to[j] *= inverse
