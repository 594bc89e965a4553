"""A problem with the parameters of one run as the solver takes it, and with further unknowns that move its limits.

Slacks that let limits give and the share of tolerance margins that a design bears are such unknowns.
"""

import numpy as np
from numpy.typing import NDArray

from tvimdesign.solve.nlp.problem import Problem
from tvimdesign.solve.nlp.problem_parts import Parameters, Point

Array = NDArray[np.float64]
_NONE = np.zeros(0)


class ExtendedProblem:
    """A nonlinear programme: the problem's unknowns, then the further ones."""

    def __init__(
        self, problem: Problem, parameters: Parameters, by_further: Array | None = None, weights: Array = _NONE,
        share: float = 1.0,
    ) -> None:  # fmt: skip
        """Take the problem at its parameters.

        A further unknown (a column of `by_further`) moves the residual of each limit (a row) in proportion, and counts
        by its weight in what is minimised, beside a `share` of the problem's own objective.
        """
        self.problem, self.parameters = problem, parameters
        self._by_further, self._weights, self._share = by_further, weights, share
        self.unknown_count, self.row_count = problem.unknown_count + len(weights), problem.row_count

    def at(self, x: Array) -> Point:
        """Evaluate the problem and its further unknowns at a point."""
        size, first = self.problem.unknown_count, self.problem.equation_count
        point = self.problem.at(x[:size], self.parameters)
        if self._by_further is None:
            return point
        further, limits = x[size:], slice(first, first + len(self._by_further))
        rows, by_further = point.rows.copy(), np.zeros((self.row_count, len(further)))
        rows[limits] += self._by_further @ further
        by_further[limits] = self._by_further
        return point._replace(
            objective=self._share * point.objective + float(self._weights @ further),
            gradient=np.concatenate([self._share * point.gradient, self._weights]),
            rows=rows, jacobian=np.hstack([point.jacobian, by_further]),
        )  # fmt: skip
