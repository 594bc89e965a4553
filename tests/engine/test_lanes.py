"""Many designs side by side: functions to their last digits, linear systems, steps in time and what they pass."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from tvimdesign.engine import lane_events, lanes, vectors
from tvimdesign.engine.integrator import Motion
from tvimdesign.engine.sparse_lu import pattern_of
from tvimdesign.engine.tape import Tape
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.solve.batch.batch_model import Kernel

Array = np.ndarray
COUNT = 21


def _columns(function: Callable[[object], object], places: Array) -> Array:
    x = ca.SX.sym("x")
    return Kernel(ca.Function("f", [x], [function(x)]))(places[None])[0]


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [("exp", -708.0, 709.0), ("exp", -1.0, 1.0), ("log", 1e-300, 1e300), ("log", 0.5, 2.0), ("log1p", -0.9, 3.0)],
)
def test_functions_are_right_over_their_whole_range(name: str, low: float, high: float) -> None:
    random = np.random.default_rng(1)
    places = random.uniform(low, high, 20_000) if high < 1e3 else 10.0 ** random.uniform(-300.0, 300.0, 20_000)
    exact = getattr(np, name)(places.astype(np.longdouble))
    assert np.max(np.abs(_columns(getattr(ca, name), places) / exact - 1.0)) < 1e-15


def test_powers_are_right_where_their_logarithms_are_small() -> None:
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    given = np.random.default_rng(2).uniform(0.2, 4.0, (2, 5_000))
    found = Kernel(ca.Function("f", [x, y], [x**y]))(given)[0]
    assert np.max(np.abs(found / given[0].astype(np.longdouble) ** given[1] - 1.0)) < 3e-15


def test_quotients_that_share_a_divisor_may_be_products() -> None:
    x = ca.SX.sym("x", 3)
    results = [ca.vertcat(x[0] / x[2], x[1] / x[2], x[0] / x[1]), x[2]]
    plain, inverses = Tape.of([x], results), Tape.of([x], results, inverses=True)
    given = np.array([3.0, 7.0, 11.0])
    for one, other in zip(plain.values(given), inverses.values(given), strict=True):
        assert one == pytest.approx(other, rel=1e-15)
    assert inverses.code.to.size == plain.code.to.size + 1


def test_elimination_solves_what_numpy_solves() -> None:
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
    return Motion(y, u, k, rates, ca.jacobian(rates, y), np.array([1.0, 0.0, 1.0])), Tape.of([y, u, k], [0.5 - y[0]])


def _marched(motion: Motion, rates: Array, steps: int, scales: Array) -> tuple[Array, lanes.Room, Array]:
    room, states = lanes.Room(motion), np.zeros((steps + 1, 3, len(rates)))
    states[0, 0] = 1.0
    given = np.array([np.zeros(len(rates)), rates])
    lengths = np.full(steps, 1.0 / steps)
    busy = np.ones(len(rates), dtype=bool)
    lanes.march(motion.system, room.slopes, np.array([3, 4]), given, states, lengths, scales, 0, steps, busy)
    return states, room, given


def test_steps_are_of_second_order_each_as_long_as_asked(cooling: tuple[Motion, Tape]) -> None:
    rates, scales = np.linspace(0.5, 3.0, COUNT), np.linspace(0.4, 1.2, COUNT)
    errors = []
    for steps in (20, 40):
        states, _, _ = _marched(cooling[0], rates, steps, scales)
        exact = np.exp(-rates * scales)
        assert states[-1, 1] == pytest.approx(exact**2, rel=2e-2)
        assert states[-1, 2] == pytest.approx((1.0 - exact) / rates, rel=1e-3)
        errors.append(np.max(np.abs(states[-1, 0] / exact - 1.0)))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_what_is_passed_is_found_where_it_is(cooling: tuple[Motion, Tape]) -> None:
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


def test_what_stays_is_found_with_its_current(cooling: tuple[Motion, Tape]) -> None:
    motion, gap = cooling
    rates = np.linspace(0.5, 3.0, COUNT)
    room, w, where = (
        lanes.Room(motion),
        lanes.lanes_of(gap),
        (np.array([3, 4]), np.array([np.zeros(COUNT), rates])),
    )
    rest, currents, exists = np.zeros((2, COUNT)), np.ones(COUNT), np.zeros(COUNT, dtype=bool)
    lane_events.settle(
        motion.system, room.slopes, room.rates, *where, gap.code, w, int(gap.results[0][0]), *where, 3, rest, currents,
        exists,
    )  # fmt: skip
    assert exists.all()
    assert rest == pytest.approx(np.repeat([[0.5], [0.25]], COUNT, axis=1))
    assert currents == pytest.approx(0.5 * rates)
