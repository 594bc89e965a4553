"""An answer as rows in the units people read, with the source of each number and the meaning of soft and stiff."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict
from functools import partial
from typing import Any, NamedTuple

from tvimdesign.base.errors import CatalogError
from tvimdesign.base.record import Record, own_data
from tvimdesign.base.units import format_quantity, from_si, pretty
from tvimdesign.device import Choice, Input, Table
from tvimdesign.report.output import numbers
from tvimdesign.report.output.choices_tables import choices_with_margins, choosing_data
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.solve.duty import SHARE, ControlResult, DutyResult
from tvimdesign.solve.nlp.solution import ActiveConstraint
from tvimdesign.solve.result import ConstraintCheck, StudyResult
from tvimdesign.study import Design, catalog_of

Ends = tuple[float, float]
FindRecord = Callable[[str, str], Record]
"""Gives a record by its category and name; raises CatalogError where there is none."""


class Provenance(NamedTuple):
    """The status of a number, its source in words, and the range (SI) within which it is known; None where unsaid."""

    status: str
    """`study`, `optimized`, `computed`, or as its record or default has it: measured, datasheet, assumed, paper ..."""
    source: str
    low: float | None = None
    high: float | None = None


def provenance(name: str, design: Design, find_record: FindRecord) -> Provenance:
    """Return where the number of a full name comes from, in a design."""
    row, base = design.table.quantity(name), name.partition("@")[0]
    if not isinstance(row, Input):
        return Provenance("computed", "computed", *design.intervals.get(name, (None, None)))
    if base in design.study["vary"]:
        return Provenance("optimized", "found by the optimiser")
    if base in design.study["module"]:
        return Provenance("study", "set by the study")
    if row.per_point:
        return Provenance("study", "an operating point of the study")
    if place := _place_in_record(row, design):
        return _of_record(*place, row, design, find_record)
    status, _, source = row.source.partition(": ")
    return Provenance(status, source, *(_of_factor(row, design, find_record) or (row.low, row.high)))


def _choice(name: str, design: Design) -> Choice:
    chosen = design.table.quantity(name)
    assert isinstance(chosen, Choice)
    return chosen


def _place_in_record(row: Input, design: Design) -> tuple[str, str] | None:
    """Return (choice, field) that an input comes from, if from a record: one bought whole before any other.

    An input with a default of its own comes from no choice that stands for no record.
    """
    place = row.record
    if row.stock_record is not None:
        bought = row.stock_record[0]
        is_whole = design.choices.get(bought, "none") not in _choice(bought, design).options
        place = row.stock_record if is_whole else place
    if place and row.falls_back and design.choices[place[0]] in _choice(place[0], design).options:
        return None
    return place


def _of_factor(row: Input, design: Design, find_record: FindRecord) -> Ends | None:
    """Return the range of a factor of a chosen record's value, as the record has it."""
    if row.range_of is None:
        return None
    choice, field = row.range_of
    entry = find_record(_choice(choice, design).category or "", design.choices[choice]).entries.get(field)
    return entry.share_of_range if entry else None


def _of_record(choice: str, field: str, row: Input, design: Design, find_record: FindRecord) -> Provenance:
    """Return the source in the chosen record; that of the row if there is no such record any more."""
    chosen, word = _choice(choice, design), design.choices[choice]
    if word in chosen.options:
        return Provenance("chosen", f"{choice} is {word}; such a module needs none")
    try:
        record = find_record(chosen.category or "", word)
    except CatalogError:
        return Provenance("record", row.source)
    entry = record.entries.get(field)
    if entry is not None:
        return Provenance(entry.status, f"{record.category}/{record.name}: {entry.source}", entry.low, entry.high)
    if row.falls_back:
        status, _, source = row.source.partition(": ")
        return Provenance(status, source)
    return Provenance("chosen", f"{record.category}/{record.name} has no {field}")


_MULTIPLES = {2.0: "twice", 3.0: "three times"}
_PARTS = {2.0: "half of", 3.0: "a third of"}
Value = Callable[[str], float]  # A number (SI) by its full name


def soft_in_words(design: Design) -> str:
    """Return what the joint is from `softening_time` on: `dynamic stiffness <= 12.7 N·m/rad at 1 Hz, twice ...`."""
    return _soft(design.value, design.choices["impedance_targets"])


def soft_of_module(resolved: ResolvedModule) -> str:
    """Return what soft means in a module that is no design."""
    return _soft(resolved.quantity, str(resolved.values["impedance_targets"]))


