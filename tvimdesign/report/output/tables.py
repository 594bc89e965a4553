"""An answer as rows in the units people read: the tables of the terminal, of results.json and of results.csv."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Input, Output, Table
from tvimdesign.report.output.choices_tables import choosing_data
from tvimdesign.solve.nlp.solution import ActiveConstraint
from tvimdesign.solve.result import ConstraintCheck, StudyResult
from tvimdesign.study.design import Design

NOTHING = 5e-4
"""Margin, as a share, below which a limit is said to bind."""


def number(value: float, digits: int = 4) -> str:
    """A number for people: `digits` significant figures, no needless zeros, `never` for an infinite time."""
    if math.isinf(value):
        return "never"
    text = f"{value:.{digits}g}"
    return f"{value:.0f}" if "e+" in text and abs(value) < 1e7 else text


def value_text(answer: StudyResult, name: str, table: Table) -> str:
    """The value of an output for people: one number, or `low to high` where history leaves it open."""
    unit = table.unit(name)
    if name not in answer.intervals:
        return number(from_si(answer.design.value(name), unit))
    low, high = (number(from_si(end, unit), 2) for end in answer.intervals[name])
    return f"{low} to {high}"


def headline_rows(answer: StudyResult, table: Table) -> list[tuple[str, str, str, str, str]]:
    """(group, name, value, unit, description) of the rows with one value that stand in a summary."""
    return [
        (row.group, row.name, value_text(answer, row.name, table), pretty(row.unit), row.description)
        for row in table.outputs
        if row.headline and not row.per_point
    ]


def point_rows(answer: StudyResult, table: Table) -> tuple[list[str], list[tuple[str, ...]]]:
    """Names of the operating points, and (name, one value a point, unit, description) of the rows that have several."""
    points = list(answer.design.study["operating_points"])
    shown: list[Input | Output] = [row for row in table.inputs if row.per_point]
    shown += [row for row in table.outputs if row.per_point and row.headline]
    rows = [
        (
            row.name,
            *(value_text(answer, f"{row.name}@{point}", table) for point in points),
            pretty(row.unit),
            row.description,
        )
        for row in shown
    ]
    return points, rows


def variable_rows(answer: StudyResult, table: Table) -> list[tuple[str, str, str, str, str]]:
    """(name, start, optimum, unit, range) of what the study varied."""
    if answer.solution is None:
        return []
    rows = []
    first = answer.solution.starts[0].begin
    for name, vary in answer.design.study["vary"].items():
        if name not in first and name not in answer.design.choices:
            continue  # a current that follows a profile: a table of its own
        if name not in first:
            rows.append((name, "", answer.design.choices[name], "", ", ".join(str(v) for v in vary["values"])))
            continue
        unit = table.unit(name)
        shown = [number(from_si(value, unit)) for value in (first[name], answer.design.values[name])]
        ends = (vary["lower"], vary["upper"]) if "lower" in vary else (min(vary["values"]), max(vary["values"]))
        low, high = (number(from_si(end, unit)) for end in ends)
        rows.append((name, *shown, pretty(unit), f"{low} to {high}" + ("" if "lower" in vary else ", listed")))
    return rows


def current_rows(design: Design, table: Table) -> list[tuple[str, str, str, str]]:
    """(phase, moment [s], current [A], what that is of the range) of the currents that follow a profile."""
    rows = []
    for name, plain in design.current_profiles.items():
        vary = design.study["vary"][table.phase(name).current_input]
        currents = plain["currents"]
        for i, (seconds, exact) in enumerate(zip(plain["moments"], currents, strict=True)):
            size = abs(exact)
            end = "at its upper end" if size > 0.999 * vary["upper"] else "at its lower end"
            inside = 1.001 * vary["lower"] + 1e-3 * vary["upper"] < size < 0.999 * vary["upper"]
            current = exact if size > 1e-4 * vary["upper"] else 0.0
            moment = number(seconds, 3)
            rows.append((name if i == 0 else "", moment, number(current, 3), "" if inside else end))
    return rows


def margin_of(check: ConstraintCheck | ActiveConstraint, table: Table) -> tuple[float, str]:
    """What is left of a limit: a share with the unit 1, or in the row's unit where the limit has no size of its own."""
    if not check.absolute:
        return check.margin, "1"
    unit = table.unit(check.output)
    unit = "K" if unit == "degC" else unit
    return from_si(check.margin * check.scale, unit), unit


