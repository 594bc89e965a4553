"""The Peltier module: heat and voltage from current and temperatures.

Source: Rowe (ed.), CRC Handbook of Thermoelectrics, ch. 1; temperatures in kelvin.
"""

from __future__ import annotations

from typing import Any, NamedTuple


class PeltierModule(NamedTuple):
    """Seebeck coefficient [V/K], resistance [ohm] and thermal conductance [W/K] of all Peltier elements in series."""

    seebeck: Any
    resistance: Any
    conductance: Any


def wired(one: PeltierModule, count: Any, strings: Any) -> PeltierModule:
    """`count` alike modules in `strings` parallel strings, as one module that takes the whole current.

    Each takes I/p: S I T sums to (n/p) S I T, I^2 R to (n/p^2) R I^2, and heat is conducted through all n of them.
    """
    in_series = count / strings
    return PeltierModule(in_series * one.seebeck, in_series * one.resistance / strings, count * one.conductance)


def max_cooling_power(module: PeltierModule, cold_temperature: Any) -> Any:
    """Heat that can be drawn from the cold side without a temperature difference, S^2 T_c^2/(2 R) [W].

    To be held against a data sheet's Q_max, which the other three values do not use.
    """
    return module.seebeck**2 * cold_temperature**2 / (2.0 * module.resistance)


def hot_side_heat(module: PeltierModule, current: Any, hot: Any, cold: Any) -> Any:
    """Heat given off by the hot side, Q_h = S I T_h + I^2 R/2 - K (T_h - T_c) [W]."""
    joule = 0.5 * current**2 * module.resistance
    return module.seebeck * current * hot + joule - module.conductance * (hot - cold)


def cold_side_heat(module: PeltierModule, current: Any, hot: Any, cold: Any) -> Any:
    """Heat taken up by the cold side, Q_c = S I T_c - I^2 R/2 - K (T_h - T_c) [W]."""
    joule = 0.5 * current**2 * module.resistance
    return module.seebeck * current * cold - joule - module.conductance * (hot - cold)


def legs_temperature(module: PeltierModule, current: Any, hot: Any, cold: Any) -> Any:
    """Mean temperature of the legs between the sides, (T_h + T_c)/2 + I^2 R/(12 K) [K].

    The current heats them evenly: between their ends they have a parabola above the straight line, two thirds as high
    in the mean as in the middle, where it is I^2 R/(8 K).
    """
    return 0.5 * (hot + cold) + current**2 * module.resistance / (12.0 * module.conductance)


def voltage(module: PeltierModule, current: Any, hot: Any, cold: Any) -> Any:
    """Terminal voltage, V = S (T_h - T_c) + I R [V]."""
    return module.seebeck * (hot - cold) + current * module.resistance
