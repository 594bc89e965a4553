"""Steps of an equation of motion against closed solutions: order, algebraic rows, sensitivities, errors."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import expm

from tvimdesign.engine.integrator import STAGES, TABLEAU, TIMES, Motion, adapted, advance, step, step_error

Array = NDArray[np.float64]
NONE = np.zeros(0)
MATRIX = np.array([[-3.0, 1.0, 0.0], [0.5, -1.0, 0.4], [0.0, 2.0, -40.0]])
DRIVEN = np.array([1.0, 0.0, 2.0])


def motion_of(write: Callable[[Any, Any, Any], Any], size: int, constants: int, mass: Array | None = None) -> Motion:
    y, u, k = ca.SX.sym("y", size), ca.SX.sym("u"), ca.SX.sym("k", constants)
    rates = write(y, u, k)
    return Motion.of(y, u, k, rates, ca.jacobian(rates, y), np.ones(size) if mass is None else mass)


@pytest.fixture(scope="module")
def linear() -> Motion:
    """`dy/dt = A y + b u + k`."""
    return motion_of(lambda y, u, k: ca.mtimes(ca.sparsify(ca.DM(MATRIX)), y) + ca.DM(DRIVEN) * u + k, 3, 3)


@pytest.fixture(scope="module")
def algebraic() -> Motion:
    """`2 da/dt = -2 b`, `0 = b - k a^2`: so a is 1/(1/a0 + k t)."""
    return motion_of(lambda y, _, k: ca.vertcat(-2.0 * y[1], y[1] - k[0] * y[0] ** 2), 2, 1, np.array([2.0, 0.0]))


@pytest.fixture(scope="module")
def pendulum() -> Motion:
    """Return a damped and driven pendulum, nonlinear in everything."""
    return motion_of(lambda y, u, k: ca.vertcat(y[1], -k[0] * ca.sin(y[0]) - k[1] * y[1] ** 3 + u * y[0] ** 2), 2, 2)


def stepped(
    motion: Motion, y: Array, lengths: Array, k: Array, current: Callable[[Array], Array] = np.zeros_like
) -> Array:
    """Return the state after steps of given lengths."""
    return with_slopes(motion, y, np.zeros((y.size, 0)), lengths, k, np.zeros((k.size, 0)), current)[0]


def with_slopes(
    motion: Motion, y: Array, s: Array, lengths: Array, k: Array, dk: Array,
    current: Callable[[Array], Array] = np.zeros_like, of_current: Array | None = None, of_lengths: Array | None = None,
) -> tuple[Array, Array]:  # fmt: skip
    """Return the state after steps of given lengths, and its sensitivities; every current is moved by `of_current`."""
    lanes, count = s.shape[1], len(lengths)
    starts = np.append(0.0, np.cumsum(lengths)[:-1])
    u = current(starts[:, None] + TIMES * lengths[:, None])
    du = np.zeros((count, STAGES, lanes)) + (0.0 if of_current is None else of_current)
    states, tangents = np.empty((count + 1, y.size)), np.empty((count + 1, y.size, lanes))
    states[0], tangents[0] = y, s
    of_lengths = np.zeros((count, lanes)) if of_lengths is None else of_lengths
    last = advance(
        motion.system, *motion.registers(k, dk), states, tangents, 0, lengths, of_lengths, u, du, np.zeros(y.size)
    )
    assert last == count
    return states[-1], tangents[-1]


def order_of(errors: list[float]) -> list[float]:
    return [float(np.log2(error / other)) for error, other in pairwise(errors)]


def test_the_coefficients_keep_the_conditions_of_third_order():
    weights = TABLEAU[-1]
    assert weights.sum() == pytest.approx(1.0, abs=1e-14)
    assert weights @ TIMES == pytest.approx(1.0 / 2.0, abs=1e-14)
    assert weights @ TIMES**2 == pytest.approx(1.0 / 3.0, abs=1e-14)
    assert weights @ TABLEAU @ TIMES == pytest.approx(1.0 / 6.0, abs=1e-14)


def test_a_linear_system_is_solved_to_third_order(linear):
    k, y, end = np.array([0.3, -0.2, 1.0]), np.array([1.0, 2.0, -0.5]), 2.0
    still = -np.linalg.solve(MATRIX, k)
    expected = still + expm(MATRIX * end) @ (y - still)
    errors = [
        float(np.max(np.abs(stepped(linear, y, np.full(count, end / count), k) - expected))) for count in (64, 128, 256)
    ]
    assert errors[-1] < 1e-7
    assert order_of(errors) == pytest.approx([3.0, 3.0], abs=0.15)


def test_a_current_that_changes_in_time_leaves_third_order():
    # dy/dt = -2 y + u, u = sin(3 t): y = (2 sin 3t - 3 cos 3t + 3 exp(-2t)) / 13 from zero.
    motion, end = motion_of(lambda y, u, _: -2.0 * y + u, 1, 0), 1.7
    expected = (2.0 * np.sin(3.0 * end) - 3.0 * np.cos(3.0 * end) + 3.0 * np.exp(-2.0 * end)) / 13.0
    errors = [
        abs(stepped(motion, np.zeros(1), np.full(count, end / count), NONE, lambda t: np.sin(3.0 * t))[0] - expected)
        for count in (16, 32, 64)
    ]
    assert order_of(errors) == pytest.approx([3.0, 3.0], abs=0.15)


def test_a_row_without_mass_is_an_equation_and_keeps_third_order(algebraic):
    k, end, errors = np.array([0.8]), 3.0, []
    for count in (16, 32, 64):
        a, b = stepped(algebraic, np.array([2.0, 0.8 * 4.0]), np.full(count, end / count), k)
        assert b == pytest.approx(0.8 * a**2, rel=1e-9)
        errors.append(abs(a - 1.0 / (0.5 + 0.8 * end)))
    assert errors[-1] < 1e-5
    assert order_of(errors) == pytest.approx([3.0, 3.0], abs=0.35)


def test_an_algebraic_row_finds_its_value_from_anywhere_near(algebraic):
    lengths = np.full(32, 0.05)
    right, wrong = (stepped(algebraic, np.array([2.0, b]), lengths, np.array([0.8])) for b in (3.2, 2.5))
    assert wrong == pytest.approx(right, rel=1e-8)


def test_a_row_that_is_stiff_does_not_ring():
    motion = motion_of(lambda y, _, k: -k * (y - 1.0), 1, 1)
    assert stepped(motion, np.array([5.0]), np.ones(1), np.array([1e9])) == pytest.approx([1.0], abs=1e-7)


@given(seed=st.integers(0, 2**32 - 1))
def test_sensitivities_of_a_linear_system_are_those_of_its_solution(linear, seed):
    # The method is linear in start, constants and current: so its own slopes are its values from one of each.
    generator = np.random.default_rng(seed)
    s, dk, of_current = generator.normal(size=(3, 2)), generator.normal(size=(3, 2)), generator.normal(size=2)
    y, k, lengths = generator.normal(size=3), generator.normal(size=3), generator.uniform(0.01, 0.5, 6)
    state, slopes = with_slopes(linear, y, s, lengths, k, dk, np.cos, of_current)
    for j in range(2):
        alone = stepped(linear, s[:, j].copy(), lengths, dk[:, j].copy(), lambda t, j=j: np.full_like(t, of_current[j]))
        assert slopes[:, j] == pytest.approx(alone, rel=1e-9, abs=1e-11)
    assert state == pytest.approx(stepped(linear, y, lengths, k, np.cos), rel=1e-12)


def test_sensitivities_along_directions_are_differences_of_the_steps(pendulum):
    y, k, lengths = np.array([1.0, 0.2]), np.array([2.0, 0.1]), np.full(10, 0.13)
    along = {"y": np.array([[1.0, 0.0, 0.3], [0.0, 0.0, -1.0]]), "k": np.array([[0.0, 0.5, 1.0], [0.0, 1.0, 0.2]])}
    of_current = np.array([0.0, 0.7, -0.4])
    _, slopes = with_slopes(pendulum, y, along["y"], lengths, k, along["k"], np.cos, of_current)
    for j in range(3):

        def at(share: float, j: int = j) -> Array:
            return stepped(
                pendulum, y + share * along["y"][:, j], lengths, k + share * along["k"][:, j],
                lambda t: np.cos(t) + share * of_current[j],
            )  # fmt: skip

        # The factors are those that Newton's last iteration began with, up to 1e-5 from where it ended.
        assert slopes[:, j] == pytest.approx(differences(at), rel=1e-5, abs=1e-7)


def differences(function: Callable[[float], Array], by: float = 4e-3) -> Array:
    """Return the slope at zero by a stencil of fourth order."""
    far, near = function(2.0 * by) - function(-2.0 * by), function(by) - function(-by)
    return np.asarray((8.0 * near - far) / (12.0 * by))


def test_sensitivities_along_the_lengths_of_steps(pendulum):
    y, k, lengths = np.array([1.0, 0.2]), np.array([2.0, 0.1]), np.array([0.1, 0.3, 0.2, 0.15])
    of_lengths = np.array([[0.0, 0.1], [0.0, 0.3], [0.0, 0.2], [1.0, 0.15]])
    _, slopes = with_slopes(
        pendulum, y, np.zeros((2, 2)), lengths, k, np.zeros((2, 2)), np.zeros_like, None, of_lengths
    )
    for j in range(2):
        expected = differences(lambda share, j=j: stepped(pendulum, y, lengths + share * of_lengths[:, j], k))
        assert slopes[:, j] == pytest.approx(expected, rel=1e-6, abs=1e-7)


def one_error(motion: Motion, y: Array, h: float, k: Array) -> float:
    _, _, v = motion.registers(k, np.zeros((k.size, 0)))
    return float(step_error(motion.system, v, y.copy(), 0.0, 0.0, h, np.zeros(y.size)))


def test_a_step_s_error_falls_with_the_third_power_and_is_exact_below(pendulum):
    y, k = np.array([1.0, 0.2]), np.array([2.0, 0.1])
    errors = [one_error(pendulum, y, h, k) for h in (0.08, 0.04, 0.02)]
    assert order_of(errors) == pytest.approx([3.0, 3.0], abs=0.15)
    motion = motion_of(lambda _, u, k: k * u**2, 1, 1)
    _, _, v = motion.registers(np.ones(1), np.zeros((1, 0)))
    straight = step_error(motion.system, v, np.zeros(1), 2.0, 0.0, 0.5, np.zeros(1))
    bent = step_error(motion.system, v, np.zeros(1), 0.0, 1.0, 0.5, np.zeros(1))
    assert straight == pytest.approx(0.0, abs=1e-12)
    assert bent > 1e-3


def test_a_step_takes_the_length_its_error_allows_and_proposes_the_next(pendulum):
    k, tolerance = np.array([2.0, 0.1]), 1e-4
    _, _, v = pendulum.registers(k, np.zeros((2, 0)))
    for wished in (1e-3, 0.05, 3.0, 50.0):
        y, ahead = np.array([1.0, 0.2]), np.zeros(2)
        length, following = adapted(pendulum.system, v, y, 0.0, 0.0, wished, tolerance, ahead)
        assert 0.0 < length <= wished
        assert one_error(pendulum, np.array([1.0, 0.2]), length, k) <= tolerance
        assert (length == wished) == (one_error(pendulum, np.array([1.0, 0.2]), wished, k) <= tolerance)
        assert 0.2 * length <= following <= 2.5 * length
        assert y == pytest.approx(stepped(pendulum, np.array([1.0, 0.2]), np.array([length]), k), abs=1e-9)


def test_adapted_steps_come_as_near_to_a_solution_as_requested(linear):
    k, end, counts, errors = np.zeros(3), 2.0, [], []
    begin = np.array([1.0, 2.0, -0.5])
    expected = expm(MATRIX * end) @ begin
    _, _, v = linear.registers(k, np.zeros((3, 0)))
    for tolerance in (1e-3, 1e-4, 1e-5):
        y, ahead, time, h, count = begin.copy(), np.zeros(3), 0.0, 1e-2, 0
        while time < end:
            length, h = adapted(linear.system, v, y, 0.0, 0.0, min(h, end - time), tolerance, ahead)
            assert length > 0.0
            time, count = time + length, count + 1
        counts.append(count)
        errors.append(float(np.max(np.abs(y - expected))))
    assert counts[0] < counts[1] < counts[2] < 8 * counts[0]
    assert errors[0] < 1e-3
    assert errors[2] < 1e-5


def test_a_current_that_rises_over_a_step_is_met_at_each_stage():
    motion = motion_of(lambda _, u, k: k * u, 1, 1)
    _, _, v = motion.registers(np.ones(1), np.zeros((1, 0)))
    y = np.zeros(1)
    length, _ = adapted(motion.system, v, y, 1.0, 4.0, 0.5, 1e-3, np.zeros(1))
    assert length == 0.5
    assert y == pytest.approx([0.5 + 2.0 * 0.25], rel=1e-12)


def test_what_has_no_rate_is_not_stepped_and_the_state_stays():
    motion = motion_of(lambda y, _, k: k * ca.sqrt(y), 1, 1)
    _, _, v = motion.registers(np.ones(1), np.zeros((1, 0)))
    y = np.array([-1.0])
    assert adapted(motion.system, v, y, 0.0, 0.0, 0.1, 1e-3, np.zeros(1)) == (0.0, 0.0)
    assert y.tolist() == [-1.0]
    w, d, v = motion.registers(np.ones(1), np.zeros((1, 1)))
    good = step(
        motion.system, w, d, v, y, np.zeros((1, 1)), np.zeros(3), np.zeros((3, 1)), 0.1, np.zeros(1), np.zeros(1)
    )
    assert not good


def test_steps_end_before_the_one_that_fails():
    # Below a half there is no rate.
    motion = motion_of(lambda y, _, k: -k * (1.0 + ca.sqrt(y - 0.5)), 1, 1)
    states, tangents = np.empty((9, 1)), np.empty((9, 1, 0))
    states[0] = 1.0
    last = advance(
        motion.system, *motion.registers(np.array([2.0]), np.zeros((1, 0))), states, tangents, 0, np.full(8, 0.15),
        np.zeros((8, 0)), np.zeros((8, STAGES)), np.zeros((8, STAGES, 0)), np.zeros(1),
    )  # fmt: skip
    assert 1 <= last < 8
    assert np.all(np.diff(states[: last + 1, 0]) < 0.0)
