"""The first screen of a run's page, and its requirements asked against got: what the terminal says, at full width."""

from __future__ import annotations

from collections.abc import Sequence

from tvimdesign.page.blocks import Block, Facts, Folded, Grid, Points, Section, Warned
from tvimdesign.report.output.page_sections import grid, grid_of
from tvimdesign.report.output.tables import headline_rows, point_rows, variable_rows
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.first_screen.active_constraints import active_constraint_lines, margin_lines, yield_lines
from tvimdesign.report.run.first_screen.layout import LABEL
from tvimdesign.report.run.first_screen.measured import measured_lines
from tvimdesign.report.run.first_screen.qualifications import qualification_lines
from tvimdesign.report.run.first_screen.requirements import lines_of
from tvimdesign.report.run.first_screen.screen import Told
from tvimdesign.report.run.first_screen.verdict import (
    chosen_lines,
    current_lines,
    left_out_lines,
    module_lines,
    starts,
    trade_lines,
)
from tvimdesign.report.run.infeasible_report import complaint
from tvimdesign.report.run.summary_tables import checks_table

_WIDE = 1 << 20
"""Columns of a screen on which every block is one line."""


def glance(answered: AnsweredStudy, told: Told) -> list[Block]:
    """What the first screen tells, but the requirements, which have a section."""
    answer, table, told_of = answered.result, answered.study.table, told.uncertainty
    if not answer.found:
        return [Points([*([told.left_out] if told.left_out else []), *complaint(answer, table).splitlines()[1:]])]
    intervals = told_of.get("intervals", {})
    lines = [
        *left_out_lines(told.left_out, _WIDE),
        *module_lines(answer, table, intervals, _WIDE),
        *qualification_lines(answer, table, _WIDE),
        *chosen_lines(answer, table, _WIDE),
        *current_lines(answer, table, _WIDE),
        *trade_lines(told.front, table, _WIDE),
        *measured_lines(told_of, _WIDE),
        *margin_lines(answer, table, _WIDE),
        *active_constraint_lines(answer, _WIDE),
        *(yield_lines(answer, told_of, _WIDE, timed=False) if told_of else ()),
    ]
    found = facts_of(lines)
    if agree := ", ".join(starts(answer)):
        found.append(("Starts", agree))
    return [Facts(found), *([Warned(told.warnings)] if told.warnings else [])]


def facts_of(lines: Sequence[str]) -> list[tuple[str, str]]:
    """Lines of a screen as labels with their texts; lines without a label go on with the one before."""
    found: list[tuple[str, str]] = []
    for line in lines:
        label, text = line[:LABEL].strip(), " ".join(line[LABEL:].split())
        if label or not found:
            found.append((label, text))
        else:
            found[-1] = (found[-1][0], f"{found[-1][1]}; {text}")
    return found


def requirements_section(answered: AnsweredStudy, told: Told) -> Section:
    """Asked against got, then what was varied, then everything the module is."""
    answer, table, told_of = answered.result, answered.study.table, told.uncertainty
    lines = lines_of(answer, table, told_of.get("assumptions", {}), told_of.get("intervals", {}))
    rows = [(one.name, one.asked, one.got, one.may_be, one.stands, one.rests_on[0]) for one in lines]
    heads = ("", "asked", "got", "may be", "margin", "rests on (assumed)")
    blocks: list[Block] = [grid("Requirements, asked against got", heads, rows, right=(2,), toned=(4,))] if rows else []
    if not answer.found:
        return Section("requirements", "Requirements", [*blocks, *_varied(answered, "end")])
    checks, hidden = checks_table(answer, table)
    rules = f"{hidden} rules of the machine hold with a margin." if hidden else ""
    points, point_values = point_rows(answer, table)
    at_points = grid(
        "At the operating points", ("", *points, "unit", "meaning"), point_values, right=range(1, len(points) + 1)
    )
    module = grid(
        "What the module is", ("group", "quantity", "value", "unit", "meaning"), headline_rows(answer, table),
        right=(2,), code=(1,),
    )  # fmt: skip
    blocks += [
        *_varied(answered, "design"),
        at_points,
        Folded("What the module is", [module]),
        Folded("Every limit that binds or is asked", [grid_of(checks, toned=(0,), code=(), note=rules)]),
        Folded(f"All {len(answered.reported['values'])} inputs and outputs, with their sources", [_values(answered)]),
    ]
    return Section("requirements", "Requirements", blocks)


def _varied(answered: AnsweredStudy, what: str) -> list[Block]:
    rows = variable_rows(answered.result, answered.study.table)
    heads = ("variable", "start", what, "unit", "allowed")
    return [grid("What was varied", heads, rows, right=(1, 2))] if rows else []


def _values(answered: AnsweredStudy) -> Grid:
    """Every input and output as results.csv has it."""
    rows = [
        (name, one["group"], "never" if one["value"] is None else f"{one['value']:.6g}", one["unit"], one["status"],
         one["description"], one["source"])
        for name, one in answered.reported["values"].items()
    ]  # fmt: skip
    heads = ("name", "group", "value", "unit", "status", "meaning", "source")
    return grid("Inputs and outputs", heads, rows, right=(2,))
