"""Meaning of "soft" and "stiff" in a module, in words: an impedance at a frequency, and what it is a multiple of."""

from __future__ import annotations

from collections.abc import Callable

from tvimdesign.base.units import format_quantity
from tvimdesign.device import Table
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule
from tvimdesign.study.design import Design

_MULTIPLES = {2.0: "twice", 3.0: "three times"}
_PARTS = {2.0: "half of", 3.0: "a third of"}
Value = Callable[[str], float]
"""A number (SI) by its full name."""


def soft_in_words(design: Design, table: Table) -> str:
    """Return `|Z| <= 12.7 N·m/rad at 1 Hz, twice hot`: what the joint is from `softening_time` on."""
    return _soft(design.value, design.choices["impedance_targets"], table)


def soft_of_module(resolved: ResolvedModule) -> str:
    """Return what soft means in a module that is no design."""
    return _soft(resolved.quantity, str(resolved.values["impedance_targets"]), resolved.table)


def stiff_in_words(design: Design, table: Table) -> str:
    """Return `|Z| >= 231 N·m/rad at 1 Hz, half of cold`: what the joint is from `stiffening_time` on."""
    band = design.value("stiffening_band")
    of = "stiff_impedance" if design.choices["impedance_targets"] == "stated" else "cold"
    return f"{_at('>=', 'stiff', 'cold', design.value, table)}, {_PARTS.get(band, f'1/{band:.3g} of')} {of}"


def notes(design: Design, table: Table) -> dict[str, str]:
    """Return what must be known to read an output right, by its name: of times, what the joint is then."""
    soft, stiff = f"soft: {soft_in_words(design, table)}", f"stiff: {stiff_in_words(design, table)}"
    points = {"softening_time": soft, "stiffening_time": stiff, "equilibrium_stiffening_time": stiff}
    if design.choices["response_criterion"] == "softening":
        points["response_time"] = soft
    if design.choices["stiffening_criterion"] == "impedance":
        points["return_time"] = stiff
    return points


def meaning(name: str, design: Design, table: Table) -> str:
    """Return what an output is, with what must be known to read it."""
    note = notes(design, table).get(name)
    return table.quantity(name).description + (f" ({note})" if note else "")


def _soft(value: Value, targets: str, table: Table) -> str:
    band = value("softening_band")
    of = "soft_impedance" if targets == "stated" else "hot"
    return f"{_at('<=', 'soft', 'hot', value, table)}, {_MULTIPLES.get(band, f'{band:.3g} times')} {of}"


def _at(sense: str, which: str, point: str, value: Value, table: Table) -> str:
    threshold = format_quantity(value(f"{which}_threshold"), table.unit(f"{which}_threshold"), digits=3)
    return f"|Z| {sense} {threshold} at {format_quantity(value(f'frequency@{point}'), 'Hz')}"
