"""Tapes are recorded, interpreted and differentiated as CasADi does."""

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


def test_every_operation_is_known_to_the_tape_by_its_number():
    assert len(NAMES) == 44
    for name, (tape, *_) in MADE.items():
        assert tape.code.groups[:, 0].tolist() == [getattr(interpreter, name), 0], name


@pytest.mark.parametrize("name", NAMES)
def test_a_value_at_the_edges_is_that_of_casadi_to_the_last_bit(name):
    tape, value, _ = MADE[name]
    for x in EDGES:
        for y in EDGES:
            assert bits(tape.values(np.array([x, y]))[0][0]) == bits(float(value(x, y))), (x, y)


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=30)
@given(x=numbers, y=numbers)
def test_a_value_is_that_of_casadi_to_the_last_bit(name, x, y):
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
def test_tangents_are_those_of_casadi(name, x, y, along):
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
def test_a_power_with_a_number_as_exponent_is_that_of_casadi(exponent, x):
    base = ca.SX.sym("base")
    value = ca.Function("value", [base], [base**exponent])
    slope = ca.Function("slope", [base], [ca.jacobian(base**exponent, base)])
    tape = Tape.of([base], [base**exponent])
    assert interpreter.CONSTPOW in tape.code.groups[:, 0]
    ((power, tangent),) = tape.tangents((np.array([x]),), (np.ones((1, 1)),))
    assert bits(power[0]) == bits(tape.values(np.array([x]))[0][0]) == bits(float(value(x)))
    if np.isfinite(float(slope(x))):
        assert tangent[0, 0] == pytest.approx(float(slope(x)), rel=1e-12)


def test_a_tangent_of_what_is_no_number_is_none():
    x = ca.SX.sym("x")
    tape = Tape.of([x], [ca.sqrt(x), ca.log(x), ca.acosh(x)])
    for value, tangent in tape.tangents((np.array([-1.0]),), (np.ones((1, 1)),)):
        assert np.isnan(value[0])
        assert not np.isfinite(tangent[0, 0]) or tangent[0, 0] == -1.0  # a logarithm's slope goes on beyond zero


def test_what_an_unused_operand_moves_by_never_comes_in():
    # A branch that is not taken may be no number, and so may its tangent.
    x = ca.SX.sym("x")
    tape = Tape.of([x], [ca.if_else(x > 0.0, x, ca.sqrt(x))])
    ((value, tangent),) = tape.tangents((np.array([4.0]),), (np.ones((1, 1)),))
    assert (value[0], tangent[0, 0]) == (4.0, 1.0)


STEPS = (
    lambda a, b, _: a + b, lambda a, b, _: a - b, lambda a, b, _: a * b, lambda a, b, _: a / (1.0 + b * b),
    lambda a, *_: ca.sin(a), lambda a, *_: ca.exp(-a * a),
    # another offset each time: where two equal values meet in fmin, its derivative is anybody's choice
    lambda a, b, place: ca.fmin(a, ca.cos(b) + 0.1234 * place), lambda a, b, _: ca.if_else(a < b, a, 0.3 * b),
)  # fmt: skip
steps = st.lists(
    st.tuples(st.integers(0, len(STEPS) - 1), st.integers(0, 10**6), st.integers(0, 10**6)), min_size=1, max_size=60
)


def grown(taken: list[tuple[int, int, int]]) -> tuple[Any, Any, Any]:
    """Return an expression that grows by an operation of two earlier values at a time, and two of its values."""
    x = ca.SX.sym("x", 3)
    values = [x[0], x[1], x[2], ca.SX(0.7)]
    for kind, first, other in taken:
        values.append(STEPS[kind](values[first % len(values)], values[other % len(values)], len(values)))
    return x, ca.vertcat(*values[-5:]), values[len(values) // 2]


def operations(tape: Tape) -> int:
    return int(tape.code.groups[-1, 1])


@settings(max_examples=200)
@given(taken=steps, at=st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=3))
def test_registers_that_are_used_again_never_lose_what_is_still_read(taken, at):
    x, many, single = grown(taken)
    tape, function = Tape.of([x], [many, single]), ca.Function("f", [x], [many, single])
    expected = [np.asarray(ca.densify(part)).ravel() for part in function(at)]
    for part, other in zip(tape.values(np.array(at)), function(at), strict=True):
        assert part.tolist() == np.array(other.nonzeros()).tolist()
    moved = ca.Function("g", [x], [ca.jacobian(ca.vertcat(many, single), x)])
    tangents = np.concatenate([slope for _, slope in tape.tangents((np.array(at),), (np.eye(3),))])
    assert tangents == pytest.approx(np.asarray(moved(at)), rel=1e-10, abs=1e-10)
    assert len(expected[0]) == 5


