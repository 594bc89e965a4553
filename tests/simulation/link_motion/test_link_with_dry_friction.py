"""A link released against dry friction and one behind a lossy structure, against textbooks and scipy."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from support import study_path

from tvimdesign.physics.motions import motion
from tvimdesign.physics.motions.motion import Joint, Modes
from tvimdesign.physics.motions.one_sided import Blocks
from tvimdesign.simulation.joint_tests import release as release_test
from tvimdesign.simulation.link_motion.course import Plant
from tvimdesign.simulation.link_motion.link import released
from tvimdesign.simulation.link_motion.sampled_motion import OneSided, in_series, spectrum, turns_of, with_loss
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.study import read_study

Array = NDArray[np.float64]
INERTIA, SPRINGS, SUPPORT, FRICTION = 4.156e-4, 5.61, 919.0, 0.0318
JOINT = motion.Joint(INERTIA, SPRINGS, SUPPORT)
NOTHING = [(1.0, 1e-9)]
THIN = [(8e-3, 4.0), (1e-3, 9.0)]  # a melt thin enough for the link to ring
MELT = [(2.068841e-2, 148.3), (6.54225e-3, 186.7), (2.068841e-3, 235.0), (6.54225e-4, 295.9)]
FROZEN = [(300.0, 5.6e3), (0.4, 1.8e3), (0.05, 2.0e3), (8e-3, 2.4e3), (1.5e-3, 2.7e3), (2e-4, 3.5e3)]
BAND = FRICTION / SPRINGS


def let_go(modes: motion.Modes, one_sided: bool = False, friction: float = FRICTION) -> OneSided:
    """Released from 0.1 rad, the polymer relaxed there."""
    plant = Plant(JOINT, Blocks(modes, modes) if one_sided else modes)
    ahead, behind = np.full(len(modes), 0.1), np.full(len(modes), -0.1)
    return released(plant, 0.1, np.concatenate([ahead, behind]) if one_sided else ahead, friction)


@pytest.mark.parametrize("one_sided", [False, True])
def test_amplitude_falls_by_twice_the_band_in_every_half_swing(one_sided):
    swing = let_go(NOTHING, one_sided)
    moved = swing.motion
    stops = np.flatnonzero(moved.speed == 0.0)
    peaks = moved.angle[stops][np.abs(np.diff(moved.angle[stops], prepend=np.nan)) > 1e-9]
    # 0.1, less 2 T_f/K each time, until the springs no longer overcome the friction.
    amplitudes = [0.1]
    while abs(amplitudes[-1]) > BAND:
        amplitudes.append(-np.sign(amplitudes[-1]) * (abs(amplitudes[-1]) - 2.0 * BAND))
    assert peaks == pytest.approx(amplitudes[1:], rel=1e-6)
    assert swing.rest_angle == pytest.approx(amplitudes[-1], rel=1e-6)
    assert abs(swing.rest_angle or 1.0) < BAND
    # Friction does not change the period.
    times = moved.times[turns_of(moved.speed) - 1]
    assert np.diff(times) == pytest.approx(np.pi * np.sqrt(INERTIA / SPRINGS), rel=1e-6)


def test_the_loop_is_twice_the_friction_wide():
    moved = let_go(NOTHING).motion
    sliding = np.abs(moved.speed) > 1e-9
    loss = moved.torque[sliding] + SPRINGS * moved.angle[sliding]
    assert np.unique(np.round(loss, 9)).tolist() == pytest.approx([-FRICTION, FRICTION], rel=1e-6)
    # What the loop encloses is what the friction took: the energy the link has lost.
    work = FRICTION * np.sum(np.abs(np.diff(moved.angle)))
    assert moved.energy[0] - moved.energy[-1] == pytest.approx(work, rel=1e-6)


def smooth(modes: motion.Modes, one_sided: bool, times: Array) -> Array:
    """Angle of the same link by scipy, its equations written once more, friction smooth near zero speed."""
    tau, k = (np.array(column) for column in zip(*modes, strict=True))
    whole = SUPPORT / (SUPPORT + np.sum(k))

    def side(angle: float, q: Array) -> tuple[float, Array]:
        pull = float(np.sum(k * (angle - q)))
        if one_sided and pull < 0.0:  # parted: the block is alone and its modes meet at their mean
            return 0.0, (np.sum(k * q) / np.sum(k) - q) / tau
        return whole * pull, ((SUPPORT * angle + np.sum(k * q)) / (SUPPORT + np.sum(k)) - q) / tau

    def rates(_: float, state: Array) -> Array:
        angle, speed, q = state[0], state[1], state[2:]
        ahead, first = side(angle, q[: len(k)])
        behind, second = side(-angle, q[len(k) :]) if one_sided else (0.0, np.empty(0))
        torque = -SPRINGS * angle - ahead + behind - FRICTION * np.tanh(speed / 2e-5)
        return np.concatenate([[speed, torque / INERTIA], first, second])

    q = np.full(len(k), 0.1)
    start = np.concatenate([[0.1, 0.0], q, -q if one_sided else []])
    solved = solve_ivp(rates, (0.0, times[-1]), start, "Radau", times, rtol=1e-9, atol=1e-11)
    return np.asarray(solved.y[0])


@pytest.mark.slow
@pytest.mark.parametrize(("modes", "one_sided"), [(THIN, False), (MELT, False), (THIN, True), (MELT, True)])
def test_the_motion_is_that_of_scipy_with_friction_made_smooth(modes, one_sided):
    moved = let_go(modes, one_sided).motion
    early = moved.times <= 0.4
    times = moved.times[early]
    apart = np.diff(times, prepend=-1.0) > 1e-12
    other = smooth(modes, one_sided, times[apart])
    assert moved.angle[early][apart] == pytest.approx(other, abs=2e-5)


def test_hardly_any_friction_is_none():
    moved = let_go(THIN, friction=1e-12).motion
    early = moved.times < 0.3
    fine = solve_ivp(
        lambda _, x: np.array(motion.rates(x[0], x[1], x[2:], 0.0, JOINT, THIN), dtype=float),
        (0.0, moved.times[early][-1]), [0.1, 0.0, 0.1, 0.1], "DOP853", moved.times[early], rtol=1e-11, atol=1e-13,
    )  # fmt: skip
    assert moved.angle[early] == pytest.approx(fine.y[0], abs=1e-8)


def test_a_melt_creeps_to_the_edge_of_the_band_and_stays():
    swing = let_go(MELT)
    assert swing.rest_angle == pytest.approx(BAND, rel=1e-4)
    assert np.max(np.diff(swing.motion.energy)) <= 1e-12 * swing.motion.energy[0]


def test_a_frozen_joint_creeps_without_inertia_on_the_edge_of_the_friction():
    swing = let_go(FROZEN)
    moved = swing.motion
    assert moved.times[-1] > 3000.0  # not held up by a slip at every period of the joint
    assert len(moved.times) < 2000
    assert np.max(np.diff(moved.energy)) <= 1e-12 * moved.energy[0]
    # The torque of springs and layer stays within the friction once it only creeps, and comes to it when it moves.
    pushed = motion.module_torque(moved.angle, list(moved.internal), JOINT, FROZEN)
    late = moved.times > 1.0
    assert np.max(np.abs(pushed[late])) <= FRICTION * (1.0 + 1e-5)  # rounding over an hour
    moving = late[1:] & (np.abs(np.diff(moved.angle)) > 1e-9)
    assert np.abs(pushed[1:][moving]) == pytest.approx(FRICTION, rel=1e-5)


@pytest.mark.slow
def test_the_release_of_the_published_module_shows_its_hysteresis():
    study = read_study(study_path("paper_reconstructed"))
    resolved = resolve_study(study)
    trial = release_test.release(resolved, kelvin_voigt=False)
    friction = resolved.quantity("pin_friction_torque")
    resting = next(finding.value for finding in trial.findings if finding.name == "rest_angle@hot")
    assert resting == pytest.approx(friction / resolved.quantity("spring_stiffness"), rel=1e-3)
    held = next(finding.value for finding in trial.findings if finding.name == "held_torque@hot")
    assert held == pytest.approx(0.1 * resolved.quantity("spring_stiffness") - friction, rel=1e-3)
    assert any("Friction of" in note for note in trial.notes)


LOSSY_MELT = [(1.0, 1.0), (0.1, 20.0), (0.01, 200.0)]
LOSSY_FROZEN = [(1e10, 2e5), (10.0, 2e4), (1.0, 2e4), (0.1, 2e4), (0.01, 2e4), (0.001, 3e4)]


def star(spring: float, modes: Modes, hertz: np.ndarray) -> np.ndarray:
    s = 2j * np.pi * hertz
    return spring + sum(k * s * tau / (1.0 + s * tau) for tau, k in modes)


@pytest.mark.parametrize("loss_factor", [1e-4, 0.04, 0.3, 1.5])
@pytest.mark.parametrize("hertz", [0.1, 1.0, 100.0])
def test_loss_factor_is_the_same_over_three_decades_and_exact_at_the_point(loss_factor, hertz):
    spring, elements = spectrum(700.0, 700.0 * loss_factor, hertz)
    assert spring >= 0.0
    assert all(stiffness > 0.0 for _, stiffness in elements)
    band = np.geomspace(0.1, 100.0, 300)
    complex_stiffness = star(spring, elements, band)
    assert complex_stiffness.imag / complex_stiffness.real == pytest.approx(loss_factor, rel=0.01)
    # The law a constant loss factor leaves: (i omega)^alpha, alpha = 2/pi atan(eta).
    law = 700.0 * (1.0 + 1j * loss_factor) * (band / hertz) ** (2.0 / np.pi * np.arctan(loss_factor))
    assert np.max(np.abs(complex_stiffness / law - 1.0)) < 5e-3
    assert star(spring, elements, np.array([hertz]))[0] == pytest.approx(700.0 * (1.0 + 1j * loss_factor), rel=1e-6)


@pytest.mark.parametrize("layer", [LOSSY_MELT, LOSSY_FROZEN, [(0.01, 3.0)]])
@pytest.mark.parametrize("loss_factor", [0.04, 1.5])
def test_modes_in_series_are_those_of_both_one_behind_the_other(layer, loss_factor):
    spring, elements = spectrum(700.0, 700.0 * loss_factor, 1.0)
    together = in_series(layer, spring, elements)
    assert all(stiffness > 0.0 and tau > 0.0 for tau, stiffness in together)
    hertz = np.geomspace(1e-8, 1e5, 400)
    first, other = star(0.0, layer, hertz), star(spring, elements, hertz)
    assert np.max(np.abs(star(0.0, together, hertz) / (first * other / (first + other)) - 1.0)) < 1e-9


def test_structures_may_share_a_time_with_the_layer_or_lose_nothing():
    spring, elements = spectrum(700.0, 28.0, 1.0)
    layer = [(elements[3][0], 90.0), (1e-3, 500.0)]
    hertz = np.geomspace(1e-3, 1e3, 100)
    first, other = star(0.0, layer, hertz), star(spring, elements, hertz)
    together = star(0.0, in_series(layer, spring, elements), hertz)
    assert np.max(np.abs(together / (first * other / (first + other)) - 1.0)) < 1e-5
    joint = Joint(4e-4, 5.0, 700.0)
    assert with_loss(joint, LOSSY_MELT, 0.0, 1.0) == (joint, LOSSY_MELT)
