"""Symbols that numpy's functions act on: they are what numpy computes, to the last digit."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.symbols import symbols

WRITTEN: dict[str, Callable[[Any], Any]] = {
    "arithmetic of entries": lambda x: (x[0] + 2.0) * x[1] - 3.0 / x[2] + x[1] ** 2 - 2 ** x[0] + (-x[2]),
    "numbers on the left": lambda x: 1.0 - x[0] + 2 * x[1] / (4.0 / x[2]) + np.float64(0.3) * x[0],
    "elementwise functions": lambda x: np.sum(
        np.sqrt(x) + np.exp(-x) + np.expm1(x) + np.log(x) + np.log1p(x) + np.sin(x) + np.cos(x) + np.tanh(x)
        + np.arcsin(x / 10.0) + np.arctan(x) + np.abs(-x)
    ),
    "smaller and larger": lambda x: np.fmin(x[0], x[1]) - np.fmax(x[2], 1.0) + np.minimum(0.5, x[1]),
    "angles of two sides": lambda x: np.arctan2(x[0], x[1]),
    "array with array": lambda x: np.sum(x * np.array([1.0, 2.0, 3.0]) + np.array([1.0, 2.0, 3.0]) / x),
    "array with entry": lambda x: np.sum(x * x[0] + x[1] / x - (x[2] - x)),
    "parts of an array": lambda x: np.sum(x[1:] * x[:-1]) + np.sum(np.diff(x) ** 2) + x[-1],
    "arrays put together": lambda x: np.sum(np.append(x, x[0]) * np.array([1.0, -1.0, 2.0, 0.5])) + np.mean(x),
    "a table of two dimensions": lambda x: np.sum(np.reshape(x, (3, 1)) * np.array([[1.0, 2.0]])),
}  # fmt: skip


@pytest.mark.parametrize("what", WRITTEN)
@given(values=st.lists(st.floats(0.1, 9.0), min_size=3, max_size=3))
def test_an_expression_of_symbols_is_what_numpy_computes(what: str, values: list[float]) -> None:
    column = ca.SX.sym("x", 3)
    written = ca.Function("written", [column], [WRITTEN[what](symbols(column))])
    assert float(written(values)) == pytest.approx(float(WRITTEN[what](np.array(values))), rel=1e-13, abs=1e-13)
