"""The reference problem solved by hand: equations written for numba, exact slopes, and scipy's SLSQP on top.

This is what someone does who knows the problem, numba and numerics well, and has this one problem to solve. Compiling
takes some seconds once; numba keeps the result beside the files.
"""

from __future__ import annotations

import numpy as np
from hand_module import HEAT, OUTPUTS, RESIDUALS, Array, measure
from hand_strips import beside
from hand_switch import FREE, STEP_OF, cycle
from numba import njit
from scipy.optimize import Bounds, minimize

PUBLISHED = np.array([2.413e-3, 24.4094e-3, 3.25, 57e-3, 40e-3, np.radians(48.962), 1e-3, 1.5])
"""The module as published: wire, coil, coils, placement, outer radius and span of the arcs, thickness, current."""


@njit(cache=True)
def evaluate(logs: Array, rows: Array, slopes: Array, sensitive: bool) -> None:
    """Volume, mass and time, then the residuals; and their slopes by the logarithms of the variables, a column each."""
    heat, moved = np.zeros(HEAT), np.zeros((FREE, HEAT))
    measure(np.exp(logs), rows, heat)
    beside(np.exp(logs), heat)
    if sensitive:
        up, down, aside = np.zeros(rows.size), np.zeros(rows.size), np.zeros(HEAT)
        for k in range(FREE):
            there = logs.copy()
            there[k] += STEP_OF
            measure(np.exp(there), up, moved[k])
            beside(np.exp(there), moved[k])
            there[k] -= 2.0 * STEP_OF
            measure(np.exp(there), down, aside)
            slopes[:, k] = (up - down) / (2.0 * STEP_OF)
    rows[2] = cycle(heat, moved, slopes[2], sensitive)


class ByHand:
    """Objective, residuals and slopes for SLSQP; a design asked for again is not worked out again."""

    def __init__(self) -> None:
        """Divide by what the module as published has."""
        self.evaluations = 0
        self._rows, self._slopes = np.zeros(OUTPUTS + RESIDUALS), np.zeros((OUTPUTS + RESIDUALS, FREE))
        self._last = b""
        self._weights = np.ones(OUTPUTS)
        self._weights = 1.0 / self._at(np.log(PUBLISHED))[0][:OUTPUTS]
        self.evaluations = 0

    def _at(self, logs: Array) -> tuple[Array, Array]:
        key = logs.tobytes()
        if key != self._last:
            self._last = key
            self.evaluations += 1
            evaluate(logs, self._rows, self._slopes, True)
        return self._rows, self._slopes

    def objective(self, logs: Array) -> float:
        """Return the objective."""
        return float(self._weights @ self._at(logs)[0][:OUTPUTS])

    def downhill(self, logs: Array) -> Array:
        """Return its slopes."""
        slopes: Array = self._weights @ self._at(logs)[1][:OUTPUTS]
        return slopes

    def room(self, logs: Array) -> Array:
        """Return what is left of every limit."""
        return -self._at(logs)[0][OUTPUTS:]

    def room_slopes(self, logs: Array) -> Array:
        """Return its slopes."""
        return -self._at(logs)[1][OUTPUTS:]


def by_hand(begin: Array, lower: Array, upper: Array) -> tuple[Array, int]:
    """Return the best design from a start, and how many designs were worked out."""
    written = ByHand()
    least = minimize(
        written.objective, np.log(begin), jac=written.downhill, method="SLSQP",
        bounds=Bounds(np.log(lower), np.log(upper), keep_feasible=True),
        constraints={"type": "ineq", "fun": written.room, "jac": written.room_slopes},
        options={"maxiter": 300, "ftol": 1e-9},
    )  # fmt: skip
    return np.exp(least.x), written.evaluations
