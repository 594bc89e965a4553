"""How much of the layer is frozen at a temperature: one number outside melting, an interval inside it.

Inside the melting range the solid fraction depends on what came before. Cooled from the melt the layer is still liquid;
heated it follows the equilibrium curve, which the record knows to some kelvin only.
"""

from __future__ import annotations

from typing import NamedTuple

from tvimdesign.physics import polymer
from tvimdesign.solve.rig import Rig


class Fractions(NamedTuple):
    """Solid fractions [1] at one temperature."""

    low: float
    """Cooled from the melt, still liquid."""
    nominal: float
    """Heated, on the equilibrium curve."""
    high: float
    """Heated, melting as late as the record allows."""


def melting_range(rig: Rig) -> tuple[float, float]:
    """Temperatures [K] between which the solid fraction depends on history: earliest start and latest end."""
    melting: polymer.Melting = rig.row("pcl_melting")
    return melting.start + _off(rig, "melting_start")[0], melting.end + _off(rig, "melting_end")[1]


def fractions_at(rig: Rig, temperature: float) -> Fractions:
    """Least, nominal and largest solid fraction at a temperature [K]; outside the melting range all are the same."""
    melting: polymer.Melting = rig.row("pcl_melting")
    nominal = _on_heating(temperature, melting)
    first, last = melting_range(rig)
    if not first <= temperature <= last:
        return Fractions(nominal, nominal, nominal)
    late = melting._replace(
        start=melting.start + _off(rig, "melting_start")[1], end=melting.end + _off(rig, "melting_end")[1]
    )
    return Fractions(0.0, nominal, max(nominal, _on_heating(temperature, late)))


def _on_heating(temperature: float, melting: polymer.Melting) -> float:
    return float(polymer.solid_fraction(polymer.enthalpy(temperature, melting), melting))


def _off(rig: Rig, field: str) -> tuple[float, float]:
    """How far [K] the record's range reaches below and above its value; a study's own value is taken to be as sure."""
    entry = rig.values["pcl_grade"].entry(field)
    low = entry.value if entry.low is None else entry.low
    high = entry.value if entry.high is None else entry.high
    return low - entry.value, high - entry.value