def stiff_in_words(design: Design) -> str:
    """Return what the joint is from `stiffening_time` on: `dynamic stiffness >= 231 N·m/rad at 1 Hz, half of ...`."""
    band = design.value("stiffening_band")
    of = "stiff_impedance" if design.choices["impedance_targets"] == "stated" else "that at the cold point"
    return f"{_at('>=', 'stiff', 'cold', design.value)}, {_PARTS.get(band, f'1/{band:.3g} of')} {of}"


def notes(design: Design) -> dict[str, str]:
    """Return what must be known to read an output right, by its name: of times, what the joint is then."""
    soft, stiff = f"soft: {soft_in_words(design)}", f"stiff: {stiff_in_words(design)}"
    points = {"softening_time": soft, "stiffening_time": stiff, "equilibrium_stiffening_time": stiff}
    if design.choices["response_criterion"] == "softening":
        points["response_time"] = soft
    if design.choices["stiffening_criterion"] == "impedance":
        points["return_time"] = stiff
    return points


def meaning(name: str, design: Design) -> str:
    """Return what an output is, with what must be known to read it."""
    note = notes(design).get(name)
    return design.table.quantity(name).description + (f" ({note})" if note else "")


def _soft(value: Value, targets: str) -> str:
    band = value("softening_band")
    of = "soft_impedance" if targets == "stated" else "that at the hot point"
    return f"{_at('<=', 'soft', 'hot', value)}, {_MULTIPLES.get(band, f'{band:.3g} times')} {of}"


def _at(sense: str, which: str, point: str, value: Value) -> str:
    threshold = format_quantity(value(f"{which}_threshold"), "N*m/rad", digits=3)
    return f"dynamic stiffness {sense} {threshold} at {format_quantity(value(f'frequency@{point}'), 'Hz')}"


NOTHING = 5e-4  # Margin, as a share, below which a limit is active
_ROUND = 1e-5


def value_text(answer: StudyResult, name: str, *, rounded: bool = False) -> str:
    """Return an output's value for people: one number, or `low to high` if history leaves it open.

    With `rounded`, what a solver leaves of zero is zero, in any unit that a limit is written in.
    """
    unit = answer.design.table.unit(name)
    if name not in answer.intervals:
        value = from_si(answer.design.value(name), unit)
        return numbers.number(_rounded(value) if rounded else value)
    low, high = (numbers.in_unit(end, unit, 2) for end in answer.intervals[name])
    return f"{low} to {high}"


def on_limit(check: ConstraintCheck, unit: str) -> float:
    """Return the value of an active limit, put exactly on the limit, in `unit`."""
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
    unit = table.unit(check.output)
    if not _has_unit(check, table):
        return check.margin, "1"
    unit = "K" if unit == "degC" else unit
    return from_si(check.margin * check.scale, unit), unit


def _has_unit(check: ConstraintCheck | ActiveConstraint, table: Table) -> bool:
    """Return whether a margin is in the row's unit: the limit has no size, or is a difference of temperatures."""
    return check.absolute or table.unit(check.output) == "K"


def margin_text(check: ConstraintCheck | ActiveConstraint, table: Table) -> str:
    """Return the margin for people: `19 %`, `-0.016 rad`, `ample`; never for what never happens.

    What is less than rounding is 0, unless the limit is violated by it.
    """
    if not math.isfinite(check.margin):
        return "never"
    margin, unit = margin_of(check, table)
    margin = margin if abs(check.margin) > NOTHING or not getattr(check, "met", True) else 0.0
    if _has_unit(check, table):
        return f"{numbers.number(margin, 3)} {pretty(unit)}".rstrip()
    if abs(margin) >= 10.0:
        return "ample" if margin > 0.0 else "far"
    return numbers.percent(margin, 2 if abs(margin) < 1.0 else 3)


def check_row(check: ConstraintCheck, table: Table, ends: tuple[float, float] | None = None) -> dict[str, Any]:
    """Return one check as plain data; `ends` (SI) where history leaves its output open."""
    margin, margin_unit = margin_of(check, table)
    return {
        "limit": check.text,
        "output": check.output,
        **numbers.number_entry(check.value, table.unit(check.output), ends),
        "margin": numbers.finite(margin),
        "margin_unit": pretty(margin_unit),
        "met": check.met,
        "origin": check.origin,
    }


results_schema = partial(own_data, __file__, "results.schema.yaml")  # The JSON schema of results.json and `run --json`


