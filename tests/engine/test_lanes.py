"""Many designs side by side: functions to their last digits, factors without pivots, steps in time and events."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tvimdesign.engine import lane_events, lanes, vectors
from tvimdesign.engine.integrator import Motion
from tvimdesign.engine.sparse_lu import Pattern, factor, pattern_of, solve, solve_many
from tvimdesign.engine.tape import Tape
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.solve.batch.batch_model import Kernel

Array = np.ndarray
COUNT = 21


def _columns(function: Callable[[object], object], places: Array) -> Array:
    x = ca.SX.sym("x")
    return Kernel(Tape.of([x], [function(x)]))(places[None])[0]


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [("exp", -708.0, 709.0), ("exp", -1.0, 1.0), ("log", 1e-300, 1e300), ("log", 0.5, 2.0), ("log1p", -0.9, 3.0)],
)
def test_functions_are_right_over_their_whole_range(name, low, high):
    random = np.random.default_rng(1)
    places = random.uniform(low, high, 20_000) if high < 1e3 else 10.0 ** random.uniform(-300.0, 300.0, 20_000)
    exact = getattr(np, name)(places.astype(np.longdouble))
    assert np.max(np.abs(_columns(getattr(ca, name), places) / exact - 1.0)) < 1e-15


def test_powers_are_right_where_their_logarithms_are_small():
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    given = np.random.default_rng(2).uniform(0.2, 4.0, (2, 5_000))
    powers = Kernel(Tape.of([x, y], [x**y]))(given)[0]
    assert np.max(np.abs(powers / given[0].astype(np.longdouble) ** given[1] - 1.0)) < 3e-15


def test_quotients_that_share_a_divisor_may_be_products():
    x = ca.SX.sym("x", 3)
    results = [ca.vertcat(x[0] / x[2], x[1] / x[2], x[0] / x[1]), x[2]]
    plain, inverses = Tape.of([x], results), Tape.of([x], results, inverses=True)
    given = np.array([3.0, 7.0, 11.0])
    for quotient, other in zip(plain.values(given), inverses.values(given), strict=True):
        assert quotient == pytest.approx(other, rel=1e-15)
    assert inverses.code.to.size == plain.code.to.size + 1


def test_elimination_solves_what_numpy_solves():
    # An arrow about a chain, as the heat equation has it.
    random = np.random.default_rng(3)
    matrix = np.diag(random.uniform(4.0, 5.0, 8)) + np.diag(random.uniform(-1, 1, 7), 1) + np.diag(np.ones(7), -1)
    matrix[7, :], matrix[:, 7] = random.uniform(-1, 1, 8), random.uniform(-1, 1, 8)
    matrix[7, 7] = 4.0
    rows, columns = (part.astype(np.int64) for part in np.nonzero(matrix))
    pattern, entries, _ = pattern_of(8, rows, columns)
    right = random.uniform(-1, 1, 8)
    w = vectors.registers(pattern.size + 8)
    w[entries] = matrix[rows, columns][:, None]
    w[pattern.size :] = right[pattern.order][:, None] * np.arange(1.0, vectors.LANES + 1.0)
    lanes.factor(pattern, w, 0)
    lanes.solve(pattern, w, 0, pattern.size)
    for j in range(vectors.LANES):
        assert w[pattern.size :, j] == pytest.approx(
            (j + 1.0) * np.linalg.solve(matrix, right)[pattern.order], rel=1e-12
        )


@pytest.fixture(scope="module")
def cooling() -> tuple[Motion, Tape]:
    """Return a body that cools at a rate of its own, one that follows it without mass, and the first's integral."""
    y, u, k = ca.SX.sym("y", 3), ca.SX.sym("u"), ca.SX.sym("k")
    rates = ca.vertcat(u - k * y[0], y[0] ** 2 - y[1], y[0])
    return Motion.of(y, u, k, rates, ca.jacobian(rates, y), np.array([1.0, 0.0, 1.0])), Tape.of([y, u, k], [0.5 - y[0]])


def _marched(motion: Motion, rates: Array, steps: int, scales: Array) -> tuple[Array, lanes.Room, Array]:
    room, states = lanes.Room(motion), np.zeros((steps + 1, 3, len(rates)))
    states[0, 0] = 1.0
    given = np.array([np.zeros(len(rates)), rates])
    lengths = np.full(steps, 1.0 / steps)
    busy = np.ones(len(rates), dtype=bool)
    lanes.march(motion.system, room.slopes, np.array([3, 4]), given, states, lengths, scales, 0, steps, busy)
    return states, room, given


