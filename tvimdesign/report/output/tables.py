"""An answer as rows in the units people read: the tables of the terminal, of results.json and of results.csv."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any, cast

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Input, Table
from tvimdesign.report.output.choices_tables import choices_with_margins, choosing_data
from tvimdesign.report.output.numbers import finite, head, number, number_entry, percent
from tvimdesign.report.output.provenance import FindRecord, provenance
from tvimdesign.report.output.results_format import Answered, BestConstant, CheckEntry, IntervalEntry, ValueEntry, Yield
from tvimdesign.report.output.thresholds import notes
from tvimdesign.solve.nlp.solution import ActiveConstraint, YieldReached
from tvimdesign.solve.result import ConstraintCheck, StudyResult
from tvimdesign.study.design import catalog_of

NOTHING = 5e-4
"""Margin, as a share, below which a limit binds."""
_ROUND = 1e-5


def value_text(answer: StudyResult, name: str, table: Table, *, rounded: bool = False) -> str:
    """Return an output's value for people: one number, or `low to high` if history leaves it open.

    With `rounded`, what a solver leaves of zero is zero, in any unit that a limit is written in.
    """
    unit = table.unit(name)
    if name not in answer.intervals:
        value = from_si(answer.design.value(name), unit)
        return number(_rounded(value) if rounded else value)
    low, high = (number(from_si(end, unit), 2) for end in answer.intervals[name])
    return f"{low} to {high}"


def on_limit(check: ConstraintCheck, unit: str) -> float:
    """Return the value of a limit that binds, put exactly on the limit, in `unit`."""
    beyond = -check.margin * check.scale if ">=" in check.text else check.margin * check.scale
    return _rounded(from_si(check.value + beyond, unit))


def _rounded(value: float) -> float:
    """Return zero for what a solver leaves of zero, in any unit that people read."""
    return 0.0 if abs(value) < _ROUND else value


def mark(name: str, answer: StudyResult) -> str:
    """Return what marks a value that an idealization gave."""
    return " ~" if any(name in idealization.as_drawn for idealization in answer.idealizations) else ""


def margin_of(check: ConstraintCheck | ActiveConstraint, table: Table) -> tuple[float, str]:
    """Return what is left of a limit: a share with the unit 1, or in the row's unit if the limit has no size."""
    if not check.absolute:
        return check.margin, "1"
    unit = table.unit(check.output)
    unit = "K" if unit == "degC" else unit
    return from_si(check.margin * check.scale, unit), unit


def margin_text(check: ConstraintCheck | ActiveConstraint, table: Table) -> str:
    """Return the margin for people: `19 %`, `-0.016 rad`, `ample`; never for what never happens.

    What is less than rounding is 0.
    """
    if not math.isfinite(check.margin):
        return "never"
    margin, unit = margin_of(check, table)
    margin = margin if abs(check.margin) > NOTHING else 0.0
    if check.absolute:
        return f"{number(margin, 3)} {pretty(unit)}".rstrip()
    if abs(margin) >= 10.0:
        return "ample" if margin > 0.0 else "far"
    return percent(margin, 2 if abs(margin) < 1.0 else 3)


def check_row(check: ConstraintCheck, table: Table, ends: tuple[float, float] | None = None) -> CheckEntry:
    """Return one check as plain data; `ends` (SI) where history leaves its output open."""
    margin, margin_unit = margin_of(check, table)
    return {
        "limit": check.text,
        "output": check.output,
        **number_entry(check.value, table.unit(check.output), ends),
        "margin": finite(margin),
        "margin_unit": pretty(margin_unit),
        "kept": check.kept,
        "origin": check.origin,
    }


