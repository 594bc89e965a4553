"""Every requirement, asked against got: its range, its margin, and the assumed input it depends on most."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.report.output.numbers import in_unit, label, number, range_text
from tvimdesign.report.output.tables import NOTHING, margin_text, mark, on_limit, value_text
from tvimdesign.report.page.blocks import Cell, Grid, Head, Tone
from tvimdesign.report.run.blocks.verdict import measure_first
from tvimdesign.report.run.reasons import is_active
from tvimdesign.solve.result import ConstraintCheck, StudyResult

HEADS = ("", "asked", "got", "plausible range", "met in", "margin")
_WIDE = (3, 6)  # Columns that a narrow screen hides: the range, and the assumed input


@dataclass(frozen=True)
class Requirement:
    """One output that the study or the machine limits."""

    name: str
    requested: str
    got: str
    range: str  # `38 to 104`, over the ranges of unmeasured inputs; empty if that says no more than the value
    stands: str  # `violated by 3 %`, `open`, `at the limit`, or the margin
    tone: Tone
    least: float  # The least margin over what history leaves open, as a share of the limit's scale
    met_in: float | None = None  # Share of the plausible cases that meet the limits; none if it was not computed

    depends_on: str = ""
    """The assumed input to measure first for the limit met in the fewest cases, else for the range; empty if none."""

    state: str = ""
    """`51 to 80 °C` if the limit is also on the state in which heating ends; it stands for the point's name."""

    @property
    def cells(self) -> tuple[str, ...]:
        """The row under `HEADS`."""
        title = f"{label(self.name.partition('@')[0])}, {self.state}" if self.state else label(self.name)
        cases = "" if self.met_in is None else f"{int(100.0 * self.met_in)} % of cases"
        cases = "all cases" if self.met_in == 1.0 else cases
        return title, self.requested, self.got, self.range, cases, self.stands

    @property
    def doubt(self) -> tuple[float, float, float]:
        """Order of the rows that a screen shows first: violated, then met in few cases, then with little margin."""
        return self.least if self.least < -NOTHING else 0.0, 1.0 if self.met_in is None else self.met_in, self.least


def requirements(answer: StudyResult, uncertainty: Mapping[str, Any]) -> list[Requirement]:
    """Return an entry for each output the study requires something of, then the machine's violated rules."""
    table, intervals = answer.design.table, uncertainty.get("intervals", {})
    limits_by_output: dict[str, list[Mapping[str, Any]]] = {}
    for limit in (*answer.design.study["require"], *answer.design.study.get("simulated", ())):
        limits_by_output.setdefault(limit["output"], []).append(limit)
    rows = []
    for name, limits in limits_by_output.items():
        checks = [
            check for check in answer.checks if check.origin == "require" and name in (check.output, check.part_of)
        ]
        if not checks:  # of a search without a design nothing was simulated
            continue
        doubtful, met_in = _least_met(checks, uncertainty)
        first = measure_first(doubtful or name, uncertainty)
        row = _requirement(answer, name, _limit_text(limits, table.unit(name)), checks)
        spread = range_text(_interval(_limited(answer, name, checks), intervals))
        state = _hot_states(answer) if table.output(name).at_end in {check.output for check in checks} else ""
        depends = label(first) if first else ""
        rows.append(replace(row, range=spread, met_in=met_in, depends_on=depends, state=state))
    violated = [check for check in answer.checks if check.origin != "require" and not check.met]
    for check in sorted(violated, key=lambda check: check.worst):
        rows.append(_requirement(answer, check.output, check.text.removeprefix(check.output).strip(), [check]))
    return rows


def requirements_grid(rows: Sequence[Requirement]) -> Grid:
    """Return the table that a page shows."""
    texts = ("requirement", *HEADS[1:], "depends most on")
    heads = [Head(text, i == 2, i in _WIDE) for i, text in enumerate(texts)]
    cells = [
        [
            *(Cell(text, tone=row.tone if i == len(HEADS) - 1 else "") for i, text in enumerate(row.cells)),
            Cell(row.depends_on),
        ]
        for row in rows
    ]
    return Grid("Requirements, asked against got", heads, cells)


