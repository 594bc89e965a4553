"""One spectrum in every test, across its glass transition, and where its times shorten with stress."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from tvimdesign.catalog import Catalog
from tvimdesign.device.core.impedance.joint_impedance import solid_modes
from tvimdesign.physics.polymers import polymer, transitions, viscoelasticity
from tvimdesign.physics.polymers.polymer import PINNED_FREQUENCY, maxwell_moduli
from tvimdesign.physics.polymers.viscoelasticity import creep_compliance, relaxation_modulus, retardation

Modes = list[tuple[float, float]]
MELT = [(2.07e-2, 8.25e4), (6.5e-3, 1.04e5), (2.07e-3, 1.31e5), (6.5e-4, 1.65e5), (2.07e-4, 2.07e5), (6.5e-5, 2.61e5)]
SOLID = [(1e10, 1.2e8), (10.0, 1.0e7), (1.0, 9.5e6), (0.1, 1.05e7), (1e-2, 1.08e7), (1e-3, 1.46e7)]
BETWEEN = [(math.sqrt(a * c), math.sqrt(b * d)) for (a, b), (c, d) in zip(MELT, SOLID, strict=True)]
NAMED = pytest.mark.parametrize("modes", [MELT, SOLID, BETWEEN], ids=["melt", "solid", "between"])
SPECTRA = st.lists(
    st.tuples(st.floats(-5.0, 10.0), st.floats(3.0, 9.0)),
    min_size=1,
    max_size=7,
    unique_by=lambda pair: round(pair[0], 1),
).map(lambda pairs: [(10.0**time, 10.0**modulus) for time, modulus in pairs])


def inverse_laplace_identity(modes: Modes, s: complex) -> complex:
    """Q(s) of the relaxation spectrum times 1/Q(s) of the retardation spectrum, which is one."""
    response = retardation(modes)
    stiff = sum(g * s * tau / (1.0 + s * tau) for tau, g in modes)
    soft = response.instant_compliance + sum(j / (1.0 + s * lag) for lag, j in response.modes)
    return stiff * (soft + 1.0 / (s * response.viscosity))


@given(modes=SPECTRA, exponent=st.floats(-10.0, 6.0))
def test_complex_compliance_is_one_over_the_complex_modulus(modes, exponent):
    assert inverse_laplace_identity(modes, 1j * 10.0**exponent) == pytest.approx(1.0, rel=1e-6)


@given(modes=SPECTRA)
def test_times_of_retardation_lie_between_those_of_relaxation(modes):
    response = retardation(modes)
    relaxing, retarding = sorted(tau for tau, _ in modes), sorted(lag for lag, _ in response.modes)
    assert len(retarding) == len(relaxing) - 1
    for short, lag, long in zip(relaxing, retarding, relaxing[1:], strict=False):
        assert short * (1.0 - 1e-9) <= lag <= long * (1.0 + 1e-9)
    assert all(compliance > 0.0 for _, compliance in response.modes)


@NAMED
@pytest.mark.parametrize("time", [1e-3, 0.3, 40.0])
def test_creep_and_relaxation_convolve_to_the_time(modes, time):
    # Ferry, ch. 3: int G(t - s) J(s) ds = t.
    response = retardation(modes)

    def product(s: float) -> float:
        return float(relaxation_modulus(time - s, modes) * creep_compliance(s, response))

    near = [time * (1.0 - 10.0**-k) for k in range(1, 9) if 10.0**-k < 0.5]
    edges = sorted({0.0, *(time * 10.0**-k for k in range(9)), *near, time})
    whole = sum(quad(product, a, b, epsabs=0.0, epsrel=1e-9, limit=200)[0] for a, b in pairwise(edges))
    assert whole == pytest.approx(time, rel=1e-6)


def test_one_mode_creeps_as_textbook_bodies_do():
    # J = 1/G + t/(G tau).
    response = retardation([(2.0, 5.0)])
    assert response.modes == ()
    assert creep_compliance(3.0, response) == pytest.approx(0.2 + 0.3, rel=1e-12)
    # Findley, ch. 5: J = 1/R - (1/R - 1/(R + G)) exp(-t R/((R + G) tau)), here R = 2, G = 6, tau = 0.5.
    response = retardation([(1e14, 2.0), (0.5, 6.0)])
    for time in (0.0, 0.4, 3.0, 100.0):
        expected = 0.5 - (0.5 - 0.125) * math.exp(-time * 2.0 / (8.0 * 0.5))
        assert creep_compliance(time, response) == pytest.approx(expected, rel=1e-9)
    together, apart = retardation([(1.0, 5.0), (0.1, 7.0)]), retardation([(1.0, 2.0), (0.1, 7.0), (1.0, 3.0)])
    assert np.allclose(together.modes, apart.modes, rtol=1e-12)
    assert together.viscosity == pytest.approx(apart.viscosity)


@NAMED
def test_strain_is_what_the_internal_equations_integrate_to(modes):
    # Modes in parallel: e_m' = gamma' - e_m/tau_m and sum G_m e_m = sigma, sigma constant, then none.
    taus, moduli = np.array(modes).T

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        elastic = state[:-1]
        flow = np.sum(moduli * elastic / taus) / np.sum(moduli)
        return np.append(flow - elastic / taus, flow)

    jump = 50.0 / np.sum(moduli)
    loaded = solve_ivp(rates, (0.0, 30.0), np.full(len(modes) + 1, jump), "Radau", rtol=1e-9, atol=1e-20)
    assert loaded.success
    after = solve_ivp(rates, (0.0, 60.0), loaded.y[:, -1] - jump, "Radau", rtol=1e-9, atol=1e-20)
    assert after.success
    strains = viscoelasticity.creep_and_recovery(np.array([30.0 - 1e-9, 90.0]), 50.0, 30.0, retardation(modes))
    assert strains[0] == pytest.approx(loaded.y[-1, -1], rel=1e-6)
    assert strains[1] == pytest.approx(after.y[-1, -1], rel=1e-3, abs=1e-7 * loaded.y[-1, -1])


@NAMED
def test_storage_and_loss_obey_kramers_and_kronig(modes):
    # G''(w) = -(2 w/pi) P int (G'(x) - G'(w))/(x^2 - w^2) dx (Tschoegl);
    # in ln x, the pole taken out by symmetry.
    for omega in (0.5, 20.0):

        def pair(y: float, omega: float = omega) -> float:
            above, _ = maxwell_moduli(omega * math.exp(y), modes)
            below, _ = maxwell_moduli(omega * math.exp(-y), modes)
            return float((above - below) / (2.0 * math.sinh(y)))

        edges = [1e-9, 0.1, 1.0, 3.0, 6.0, 10.0, 15.0, 25.0, 40.0]
        integral = sum(quad(pair, a, b, epsrel=1e-9, limit=200)[0] for a, b in pairwise(edges))
        _, loss = maxwell_moduli(omega, modes)
        assert 2.0 / math.pi * integral == pytest.approx(loss, rel=1e-5)


@NAMED
def test_start_up_adds_the_relaxation_modulus_up_and_ends_at_the_viscosity(modes):
    for time in (1e-3, 0.2):
        edges = [0.0, *(time * 10.0**-k for k in range(6, -1, -1))]
        summed = sum(quad(relaxation_modulus, a, b, args=(modes,), epsabs=0.0)[0] for a, b in pairwise(edges))
        assert viscoelasticity.start_up_viscosity(time, modes) == pytest.approx(summed, rel=1e-8)
    end = viscoelasticity.start_up_viscosity(1e12, modes)
    assert end == pytest.approx(viscoelasticity.zero_shear_viscosity(modes), rel=1e-9)
    assert end == pytest.approx(sum(tau * g for tau, g in modes), rel=1e-9)


def test_a_slow_melt_flows_with_its_viscosity_and_keeps_a_tiny_stress():
    viscosity = viscoelasticity.zero_shear_viscosity(MELT)
    assert viscoelasticity.complex_viscosity(1e-3, MELT) == pytest.approx(viscosity, rel=1e-6)
    assert retardation(MELT).viscosity == pytest.approx(viscosity, rel=1e-12)
    assert viscoelasticity.loss_factor(1e-3, MELT) > 1e3
    # One mode by hand: s' = G g' - s/tau gives G g' tau (1 - exp(-t_r/tau)) at the end of the rise, fading from there.
    by_hand = 1e5 * (0.1 / 0.1) * 0.02 * (1.0 - math.exp(-5.0)) * math.exp(-0.9 / 0.02)
    assert viscoelasticity.ramped_stress(1.0, 0.1, 0.1, [(0.02, 1e5)]) == pytest.approx(by_hand, rel=1e-9, abs=0.0)


CELSIUS = 273.15
TRANSITION = transitions.GlassTransition(CELSIUS + 60.0, 17.44, 51.6, 300e3)


def pla() -> transitions.Glass:
    record = Catalog().record("polymers", "pla")
    names = ("glass_transition", "wlf_c1", "wlf_c2", "glass_activation_energy")
    transition = transitions.GlassTransition(*(record.value(name) for name in names))
    return transitions.Glass(1e9, record.value("reference_temperature"), transition, solid_modes(record))


@pytest.mark.parametrize(
    ("above", "decades"),
    [(10.0, -2.8312), (20.0, -4.8715), (40.0, -7.6157)],  # 17.44 dT/(51.6 + dT) by hand
)
def test_above_the_transition_times_shift_by_wlf(above, decades):
    shifted = np.log10(transitions.shift(TRANSITION.temperature + above, TRANSITION))
    assert shifted == pytest.approx(decades, abs=0.01)


def test_below_the_transition_times_shift_by_arrhenius_round_the_corner():
    # 300 kJ/mol, 60 and 20 degC: 300000/8.314463 (1/293.15 - 1/333.15)/ln 10 = 6.4182 decades, by hand.
    assert np.log10(transitions.shift(CELSIUS + 20.0, TRANSITION)) == pytest.approx(6.4182, abs=0.01)
    around = np.log10(transitions.shift(TRANSITION.temperature + np.linspace(-3.0, 3.0, 241), TRANSITION))
    assert np.all(np.diff(around) < 0.0)
    # The WLF law has 0.338 decades a kelvin there, the Arrhenius law 0.141: half of a kelvin off at most.
    assert abs(around[120]) < 0.5 * 0.34


def test_a_glass_has_its_reference_modulus_whatever_is_frozen():
    glass = pla()
    at = polymer.maxwell_moduli(PINNED_FREQUENCY, glass.at(glass.reference_temperature))
    assert at[0] == pytest.approx(1e9, rel=1e-12)
    rubber = polymer.moduli(CELSIUS + 110.0, 0.0, PINNED_FREQUENCY, glass)[0]
    assert rubber == pytest.approx(1e9 * 1.2 / 1045.7, rel=0.02)
    assert polymer.spectrum(CELSIUS + 60.0, 0.0, pla()) == polymer.spectrum(CELSIUS + 60.0, 1.0, pla())


def test_slower_at_a_warmer_place_is_the_same():
    """Time-temperature superposition: a faster test stands for a colder one."""
    glass = pla()
    colder, warmer = CELSIUS + 65.0, CELSIUS + 70.0
    faster = transitions.shift(colder, glass.transition) / transitions.shift(warmer, glass.transition)
    cold = polymer.maxwell_moduli(1.0, glass.at(colder))
    warm = polymer.maxwell_moduli(faster, glass.at(warmer))
    assert warm == pytest.approx(cold, rel=1e-9)


MODES = [(1e-2, 4e7), (1.0, 3e7), (1e2, 3e7), (1e6, 5e7)]
TAU_0 = 0.6e6


def test_small_strains_relax_as_in_the_linear_spectrum():
    time = np.geomspace(1e-3, 1e3, 31)
    stress = viscoelasticity.stress_of_a_ramp(time, 1e-5, 0.1, MODES, TAU_0)
    assert stress == pytest.approx(viscoelasticity.ramped_stress(time, 1e-5, 0.1, MODES), rel=1e-4)


def test_one_mode_relaxes_as_guiu_and_pratt_integrated_it():
    # d tau/dt = -(tau_0/t_1) sinh(tau/tau_0): tanh(tau/2 tau_0) = tanh(tau_s/2 tau_0) exp(-t/t_1).
    # Source: Guiu and Pratt, Phys. Stat. Sol. 6 (1964) 111 (stress relaxation by an activated flow).
    relaxation_time, modulus, rise = 1e6, 1e8, 1e-6
    time = np.geomspace(1e-3, 1e6, 19)
    stress = viscoelasticity.stress_of_a_ramp(time, 0.05, rise, [(relaxation_time, modulus)], TAU_0)
    start = 0.05 * modulus / TAU_0
    tanh = math.tanh(0.5 * start) * np.exp(-(time - rise) / relaxation_time)
    # Near one the hyperbolic tangent keeps no digits: its complement is 2/(exp(x) + 1).
    complement = 2.0 / (math.exp(start) + 1.0) - np.expm1(-(time - rise) / relaxation_time) * math.tanh(0.5 * start)
    assert stress == pytest.approx(TAU_0 * np.log((1.0 + tanh) / complement), rel=2e-3)


@pytest.mark.parametrize("rate", [1e-3, 1.0])
def test_a_constant_rate_comes_to_its_yield_stress(rate):
    end = 3.0 / rate
    stress = viscoelasticity.stress_of_a_ramp(np.array([end]), 3.0, end, MODES, TAU_0)
    assert stress[0] == pytest.approx(viscoelasticity.yield_stress(rate, TAU_0, MODES), rel=1e-4)
    # A decade of rate adds tau_0 ln(10), as Eyring's law has it far above tau_0.
    faster = viscoelasticity.yield_stress(10.0 * rate, TAU_0, MODES)
    assert faster - stress[0] == pytest.approx(TAU_0 * math.log(10.0), rel=1e-3)


def test_the_activation_stress_gives_back_the_strength_it_is_for():
    tau_0 = viscoelasticity.activation_stress(9.2e6, MODES)
    assert viscoelasticity.yield_stress(viscoelasticity.SHEET_RATE, tau_0, MODES) == pytest.approx(9.2e6)
    with pytest.raises(ValueError, match="below its yield strength"):
        viscoelasticity.activation_stress(9.2e6, [(1.0, 1e6)])
