"""The table of a comparison, outputs side by side with ratio and verdict, and its conclusions in sentences."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from tvimdesign.base.units import format_quantity, from_si, pretty, si_unit
from tvimdesign.device import Output, Table
from tvimdesign.report.output.numbers import csv_text, finite, finite_in, listed, number
from tvimdesign.solve.pareto.front_shape import ALIKE, Lead
from tvimdesign.study import Design
from tvimdesign.study.conditions import Case

Verdict = Literal["better", "worse", "same", "open", ""]


@dataclass(frozen=True)
class Row:
    """One output of every study, SI; the others are compared with the first study."""

    name: str
    unit: str
    description: str
    headline: bool
    better: Literal["less", "more"] | None
    values: dict[str, float]
    ends: dict[str, tuple[float, float]]  # Least and largest value where history leaves it open

    @property
    def first(self) -> str:
        """The study that the others are compared with."""
        return next(iter(self.values))

    def ratio(self, label: str) -> float | None:
        """Return a study's value over the first one's; None for temperatures and signed quantities."""
        mine, theirs = self.values[label], self.values[self.first]
        if self.unit == "degC" or math.isnan(mine) or math.isnan(theirs):
            return None
        if mine == theirs:
            return 1.0
        sizes = all(math.isfinite(value) and value > 0.0 for value in (mine, theirs))
        return mine / theirs if sizes else None

    def verdict(self, label: str) -> Verdict:
        """Return whether a study does better than the first: nothing where that depends on what the module is for."""
        mine, theirs = self.values[label], self.values[self.first]
        if self.better is None or math.isnan(mine) or math.isnan(theirs):
            return ""
        if mine == theirs or math.isclose(mine, theirs, rel_tol=ALIKE):  # an infinite time is close to none but itself
            return "same"
        (low, high), (other_low, other_high) = (
            self.ends.get(name, (self.values[name],) * 2) for name in (label, self.first)
        )
        if low <= other_high and other_low <= high:  # history decides: what it leaves of the two overlaps
            return "open"
        return "better" if (mine < theirs) == (self.better == "less") else "worse"


def common_rows(designs: Mapping[str, Design], tables: Mapping[str, Table]) -> list[Row]:
    """Return every output that all designs have, in the order of the first one's table."""
    names, *others = (_outputs(design, tables[label]) for label, design in designs.items())
    common = set(names).intersection(*others)
    return [_row(name, designs, tables[next(iter(designs))]) for name in names if name in common]


def _outputs(design: Design, table: Table) -> list[str]:
    points = design.study["operating_points"]
    swings = [f"{row.name}@{point}" for row in table.first_oscillations for point in points]
    return [name for name in (*table.names(points), *swings) if name in design.values]


def _row(name: str, designs: Mapping[str, Design], table: Table) -> Row:
    row = table.quantity(name)
    assert isinstance(row, Output)
    return Row(
        name, row.unit, row.description, row.headline, row.better,
        {label: design.values[name] for label, design in designs.items()},
        {label: design.intervals[name] for label, design in designs.items() if name in design.intervals},
    )  # fmt: skip


def plain(row: Row) -> dict[str, Any]:
    """Return a row as plain data, in its unit; null is never, or nothing to say."""
    others = [label for label in row.values if label != row.first]
    return {
        "name": row.name,
        "unit": pretty(row.unit),
        "values": {label: finite_in(value, row.unit) for label, value in row.values.items()},
        "si": {label: finite(value) for label, value in row.values.items()},
        "si_unit": pretty(si_unit(row.unit)),
        "intervals": {label: [finite_in(end, row.unit) for end in ends] for label, ends in row.ends.items()},
        "ratio": {label: row.ratio(label) for label in others},
        "verdict": {label: row.verdict(label) for label in others},
        "description": row.description,
    }


def compare_csv(rows: Mapping[str, Sequence[Row]]) -> str:
    """Return all rows of both comparisons, `as drawn` and `optimised`, as CSV."""
    labels = list(dict.fromkeys(label for each in rows.values() for row in each for label in row.values))
    heads = ["comparison", "output", "unit", *labels]
    heads += [f"{what} {label}" for label in labels[1:] for what in ("ratio", "verdict")]
    lines = []
    for comparison, each in rows.items():
        for row in each:
            reported = plain(row)
            entry = {"comparison": comparison, "output": row.name, "unit": reported["unit"], "meaning": row.description}
            entry |= {label: "never" if value is None else value for label, value in reported["values"].items()}
            entry |= {f"ratio {label}": "" if r is None else r for label, r in reported["ratio"].items()}
            entry |= {f"verdict {label}": verdict for label, verdict in reported["verdict"].items()}
            lines.append(entry)
    return csv_text(lines, [*heads, "meaning"])


