"""A number as it stands in a JSON file of results: in the unit people read, and in SI."""

from __future__ import annotations

import math

from tvimdesign.base.units import from_si, pretty, si_unit
from tvimdesign.report.output.number_format import NumberEntry

Ends = tuple[float | None, float | None]


def number_entry(value: float, unit: str, ends: Ends | None = None) -> NumberEntry:
    """A number (SI) of a quantity people read in `unit`, with what it may lie between (SI) where that is known."""
    low, high = ends or (None, None)

    def shown(number: float | None) -> float | None:
        return None if number is None else finite(from_si(number, unit))

    return {
        "value": shown(value),
        "low": shown(low),
        "high": shown(high),
        "unit": pretty(unit),
        "si": {"value": finite(value), "low": finite(low), "high": finite(high), "unit": pretty(si_unit(unit))},
    }


def finite(value: float | None) -> float | None:
    """JSON has no infinity: what never happens is null."""
    return value if value is not None and math.isfinite(value) else None
