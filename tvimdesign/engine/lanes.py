"""Run a tape for many designs at once: registers are rows, their columns designs side by side.

Every design is on its own: its bits do not depend on its neighbours, nor on how many there are.

Equations of motion are stepped in time by SDIRK2 (Alexander, SIAM J. Numer. Anal. 14 (1977), 1006; L-stable) with one
exact Newton step a stage. The lengths of steps are given, to be scaled for each design. A row of `given` is the current
or a constant of the motion; arrays of states are indexed by step, entry and design.
"""

from typing import Any

import numpy as np
from numba import njit
from numba.np.numpy_support import carray
from numpy.typing import NDArray

from tvimdesign.engine import interpreter as known
from tvimdesign.engine import vectors
from tvimdesign.engine.integrator import Motion, System
from tvimdesign.engine.interpreter import ON_VALUES, Array, Code, by_address, slopes_of
from tvimdesign.engine.sparse_lu import Integers, Pattern
from tvimdesign.engine.tape import Tape
from tvimdesign.engine.vectors import LANES


def lanes_of(tape: Tape, more: int = 0) -> Array:
    """Return registers of a tape with its constants in place, and some `more` behind them."""
    w = vectors.registers(tape.registers.size + more)
    w[: tape.registers.size] = tape.registers[:, None]
    return w


@njit(cache=True, nogil=True, error_model="numpy")
def run(code: Code, w: Array) -> None:
    """Fill the registers of the results from those of the arguments and constants."""
    first, second, to, groups = code.first.ctypes, code.second.ctypes, code.to.ctypes, code.groups.ctypes
    _run(first, second, to, groups, code.groups.shape[0] - 1, w.ctypes, w.shape[0])


@by_address("tvimdesign_lanes", ON_VALUES)
def _run(  # noqa: PLR0915 - a case for each operation
    first: Any, second: Any, to: Any, groups_at: Any, count: int, registers: Any, size: int
) -> None:
    groups, w = carray(groups_at, (count + 1, 2)), carray(registers, (size, LANES))
    for g in range(count):
        op, start, end = groups[g, 0], groups[g, 1], groups[g + 1, 1]
        if op == known.MUL:
            for k in range(start, end):
                vectors.mul(w, to[k], first[k], second[k])
        elif op == known.ADD:
            for k in range(start, end):
                vectors.add(w, to[k], first[k], second[k])
        elif op == known.SUB:
            for k in range(start, end):
                vectors.sub(w, to[k], first[k], second[k])
        elif op == known.DIV:
            for k in range(start, end):
                vectors.div(w, to[k], first[k], second[k])
        elif op == known.SQ:
            for k in range(start, end):
                vectors.square(w, to[k], first[k])
        elif op == known.SQRT:
            for k in range(start, end):
                vectors.sqrt(w, to[k], first[k])
        elif op == known.NEG:
            for k in range(start, end):
                vectors.neg(w, to[k], first[k])
        elif op == known.TWICE:
            for k in range(start, end):
                vectors.twice(w, to[k], first[k])
        elif op == known.INV:
            for k in range(start, end):
                vectors.inverse(w, to[k], first[k])
        elif op == known.EXP:
            for k in range(start, end):
                vectors.exp(w, to[k], first[k])
        elif op == known.LOG:
            for k in range(start, end):
                vectors.log(w, to[k], first[k])
        elif op == known.LOG1P:
            for k in range(start, end):
                vectors.log1p(w, to[k], first[k])
        elif op in (known.POW, known.CONSTPOW):
            for k in range(start, end):
                vectors.power(w, to[k], first[k], second[k])
        elif op == known.LT:
            for k in range(start, end):
                vectors.less(w, to[k], first[k], second[k])
        elif op == known.LE:
            for k in range(start, end):
                vectors.at_most(w, to[k], first[k], second[k])
        elif op == known.FMIN:
            for k in range(start, end):
                vectors.lesser(w, to[k], first[k], second[k])
        elif op == known.FMAX:
            for k in range(start, end):
                vectors.larger(w, to[k], first[k], second[k])
        elif op == known.IF_ELSE_ZERO:
            for k in range(start, end):
                vectors.if_else_zero(w, to[k], first[k], second[k])
        elif op == known.FABS:
            for k in range(start, end):
                vectors.fabs(w, to[k], first[k])
        elif op == known.SIN:
            for k in range(start, end):
                vectors.sin(w, to[k], first[k])
        elif op == known.COS:
            for k in range(start, end):
                vectors.cos(w, to[k], first[k])
        elif op == known.ASIN:
            for k in range(start, end):
                vectors.asin(w, to[k], first[k])
        elif op == known.ACOS:
            for k in range(start, end):
                vectors.acos(w, to[k], first[k])
        elif op == known.ATAN:
            for k in range(start, end):
                vectors.atan(w, to[k], first[k])
        elif op == known.TANH:
            for k in range(start, end):
                vectors.tanh(w, to[k], first[k])
        else:
            for k in range(start, end):
                for j in range(LANES):
                    w[to[k], j] = slopes_of(op, w[first[k], j], w[second[k], j])[0]


