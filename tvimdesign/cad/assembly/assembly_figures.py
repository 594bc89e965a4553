"""Figures in the steps of an assembly note: quantities of the table, and words that follow from some of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from math import degrees
from typing import Any

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.parts.heater_parts import fits_in_window
from tvimdesign.device import Input, Output, table_for
from tvimdesign.study.design import Design

ANGLES = ("rad", "deg")
TORQUE = "N*m"
_GRAMS = 1e3 / 9.80665
"""Reading of a balance in grams for one newton, by standard gravity (ISO 80000-3)."""
_HEATED = ("current", "response_time", "hold_current")


class Figures(dict[str, Any]):
    """Words and rows by name as they are written in a text: lengths in mm, angles in degrees, counts as they are."""

    def __init__(self, design: Design, dims: Dimensions, counts: Mapping[str, object]) -> None:
        """`counts` are there beside the rows: of parts, and the grams of one."""
        super().__init__(counts)
        self._design, self._dims = design, dims
        rows: list[Input | Output] = [*table_for(design.mode).inputs, *table_for(design.mode).outputs]
        self._units = {row.name: row.unit for row in rows}

    def __missing__(self, name: str) -> str:
        """Return the words a text has in place of a name, or the value of a quantity."""
        if name in _WORDS:
            return _WORDS[name](self._design, self._dims)
        unit = self._units.get(name)
        if unit == TORQUE:
            return f"{self._design.value(name):.2g}"
        value: float = getattr(self._dims, name)
        return f"{degrees(value) if unit in ANGLES else value:.3g}"


def preload_tolerance(design: Design) -> float | None:
    """Return what the study counts a spring's preload off by, to either side [rad]; None where it says nothing.

    What is adjusted is no further off than what adjusting leaves, as where the yield is counted.
    """
    stated = (design.study.get("tolerances") or {}).get("preload_angle")
    if not stated:
        return None
    if stated.get("row"):
        size = design.value(stated["row"])
    elif stated.get("share") is not None:
        size = stated["share"] * abs(design.value("preload_angle"))
    else:
        size = stated.get("plus_minus") or 0.0
    return float(min(size, stated.get("adjusted_to") or 0.0) if stated.get("adjustable") else size)


def _preload_force(design: Design, _: Dimensions) -> str:
    """Return the force that takes a leg off its pin at rest, `pin_force`, and within what the study's tolerance leaves
    of it.

    The preload and this force are in proportion, as the spring is straight: torque over the arm of the leg.
    """
    force = design.values.get("pin_force", math.nan)
    if not math.isfinite(force):
        return "the force of the study's `pin_force`"
    grams = float(f"{_GRAMS * force:.3g}")
    said = f"{force:.3g} N ({grams:g} g)"
    off = preload_tolerance(design)
    if not off:
        return said
    share = off / design.value("preload_angle")
    ends = f"{force * max(1.0 - share, 0.0):.3g} to {force * (1.0 + share):.3g} N"
    return f"{said}; the study counts on {ends}"


def _sorting(design: Design, dims: Dimensions) -> str:
    """Return which springs are good enough, by what the study counts on; else how the rotor is brought to its place."""
    off = preload_tolerance(design)
    if not dims.adjuster_radius:
        share, sorting = 100.0 * design.value("sorted_share"), degrees(design.value("free_angle_sorting"))
        return (
            f"measure each before it goes in, and keep out those further off than ±{sorting:.3g}°: {share:.0f} % of "
            "what is bought are good enough"
        )
    if off is None or off >= design.value("free_angle_tolerance"):
        return "choose pairs that agree, or bend the legs until the rotor rests with its pins in line with the posts"
    return f"the study counts on a preload that is set within ±{degrees(off):.3g}°"


def _bonding_heat(design: Design, _: Dimensions) -> str:
    """Return how the PCL is melted through, by the study's own currents and times.

    By hand where it was not switched.
    """
    current, time, hold = (design.values.get(name, math.nan) for name in _HEATED)
    if not all(math.isfinite(one) and one > 0.0 for one in (current, time, hold)):
        return "heat the pads until the rotor turns by hand against its springs alone, and hold that for two minutes"
    by = "the study's current profile" if "softening" in design.current_profiles else f"{current:.3g} A"
    return f"heat the pads with {by} for {time:.3g} s, then hold {hold:.3g} A for two minutes"


def _cutout_place(_: Design, dims: Dimensions) -> str:
    """Return where the cut-out is drawn."""
    return "in the window, to the outer side of the heater" if fits_in_window(dims) else "below the floor"


def _ledge_pull(design: Design, _: Dimensions) -> str:
    """Return how strongly the freezing layer pulls at what lies on the ledges.

    Nothing where the design does not say.
    """
    tension = design.values.get("ledge_tension", math.nan)
    return f", by {1e-6 * tension:.2g} MPa there at most" if math.isfinite(tension) else ""


def _heated_parts(_: Design, dims: Dimensions) -> str:
    """Return what the PCL lies on."""
    return "spreaders" if dims.spreader_depth else "pads"


_WORDS: Mapping[str, Callable[[Design, Dimensions], str]] = {
    "preload_force": _preload_force,
    "sorting": _sorting,
    "bonding_heat": _bonding_heat,
    "cutout_place": _cutout_place,
    "heated_parts": _heated_parts,
    "ledge_pull": _ledge_pull,
}
"""By the name a text has in braces."""
