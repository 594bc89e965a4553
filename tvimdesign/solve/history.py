"""How much of the layer is frozen at a temperature: inside the melting range its history decides, so an interval."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tvimdesign.device import Table
from tvimdesign.physics import polymer


@dataclass(frozen=True)
class History:
    """One way to have come to a temperature: `name` for sheets, `label` for people, the solid fraction it leaves."""

    name: str
    label: str
    fraction: float


def fractions_at(given: Mapping[str, Any], table: Table, temperature: float) -> tuple[float, float, float]:
    """Return the solid fraction at a temperature [K]: least, on the equilibrium curve on heating, most.

    Least: cooled from the melt and not yet freezing, 0. Most: heated to it, with the highest start and end of melting
    the record deems possible. Outside the range from the lowest start to the highest end the three are one.
    """
    melting: polymer.Melting = table.evaluate(given, ["pcl_melting"])["pcl_melting"]
    start, end = (given["pcl_grade"].entry(name) for name in ("melting_start", "melting_end"))
    first = min(value for value in (start.low, melting.start) if value is not None)
    late = melting._replace(
        start=max(value for value in (start.high, melting.start) if value is not None),
        end=max(value for value in (end.high, melting.end) if value is not None),
    )
    nominal, most = (
        float(polymer.solid_fraction(polymer.enthalpy(temperature, curve), curve)) for curve in (melting, late)
    )
    return (0.0, nominal, most) if first < temperature < late.end else (nominal, nominal, nominal)


def histories_at(given: Mapping[str, Any], table: Table, temperature: float) -> tuple[History, ...]:
    """Return the ways to have come to a temperature [K]: nominal first; low and high where they differ from it."""
    low, nominal, high = fractions_at(given, table, temperature)
    equilibrium = History("", "", nominal)
    if low == high:
        return (equilibrium,)
    return (
        History("nominal", "heated, equilibrium", nominal),
        History("low", "cooled from the melt", low),
        History("high", "heated, melting late", high),
    )
