"""Step the equations of motion of many designs in time.

Steps are SDIRK2 (Alexander, SIAM J. Numer. Anal. 14 (1977), 1006; L-stable) with one exact Newton step a stage. Their
lengths are given, to be scaled for each design. A row of `given` is the current or a constant of the motion; arrays of
states are indexed by step, entry and design.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from tvimdesign.engine import lanes, vectors
from tvimdesign.engine.integrator import Motion, System
from tvimdesign.engine.interpreter import Array
from tvimdesign.engine.lanes import load, run
from tvimdesign.engine.sparse_lu import Integers
from tvimdesign.engine.vectors import LANES

GAMMA = 1.0 - np.sqrt(0.5)
"""Diagonal of SDIRK2 that makes it L-stable."""


class Room:
    """Registers in which one thread steps a motion: those of its slopes with a step's own behind them, of its rates."""

    def __init__(self, motion: Motion) -> None:
        """Place the constants."""
        self.slopes = lanes.lanes_of(motion.slopes, 3 * motion.size + motion.system.pattern.size + 1)
        self.rates = lanes.lanes_of(motion.rates)


@njit(cache=True, nogil=True, error_model="numpy")
def newton(m: System, w: Array, share: float) -> None:
    """Take one Newton step of `share mass (y - base) = length f(y)`; length and base are registers, mass is 1 or 0."""
    size = m.mass.size
    length = w.shape[0] - 1
    entries = length - m.pattern.size
    right, base = entries - size, entries - 2 * size
    run(m.slopes, w)
    for e in range(entries, length):
        for j in range(LANES):
            w[e, j] = 0.0
    for i in range(size):
        w[entries + m.diagonal[i]] = share * m.mass[i]
    for i in range(m.slope_places.size):
        entry = entries + m.entries[i]
        vectors.sub_product(w, entry, entry, length, m.slope_places[i])
    lanes.factor(m.pattern, w, entries)
    for p in range(size):
        i = m.pattern.order[p]
        if m.mass[i] == 0.0 or share != 1.0:
            w[right + p] = 0.0
        else:
            vectors.sub(w, right + p, base + i, i)
        vectors.add_product(w, right + p, right + p, length, m.slope_rates[i])
    lanes.solve(m.pattern, w, entries, right)
    for p in range(size):
        i = m.pattern.order[p]
        vectors.add(w, i, i, right + p)


@njit(cache=True, nogil=True, error_model="numpy")
def step(m: System, w: Array) -> None:
    """Take one step in place."""
    size = m.mass.size
    base = w.shape[0] - 1 - m.pattern.size - 2 * size
    begin = base - size
    for i in range(size):
        vectors.copy(w, begin + i, i)
        vectors.copy(w, base + i, i)
    newton(m, w, 1.0)
    for i in range(size):
        y, start, to = w[i], w[begin + i], w[base + i]
        for j in range(LANES):
            rise = (y[j] - start[j]) / GAMMA
            to[j] = start[j] + (1.0 - GAMMA) * rise
            y[j] = start[j] + rise
    newton(m, w, 1.0)


@njit(cache=True, nogil=True, error_model="numpy")
def march(
    m: System, w: Array, places: Integers, given: Array, states: Array, lengths: Array, scales: Array, first: int,
    last: int, busy: NDArray[np.bool_],
) -> None:  # fmt: skip
    """Fill the states after the steps from `first` to before `last`; columns of which none is `busy` are left out."""
    size, count = states.shape[1], states.shape[2]
    own = np.arange(size)
    for start in range(0, count, LANES):
        if not busy[start : start + LANES].any():
            continue
        load(w, places, given, start)
        load(w, own, states[first], start)
        for k in range(first, last):
            for j in range(LANES):
                w[w.shape[0] - 1, j] = GAMMA * lengths[k] * scales[min(start + j, count - 1)]
            step(m, w)
            lanes.store(w, own, states[k + 1], start)
