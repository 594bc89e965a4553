"""Many small symmetric systems solved at once, each made positive definite where it is not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_LEAST_PIVOT = 1e-11
_FIRST_ADDED, _MORE, _MOST_ADDED = 1e-4, 8.0, 1e8
"""What is added to a diagonal of ones: at first, times what it grows, and where it ends."""


def solve_definite(matrix: Array, right: Array) -> Array:
    """Solve every column's system, `matrix` [size, size, columns], with enough added to the diagonals that need it.

    Columns are scaled to diagonals of one before. Those that nothing makes positive definite are answered with zero.
    """
    size, _, count = matrix.shape
    scale = 1.0 / np.sqrt(np.maximum(np.abs(np.einsum("nnk->nk", matrix)), np.finfo(float).tiny))
    scaled, turned = matrix * scale[:, None] * scale, right * scale
    added, found = np.zeros(count), np.zeros((size, count))
    left = np.arange(count)
    while len(left):
        part = scaled[:, :, left]
        np.einsum("nnk->nk", part)[:] += added[left]
        sound = _factorise(part)
        found[:, left[sound]] = _substitute(part[:, :, sound], turned[:, left[sound]])
        left = left[~sound]
        added[left] = np.maximum(_FIRST_ADDED, _MORE * added[left])
        left = left[added[left] < _MOST_ADDED]
    answered: Array = found * scale
    return answered


def _factorise(matrix: Array) -> NDArray[np.bool_]:
    """Put Cholesky's factors in the lower triangles; which columns have any."""
    sound = np.ones(matrix.shape[2], dtype=bool)
    for i in range(len(matrix)):
        sound &= matrix[i, i] > _LEAST_PIVOT
        matrix[i:, i] /= np.sqrt(np.where(sound, matrix[i, i], 1.0))
        for j in range(i + 1, len(matrix)):
            matrix[j:, j] -= matrix[j:, i] * matrix[j, i]
    return sound


def _substitute(factors: Array, right: Array) -> Array:
    x = right.copy()
    for i in range(len(x)):
        x[i] = (x[i] - (factors[i, :i] * x[:i]).sum(axis=0)) / factors[i, i]
    for i in reversed(range(len(x))):
        x[i] = (x[i] - (factors[i + 1 :, i] * x[i + 1 :]).sum(axis=0)) / factors[i, i]
    return x
