"""Shaft, rings and the one degree of freedom, against quadrature, integration in time, and worked values."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from tvimdesign.physics.motions import motion
from tvimdesign.physics.solids import structure

INERTIA = 4.156e-4  # kg*m^2, Exley et al., table I (there as kg/mm^2)
STIFFNESS = 5.61  # N*m/rad, four springs of 1.4023


def test_springs_alone_ring_at_18_5_hertz() -> None:
    # sqrt(5.61/4.156e-4)/(2 pi) = 116.2/6.2832.
    assert motion.natural_frequency(STIFFNESS, INERTIA) == pytest.approx(18.5, rel=5e-3)


def test_damping_of_0_0966_is_critical() -> None:
    # 2 sqrt(5.61 * 4.156e-4) = 0.0966 N*m*s/rad.
    assert motion.damping_ratio(0.0966, STIFFNESS, INERTIA) == pytest.approx(1.0, rel=5e-3)


@pytest.mark.parametrize("ratio", [0.05, 0.2])
def test_free_swing_rings_and_decays_as_frequency_and_damping_ratio_say(ratio: float) -> None:
    damping = ratio * 0.0966
    swing = solve_ivp(
        lambda _, y: [y[1], -(damping * y[1] + STIFFNESS * y[0]) / INERTIA],
        (0.0, 1.0), [0.1, 0.0], rtol=1e-10, atol=1e-12, events=[lambda _, y: y[1]],
    )  # fmt: skip
    peaks = np.array(
        [state[0] for time, state in zip(swing.t_events[0], swing.y_events[0], strict=True) if time > 1e-9]
    )
    times = swing.t_events[0][swing.t_events[0] > 1e-9]
    # Half a period apart; the logarithmic decrement of half a period is pi zeta/sqrt(1 - zeta^2).
    zeta = motion.damping_ratio(damping, STIFFNESS, INERTIA)
    frequency = motion.natural_frequency(STIFFNESS, INERTIA)
    assert 0.5 / (times[1] - times[0]) == pytest.approx(frequency * np.sqrt(1.0 - zeta**2), rel=1e-6)
    assert np.log(abs(peaks[0] / peaks[1])) == pytest.approx(np.pi * zeta / np.sqrt(1.0 - zeta**2), rel=1e-6)


def test_shear_modulus_of_6061_is_that_of_the_handbook() -> None:
    # 6061-T6: E 68.9 GPa, nu 0.33, G 26 GPa (MIL-HDBK-5: 3.8e6 psi = 26.2 GPa).
    assert structure.shear_modulus(68.9e9, 0.33) == pytest.approx(26e9, rel=0.01)


def test_shaft_stiffness_is_modulus_times_polar_moment_over_length() -> None:
    modulus, radius, length = 0.76e9, 10e-3, 9e-3
    polar, _ = quad(lambda r: 2.0 * np.pi * r**3, 0.0, radius, epsabs=0.0, epsrel=1e-12)
    assert structure.shaft_stiffness(modulus, radius, length) == pytest.approx(modulus * polar / length, rel=1e-9)


def test_shaft_yields_where_the_stress_at_its_surface_does() -> None:
    # Stress rises with the radius: tau r/R on the rings 2 pi r dr, each on the arm r.
    shear_yield, radius = 30e6, 8e-3
    torque, _ = quad(lambda r: shear_yield * r / radius * 2.0 * np.pi * r**2, 0.0, radius, epsabs=0.0)
    assert structure.shaft_torque(shear_yield, radius) == pytest.approx(torque, rel=1e-9)


def test_ring_stiffness_is_the_series_of_its_thin_rings() -> None:
    # A ring of radius r, width dr and thickness h sheared in its plane turns by T dr/(2 pi r^3 h G).
    modulus, thickness, inner, outer = 0.76e9, 4e-3, 10e-3, 33e-3
    compliance, _ = quad(lambda r: 1.0 / (2.0 * np.pi * r**3 * thickness * modulus), inner, outer, epsabs=0.0)
    found = structure.ring_stiffness(modulus, thickness, inner, outer)
    assert found == pytest.approx(1.0 / compliance, rel=1e-9)


def test_springs_in_series_share_the_torque() -> None:
    assert structure.series(3.0, 6.0) == pytest.approx(2.0, rel=1e-12)
    assert structure.series(2.0, 4.0, 4.0) == pytest.approx(1.0, rel=1e-12)


def test_a_force_beyond_two_bearings_is_balanced_by_them_in_force_and_moment() -> None:
    force, height, spread = 120.0, 0.05, 0.02
    far, near = np.linalg.solve([[1.0, 1.0], [0.0, spread]], [-force, -force * (height + spread)])
    assert structure.overhung_load(force, height, spread) == pytest.approx(-near)
    assert far > 0.0  # the farther one pulls the other way


def test_pure_shear_at_the_shear_yield_has_the_equivalent_stress_of_the_tensile_yield() -> None:
    # Mises: sqrt(3/2 s:s) of the deviator, here of shear alone in two planes of the tensor.
    shear = structure.shear_yield(47.5e6)
    tensor = np.array([[0.0, shear, 0.0], [shear, 0.0, 0.0], [0.0, 0.0, 0.0]])
    assert np.sqrt(1.5 * np.sum(tensor**2)) == pytest.approx(47.5e6, rel=1e-12)
