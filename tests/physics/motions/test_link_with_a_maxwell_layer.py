"""Equations of the link with internal states: statics written by hand, energy against heat, floats against symbols."""

import casadi as ca
import numpy as np
import pytest
import textbook
from hypothesis import given
from hypothesis import strategies as st

from tvimdesign.physics.motions import motion

JOINT = motion.Joint(4.156e-4, 5.61, 919.0)
MODES = [(2e-2, 150.0), (1e-3, 300.0), (1e10, 40.0)]
angles = st.floats(-1.0, 1.0)
states = st.lists(angles, min_size=3, max_size=3)


def test_modes_of_a_layer_are_its_moduli_times_polar_moment_over_thickness() -> None:
    # 82513.7 Pa * 1.797e-6 m^4/1 mm = 148.28 N*m/rad, the melt's longest mode in the paper's layer.
    (time, stiffness), *_ = motion.layer_modes([(2.068841e-2, 82513.7)], 1.797e-6, 1e-3)
    assert time == 2.068841e-2
    assert stiffness == pytest.approx(148.277, rel=1e-5)


def test_layer_free_of_strain_and_structure_are_springs_in_series() -> None:
    # 490 N*m/rad behind 919: 319.6 N*m/rad; the layer takes 919/1409 of the angle.
    assert motion.branch_torque(0.1, [0.0, 0.0, 0.0], JOINT, MODES) == pytest.approx(31.96, rel=1e-3)
    assert motion.layer_angle(0.1, [0.0, 0.0, 0.0], JOINT, MODES) == pytest.approx(0.1 * 919.0 / 1409.0)


def test_relaxed_layer_leaves_the_springs_alone() -> None:
    assert motion.module_torque(0.1, [0.1, 0.1, 0.1], JOINT, MODES) == pytest.approx(-0.561)


@given(angles, states)
def test_structure_and_modes_carry_one_torque(angle: float, internal: list[float]) -> None:
    phi = motion.layer_angle(angle, internal, JOINT, MODES)
    carried = sum(k * (phi - q) for (_, k), q in zip(MODES, internal, strict=True))
    assert motion.branch_torque(angle, internal, JOINT, MODES) == pytest.approx(carried, rel=1e-9, abs=1e-9)


@given(angles, st.floats(-100.0, 100.0), states, st.floats(-5.0, 5.0))
def test_energy_grows_by_the_work_done_less_the_heat_made(
    angle: float, speed: float, internal: list[float], torque: float
) -> None:
    state = np.array([angle, speed, *internal])
    rate = np.array(motion.rates(angle, speed, internal, torque, JOINT, MODES))
    # Complex step: the derivative along the motion to machine precision.
    moved = state + 1e-30j * rate
    growth = np.imag(motion.stored_energy(moved[0], moved[1], list(moved[2:]), JOINT, MODES)) / 1e-30
    heat = textbook.dissipation(angle, internal, JOINT, MODES)
    assert heat >= 0.0
    scale = abs(torque * speed) + heat + motion.stored_energy(angle, speed, internal, JOINT, MODES)
    assert growth == pytest.approx(torque * speed - heat, abs=1e-9 * scale + 1e-12)


def test_energy_is_that_of_each_spring_and_of_the_link() -> None:
    one = [(1.0, 200.0)]
    phi = (919.0 * 0.1 + 200.0 * 0.02) / 1119.0
    by_hand = 0.5 * (4.156e-4 * 3.0**2 + 5.61 * 0.1**2 + 919.0 * (0.1 - phi) ** 2 + 200.0 * (phi - 0.02) ** 2)
    assert motion.stored_energy(0.1, 3.0, [0.02], JOINT, one) == pytest.approx(by_hand, rel=1e-12)


def test_kelvin_voigt_slows_and_pulls_back() -> None:
    speed, acceleration = motion.kelvin_voigt_rates(0.1, 2.0, 0.5, 0.25, 10.0)
    assert (speed, acceleration) == (2.0, pytest.approx(-(0.25 * 2.0 + 10.0 * 0.1) / 0.5))
    assert motion.kelvin_voigt_torque(0.1, 2.0, 0.25, 10.0) == pytest.approx(-1.5)


def test_symbols_give_what_floats_give() -> None:
    names = [ca.SX.sym(name) for name in ("angle", "speed", "q1", "q2", "q3", "torque")]
    angle, speed, *internal, torque = names
    symbolic = motion.rates(angle, speed, internal, torque, JOINT, MODES)
    symbolic.append(motion.stored_energy(angle, speed, internal, JOINT, MODES))
    numbers = (0.1, -2.0, 0.02, 0.05, 0.0, 0.3)
    found = ca.Function("found", names, [ca.vertcat(*symbolic)])(*numbers)
    plain = motion.rates(*numbers[:2], list(numbers[2:5]), numbers[5], JOINT, MODES)
    plain.append(motion.stored_energy(*numbers[:2], list(numbers[2:5]), JOINT, MODES))
    assert np.asarray(found).ravel() == pytest.approx(plain, rel=1e-12)
