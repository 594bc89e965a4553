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
    may_be: str = ""
    """`38 to 104`: what it may be, given what nobody has measured; empty where that says no more than the value."""


def lines_of(
    answer: StudyResult,
    table: Table,
    assumptions: Mapping[str, Sequence[Mapping[str, Any]]],
    intervals: Mapping[str, Mapping[str, Any]] | None = None,
) -> list[Line]:
    """A line for each output the study requires something of, by the study's name; then the machine's broken rules."""
    asked: dict[str, list[Mapping[str, Any]]] = {}
    for one in answer.design.study["require"]:
        asked.setdefault(one["output"], []).append(one)
    found = [
        replace(_line(answer, table, name, limits, assumptions), may_be=may_be(_interval(name, table, intervals or {})))
        for name, limits in asked.items()
    ]
    rules = sorted(
        (check for check in answer.checks if check.origin != "require" and not check.kept),
        key=lambda check: check.worst,
    )
    return found + [
        _of_checks(answer, table, check.output, _limit(check), [check], _NOTHING_ASSUMED) for check in rules
    ]


def _interval(name: str, table: Table, intervals: Mapping[str, Mapping[str, Any]]) -> Mapping[str, Any] | None:
    """What an output may be, and with it all that a limit on it limits too: the stiffness over the whole stroke."""
    every = [intervals[one] for one in (name, *table.output(name).also_limited) if one in intervals]
    if name not in intervals or len(every) == 1:
        return intervals.get(name)
    lows, highs = ([one[end] for one in every] for end in ("low", "high"))
    return {"value": None, "low": min(lows), "high": max(highs)} if None not in lows + highs else intervals[name]


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
        on_limit = from_si(check.value + _beyond(check), table.unit(name))  # as good as on its limit
        got = number(0.0 if abs(on_limit) < _ROUND else on_limit)
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


def may_be(interval: Mapping[str, Any] | None, digits: int = 3) -> str:
    """`38 to 104`; empty where the ends are the value, in as many digits."""
    if interval is None:
        return ""
    value, low, high = ("never" if end is None else number(end, digits)
                        for end in (interval["value"], interval["low"], interval["high"]))  # fmt: skip
    return "" if low == high == value else f"{low} to {high}"


def assumption(row: Mapping[str, Any]) -> tuple[str, str]:
    """An assumed input with its value and its range, and with its range alone."""
    ends = f"{number(row['low'], 3)} to {number(row['high'], 3)}"
    value = f"{row['input']} {number(row['value'])} {row['unit']}".rstrip()
    return f"{value} ({ends})", f"{row['input']} {ends} {row['unit']}".rstrip()


_NOTHING_ASSUMED = ("", "")
_HEAD = ("", "asked", "got", "may be", "margin")
_MAY_BE = 3
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
    rows: list[Sequence[str]] = [(*_figures(line), marks.get(line.rests_on, "")) for line in lines]
    marked = _table(rows, "")
    if max(map(len, marked)) > width:  # what each may be stands in summary.txt, too
        rows = [(*row[:_MAY_BE], "", *row[_MAY_BE + 1 :]) for row in rows]
        marked = _table(rows, "")
    if max(map(len, marked)) > width:
        marked = _narrow(rows)
    return [*marked, *joined("  assumed", (f"{mark} {text[0]}" for text, mark in marks.items()), width)]


def _figures(line: Line) -> tuple[str, str, str, str, str]:
    return line.name, line.asked, line.got, line.may_be, line.stands


def _table(rows: Sequence[Sequence[str]], last: str) -> list[str]:
    return columns(_told([(*_HEAD, last), *rows]), right=(2,))


def _told(rows: Sequence[Sequence[str]]) -> Sequence[Sequence[str]]:
    """The rows without the column of what may be, where it says nothing."""
    if any(row[_MAY_BE] for row in rows[1:]):
        return rows
    return [(*row[:_MAY_BE], *row[_MAY_BE + 1 :]) for row in rows]


def _narrow(rows: Sequence[Sequence[str]]) -> list[str]:
    """A name on a line of its own, its figures below it."""
    every = _told([(*_HEAD, ""), *rows])
    head, *cells = columns([row[1:] for row in every], right=(1,))
    indent = " " * (LABEL // 2)
    figures = [line for row, one in zip(rows, cells, strict=True) for line in (row[0], indent + one)]
    return [indent + head, *figures]
