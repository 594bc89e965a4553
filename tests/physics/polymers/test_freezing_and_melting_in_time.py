"""Polymers freeze and melt in time; their melts beyond small strains."""

from itertools import pairwise

import numpy as np
import pytest
import textbook
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.integrate import quad, solve_ivp

from tvimdesign.catalog import Catalog
from tvimdesign.physics.polymers import melt, polymer, transitions
from tvimdesign.simulation.working_cycle.symbols import ca

Array = NDArray[np.float64]
CELSIUS = 273.15
GRADES = ("pcl_50k", "pcl_80k")
MELTING = polymer.Melting(1850.0, 2100.0, 76.75e3, CELSIUS + 50.0, CELSIUS + 65.0, 500.0)


def kinetics_of(grade: str) -> transitions.Kinetics:
    return textbook.kinetics_of(Catalog().record("polymers", grade))


PCL = kinetics_of("pcl_80k")


def calorimeter(rate: float, kinetics: transitions.Kinetics) -> tuple[Array, Array]:
    """Celsius and solid fraction of a melt cooled from 100 degC at a constant rate [K/min]."""
    per_second = rate / 60.0
    times = np.linspace(0.0, 110.0 / per_second, 20001)
    solved = solve_ivp(
        lambda t, psi: transitions.rate(CELSIUS + 100.0 - per_second * t, psi, kinetics, MELTING),
        (0.0, times[-1]), [0.0], method="LSODA", t_eval=times, rtol=1e-9, atol=1e-11,
    )  # fmt: skip
    return 100.0 - per_second * times, transitions.solid_fraction(solved.y[0], kinetics)


def peak(rate: float, kinetics: transitions.Kinetics) -> float:
    celsius, fraction = calorimeter(rate, kinetics)
    return float(celsius[np.argmax(np.gradient(fraction))])


@pytest.mark.parametrize("grade", GRADES)
@pytest.mark.parametrize("rate", [1.0, 2.0])
def test_cooled_at_1_to_2_kelvin_a_minute_it_freezes_at_35_to_45_degrees(grade, rate):
    assert 35.0 <= peak(rate, kinetics_of(grade)) <= 45.0


@pytest.mark.parametrize("grade", GRADES)
def test_half_freezes_in_1_to_3_minutes_at_40_degrees(grade):
    assert 60.0 <= textbook.half_time(CELSIUS + 40.0, kinetics_of(grade)) <= 180.0


def test_eva_freezes_where_published_peaks_have_it():
    # BASF, TI/ES 1474 e: 80 to 88 degC at 13 to 15 % vinyl acetate; 2.08 K less for each per cent more.
    record = Catalog().record("polymers", "eva_28")
    assert peak(10.0, kinetics_of("eva_28")) == pytest.approx(84.0 - 14.0 * 2.08, abs=3.0)
    assert record.value("melting_end") - CELSIUS == pytest.approx(95.5 - 14.0 * 1.36, abs=3.0)


@pytest.mark.parametrize("celsius", [25.0, 32.0, 40.0, 45.0])
@pytest.mark.parametrize("exponent", [2.5, 3.0])
def test_avrami_plot_of_a_quenched_melt_is_straight_with_slope_n(celsius, exponent):
    kinetics = PCL._replace(avrami_exponent=exponent)
    half = float(textbook.half_time(CELSIUS + celsius, kinetics))
    times = half * np.array([0.2, 0.4, 0.7, 1.0, 1.3])
    solved = solve_ivp(
        lambda _, psi: transitions.rate(CELSIUS + celsius, psi, kinetics, MELTING),
        (0.0, times[-1]), [0.0], t_eval=times, rtol=1e-10, atol=1e-12,
    )  # fmt: skip
    fraction = transitions.solid_fraction(solved.y[0], kinetics)
    assert fraction[3] == pytest.approx(0.5, abs=1e-3)
    slopes = np.diff(np.log(-np.log(1.0 - fraction))) / np.diff(np.log(times))
    assert slopes == pytest.approx(np.full(4, exponent), rel=5e-3)


