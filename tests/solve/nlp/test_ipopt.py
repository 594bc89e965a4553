"""The limit on the points that a search evaluates."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.deadline import NEVER
from tvimdesign.solve.nlp.ipopt import ProgrammeSolver

Array = NDArray[np.float64]
QUIET = {
    "ipopt": {"print_level": 0, "sb": "yes", "max_iter": 9, "hessian_approximation": "limited-memory"},
    "print_time": False,
    "show_eval_warnings": False,
}


@dataclass
class Cliff:
    """A least beyond the points that have rows, as that of modules whose cycle never ends."""

    evaluated: int = 0
    unknown_count: int = 2
    row_count: int = 2

    def at(self, x: Array) -> "Cliff":
        self.x, self.evaluated = x.copy(), self.evaluated + 1
        return self

    @property
    def objective(self) -> float:
        return float(self.x @ self.x)

    @property
    def gradient(self) -> Array:
        return 2.0 * self.x

    @property
    def rows(self) -> Array:
        return np.array([self.x[0] - 1.0 if self.x[1] > 0.7 else np.nan, self.x[1]])

    @property
    def jacobian(self) -> Array:
        return np.eye(2)


def test_points_without_rows_count():
    cliff, solver = Cliff(), ProgrammeSolver(2, 2, QUIET, most_points=20)
    solver(cliff, NEVER, x0=[1.0, 1.5], lbx=[-2.0, -2.0], ubx=[2.0, 2.0], lbg=[-2.0, -2.0], ubg=[0.0, 2.0])
    assert solver.stats()["return_status"] == "Maximum_Iterations_Exceeded"
    assert cliff.evaluated < 60
