"""Tapes down columns: the same numbers as CasADi and the C library, for any count of columns and of workers."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from support import ROOT, digits

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.batch.batch_model import Kernel, of_columns
from tvimdesign.study import given, read_study

ONE: dict[str, tuple[Callable[[float], float], list[float]]] = {
    "exp": (math.exp, [-745.0, -30.0, -1.0, -1e-9, 0.0, 1e-9, 0.3, 1.0, 30.0, 709.0]),
    "log": (math.log, [5e-324, 1e-310, 1e-300, 0.5, 0.7071, 0.7072, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.4143, 3.0, 1e300]),
    "log1p": (math.log1p, [-0.9999, -1e-12, 0.0, 1e-18, 1e-9, 0.5, 1e6]),
    "sqrt": (math.sqrt, [0.0, 1e-300, 2.0]),
    "sin": (math.sin, [-3.0, 0.1, 50.0]),
    "asin": (math.asin, [-1.0, 0.2, 1.0]),
    "fabs": (math.fabs, [-2.0, 0.0, 3.0]),
    "tanh": (math.tanh, [-20.0, 0.1]),
    "cos": (math.cos, [-3.0, 0.1, 50.0]),
    "tan": (math.tan, [-1.0, 0.1, 1.5]),
    "acos": (math.acos, [-1.0, 0.2, 1.0]),
    "atan": (math.atan, [-1e6, 0.3, 2.0]),
    "sinh": (math.sinh, [-2.0, 1e-9, 5.0]),
    "cosh": (math.cosh, [-2.0, 0.0, 5.0]),
    "erf": (math.erf, [-0.5, 1e-9, 2.0]),
    "floor": (math.floor, [-1.5, -1.0, 0.0, 2.7]),
    "ceil": (math.ceil, [-1.5, -1.0, 0.0, 2.7]),
    "sign": (lambda x: math.copysign(1.0, x) if x else 0.0, [-2.5, 0.0, 1e-300]),
}


@pytest.mark.parametrize("name", ONE)
def test_functions_of_one_number_are_those_of_the_c_library(name: str) -> None:
    function, places = ONE[name]
    x = ca.SX.sym("x")
    found = Kernel(ca.Function("f", [x], [getattr(ca, name)(x)]))(np.array([places]))[0]
    assert found == pytest.approx([function(place) for place in places], rel=1e-15, abs=5e-324)


def test_what_is_no_number_stays_none() -> None:
    x = ca.SX.sym("x")
    kernel = Kernel(ca.Function("f", [x], [ca.vertcat(ca.exp(x), ca.log(x), ca.log1p(x))]))
    found = kernel(np.array([[math.nan, -2.0, 0.0, math.inf, -math.inf]]))
    assert np.array_equal(found[0, [0, 3, 4]], [math.nan, math.inf, 0.0], equal_nan=True)
    assert np.array_equal(found[1], [math.nan, math.nan, -math.inf, math.inf, math.nan], equal_nan=True)
    assert found[2, 3] == math.inf


def test_functions_of_two_numbers_and_choices() -> None:
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    entries = [x**y, ca.atan2(x, y), ca.fmin(x, y), ca.fmax(x, y), ca.if_else(x < y, x, y), x / y, x**0.3]
    found = Kernel(ca.Function("f", [x, y], [ca.vertcat(*entries)]))(np.array([[2.5], [1.5]]))[:, 0]
    assert found == pytest.approx([2.5**1.5, math.atan2(2.5, 1.5), 1.5, 2.5, 1.5, 2.5 / 1.5, 2.5**0.3], rel=1e-15)


def test_comparisons_and_logic_are_those_of_casadi() -> None:
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    entries = [x < y, x <= y, x == y, x != y, ca.logic_not(x), ca.logic_and(x, y), ca.logic_or(x, y),
               ca.if_else(x, y, 7.0), ca.copysign(x, y), -x, x * x, 2 * x, 1 / (x + 3.0)]  # fmt: skip
    function = ca.Function("f", [x, y], [ca.vertcat(*entries)])
    columns = np.array(
        [[-1.0, -1.0, 0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 0.5], [-1.0, 2.0, 0.0, 3.0, -3.0, 2.0, 0.0, 1.0, 0.5]]
    )
    expected = np.hstack([np.asarray(function(*column)) for column in columns.T])
    assert Kernel(function)(columns) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize("study", ["paper_shear", "paper_compression", "wrist_joint"])
def test_the_kernel_of_the_table_agrees_with_casadi(study: str) -> None:
    read = read_study(ROOT / f"studies/{study}.yaml")
    table = table_for(read.mode)
    model = DeviceFunctions(table, given(read), tuple(read.operating_points), read.solver.cells)
    moving = ["wire_diameter", "coil_diameter", "preload_angle", "pcl_inner_radius", "pcl_flexural_modulus", "current"]
    places = [(0, model.index[name]) for name in moving]
    function = of_columns(model.every_output, [model.start, np.full(len(model.switch_names), 50.0)], places)
    random = np.random.default_rng(1)
    columns = np.array([[model.start[i]] for _, i in places]) * random.uniform(0.99, 1.01, (len(moving), 21))
    found, expected = Kernel(function)(columns), np.asarray(function(columns))
    for name, ours, theirs in zip(model.output_names, found, expected, strict=True):
        assert ours == pytest.approx(theirs, rel=digits(name, 1e-13), abs=1e-15, nan_ok=True), name


def test_no_bit_hangs_on_workers_or_neighbours() -> None:
    x = ca.SX.sym("x", 2)
    kernel = Kernel(ca.Function("f", [x], [ca.vertcat(ca.exp(x[0]) * ca.log(x[1]), x[0] ** x[1])]))
    columns = np.random.default_rng(2).uniform(0.1, 3.0, (2, 10_007))
    alone = kernel(columns)
    assert np.array_equal(alone, kernel(columns, workers=2))
    assert np.array_equal(alone[:, 5_001:5_004], kernel(np.ascontiguousarray(columns[:, 5_001:5_004])))


def test_arrays_that_are_not_row_by_row_are_copied() -> None:
    x = ca.SX.sym("x", 2)
    kernel = Kernel(ca.Function("f", [x], [x[0] - 2.0 * x[1]]))
    columns = np.arange(20.0).reshape(10, 2).T
    assert kernel(columns)[0] == pytest.approx(columns[0] - 2.0 * columns[1])
    with pytest.raises(ValueError, match="takes 2 rows, got 3"):
        kernel(np.zeros((3, 4)))
