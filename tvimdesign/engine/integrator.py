"""Step an equation of motion in time, with the sensitivities of its state along directions.

`mass * dy/dt = f(y, u, k)`: `u` is one number that may change in time, `k` are constants, and a row without mass is an
algebraic equation. Singly diagonally implicit Runge-Kutta steps of third order with a full Newton; sensitivities go
along by the factors that each stage's Newton ended with, so they are those of the discrete solution.
Source: Alexander, SIAM J. Numer. Anal. 14 (1977), 1006.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np
from numba import njit
from numpy.typing import NDArray

from tvimdesign.engine.interpreter import Array, Code, push, run
from tvimdesign.engine.sparse_lu import Integers, Pattern, factor, pattern_of, solve, solve_many
from tvimdesign.engine.tape import Tape
from tvimdesign.engine.vectors import tangent_registers

GAMMA = 0.4358665215084590
STAGES = 3
TABLEAU = np.array([
    [GAMMA, 0.0, 0.0],
    [0.5 * (1.0 - GAMMA), GAMMA, 0.0],
    [4.0 * GAMMA - 1.5 * GAMMA**2 - 0.25, 1.5 * GAMMA**2 - 5.0 * GAMMA + 1.25, GAMMA],
])  # fmt: skip
TIMES = TABLEAU.sum(axis=1)  # When each stage is, as shares of the step; the last is its end
_FIRST = (0.5 - TIMES[1]) / (TIMES[0] - TIMES[1])
ERROR = TABLEAU[2] - np.array([_FIRST, 1.0 - _FIRST, 0.0])
"""Weights of the stages in the difference from a solution of second order."""
SAFETY, SHORTEST, LONGEST = 0.9, 0.2, 2.5
"""Of the length that the error allows next, the part that is taken; how far lengths change from one step to another."""
MOST_ITERATIONS, EXACT = 15, 1e-5
"""Newton's steps of a stage; the change of the scaled state below which one is the last: its square is left."""


class System(NamedTuple):
    """An equation of motion, as the compiled program takes it."""

    mass: Array
    rates: Code  # f alone
    rate_places: Integers
    slopes: Code  # f and its Jacobian by y
    slope_rates: Integers
    slope_places: Integers
    pattern: Pattern
    entries: Integers  # Entry of the factored matrix of each of the Jacobian's
    diagonal: Integers


class Motion:
    """An equation of motion, recorded."""

    def __init__(self, rates: Tape, slopes: Tape, places: Integers, mass: Array) -> None:
        """Take f, then f with its Jacobian, whose entries have these `places`: a row of rows and one of columns."""
        self.rates, self.slopes, self.places, self.size = rates, slopes, places, mass.size
        pattern, entries, diagonal = pattern_of(self.size, *places)
        self.system = System(
            mass, self.rates.code, self.rates.results[0], self.slopes.code, self.slopes.results[0],
            self.slopes.results[1], pattern, entries, diagonal,
        )  # fmt: skip

    @classmethod
    def of(cls, y: Any, u: Any, k: Any, rates: Any, jacobian: Any, mass: Array) -> Self:
        """Record expressions (SX) of symbols."""
        alone, both = (Tape.of([y, u, k], results, inverses=True) for results in ([rates], [rates, jacobian]))
        return cls(alone, both, np.array(jacobian.sparsity().get_triplet(), dtype=np.int64), mass)

    def arrays(self) -> list[NDArray[Any]]:
        """Return what `of_arrays` makes the motion from."""
        return [*self.rates.arrays(), *self.slopes.arrays(), self.places, self.system.mass]

    @classmethod
    def of_arrays(cls, arrays: Iterator[NDArray[Any]]) -> Self:
        """Return the motion of the next of some arrays."""
        return cls(Tape.of_arrays(arrays), Tape.of_arrays(arrays), next(arrays), next(arrays))

    def registers(self, k: Array, dk: Array) -> tuple[Array, Array, Array]:
        """Return registers for the rates, their tangents, and the slopes, with the constants in place."""
        w, v = self.rates.registers.copy(), self.slopes.registers.copy()
        d = tangent_registers(w.size, dk.shape[1])
        first = self.size + 1
        w[first : first + k.size] = v[first : first + k.size] = k
        d[first : first + k.size, : dk.shape[1]] = dk
        return w, d, v


