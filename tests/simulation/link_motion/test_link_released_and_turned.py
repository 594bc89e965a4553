"""The exact motion of the link: textbook solutions, scipy's Radau on equations written once more, and passivity."""

import numpy as np
import pytest
import textbook
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from tvimdesign.physics.motions import motion
from tvimdesign.simulation.link_motion import link
from tvimdesign.simulation.link_motion.course import Plant
from tvimdesign.simulation.link_motion.sampled_motion import doubling, settling_time

Array = NDArray[np.float64]
INERTIA, SPRINGS = 4.156e-4, 5.61  # the paper's table I
JOINT = motion.Joint(INERTIA, SPRINGS, 919.0)
MELT = [(2.068841e-2, 148.3), (6.54225e-3, 186.7), (2.068841e-3, 235.0), (6.54225e-4, 295.9), (2.068841e-4, 372.5),
        (6.54225e-5, 468.9)]  # fmt: skip
SOLID = [(1e10, 2.1e5), (10.0, 1.8e4), (1.0, 1.7e4), (0.1, 1.9e4), (0.01, 1.9e4), (0.001, 2.6e4)]
HALF = [(300.0, 5.6e3), (0.4, 1.8e3), (0.05, 2.0e3), (8e-3, 2.4e3), (1.5e-3, 2.7e3), (2e-4, 3.5e3)]
LAYERS = {"melt": MELT, "half frozen": HALF, "solid": SOLID}
RIGID = 1e9  # N*m/rad


def dashpot(damping: float) -> tuple[motion.Joint, motion.Modes]:
    """Return a joint whose branch is a dashpot, as near as springs of 1e7 N*m/rad come to rigid."""
    return motion.Joint(INERTIA, SPRINGS, RIGID), [(damping / 1e7, 1e7)]


def relaxed(modes: motion.Modes) -> Array:
    return np.full(len(modes), 0.1)


def crossings(times: Array, values: Array) -> Array:
    before = np.flatnonzero(values[:-1] * values[1:] < 0.0)
    share = values[before] / (values[before] - values[before + 1])
    return np.asarray(times[before] + share * (times[before + 1] - times[before]))


def test_springs_alone_ring_at_18_5_hertz():
    nothing = [(1.0, 1e-9)]
    moved = link.released(Plant(JOINT, nothing), 0.1, np.zeros(1)).motion
    frequency = 0.5 / np.mean(np.diff(crossings(moved.times, moved.angle)))
    assert frequency == pytest.approx(np.sqrt(SPRINGS / INERTIA) / (2.0 * np.pi), rel=1e-6)
    assert frequency == pytest.approx(18.5, abs=0.05)
    assert link.swings(JOINT, nothing, 0.1, np.zeros(1)).ringing() == pytest.approx(
        (frequency, 0.0), rel=1e-6, abs=1e-6
    )


@pytest.mark.parametrize("ratio", [0.05, 0.3])
def test_light_dashpot_gives_the_textbook_decay(ratio):
    joint, modes = dashpot(ratio * 2.0 * np.sqrt(SPRINGS * INERTIA))
    moved = link.released(Plant(joint, modes), 0.1, relaxed(modes)).motion
    omega = np.sqrt(SPRINGS / INERTIA)
    damped = omega * np.sqrt(1.0 - ratio**2)
    textbook = 0.1 * np.exp(-ratio * omega * moved.times) * (
        np.cos(damped * moved.times) + ratio * omega / damped * np.sin(damped * moved.times)
    )  # fmt: skip
    assert moved.angle == pytest.approx(textbook, abs=1e-6)
    swings = link.swings(joint, modes, 0.1, relaxed(modes))
    assert swings.ringing() == pytest.approx((damped / (2.0 * np.pi), ratio), rel=1e-4)


def test_heavy_dashpot_creeps_back_with_two_exponentials():
    joint, modes = dashpot(5.0)
    moved = link.released(Plant(joint, modes), 0.1, relaxed(modes)).motion
    fast, slow = np.sort(np.roots([INERTIA, 5.0, SPRINGS]))
    textbook = 0.1 * (fast * np.exp(slow * moved.times) - slow * np.exp(fast * moved.times)) / (fast - slow)
    assert moved.angle == pytest.approx(textbook, abs=1e-6)
    # b/K_s = 0.891 s; three of them to 5 %.
    settled = settling_time(moved.times, moved.angle, 0.05)
    assert settled == pytest.approx(np.log(20.0) * 5.0 / SPRINGS, rel=2e-3)
    swings = link.swings(joint, modes, 0.1, relaxed(modes))
    assert swings.ringing() == (0.0, 1.0)
    assert swings.fading_time(0.005) == pytest.approx(settled, rel=2e-3)


@pytest.mark.parametrize("damping", [0.01, 5.0])
def test_kelvin_voigt_is_the_dashpot_beside_the_spring(damping):
    joint, modes = dashpot(damping)
    moved = link.released(Plant(joint, modes), 0.1, relaxed(modes)).motion
    angle, torque = link.kelvin_voigt(joint, damping, SPRINGS, 0.1, moved)
    assert angle == pytest.approx(moved.angle, abs=1e-6)
    # A rigid link would have to turn at once: the dashpot's torque agrees once it has.
    later = moved.times > 1e-3
    assert torque[later] == pytest.approx(moved.torque[later], abs=1e-3)


