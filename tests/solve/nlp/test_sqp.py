"""Sequential quadratic programming: published optima, least breaches, ends that are no optimum."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.solve.nlp.solver_run import NO_DESIGN, NO_MODULE, SOLVED
from tvimdesign.solve.nlp.sqp import SqpSolver

Array = Any


class Point(NamedTuple):
    objective: float
    gradient: Array
    rows: Array
    jacobian: Array


class Program:
    """A programme of functions; slopes are central differences."""

    def __init__(self, objective: Callable[[Array], float], rows: Callable[[Array], list[float]], size: int) -> None:
        self.objective, self.rows = objective, lambda x: np.array(rows(x), dtype=float)
        self.unknown_count, self.row_count = size, len(rows(np.ones(size)))
        self.points = 0

    def at(self, x: Array) -> Point:
        self.points += 1
        steps = 1e-6 * np.eye(len(x))
        gradient = np.array([self.objective(x + s) - self.objective(x - s) for s in steps]) / 2e-6
        jacobian = np.array([self.rows(x + s) - self.rows(x - s) for s in steps]).T / 2e-6
        return Point(self.objective(x), gradient, self.rows(x), jacobian)


def solve(program: Program, x0: list[float], low: float, high: float, equations: int = 0, **options: Any):
    size, rows = program.unknown_count, program.row_count
    solver = SqpSolver(size, rows, equations, 1e-8, **options)
    least = np.full(rows, -np.inf)
    least[:equations] = 0.0
    answer = solver(
        program, NEVER, x0=np.array(x0), lbx=np.full(size, low), ubx=np.full(size, high), lbg=least, ubg=np.zeros(rows)
    )
    return answer, solver.stats()


ROSEN_SUZUKI = Program(  # Hock, Schittkowski, Test examples for nonlinear programming codes, 1981, problem 43
    lambda x: x[0] ** 2 + x[1] ** 2 + 2 * x[2] ** 2 + x[3] ** 2 - 5 * x[0] - 5 * x[1] - 21 * x[2] + 7 * x[3],
    lambda x: [
        x @ x + x[0] - x[1] + x[2] - x[3] - 8,
        x[0] ** 2 + 2 * x[1] ** 2 + x[2] ** 2 + 2 * x[3] ** 2 - x[0] - x[3] - 10,
        2 * x[0] ** 2 + x[1] ** 2 + x[2] ** 2 + 2 * x[0] - x[1] - x[3] - 5,
    ],
    4,
)
HS71 = Program(  # The same, problem 71
    lambda x: x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2], lambda x: [x @ x - 40, 25 - np.prod(x)], 4
)


def test_published_optimum_and_multipliers():
    answer, stats = solve(ROSEN_SUZUKI, [0, 0, 0, 0], -10, 10)
    assert stats["return_status"] == SOLVED
    assert answer["f"] == pytest.approx(-44.0, abs=1e-6)
    assert answer["x"] == pytest.approx([0, 1, 2, -1], abs=1e-4)
    assert answer["lam_g"] == pytest.approx([1, 0, 2], abs=1e-3)


def test_equation_and_active_bound():
    answer, stats = solve(HS71, [1, 5, 5, 1], 1, 5, equations=1)
    assert stats["success"]
    assert answer["f"] == pytest.approx(17.0140173, abs=1e-6)
    slope = HS71.at(answer["x"])
    lagrangian = slope.gradient + answer["lam_g"] @ slope.jacobian + answer["lam_x"]
    assert np.max(np.abs(lagrangian)) < 1e-5
    assert answer["lam_x"][0] < 0.0


def test_curved_equation_takes_few_points():
    """On a circle full steps are refused for its curvature (Maratos) unless a second step makes up for it."""
    circle = Program(lambda x: 2 * (x @ x - 1) - x[0], lambda x: [x @ x - 1], 2)
    answer, stats = solve(circle, [np.cos(1.5), np.sin(1.5)], -10, 10, equations=1)
    assert stats["success"]
    assert answer["x"] == pytest.approx([1, 0], abs=1e-4)
    assert circle.points < 40


def test_programme_without_a_point_ends_where_breaches_cost_least():
    disc = Program(lambda x: x[1], lambda x: [x @ x - 1, 3 - x[0]], 2)
    answer, stats = solve(disc, [0.3, 0.7], -10, 10)
    assert stats["return_status"] == NO_DESIGN
    assert not stats["success"]
    slope = np.polynomial.Polynomial([-4, 1, 0, 2])  # Of both breaches with half their squares, by x
    (root,) = (float(x.real) for x in slope.roots() if abs(x.imag) < 1e-9)
    assert answer["x"] == pytest.approx([root, 0.0], abs=2e-2)


def test_limits_that_are_hard_to_reach_are_reached():
    """Raise the price of a breach: at ten, the limit is not reached, whose multiplier at the optimum is 100."""
    steep = Program(lambda x: 100.0 * x[0], lambda x: [1.0 - x[0]], 1)
    answer, stats = solve(steep, [3.0], -10, 10)
    assert stats["success"]
    assert answer["x"] == pytest.approx([1.0], abs=1e-7)
    assert answer["lam_g"] == pytest.approx([100.0], rel=1e-4)


def test_steps_into_nothing_are_taken_back():
    root = Program(lambda x: float(np.sqrt(x[0] - 0.5)) if x[0] >= 0.5 else np.nan, lambda x: [0.6 - x[0]], 1)
    answer, stats = solve(root, [3.0], 0.0, 10)
    assert stats["success"]
    assert answer["x"] == pytest.approx([0.6], abs=1e-7)
    assert solve(root, [0.2], 0.0, 10)[1]["return_status"] == NO_MODULE


def test_points_without_slopes_are_taken_back():
    steep = Program(lambda x: x[0], lambda x: [0.6 - x[0]], 1)
    at = steep.at
    steep.at = lambda x: at(x) if x[0] > 0.5 else at(x)._replace(jacobian=np.array([[np.nan]]))
    answer, stats = solve(steep, [3.0], 0.0, 10)
    assert stats["success"]
    assert answer["x"] == pytest.approx([0.6], abs=1e-7)
    assert solve(steep, [0.2], 0.0, 10)[1]["return_status"] == NO_MODULE


def test_first_feasible_point_ends_a_run_for_one():
    answer, stats = solve(ROSEN_SUZUKI, [5, 5, 5, 5], -10, 10, feasible=True)
    assert stats["success"]
    assert np.max(ROSEN_SUZUKI.at(answer["x"]).rows) <= 1e-8
    assert answer["f"] > -43.9


def test_deadline_and_iterations_end_a_run():
    assert solve(HS71, [1, 5, 5, 1], 1, 5, equations=1, most=2)[1]["iter_count"] == 2
    size, rows = 4, np.zeros(2)
    solver = SqpSolver(size, 2, 1, 1e-8)
    past = Deadline(0.0)
    solver(HS71, past, x0=np.ones(size), lbx=np.ones(size), ubx=np.full(size, 5.0), lbg=rows, ubg=rows)
    assert solver.stats()["return_status"] == "Maximum_WallTime_Exceeded"