@njit(cache=True, error_model="numpy")
def newton_matrix(m: System, v: Array, y: Array, u: float, share: float, h: float, entries: Array) -> None:
    """Evaluate f and its Jacobian, and factor `share mass - h J`."""
    for i in range(y.size):
        v[i] = y[i]
    v[y.size] = u
    run(m.slopes, v)
    for i in range(entries.size):
        entries[i] = 0.0
    for i in range(y.size):
        entries[m.diagonal[i]] = share * m.mass[i]
    for i in range(m.slope_places.size):
        entries[m.entries[i]] -= h * v[m.slope_places[i]]
    factor(m.pattern, entries)


@njit(cache=True, error_model="numpy")
def largest(size: float, other: float) -> float:
    """Return the larger size of two; infinity where one is no number, which a maximum would pass over."""
    return max(size, abs(other)) if not np.isnan(other) else np.inf


@njit(cache=True, error_model="numpy")
def stage(m: System, v: Array, y: Array, base: Array, u: float, h: float, entries: Array, right: Array) -> bool:
    """Solve `mass (y - base) = h f(y)` from y."""
    for _ in range(MOST_ITERATIONS):
        newton_matrix(m, v, y, u, 1.0, h, entries)
        for p in range(y.size):
            i = m.pattern.order[p]
            right[p] = m.mass[i] * (base[i] - y[i]) + h * v[m.slope_rates[i]]
        solve(m.pattern, entries, right)
        change = 0.0
        for p in range(y.size):
            y[m.pattern.order[p]] += right[p]
            change = largest(change, right[p])
        if change <= EXACT:
            return True
        if change == np.inf:
            break
    return False


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def stage_tangents(
    m: System, w: Array, d: Array, y: Array, u: float, du: Array, h: float, dh: Array, entries: Array, sb: Array,
    b: Array, s: Array,
) -> None:  # fmt: skip
    """Fill the sensitivities `s` of a stage that is solved, from those of its base `sb`."""
    size, lanes = y.size, s.shape[1]
    for i in range(size):
        w[i] = y[i]
    w[size] = u
    for j in range(lanes):
        d[size, j] = du[j]
    push(m.rates, w, d)
    for p in range(size):
        i = m.pattern.order[p]
        to, by, before, rate = b[p], d[m.rate_places[i]], sb[i], w[m.rate_places[i]]
        mass = m.mass[i]
        for j in range(lanes):
            to[j] = mass * before[j] + h * by[j] + dh[j] * rate
    solve_many(m.pattern, entries, b)
    for p in range(size):
        to, by = s[m.pattern.order[p]], b[p]
        for j in range(lanes):
            to[j] = by[j]


@njit(cache=True, error_model="numpy")
def step(
    m: System, w: Array, d: Array, v: Array, y: Array, s: Array, u: Array, du: Array, h: float, dh: Array, ahead: Array
) -> bool:
    """Take one step in place. `u` has a number for each stage, `du` its tangents; `dh` are those of the length.

    `ahead` is what the state is expected to move by in the first stage, on return what it moved by in the last.
    Without columns of `s`, sensitivities are left out.
    """
    size, lanes = s.shape
    entries, right, b = np.empty(m.pattern.size), np.empty(size), np.empty((size, lanes))
    # Loops take numba a third of the time to compile that slices and sums of arrays do.
    bases, moved = np.empty((STAGES, size)), np.empty((STAGES, size))
    sbases, smoved, of_stage = np.empty((STAGES, size, lanes)), np.empty((STAGES, size, lanes)), np.empty(lanes)
    for k in range(lanes):
        of_stage[k] = GAMMA * dh[k]
    for i in range(STAGES):
        for p in range(size):
            bases[i, p] = y[p]
            for k in range(lanes):
                sbases[i, p, k] = s[p, k]
    good = True
    for i in range(STAGES):
        for p in range(size):
            y[p] = bases[i, p] + (moved[i - 1, p] if i > 0 else ahead[p])
        good = stage(m, v, y, bases[i], u[i], GAMMA * h, entries, right) and good
        if lanes > 0:
            stage_tangents(m, w, d, y, u[i], du[i], GAMMA * h, of_stage, entries, sbases[i], b, s)
        for p in range(size):
            moved[i, p] = y[p] - bases[i, p]
            for k in range(lanes):
                smoved[i, p, k] = s[p, k] - sbases[i, p, k]
        for j in range(i + 1, STAGES):
            share = TABLEAU[j, i] / GAMMA
            for p in range(size):
                bases[j, p] += share * moved[i, p]
                for k in range(lanes):
                    sbases[j, p, k] += share * smoved[i, p, k]
    for p in range(size):
        ahead[p] = moved[STAGES - 1, p]
    return good


