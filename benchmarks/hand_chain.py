"""Linear equations of the chain of cells that `hand_switch.py` steps through, by hand for numba.

The chain is tridiagonal; thirteen bodies, the middle of the pads' legs, the mean temperature of the plate and that of
the hot side once more are bordered onto it; seven of them touch it (`TOUCHING`). Order: cold side, hot side, cells of
the layer, cells of the plate; beside the plate three bodies from its edge on and the core; around the pads three
bodies of their height from the edge on, three below those, the ledges, the corner next to the hot sides, the rest of
the housing; the legs' middle; the mean of the plate's cells; the hot side.
"""

from __future__ import annotations

import numpy as np
from hand_module import Array
from numba import njit

CELLS, PLATE, BODIES = 12, 8, 13
CHAIN = 2 + CELLS + PLATE
BORDER = BODIES + 3
STATES = CHAIN + BORDER
TOUCHING = np.array([0, 4, 10, 11, 13, 14, 15])
"""Of the border: the first beside the plate, the first around the pads, the ledges, the corner, the legs, the plate's
mean, the hot side."""
TOUCH = TOUCHING.size
ROWS = 3 + 2 * TOUCH + BORDER
"""Rows of a matrix: below, on and above the chain's diagonal; what the chain has from each that touches it; what it
gives to each; then the border among itself."""


@njit(cache=True)
def chain_solve(w: Array, b: Array) -> None:
    """Put the solution of the chain alone in the place of `b`."""
    b[0] *= w[1, 0]
    for i in range(1, CHAIN):
        b[i] = (b[i] - w[0, i] * b[i - 1]) * w[1, i]
    for i in range(CHAIN - 2, -1, -1):
        b[i] -= w[2, i] * b[i + 1]


@njit(cache=True)
def factor(a: Array, h: float, w: Array) -> None:
    """Factors of I - h A: the chain by Thomas, then what is left of the border by Gauss.

    The last two rows say that they are the plate's mean and the hot side: they have no step.
    """
    for i in range(CHAIN):
        below, above = -h * a[0, i], -h * a[2, i]
        pivot = 1.0 - h * a[1, i] - (below * w[2, i - 1] if i else 0.0)
        w[0, i], w[1, i], w[2, i] = below, 1.0 / pivot, above / pivot
        for t in range(TOUCH):
            w[3 + t, i] = -h * a[3 + t, i]
            w[3 + TOUCH + t, i] = -(h if t + 2 < TOUCH else 1.0) * a[3 + TOUCH + t, i]
    for t in range(TOUCH):
        chain_solve(w, w[3 + t])
    left, among = w[3 + 2 * TOUCH :], a[3 + 2 * TOUCH :]
    for i in range(BORDER):
        for j in range(BORDER):
            left[i, j] = (1.0 if i == j else 0.0) - h * among[i, j]
    for t in range(TOUCH):
        for s in range(TOUCH):
            for i in range(CHAIN):
                left[TOUCHING[t], TOUCHING[s]] -= w[3 + TOUCH + t, i] * w[3 + s, i]
    for k in range(BORDER):
        for i in range(k + 1, BORDER):
            if left[i, k] != 0.0:
                left[i, k] /= left[k, k]
                for j in range(k + 1, BORDER):
                    left[i, j] -= left[i, k] * left[k, j]


@njit(cache=True)
def solve(w: Array, b: Array) -> None:
    """Put the solution of (I - h A) x = b in the place of `b`."""
    chain_solve(w, b)
    left, x = w[3 + 2 * TOUCH :], b[CHAIN:]
    for t in range(TOUCH):
        for i in range(CHAIN):
            x[TOUCHING[t]] -= w[3 + TOUCH + t, i] * b[i]
    for i in range(1, BORDER):
        for j in range(i):
            x[i] -= left[i, j] * x[j]
    for i in range(BORDER - 1, -1, -1):
        for j in range(i + 1, BORDER):
            x[i] -= left[i, j] * x[j]
        x[i] /= left[i, i]
    for t in range(TOUCH):
        for i in range(CHAIN):
            b[i] -= w[3 + t, i] * x[TOUCHING[t]]
