"""Search the studies again and compare the optima with the frozen ones."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import tvimdesign
from oracle.compare import Difference, Renames, differences, relative_difference
from oracle.study_outputs import chosen_by_search, load_study

OBJECTIVE_TOLERANCE = 1e-6
"""How much worse an objective may be, relative."""
REFERENCE_TOLERANCE = 1e-9
"""How much the values may differ by which the minimised outputs are divided, relative: they are those of the start."""


@dataclass(frozen=True)
class Optimum:
    """Hold what a search found, as `chosen_by_search` describes it, with the design and the processor time."""

    design: tvimdesign.Design
    outcome: Mapping[str, Any]
    seconds: float


def search(name: str) -> Optimum:
    """Optimise a study as `tvimdesign run` does, without the front; evaluate it if nothing varies.

    Raises
    ------
    NoDesignError
        If no design satisfies every limit.
    """
    study, start = load_study(name), time.process_time()
    result = study.set(front=None).run(progress=False)
    return Optimum(result.design, chosen_by_search(study, result.design), time.process_time() - start)


def optimum_differences(
    name: str, frozen: Mapping[str, Any], now: Mapping[str, Any], renames: Renames | None = None
) -> Iterator[Difference]:
    """Compare an optimum with the frozen one; a better objective is no difference.

    Yields
    ------
    Difference
        Another status, another reference, or a worse objective.
    """
    if frozen["status"] != now["status"]:
        yield Difference(name, "optimum:status", frozen["status"], now["status"])
    yield from differences(
        name,
        {f"reference:{output}": value for output, value in frozen["reference"].items()},
        {f"reference:{output}": value for output, value in now["reference"].items()},
        tolerance=REFERENCE_TOLERANCE,
        renames=renames,
    )
    change = objective_change(frozen, now)
    if change > OBJECTIVE_TOLERANCE:
        yield Difference(name, "optimum:objective", repr(frozen["objective"]), repr(now["objective"]), change)


def objective_change(frozen: Mapping[str, Any], now: Mapping[str, Any]) -> float:
    """Return the relative change of the objective, negative if it is better; 0 if nothing is minimised."""
    if frozen["objective"] is None or now["objective"] is None:
        return 0.0
    change = relative_difference(frozen["objective"], now["objective"])
    return -change if now["objective"] < frozen["objective"] else change
