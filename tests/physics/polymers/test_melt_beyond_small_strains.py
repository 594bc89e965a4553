"""A melt in large oscillations and in a thin gap, against brute force, Stokes' equation and limits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from tvimdesign.physics.polymers import melt, polymer
from tvimdesign.simulation.working_cycle.casadi_setup import ca

LIMIT = 0.3
MELT = polymer.melt_spectrum(4200.0, 0.95e6, 6)


def kept(strain: np.ndarray | float) -> np.ndarray | float:
    """Share of the modulus after a step, 5 % less at 30 % of strain: written out once more."""
    return 1.0 / (1.0 + (strain / 0.3) ** 2 / 19.0)


def by_brute_force(strain: float, angular: float) -> tuple[float, float]:
    """First harmonics over the amplitude of Wagner's stress, 48 phases, 300 points of the past in each mode."""
    phases = np.arange(48) * 2.0 * np.pi / 48
    nodes, weights = np.polynomial.legendre.leggauss(300)
    ages, stress = 15.0 * (nodes + 1.0), np.zeros(48)
    for time, modulus in MELT:
        relative = strain * (np.sin(phases)[:, None] - np.sin(phases[:, None] - angular * time * ages))
        stress += modulus * np.sum(15.0 * weights * np.exp(-ages) * kept(relative) * relative, axis=1)
    return 2.0 / 48 * float(stress @ np.sin(phases)) / strain, 2.0 / 48 * float(stress @ np.cos(phases)) / strain


@pytest.mark.parametrize("hertz", [0.1, 1.0, 5.0, 20.0])
@pytest.mark.parametrize("strain", [0.3, 1.0, 4.13])
def test_moduli_are_the_first_harmonics_of_wagners_integral(strain: float, hertz: float) -> None:
    angular = 2.0 * np.pi * hertz
    found = melt.wagner_moduli(strain, angular, MELT, LIMIT)
    assert found == pytest.approx(by_brute_force(strain, angular), rel=2e-3)


def test_slow_or_small_motion_is_linear() -> None:
    linear = polymer.maxwell_moduli(0.01, MELT)
    assert melt.wagner_moduli(4.0, 0.01, MELT, LIMIT) == pytest.approx(linear, rel=1e-3)
    assert melt.unrelaxed_moduli(4.0, 0.01, MELT, LIMIT)[1] < 0.1 * linear[1]
    found = melt.wagner_moduli(1e-4, 600.0, MELT, LIMIT)
    assert found == pytest.approx(polymer.maxwell_moduli(600.0, MELT), rel=1e-6)


@given(strain=st.floats(0.01, 10.0), hertz=st.floats(0.05, 20.0))
def test_strain_only_softens_and_never_below_none(strain: float, hertz: float) -> None:
    angular = 2.0 * np.pi * hertz
    linear = polymer.maxwell_moduli(angular, MELT)
    for found, most in zip(melt.wagner_moduli(strain, angular, MELT, LIMIT), linear, strict=True):
        assert 0.0 < found <= most * (1.0 + 1e-9)


@pytest.mark.parametrize("strain", [1e-5, 0.3, 3.0])
def test_softening_is_the_first_harmonic_of_the_strain_law(strain: float) -> None:
    share, _ = quad(lambda p: kept(strain * np.cos(p)) * np.cos(p) ** 2 / np.pi, 0.0, 2.0 * np.pi)
    assert melt.softening(strain, LIMIT) == pytest.approx(1.0 - share, rel=1e-6, abs=1e-12)


def test_a_ring_s_torque_and_an_edge_that_gives() -> None:
    inner, rim = 0.6, 4.0
    share, _ = quad(lambda r: kept(rim * r) * r**3, inner, 1.0)
    whole, _ = quad(lambda r: r**3, inner, 1.0)
    nodes = melt.ring(inner)
    assert sum(weight for _, weight in nodes) == pytest.approx(1.0, rel=1e-12)
    assert sum(w * float(kept(rim * reach)) for reach, w in nodes) == pytest.approx(share / whole, rel=1e-4)
    # 2 0.035/(3 1 mm) = 23.3 Pa; a fifth of 1 kPa times the strain squared passes it at 34 %.
    strain = melt.edge_strain(1e-3, 0.035, 0.2, 1000.0)
    assert 0.2 * 1000.0 * strain**2 == pytest.approx(23.333, rel=1e-3)
    assert strain == pytest.approx(0.3416, rel=1e-3)