@njit(cache=True, error_model="numpy")
def step_error(m: System, v: Array, y: Array, current: float, slope: float, h: float, ahead: Array) -> float:
    """Take one step in place without sensitivities; return its error in the scaled state, NaN where it failed."""
    size = y.size
    entries, right = np.empty(m.pattern.size), np.empty(size)
    bases, moved = np.empty((STAGES, size)), np.empty((STAGES, size))
    for i in range(STAGES):
        for p in range(size):
            bases[i, p] = y[p]
    for i in range(STAGES):
        for p in range(size):
            y[p] = bases[i, p] + (moved[i - 1, p] if i > 0 else ahead[p])
        if not stage(m, v, y, bases[i], current + slope * TIMES[i] * h, GAMMA * h, entries, right):
            return np.nan
        for p in range(size):
            moved[i, p] = y[p] - bases[i, p]
            for j in range(i + 1, STAGES):
                bases[j, p] += TABLEAU[j, i] / GAMMA * moved[i, p]
    for p in range(size):
        i = m.pattern.order[p]
        ahead[i], right[p] = moved[STAGES - 1, i], 0.0
        for j in range(STAGES):
            right[p] += m.mass[i] * ERROR[j] / GAMMA * moved[j, i]
    solve(m.pattern, entries, right)
    worst = 0.0
    for p in range(size):
        worst = largest(worst, right[p])
    return worst


@njit(cache=True, error_model="numpy")
def adapted(
    m: System, v: Array, y: Array, current: float, slope: float, h: float, tolerance: float, ahead: Array
) -> tuple[float, float]:
    """Take one step in place, as long as the error allows; return its length and that of the next, zero where it fails.

    The current is `current` at first and changes by `slope`. `ahead` is scaled for the next step.
    """
    begin, guess = y.copy(), ahead.copy()
    for _ in range(30):
        error = step_error(m, v, y, current, slope, h, ahead)
        if error <= tolerance:
            factor = min(max(SAFETY * (tolerance / max(error, 1e-12)) ** (1.0 / 3.0), SHORTEST), LONGEST)
            for p in range(y.size):
                ahead[p] *= factor
            return h, h * factor
        shorter = 0.25 if not error < np.inf else max(SAFETY * (tolerance / error) ** (1.0 / 3.0), SHORTEST)
        for p in range(y.size):
            y[p], guess[p] = begin[p], guess[p] * shorter
            ahead[p] = guess[p]
        h *= shorter
    return 0.0, 0.0


@njit(cache=True, error_model="numpy")
def pursue(
    m: System, v: Array, states: Array, lengths: Array, current: float, slope: float, h: float, room: float,
    tolerance: float, ahead: Array,
) -> tuple[int, float]:  # fmt: skip
    """Step from `states[0]` as `adapted` does, `room` at most, and fill the states after it and the steps' lengths.

    Returns how many steps were taken, and the length of the next, zero where it fails.
    """
    for k in range(lengths.size):
        whole = h <= 0.999 * room
        least = h if whole else room
        for p in range(ahead.size):
            states[k + 1, p] = states[k, p]
        length, following = adapted(m, v, states[k + 1], current, slope, least, tolerance, ahead)
        if length == 0.0:
            return k, 0.0
        h = following if whole or length < least else max(following, h)
        lengths[k], current, room = length, current + slope * length, room - length
        if room <= 0.0:
            return k + 1, h
    return lengths.size, h


@njit(cache=True, error_model="numpy")
def advance(
    m: System, w: Array, d: Array, v: Array, states: Array, tangents: Array, first: int, lengths: Array,
    of_lengths: Array, u: Array, du: Array, ahead: Array,
) -> int:  # fmt: skip
    """Step from `states[first]` with the given lengths, and fill the states and tangents after it.

    `u[k]` and `du[k]` are those of the stages of step k. Returns the number of the last state, which is less where a
    step failed.
    """
    last = lengths.size
    scaled = ahead.copy()
    for k in range(first, last):
        for p in range(ahead.size):
            scaled[p] = ahead[p] * (lengths[k] / lengths[k - 1] if k > 0 else 1.0)
            states[k + 1, p] = states[k, p]
            for j in range(tangents.shape[2]):
                tangents[k + 1, p, j] = tangents[k, p, j]
        if not step(m, w, d, v, states[k + 1], tangents[k + 1], u[k], du[k], lengths[k], of_lengths[k], scaled):
            return k
        for p in range(ahead.size):
            ahead[p] = scaled[p]
    return last


def is_compiled() -> bool:
    """Return whether an earlier run has compiled this for the present user; numba takes a minute for it."""
    return any(Path(advance.stats.cache_path or "").glob("integrator.advance-*.nbi"))
