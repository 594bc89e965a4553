"""Derivatives put together from those of the functions a problem calls, against CasADi's of the problem as a whole."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.solve.nlp.derivatives import derivatives_of
from tvimdesign.solve.nlp.objective import Objective
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import read_study_text

Array = NDArray[np.float64]
HEATING = """
mode: {mode}
vary:
  wire_diameter: [1.5 mm, 3 mm]
  {depth}
  current: [0.5 A, 2 A]
require:
  spring_stiffness: ">= 2 N.m/rad"
  peak_power: "<= 12 W"
  peak_peltier_temperature: "<= 120 degC"
minimize: {{module_mass: 1, response_time: 1, switch_energy: 1}}
solver: {{starts: 1, cells: 4, elements: 2}}
"""
SHEAR = HEATING.format(mode="shear", depth="pcl_thickness: [0.6 mm, 2 mm]")
COMPRESSION = HEATING.format(mode="compression", depth="block_depth: [3 mm, 6 mm]")
CYCLE = """
mode: shear
module: {cold_side: sink, current_slew: 0.5 A/s}
vary:
  pcl_thickness: [0.6 mm, 2 mm]
  current: [0.3 A, 3 A]
  cooling_current: [0.05 A, 2.5 A]
require:
  hold_power: "<= 30 W"
  peak_peltier_temperature: "<= 130 degC"
minimize: cycle_time
profile: {softening: 1, stiffening: 1}
solver: {starts: 1, cells: 3, elements: 2}
"""
ROBUST = (
    SHEAR + "tolerances: {wire_diameter: 0.05 mm, coil_diameter: {row: coil_diameter_tolerance}}\nrobust: {sigma: 2}\n"
)


def of_the_whole(problem: Any) -> Any:
    """The function to Jacobian of g and Hessian of the Lagrangian, both as CasADi finds them."""
    x, p = (ca.MX.sym(name, problem.size1_in(i)) for i, name in enumerate("xp"))
    f, g = problem(x, p)
    lam_f, lam_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", g.numel())
    bent = ca.hessian(lam_f * f + ca.dot(lam_g, g), x)[0]
    return ca.Function("whole", [x, p, lam_f, lam_g], [ca.jacobian(g, x), ca.triu(bent)])


def assert_same(problem: Any, x: Array, p: Array) -> None:
    """Values and patterns, at random multipliers."""
    found = derivatives_of(problem)
    multipliers = np.random.default_rng(1).normal(size=problem.size1_out(1))
    expected = of_the_whole(problem)(x, p, 1.3, multipliers)
    rows, jacobian = found["jac_g"](x, p)
    np.testing.assert_array_equal(np.asarray(rows), np.asarray(problem(x, p)[1]))
    for mine, theirs in zip((jacobian, found["hess_lag"](x, p, 1.3, multipliers)), expected, strict=True):
        assert mine.sparsity().is_subset(theirs.sparsity())
        largest = np.max(np.abs(theirs.nonzeros()))
        np.testing.assert_allclose(mine.full(), theirs.full(), rtol=0.0, atol=1e-13 * largest)


@pytest.mark.gate
@pytest.mark.parametrize("text", [SHEAR, COMPRESSION, CYCLE, ROBUST], ids=["shear", "compression", "cycle", "robust"])
def test_derivatives_of_a_problem_are_those_of_the_whole(text: str) -> None:
    study = read_study_text(text, "a test")
    optimizer = Optimizer(study)
    begin = optimizer.guess(optimizer.model.start)
    apart = 1e-3 * np.random.default_rng(2).normal(size=begin.size)
    assert_same(optimizer._compiled, begin + apart, optimizer.parameters(Objective(study.minimize)))


def test_calls_may_need_calls_that_may_share_arguments_and_have_graphs_of_their_own() -> None:
    x, p = ca.MX.sym("x", 4), ca.MX.sym("p", 2)
    state, shared = ca.SX.sym("state", 2), ca.SX.sym("shared", 2)
    first = ca.Function("first", [state, shared], [ca.vertcat(state[0] * shared[0] ** 2, ca.sin(state[1] * shared[1]))])
    inner = ca.MX.sym("inner", 2)
    second = ca.Function("second", [inner], [ca.exp(inner[0]) * first(inner, inner)])
    columns = ca.horzcat(x[:2], x[2:], ca.vertcat(x[0] * x[3], p[1]))
    mapped = first.map(3)(columns, ca.repmat(ca.vertcat(x[1] ** 2, p[0]), 1, 3))
    after = second(mapped[:, 2] + x[:2])
    problem = ca.Function("problem", [x, p], [ca.dot(after, after), ca.vertcat(ca.vec(mapped), after[0] * x[0], x[1])])
    assert_same(problem, np.array([0.3, 0.7, -0.4, 1.1]), np.array([0.9, -0.5]))


@pytest.mark.parametrize("count", [1, 3])
def test_a_call_of_which_nothing_moves_has_no_derivatives(count: int) -> None:
    x, p, entry = ca.MX.sym("x", 2), ca.MX.sym("p", 2), ca.SX.sym("entry", 2)
    one = ca.Function("one", [entry], [ca.sin(entry[0]) * entry[1]])
    other = ca.Function("other", [entry], [entry[0] ** 2 * entry[1]])
    still = ca.sum2((one if count == 1 else one.map(count))(ca.repmat(p, 1, count)))
    moved = other(ca.vertcat(x[0] * still, x[1]))
    problem = ca.Function("problem", [x, p], [moved * still, ca.vertcat(moved * x[1], still)])
    assert_same(problem, np.array([0.3, 0.7]), np.array([0.9, 2.0]))


def test_a_problem_without_calls_has_derivatives_too() -> None:
    x, p = ca.MX.sym("x", 2), ca.MX.sym("p")
    problem = ca.Function("problem", [x, p], [ca.sin(x[0]) * p, ca.vertcat(x[0] * x[1] ** 2, x[1])])
    assert_same(problem, np.array([0.3, 0.7]), np.array([2.0]))


@pytest.mark.parametrize("count", [1, 3])
def test_a_call_may_have_several_results(count: int) -> None:
    x, p, entry = ca.MX.sym("x", 2), ca.MX.sym("p"), ca.SX.sym("entry", 2)
    one = ca.Function("one", [entry], [ca.vertcat(ca.sin(entry[0]), entry[1] ** 2)])
    two = ca.Function("two", [entry], [entry[0] * entry[1], ca.vertcat(entry[0] ** 3, entry[1])])
    every = two if count == 1 else two.map(count)
    # Its arguments hang on another call: what is not opened up would lose that way.
    product, cubes = every.call([ca.repmat(one.call([x], False, True)[0], 1, count)], False, True)
    problem = ca.Function("problem", [x, p], [p * ca.sum2(product), ca.vec(cubes)])
    assert_same(problem, np.array([0.3, 0.7]), np.array([2.0]))