@pytest.mark.gate
@pytest.mark.parametrize(("layer", "hold"), [("melt", 10.0), ("half frozen", 10.0), ("solid", 10.0), ("solid", 0.0)])
def test_hold_and_release_are_those_of_radau_on_the_torques_of_the_modes(layer, hold):
    # Other unknowns: torque of each mode, with the layer's angle from d/dt of the series' balance.
    tau, k = np.array(LAYERS[layer]).T
    structure = JOINT.structure_stiffness

    def free(_: float, y: Array) -> Array:
        turning = (structure * y[1] + np.sum(y[2:] / tau)) / (structure + np.sum(k))
        return np.array([y[1], -(SPRINGS * y[0] + np.sum(y[2:])) / INERTIA, *(k * turning - y[2:] / tau)])

    def still(_: float, y: Array) -> Array:
        return np.asarray(k * np.sum(y / tau) / (structure + np.sum(k)) - y / tau)

    torques = k * structure * 0.1 / (structure + np.sum(k))
    if hold:
        torques = solve_ivp(still, (0.0, hold), torques, method="Radau", rtol=1e-10, atol=1e-12).y[:, -1]
    internal = link.held(Plant(JOINT, LAYERS[layer]), 0.1, hold)
    moved = link.released(Plant(JOINT, LAYERS[layer]), 0.1, internal).motion
    early = moved.times <= 0.02
    reference = solve_ivp(
        free, (0.0, 0.021), np.concatenate([[0.1, 0.0], torques]), method="Radau", t_eval=moved.times[early],
        rtol=1e-9, atol=1e-12,
    )  # fmt: skip
    assert moved.angle[early] == pytest.approx(reference.y[0], abs=1e-6)
    held_torque = SPRINGS * 0.1 + np.sum(torques)
    torque = -(SPRINGS * reference.y[0] + np.sum(reference.y[2:], axis=0))
    assert moved.torque[early] == pytest.approx(torque, abs=1e-5 * held_torque)


@pytest.mark.parametrize("frequency", [0.2, 1.0, 18.5])
@pytest.mark.parametrize("layer", LAYERS)
def test_sine_in_time_has_the_complex_stiffness_of_the_frequency_domain(layer, frequency):
    moved = link.swung(Plant(JOINT, LAYERS[layer]), 0.104, frequency, 10, 240).motion
    s = 2j * np.pi * frequency
    inner = sum(k * s * tau / (1.0 + s * tau) for tau, k in LAYERS[layer])
    expected = SPRINGS + 1.0 / (1.0 / JOINT.structure_stiffness + 1.0 / inner)
    wave = np.exp(-s * moved.times[-240:])
    stiffness = -(moved.torque[-240:] @ wave) / (moved.angle[-240:] @ wave)
    assert abs(stiffness - expected) < 1e-2 * abs(expected)
    assert stiffness.imag == pytest.approx(expected.imag, rel=1e-2)
    assert moved.angle == pytest.approx(0.104 * np.sin(2.0 * np.pi * frequency * moved.times), abs=1e-9)


modes = st.lists(
    st.tuples(st.floats(-5.0, 10.0), st.floats(-3.0, 5.5)).map(lambda pair: (10.0 ** pair[0], 10.0 ** pair[1])),
    min_size=1,
    max_size=6,
)


@settings(max_examples=20, deadline=None)
@given(modes, st.floats(1.0, 5.0), st.floats(-4.0, 4.0))
def test_energy_never_rises_once_the_link_is_let_go(layer, structure, hold):
    joint = motion.Joint(INERTIA, SPRINGS, 10.0**structure)
    moved = link.released(Plant(joint, layer), 0.1, link.held(Plant(joint, layer), 0.1, 10.0**hold)).motion
    assert np.max(np.diff(moved.energy)) <= 1e-9 * moved.energy[0]
    assert np.all(moved.energy >= 0.0)


def test_energy_lost_is_the_heat_of_the_dashpots():
    moved = link.released(Plant(JOINT, HALF), 0.1, link.held(Plant(JOINT, HALF), 0.1, 10.0)).motion
    early = moved.times <= 0.2
    heat = textbook.dissipation(moved.angle, list(moved.internal), JOINT, HALF)[early]
    lost = moved.energy[0] - moved.energy[early][-1]
    assert np.trapezoid(heat, moved.times[early]) == pytest.approx(lost, rel=0.01)


def test_cold_ring_is_sampled_twenty_times_a_period_as_long_as_it_lives():
    moved = link.released(Plant(JOINT, HALF), 0.1, link.held(Plant(JOINT, HALF), 0.1, 10.0)).motion
    frequency, ratio = link.swings(JOINT, HALF, 0.1, link.held(Plant(JOINT, HALF), 0.1, 10.0)).ringing()
    alive = 6.0 / (2.0 * np.pi * frequency * ratio)
    assert np.max(np.diff(moved.times[moved.times < alive])) < 1.0 / (20.0 * frequency)


def test_doubling_stretches_end_where_they_should():
    times = np.cumsum([0.0, *(step for step, count in doubling(1e-4, 100.0) for _ in range(count))])
    assert times[0] == 0.0
    assert times[1] == pytest.approx(1e-4)
    assert times[-1] == pytest.approx(100.0, rel=1e-12)
    assert np.all(np.diff(times) > 0.0)