def margin_text(check: ConstraintCheck | ActiveConstraint, table: Table) -> str:
    """The margin for people: in percent or in the row's unit; rounding is not a margin."""
    if not math.isfinite(check.margin):
        return "never"
    margin, unit = margin_of(check, table)
    margin = margin if abs(check.margin) > NOTHING else 0.0
    if unit == "1" and not check.absolute:
        return f"{margin:+.1%}" if abs(margin) < 100 else "ample" if margin > 0.0 else "far off"
    return f"{margin:+.3g} {pretty(unit)}".rstrip()


def check_row(check: ConstraintCheck, table: Table) -> dict[str, Any]:
    """One check as plain data, in the row's unit."""
    unit = table.unit(check.output)
    margin, margin_unit = margin_of(check, table)
    return {
        "limit": check.text,
        "value": _finite(from_si(check.value, unit)),
        "unit": pretty(unit),
        "margin": _finite(margin),
        "margin_unit": pretty(margin_unit),
        "kept": check.kept,
        "origin": check.origin,
    }


def results(answer: StudyResult, table: Table) -> dict[str, Any]:
    """Everything a script wants to know: every number in its unit, every check, how it was found."""
    design, reached = answer.design, answer.solution.yield_reached if answer.solution else None
    return {
        "name": design.name,
        "mode": design.mode,
        "status": design.status,
        "feasible": answer.feasible,
        "choices": design.choices,
        "values": {
            name: _entry(name, value, design, table) | _ends(answer, name, table)
            for name, value in design.values.items()
        },
        "checks": [check_row(check, table) | _ends(answer, check.output, table) for check in answer.checks],
        "warnings": [check_row(check, table) | _ends(answer, check.output, table) for check in answer.warnings],
        "current_profiles": design.current_profiles,
        "at_default_currents": {
            name: _entry(name, value, design, table) for name, value in answer.constant_current.items()
        },
        "best_constant_currents": _best_constant(answer, table),
        "yield_reached": asdict(reached) if reached else None,
        "choosing": choosing_data(answer.solution.choosing if answer.solution else None, table),
        "solution": _all_finite(design.solution),
    }


def _origin(name: str, design: Design, table: Table) -> str:
    """Where a value comes from: computed, found, set by the study, or the source of the row's default."""
    row, base = table.quantity(name), name.partition("@")[0]
    if not isinstance(row, Input):
        return "computed"
    if base in design.study["vary"]:
        return "found by the optimiser"
    if base in design.study["module"]:
        return "set by the study"
    return "an operating point of the study" if row.per_point else row.source


def _entry(name: str, value: float, design: Design, table: Table) -> dict[str, Any]:
    row = table.quantity(name)
    unit = table.unit(name)
    return {
        "value": _finite(from_si(value, unit)),
        "unit": pretty(unit),
        "kind": "input" if isinstance(row, Input) else "output",
        "source": _origin(name, design, table),
        "group": row.group,
        "description": row.description,
    }


def _best_constant(answer: StudyResult, table: Table) -> dict[str, Any]:
    constant, design = answer.solution.constant if answer.solution else None, answer.design
    if constant is None:
        return {}
    values = {name: _entry(name, value, design, table) for name, value in constant.values.items()}
    return {"objective": constant.objective, "values": values}


def _ends(answer: StudyResult, name: str, table: Table) -> dict[str, Any]:
    """`low` and `high` of an output that history leaves open; its value is that of the equilibrium curve on heating."""
    if name not in answer.intervals:
        return {}
    low, high = (_finite(from_si(end, table.unit(name))) for end in answer.intervals[name])
    return {"low": low, "high": high}


def _finite(value: float) -> float | None:
    """JSON has no infinity: what never happens is null."""
    return value if math.isfinite(value) else None


def _all_finite(data: Any) -> Any:
    """Plain data with null for what is not finite."""
    if isinstance(data, Mapping):
        return {key: _all_finite(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_all_finite(value) for value in data]
    return _finite(data) if isinstance(data, float) else data


def results_csv(entries: Mapping[str, Mapping[str, Any]]) -> str:
    """The values of `results` as CSV."""
    stream = io.StringIO()
    columns = ["name", "value", "low", "high", "unit", "kind", "group", "description", "source"]
    writer = csv.DictWriter(stream, columns, lineterminator="\n")
    writer.writeheader()
    for name, entry in entries.items():
        writer.writerow({"name": name, **entry})
    return stream.getvalue()


def curves_csv(curves: Mapping[str, list[float]], units: Mapping[str, str], other: str) -> str:
    """Columns of equal length as CSV, each headed by name and unit; `other` is the unit of what is not in `units`."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(f"{name} [{units.get(name, other)}]" for name in curves)
    writer.writerows([f"{value:.8g}" for value in row] for row in zip(*curves.values(), strict=True))
    return stream.getvalue()
