"""Find when something happens to many designs, and where they would stay: where a quantity of their states passes zero.

A row of `given` is the current or a constant of the motion, one of `watched` an argument of the quantity beside the
state; arrays of states are indexed by step, entry and design.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from tvimdesign.engine import lanes
from tvimdesign.engine.integrator import System
from tvimdesign.engine.interpreter import Array, Code
from tvimdesign.engine.lanes import GAMMA, load, newton, put, run, step
from tvimdesign.engine.sparse_lu import Integers
from tvimdesign.engine.vectors import LANES

NOWHERE = 1 << 40  # Index of a step that has not been found
_TRIALS, _NEAR = 8, 0.02
"""How often a zero is looked for along a cubic, and the share of the step's change that may be left."""
_LAST_STEPS, _SHORT = 4, 0.02  # How many last steps are tried, and the share of a step that may be left to slopes
_STANDING = -1e-12
"""Share of the mass in the matrix of a state that stays, so that integrals, which do not, leave it regular."""
_BALANCE, _AT_REST, _APART = 20, 1e-8, 1e-5
"""Newton's steps to a state that stays, the change at which there is one, and of differences by the current."""


@njit(cache=True, nogil=True, error_model="numpy")
def _next_step(low: int, high: int, below: float, above: float, stride: int, guess: int, reached: int) -> int:
    """Return the step at which to look next; -1 where there is none."""
    if low + 1 == high or (high == NOWHERE and low >= reached):
        return -1
    if high == NOWHERE:
        return min(max(low + stride, guess if low < 0 else 0), reached)
    if low < 0:
        return max(high - stride, 0)
    between = low + (high - low) * below / (below - above)
    return min(max(int(between), low + 1), high - 1)


@njit(cache=True, nogil=True, error_model="numpy")
def search(
    code: Code, w: Array, result: int, places: Integers, watched: Array, states: Array, size: int, reached: int,
    guess: int, low: Integers, high: Integers, below: Array, above: Array,
) -> None:  # fmt: skip
    """Find the two steps one after the other between which a quantity of `size` entries of the state passes zero.

    `low` and `high` are the last at which it is below and the first at which it is not, -1 and NOWHERE where none is
    known; `below` and `above` what it is there. They are narrowed as far as the states reach.
    """
    count = states.shape[2]
    at, stride = np.empty(LANES, np.int64), np.empty(LANES, np.int64)
    for start in range(0, count, LANES):
        lanes_here = min(LANES, count - start)
        for j in range(LANES):
            stride[j] = 1
        loaded = False
        while True:
            left = False
            for j in range(lanes_here):
                k = start + j
                at[j] = _next_step(low[k], high[k], below[k], above[k], stride[j], guess, reached)
                left = left or at[j] >= 0
                stride[j] *= 2
            if not left:
                break
            if not loaded:
                load(w, places, watched, start)
                loaded = True
            for i in range(size):
                for j in range(lanes_here):
                    w[i, j] = states[max(at[j], 0), i, start + j]
                for j in range(lanes_here, LANES):
                    w[i, j] = w[i, 0]
            run(code, w)
            for j in range(lanes_here):
                if at[j] < 0:
                    continue
                if w[result, j] >= 0.0:
                    high[start + j], above[start + j] = at[j], w[result, j]
                else:
                    low[start + j], below[start + j] = at[j], w[result, j]


@njit(cache=True, nogil=True, error_model="numpy")
def _cubic(share: float, before: float, after: float, here: float, there: float) -> float:
    left = 1.0 - share
    whole = before * left * left * (1.0 + 2.0 * share) + after * share * share * (3.0 - 2.0 * share)
    return whole + share * left * (here * left - there * share)


@njit(cache=True, nogil=True, error_model="numpy")
def _slope(share: float, before: float, after: float, here: float, there: float) -> float:
    left = 1.0 - share
    cross = 2.0 * share * left
    return 3.0 * cross * (after - before) + here * (left * left - cross) - there * (cross - share * share)


