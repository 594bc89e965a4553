"""Interval arithmetic: it contains what floats give and what is exact, and no more where there is a closed form."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tvimdesign.solve.infeasibility.enclosure import Walk
from tvimdesign.solve.infeasibility.interval import Interval

from tvimdesign.simulation.casadi_setup import ca
from tvimdesign.solve.infeasibility import interval

NUMBERS = st.floats(-30.0, 30.0)
SHARES = st.floats(0.0, 1.0)
OF_ONE: dict[str, Callable[..., object]] = {
    "square": lambda x: x**2, "inverse": lambda x: 1.0 / x, "root": ca.sqrt, "exponential": ca.exp, "logarithm": ca.log,
    "log1p": ca.log1p, "sine": ca.sin, "cosine": ca.cos, "arcsine": ca.asin, "arctangent": ca.atan, "size": ca.fabs,
    "power": lambda x: x**-0.146, "sign": ca.sign, "floor": ca.floor,
}  # fmt: skip
OF_TWO: dict[str, Callable[..., object]] = {
    "sum": lambda x, y: x + y, "difference": lambda x, y: x - y, "product": lambda x, y: x * y,
    "quotient": lambda x, y: x / y, "power": lambda x, y: x**y, "least": ca.fmin, "largest": ca.fmax,
    "arctangent": ca.atan2, "order": lambda x, y: x <= y, "least of a root": lambda x, y: ca.fmin(ca.sqrt(x), y),
    "not in order": lambda x, y: ca.logic_not(x <= y),
    "the other of a root": lambda x, y: ca.fmax(x, ca.sqrt(y)),
}  # fmt: skip


def _box(ends: tuple[float, float]) -> Interval:
    low, high = min(ends), max(ends)
    return Interval(np.array([low]), np.array([high]), np.array([True]))


def _holds(function: Callable[..., object], ends: list[tuple[float, float]], shares: list[float]) -> None:
    """What CasADi gives at a point of the box lies within what the walk gives for the box."""
    symbols = [ca.SX.sym(f"x{i}") for i in range(len(ends))]
    compiled = ca.Function("f", [ca.vertcat(*symbols)], [function(*symbols)])
    boxes = [_box(pair) for pair in ends]
    inside = [
        float(np.clip(box.low[0] + share * (box.high[0] - box.low[0]), box.low[0], box.high[0]))
        for box, share in zip(boxes, shares, strict=True)
    ]
    value = float(compiled(inside))
    found = Walk(compiled)(boxes)[0]
    if np.isnan(value):
        assert not found.whole[0]
    else:
        assert found.low[0] <= value <= found.high[0]


@pytest.mark.parametrize("name", OF_ONE)
@settings(max_examples=40)
@given(ends=st.tuples(NUMBERS, NUMBERS), share=SHARES)
def test_a_function_of_a_point_lies_within_the_function_of_its_interval(
    name: str, ends: tuple[float, float], share: float
) -> None:
    _holds(OF_ONE[name], [ends], [share])


@pytest.mark.parametrize("name", OF_TWO)
@settings(max_examples=40)
@given(first=st.tuples(NUMBERS, NUMBERS), second=st.tuples(NUMBERS, NUMBERS), shares=st.tuples(SHARES, SHARES))
def test_an_operation_on_points_lies_within_the_operation_on_their_intervals(
    name: str, first: tuple[float, float], second: tuple[float, float], shares: tuple[float, float]
) -> None:
    _holds(OF_TWO[name], [first, second], list(shares))


def test_a_sum_contains_the_exact_one_that_floats_miss() -> None:
    found = interval.add(interval.point(0.1), interval.point(0.2))
    exact = Fraction(0.1) + Fraction(0.2)
    assert Fraction(0.1 + 0.2) != exact
    assert Fraction(float(found.low[0])) < exact < Fraction(float(found.high[0]))


@pytest.mark.parametrize(
    ("found", "low", "high"),
    [
        (interval.multiply(_box((-1.0, 2.0)), _box((-3.0, 4.0))), -6.0, 8.0),
        (interval.divide(_box((1.0, 2.0)), _box((-4.0, -2.0))), -1.0, -0.25),
        (interval.square(_box((-3.0, 2.0))), 0.0, 9.0),
        (interval.cosine(_box((3.0, 7.0))), -1.0, 1.0),
        (interval.cosine(_box((0.5, 1.0))), np.cos(1.0), np.cos(0.5)),
        (interval.sine(_box((0.1, 2.0))), np.sin(0.1), 1.0),
        (interval.cosine(_box((7.0, 12.0))), -1.0, np.cos(12.0)),  # with three half turns within, and no whole one
        (interval.cosine(_box((-12.0, -10.0))), np.cos(10.0), np.cos(12.0)),
        (interval.size(_box((-3.0, -1.0))), 1.0, 3.0),
        (interval.size(_box((1.0, 3.0))), 1.0, 3.0),
        (interval.size(_box((-3.0, 2.0))), 0.0, 3.0),
        (interval.negation(_box((0.0, 0.0))), 1.0, 1.0),
        (interval.negation(_box((1.0, 1.0))), 0.0, 0.0),
        (interval.negation(_box((0.0, 1.0))), 0.0, 1.0),
        (interval.at_most(_box((1.0, 2.0)), _box((2.0, 3.0))), 1.0, 1.0),
        (interval.at_most(_box((1.0, 4.0)), _box((2.0, 3.0))), 0.0, 1.0),
        (interval.at_most(_box((4.0, 5.0)), _box((2.0, 3.0))), 0.0, 0.0),
        (interval.sign(_box((1.0, 2.0))), 1.0, 1.0),
        (interval.sign(_box((-2.0, 1.0))), -1.0, 1.0),
        (interval.least(_box((1.0, 5.0)), _box((2.0, 3.0))), 1.0, 3.0),
        (interval.largest(_box((1.0, 5.0)), _box((2.0, 3.0))), 2.0, 5.0),
        (interval.power(_box((2.0, 3.0)), interval.point(-2.0)), 1.0 / 9.0, 0.25),
    ],
)
def test_ends_are_those_of_the_closed_form(found: Interval, low: float, high: float) -> None:
    assert found.low[0] == pytest.approx(low, rel=1e-14, abs=1e-300)
    assert found.high[0] == pytest.approx(high, rel=1e-14)
    assert found.whole[0]
    assert found.low[0] <= low
    assert found.high[0] >= high


def test_nothing_is_claimed_across_a_pole_or_of_an_operation_without_a_rule() -> None:
    across = interval.inverse(_box((-1.0, 1.0)))
    assert (across.low[0], across.high[0], across.whole[0]) == (-np.inf, np.inf, False)
    x = ca.SX.sym("x")
    unknown = Walk(ca.Function("f", [x], [ca.erf(x)]))([_box((0.0, 1.0))])[0]
    assert (unknown.low[0], unknown.high[0], unknown.whole[0]) == (-np.inf, np.inf, False)
