"""What qualifies a result: ratings that it exceeds as the study accepts, and values that an idealization gave."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tvimdesign.base.units import format_quantity, from_si, pretty
from tvimdesign.device import Table
from tvimdesign.report.output.tables import number
from tvimdesign.report.run.first_screen.layout import listed
from tvimdesign.solve.idealized import Idealization
from tvimdesign.solve.result import StudyResult

_TOLD = 2
"""Outputs whose values as drawn are told of an idealization."""


def qualification_lines(answer: StudyResult, table: Table, width: int) -> list[str]:
    """What the study accepts, with by how much, and what is idealized, with what comes out as drawn."""
    return [
        *listed("Accepts", list(_accepted(answer, table)), width),
        *listed("Idealized ~", [_idealized(one, answer, table) for one in answer.idealizations], width),
    ]


def _accepted(answer: StudyResult, table: Table) -> Iterator[str]:
    for check in answer.accepted:
        yield f"{check.output} {format_quantity(check.value, table.unit(check.output))}: {check.origin}"
    if answer.accepted_in_vain:
        yield f"not needed: {', '.join(answer.accepted_in_vain)}, within the rating; take it out of `accept`"


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