@pytest.mark.parametrize("rate", [1.0, 5.0, 10.0])
def test_cooling_at_a_constant_rate_is_ozawas_integral_over_temperature(rate):
    # Ozawa, Polymer 12 (1971) 150: X = 1 - exp(-(chi(T)/rate^n)), chi^(1/n) = integral of K over temperature. The
    # half-time stands here once more, from the handbook: U 1500 cal/mol, T_inf 30 K below the glass transition.
    def slowness(kelvin: float) -> float:
        nucleation = PCL.nucleation_constant * (kelvin + 347.15) / (2.0 * kelvin**2 * (347.15 - kelvin))
        return 1500.0 * 4.18 / (8.314462618 * (kelvin - 183.15)) + nucleation

    def constant(kelvin: float) -> float:
        return np.log(2.0) ** (1.0 / 3.0) / 70.0 * np.exp(slowness(308.15) - slowness(kelvin))

    celsius, fraction = calorimeter(rate, PCL)
    for share in (0.1, 0.5, 0.9):
        at = int(np.argmax(fraction >= share))
        integral, _ = quad(constant, CELSIUS + celsius[at], 347.149, epsabs=1e-12, limit=200)
        assert fraction[at] == pytest.approx(1.0 - np.exp(-((60.0 * integral / rate) ** 3)), abs=1e-3)


def test_freezing_is_fastest_in_between_and_at_slower_cooling_warmer():
    kelvin = np.linspace(230.0, 345.0, 400)
    fastest = float(kelvin[np.argmin(textbook.half_time(kelvin, PCL))])
    assert 0.70 < fastest / PCL.equilibrium_melting < 0.92  # as a rule 0.8-0.9 of T_m0
    assert np.all(np.diff(textbook.half_time(np.linspace(303.0, 345.0, 50), PCL)) > 0.0)
    peaks = [peak(rate, PCL) for rate in (0.5, 2.0, 10.0, 20.0)]
    assert all(hotter > colder + 3.0 for hotter, colder in pairwise(peaks))


@given(celsius=st.floats(74.5, 200.0))
def test_nothing_freezes_above_the_equilibrium_melting_temperature(celsius):
    assert 0.0 <= transitions.rate_constant(CELSIUS + celsius, PCL) < 1e-30
    assert 1e30 < textbook.half_time(CELSIUS + celsius, PCL) < np.inf
    times = (0.0, 600.0)
    solved = solve_ivp(lambda _, psi: transitions.rate(CELSIUS + celsius, psi, PCL, MELTING), times, [0.0])
    assert transitions.solid_fraction(solved.y[0, -1], PCL) < 1e-6


@pytest.mark.parametrize("begin", [-0.01, 0.0, 0.05])
def test_a_melt_without_a_crystal_is_no_stuck_point(begin):
    psi = float(transitions.extended(begin, PCL))
    solved = solve_ivp(lambda _, y: transitions.rate(CELSIUS + 35.0, y, PCL, MELTING), (0.0, 600.0), [psi])
    assert transitions.solid_fraction(solved.y[0, -1], PCL) > 0.99


@given(fraction=st.floats(0.01, 0.999))
def test_psi_of_a_solid_fraction_gives_it_back(fraction):
    psi = transitions.extended(fraction, PCL)
    assert psi == pytest.approx((-np.log(1.0 - fraction)) ** (1.0 / 3.0), rel=5e-3)
    assert transitions.solid_fraction(psi, PCL) == pytest.approx(fraction, abs=1e-4)


def test_part_molten_polymer_goes_on_and_its_psi_is_finite():
    assert transitions.extended(0.0, PCL) == pytest.approx(0.0, abs=1e-5)
    assert transitions.extended(-0.02, PCL) == pytest.approx(0.0, abs=0.3)
    assert transitions.extended(1.0, PCL) == pytest.approx(np.log(1e4) ** (1.0 / 3.0), rel=0.01)
    assert transitions.extended(1.02, PCL) == pytest.approx(np.log(1e4) ** (1.0 / 3.0), rel=0.01)
    assert transitions.solid_fraction(-0.05, PCL) == pytest.approx(0.0, abs=1e-12)
    psi = float(transitions.extended(0.5, PCL))
    assert transitions.rate(CELSIUS + 35.0, psi, PCL, MELTING) > 1e-3
    assert transitions.rate(CELSIUS + 62.0, psi, PCL, MELTING) < -0.1


