"""The torque at which a clamped ring slips, against its rings of pressure added up."""

import pytest
from scipy.integrate import quad

from tvimdesign.physics.motions.contacts import disc_torque


def test_a_clamped_ring_slips_at_what_its_thin_rings_bear() -> None:
    friction, force, inner, outer = 0.3, 250.0, 2e-3, 9e-3
    pressure = force / (3.141592653589793 * (outer**2 - inner**2))
    thin = quad(lambda r: friction * pressure * 2.0 * 3.141592653589793 * r * r, inner, outer)[0]
    assert disc_torque(friction, force, inner, outer) == pytest.approx(thin, rel=1e-9)


def test_a_thin_ring_slips_at_friction_times_force_times_radius() -> None:
    assert disc_torque(0.3, 250.0, 8.999e-3, 9.001e-3) == pytest.approx(0.3 * 250.0 * 9e-3, rel=1e-6)
