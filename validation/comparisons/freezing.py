"""Freezing and melting of the shipped polymers: half-times, exotherms, and heat to melt."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.integrate import cumulative_trapezoid, solve_ivp

from comparisons.numbers import Array
from tvimdesign.catalog import Catalog
from tvimdesign.physics.polymers import polymer, transitions

Values = Mapping[str, Any]
CELSIUS = 273.15
_KINETICS = ("avrami_exponent", "crystallization_half_time", "crystallization_reference", "nucleation_constant",
             "equilibrium_melting_temperature", "glass_transition", "transport_energy")  # fmt: skip
_MELTING = ("specific_heat_solid", "specific_heat_melt", "latent_heat", "melting_start", "melting_end")
_LAG = 0.5  # s, of melting behind heating; nothing melts in these cases


def _kinetics(inputs: Values, polymer_name: str = "") -> transitions.Kinetics:
    """Of a record, with what the case gives instead."""
    record = Catalog().record("polymers", polymer_name or inputs["polymer"])
    kinetics = transitions.Kinetics(*(record.value(name) for name in _KINETICS), _LAG)
    return kinetics._replace(**inputs.get("instead", {}))


def _half_time(celsius: float, kinetics: transitions.Kinetics) -> float:
    """Time [s] after which half of a melt is frozen, from its rate integrated in time."""
    kelvin = CELSIUS + celsius
    guess = 1.0 / float(transitions.rate_constant(kelvin, kinetics))
    times = np.linspace(0.0, 2.0 * guess, 2001)
    psi = times * float(transitions.rate_constant(kelvin, kinetics))
    return float(np.interp(0.5, transitions.solid_fraction(psi, kinetics), times))


def half_times(inputs: Values) -> Values:
    """Isothermal half-times [s] over the temperature [degC], and over that at the first."""
    results = [_half_time(celsius, _kinetics(inputs)) for celsius in inputs["celsius"]]
    return {"half_time": results, "over_the_first": np.array(results) / results[0]}


def isothermal_curve(inputs: Values) -> Values:
    """Solid fraction over the time [s], the product's rate integrated by scipy."""
    kinetics = _kinetics(inputs)
    window = polymer.Melting(1850.0, 2100.0, 76.75e3, CELSIUS + 50.0, CELSIUS + 65.0, 500.0)
    results = solve_ivp(
        lambda _, psi: transitions.rate(CELSIUS + inputs["celsius"], psi, kinetics, window),
        (0.0, inputs["time"][-1]), [0.0], t_eval=inputs["time"], rtol=1e-10, atol=1e-12,
    )  # fmt: skip
    return {"fraction": transitions.solid_fraction(results.y[0], kinetics)}


def _cooled(rate: float, kinetics: transitions.Kinetics) -> tuple[Array, Array]:
    """Temperature [degC] and solid fraction of a melt cooled from 50 to -10 degC at a rate [K/min]."""
    celsius = np.linspace(50.0, -10.0, 6001)
    constants = transitions.rate_constant(CELSIUS + celsius, kinetics)
    psi = cumulative_trapezoid(constants, -celsius * 60.0 / rate, initial=0.0)
    return celsius, transitions.solid_fraction(psi, kinetics)


def cooled_fraction(inputs: Values) -> Values:
    """Solid fraction over the temperature [degC], cooled at a constant rate; and at the end of all cooling."""
    celsius, fraction = _cooled(inputs["rate"], _kinetics(inputs))
    at = inputs.get("celsius", [-10.0])
    return {"fraction": np.interp(-np.array(at, float), -celsius, fraction), "last": fraction[-1]}


def exotherm(inputs: Values) -> Values:
    """Peak [degC] of the exotherm of each polymer at the case's rate, and its width at half its height [K]."""
    peaks, widths = [], []
    for name in inputs["polymers"]:
        celsius, fraction = _cooled(inputs["rate"], _kinetics(inputs, name))
        heat = np.gradient(fraction, -celsius)
        above = celsius[heat >= 0.5 * np.max(heat)]
        peaks.append(float(celsius[np.argmax(heat)]))
        widths.append(float(above[0] - above[-1]))
    return {"peak": peaks, "width": widths}


def half_time_of_cooling(inputs: Values) -> Values:
    """Minutes from an onset to half of it frozen, cooled at a constant rate."""
    celsius, fraction = _cooled(inputs["rate"], _kinetics(inputs))
    onset, half = np.interp([inputs["onset"], 0.5], fraction, celsius)
    return {"minutes": (onset - half) / inputs["rate"]}


def heat_to_melt(inputs: Values) -> Values:
    """Heat [J/kg] that takes a polymer from a temperature to another [degC]."""
    record = Catalog().record("polymers", inputs["polymer"])
    melting = polymer.Melting(*(record.value(name) for name in _MELTING), 500.0)
    start, end = (polymer.enthalpy(CELSIUS + inputs[name], melting) for name in ("from", "to"))
    back = [polymer.temperature(enthalpy, melting) - CELSIUS for enthalpy in (start, end)]
    return {"heat": end - start, "temperatures": back}
