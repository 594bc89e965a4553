"""Friction of bearings: the maker's estimate, and the damping that loses as much."""

import numpy as np
import pytest
from scipy.integrate import quad

from tvimdesign.physics.motions.friction import equivalent_damping, journal_torque


def test_the_makers_estimate_for_a_ball_bearing() -> None:
    # SKF: M = 0.5 mu P d. 100 N on a bore of 15 mm with 0.0015: 1.125 N*mm.
    assert journal_torque(0.0015, 100.0, 15e-3) == pytest.approx(1.125e-3, rel=1e-12)


def test_the_damping_loses_in_a_cycle_what_the_friction_does() -> None:
    omega, amplitude, torque = 2.0 * np.pi, 0.104, 0.05
    damping = equivalent_damping(torque, omega, amplitude)
    viscous, _ = quad(lambda t: damping * (omega * amplitude * np.cos(omega * t)) ** 2, 0.0, 1.0)
    assert viscous == pytest.approx(torque * 4.0 * amplitude, rel=1e-9)  # there, back, and both again
