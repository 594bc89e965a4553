"""Many small problems of one form solved side by side: an interior-point method each step of which is for all of them.

A problem is min f(u, c) + PENALTY s with g(u, c) <= s, s >= 0 and u within its ends; c are numbers of its own. All that
must stay positive is a wall: t = s - g(u) and the distances to the ends. The way goes through the inside, as s begins
above the worst g. Steps are Newton's on the perturbed conditions of an optimum, the matrix made positive definite by
what is added to its diagonal, their length by backtracking on the barrier function.
Source: Nocedal and Wright, Numerical Optimization, 2nd ed. (2006), ch. 19; the rule for the barrier is that of Waechter
and Biegler, Math. Program. 106 (2006) 25, eq. 7.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.simulation.casadi_setup import ca
from tvimdesign.solve.batch.kernel import Kernel, stacked
from tvimdesign.solve.discrete.systems import solve_definite

Array = NDArray[np.float64]
Which = NDArray[np.bool_]

PENALTY = 1e3
"""What breaking the worst limit by its scale costs, in objectives of about one."""
TOLERANCE = 1e-7
"""Of the conditions of an optimum, as shares of the multipliers' mean where that is large."""
_ROOM = 0.1
"""How far above the worst limit s begins, and as a share of the ranges how far from their ends u does."""
_FIRST, _LAST = 1e-1, 1e-9
"""The barrier's parameter to begin with and in the end."""
_NEARLY = 0.99
"""Share of the way to a wall that a step may go."""
_STEPS, _HALVINGS = 150, 30
_DECREASE = 1e-4
"""Share of the decrease a step promises that it must bring."""
_ROUNDING = 1e-12
_LARGE = 100.0


@dataclass(frozen=True)
class Found:
    """Where the problems ended, a column each."""

    unknowns: Array
    values: Array
    """The objective with the penalty, less what the barrier adds: no more than without, where limits can be kept."""
    broken: Array
    """By how much the worst limit is broken, as a share of its scale."""
    converged: Which


class SideBySide:
    """One form of problem, compiled from a function of scalars (u, c) -> (f, g)."""

    def __init__(self, function: Any) -> None:
        """Compile the function's value, slopes and curvature."""
        self.free, own = function.size1_in(0), function.size1_in(1)
        self.rows = function.size1_out(1)
        u, c, z = ca.SX.sym("u", self.free), ca.SX.sym("c", own), ca.SX.sym("z", self.rows)
        f, g = function.call([u, c], True, False)
        slopes, bent = ca.jacobian(g, u), ca.tril(ca.hessian(f + ca.dot(z, g), u)[0])
        self._slopes, self._bent = (np.array(one.sparsity().get_triplet()) for one in (slopes, bent))
        self._value = Kernel(ca.Function("value", [ca.vertcat(u, c)], [f, ca.densify(g)]))
        derivatives = [ca.densify(ca.gradient(f, u)), slopes.nz[:], bent.nz[:]]
        self._derivatives = Kernel(ca.Function("derivatives", [ca.vertcat(u, c, z)], derivatives))

    def value(self, v: Array, own: Array) -> tuple[Array, Array]:
        """Objective with the penalty, and s - g, where v = (u, s)."""
        found = self._value(stacked(v[:-1], own))
        return found[0] + PENALTY * v[-1], v[-1] - found[1:]

    def derivatives(self, v: Array, own: Array, z: Array) -> tuple[Array, Array, Array]:
        """By v: the objective's gradient, the slopes of s - g, and the Lagrangian's curvature, of every column."""
        found, count = self._derivatives(stacked(v[:-1], own, z)), v.shape[1]
        size, last = self.free + 1, self.free + self._slopes.shape[1]
        gradient = stacked(found[: self.free], np.full((1, count), PENALTY))
        slopes = np.zeros((self.rows, size, count))
        slopes[self._slopes[0], self._slopes[1]] = -found[self.free : last]
        slopes[:, -1] = 1.0
        bent = np.zeros((size, size, count))
        bent[self._bent[0], self._bent[1]] = bent[self._bent[1], self._bent[0]] = found[last:]
        return gradient, slopes, bent

    def solve(self, begin: Array, own: Array, low: Array, high: Array) -> Found:
        """Solve all columns from `begin` [free, columns], with numbers of their own and ends."""
        count = begin.shape[1]
        found = Found(begin.copy(), np.full(count, -np.inf), np.full(count, np.nan), np.zeros(count, dtype=bool))
        left, columns = np.arange(count), _begun(self, begin, own, low, high)
        over = ~np.all(np.isfinite(columns.walls), axis=0)
        for _ in range(_STEPS):
            left, columns = left[~over], columns.only(~over)
            if not len(left):
                break
            done, stuck = _step(self, columns)
            over = done | stuck
            which = left[done]
            found.unknowns[:, which], found.broken[which] = columns.v[:-1, done], columns.v[-1, done]
            found.values[which] = columns.objective[done] - _LAST * len(columns.walls)
            found.converged[which] = True
        return found