@pytest.mark.parametrize("speed", [0.1, 1.0])
def test_heated_solid_melts_half_a_second_behind_equilibrium(speed):
    # Equilibrium: straight from all solid at 50 degC to none at 65 degC. The lag is the melting time times the speed.
    start = CELSIUS + 48.0
    times = np.linspace(0.0, 20.0 / speed, 401)
    psi = float(transitions.extended(1.0, PCL))
    solved = solve_ivp(
        lambda t, y: transitions.rate(start + speed * t, y, PCL, MELTING), (0.0, times[-1]), [psi],
        method="LSODA", t_eval=times, rtol=1e-9, atol=1e-11,
    )  # fmt: skip
    fraction = transitions.solid_fraction(solved.y[0], PCL)
    inside = (fraction > 0.1) & (fraction < 0.9)
    lag = 48.0 + speed * times[inside] - (65.0 - 15.0 * fraction[inside])
    assert np.all(np.abs(lag) < 0.5 * speed + 0.05)
    assert np.mean(lag) == pytest.approx(0.5 * speed, abs=0.05)


@given(celsius=st.floats(-20.0, 200.0), fraction=st.floats(0.0, 1.0))
def test_temperature_is_the_enthalpy_solved_for_it(celsius, fraction):
    enthalpy = transitions.enthalpy(CELSIUS + celsius, fraction, MELTING)
    assert transitions.temperature(enthalpy, fraction, MELTING) == pytest.approx(CELSIUS + celsius, abs=1e-9)


def test_heats_follow_kirchhoffs_law_and_the_melting_curve():
    # 76.75 kJ/kg and half the window's sensible heat difference at 57.5 degC; d L/dT = c_melt - c_solid = 250 J/kg K.
    def latent(celsius: float) -> float:
        return transitions.enthalpy(CELSIUS + celsius, 0.0, MELTING) - transitions.enthalpy(
            CELSIUS + celsius, 1.0, MELTING
        )

    assert latent(57.5) == pytest.approx(76.75e3, rel=1e-9)
    assert latent(27.5) == pytest.approx(76.75e3 - 30.0 * 250.0, rel=1e-9)
    for celsius, fraction in ((20.0, 1.0), (49.9, 1.0), (65.1, 0.0), (120.0, 0.0)):
        enthalpy = transitions.enthalpy(CELSIUS + celsius, fraction, MELTING)
        assert enthalpy == pytest.approx(polymer.enthalpy(CELSIUS + celsius, MELTING), rel=1e-12)


def test_symbols_give_numbers_with_finite_derivatives():
    kelvin, psi = ca.SX.sym("T"), ca.SX.sym("psi")
    both = ca.vertcat(kelvin, psi)
    value = transitions.rate(kelvin, psi, PCL, MELTING)
    fraction = transitions.solid_fraction(psi, PCL)
    handover = transitions.extended(psi / 2.0, PCL)
    first = [ca.gradient(of, both) for of in (value, fraction, handover)]
    second = [ca.hessian(of, both)[0] for of in (value, fraction, handover)]
    look = ca.Function("look", [both], [value, fraction, ca.vertcat(*first), ca.vertcat(*second)])
    for t in np.linspace(250.0, 480.0, 93):
        for p in (-0.05, 0.0, 1e-3, 0.5, 1.0, 2.0, 2.1, 2.3):
            numbers = [np.asarray(part).ravel() for part in look([t, p])]
            assert numbers[0][0] == pytest.approx(transitions.rate(t, p, PCL, MELTING), rel=1e-9, abs=1e-300)
            assert numbers[1][0] == pytest.approx(transitions.solid_fraction(p, PCL), rel=1e-12, abs=1e-15)
            assert np.all(np.isfinite(np.concatenate(numbers)))


LIMIT = 0.3
MELT = polymer.melt_spectrum(4200.0, 0.95e6, 6)


def damping_function(strain: np.ndarray | float) -> np.ndarray | float:
    """Share of the modulus after a step, 5 % less at 30 % of strain: written out once more."""
    return 1.0 / (1.0 + (strain / 0.3) ** 2 / 19.0)


def by_brute_force(strain: float, angular: float) -> tuple[float, float]:
    """First harmonics over the amplitude of Wagner's stress, 48 phases, 300 points of the past in each mode."""
    phases = np.arange(48) * 2.0 * np.pi / 48
    nodes, weights = np.polynomial.legendre.leggauss(300)
    ages, stress = 15.0 * (nodes + 1.0), np.zeros(48)
    for time, modulus in MELT:
        relative = strain * (np.sin(phases)[:, None] - np.sin(phases[:, None] - angular * time * ages))
        stress += modulus * np.sum(15.0 * weights * np.exp(-ages) * damping_function(relative) * relative, axis=1)
    return 2.0 / 48 * float(stress @ np.sin(phases)) / strain, 2.0 / 48 * float(stress @ np.cos(phases)) / strain


