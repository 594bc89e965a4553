"""Many small problems at once: each ends where it is known to, and what goes wrong in one column stays there."""

from __future__ import annotations

import numpy as np
import pytest

from tvimdesign.simulation.casadi_setup import ca
from tvimdesign.solve.discrete.side_by_side import PENALTY, Found, SideBySide
from tvimdesign.solve.discrete.systems import solve_definite


@pytest.fixture(scope="module")
def discs() -> SideBySide:
    """The point of a disc around the origin, radius c0, that is lowest along (c1, c2), right of a line at c3."""
    u, c = ca.SX.sym("u", 2), ca.SX.sym("c", 4)
    rows = ca.vertcat(ca.sumsqr(u) - c[0] ** 2, c[3] - u[0])
    return SideBySide(ca.Function("discs", [u, c], [ca.dot(c[1:3], u), rows]))


def _solved(problem: SideBySide, columns: list[list[float]], ends: float = 10.0) -> Found:
    own = np.array(columns, dtype=float).T
    begin, low = np.full((2, own.shape[1]), 1.0), np.full((2, own.shape[1]), -ends)
    return problem.solve(begin, own, low, -low)


def test_every_column_ends_at_its_own_optimum(discs: SideBySide) -> None:
    """By hand: -c/|c| times the radius; where the line cuts that off, the corner of line and circle; else the end."""
    found = _solved(discs, [[2.0, 3.0, 4.0, -9.0], [1.0, 0.0, 1.0, 0.6], [100.0, -1.0, 0.5, -9.0]])
    assert np.all(found.converged)
    expected = np.array([[-1.2, -1.6], [0.6, -0.8], [10.0, -10.0]]).T
    assert found.unknowns == pytest.approx(expected, abs=1e-5)
    assert found.values == pytest.approx([-10.0, -0.8, -15.0], abs=1e-5)
    assert found.broken == pytest.approx(0.0, abs=1e-6)


def test_limits_that_cannot_be_kept_are_broken_as_little_as_can_be(discs: SideBySide) -> None:
    """By hand: u^2 - 1 = 3 - u at u = (sqrt(17) - 1) / 2, as far beyond one limit as beyond the other."""
    found = _solved(discs, [[1.0, 0.0, 1.0, 3.0]])
    at = (np.sqrt(17.0) - 1.0) / 2.0
    assert found.converged[0]
    assert found.broken[0] == pytest.approx(3.0 - at, rel=1e-4)
    assert found.values[0] == pytest.approx(PENALTY * (3.0 - at), rel=1e-3)


def test_a_column_that_is_no_number_leaves_the_others_alone(discs: SideBySide) -> None:
    good = [2.0, 3.0, 4.0, -9.0]
    alone, beside = _solved(discs, [good]), _solved(discs, [[np.nan, 1.0, 1.0, 0.0], good])
    assert list(beside.converged) == [False, True]
    assert beside.values[0] == -np.inf
    assert np.array_equal(beside.unknowns[:, 1], alone.unknowns[:, 0])


def test_saddles_are_left_for_a_minimum() -> None:
    """x^4/4 - x^2/2 + y^2 has its saddle at the origin, where curvature is negative, and minima of -1/4 at (+-1, 0)."""
    u, c = ca.SX.sym("u", 2), ca.SX.sym("c", 1)
    form = ca.Function("saddle", [u, c], [u[0] ** 4 / 4 - u[0] ** 2 / 2 + u[1] ** 2, u[0] + u[1] - c])
    found = _solved(SideBySide(form), [[5.0], [6.0]], ends=3.0)
    assert np.all(found.converged)
    assert found.values == pytest.approx(-0.25, abs=1e-6)


def test_systems_are_solved_as_numpy_solves_them_and_made_definite_where_they_are_not() -> None:
    random = np.random.default_rng(3)
    half = random.normal(size=(5, 5, 40))
    matrix = np.einsum("ijk,ljk->ilk", half, half) + 0.1 * np.eye(5)[:, :, None]
    right = random.normal(size=(5, 40))
    expected = np.linalg.solve(np.moveaxis(matrix, 2, 0), right.T[:, :, None])[:, :, 0].T
    assert solve_definite(matrix, right) == pytest.approx(expected, rel=1e-8, abs=1e-8)
    matrix[:, :, ::2] -= 5.0 * np.eye(5)[:, :, None]
    assert np.all(np.sum(solve_definite(matrix, right) * right, axis=0) > 0.0), "every step goes uphill along the slope"