@njit(cache=True, nogil=True, error_model="numpy")
def _slopes(m: System, v: Array, state: Array, h: Array, slopes: Array) -> None:
    """Fill what a state moves by in a step at its rates; entries without mass are taken to stay."""
    put(v, state, m.mass.size)
    run(m.rates, v)
    for i in range(m.mass.size):
        for j in range(LANES):
            slopes[i, j] = m.mass[i] * h[j] * v[m.rate_places[i], j]


@njit(cache=True, nogil=True, error_model="numpy")
def _seek(
    code: Code, g: Array, result: int, size: int, sought: NDArray[np.bool_], curve: Array, shares: Array, bracket: Array
) -> None:
    """Find the shares of a step at which a quantity passes zero along a cubic, about: by regula falsi (Illinois).

    `curve` has states and slopes at both ends, `bracket` shares below and above the zero and the values there.
    """
    pulled, side = bracket[2:].copy(), np.zeros(LANES, np.int64)
    scale = _NEAR * (bracket[3] - bracket[2])
    left = sought.copy()
    for _ in range(_TRIALS):
        if not left.any():
            return
        for j in range(LANES):
            if left[j]:
                a, b = bracket[0, j], bracket[1, j]
                guess = (a * pulled[1, j] - b * pulled[0, j]) / (pulled[1, j] - pulled[0, j])
                shares[j] = guess if a < guess < b else 0.5 * (a + b)
        for i in range(size):
            for j in range(LANES):
                g[i, j] = _cubic(shares[j], curve[0, i, j], curve[1, i, j], curve[2, i, j], curve[3, i, j])
        run(code, g)
        for j in range(LANES):
            if not left[j]:
                continue
            value = g[result, j]
            above = 1 if value >= 0.0 else 0
            if side[j] == 2 * above - 1:
                pulled[1 - above, j] *= 0.5
            bracket[above, j], bracket[2 + above, j], pulled[above, j] = shares[j], value, value
            side[j] = 2 * above - 1
            left[j] = not abs(value) <= scale[j]


@njit(cache=True, nogil=True, error_model="numpy")
def cross(
    m: System, w: Array, v: Array, places: Integers, given: Array, states: Array, lengths: Array, scales: Array,
    code: Code, g: Array, result: int, watching: Integers, watched: Array, size: int,
    sought: NDArray[np.bool_], low: Integers, below: Array, above: Array, shares: Array, ends: Array,
) -> None:  # fmt: skip
    """Find the share of the step after `low` at which a quantity passes zero, and the state there, where it is sought.

    It is looked for along a cubic; then a step of that length is taken, and what is left made up by slopes.
    """
    total, count = states.shape[1], states.shape[2]
    curve, bracket = np.empty((4, total, LANES)), np.empty((4, LANES))
    h, share, wanted = np.empty(LANES), np.ones(LANES), np.empty(LANES, np.bool_)
    slope, before, more = np.empty(LANES), np.empty(LANES), np.zeros(LANES)
    for start in range(0, count, LANES):
        if not sought[start : start + LANES].any():
            continue
        for j in range(LANES):
            k = min(start + j, count - 1)
            at = min(max(low[k], 0), lengths.shape[0] - 1)
            more[j], h[j], wanted[j] = 0.0, lengths[at] * scales[k], sought[k] and start + j < count
            bracket[0, j], bracket[1, j], bracket[2, j], bracket[3, j] = 0.0, 1.0, below[k], above[k]
            for i in range(total):
                curve[0, i, j], curve[1, i, j] = states[at, i, k], states[at + 1, i, k]
        load(v, places, given, start)
        _slopes(m, v, curve[0], h, curve[2])
        _slopes(m, v, curve[1], h, curve[3])
        load(g, watching, watched, start)
        _seek(code, g, result, size, wanted, curve, share, bracket)
        load(w, places, given, start)
        for j in range(LANES):
            slope[j] = (bracket[3, j] - bracket[2, j]) / (bracket[1, j] - bracket[0, j])
        for _ in range(_LAST_STEPS):
            if not wanted.any():
                break
            put(w, curve[0], total)
            for j in range(LANES):
                w[w.shape[0] - 1, j] = GAMMA * share[j] * h[j]
            step(m, w)
            put(g, w, size)
            run(code, g)
            for j in range(LANES):
                if not wanted[j]:
                    continue
                value = g[result, j]
                if more[j] != 0.0:
                    slope[j] = (value - before[j]) / more[j]
                before[j], more[j] = value, min(max(-value / slope[j], -share[j]), 1.5 - share[j])
                wanted[j] = abs(more[j]) > _SHORT
                shares[start + j] = share[j] + more[j]
                for i in range(total):
                    along = _slope(share[j], curve[0, i, j], curve[1, i, j], curve[2, i, j], curve[3, i, j])
                    ends[i, start + j] = w[i, j] + more[j] * along
                share[j] += more[j]


