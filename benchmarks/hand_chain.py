"""Linear equations of the chain of cells that `hand_switch.py` steps through, by hand for numba.

The chain is tridiagonal; the body beside the plate, which all of the plate's cells touch, is bordered onto it, and the
core onto that. Order: cold side, hot side, cells of the layer, cells of the plate, plate beside the arcs, core.
"""

from __future__ import annotations

from hand_module import Array
from numba import njit

CELLS, PLATE = 12, 8
CHAIN = 2 + CELLS + PLATE
STATES = CHAIN + 2
BESIDE, CORE = CHAIN, CHAIN + 1


@njit(cache=True)
def factor(a: Array, h: float, w: Array) -> None:
    """Factors of I - h A: the chain by Thomas, the plate's surroundings bordered, the core taken into them."""
    for i in range(CHAIN):
        below, above = -h * a[0, i], -h * a[2, i]
        pivot = 1.0 - h * a[1, i] - (below * w[2, i - 1] if i else 0.0)
        w[0, i], w[1, i], w[2, i] = below, 1.0 / pivot, above / pivot
    for i in range(CHAIN):
        w[3, i] = (-h * a[3, i] - (w[0, i] * w[3, i - 1] if i else 0.0)) * w[1, i]
    for i in range(CHAIN - 2, -1, -1):
        w[3, i] -= w[2, i] * w[3, i + 1]
    corner = 1.0 - h * a[1, BESIDE]
    for i in range(2 + CELLS, CHAIN):
        w[4, i] = -h * a[4, i]
        corner -= w[4, i] * w[3, i]
    w[0, CORE], w[1, CORE], w[2, BESIDE] = -h * a[0, CORE], 1.0 / (1.0 - h * a[1, CORE]), -h * a[2, BESIDE]
    w[1, BESIDE] = 1.0 / (corner - w[2, BESIDE] * w[0, CORE] * w[1, CORE])


@njit(cache=True)
def solve(w: Array, b: Array) -> None:
    """Put the solution of (I - h A) x = b in the place of `b`."""
    b[0] *= w[1, 0]
    for i in range(1, CHAIN):
        b[i] = (b[i] - w[0, i] * b[i - 1]) * w[1, i]
    for i in range(CHAIN - 2, -1, -1):
        b[i] -= w[2, i] * b[i + 1]
    beside = b[BESIDE] - w[2, BESIDE] * b[CORE] * w[1, CORE]
    for i in range(2 + CELLS, CHAIN):
        beside -= w[4, i] * b[i]
    beside *= w[1, BESIDE]
    b[BESIDE] = beside
    b[CORE] = (b[CORE] - w[0, CORE] * beside) * w[1, CORE]
    for i in range(CHAIN):
        b[i] -= w[3, i] * beside
