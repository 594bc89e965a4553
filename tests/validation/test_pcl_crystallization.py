"""Freezing of the shipped polymers against published calorimetry, by the product's own equations (validation/)."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import textbook
import yaml
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid, solve_ivp
from scipy.optimize import least_squares

from tvimdesign.catalog import Catalog
from tvimdesign.physics.polymers import polymer, transitions

Array = NDArray[np.float64]
CELSIUS = 273.15
DATA: dict[str, Any] = yaml.safe_load(
    (Path(__file__).parents[2] / "validation" / "pcl_crystallization" / "data.yaml").read_text(encoding="utf-8")
)
MELTING = polymer.Melting(1850.0, 2100.0, 76.75e3, CELSIUS + 50.0, CELSIUS + 65.0, 500.0)
RECORD = Catalog().record("polymers", "pcl_80k")
PCL = textbook.kinetics_of(RECORD)


def cooled(rate: float, kinetics: transitions.Kinetics) -> tuple[Array, Array]:
    """Celsius and solid fraction of a melt cooled from the melting window to -10 degC at a constant rate [K/min].

    Below the window nothing melts, so psi is the integral of the rate constant (Nakamura).
    """
    celsius = np.linspace(50.0, -10.0, 6001)
    constants = transitions.rate_constant(CELSIUS + celsius, kinetics)
    psi = cumulative_trapezoid(constants, -celsius * 60.0 / rate, initial=0.0)
    return celsius, transitions.solid_fraction(psi, kinetics)


def exotherm(rate: float, kinetics: transitions.Kinetics) -> tuple[float, float]:
    """Peak [degC] of the exotherm and its width at half its height [K]."""
    celsius, fraction = cooled(rate, kinetics)
    heat = np.gradient(fraction, -celsius)
    above = celsius[heat >= 0.5 * np.max(heat)]
    return float(celsius[np.argmax(heat)]), float(above[0] - above[-1])


def from_onset(kinetics: transitions.Kinetics) -> float:
    """Minutes from the onset to half at the rate of `cooling_half_time`."""
    data = DATA["cooling_half_time"]
    celsius, fraction = cooled(data["rate"], kinetics)
    onset, half = np.interp([data["onset"], 0.5], fraction, celsius)
    return float((onset - half) / data["rate"])


def slope_of_half_times() -> float:
    """K_g of the isothermal half-times [K^2], by Hoffman and Lauritzen's plot, constants from the handbook."""
    celsius, minutes = np.array(DATA["half_times"]["rows"], dtype=float).T
    kelvin, melting = celsius + CELSIUS, PCL.equilibrium_melting
    transport = 1500.0 * 4.18 / (8.314462618 * (kelvin - 183.15))
    undercooling = kelvin * (melting - kelvin) * 2.0 * kelvin / (kelvin + melting)
    return float(np.polyfit(1.0 / undercooling, np.log(minutes) - transport, 1)[0])


def joint_fit() -> tuple[Array, Array]:
    """Half-time at the record's reference [s] and K_g [K^2] that fit all data; covariance of their logarithms."""
    level, cooling, peaks = (DATA[name] for name in ("level", "cooling_half_time", "peaks"))
    sheet = dict(peaks["rows"])["pcl_80k"]

    def misses(logarithms: Array) -> list[float]:
        half_time, constant = (float(x) for x in np.exp(logarithms))
        kinetics = PCL._replace(reference_half_time=half_time, nucleation_constant=constant)
        at_level = float(textbook.half_time(CELSIUS + level["celsius"], kinetics))
        peak = float(np.mean([exotherm(rate, kinetics)[0] for rate in peaks["rates"]]))
        return [
            np.log(constant / slope_of_half_times()) / DATA["half_times"]["fit"]["deviation"],
            np.log(at_level / np.sqrt(level["low"] * level["high"])) / level["fit"]["deviation"],
            np.log(from_onset(kinetics) / cooling["minutes"]) / cooling["fit"]["deviation"],
            (peak - sheet) / peaks["fit"]["deviation"],
        ]

    start = np.log([PCL.reference_half_time * 1.5, PCL.nucleation_constant * 0.7])
    fit = least_squares(misses, start, diff_step=1e-3)
    return np.exp(fit.x), np.linalg.inv(fit.jac.T @ fit.jac)


def test_half_time_and_nucleation_constant_are_the_joint_fit():
    # At the record's reference of 35 degC an error of one says nothing of the other: each may be moved alone.
    (half_time, constant), covariance = joint_fit()
    assert PCL.reference_half_time == pytest.approx(half_time, rel=0.03)
    assert PCL.nucleation_constant == pytest.approx(constant, rel=0.03)
    assert abs(covariance[0, 1]) < 0.15 * np.sqrt(covariance[0, 0] * covariance[1, 1])


def test_interval_of_the_nucleation_constant_spans_the_sources():
    entry = RECORD.entry("nucleation_constant")
    assert entry.status in ("assumed", "calibrated")
    assert entry.high >= slope_of_half_times() == pytest.approx(1.51e5, rel=0.01)
    exponent = RECORD.entry("avrami_exponent").low
    widest = from_onset(PCL._replace(nucleation_constant=entry.low, avrami_exponent=exponent))
    cooling = DATA["cooling_half_time"]
    assert widest == pytest.approx(cooling["minutes"], rel=cooling["fit"]["deviation"])