def results(answer: StudyResult, table: Table) -> Answered:
    """Return everything a script wants to know: every number in its unit and in SI, every check, how it was found."""
    design, reached = answer.design, answer.solution.yield_reached if answer.solution else None
    find_record, ends = catalog_of(design).record, answer.intervals

    def entries(values: Mapping[str, float]) -> dict[str, ValueEntry]:
        return {name: _entry(name, value, answer, table, find_record) for name, value in values.items()}

    constant = answer.solution.constant if answer.solution else None
    best: BestConstant | None = (
        {"objective": constant.objective, "values": entries(constant.values)} if constant else None
    )
    return {
        **head(),
        "name": design.name,
        "mode": design.mode,
        "status": design.status,
        "feasible": answer.feasible,
        "choices": design.choices,
        "values": entries(design.values),
        "checks": [check_row(check, table, ends.get(check.output)) for check in answer.checks],
        "warnings": [check_row(check, table, ends.get(check.output)) for check in answer.warnings],
        "above_rating": [
            check_row(check, table, ends.get(check.output))
            for check in answer.warnings
            if check.output in design.above_rating
        ],
        "accepting": [check_row(check, table, ends.get(check.output)) for check in answer.accepted],
        "accepted_in_vain": list(answer.accepted_in_vain),
        "idealizations": [
            {
                "choice": idealization.choice,
                "word": idealization.word,
                "instead": idealization.instead,
                "leaves_out": idealization.leaves_out,
                "as_drawn": {
                    name: number_entry(value, table.unit(name)) for name, value in idealization.as_drawn.items()
                },
            }
            for idealization in answer.idealizations
        ],
        "current_profiles": cast("Any", design.current_profiles),
        "at_default_currents": entries(answer.constant_current),
        "cooling": {
            "able": answer.cooling.able,
            "used": answer.cooling.used,
            "unpowered": {n: number_entry(v, table.unit(n)) for n, v in answer.cooling.unpowered.items()},
        },
        "best_constant_currents": best,
        "yield_reached": yield_entry(reached, table) if reached else None,
        "choosing": choosing_data(
            answer.solution.choosing if answer.solution else None, table, choices_with_margins(answer)
        ),
        "solution": _all_finite(design.solution) or None,
    }


def yield_entry(reached: YieldReached, table: Table) -> Yield:
    """Return the account of a yield that was asked for, with units."""
    nominal = {name: number_entry(value, table.unit(name)) for name, value in reached.nominal.items()}
    return cast("Yield", asdict(reached) | {"nominal": nominal})


def _entry(name: str, value: float, answer: StudyResult, table: Table, find_record: FindRecord) -> ValueEntry:
    design = answer.design
    row, known = table.quantity(name), provenance(name, design, table, find_record)
    return {
        **number_entry(value, table.unit(name), (known.low, known.high)),
        "kind": "input" if isinstance(row, Input) else "output",
        "status": known.status,
        "source": known.source,
        "group": row.group,
        "description": row.description,
        "note": notes(design, table).get(name, ""),
        "idealized": ", ".join(
            idealization.text for idealization in answer.idealizations if name in idealization.as_drawn
        ),
    }


def _all_finite(data: Any) -> Any:
    """Return plain data with null for what is not finite."""
    if isinstance(data, Mapping):
        return {key: _all_finite(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_all_finite(value) for value in data]
    return finite(data) if isinstance(data, float) else data


def results_csv(entries: Mapping[str, ValueEntry], intervals: Mapping[str, IntervalEntry] | None = None) -> str:
    """Return the values of `results` as CSV, in the units people read, with status, range and source.

    `may_be_low` to `may_be_high` are the intervals over unmeasured inputs; `measure_first` carries most of one.
    """
    stream = io.StringIO()
    columns = ["name", "value", "unit", "status", "low", "high", "source", "kind", "group", "description", "note",
               "idealized", "may_be_low", "may_be_high", "measure_first"]  # fmt: skip
    writer = csv.DictWriter(stream, columns, lineterminator="\n", extrasaction="ignore")
    writer.writeheader()
    for name, entry in entries.items():
        interval = (intervals or {}).get(name)
        may_be = interval and {"may_be_low": interval["low"],
                               "may_be_high": "never" if interval["high"] is None else interval["high"],
                               "measure_first": next(iter(interval["shares"]), "")}  # fmt: skip
        writer.writerow({"name": name, **entry, **(may_be or {})})
    return stream.getvalue()


def curves_csv(curves: Mapping[str, list[float]], units: Mapping[str, str], other: str) -> str:
    """Return columns of equal length as CSV, headed by name and unit; `other` is the unit of what is not in `units`."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(f"{name} [{pretty(units.get(name, other)) or 1}]" for name in curves)
    writer.writerows([f"{value:.8g}" for value in row] for row in zip(*curves.values(), strict=True))
    return stream.getvalue()
