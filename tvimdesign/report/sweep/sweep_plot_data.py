"""What the figure of a sweep is drawn from: outputs over an axis, or over two where cells are scattered."""

from __future__ import annotations

from typing import Any

from tvimdesign.report.output.axis_labels import axis_label, name_in_words
from tvimdesign.report.sweep.cell_table import CellTable
from tvimdesign.sweep.gather import Column, Value, columns
from tvimdesign.sweep.plan import SweepPlan

MOST_LINES = 6


def figure_data(plan: SweepPlan, seen: CellTable, rows: list[dict[str, Value]] | None = None) -> dict[str, Any]:
    """Panels of an output each: lines over the first number that is swept, or points over the first two.

    `rows` are the cells that are drawn: those of the picture unless given.
    """
    drawn = seen.drawn if rows is None else rows
    every = [column for column in columns(plan) if column.kind == "axis"]
    numbers = [column for column in every if column.unit]
    across = numbers[0] if numbers else Column("cell", "1", "cell", "")
    others = [column for column in every if column is not across]
    kinds = {_label(row, others) for row in drawn}
    over_two = len(numbers) > 1 and len(kinds) > MOST_LINES
    up = numbers[1].name if over_two else ""
    lines = len(kinds) <= MOST_LINES
    panels = [
        {
            "label": axis_label(name, plan.unit(name)),
            "series": [
                _series(kind if lines else "", [r for r in drawn if not lines or _label(r, others) == kind],
                        across.name, up, name)
                for kind in (sorted(kinds, key=str) if lines else [""])
            ],
        }
        for name in seen.shown
    ]  # fmt: skip
    return {
        "x": axis_words(across), "y": axis_words(numbers[1]) if over_two else "", "panels": panels,
        "legend": ", ".join(name_in_words(column.name) for column in others) if lines else "",
        "joined": lines and bool(numbers) and plan.block.method == "grid",
    }  # fmt: skip


def axis_words(column: Column) -> str:
    """What stands at an axis that is swept."""
    return axis_label(column.name.replace("require.", "limit on ").replace(".", " "), column.unit)


def _label(row: dict[str, Value], others: list[Column]) -> str:
    """The other axes' values, as a legend says them."""
    return ", ".join(f"{row[c.name]:.4g} {c.unit}".strip() if isinstance(row[c.name], float) else str(row[c.name])
                     for c in others)  # fmt: skip


def _series(label: str, rows: list[dict[str, Value]], x: str, up: str, name: str) -> dict[str, Any]:
    there = [row for row in rows if isinstance(row[name], float) and abs(float(row[name] or 0.0)) < float("inf")]
    return {
        "label": label, "x": [row[x] for row in there], "y": [row[up or name] for row in there],
        "colour": [row[name] for row in there] if up else [],
        "kept": [row["broken"] == 0 for row in there],
    }  # fmt: skip
