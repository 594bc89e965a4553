"""Solve a programme by local models of its working cycle, within a trust region.

A cycle costs ten times what everything else does. Between two cycles the programme is therefore solved with the
table's exact equations and a second-order model of what the cycle supplies. Values and slopes of the model are those
of the last cycle; its curvature is learned from the slopes of all before (symmetric rank one). Where the model's
optimum is the cycle's, the multipliers are, too.
[Conn, Gould, Toint, Trust-region methods, 2000; Nocedal, Wright, Numerical optimization, 2006, eq. 6.24]
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from tvimdesign.base.deadline import Deadline
from tvimdesign.solve.nlp.decision_vector import ExtendedProblem
from tvimdesign.solve.nlp.problem_parts import Array, Curvatures, CycleModel, Point
from tvimdesign.solve.nlp.solver_run import NO_DESIGN
from tvimdesign.solve.nlp.sqp import SqpSolver

FIRST_RADIUS, MOST_RADIUS, LEAST_RADIUS = 0.4, 2.0, 1e-5
"""Half the edge of the trust region, in the unknowns: a logarithm of 0.4 is half as much again."""
POOR, GOOD, EXACT = 0.1, 0.02, 1e-3
"""Error of a modelled limit, as a share of it, from which a step is taken back, and below which the
region grows; error up to which a model shows how a solver fares on the cycle."""
CERTAIN = 0.05  # Error of a model, as a share of the least breach that it finds, up to which that is the cycle's, too
NOISE, CREEP = 1e-6, 3e-4
"""Change of the objective that says nothing; change that ends the search for more of a further unknown: a step of
margins that no design bears whole leads along valleys."""
MOST_CYCLES = 20  # A run that takes more cycles goes on with the cycle itself
FEASIBLE, STATIONARY, STILL = 1e-7, 1e-6, 1e-7
"""Largest breach of a limit and slope of the Lagrangian at an optimum; step that leaves a point where it is."""


class TrustRegion:
    """Run of a programme by models of its cycle."""

    def __init__(
        self, programme: ExtendedProblem, solver: SqpSolver, deadline: Deadline, ends: Mapping[str, Array]
    ) -> None:
        """Take the programme, its solver, and nlpsol's bounds of unknowns and rows."""
        self._programme, self._solver, self._deadline, self._ends = programme, solver, deadline, ends
        self._problem = programme.problem
        self._curvatures = Curvatures(len(self._problem.model.switch_names), self._problem.unknown_count)
        self._radius = FIRST_RADIUS
        self._filter: list[tuple[float, float]] = []  # Objective and largest breach of the points that were taken
        self.iterations = 0  # Steps of the last run: cycles it took
        self.reached = np.zeros(0)  # Unknowns of the last point that was taken

    def solve(self, x: Array, *, near: bool) -> tuple[dict[str, Any], dict[str, Any]] | None:
        """Return the solver's answer and statistics at an optimum from x; None where models do not lead to one.

        A run `near` an optimum is returned as it failed where no step of its models is better: the cycle itself seldom
        leads on there.
        """
        x = self.reached = np.clip(x, self._ends["lbx"], self._ends["ubx"])
        self._radius, self._filter, self.iterations = FIRST_RADIUS if self._problem.events else np.inf, [], 0
        model = self._model(x)
        if model is not None:
            self._filter.append((self._programme.at(x).objective, self._breach(self._programme.at(x))))
        for _ in range(MOST_CYCLES):
            if model is None or self._deadline.remaining <= 0.0:
                return None
            region, radius = self._region(x), self._radius
            answer, stats, to, expected = self._step(model, x, region)
            self.iterations += 1
            here, there, reached = self._programme.at(x), self._programme.at(to), self._model(to)
            length = float(np.max(np.abs(to - x), initial=0.0))
            if reached is not None:
                self._curvatures.learn(model, reached)
            error = np.inf if reached is None else _error(expected, there)
            stats = {**stats, "iter_count": self.iterations}
            fails = not stats["success"] and error <= EXACT and length < 0.99 * radius
            infeasible = (
                stats["return_status"] == NO_DESIGN and length < 0.99 * radius
                and error <= CERTAIN * self._breach(expected)
            )  # fmt: skip
            if (
                (length < LEAST_RADIUS and not stats["success"]) or infeasible
                or (fails and not self._better(there, -NOISE))
            ):  # fmt: skip
                return {**answer, "x": to, "f": there.objective}, stats  # the solver fails on the cycle as it does here
            if not error <= POOR or not self._better(there):
                if length < LEAST_RADIUS or not self._better(expected):
                    if near and not stats["success"]:
                        return {**answer, "x": x, "f": here.objective}, stats
                    return None
                self._radius, model = 0.3 * min(radius, length), replace(model, curvatures=self._curvatures.matrices)
                continue
            self._radius = min(2.0 * radius, MOST_RADIUS) if error <= GOOD else radius
            self._filter.append((there.objective, self._breach(there)))
            x, model = to, self._model(to)
            self.reached = x
            if stats["success"]:
                partial = np.any(to[self._problem.unknown_count :] < self._ends["ubx"][self._problem.unknown_count :])
                noise = CREEP if partial else NOISE
                stands = abs(there.objective - here.objective) < noise and length < 0.99 * radius
                if length < STILL or self._ends_here(there, answer, region, stands=stands):
                    return {**answer, "x": to, "f": there.objective}, stats
        return None

    def _better(self, point: Point, slack: float = NOISE) -> bool:
        """Return whether no point that was taken is as good in both the objective and the largest breach."""
        breach, most = self._breach(point), point.objective + 0.01 * self._breach(point) - slack
        return all(breach < 0.99 * old or most < objective for objective, old in self._filter)

    def _breach(self, point: Point) -> float:
        """Return the largest breach of a limit, zero where it is feasible."""
        breach = np.maximum(point.rows - self._ends["ubg"], self._ends["lbg"] - point.rows)
        largest = float(np.max(breach, initial=0.0))
        return largest if largest > FEASIBLE else 0.0

    def _model(self, x: Array) -> CycleModel | None:
        """Return the model of the cycle at a point; None where the cycle has no end."""
        point = self._programme.at(x)
        if not (np.all(np.isfinite(point.rows)) and np.isfinite(point.objective)):
            return None
        size = self._problem.unknown_count
        return CycleModel.of(x[:size], point.cycle, point.of_cycle, self._curvatures.matrices)

    def _region(self, x: Array) -> dict[str, Array]:
        """Return the bounds of the unknowns within the trust region."""
        size, radius = self._problem.unknown_count, self._radius
        lower, upper = self._ends["lbx"].copy(), self._ends["ubx"].copy()
        lower[:size] = np.maximum(lower[:size], x[:size] - radius)
        upper[:size] = np.minimum(upper[:size], x[:size] + radius)
        return {"lbx": lower, "ubx": upper}

    def _step(
        self, model: CycleModel, x: Array, region: Mapping[str, Array]
    ) -> tuple[dict[str, Any], dict[str, Any], Array, Point]:
        """Solve the programme with the cycle's model; return where that ends, and what is expected there."""
        with self._problem.modelled(model):
            answer = self._solver(self._programme, self._deadline, x0=x, **{**self._ends, **region})
            return answer, self._solver.stats(), answer["x"], self._programme.at(answer["x"])

    def _ends_here(self, point: Point, answer: Mapping[str, Any], region: Mapping[str, Array], *, stands: bool) -> bool:
        """Return whether the cycle's own rows and slopes say that an optimum of the models is one."""
        if self._breach(point) > 0.0:
            return False
        if self._solver.feasible or stands:
            return True
        of_bounds = answer["lam_x"]
        # The trust region is no limit of the programme: where it presses, the search goes on.
        real = (region["lbx"] == self._ends["lbx"]) & (of_bounds < 0.0) | (region["ubx"] == self._ends["ubx"]) & (
            of_bounds > 0.0
        )
        slope = point.gradient + answer["lam_g"] @ point.jacobian + np.where(real, of_bounds, 0.0)
        return bool(np.max(np.abs(slope), initial=0.0) <= STATIONARY)


def _error(expected: Point, there: Point) -> float:
    """Return the largest error of the models, in the objective and in shares of the limits."""
    # How far a limit is satisfied beyond some share of it does not matter to a step.
    rows = np.maximum(there.rows, -POOR) - np.maximum(expected.rows, -POOR)
    errors = np.append(np.abs(rows), abs(there.objective - expected.objective))
    return float(np.max(errors)) if np.all(np.isfinite(errors)) else np.inf
