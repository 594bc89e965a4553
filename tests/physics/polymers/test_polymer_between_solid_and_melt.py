"""Polycaprolactone: melting curve, frozen modulus, and the one spectrum of every state between solid and melt."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.integrate import quad

from tvimdesign.base.record import Record
from tvimdesign.catalog import Catalog
from tvimdesign.device.core.impedance.joint_impedance import melt_modes
from tvimdesign.physics.polymers import polymer
from tvimdesign.physics.polymers.viscoelasticity import zero_shear_viscosity

Array = NDArray[np.float64]
CELSIUS, GAS = 273.15, 8.314462618
# Capa 6500 and 6800: 76.7 kJ/kg. Specific heats: the middles of 1.7-2.0 and 2.0-2.2 kJ/kg K.
MELTING = polymer.Melting(1850.0, 2100.0, 76.75e3, CELSIUS + 50.0, CELSIUS + 65.0, 500.0)
MODES = ((1.0, 2.0e5), (0.1, 3.0e5), (0.01, 5.0e5))
GRADES = ("pcl_50k", "pcl_80k")


def solid_of(record: Record) -> polymer.SolidModulus:
    names = ("flexural_modulus", "reference_temperature", "softening_slope", "softening_onset", "softening_width",
             "poissons_ratio")  # fmt: skip
    return polymer.SolidModulus(*(record.value(name) for name in names))


def modes_of(record: Record) -> list[tuple[float, float]]:
    return list(melt_modes(record))


def rheology_of(grade: str) -> polymer.Rheology:
    record = Catalog().record("polymers", grade)
    solid = [(row["relaxation_time"], row["relative_modulus"]) for row in record.table("solid_spectrum")]
    return polymer.Rheology(solid_of(record), solid, modes_of(record), 35e3, CELSIUS + 100.0)


@given(celsius=st.one_of(st.floats(-20.0, 40.0), st.floats(55.0, 60.0), st.floats(75.0, 180.0)))
def test_temperature_inverts_enthalpy_away_from_the_corners(celsius):
    enthalpy = polymer.enthalpy(CELSIUS + celsius, MELTING)
    assert polymer.temperature(enthalpy, MELTING) == pytest.approx(CELSIUS + celsius, abs=0.01)


@given(heat=st.floats(-2e5, 6e5))
def test_the_solid_fraction_is_that_of_the_curve(heat):
    temperature, fraction = polymer.temperature(heat, MELTING), polymer.solid_fraction(heat, MELTING)
    assert polymer.fraction_at(temperature, MELTING) == pytest.approx(fraction, abs=1e-5)


@pytest.mark.parametrize("celsius", [50.0, 65.0])
def test_the_solid_fraction_has_no_kink(celsius):
    step, places = 1e-3, CELSIUS + celsius + 0.25 * np.linspace(-1.0, 1.0, 51)
    slopes = (polymer.fraction_at(places + step, MELTING) - polymer.fraction_at(places - step, MELTING)) / (2.0 * step)
    assert np.max(np.abs(np.diff(slopes))) < 0.05 * np.max(np.abs(slopes))


@given(first=st.floats(-2e5, 6e5), second=st.floats(-2e5, 6e5))
def test_temperature_rises_and_the_solid_fraction_falls_with_enthalpy(first, second):
    low, high = sorted((first, second))
    assert polymer.temperature(low, MELTING) <= polymer.temperature(high, MELTING)
    assert polymer.solid_fraction(low, MELTING) >= polymer.solid_fraction(high, MELTING) - 1e-12


def test_heats_between_temperatures_by_hand():
    taken = polymer.enthalpy(CELSIUS + 65.0, MELTING) - polymer.enthalpy(CELSIUS + 50.0, MELTING)
    assert taken == pytest.approx(76.75e3 + 15.0 * 0.5 * (1850.0 + 2100.0), rel=1e-9)
    assert polymer.solid_fraction(polymer.enthalpy(CELSIUS + 57.5, MELTING), MELTING) == pytest.approx(0.5, abs=1e-6)
    taken = polymer.enthalpy(CELSIUS + 100.0, MELTING) - polymer.enthalpy(CELSIUS + 22.0, MELTING)
    assert taken == pytest.approx(231e3, rel=5e-3)
    assert MELTING.latent_heat / taken == pytest.approx(1.0 / 3.0, rel=0.02)
    assert polymer.enthalpy(CELSIUS, MELTING) == 0.0
    assert polymer.enthalpy(CELSIUS + 10.0, MELTING) == pytest.approx(18.5e3, rel=1e-12)
    for celsius, specific_heat in ((10.0, 1850.0), (120.0, 2100.0)):
        rise = polymer.enthalpy(CELSIUS + celsius + 1.0, MELTING) - polymer.enthalpy(CELSIUS + celsius, MELTING)
        assert rise == pytest.approx(specific_heat, rel=1e-9)


@pytest.mark.parametrize("frequency", [0.3, 3.0, 30.0, 300.0])
def test_maxwell_moduli_are_the_fourier_integral_of_the_relaxation_modulus(frequency):
    # Ferry, ch. 3: G' = w int G(t) sin(wt) dt, G'' = w int G(t) cos(wt) dt for a fluid.
    def relaxation(time: float) -> float:
        return sum(modulus / 1e5 * np.exp(-time / tau) for tau, modulus in MODES)

    kind = {"epsabs": 1e-9, "limlst": 500, "limit": 500}
    sine, _ = quad(relaxation, 0.0, np.inf, weight="sin", wvar=frequency, **kind)
    cosine, _ = quad(relaxation, 0.0, np.inf, weight="cos", wvar=frequency, **kind)
    moduli = polymer.maxwell_moduli(frequency, MODES)
    assert moduli == pytest.approx((1e5 * frequency * sine, 1e5 * frequency * cosine), rel=1e-5)


@pytest.mark.parametrize(("grade", "low", "high"), [("pcl_50k", 430.0, 661.0), ("pcl_80k", 1900.0, 4201.0)])
def test_slow_melt_flows_with_its_zero_shear_viscosity(grade, low, high):
    # Pa s at 100 degC, extrapolated from melts of 16.9-35.5 kg/mol with viscosity ~ M^3.9.
    record = Catalog().record("polymers", grade)
    modes = modes_of(record)
    storage, loss = polymer.maxwell_moduli(1e-4, modes)
    assert low <= loss / 1e-4 <= high
    assert loss / 1e-4 == pytest.approx(record.value("zero_shear_viscosity"), rel=1e-3)
    assert storage / 1e-8 == pytest.approx(sum(g * tau**2 for tau, g in modes), rel=1e-6)


def test_spectrum_of_a_melt_is_the_power_law_by_hand():
    """Two modes half a decade apart: t^-0.2 makes the faster one 10^0.1 = 1.2589 times as stiff."""
    (slow, soft), (fast, stiff) = polymer.melt_spectrum(1000.0, 1e6, 2)
    assert slow / fast == pytest.approx(3.16228, rel=1e-5)
    assert stiff / soft == pytest.approx(1.25893, rel=1e-5)
    assert soft + stiff == pytest.approx(1e6)
    assert soft * slow + stiff * fast == pytest.approx(1000.0)


def test_viscosity_moves_times_and_falls_as_arrhenius_says():
    thin, thicker, stiffer = (polymer.melt_spectrum(*how, 6) for how in ((1e3, 1e6), (1e2, 1e6), (1e3, 1e4)))
    for (time, modulus), (own_time, own_modulus), (longer, softer) in zip(thin, thicker, stiffer, strict=True):
        assert (own_time, own_modulus) == pytest.approx((0.1 * time, modulus))
        assert (longer, softer) == pytest.approx((100.0 * time, 0.01 * modulus))
    # 35 kJ/mol from 100 to 120 degC: exp(35000/8.3145 (1/393.15 - 1/373.15)) = exp(-0.57388) = 0.5633.
    assert polymer.arrhenius_shift(393.15, 373.15, 35e3) == pytest.approx(0.5633, rel=1e-3)
    assert polymer.arrhenius_shift(373.15, 373.15, 35e3) == 1.0


@pytest.mark.parametrize("grade", GRADES)
def test_fast_melt_is_a_rubber_of_its_plateau_modulus(grade):
    storage, loss = polymer.maxwell_moduli(1e9, modes_of(Catalog().record("polymers", grade)))
    assert storage == pytest.approx(0.95e6, rel=0.06)  # 0.9-1.0 MPa
    assert loss < 1e-2 * storage


@given(celsius=st.floats(70.0, 160.0))
def test_melt_at_another_temperature_is_the_melt_at_a_shifted_frequency(celsius):
    rheology = rheology_of("pcl_80k")
    viscosity = polymer.moduli(CELSIUS + celsius, 0.0, 1e-5, rheology)[1] / 1e-5
    reference = polymer.moduli(373.15, 0.0, 1e-5, rheology)[1] / 1e-5
    slope = np.log(viscosity / reference) / (1.0 / (CELSIUS + celsius) - 1.0 / 373.15) if celsius != 100.0 else 4209.6
    assert slope == pytest.approx(35e3 / 8.314462618, rel=1e-3)


SWEEP = np.geomspace(0.1, 628.0, 60)


@pytest.mark.parametrize("grade", GRADES)
def test_frozen_polymer_has_a_loss_factor_near_5_percent(grade):
    storage, loss = polymer.moduli(CELSIUS + 30.0, 1.0, SWEEP, rheology_of(grade))
    assert np.all(np.abs(loss / storage - 0.05) < 0.0035)
    # With a constant loss factor G' grows as w^(2 delta/pi): 0.0318 a unit of ln w.
    slope = np.polyfit(np.log(SWEEP), np.log(storage), 1)[0]
    assert slope == pytest.approx(2.0 / np.pi * np.arctan(0.05), rel=0.05)


@pytest.mark.parametrize("grade", GRADES)
@pytest.mark.parametrize("celsius", [-5.0, 23.0, 37.0, 50.0])
def test_frozen_polymer_at_1_hertz_has_the_data_sheets_modulus(grade, celsius):
    # 411 MPa at 23 degC, nu 0.45, and ln E falling by 0.09*5*ln(1 + exp((T - 42)/5)).
    fall = [0.45 * np.log1p(np.exp((at - 42.0) / 5.0)) for at in (23.0, celsius)]
    expected = 411e6 * np.exp(fall[0] - fall[1]) / 2.9
    storage, _ = polymer.moduli(CELSIUS + celsius, 1.0, 2.0 * np.pi, rheology_of(grade))
    assert storage == pytest.approx(expected, rel=1e-9)


def test_part_frozen_polymer_mixes_paired_modes_by_their_logarithms():
    # At the melt's reference and the solid's: a quarter solid is the geometric mean with weights 1/4 and 3/4.
    stiff = polymer.SolidModulus(2.9e8, 373.15, 0.09, 900.0, 5.0, 0.45)
    rheology = polymer.Rheology(stiff, [(1e12, 1.0)], [(1e-4, 1e4)], 35e3, 373.15)
    ((time, modulus),) = polymer.spectrum(373.15, 0.25, rheology)
    assert modulus == pytest.approx(1e5, rel=1e-9)  # 1e8 and 1e4 Pa
    assert time == pytest.approx(1.0, rel=1e-9)  # 1e12 and 1e-4 s


@given(celsius=st.floats(-20.0, 70.0), fraction=st.floats(-1e-3, 1.001), frequency=st.floats(1e-3, 1e4))
def test_every_state_is_passive_and_stiffer_the_more_is_frozen(celsius, fraction, frequency):
    rheology = rheology_of("pcl_80k")
    assert all(tau > 0.0 and g > 0.0 for tau, g in polymer.spectrum(CELSIUS + celsius, fraction, rheology))
    storage, loss = polymer.moduli(CELSIUS + celsius, fraction, frequency, rheology)
    assert storage > 0.0
    assert loss > 0.0
    more, _ = polymer.moduli(CELSIUS + celsius, fraction + 0.01, frequency, rheology)
    assert more > storage


def test_memory_multiplies_viscosity_and_activation_energy_by_ten_at_most():
    # Sangroniz et al., Eur. Polym. J. (2018) 495: viscosity and flow activation energy of self-nucleated melts of
    # polycaprolactone are up to an order of magnitude above those of equilibrated ones.
    plain = rheology_of("pcl_80k")
    marked = plain._replace(memory=polymer.MeltMemory(10.0, CELSIUS + 68.0, 3.0, 5.0))

    def viscosity(celsius: Array, rheology: polymer.Rheology) -> Array:
        return np.array([zero_shear_viscosity(polymer.spectrum(CELSIUS + t, 0.0, rheology)) for t in celsius])

    celsius = np.linspace(60.0, 120.0, 241)
    risen = viscosity(celsius, marked) / viscosity(celsius, marked.equilibrated)
    assert risen[0] == pytest.approx(10.0, rel=0.01)
    assert np.all(np.diff(risen) < 0.0)
    assert risen[-1] == pytest.approx(1.0, abs=1e-3)
    energy = GAS * np.gradient(np.log(viscosity(celsius, marked)), 1.0 / (CELSIUS + celsius))
    assert 150e3 < np.max(energy) < 350e3  # 35 kJ/mol without
    five_minutes = marked._replace(memory=marked.memory._replace(time=300.0))
    at_half = np.array([68.0])
    assert viscosity(at_half, five_minutes) == pytest.approx(10.0**0.5 * viscosity(at_half, plain), rel=1e-12)


def test_five_percent_of_the_modulus_are_gone_at_the_linear_limit():
    limits = polymer.LinearRange(solid=0.003, melt=0.3)
    assert polymer.damping_function(0.003, polymer.linear_strain(1.0, limits)) == pytest.approx(0.95, rel=1e-12)
    assert polymer.damping_function(0.3, polymer.linear_strain(0.0, limits)) == pytest.approx(0.95, rel=1e-12)
    assert polymer.linear_strain(0.5, limits) == pytest.approx(0.03, rel=1e-12)  # the geometric mean
    # Soskey and Winter: far beyond the limit the modulus falls with the square of the strain.
    assert polymer.damping_function(300.0, 0.3) / polymer.damping_function(30.0, 0.3) == pytest.approx(0.01, rel=3e-3)