@njit(cache=True, nogil=True, error_model="numpy")
def _standing(m: System, w: Array, v: Array, y: Array, u: Array, moved: Array, to: Array) -> None:
    """Fill in states one Newton step nearer to one that stays at the currents `u`, and their slopes by these."""
    total, length = m.mass.size, w.shape[0] - 1
    entries = length - m.pattern.size
    put(w, y, total)
    put(v, y, total)
    for j in range(LANES):
        w[total, j], w[length, j] = u[j], -1.0
    newton(m, w, _STANDING)
    put(moved, w, total)
    for j in range(LANES):
        v[total, j] = u[j] + _APART
    run(m.rates, v)
    for i in range(total):
        for j in range(LANES):
            to[i, j] = v[m.rate_places[i], j]
    for j in range(LANES):
        v[total, j] = u[j] - _APART
    run(m.rates, v)
    right = entries - total
    for p in range(total):
        i = m.pattern.order[p]
        for j in range(LANES):
            w[right + p, j] = (v[m.rate_places[i], j] - to[i, j]) / (2.0 * _APART)
    lanes.solve(m.pattern, w, entries, right)
    for p in range(total):
        for j in range(LANES):
            to[m.pattern.order[p], j] = w[right + p, j]


@njit(cache=True, nogil=True, error_model="numpy")
def settle(
    m: System, w: Array, v: Array, places: Integers, given: Array, code: Code, g: Array, result: int,
    watching: Integers, watched: Array, size: int, states: Array, currents: Array, exists: NDArray[np.bool_],
) -> None:  # fmt: skip
    """Find the `states` without integrals and the `currents` that stay while a quantity is zero, where they exist."""
    (staying, count), total = states.shape, m.mass.size
    y, moved, to = np.zeros((total, LANES)), np.empty((total, LANES)), np.empty((total, LANES))
    u, before, change = np.empty(LANES), np.empty(LANES), np.empty(LANES)
    for start in range(0, count, LANES):
        load(w, places, given, start)
        load(v, places, given, start)
        load(g, watching, watched, start)
        for j in range(LANES):
            k = min(start + j, count - 1)
            u[j], change[j] = currents[k], np.inf
            for i in range(staying):
                y[i, j] = states[i, k]
        for _ in range(_BALANCE):
            _standing(m, w, v, y, u, moved, to)
            put(g, moved, size)
            for j in range(LANES):
                g[size, j] = u[j]
            run(code, g)
            for j in range(LANES):
                before[j], g[size, j] = g[result, j], u[j] + _APART
                for i in range(size):
                    g[i, j] = moved[i, j] + _APART * to[i, j]
            run(code, g)
            left = False
            for j in range(LANES):
                if not change[j] > _AT_REST:
                    continue
                more = -before[j] * _APART / (g[result, j] - before[j])
                change[j] = abs(more)
                u[j] += more
                for i in range(staying):
                    new = moved[i, j] + more * to[i, j]
                    change[j] = max(change[j], abs(new - y[i, j]))
                    y[i, j] = new
                left = left or change[j] > _AT_REST
            if not left:
                break
        for j in range(min(LANES, count - start)):
            for i in range(staying):
                states[i, start + j] = y[i, j]
            currents[start + j] = u[j]
            exists[start + j] = change[j] <= _AT_REST
