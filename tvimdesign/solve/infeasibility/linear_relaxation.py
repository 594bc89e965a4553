"""A linear programme that no design in a box beats: every row below itself from two corners, by its least slopes.

From the lower corner a row rises at least by its least slope, from the upper it falls at most by its greatest. The
bound is computed from the solver's multipliers alone, by weak duality: any multipliers give one that is certain, and
those of a solver that erred only a worse one.
Source: Araya, Trombettoni and Neveu, CPAIOR 2012 (X-Taylor); Neumaier and Shcherbina, Math. Program. 99 (2004) 283.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_PENALTY = 1e4
"""What breaking a row by its scale costs in scales of the goal: a box without designs gets a bound as great."""
_ROUNDING = 1e-9


class LinearBelow:
    """Rows and goal (the last row) as a + B u over the unit cube, below the true ones; rows are kept where <= cap."""

    def __init__(self, at_low: Array, rising: Array, at_high: Array, falling: Array, caps: Array) -> None:
        """Rows at both corners, and their slopes times the sides of the box (rows by free numbers)."""
        constants = np.concatenate([at_low, at_high - np.sum(np.where(np.isfinite(falling), falling, 0.0), axis=1)])
        slopes = np.concatenate([rising, falling])
        caps = np.concatenate([caps, caps])
        known = np.isfinite(constants) & np.all(np.isfinite(slopes), axis=1)
        goal = np.isin(np.arange(len(caps)), [len(at_low) - 1, len(caps) - 1]) & known
        worst = constants + np.sum(np.maximum(np.where(known[:, None], slopes, 0.0), 0.0), axis=1)
        rows = known & np.isfinite(caps) & (worst > caps)
        self.rows, self.room = slopes[rows], (caps - constants)[rows]
        self.goals, self.goal_constants = slopes[goal], constants[goal]

    def bound(self) -> float:
        """The least the goal can be in the box, and more than any cap where nothing keeps the rows."""
        if not len(self.goals):
            return -np.inf
        multipliers = self._multipliers()
        if multipliers is None:
            return -np.inf
        rows, goals = multipliers
        parts = np.concatenate([-rows[:, None] * self.room[:, None], goals[:, None] * self.goal_constants[:, None]])
        slopes = np.concatenate([rows[:, None] * self.rows, goals[:, None] * self.goals])
        total = float(np.sum(parts) + np.sum(np.minimum(np.sum(slopes, axis=0), 0.0)))
        return total - _ROUNDING * float(np.sum(np.abs(parts)) + np.sum(np.abs(slopes)))

    def _multipliers(self) -> tuple[Array, Array] | None:
        """Those of the rows and of the goals, none negative, the goals' summing up to one."""
        from scipy.optimize import linprog

        count, size = len(self.rows), self.goals.shape[1]
        # Unknowns: u, by how much rows are broken, the goal.
        matrix = np.block([
            [self.rows, -np.ones((count, 1)), np.zeros((count, 1))],
            [self.goals, np.zeros((len(self.goals), 1)), -np.ones((len(self.goals), 1))],
        ])  # fmt: skip
        found: Any = linprog(
            np.concatenate([np.zeros(size), [_PENALTY, 1.0]]),
            A_ub=matrix, b_ub=np.concatenate([self.room, -self.goal_constants]),
            bounds=[*[(0.0, 1.0)] * size, (0.0, None), (None, None)], method="highs",
        )  # fmt: skip
        if found.status != 0:
            return None
        multipliers = np.maximum(-np.asarray(found.ineqlin.marginals), 0.0)
        rows, goals = multipliers[:count], multipliers[count:]
        return (rows, goals / np.sum(goals)) if np.sum(goals) > 0.0 else None
