"""The first screen, put together: at most 40 lines in any width, the rest is left to the tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from tvimdesign.device import Table
from tvimdesign.report.run.first_screen.active_constraints import active_constraint_lines, margin_lines, yield_lines
from tvimdesign.report.run.first_screen.measured import measured_lines
from tvimdesign.report.run.first_screen.qualifications import qualification_lines
from tvimdesign.report.run.first_screen.requirements import Line, lines_of, screen_lines
from tvimdesign.report.run.first_screen.verdict import (
    chosen_lines,
    current_lines,
    header,
    left_out_lines,
    module_lines,
    trade_lines,
)
from tvimdesign.report.run.first_screen.warnings import Warned, warning_lines
from tvimdesign.solve.result import StudyResult

LINES = 40
AFTER = 5
"""Lines kept for what comes after the answer: the parts, and where to look first."""
_REQUIREMENTS = 17
"""Lines that the requirements may take where all else leaves them."""


@dataclass(frozen=True)
class Told:
    """What a first screen tells beside the answer itself."""

    seconds: float | None = None
    """How long the run took; None where that is not to be told."""
    uncertainty: Mapping[str, Any] = field(default_factory=dict)
    """What `uncertainty_data` says; empty where nothing is known."""
    warnings: Sequence[Warned] = ()
    """What `warnings_of` says."""
    front: Any = None
    left_out: str = ""
    """Steps that the time limit left out, and how to get them."""


def first_screen(answer: StudyResult, table: Table, told: Told, width: int) -> list[str]:
    """Lines of plain text, none wider than `width` but a name that is."""
    assumptions = told.uncertainty.get("assumptions", {})
    intervals = told.uncertainty.get("intervals", {})
    requirements = lines_of(answer, table, assumptions, intervals)
    head, top = [*header(answer, told.seconds, width), *left_out_lines(told.left_out, width)], []
    if answer.found:
        top += qualification_lines(answer, table, width)
        top += module_lines(answer, table, intervals, width)
        top += chosen_lines(answer, table, width) + current_lines(answer, table, width)
        top += trade_lines(told.front, table, width)
        top += measured_lines(told.uncertainty, width)
        top += margin_lines(answer, table, width) + active_constraint_lines(answer, width)
    bottom = []
    if told.uncertainty or not told.left_out:
        bottom = yield_lines(answer, told.uncertainty, width, timed=told.seconds is not None)
    left = LINES - AFTER - len(head) - len(top) - len(bottom)
    asked = _some(requirements, width, min(_REQUIREMENTS, left - 1))
    left -= len(asked)
    return [*head, *asked, *top, *warning_lines(told.warnings, width, max(left, 1)), *bottom]


def _some(requirements: Sequence[Line], width: int, most: int) -> list[str]:
    """The requirements; of more than `most` lines hold, those with the least margin, and how many more there are."""
    by_margin = sorted(requirements, key=lambda line: line.least)
    for count in range(len(requirements), 0, -1):
        least = by_margin[:count]
        lines = screen_lines([line for line in requirements if line in least], width)
        lines += [f"{len(requirements) - count} more with larger margins: --full"] if count < len(requirements) else []
        if len(lines) <= most:
            return lines
    return []
