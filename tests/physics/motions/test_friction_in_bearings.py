"""Friction of bearings: the maker's estimate, and the damping that loses as much."""

import numpy as np
import pytest
from scipy.integrate import quad

from tvimdesign.physics.motions.contacts import equivalent_damping, journal_torque, loaded_damping


def test_the_makers_estimate_for_a_ball_bearing() -> None:
    # SKF: M = 0.5 mu P d. 100 N on a bore of 15 mm with 0.0015: 1.125 N*mm.
    assert journal_torque(0.0015, 100.0, 15e-3) == pytest.approx(1.125e-3, rel=1e-12)


def test_the_damping_loses_in_a_cycle_what_the_friction_does() -> None:
    omega, amplitude, torque = 2.0 * np.pi, 0.104, 0.05
    damping = equivalent_damping(torque, omega, amplitude)
    viscous, _ = quad(lambda t: damping * (omega * amplitude * np.cos(omega * t)) ** 2, 0.0, 1.0)
    assert viscous == pytest.approx(torque * 4.0 * amplitude, rel=1e-9)  # there, back, and both again


@pytest.mark.parametrize("degrees", [0.0, 20.0, 60.0, 90.0])
def test_friction_that_grows_with_the_load_takes_what_summing_up_a_cycle_says(degrees: float) -> None:
    # K* of 7 N m/rad at that phase, friction a fifth of the load, 3 Hz, 0.1 rad: W by quadrature, b = W/(pi w a^2).
    delta, omega, reach, share, size = np.radians(degrees), 6.0 * np.pi, 0.1, 0.2, 7.0
    phase = np.linspace(0.0, 2.0 * np.pi, 200_001)
    torque = share * size * reach * np.abs(np.sin(phase + delta))
    energy = np.trapezoid(torque * np.abs(reach * np.cos(phase)), phase)
    found = loaded_damping(share, size * np.cos(delta), size * np.sin(delta), omega)
    assert found == pytest.approx(energy / (np.pi * omega * reach**2), rel=1e-8)


def test_half_of_a_constant_friction_against_a_spring_and_pi_over_four_against_a_dashpot() -> None:
    constant = equivalent_damping(0.2 * 7.0 * 0.1, 2.0, 0.1)
    assert loaded_damping(0.2, 7.0, 0.0, 2.0) == pytest.approx(0.5 * constant, rel=1e-12)
    assert loaded_damping(0.2, 0.0, 7.0, 2.0) == pytest.approx(0.25 * np.pi * constant, rel=1e-12)