@njit(cache=True, nogil=True, error_model="numpy")
def load(w: Array, places: Integers, columns: Array, start: int) -> None:
    """Put the rows of some columns into registers; lanes beyond the last column hold that once more."""
    last = columns.shape[1] - 1
    for r in range(places.size):
        to, row = w[places[r]], columns[r]
        if start + LANES <= last + 1:
            for j in range(LANES):
                to[j] = row[start + j]
        else:
            for j in range(LANES):
                to[j] = row[min(start + j, last)]


@njit(cache=True, nogil=True, error_model="numpy")
def put(w: Array, rows: Array, count: int) -> None:
    """Copy the first rows into the first registers. A slice would take numba ten times as long to compile."""
    for i in range(count):
        for j in range(LANES):
            w[i, j] = rows[i, j]


@njit(cache=True, nogil=True, error_model="numpy")
def store(w: Array, places: Integers, columns: Array, start: int) -> None:
    """Put registers into the rows of some columns."""
    count = min(LANES, columns.shape[1] - start)
    for r in range(places.size):
        row, at = columns[r], w[places[r]]
        for j in range(count):
            row[start + j] = at[j]


@njit(cache=True, nogil=True, error_model="numpy")
def evaluate(
    code: Code, w: Array, places: Integers, given: Array, results: Integers, values: Array, first: int, end: int
) -> None:
    """Run a tape down columns from `first` to before `end`, a multiple of LANES of them or the last.

    Rows of `given` are the inputs for the registers at `places`, rows of `values` the results.
    """
    for start in range(first, end, LANES):
        load(w, places, given, start)
        run(code, w)
        store(w, results, values, start)


@njit(cache=True, nogil=True, error_model="numpy")
def factor(p: Pattern, w: Array, base: int) -> None:
    """Factor entries in place, which are the registers from `base` on; pivots become their inverses."""
    for k in range(p.diagonal.size):
        pivot = base + p.diagonal[k]
        vectors.inverse(w, pivot, pivot)
        for r in range(p.below_start[k], p.below_start[k + 1]):
            vectors.mul(w, base + p.below[r], base + p.below[r], pivot)
        for r in range(p.update_start[k], p.update_start[k + 1]):
            target = base + p.target[r]
            vectors.sub_product(w, target, target, base + p.left[r], base + p.upper[r])


@njit(cache=True, nogil=True, error_model="numpy")
def solve(p: Pattern, w: Array, base: int, b: int) -> None:
    """Solve in place for the registers from `b` on, in the order of elimination."""
    size = p.diagonal.size
    for i in range(size):
        for r in range(p.lower_start[i], p.lower_start[i + 1]):
            vectors.sub_product(w, b + i, b + i, base + p.lower_entry[r], b + p.lower_column[r])
    for i in range(size - 1, -1, -1):
        for r in range(p.upper_start[i], p.upper_start[i + 1]):
            vectors.sub_product(w, b + i, b + i, base + p.upper_entry[r], b + p.upper_column[r])
        vectors.mul(w, b + i, b + i, base + p.diagonal[i])


GAMMA = 1.0 - np.sqrt(0.5)  # Diagonal of SDIRK2 that makes it L-stable


class Room:
    """Registers in which one thread steps a motion: those of its slopes with a step's own behind them, of its rates."""

    def __init__(self, motion: Motion) -> None:
        self.slopes = lanes_of(motion.slopes, 3 * motion.size + motion.system.pattern.size + 1)
        self.rates = lanes_of(motion.rates)


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
    factor(m.pattern, w, entries)
    for p in range(size):
        i = m.pattern.order[p]
        if m.mass[i] == 0.0 or share != 1.0:
            w[right + p] = 0.0
        else:
            vectors.sub(w, right + p, base + i, i)
        vectors.add_product(w, right + p, right + p, length, m.slope_rates[i])
    solve(m.pattern, w, entries, right)
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
    """Fill the states after the steps from `first` to before `last`; columns without a `busy` lane are left out."""
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
            store(w, own, states[k + 1], start)
