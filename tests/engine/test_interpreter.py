"""The interpreter's operations: values as CasADi's to the last bit, slopes as CasADi's, and the edges of each."""

import math
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tvimdesign.engine import interpreter
from tvimdesign.engine.tape import Tape

Array = NDArray[np.float64]
BINARY = (
    "ADD", "SUB", "MUL", "DIV", "POW", "LT", "LE", "EQ", "NE", "AND", "OR", "COPYSIGN", "IF_ELSE_ZERO",
    "FMIN", "FMAX", "ATAN2", "HYPOT",
)  # fmt: skip
NAMES = [name for name in vars(interpreter) if name.isupper() and hasattr(ca, f"OP_{name}")]
CORNERS = ("FMIN", "FMAX", "COPYSIGN", "FABS")
"""Where both operands are the same, or the first is zero, any slope between those of both sides will do."""
EDGES = [0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 3.0, -2.5, 1e-300, 1e300, math.inf, -math.inf, math.nan]
numbers = st.one_of(st.sampled_from(EDGES), st.floats(-6.0, 6.0))
sizes = st.floats(-6.0, 6.0).filter(lambda x: x == 0.0 or abs(x) > 1e-6)


def written(name: str) -> tuple[list[Any], Any]:
    """Two symbols, and one operation of them, as CasADi writes it."""
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    op = getattr(ca, f"OP_{name}")
    return [x, y], (ca.SX.binary(op, x, y) if name in BINARY else ca.SX.unary(op, x))


def both(name: str) -> tuple[Tape, Any, Any]:
    """Return the operation as a tape, and as CasADi's function of its operands and of those and a direction."""
    operands, value = written(name)
    along = ca.SX.sym("along", 2)
    slope = ca.jtimes(value, ca.vertcat(*operands), along)
    return (
        Tape.of(operands, [value]),
        ca.Function("value", operands, [value]),
        ca.Function("slope", [*operands, along], [slope]),
    )


NAMES.remove("CONSTPOW")  # its exponent is a number: below
MADE = {name: both(name) for name in NAMES}


def bits(value: float) -> int:
    """Return the bits of a number; all NaN are alike."""
    return int(np.array(math.nan if math.isnan(value) else value).view(np.int64))


def test_every_operation_is_known_to_the_tape_by_its_number() -> None:
    assert len(NAMES) == 44
    for name, (tape, *_) in MADE.items():
        assert tape.code.groups[:, 0].tolist() == [getattr(interpreter, name), 0], name


@pytest.mark.parametrize("name", NAMES)
def test_a_value_at_the_edges_is_that_of_casadi_to_the_last_bit(name: str) -> None:
    tape, value, _ = MADE[name]
    for x in EDGES:
        for y in EDGES:
            assert bits(tape.values(np.array([x, y]))[0][0]) == bits(float(value(x, y))), (x, y)


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=30)
@given(x=numbers, y=numbers)
def test_a_value_is_that_of_casadi_to_the_last_bit(name: str, x: float, y: float) -> None:
    tape, value, _ = MADE[name]
    expected, at = bits(float(value(x, y))), np.array([x, y])
    assert bits(tape.values(at)[0][0]) == expected
    assert bits(tape.tangents((at,), (np.eye(2),))[0][0][0]) == expected


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=30)
@given(x=sizes, y=sizes, along=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)))
@example(x=0.0, y=0.0, along=(1.0, 2.0))
@example(x=1.0, y=1.0, along=(1.0, 2.0))
@example(x=-1.5, y=2.0, along=(-1.0, 2.0))
@example(x=2.5, y=-0.5, along=(1.0, 0.0))
@example(x=1e-05, y=1e-05, along=(2.991171371580771, 2.991171371580771))
def test_tangents_are_those_of_casadi(name: str, x: float, y: float, along: tuple[float, float]) -> None:
    tape, value, slope = MADE[name]
    directions = np.array([[along[0], 1.0], [along[1], -1.0]])
    expected = np.array([float(slope(x, y, column)) for column in directions.T])
    ((values, tangents),) = tape.tangents((np.array([x, y]),), (directions,))
    if (name in CORNERS and x in (y, 0.0)) or not np.all(np.isfinite([float(value(x, y)), *expected])):
        return
    # Two terms that cancel leave the rounding of the terms.
    terms = np.array([[abs(float(slope(x, y, column * axis))) for axis in np.eye(2)] for column in directions.T])
    assert np.all(np.abs(tangents[0] - expected) <= 1e-11 * np.maximum(1.0, terms.sum(axis=1)))
    assert bits(values[0]) == bits(float(value(x, y)))


@pytest.mark.parametrize("exponent", [-1.5, 0.25, 1.0 / 3.0, 1.7, 120.5])
@settings(max_examples=30)
@given(x=numbers)
def test_a_power_with_a_number_as_exponent_is_that_of_casadi(exponent: float, x: float) -> None:
    base = ca.SX.sym("base")
    value = ca.Function("value", [base], [base**exponent])
    slope = ca.Function("slope", [base], [ca.jacobian(base**exponent, base)])
    tape = Tape.of([base], [base**exponent])
    assert interpreter.CONSTPOW in tape.code.groups[:, 0]
    ((found, tangent),) = tape.tangents((np.array([x]),), (np.ones((1, 1)),))
    assert bits(found[0]) == bits(tape.values(np.array([x]))[0][0]) == bits(float(value(x)))
    if np.isfinite(float(slope(x))):
        assert tangent[0, 0] == pytest.approx(float(slope(x)), rel=1e-12)


def test_a_tangent_of_what_is_no_number_is_none() -> None:
    x = ca.SX.sym("x")
    tape = Tape.of([x], [ca.sqrt(x), ca.log(x), ca.acosh(x)])
    for value, tangent in tape.tangents((np.array([-1.0]),), (np.ones((1, 1)),)):
        assert np.isnan(value[0])
        assert not np.isfinite(tangent[0, 0]) or tangent[0, 0] == -1.0  # a logarithm's slope goes on beyond zero


def test_what_an_unused_operand_moves_by_never_comes_in() -> None:
    # A branch that is not taken may be no number, and so may its tangent.
    x = ca.SX.sym("x")
    tape = Tape.of([x], [ca.if_else(x > 0.0, x, ca.sqrt(x))])
    ((value, tangent),) = tape.tangents((np.array([4.0]),), (np.ones((1, 1)),))
    assert (value[0], tangent[0, 0]) == (4.0, 1.0)
