"""Ratings of materials and bought parts that a design exceeds, and the consequence for an optimum."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import numpy as np

from tvimdesign.device import Path, Table
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE, Constraint, on_cycle, ratings_of
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE
from tvimdesign.study import Study


def happened(name: str, values: Mapping[str, float], table: Table) -> bool:
    """Return whether an output has a value: the peak of a phase that never started has none."""
    peaks = (need for need in table.output(name).needs if isinstance(table.quantity(need), Path))
    return not np.isnan(values[name]) and all(np.isfinite(values[peak]) for peak in peaks)


def kept(limit: Constraint, value: float, table: Table) -> bool:
    """Return whether a value satisfies a limit, to the precision of its computation."""
    tolerance = CYCLE_TOLERANCE if on_cycle(table, limit.output) else ALGEBRAIC_TOLERANCE
    return bool(limit.residual(value) <= tolerance)


def exceeded(values: Mapping[str, float], table: Table) -> tuple[Constraint, ...]:
    """Return the ratings that a design exceeds; `values` holds every input and output in SI by full name."""
    return tuple(
        limit
        for limit in ratings_of(table)
        if happened(limit.output, values, table) and not kept(limit, values[limit.output], table)
    )


def sorted_by_acceptance(names: Collection[str], accept: Collection[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Ratings exceeded, those that a study does not accept and those that it does."""
    return (
        tuple(name for name in names if name not in accept),
        tuple(name for name in names if name in accept),
    )


def exceeded_at_start(study: Study) -> dict[str, float]:
    """Return the ratings that the start exceeds and the study does not accept: value (SI) by the rating's name.

    One working cycle is simulated. A rating that the study requires to be kept is left out. Raises SimulationError.
    """
    model = resolve_study(study).functions
    values = model.values(model.start, Simulator(model).run(model.start).values)
    required = {limit.output for limit in study.require if limit.sense == ">=" and limit.limit >= 0.0}
    names = (limit.output for limit in exceeded(values, study.table))
    return {name: values[name] for name in names if name not in required and name not in study.accept}
