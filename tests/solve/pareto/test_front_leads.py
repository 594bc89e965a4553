"""Which front lies lowest where: against crossings worked out by hand."""

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tvimdesign.solve.pareto.front_shape import leads, reached

FALLING = [(1.0, 10.0), (5.0, 2.0)]  # y = 12 - 2 x
FLAT = [(2.0, 5.0), (6.0, 4.0)]  # y = 5.5 - x / 4


def test_two_lines_cross_where_their_equations_say() -> None:
    found = leads({"falling": FALLING, "flat": FLAT})
    # 12 - 2 x = 5.5 - x / 4 at x = 26/7; below 2 only one has anything.
    assert [(lead.best, lead.alone) for lead in found] == [("falling", True), ("flat", False), ("falling", False)]
    assert found[0].lower == 1.0
    assert found[0].upper == 2.0
    assert found[1].upper == pytest.approx(26.0 / 7.0)
    assert math.isinf(found[2].upper)
    # At x = 2 the one has 8, the other 5; from 6 on 2 against 4.
    assert found[1].most == pytest.approx(8.0 / 5.0)
    assert found[1].least == pytest.approx(1.0)
    assert found[2].most == pytest.approx(4.25 / 2.0)


def test_fronts_lead_from_their_first_point_on() -> None:
    assert reached(FALLING, 0.99) == math.inf
    assert reached(FALLING, 3.0) == pytest.approx(6.0)
    assert reached(FALLING, 50.0) == 2.0
    found = leads({"one": FALLING, "other": list(reversed(FALLING))})
    assert [lead.best for lead in found] == [None]
    found = leads({"falling": FALLING, "flat": FLAT, "low": [(3.0, 1.0)]})
    assert [lead.best for lead in found] == ["falling", "flat", "low"]
    assert found[2].least == pytest.approx(2.0)  # against the next best, which ends at 2
    found = leads({"point": [(2.0, 3.0)]})
    assert [(lead.lower, lead.upper, lead.best, lead.alone) for lead in found] == [(2.0, math.inf, "point", True)]


CURVES = st.lists(st.tuples(st.floats(1.0, 9.0), st.floats(1.0, 9.0)), min_size=1, max_size=5, unique_by=lambda p: p[0])


def _front(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points made a front: rising limits, falling values."""
    return list(zip(sorted(x for x, _ in points), sorted((y for _, y in points), reverse=True), strict=True))


@given(CURVES, CURVES, st.floats(1.0, 12.0))
def test_who_is_said_to_lead_at_a_limit_is_who_has_less_there(
    one: list[tuple[float, float]], other: list[tuple[float, float]], limit: float
) -> None:
    curves = {"one": _front(one), "other": _front(other)}
    here = [lead for lead in leads(curves) if lead.lower <= limit < lead.upper]
    values = {label: reached(curve, limit) for label, curve in curves.items()}
    if not here:
        assert all(math.isinf(value) for value in values.values())
        return
    assert len(here) == 1
    if here[0].best is not None and abs(limit - here[0].lower) > 1e-9:
        assert values[here[0].best] <= min(values.values()) * (1.0 + 4e-3)


@given(CURVES, CURVES)
def test_ranges_join_without_gaps_and_do_not_depend_on_the_order(
    one: list[tuple[float, float]], other: list[tuple[float, float]]
) -> None:
    found = leads({"one": _front(one), "other": _front(other)})
    assert math.isinf(found[-1].upper)
    assert all(a.upper == b.lower for a, b in itertools.pairwise(found))
    turned = leads({"other": _front(other), "one": _front(one)})
    assert [lead.best for lead in turned] == [lead.best for lead in found]
    assert [lead.lower for lead in turned] == pytest.approx([lead.lower for lead in found])
