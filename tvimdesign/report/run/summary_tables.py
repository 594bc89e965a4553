"""The tables of a run's summary as rows of text, for the terminal, summary.txt and the page alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Table
from tvimdesign.report.output.summary_table import SummaryTable
from tvimdesign.report.output.tables import NOTHING, margin_text, number, value_text
from tvimdesign.report.run.first_screen.measured import ends_in_words
from tvimdesign.report.run.why import binding
from tvimdesign.solve.result import ConstraintCheck, StudyResult

_ROUND = 1e-5  # of any unit a limit is written in


def checks_table(answer: StudyResult, table: Table) -> tuple[SummaryTable, int]:
    """Requirements always; the machine's own rules only where they bind or break. And how many rules are left out."""
    told = [check for check in answer.checks if check.origin == "require" or not check.kept or check.worst <= NOTHING]
    rows = [_check_row(check, answer, table) for check in told]
    heads = ("", "limit", "value", "unit", "margin", "because")
    return SummaryTable("What must hold", heads, rows, (2, 4)), len(answer.checks) - len(told)


def _check_row(check: ConstraintCheck, answer: StudyResult, table: Table) -> tuple[str, ...]:
    stands = "broken" if not check.kept else "binds" if abs(check.margin) <= NOTHING else "ok"
    stands = "open" if check in answer.undecided else stands
    unit = table.unit(check.output)
    because = "the study" if check.origin == "require" else check.origin
    value = from_si(check.value, unit)
    shown = number(0.0 if abs(value) < _ROUND else value)
    if check.output in answer.intervals:
        shown = value_text(answer, check.output, table)
    margin = margin_text(replace(check, margin=check.worst), table)  # with the history that leaves the least
    return stands, check.text, shown, pretty(unit), margin, because


def prices_table(answer: StudyResult) -> SummaryTable:
    """What binds, with its cost in the objective and in each output."""
    outputs = list(answer.design.study["minimize"])
    rows = [
        (row.text, row.step, _saved(row.shadow_price),
         *(_saved(row.sensitivity[name]) if name in row.sensitivity else "" for name in outputs))
        for row in binding(answer)
    ]  # fmt: skip
    heads = ("limit", "relaxed by", "lowers the objective by", *outputs)
    return SummaryTable("What holds the design back", heads, rows, tuple(range(1, len(heads))))


def _saved(percent: float) -> str:
    """A saving for people: what is less than a millionth is none."""
    return f"{percent:.2g} %" if abs(percent) >= 1e-4 else "0 %"


def intervals_table(intervals: Mapping[str, Mapping[str, Any]]) -> SummaryTable:
    """What each headline and requirement may be, given what nobody has measured; what to measure first, and how many
    values for half the width (results.json names them).
    """
    measured = any(one.get("before") for one in intervals.values())
    heads: tuple[str, ...] = ("", "value", "low", "high", "one at a time", "unit", "measure first", "share", "for half")
    heads += ("before measuring",) if measured else ()
    rows = [
        _interval_row(output, one) + ((ends_in_words(one["before"]),) if measured else ())
        for output, one in intervals.items()
        if one["low"] != one["high"]
    ]
    title = "What may be, over the ranges of what is not measured (95 %, all together)"
    return SummaryTable(title, heads, rows, (1, 2, 3, 7))


def _interval_row(output: str, one: Mapping[str, Any]) -> tuple[str, ...]:
    alone = one["one_at_a_time"]
    value, low, high, least, most = (
        "never" if end is None else number(end)
        for end in (one["value"], one["low"], one["high"], alone["low"], alone["high"])
    )
    first = next(iter(one["shares"]), "")
    share = f"{100.0 * one['shares'][first]:.0f} %" if first else ""
    half = f"{len(one['to_halve'])}" if one["to_halve"] else "many"
    return output, value, low, high, f"{least} to {most}", one["unit"], first, share, half


def assumptions_table(assumptions: Mapping[str, Sequence[Mapping[str, Any]]]) -> SummaryTable:
    """What the requirements rest on: assumed inputs, and what each output is at the ends of their ranges."""
    heads = ("", "at low", "at high", "unit", "assumed", "value", "from", "to", "unit")
    rows = []
    for output, inputs in assumptions.items():
        for i, row in enumerate(inputs):
            ends = ("never" if row[end] is None else number(row[end]) for end in ("output_at_low", "output_at_high"))
            values = (number(row["value"]), number(row["low"]), number(row["high"]), row["unit"])
            rows.append((output if i == 0 else "", *ends, row["output_unit"], row["input"], *values))
    return SummaryTable("What rests on what is assumed", heads, rows, (1, 2, 5, 6, 7))