_TIMES_FROM = 1.5  # Ratio from which on people say `times` and not `%`
_WORDS = {
    "s": ("faster", "slower"), "g": ("lighter", "heavier"), "mm": ("smaller", "larger"), "cm³": ("smaller", "larger"),
    "J": ("thriftier", "thirstier"), "W": ("thriftier", "thirstier"),
}  # fmt: skip
"""By unit, what less and more of an output are called."""


@dataclass(frozen=True)
class ParetoComparison:
    """Two outputs that every study trades: who leads in `gained`, by limits on `limited`."""

    gained: str
    limited: str
    gained_unit: str
    limited_unit: str
    leads: tuple[Lead, ...]

    def plain(self) -> dict[str, Any]:
        """Return plain data, limits in the unit; null as an upper limit is no end."""
        return {
            "gained": self.gained, "limited": self.limited, "unit": pretty(self.limited_unit),
            "leads": [
                {"from": from_si(lead.lower, self.limited_unit),
                 "to": finite_in(lead.upper, self.limited_unit),
                 "best": lead.best, "alone": lead.alone, "least_ratio": lead.least, "most_ratio": lead.most}
                for lead in self.leads
            ],
        }  # fmt: skip


def conditions(cases: Mapping[str, Case]) -> list[str]:
    """Describe what holds for every study: shared requirements, temperatures, current, materials, surroundings."""
    first = next(iter(cases.values()))
    study, table, values = first.study, first.study.table, first.values
    everywhere = [
        r for r in study.require if all(r.output.partition("@")[0] in e.study.table.by_name for e in cases.values())
    ]
    required = [f"{r.output} {r.sense} {format_quantity(r.limit, table.unit(r.output))}" for r in everywhere]
    points = [
        f"{name} {format_quantity(point['temperature'], 'degC')} at {format_quantity(point['frequency'], 'Hz')}"
        for name, point in study.operating_points.items()
    ]
    current = study.vary.get("current")
    lower, upper = getattr(current, "lower", None), getattr(current, "upper", None)
    ends = [values["current"]] if lower is None else [lower, upper]
    clauses = [f"at {' to '.join(format_quantity(end, 'A') for end in ends)}"]
    clauses += [f"{values['heater_module'].name} pads", values["structure_material"].name, values["pcl_grade"].name]
    clauses.append(f"ambient {format_quantity(values['ambient_temperature'], 'degC')}, cold side {values['cold_side']}")
    clauses.append(f"response_time by {values['response_criterion']}")
    return [*required, *points, *clauses]


def against(label: str, first: str, rows: Sequence[Row], names: Sequence[str]) -> str:
    """Return how a study stands against the first: `compression is 2.1 times slower (...) than shear`."""
    differences = [text for row in rows if row.name in names for text in [_difference(row, label)] if text]
    return f"{label} is {listed(differences)} than {first}" if differences else f"{label} and {first} do not differ"


def _difference(row: Row, label: str) -> str:
    mine, theirs = row.values[label], row.values[row.first]
    shown = [format_quantity(v, row.unit) if math.isfinite(v) else "never" for v in (mine, theirs)]
    less, more = _WORDS.get(pretty(row.unit), (f"lower in {row.name}", f"higher in {row.name}"))
    if row.verdict(label) in {"", "same"}:
        return ""
    factor = max(mine, theirs) / min(mine, theirs) if math.isfinite(mine) and math.isfinite(theirs) else math.inf
    word = less if mine < theirs else more
    return f"{_factor(factor, mine < theirs)}{word} ({row.name} {shown[0]} against {shown[1]})"


def _factor(factor: float, less: bool) -> str:
    """Return `2.1 times `, or as a share of the first one's: `8 % `."""
    if math.isinf(factor):
        return ""
    if factor >= _TIMES_FROM:
        return f"{number(factor, 2)} times "
    return f"{number(100.0 * (1.0 - 1.0 / factor if less else factor - 1.0), 2)} % "


def standing(contest: ParetoComparison) -> str:
    """Say in one sentence who leads where."""
    word = _WORDS.get(pretty(contest.gained_unit), ("better", ""))[0]
    parts = []
    for lead in contest.leads:
        where = _range(lead, contest.limited_unit)
        if lead.alone:
            parts.append(f"{where} only {lead.best} has a design")
        elif lead.best is None:
            parts.append(f"{where} the best two are alike")
        else:
            parts.append(f"{where} {lead.best} is {word}, by {_span(lead)}")
    return f"With {contest.limited} limited, {'; '.join(parts)} ({contest.gained})."


def _range(lead: Lead, unit: str) -> str:
    lower = format_quantity(lead.lower, unit)
    return f"from {lower} to {format_quantity(lead.upper, unit)}" if math.isfinite(lead.upper) else f"from {lower} on"


def _span(lead: Lead) -> str:
    least, most = (number(100.0 * (ratio - 1.0), 2) for ratio in (lead.least, lead.most))
    return f"{least} %" if least == most else f"{least} to {most} %"
