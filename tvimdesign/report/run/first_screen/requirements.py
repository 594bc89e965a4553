"""Every requirement, asked against got: its margin, whether it binds, and the assumed input it rests on most."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Table
from tvimdesign.report.output.tables import NOTHING, margin_of, number, value_text
from tvimdesign.report.run.first_screen.layout import LABEL, columns, joined
from tvimdesign.solve.result import ConstraintCheck, StudyResult

_ROUND = 1e-5  # of any unit a limit is written in
_MARKS = "abcdefghijklmnopqrstuvwxyz"


@dataclass(frozen=True)
class Line:
    """One output that the study or the machine limits."""

    name: str
    asked: str
    got: str
    stands: str
    """BROKEN, OPEN, BINDS, or the margin."""
    least: float
    """The least margin over what history leaves open, as a share of the limit's scale."""
    rests_on: tuple[str, str]
    """`pcl_bond_strength 2 MPa (1 to 5)` and, shorter, `pcl_bond_strength 1 to 5 MPa`; empty where nothing assumed
    matters."""


def lines_of(answer: StudyResult, table: Table, assumptions: Mapping[str, Sequence[Mapping[str, Any]]]) -> list[Line]:
    """A line for each output the study requires something of, by the study's name; then the machine's broken rules."""
    asked: dict[str, list[Mapping[str, Any]]] = {}
    for one in answer.design.study["require"]:
        asked.setdefault(one["output"], []).append(one)
    found = [_line(answer, table, name, limits, assumptions) for name, limits in asked.items()]
    rules = sorted(
        (check for check in answer.checks if check.origin != "require" and not check.kept),
        key=lambda check: check.worst,
    )
    return found + [
        _of_checks(answer, table, check.output, _limit(check), [check], _NOTHING_ASSUMED) for check in rules
    ]


def _limit(check: ConstraintCheck) -> str:
    """What a rule asks, without the name of its output."""
    return check.text.removeprefix(check.output).strip()


def _line(
    answer: StudyResult,
    table: Table,
    name: str,
    limits: Sequence[Mapping[str, Any]],
    assumptions: Mapping[str, Sequence[Mapping[str, Any]]],
) -> Line:
    unit = table.unit(name)
    ends = {one["sense"]: number(from_si(one["limit"], unit), 6) for one in limits}
    if len(limits) == 2 and len(ends) == 2:
        asked = f"{ends['>=']} to {ends['<=']} {pretty(unit)}"
    else:
        asked = ", ".join(f"{one['sense']} {number(from_si(one['limit'], unit), 6)}" for one in limits)
        asked = f"{asked} {pretty(unit)}"
    behind = {name, *table.output(name).least_of, *table.output(name).also_limited}
    checks = [check for check in answer.checks if check.origin == "require" and check.output in behind]
    rests_on = next(iter(assumptions.get(name, ())), None)
    return _of_checks(
        answer, table, name, asked.rstrip(), checks, assumption(rests_on) if rests_on else _NOTHING_ASSUMED
    )


def _of_checks(
    answer: StudyResult,
    table: Table,
    name: str,
    asked: str,
    checks: Sequence[ConstraintCheck],
    rests_on: tuple[str, str],
) -> Line:
    check = min(checks, key=lambda one: one.worst)
    value = from_si(answer.design.value(name), table.unit(name))
    if name in answer.intervals:
        got = value_text(answer, name, table)
    elif check.absolute and abs(check.margin) <= NOTHING and check.output == name:
        got = number(from_si(check.value + _beyond(check), table.unit(name)))  # as good as on its limit
    else:
        got = number(0.0 if abs(value) < _ROUND else value)
        if also := table.output(name).also_limited:
            got = _over(name, also, answer, table)
    got += " ~" if any(name in one.as_drawn for one in answer.idealizations) else ""
    return Line(name, asked, got, _stands(answer, check, table), check.worst, rests_on)


def _over(name: str, also: Sequence[str], answer: StudyResult, table: Table) -> str:
    """What an output ranges over where a limit on it is one on others too: `5.2 to 5.8`."""
    values = [from_si(answer.design.value(one), table.unit(name)) for one in (name, *also)]
    ends = list(dict.fromkeys(number(end) for end in (min(values), max(values))))
    return " to ".join(ends)


def _beyond(check: ConstraintCheck) -> float:
    """What takes the value of a limit that binds to where the limit is."""
    return -check.margin * check.scale if ">=" in check.text else check.margin * check.scale


def _stands(answer: StudyResult, check: ConstraintCheck, table: Table) -> str:
    if not check.kept:
        return f"BROKEN {margin_words(check, table).lstrip('-')}"
    if check in answer.undecided:
        return "OPEN"
    if abs(check.margin) <= NOTHING:
        return "BINDS"
    return margin_words(replace(check, margin=check.worst), table)


def margin_words(check: ConstraintCheck, table: Table) -> str:
    """`19 %`, `0.016 rad`, `ample`; never for what never happens."""
    if not math.isfinite(check.margin):
        return "never"
    margin, unit = margin_of(check, table)
    if check.absolute:
        return f"{number(margin, 3)} {pretty(unit)}".rstrip()
    return (
        f"{number(100.0 * margin, 2 if abs(margin) < 1.0 else 3)} %"
        if abs(margin) < 10.0
        else "ample"
        if margin > 0
        else "far"
    )


def assumption(row: Mapping[str, Any]) -> tuple[str, str]:
    """An assumed input with its value and its range, and with its range alone."""
    ends = f"{number(row['low'], 3)} to {number(row['high'], 3)}"
    value = f"{row['input']} {number(row['value'])} {row['unit']}".rstrip()
    return f"{value} ({ends})", f"{row['input']} {ends} {row['unit']}".rstrip()


_NOTHING_ASSUMED = ("", "")
_HEAD = ("", "asked", "got", "margin")
_RESTS_ON = "rests on (assumed)"


def screen_lines(lines: Sequence[Line], width: int) -> list[str]:
    """The table; where what a line rests on does not fit beside it, a letter does, and a list below says what it is."""
    if not lines:
        return []
    assumed = any(line.rests_on[0] for line in lines)
    for form in (0, 1):
        beside = _table([(*_figures(line), line.rests_on[form]) for line in lines], _RESTS_ON if assumed else "")
        if max(map(len, beside)) <= width:
            return beside
    named = list(dict.fromkeys(line.rests_on for line in lines if line.rests_on[0]))
    marks = dict(zip(named, _MARKS, strict=False))
    rows = [(*_figures(line), marks.get(line.rests_on, "")) for line in lines]
    marked = _table(rows, "")
    if max(map(len, marked)) > width:
        marked = _narrow(rows)
    return [*marked, *joined("  assumed", (f"{mark} {text[0]}" for text, mark in marks.items()), width)]


def _figures(line: Line) -> tuple[str, str, str, str]:
    return line.name, line.asked, line.got, line.stands


def _table(rows: Sequence[Sequence[str]], last: str) -> list[str]:
    return columns([(*_HEAD, last), *rows], right=(2,))


def _narrow(rows: Sequence[Sequence[str]]) -> list[str]:
    """A name on a line of its own, its figures below it."""
    head, *cells = columns([(*_HEAD[1:], ""), *(row[1:] for row in rows)], right=(1,))
    indent = " " * (LABEL // 2)
    figures = [line for row, one in zip(rows, cells, strict=True) for line in (row[0], indent + one)]
    return [indent + head, *figures]