def test_steps_are_of_second_order_each_as_long_as_asked(cooling):
    rates, scales = np.linspace(0.5, 3.0, COUNT), np.linspace(0.4, 1.2, COUNT)
    errors = []
    for steps in (20, 40):
        states, _, _ = _marched(cooling[0], rates, steps, scales)
        exact = np.exp(-rates * scales)
        assert states[-1, 1] == pytest.approx(exact**2, rel=2e-2)
        assert states[-1, 2] == pytest.approx((1.0 - exact) / rates, rel=1e-3)
        errors.append(np.max(np.abs(states[-1, 0] / exact - 1.0)))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_what_is_passed_is_found_where_it_is(cooling):
    motion, gap = cooling
    rates, steps, scales = np.linspace(0.5, 3.0, COUNT), 40, np.ones(COUNT)
    states, room, given = _marched(motion, rates, steps, scales)
    w, where = lanes.lanes_of(gap), (np.array([3, 4]), given)
    low, high = np.full(COUNT, -1), np.full(COUNT, lane_events.NOWHERE)
    below, above = np.full(COUNT, np.nan), np.full(COUNT, np.nan)
    result = int(gap.results[0][0])
    lane_events.search(gap.code, w, result, *where, states, 3, steps, 20, low, high, below, above)
    passed = rates > math.log(2.0)
    assert np.array_equal(high != lane_events.NOWHERE, passed)
    assert np.all(high[passed] == np.ceil(steps * math.log(2.0) / rates[passed]))
    shares, ends = np.zeros(COUNT), np.full((3, COUNT), np.nan)
    lengths = np.full(steps, 1.0 / steps)
    lane_events.cross(
        motion.system, room.slopes, room.rates, *where, states, lengths, scales, gap.code, w, result, *where, 3, passed,
        low, below, above, shares, ends,
    )  # fmt: skip
    times = (low + shares)[passed] / steps
    assert times == pytest.approx(math.log(2.0) / rates[passed], rel=1e-3)
    assert ends[0, passed] == pytest.approx(0.5, rel=1e-4)
    assert np.all(np.isnan(ends[:, ~passed]))


def test_what_stays_is_found_with_its_current(cooling):
    motion, gap = cooling
    rates = np.linspace(0.5, 3.0, COUNT)
    room, w, where = (lanes.Room(motion), lanes.lanes_of(gap), (np.array([3, 4]), np.array([np.zeros(COUNT), rates])))
    settled, currents, exists = np.zeros((2, COUNT)), np.ones(COUNT), np.zeros(COUNT, dtype=bool)
    lane_events.settle(
        motion.system, room.slopes, room.rates, *where, gap.code, w, int(gap.results[0][0]), *where, 3, settled,
        currents, exists,
    )  # fmt: skip
    assert exists.all()
    assert settled == pytest.approx(np.repeat([[0.5], [0.25]], COUNT, axis=1))
    assert currents == pytest.approx(0.5 * rates)


class Case(NamedTuple):
    matrix: Array
    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    """Of the entries that are given; their values lie in the matrix, and so do those of the diagonal."""


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """Return a random pattern, often without parts of its diagonal, with values that need no pivots."""
    size = draw(st.integers(1, 14))
    share, seed = draw(st.sampled_from([0.0, 0.1, 0.3, 1.0])), draw(st.integers(0, 2**32 - 1))
    generator = np.random.default_rng(seed)
    hit = generator.random((size, size)) < share
    matrix = np.where(hit, generator.uniform(-1.0, 1.0, (size, size)), 0.0)
    matrix[np.diag_indices(size)] = generator.choice([-1.0, 1.0], size) * (1.0 + np.abs(matrix).sum(axis=1))
    rows, columns = np.nonzero(hit)
    return Case(matrix, rows.astype(np.int64), columns.astype(np.int64))


def factored(case: Case) -> tuple[Pattern, Array]:
    pattern, entries, diagonal = pattern_of(len(case.matrix), case.rows, case.columns)
    w = np.zeros(pattern.size)
    on = case.rows == case.columns
    w[entries[~on]] = case.matrix[case.rows[~on], case.columns[~on]]
    w[diagonal] = np.diagonal(case.matrix)
    factor(pattern, w)
    return pattern, w


@given(case=cases())
def test_one_compiled_program_takes_every_pattern(case):
    usual, _, _ = pattern_of(2, np.array([0]), np.array([1]))
    pattern, _, _ = pattern_of(len(case.matrix), case.rows, case.columns)
    assert numba.typeof(pattern) == numba.typeof(usual)


@given(case=cases(), lanes=st.integers(0, 5), seed=st.integers(0, 2**32 - 1))
def test_solutions_are_numpys(case, lanes, seed):
    pattern, w = factored(case)
    right = np.random.default_rng(seed).uniform(-3.0, 3.0, (len(case.matrix), lanes + 1))
    expected = np.linalg.solve(case.matrix, right)
    many, single = right[pattern.order].copy(), right[pattern.order, 0].copy()
    solve_many(pattern, w, many)
    solve(pattern, w, single)
    solution = np.empty_like(many)
    solution[pattern.order] = many
    assert solution == pytest.approx(expected, rel=1e-10, abs=1e-12)
    assert single == pytest.approx(many[:, 0], rel=1e-12, abs=1e-14)


def test_arrows_and_chains_are_eliminated_without_fill_in():
    size = 30
    tips = np.arange(1, size)
    nothing = np.zeros(size - 1, np.int64)
    pattern, *_ = pattern_of(size, np.append(tips, nothing), np.append(nothing, tips))
    assert pattern.size == 3 * size - 2
    assert pattern.order[0] != 0
    size = 40
    low = np.arange(size - 1)
    pattern, *_ = pattern_of(size, np.append(low, low + 1), np.append(low + 1, low))
    assert pattern.size == 3 * size - 2


def test_a_matrix_without_a_pivot_gives_no_number():
    pattern, entries, diagonal = pattern_of(2, np.array([0, 1]), np.array([1, 0]))
    w = np.zeros(pattern.size)
    w[entries] = 1.0
    assert not w[diagonal].any()
    factor(pattern, w)
    right = np.ones(2)
    solve(pattern, w, right)
    assert not np.all(np.isfinite(right))
