"""The table of a comparison: every output that all studies have, side by side, with ratio and verdict."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from tvimdesign.base.units import from_si, pretty, si_unit
from tvimdesign.device import Output, Table
from tvimdesign.report.output.number_format import finite
from tvimdesign.solve.pareto.front_shape import ALIKE
from tvimdesign.study.design import Design

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
    ends: dict[str, tuple[float, float]]
    """Least and largest value where history leaves it open."""

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
        if self._open(label):
            return "open"
        return "better" if (mine < theirs) == (self.better == "less") else "worse"

    def _open(self, label: str) -> bool:
        """Return whether history decides: what it leaves of the two overlaps."""
        (low, high), (other_low, other_high) = (
            self.ends.get(name, (self.values[name],) * 2) for name in (label, self.first)
        )
        return low <= other_high and other_low <= high


def common_rows(designs: Mapping[str, Design], tables: Mapping[str, Table]) -> list[Row]:
    """Return every output that all designs have, in the order of the first one's table."""
    first = next(iter(designs))
    names = [name for name in _outputs(designs[first], tables[first])
             if all(name in _outputs(designs[label], tables[label]) for label in designs)]  # fmt: skip
    return [_row(name, designs, tables[first]) for name in names]


def lone_values(designs: Mapping[str, Design], tables: Mapping[str, Table]) -> list[tuple[str, Row]]:
    """Return (study, output) of what some study has and not all of them have."""
    shared = {row.name for row in common_rows(designs, tables)}
    return [
        (label, _row(name, {label: design}, tables[label]))
        for label, design in designs.items()
        for name in _outputs(design, tables[label])
        if name not in shared
    ]


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
        "values": {label: _shown(value, row.unit) for label, value in row.values.items()},
        "si": {label: finite(value) for label, value in row.values.items()},
        "si_unit": pretty(si_unit(row.unit)),
        "intervals": {label: [_shown(end, row.unit) for end in ends] for label, ends in row.ends.items()},
        "ratio": {label: row.ratio(label) for label in others},
        "verdict": {label: row.verdict(label) for label in others},
        "description": row.description,
    }


def _shown(value: float, unit: str) -> float | None:
    return from_si(value, unit) if math.isfinite(value) else None


def compare_csv(rows: Mapping[str, Sequence[Row]], alone: Mapping[str, Sequence[tuple[str, Row]]]) -> str:
    """Return all rows of both comparisons, `as drawn` and `optimised`, as CSV; outputs of one mode have no ratio."""
    labels = list(dict.fromkeys(label for each in rows.values() for row in each for label in row.values))
    heads = ["comparison", "output", "unit", *labels]
    heads += [f"{what} {label}" for label in labels[1:] for what in ("ratio", "verdict")]
    stream = io.StringIO()
    writer = csv.DictWriter(stream, [*heads, "meaning"], lineterminator="\n", restval="")
    writer.writeheader()
    for comparison, each in rows.items():
        for row in (*each, *(row for _, row in alone.get(comparison, ()))):
            reported = plain(row)
            entry = {"comparison": comparison, "output": row.name, "unit": reported["unit"], "meaning": row.description}
            entry |= {label: "never" if value is None else value for label, value in reported["values"].items()}
            entry |= {f"ratio {label}": "" if r is None else r for label, r in reported["ratio"].items()}
            entry |= {f"verdict {label}": verdict for label, verdict in reported["verdict"].items()}
            writer.writerow(entry)
    return stream.getvalue()
