"""Linear equations of the chain of cells that `hand_switch.py` steps through, by hand for numba.

The chain is tridiagonal; eight bodies are bordered onto it, of which two touch it: the first beside the plate touches
all of the plate's cells, the first around the pads both sides of the pads and all cells of the layer. Order: cold side,
hot side, cells of the layer, cells of the plate, bodies beside the plate from its edge on, the core last of them,
bodies around the pads from their edge on.
"""

from __future__ import annotations

from hand_module import Array
from numba import njit

CELLS, PLATE, BODIES = 12, 8, 8
CHAIN = 2 + CELLS + PLATE
STATES = CHAIN + BODIES
AROUND = 4
"""Place among the bodies of the first around the pads; the first beside the plate has place 0."""
ROWS = 7 + BODIES
"""Rows of a matrix: below, on and above the chain's diagonal; what the chain has from the body beside the plate and
gives to it; the same of the body around the pads; then the bodies among themselves."""


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
    """Factors of I - h A: the chain by Thomas, then what is left of the bodies by Gauss."""
    for i in range(CHAIN):
        below, above = -h * a[0, i], -h * a[2, i]
        pivot = 1.0 - h * a[1, i] - (below * w[2, i - 1] if i else 0.0)
        w[0, i], w[1, i], w[2, i] = below, 1.0 / pivot, above / pivot
        w[3, i], w[4, i], w[5, i], w[6, i] = -h * a[3, i], -h * a[4, i], -h * a[5, i], -h * a[6, i]
    chain_solve(w, w[3])
    chain_solve(w, w[5])
    left = w[7:]
    for i in range(BODIES):
        for j in range(BODIES):
            left[i, j] = (1.0 if i == j else 0.0) - h * a[7 + i, j]
    for i in range(CHAIN):
        left[0, 0] -= w[4, i] * w[3, i]
        left[0, AROUND] -= w[4, i] * w[5, i]
        left[AROUND, 0] -= w[6, i] * w[3, i]
        left[AROUND, AROUND] -= w[6, i] * w[5, i]
    for k in range(BODIES):
        for i in range(k + 1, BODIES):
            left[i, k] /= left[k, k]
            for j in range(k + 1, BODIES):
                left[i, j] -= left[i, k] * left[k, j]


@njit(cache=True)
def solve(w: Array, b: Array) -> None:
    """Put the solution of (I - h A) x = b in the place of `b`."""
    chain_solve(w, b)
    left, x = w[7:], b[CHAIN:]
    for i in range(CHAIN):
        x[0] -= w[4, i] * b[i]
        x[AROUND] -= w[6, i] * b[i]
    for i in range(1, BODIES):
        for j in range(i):
            x[i] -= left[i, j] * x[j]
    for i in range(BODIES - 1, -1, -1):
        for j in range(i + 1, BODIES):
            x[i] -= left[i, j] * x[j]
        x[i] /= left[i, i]
    for i in range(CHAIN):
        b[i] -= w[3, i] * x[0] + w[5, i] * x[AROUND]
