"""What nobody knows of a module, apart from what varies: intervals over the ranges of unmeasured values.

A tolerance is of a part: among many modules all values within it occur. A range is of our knowledge: all modules have
the one value in it that nobody has measured. So they are two blocks, and no yield counts both.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tvimdesign.device import Table
from tvimdesign.report.run.uncertainty_data import interval_entry
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule
from tvimdesign.solve.uncertainty.design_uncertainty import DesignUncertainty, UncertaintyModel
from tvimdesign.solve.uncertainty.tolerance import Spread

_FEWEST = 4
"""Modules drawn for a yield that is not told here: the analysis has its own."""


def epistemic_uncertainty(resolved: ResolvedModule, found: Spread, workers: int) -> DesignUncertainty:
    """Intervals of what is asked of a module, and how far its limits hold, parts as drawn."""
    return UncertaintyModel(resolved, found.asked).at(resolved, _FEWEST, workers=workers)


def unknown_data(unknown: DesignUncertainty, table: Table) -> dict[str, Any]:
    """That as plain data."""
    holds = unknown.holds
    return {
        "holds": None if holds is None else {"share": holds.share, "low": holds.low, "high": holds.high},
        "held": unknown.held,
        "unmeasured": [one.name for one in unknown.unmeasured],
        "intervals": {
            name: interval_entry(name, one, table, unknown.before.get(name)) for name, one in unknown.intervals.items()
        },
    }


def unknown_rows(data: Mapping[str, Any]) -> list[dict[str, Any]]:
    """A row an output: what it may be, all together and one at a time, and what carries most of it."""
    return [
        {
            "output": name, "unit": one["unit"], "as_drawn": one["value"], "low": one["low"], "high": one["high"],
            "one_at_a_time_low": one["one_at_a_time"]["low"], "one_at_a_time_high": one["one_at_a_time"]["high"],
            "measure_first": next(iter(one["shares"]), ""), "share": next(iter(one["shares"].values()), None),
            "to_halve": ", ".join(one["to_halve"]),
        }
        for name, one in data["intervals"].items()
    ]  # fmt: skip


def unknown_sentences(unknown: DesignUncertainty, found: Spread) -> list[str]:
    """How far the limits hold, and what to measure first; said beside the yield, never in it."""
    if unknown.holds is None:
        return []
    said = (
        f"What nobody knows: with parts as drawn every limit holds in {100.0 * unknown.holds.share:.3g} % of the "
        f"ranges of {len(unknown.unmeasured)} unmeasured values. The yield of {100.0 * found.together.share:.3g} % "
        "counts none of that: it is of the parts, with these values as assumed."
    )
    first = [f"{name}: {one.first} ({100.0 * one.shares[one.first]:.0f} %)"
             for name, one in unknown.intervals.items() if one.first]  # fmt: skip
    return [said, *([f"Measure first, of {'; of '.join(first)}."] if first else [])]