@dataclass
class _Columns:
    """Where the problems are that are not done, a column each."""

    v: Array
    own: Array
    low: Array
    high: Array
    z: Array
    """Multipliers of the walls."""
    barrier: Array
    objective: Array
    walls: Array
    """Limits, lower ends, upper ends: all positive."""

    def only(self, keep: Which) -> _Columns:
        return _Columns(*(np.ascontiguousarray(getattr(self, field.name)[..., keep]) for field in fields(self)))


def _begun(problem: SideBySide, begin: Array, own: Array, low: Array, high: Array) -> _Columns:
    """Every column inside its walls, its multipliers those of the barrier."""
    near = _ROOM * (high - low)
    v = stacked(np.clip(begin, low + near, high - near), np.zeros((1, begin.shape[1])))
    worst = np.max(-problem.value(v, own)[1], axis=0, initial=0.0)
    v[-1] = worst + _ROOM
    low, high = stacked(low, np.zeros((1, len(worst)))), stacked(high, 2.0 * v[-1:])
    objective, limits = problem.value(v, own)
    walls = stacked(limits, v - low, high - v)
    with np.errstate(all="ignore"):  # columns that are no number anywhere are left at once
        z = _FIRST / walls
    return _Columns(v, own, low, high, z, np.full(len(worst), _FIRST), objective, walls)


def _step(problem: SideBySide, at: _Columns) -> tuple[Which, Which]:
    """One step of all columns; which of them are done, and which find no way on."""
    gradient, slopes, bent = problem.derivatives(at.v, at.own, at.z[: problem.rows])
    dual = gradient - _back(slopes, at.z)
    done = _error(at, dual, np.zeros_like(at.barrier)) <= TOLERANCE
    _lower(at, dual)
    weight = at.z / at.walls
    matrix = bent + np.einsum("jnk,jmk->nmk", slopes * weight[: problem.rows, None], slopes)
    ends = weight[problem.rows :].reshape(2, *at.v.shape).sum(axis=0)
    np.einsum("nnk->nk", matrix)[:] += ends
    right = _back(slopes, at.barrier / at.walls) - gradient
    dv = solve_definite(matrix, right)
    dwalls = stacked(np.einsum("jnk,nk->jk", slopes, dv), dv, -dv)
    dz = at.barrier / at.walls - at.z - weight * dwalls
    downhill = np.einsum("nk,nk->k", right, dv)
    moved = _advance(problem, at, dv, np.where(done, 0.0, _room(at.walls, dwalls)), downhill)
    at.z += _room(at.z, dz) * dz
    return done, ~moved & ~done


def _back(slopes: Array, y: Array) -> Array:
    """The walls' slopes, turned over, times a number for each wall."""
    rows, size, count = slopes.shape
    lower, upper = y[rows:].reshape(2, size, count)
    found: Array = np.einsum("jnk,jk->nk", slopes, y[:rows]) + lower - upper
    return found


def _error(at: _Columns, dual: Array, barrier: Array) -> Array:
    """How far each column is from an optimum of its barrier function."""
    scale = np.maximum(1.0, np.mean(at.z, axis=0) / _LARGE)
    found: Array = np.maximum(np.abs(dual).max(axis=0), np.abs(at.z * at.walls - barrier).max(axis=0)) / scale
    return found


def _lower(at: _Columns, dual: Array) -> None:
    """Lower the barrier of every column that has come near enough to the optimum there."""
    while True:
        near = (_error(at, dual, at.barrier) <= 10.0 * at.barrier) & (at.barrier > _LAST)
        if not np.any(near):
            return
        less = np.maximum(_LAST, np.minimum(0.2 * at.barrier, at.barrier**1.5))
        at.barrier = np.where(near, less, at.barrier)


def _room(value: Array, change: Array) -> Array:
    """How far a step may go before a positive value is all but used up."""
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(change < 0.0, -_NEARLY * value / change, 1.0)
    least: Array = np.minimum(1.0, share.min(axis=0))
    return least


def _merit(objective: Array, walls: Array, barrier: Array) -> Array:
    with np.errstate(invalid="ignore", divide="ignore"):
        found: Array = objective - barrier * np.log(walls).sum(axis=0)
    return found


def _advance(problem: SideBySide, at: _Columns, dv: Array, length: Array, downhill: Array) -> Which:
    """Go as far along a step as the barrier function falls; whether there is such a way."""
    before = _merit(at.objective, at.walls, at.barrier)
    before += _ROUNDING * np.abs(before)
    moved = np.zeros(len(length), dtype=bool)
    left = np.flatnonzero(length > 0.0)
    for _ in range(_HALVINGS):
        if not len(left):
            break
        v, own = at.v[:, left] + length[left] * dv[:, left], at.own[:, left]
        objective, limits = problem.value(v, own)
        walls = stacked(limits, v - at.low[:, left], at.high[:, left] - v)
        after = _merit(objective, walls, at.barrier[left])
        good = after <= before[left] - _DECREASE * length[left] * downhill[left]
        which = left[good]
        at.v[:, which], at.objective[which], at.walls[:, which] = v[:, good], objective[good], walls[:, good]
        moved[which] = True
        left = left[~good]
        length[left] *= 0.5
    return moved