@pytest.mark.parametrize("hertz", [0.1, 1.0, 5.0, 20.0])
@pytest.mark.parametrize("strain", [0.3, 1.0, 4.13])
def test_moduli_are_the_first_harmonics_of_wagners_integral(strain, hertz):
    angular = 2.0 * np.pi * hertz
    moduli = melt.wagner_moduli(strain, angular, MELT, LIMIT)
    assert moduli == pytest.approx(by_brute_force(strain, angular), rel=2e-3)


def test_slow_or_small_motion_is_linear():
    linear = polymer.maxwell_moduli(0.01, MELT)
    assert melt.wagner_moduli(4.0, 0.01, MELT, LIMIT) == pytest.approx(linear, rel=1e-3)
    assert melt.unrelaxed_moduli(4.0, 0.01, MELT, LIMIT)[1] < 0.1 * linear[1]
    moduli = melt.wagner_moduli(1e-4, 600.0, MELT, LIMIT)
    assert moduli == pytest.approx(polymer.maxwell_moduli(600.0, MELT), rel=1e-6)


@given(strain=st.floats(0.01, 10.0), hertz=st.floats(0.05, 20.0))
def test_strain_only_softens_and_never_below_none(strain, hertz):
    angular = 2.0 * np.pi * hertz
    linear = polymer.maxwell_moduli(angular, MELT)
    for modulus, most in zip(melt.wagner_moduli(strain, angular, MELT, LIMIT), linear, strict=True):
        assert 0.0 < modulus <= most * (1.0 + 1e-9)


@pytest.mark.parametrize("strain", [1e-5, 0.3, 3.0])
def test_softening_is_the_first_harmonic_of_the_strain_law(strain):
    share, _ = quad(lambda p: damping_function(strain * np.cos(p)) * np.cos(p) ** 2 / np.pi, 0.0, 2.0 * np.pi)
    assert melt.softening(strain, LIMIT) == pytest.approx(1.0 - share, rel=1e-6, abs=1e-12)


def test_a_ring_s_torque_and_an_edge_that_gives():
    inner, rim = 0.6, 4.0
    share, _ = quad(lambda r: damping_function(rim * r) * r**3, inner, 1.0)
    whole, _ = quad(lambda r: r**3, inner, 1.0)
    nodes = melt.ring(inner)
    assert sum(weight for _, weight in nodes) == pytest.approx(1.0, rel=1e-12)
    assert sum(w * float(damping_function(rim * reach)) for reach, w in nodes) == pytest.approx(share / whole, rel=1e-4)
    # 2 0.035/(3 1 mm) = 23.3 Pa; a fifth of 1 kPa times the strain squared passes it at 34 %.
    strain = melt.edge_strain(1e-3, 0.035, 0.2, 1000.0)
    assert 0.2 * 1000.0 * strain**2 == pytest.approx(23.333, rel=1e-3)
    assert strain == pytest.approx(0.3416, rel=1e-3)


def test_symbols_give_the_numbers_with_finite_derivatives():
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


def test_gaps_pass_flow_as_stokes_says_and_surfaces_hold_what_they_lift():
    expected = profile_mean(1.05e4, 1e-3, 2825.0)
    assert melt.gap_speed(1.05e4, 1e-3, 2825.0) == pytest.approx(expected, rel=1e-4)
    length, gap, lip, narrow, viscosity, pressure = 14e-3, 1e-3, 1.5e-3, 0.4e-3, 2825.0, 150.0
    speed = melt.gap_speed(pressure / melt.gaps_in_series(length, gap, lip, narrow), gap, viscosity)
    inside = 12.0 * viscosity * speed / gap**2 * length
    below = 12.0 * viscosity * (speed * gap / narrow) / narrow**2 * lip  # the same volume through a narrower gap
    assert inside + below == pytest.approx(pressure, rel=1e-12)
    # Water at 20 degC, 72.8 mN/m and 998 kg/m3, wets glass plates a millimetre apart and rises 14.9 mm (handbook).
    assert melt.meniscus_pressure(0.0728, 1e-3) / (998.0 * 9.807) == pytest.approx(14.9e-3, rel=0.005)


def test_a_strip_is_squeezed_as_long_as_reynolds_equation_says():
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
    time = melt.squeeze_time(force, viscosity, length, width, end, start)
    assert time == pytest.approx(run.t_events[0][0], rel=1e-3)