def results(answer: StudyResult) -> dict[str, Any]:
    """Return everything a script wants to know: every number in its unit and in SI, every check, how it was found."""
    design, solution, ends = answer.design, answer.solution, answer.intervals
    table, find_record = design.table, catalog_of(design).record
    reached, constant, choosing = (
        (solution.yield_reached, solution.constant, solution.choosing) if solution else (None, None, None)
    )

    def entries(values: Mapping[str, float]) -> dict[str, dict[str, Any]]:
        return {name: _entry(name, value, answer, find_record) for name, value in values.items()}

    def rows(checks: Iterable[ConstraintCheck]) -> list[dict[str, Any]]:
        return [check_row(check, table, ends.get(check.output)) for check in checks]

    return {
        **numbers.head(),
        **{name: getattr(design, name) for name in ("name", "mode", "status")},
        "feasible": answer.feasible,
        "choices": design.choices,
        "values": entries(design.values),
        "checks": rows(answer.checks),
        "warnings": rows(answer.warnings),
        "above_rating": rows(check for check in answer.warnings if check.output in design.above_rating),
        "accepting": rows(answer.accepted),
        "accepted_in_vain": list(answer.accepted_in_vain),
        "idealizations": [
            vars(each) | {"as_drawn": number_entries(each.as_drawn, table)} for each in answer.idealizations
        ],
        "current_profiles": design.current_profiles,
        "at_default_currents": entries(answer.constant_current),
        "cooling": vars(answer.cooling) | {"unpowered": number_entries(answer.cooling.unpowered, table)},
        "best_constant_currents": (
            {"objective": constant.objective, "values": entries(constant.values)} if constant else None
        ),
        "yield_reached": asdict(reached) | {"nominal": number_entries(reached.nominal, table)} if reached else None,
        "choosing": choosing_data(choosing, table, choices_with_margins(answer)),
        "solution": numbers.all_finite(design.solution) or None,
    }


def number_entries(values: Mapping[str, float], table: Table) -> dict[str, dict[str, Any]]:
    """Return numbers (SI) by full name, each in the unit that people read."""
    return {name: numbers.number_entry(value, table.unit(name)) for name, value in values.items()}


def duty_entry(duty: DutyResult, table: Table) -> dict[str, Any]:
    """Return the result of a duty, with units."""
    return {
        "values": number_entries(duty.values, table), "exceeded": list(duty.exceeded),
        "settling_time": numbers.number_entry(duty.settling, "min"),
        "energy_a_day": numbers.number_entry(duty.energy_a_day, "kJ"),
        "most_switches_per_hour": duty.most, "limited_by": duty.limited_by,
    }  # fmt: skip


def control_entry(control: ControlResult) -> dict[str, Any]:
    """Return the controller and what it does, with units."""
    return {
        "controller": asdict(control.controller), "share": SHARE,
        "overshoot": numbers.number_entry(control.overshoot, "K"),
        "hottest_pads": numbers.number_entry(control.hottest_pads, "degC"),
        "settling": control.settling, "settling_of_nominal": control.settling_of_nominal,
        "controlled": asdict(control.controlled), "stays_soft": asdict(control.stays_soft),
    }  # fmt: skip


def _entry(name: str, value: float, answer: StudyResult, find_record: FindRecord) -> dict[str, Any]:
    design = answer.design
    row, known = design.table.quantity(name), provenance(name, design, find_record)
    return {
        **numbers.number_entry(value, design.table.unit(name), (known.low, known.high)),
        "kind": "input" if isinstance(row, Input) else "output",
        "status": known.status, "source": known.source, "group": row.group, "description": row.description,
        "note": notes(design).get(name, ""),
        "idealized": ", ".join(each.text for each in answer.idealizations if name in each.as_drawn),
    }  # fmt: skip


def results_csv(entries: Mapping[str, dict[str, Any]], intervals: Mapping[str, dict[str, Any]] | None = None) -> str:
    """Return the values of `results` as CSV, in the units people read, with status, range and source.

    `may_be_low` to `may_be_high` are the intervals over unmeasured inputs; `measure_first` carries most of one.
    """
    columns = ["name", "value", "unit", "status", "low", "high", "source", "kind", "group", "description", "note",
               "idealized", "may_be_low", "may_be_high", "measure_first"]  # fmt: skip
    rows = []
    for name, entry in entries.items():
        interval = (intervals or {}).get(name)
        may_be = interval and {"may_be_low": interval["low"],
                               "may_be_high": "never" if interval["high"] is None else interval["high"],
                               "measure_first": next(iter(interval["shares"]), "")}  # fmt: skip
        rows.append({"name": name, **entry, **(may_be or {})})
    return numbers.csv_text(rows, columns)