def test_interval_of_the_half_time_holds_what_is_published_at_40_degrees():
    entry = RECORD.entry("crystallization_half_time")
    at_40 = [
        float(textbook.half_time(CELSIUS + 40.0, PCL._replace(reference_half_time=end)))
        for end in (entry.low, entry.value, entry.high)
        if end is not None
    ]
    assert at_40[0] == pytest.approx(DATA["level"]["low"], rel=0.2)
    assert DATA["level"]["low"] < at_40[1] < DATA["level"]["high"]
    assert at_40[2] == pytest.approx(DATA["half_times"]["rows"][0][1] * 60.0, rel=0.1)


@pytest.mark.parametrize("melting", [69.0, 82.0])
def test_equilibrium_melting_and_nucleation_constant_are_one_fact(melting):
    # K_g read off the same half-times with another T_m0 gives the same exotherm within a kelvin: only the pair counts.
    own = PCL._replace(nucleation_constant=slope_of_half_times())
    other = own._replace(equilibrium_melting=CELSIUS + melting)
    celsius = np.array([row[0] for row in DATA["half_times"]["rows"]])
    wanted = np.log([float(textbook.half_time(CELSIUS + at, own)) for at in celsius])

    def misses(constant: Array) -> Array:
        trial = other._replace(nucleation_constant=float(constant[0]) * 1e5)
        gaps = np.log([float(textbook.half_time(CELSIUS + at, trial)) for at in celsius])
        shifted: Array = (gaps - wanted) - np.mean(gaps - wanted)
        return shifted

    fitted = other._replace(nucleation_constant=1e5 * float(least_squares(misses, [1.5]).x[0]))
    at_40 = [float(textbook.half_time(CELSIUS + 40.0, kinetics)) for kinetics in (own, fitted)]
    fitted = fitted._replace(reference_half_time=fitted.reference_half_time * at_40[0] / at_40[1])
    assert exotherm(10.0, fitted)[0] == pytest.approx(exotherm(10.0, own)[0], abs=1.0)


def test_cooling_by_integral_is_the_products_own_rate_integrated_in_time():
    celsius, fraction = cooled(10.0, PCL)
    solved = solve_ivp(
        lambda t, psi: transitions.rate(CELSIUS + 50.0 - t / 6.0, psi, PCL, MELTING),
        (0.0, 300.0), [0.0], method="LSODA", t_eval=[60.0, 120.0, 180.0], rtol=1e-9, atol=1e-11,
    )  # fmt: skip
    by_time = transitions.solid_fraction(solved.y[0], PCL)
    assert by_time == pytest.approx(np.interp([-40.0, -30.0, -20.0], -celsius, fraction), abs=1e-3)


def test_second_implementation_finds_the_same_exotherm():
    data = DATA["second_implementation"]
    kinetics = PCL._replace(
        nucleation_constant=data["nucleation_constant"], reference_half_time=data["half_time"],
        reference=CELSIUS + 40.0, avrami_exponent=3.0,
    )  # fmt: skip
    peak, width = exotherm(10.0, kinetics)
    assert peak == pytest.approx(data["peak"], abs=0.1)
    assert width == pytest.approx(data["width"], abs=0.1)


def test_exotherms_peak_where_the_sheet_says():
    # Between the sheet's 27.4 degC at an unknown rate and 31.8 degC of the steep half-times; 3.5 to 7 K wide.
    peak, width = exotherm(10.0, PCL)
    assert 27.4 < peak < DATA["second_implementation"]["peak"]
    assert DATA["second_implementation"]["width"] < width < 7.0
    cold, warm = (exotherm(rate, PCL)[0] for rate in reversed(DATA["peaks"]["rates"]))
    for _, celsius in DATA["peaks"]["rows"]:
        assert cold < celsius < warm
    before = PCL._replace(nucleation_constant=6.08e4, reference_half_time=170.0, reference=CELSIUS + 40.0)
    assert cooled(50.0, before)[1][-1] == pytest.approx(0.13, abs=0.01)
    assert exotherm(10.0, before) == pytest.approx((26.0, 12.1), abs=0.3)


@pytest.mark.parametrize(
    ("half_time", "constant", "least"), [("value", "value", 0.99), ("high", "value", 0.9), ("value", "low", 0.9)]
)
def test_at_50_kelvin_a_minute_it_freezes_whole(half_time, constant, least):
    # A usual calorimeter cannot keep polycaprolactone amorphous. The record before this fit left 86 % unfrozen.
    kinetics = PCL._replace(
        reference_half_time=getattr(RECORD.entry("crystallization_half_time"), half_time),
        nucleation_constant=getattr(RECORD.entry("nucleation_constant"), constant),
    )
    assert cooled(DATA["fast_cooling"]["whole_at"], kinetics)[1][-1] > least