def test_symbols_give_the_numbers_with_finite_derivatives() -> None:
    strain, angular = ca.SX.sym("g"), ca.SX.sym("w")
    storage, loss = melt.wagner_moduli(strain, angular, MELT, LIMIT)
    both = ca.vertcat(storage, loss)
    look = ca.Function("look", [strain, angular], [both, ca.jacobian(both, ca.vertcat(strain, angular))])
    for at in ((1e-3, 0.1), (0.5, 6.0), (8.0, 600.0)):
        numbers, slopes = (np.asarray(part) for part in look(*at))
        assert numbers.ravel() == pytest.approx(melt.wagner_moduli(*at, MELT, LIMIT), rel=1e-9)
        assert np.all(np.isfinite(slopes))


def profile_mean(gradient: float, gap: float, viscosity: float, cells: int = 400) -> float:
    """Mean speed [m/s] of eta u'' = -g between two walls at rest, by finite volumes."""
    step = gap / cells
    matrix = np.diag(np.full(cells, -2.0)) + np.diag(np.ones(cells - 1), 1) + np.diag(np.ones(cells - 1), -1)
    matrix[0, 0] = matrix[-1, -1] = -3.0  # the wall is half a cell away
    return float(np.mean(np.linalg.solve(matrix, np.full(cells, -gradient * step**2 / viscosity))))


def test_gaps_pass_flow_as_stokes_says_and_surfaces_hold_what_they_lift() -> None:
    expected = profile_mean(1.05e4, 1e-3, 2825.0)
    assert melt.gap_speed(1.05e4, 1e-3, 2825.0) == pytest.approx(expected, rel=1e-4)
    length, gap, lip, narrow, viscosity, pressure = 14e-3, 1e-3, 1.5e-3, 0.4e-3, 2825.0, 150.0
    speed = melt.gap_speed(pressure / melt.gaps_in_series(length, gap, lip, narrow), gap, viscosity)
    inside = 12.0 * viscosity * speed / gap**2 * length
    below = 12.0 * viscosity * (speed * gap / narrow) / narrow**2 * lip  # the same volume through a narrower gap
    assert inside + below == pytest.approx(pressure, rel=1e-12)
    # Water at 20 degC, 72.8 mN/m and 998 kg/m3, wets glass plates a millimetre apart and rises 14.9 mm (handbook).
    assert melt.meniscus_pressure(0.0728, 1e-3) / (998.0 * 9.807) == pytest.approx(14.9e-3, rel=0.005)


def test_a_strip_is_squeezed_as_long_as_reynolds_equation_says() -> None:
    force, viscosity, length, width, start, end = 0.5, 2825.0, 0.113, 14e-3, 1.1e-3, 1.0e-3

    def closing(_: float, h: np.ndarray) -> list[float]:
        # h^3 p'' = 12 eta h', p = 0 at both edges: solved on a grid for a unit speed, which the force scales.
        cells = 300
        step = width / cells
        matrix = np.diag(np.full(cells - 1, -2.0)) + np.diag(np.ones(cells - 2), 1) + np.diag(np.ones(cells - 2), -1)
        pressure = np.linalg.solve(matrix, np.full(cells - 1, -12.0 * viscosity / h[0] ** 3 * step**2))
        return [-force / (length * step * float(pressure.sum()))]

    def done(_: float, h: np.ndarray) -> float:
        return float(h[0]) - end

    done.terminal = True
    run = solve_ivp(closing, (0.0, 1e4), [start], events=done, rtol=1e-7, atol=1e-12)
    found = melt.squeeze_time(force, viscosity, length, width, end, start)
    assert found == pytest.approx(run.t_events[0][0], rel=1e-3)