def _limit_text(limits: Sequence[Mapping[str, Any]], unit: str) -> str:
    """Return `5.2 to 5.8 N·m/rad` for two ends, else each end with its sense."""
    ends = {limit["sense"]: in_unit(limit["limit"], unit, 6) for limit in limits}
    if len(limits) == 2 and len(ends) == 2:
        text = f"{ends['>=']} to {ends['<=']}"
    else:
        text = ", ".join(f"{limit['sense']} {in_unit(limit['limit'], unit, 6)}" for limit in limits)
    return f"{text} {pretty(unit)}".rstrip()


def _least_met(checks: Sequence[ConstraintCheck], uncertainty: Mapping[str, Any]) -> tuple[str, float | None]:
    """Return the output whose limit is met in the fewest cases, and their share; no output where all cases meet all."""
    shares = uncertainty.get("held")
    if shares is None:
        return "", None
    outputs = {check.output for check in checks}
    met = [(share, output) for limit, share in shares.items() if (output := limit.partition(" ")[0]) in outputs]
    share, output = min(met, default=(1.0, ""))
    return output, share


def _limited(answer: StudyResult, name: str, checks: Sequence[ConstraintCheck]) -> list[str]:
    """Return an output and those that a limit on it limits as well: the stiffness over the stroke."""
    parts = answer.design.table.output(name).least_of
    return list(dict.fromkeys([name, *(check.output for check in checks if check.output not in parts)]))


def _hot_states(answer: StudyResult) -> str:
    """Return from which temperature of the layer to which a limit at the hot point is met."""
    values = answer.design.values
    ends = sorted(from_si(values[name], "degC") for name in ("softened_temperature", "temperature@hot"))
    return f"{ends[0]:.0f} to {ends[1]:.0f} {pretty('degC')}"


def _interval(names: Sequence[str], intervals: Mapping[str, Mapping[str, Any]]) -> Mapping[str, Any] | None:
    """Return the range of the first output, and with it of the others."""
    every = [intervals[name] for name in names if name in intervals]
    if names[0] not in intervals or len(every) == 1:
        return intervals.get(names[0])
    lows, highs = ([interval[end] for interval in every] for end in ("low", "high"))
    return {"value": None, "low": min(lows), "high": max(highs)} if None not in lows + highs else intervals[names[0]]


def _requirement(answer: StudyResult, name: str, limit_text: str, checks: Sequence[ConstraintCheck]) -> Requirement:
    check = min(checks, key=lambda check: check.worst)
    stands, tone = _stands(answer, check)
    got = _got(answer, _limited(answer, name, checks), answer.design.table.unit(name), check)
    return Requirement(name, limit_text, got, "", stands, tone, check.worst)


def _got(answer: StudyResult, names: Sequence[str], unit: str, check: ConstraintCheck) -> str:
    """Return the value of the first output; `5.2 to 5.8` if the limit is on the others too."""
    name = names[0]
    if name in answer.intervals:
        text = value_text(answer, name, rounded=True)
    elif check.absolute and check.met and abs(check.margin) <= NOTHING and check.output == name:
        text = number(on_limit(check, unit))
    elif len(names) > 1:
        values = [from_si(answer.design.value(output), unit) for output in names]
        text = " to ".join(dict.fromkeys(number(end) for end in (min(values), max(values))))
    else:
        text = value_text(answer, name, rounded=True)
    return text + mark(name, answer)


def _stands(answer: StudyResult, check: ConstraintCheck) -> tuple[str, Tone]:
    """Return the margin, or how a limit without any stands; `3 %, active` if the optimum is at its tolerance margin."""
    if not check.met:
        return f"violated by {margin_text(check, answer.design.table).lstrip('-')}", "bad"
    if check in answer.undecided:
        return "open: history decides", "warn"
    if abs(check.margin) <= NOTHING:
        return "at the limit", "warn"
    margin = margin_text(replace(check, margin=check.worst), answer.design.table)
    return (f"{margin}, active", "warn") if is_active(check, answer) else (margin, "")
