"""A study's tolerances at one design: which inputs spread, and how far [SI]."""

from __future__ import annotations

from tvimdesign.device import Input
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule
from tvimdesign.solve.nlp import spread
from tvimdesign.study import Tolerance

FREE_ANGLE = "preload_angle"
"""The input that a spring's free angle adds to."""


def contributors_of(resolved: ResolvedModule, adjusted: bool | None = None) -> list[spread.Contributor]:
    """Return the study's tolerances at this design; `adjusted` decides on all those that can be adjusted.

    A constant current in whose place one follows a profile spreads nothing.
    """
    contributors = []
    for name, tolerance in resolved.study.tolerances.items():
        if name in resolved.replaced:
            continue
        row = resolved.table.quantity(name)
        assert isinstance(row, Input)  # the reader sees to that
        value = float(resolved.values[name])
        size = plus_minus(resolved, value, tolerance)
        can_be = tolerance.adjustable or tolerance.adjusted_to is not None
        if tolerance.adjustable if adjusted is None else adjusted and can_be:
            size = min(size, tolerance.adjusted_to or 0.0)
        if size > 0.0:
            kind, sigma = tolerance.distribution, tolerance.sigma
            contributors.append(spread.Contributor(name, value, size, kind, sigma, row.lower, row.upper))
    return contributors


def plus_minus(resolved: ResolvedModule, value: float, tolerance: Tolerance) -> float:
    """Return a tolerance to either side [SI] of an input with this value."""
    if tolerance.row is not None:
        return float(resolved.quantity(tolerance.row))
    return abs(value) * tolerance.share if tolerance.share is not None else float(tolerance.plus_minus or 0.0)