@given(taken=steps, at=st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=3), first=st.integers(1, 2))
def test_a_tape_in_two_parts_is_the_whole(taken, at, first):
    x, many, single = grown(taken)
    arguments = ca.SX.sym("y", first), ca.SX.sym("k", 3 - first)
    values = ca.substitute(ca.vertcat(many, single), x, ca.vertcat(*arguments))
    constants_tape, values_tape = Tape.parted(arguments, [values])
    (constants,) = constants_tape.values(np.array(at[first:]))
    (parted,) = values_tape.values(np.array(at[:first]), constants)
    (whole,) = Tape.of(arguments, [values], inverses=True).values(np.array(at[:first]), np.array(at[first:]))
    assert parted.tolist() == whole.tolist()
    used = {int(place) for side in (values_tape.code.first, values_tape.code.second) for place in side}
    used |= {int(place) for place in values_tape.results[0]}
    assert set(range(first, first + len(constants))) <= used, "what is handed on is needed"


@given(taken=steps)
def test_no_operation_writes_where_its_own_group_reads(taken):
    x, many, single = grown(taken)
    code = Tape.of([x], [many, single]).code
    for (_, start), (_, end) in zip(code.groups[:-1], code.groups[1:], strict=True):
        written = code.to[start:end].tolist()
        assert len(set(written)) == len(written)
        assert not set(written) & {*code.first[start:end].tolist(), *code.second[start:end].tolist()}


def test_a_long_chain_needs_few_registers():
    x = ca.SX.sym("x", 2)
    value = x[0]
    for _ in range(500):
        value = ca.sin(value) + x[1]
    tape = Tape.of([x], [value])
    assert operations(tape) == 1000
    assert tape.registers.size <= 2 + 4


def test_what_is_written_twice_is_computed_once():
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    twice = ca.exp(x * y) + ca.exp(y * x) * ca.sin(x + y) - ca.sin(y + x)
    tape = Tape.of([x, y], [twice, ca.exp(x * y)])
    # x y, its exponential, x + y, its sine, their product, the sum, the difference
    assert operations(tape) == 7
    values = tape.values(np.array([0.3]), np.array([0.9]))
    assert values[0][0] == pytest.approx(float(ca.Function("f", [x, y], [twice])(0.3, 0.9)), rel=1e-15)
    assert values[1][0] == pytest.approx(np.exp(0.27), rel=1e-15)


def test_operands_that_may_not_change_places_are_not_taken_for_the_same():
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    tape = Tape.of([x, y], [x - y, y - x, x / y, y / x])
    assert operations(tape) == 4
    assert [float(part[0]) for part in tape.values(np.array([3.0]), np.array([2.0]))] == [1.0, -1.0, 1.5, 2.0 / 3.0]


def test_results_may_be_arguments_constants_or_empty_and_have_zeros():
    x = ca.SX.sym("x", 2)
    sparse = ca.diag(x)
    tape = Tape.of([x], [x, ca.SX(4.0), ca.SX(0, 1), sparse])
    whole, number, nothing, entries = tape.values(np.array([1.5, -2.0]))
    assert whole.tolist() == entries.tolist() == [1.5, -2.0]
    assert number.tolist() == [4.0]
    assert nothing.size == 0
    ((_, of_whole), (_, of_number), *_) = tape.tangents((np.zeros(2),), (np.array([[1.0, 2.0], [3.0, 4.0]]),))
    assert of_whole.tolist() == [[1.0, 2.0], [3.0, 4.0]]
    assert of_number.tolist() == [[0.0, 0.0]]


def test_a_run_leaves_nothing_to_the_next():
    x = ca.SX.sym("x", 2)
    tape = Tape.of([x], [ca.sqrt(x[0]) * x[1], 3.0 * x[1]])
    first = [part.tolist() for part in tape.values(np.array([4.0, 5.0]))]
    tape.values(np.array([np.nan, np.inf]))
    tape.tangents((np.array([-1.0, 0.0]),), (np.full((2, 2), np.nan),))
    assert [part.tolist() for part in tape.values(np.array([4.0, 5.0]))] == first == [[10.0], [15.0]]


def test_unknown_operations_are_refused_or_give_no_number():
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    with pytest.raises(ValueError, match=rf"operation {ca.OP_FMOD} is not known"):
        Tape.of([x, y], [ca.fmod(x, y) + 1.0])
    assert np.isnan(interpreter.slopes_of(90, 1.0, 2.0)[0])
