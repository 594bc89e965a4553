"""What qualifies a result: ratings that it exceeds as the study accepts, and values that an idealization gave."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Table
from tvimdesign.report.output.tables import number
from tvimdesign.report.run.first_screen.layout import joined, listed
from tvimdesign.solve.idealized import Idealization
from tvimdesign.solve.result import StudyResult

_TOLD = 2
"""Outputs whose values as drawn are told of an idealization."""


def qualification_lines(answer: StudyResult, table: Table, width: int) -> list[str]:
    """What the study accepts and need not, and what is idealized, with what comes out as drawn."""
    return [
        *joined("Accepts", _accepted(answer), width),
        *listed("Idealized ~", [_idealized(one, answer, table) for one in answer.idealizations], width),
    ]


def _accepted(answer: StudyResult) -> Iterator[str]:
    """What need not be accepted; what is stands in the first line, and its size with the other values."""
    if answer.accepted_in_vain:
        yield f"{', '.join(answer.accepted_in_vain)}: not needed, the design is within the rating"


def _idealized(one: Idealization, answer: StudyResult, table: Table) -> str:
    asked = [limit["output"] for limit in answer.design.study["require"]]
    first = [name for name in (*asked, *_headlines(table)) if name in one.as_drawn]
    said = "; ".join(_as_drawn(name, one, answer, table) for name in list(dict.fromkeys(first))[:_TOLD])
    count = len(one.as_drawn)
    rows = f"{count} values, marked in results.csv" if count else "no value here is another for it"
    return f"{one.text}: {one.leaves_out} ({rows})" + (f"; {said}" if said else "")


def _headlines(table: Table) -> list[str]:
    return ["spring_stiffness", "least_spring_stiffness", *(row.name for row in table.outputs if row.headline)]


def _as_drawn(name: str, one: Idealization, answer: StudyResult, table: Table) -> str:
    unit, drawn = table.unit(name), one.as_drawn[name]
    here = number(from_si(answer.design.value(name), unit))
    there = "no module" if math.isnan(drawn) else f"{number(from_si(drawn, unit))} {pretty(unit)}".rstrip()
    return f"{name} {here}, as drawn {there}"
