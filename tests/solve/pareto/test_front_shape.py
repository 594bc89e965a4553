"""The shape of a front, and which front lies lowest where, against points and crossings worked out by hand."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tvimdesign.solve.pareto import front_shape as shape
from tvimdesign.solve.pareto.front_shape import Frame, leads, reached

QUARTER = np.array([[1.0 - np.sin(a), 1.0 - np.cos(a)] for a in np.linspace(0.0, np.pi / 2.0, 9)])
"""A quarter circle that bulges towards the origin: its knee is half-way, at 45 degrees."""


@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5), st.integers(0, 5)), min_size=1, max_size=8))
def test_kept_points_are_those_no_other_is_better_than(rows):
    front = [rows[i] for i in shape.efficient(np.array(rows, dtype=float))]
    assert len(set(front)) == len(front)
    for row in rows:
        beaten = any(o != row and all(x <= y for x, y in zip(o, row, strict=True)) for o in rows)
        assert (row in front) == (not beaten)


def test_knees_lie_half_way_or_nowhere():
    assert shape.knee(QUARTER) == 4
    ends = np.array([[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]])
    inside = 1.0 - np.array([[0.8, 0.6, 0.0], [1.0, 1.0, 1.0] / np.sqrt(3.0), [0.0, 0.6, 0.8]])
    assert shape.knee(np.vstack([ends, inside])) == 4
    assert shape.knee(np.array([[0.0, 1.0], [0.4, 0.6], [1.0, 0.0]])) is None
    # The plane through the ends has the normal (0.36, 0.2, 0.2); the fifth point has the smallest sum, the fourth lies
    # 0.144 below the plane in that measure, the fifth 0.088.
    ends = [[0.0, 1.0, 1.0], [1.0, 0.0, 0.2], [1.0, 0.2, 0.0]]
    assert shape.knee(np.array([*ends, [0.1, 0.5, 0.6], [0.7, 0.15, 0.15]])) == 3


@pytest.mark.parametrize(("second", "little"), [([1.0, 1.02], [1]), ([1.0, 1.05], []), ([-1.02, -1.0], [1])])
def test_an_output_that_spans_less_than_three_hundredths_is_hardly_traded(second, little):
    assert shape.little_traded(np.array([[1.0, 2.0], second]).T) == little


def test_spread_is_the_largest_gap_over_the_mean_one_and_lines_are_thin():
    points = np.array([[0.0, 0.0], [4.0, 0.0], [1.0, 0.0], [2.0, 0.0]])  # gaps 1, 1, 2
    assert shape.spread(points) == pytest.approx(1.5)
    assert shape.spread(points[::-1]) == pytest.approx(1.5)
    line = np.outer([0.0, 0.4, 1.0], [1.0, -0.5, -0.5])
    assert shape.thin(line)
    assert not shape.thin(np.array([[-2.0, 1.0, 1.0], [1.0, -2.0, 1.0], [1.0, 1.0, -2.0]]))
    assert shape.little_traded(np.array([[1.0, 2.0]])) == []


def test_every_output_falls_alike_along_the_line_through_a_place():
    names, reference = ("a", "b", "c"), {"a": 2.0, "b": 30.0, "c": 0.4}
    ends = [{"a": 1.0, "b": 50.0, "c": 0.6}, {"a": 3.0, "b": 10.0, "c": 0.5}, {"a": 2.0, "b": 40.0, "c": 0.1}]
    frame = Frame.of(names, ends)
    for end in ends:
        for bound in frame.bounds(frame.place(end), reference):
            assert bound.residual(end) == pytest.approx(0.0, abs=1e-12)
            lower = {name: end[name] - 0.3 * size for name, size in zip(names, frame.ranges, strict=True)}
            assert bound.residual(lower) == pytest.approx(0.0, abs=1e-12)
            name = next(output for output in names[1:] if output in bound.factors)
            assert bound.residual({**end, name: 1.01 * end[name]}) > 0.0


def test_weights_of_neighbours_make_up_the_target():
    places = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0]])
    weights = shape.affine(places, np.array([0.3, 0.5, -0.8]))
    assert weights == pytest.approx([0.2, 0.3, 0.5])
    assert shape.affine(places[:1], places[1]) == pytest.approx([1.0])


def test_candidates_lie_in_the_hull_of_the_ends_and_reach_its_corners():
    ends = np.array([[-2.0, 1.0, 1.0], [1.0, -2.0, 1.0], [1.0, 1.0, -2.0], [-0.2, 0.1, 0.1]]) / 3.0
    places = shape.candidates(ends)
    assert places.sum(axis=1) == pytest.approx(np.zeros(len(places)), abs=1e-12)
    assert (places <= 1.0 / 3.0 + 1e-9).all()
    for end in ends[:3]:
        assert np.linalg.norm(places - end, axis=1).min() < 1e-12
    # A circle within the triangle is no further from a place than half a step.
    assert shape.farthest(places, places[:1])[1] == pytest.approx(np.linalg.norm(ends[0] - ends[1]), rel=1e-9)


@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=6, max_size=12, unique=True))
def test_the_corners_of_a_hull_turn_left_around_all_points(points):
    places = np.array(points, dtype=float)
    assume(np.linalg.matrix_rank(places - places[0]) == 2)
    corners = np.array(shape._corners(places))
    assert tuple(corners[0]) == min(points)
    sides, ways = np.roll(corners, -1, axis=0) - corners, places[:, None] - corners
    assert (sides[:, 0] * ways[..., 1] - sides[:, 1] * ways[..., 0] >= 0.0).all()
    assert len(np.unique(corners, axis=0)) == len(corners)


FALLING = [(1.0, 10.0), (5.0, 2.0)]  # y = 12 - 2 x
FLAT = [(2.0, 5.0), (6.0, 4.0)]  # y = 5.5 - x / 4


def test_two_lines_cross_where_their_equations_say():
    ranges = leads({"falling": FALLING, "flat": FLAT})
    # 12 - 2 x = 5.5 - x / 4 at x = 26/7; below 2 only one has anything.
    assert [(lead.best, lead.alone) for lead in ranges] == [("falling", True), ("flat", False), ("falling", False)]
    assert ranges[0].lower == 1.0
    assert ranges[0].upper == 2.0
    assert ranges[1].upper == pytest.approx(26.0 / 7.0)
    assert math.isinf(ranges[2].upper)
    # At x = 2 the one has 8, the other 5; from 6 on 2 against 4.
    assert ranges[1].most == pytest.approx(8.0 / 5.0)
    assert ranges[1].least == pytest.approx(1.0)
    assert ranges[2].most == pytest.approx(4.25 / 2.0)


def test_fronts_lead_from_their_first_point_on():
    assert reached(FALLING, 0.99) == math.inf
    assert reached(FALLING, 3.0) == pytest.approx(6.0)
    assert reached(FALLING, 50.0) == 2.0
    ranges = leads({"one": FALLING, "other": list(reversed(FALLING))})
    assert [lead.best for lead in ranges] == [None]
    ranges = leads({"falling": FALLING, "flat": FLAT, "low": [(3.0, 1.0)]})
    assert [lead.best for lead in ranges] == ["falling", "flat", "low"]
    assert ranges[2].least == pytest.approx(2.0)  # against the next best, which ends at 2
    ranges = leads({"point": [(2.0, 3.0)]})
    assert [(lead.lower, lead.upper, lead.best, lead.alone) for lead in ranges] == [(2.0, math.inf, "point", True)]


CURVES = st.lists(st.tuples(st.floats(1.0, 9.0), st.floats(1.0, 9.0)), min_size=1, max_size=5, unique_by=lambda p: p[0])


def _front(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points made a front: rising limits, falling values."""
    return list(zip(sorted(x for x, _ in points), sorted((y for _, y in points), reverse=True), strict=True))


@given(CURVES, CURVES, st.floats(1.0, 12.0))
def test_the_leader_at_a_limit_is_the_front_with_less_there(first, other, limit):
    curves = {"one": _front(first), "other": _front(other)}
    here = [lead for lead in leads(curves) if lead.lower <= limit < lead.upper]
    values = {label: reached(curve, limit) for label, curve in curves.items()}
    if not here:
        assert all(math.isinf(value) for value in values.values())
        return
    assert len(here) == 1
    if here[0].best is not None and abs(limit - here[0].lower) > 1e-9:
        assert values[here[0].best] <= min(values.values()) * (1.0 + 4e-3)


@given(CURVES, CURVES)
def test_ranges_join_without_gaps_and_do_not_depend_on_the_order(first, other):
    ranges = leads({"one": _front(first), "other": _front(other)})
    assert math.isinf(ranges[-1].upper)
    assert all(a.upper == b.lower for a, b in itertools.pairwise(ranges))
    turned = leads({"other": _front(other), "one": _front(first)})
    assert [lead.best for lead in turned] == [lead.best for lead in ranges]
    assert [lead.lower for lead in turned] == pytest.approx([lead.lower for lead in ranges])
