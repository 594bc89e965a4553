"""Currents that follow a profile: the numbers of one, and a switch under one against scipy."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from another_stack import AnotherStack, value_of
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp
from support import tight

from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile, ramp_time
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions

currents = st.lists(st.floats(-20.0, 20.0), min_size=1, max_size=9).map(tuple)
durations = st.floats(0.5, 5000.0)


def evenly(duration: float, sizes: tuple[float, ...]) -> CurrentProfile:
    return CurrentProfile.in_pieces(0.0, duration, sizes)


def test_a_profile_rises_from_zero_straight_between_nodes_and_lasts() -> None:
    assert ramp_time(1.5, 0.5) == pytest.approx(3.0)
    profile = CurrentProfile.in_pieces(2.0, 10.0, (-1.0, -0.5, -0.5))
    assert profile.at(np.array([0.0, 1.0, 2.0, 4.5, 7.0, 50.0])) == pytest.approx([0.0, -0.5, -1.0, -0.75, -0.5, -0.5])
    assert profile.steepest == pytest.approx(0.5)
    assert profile.next_corner(0.0) == pytest.approx(2.0)
    assert profile.mean == pytest.approx((-1.0 - 3.75 - 2.5) / 12.0)
    profile = evenly(120.0, (2.0, 1.0, 1.5))
    assert profile.at(np.array([0.0, 30.0, 60.0, 90.0, 120.0, 500.0])) == pytest.approx([2.0, 1.5, 1.0, 1.25, 1.5, 1.5])
    assert profile.mean == pytest.approx((60.0 * 1.5 + 60.0 * 1.25) / 120.0)


@given(duration=durations, pieces=st.integers(1, 64))
def test_going_from_corner_to_corner_meets_each_once(duration: float, pieces: int) -> None:
    profile, time, corners = evenly(duration, (1.0,) * (pieces + 1)), 0.0, []
    while np.isfinite(time := profile.next_corner(time)) and len(corners) < 100:
        corners.append(time)
    assert corners == pytest.approx(list(np.linspace(0.0, duration, pieces + 1)[1:]), rel=1e-9)


@given(duration=durations, sizes=currents)
def test_the_mean_is_the_integral_over_the_duration(duration: float, sizes: tuple[float, ...]) -> None:
    profile = evenly(duration, sizes)
    nodes = np.linspace(0.0, duration, max(len(sizes), 2))
    total = sum(quad(lambda t: float(profile.at(np.array(t))), a, b)[0] for a, b in pairwise(nodes))
    assert profile.mean == pytest.approx(total / duration, rel=1e-9, abs=1e-9)


@given(duration=durations, sizes=currents)
def test_a_profile_comes_back_from_plain_data(duration: float, sizes: tuple[float, ...]) -> None:
    profile = evenly(duration, sizes)
    assert CurrentProfile.from_plain(profile.plain()) == profile


@pytest.mark.slow
def test_a_switch_under_a_profile_agrees_with_scipy(build: Callable[..., DeviceFunctions]) -> None:
    model = build()
    profile = evenly(100.0, (0.8, 2.4, 1.2, 2.0, 1.6))
    another = AnotherStack(value_of(model))
    target = model.start[model.index["target_temperature"]] - 273.15

    def reached(_: float, y: np.ndarray) -> float:
        return another.faces(y)[2] - target

    reached.terminal = True
    found = solve_ivp(
        lambda t, y: another.rates(y, float(np.interp(t, np.linspace(0.0, 100.0, 5), [0.8, 2.4, 1.2, 2.0, 1.6]))),
        (0.0, 600.0), another.everywhere(22.0), method="BDF", rtol=1e-6, atol=1e-4, max_step=5.0,
        jac_sparsity=another.neighbours(), events=[reached], dense_output=True,
    )  # fmt: skip
    cycle = tight(model).run(model.start, {"softening": profile}, phases=["softening"])
    time = float(found.t_events[0][0])
    assert cycle.values["far_face_time"] == pytest.approx(time, rel=0.01)
    sampled = np.linspace(0.0, time, 2001)
    amps = np.interp(sampled, np.linspace(0.0, 100.0, 5), [0.8, 2.4, 1.2, 2.0, 1.6])
    power = [another.power(found.sol(t), a) for t, a in zip(sampled, amps, strict=True)]
    assert cycle.values["switch_energy"] == pytest.approx(np.trapezoid(power, sampled), rel=0.01)
    assert cycle.values["peak_power"] == pytest.approx(max(power), rel=0.01)
    assert cycle.values["peak_current"] == pytest.approx(2.4, rel=1e-6)
    assert cycle.trajectory.currents == pytest.approx(profile.at(cycle.trajectory.times))
    constant = tight(model).run(model.start, phases=["softening"]).values["far_face_time"]
    assert abs(constant - time) > 0.05 * time  # the profile is what made it


def test_a_profile_that_is_flat_is_the_constant_current(build: Callable[..., DeviceFunctions]) -> None:
    model = build()
    flat = tight(model).run(model.start, {"softening": evenly(80.0, (1.5,) * 5)}).values
    constant = tight(model).run(model.start).values
    for name in ("response_time", "switch_energy", "peak_pcl_temperature", "stiffening_time", "hold_power"):
        assert flat[name] == pytest.approx(constant[name], rel=1e-6), name


def test_a_switch_s_end_does_not_depend_on_later_currents(build: Callable[..., DeviceFunctions]) -> None:
    model = build()
    simulator = tight(model)
    early = simulator.run(model.start, {"softening": evenly(400.0, (2.0,) * 5)}).values["response_time"]
    late = simulator.run(model.start, {"softening": evenly(400.0, (2.0, 2.0, 2.0, 0.1, 0.1))}).values["response_time"]
    assert early < 200.0
    assert late == pytest.approx(early, rel=1e-7)
