"""The Peltier module: heat and voltage from current and temperatures, and its parameters from a data sheet.

Source: Rowe (ed.), CRC Handbook of Thermoelectrics, ch. 1; temperatures in kelvin.
"""

from __future__ import annotations

from typing import Any, NamedTuple


class PeltierModule(NamedTuple):
    """Seebeck coefficient [V/K], resistance [ohm] and thermal conductance [W/K] of all Peltier elements in series."""

    seebeck: Any
    resistance: Any
    conductance: Any


def from_data_sheet(
    max_current: float, max_voltage: float, max_difference: float, hot_side_temperature: float
) -> PeltierModule:
    """Parameters from I_max, V_max, dT_max at the sheet's hot-side temperature [K].

    S = V_max/T_h, R = V_max (T_h - dT_max)/(I_max T_h), K = V_max I_max (T_h - dT_max)/(2 T_h dT_max).
    """
    cold = hot_side_temperature - max_difference
    return PeltierModule(
        seebeck=max_voltage / hot_side_temperature,
        resistance=max_voltage * cold / (max_current * hot_side_temperature),
        conductance=max_voltage * max_current * cold / (2.0 * hot_side_temperature * max_difference),
    )


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


def voltage(module: PeltierModule, current: Any, hot: Any, cold: Any) -> Any:
    """Terminal voltage, V = S (T_h - T_c) + I R [V]."""
    return module.seebeck * (hot - cold) + current * module.resistance
