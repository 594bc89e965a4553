"""Polycaprolactone: melting curve, frozen modulus, and the melt's spectrum against its own Fourier integral."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from tvimdesign.catalog import Catalog, Record
from tvimdesign.physics import polymer

CELSIUS = 273.15
# Capa 6500 and 6800: 76.7 kJ/kg. Specific heats: the middles of 1.7-2.0 and 2.0-2.2 kJ/kg K.
MELTING = polymer.Melting(1850.0, 2100.0, 76.75e3, CELSIUS + 50.0, CELSIUS + 65.0, 500.0)
MODES = ((1.0, 2.0e5), (0.1, 3.0e5), (0.01, 5.0e5))
GRADES = ("pcl_50k", "pcl_80k")


def solid_of(record: Record) -> polymer.SolidModulus:
    names = ("flexural_modulus", "reference_temperature", "softening_slope", "softening_onset", "softening_width",
             "poissons_ratio", "solid_loss_factor")  # fmt: skip
    return polymer.SolidModulus(*(record.value(name) for name in names))


def modes_of(record: Record) -> list[tuple[float, float]]:
    return [(row["relaxation_time"], row["modulus"]) for row in record.table("melt_spectrum")]


@given(celsius=st.one_of(st.floats(-20.0, 40.0), st.floats(55.0, 60.0), st.floats(75.0, 180.0)))
def test_temperature_inverts_enthalpy_away_from_the_corners(celsius: float) -> None:
    enthalpy = polymer.enthalpy(CELSIUS + celsius, MELTING)
    assert polymer.temperature(enthalpy, MELTING) == pytest.approx(CELSIUS + celsius, abs=0.01)


def test_sharp_corners_are_the_limit_of_rounded_ones() -> None:
    sharp = MELTING._replace(smoothing=1e-3)
    for celsius in (49.9, 50.1, 64.9, 65.1):
        enthalpy = polymer.enthalpy(CELSIUS + celsius, sharp)
        assert polymer.temperature(enthalpy, sharp) == pytest.approx(CELSIUS + celsius, abs=1e-6)


@given(first=st.floats(-2e5, 6e5), second=st.floats(-2e5, 6e5))
def test_temperature_rises_and_the_solid_fraction_falls_with_enthalpy(first: float, second: float) -> None:
    low, high = sorted((first, second))
    assert polymer.temperature(low, MELTING) <= polymer.temperature(high, MELTING)
    assert polymer.solid_fraction(low, MELTING) >= polymer.solid_fraction(high, MELTING) - 1e-12


def test_heat_between_50_and_65_degrees_is_the_latent_heat_and_the_mean_sensible_heat() -> None:
    taken = polymer.enthalpy(CELSIUS + 65.0, MELTING) - polymer.enthalpy(CELSIUS + 50.0, MELTING)
    assert taken == pytest.approx(76.75e3 + 15.0 * 0.5 * (1850.0 + 2100.0), rel=1e-9)
    assert polymer.solid_fraction(polymer.enthalpy(CELSIUS + 57.5, MELTING), MELTING) == pytest.approx(0.5, abs=1e-6)


def test_heat_from_22_to_100_degrees_is_231_kilojoules_a_kilogram_a_third_of_it_latent() -> None:
    taken = polymer.enthalpy(CELSIUS + 100.0, MELTING) - polymer.enthalpy(CELSIUS + 22.0, MELTING)
    assert taken == pytest.approx(231e3, rel=5e-3)
    assert MELTING.latent_heat / taken == pytest.approx(1.0 / 3.0, rel=0.02)


def test_zero_of_enthalpy_is_the_solid_at_0_degrees() -> None:
    assert polymer.enthalpy(CELSIUS, MELTING) == 0.0
    assert polymer.enthalpy(CELSIUS + 10.0, MELTING) == pytest.approx(18.5e3, rel=1e-12)


def test_slopes_outside_the_window_are_the_specific_heats() -> None:
    for celsius, specific_heat in ((10.0, 1850.0), (120.0, 2100.0)):
        rise = polymer.enthalpy(CELSIUS + celsius + 1.0, MELTING) - polymer.enthalpy(CELSIUS + celsius, MELTING)
        assert rise == pytest.approx(specific_heat, rel=1e-9)


@pytest.mark.parametrize("grade", GRADES)
@pytest.mark.parametrize(
    ("celsius", "low", "high"),
    [
        (23.0, 410.9, 411.1),  # Capa data sheets, flexural modulus in MPa
        (37.0, 300.0, 380.0),  # published tensile moduli of polycaprolactone
        (50.0, 120.0, 220.0),
    ],
)
def test_frozen_modulus_stays_in_the_published_ranges(grade: str, celsius: float, low: float, high: float) -> None:
    solid = solid_of(Catalog().record("polymers", grade))
    youngs = 2.0 * (1.0 + solid.poissons_ratio) * polymer.solid_shear_modulus(CELSIUS + celsius, solid)
    assert low <= youngs / 1e6 <= high


@pytest.mark.parametrize("grade", GRADES)
def test_shear_modulus_at_30_degrees_is_about_130_megapascals(grade: str) -> None:
    solid = solid_of(Catalog().record("polymers", grade))
    assert polymer.solid_shear_modulus(CELSIUS + 30.0, solid) == pytest.approx(130e6, rel=0.1)


@pytest.mark.parametrize("frequency", [0.3, 3.0, 30.0, 300.0])
def test_maxwell_moduli_are_the_fourier_integral_of_the_relaxation_modulus(frequency: float) -> None:
    # Ferry, ch. 3: G' = w int G(t) sin(wt) dt, G'' = w int G(t) cos(wt) dt for a fluid.
    def relaxation(time: float) -> float:
        return sum(modulus / 1e5 * np.exp(-time / tau) for tau, modulus in MODES)

    kind = {"epsabs": 1e-9, "limlst": 500, "limit": 500}
    sine, _ = quad(relaxation, 0.0, np.inf, weight="sin", wvar=frequency, **kind)
    cosine, _ = quad(relaxation, 0.0, np.inf, weight="cos", wvar=frequency, **kind)
    found = polymer.maxwell_moduli(frequency, MODES)
    assert found == pytest.approx((1e5 * frequency * sine, 1e5 * frequency * cosine), rel=1e-5)


@pytest.mark.parametrize(("grade", "low", "high"), [("pcl_50k", 430.0, 660.0), ("pcl_80k", 1900.0, 4200.0)])
def test_slow_melt_flows_with_its_zero_shear_viscosity(grade: str, low: float, high: float) -> None:
    # Pa s at 100 degC, extrapolated from melts of 16.9-35.5 kg/mol with viscosity ~ M^3.9.
    record = Catalog().record("polymers", grade)
    modes = modes_of(record)
    storage, loss = polymer.maxwell_moduli(1e-4, modes)
    assert low <= loss / 1e-4 <= high
    assert loss / 1e-4 == pytest.approx(record.value("zero_shear_viscosity"), rel=1e-3)
    assert storage / 1e-8 == pytest.approx(sum(g * tau**2 for tau, g in modes), rel=1e-6)


@pytest.mark.parametrize("grade", GRADES)
def test_fast_melt_is_a_rubber_of_its_plateau_modulus(grade: str) -> None:
    storage, loss = polymer.maxwell_moduli(1e9, modes_of(Catalog().record("polymers", grade)))
    assert storage == pytest.approx(0.95e6, rel=0.06)  # 0.9-1.0 MPa
    assert loss < 1e-2 * storage


def test_melt_viscosity_falls_with_temperature_as_arrhenius_says() -> None:
    # 35 kJ/mol from 100 to 120 degC: exp(35000/8.3145 (1/393.15 - 1/373.15)) = exp(-0.57388) = 0.5633.
    assert polymer.arrhenius_shift(393.15, 373.15, 35e3) == pytest.approx(0.5633, rel=1e-3)
    assert polymer.arrhenius_shift(373.15, 373.15, 35e3) == 1.0


@given(celsius=st.floats(70.0, 160.0))
def test_melt_at_another_temperature_is_the_melt_at_a_shifted_frequency(celsius: float) -> None:
    rheology = polymer.Rheology(solid_of(Catalog().record("polymers", "pcl_80k")), MODES, 35e3, 373.15)
    viscosity = polymer.moduli(CELSIUS + celsius, 0.0, 1e-5, rheology)[1] / 1e-5
    reference = polymer.moduli(373.15, 0.0, 1e-5, rheology)[1] / 1e-5
    slope = np.log(viscosity / reference) / (1.0 / (CELSIUS + celsius) - 1.0 / 373.15) if celsius != 100.0 else 4209.6
    assert slope == pytest.approx(35e3 / 8.314462618, rel=1e-3)


def test_part_frozen_polymer_is_the_geometric_mean_of_its_phases() -> None:
    # Lichtenecker: log G = X log G_solid + (1 - X) log G_melt.
    assert polymer.mix(0.25, (1e8, 1e6), (1e4, 1e2)) == pytest.approx((1e5, 1e3), rel=1e-9)
    assert polymer.mix(1.0, (1e8, 1e6), (1e4, 1e2)) == pytest.approx((1e8, 1e6), rel=1e-9)
    assert polymer.mix(0.0, (1e8, 1e6), (1e4, 1e2)) == pytest.approx((1e4, 1e2), rel=1e-9)
