"""The figures of a sweep: lines over an axis, points over two, and cells to brush on the page."""

import math
from collections.abc import Iterable
from typing import Any

from tvimdesign.report.output.numbers import axis_label, name_in_words
from tvimdesign.report.page.blocks import Drawn
from tvimdesign.sweep.shards import Column, Value
from tvimdesign.sweep.swept_cells import CellTable, SweptCells

MOST_LINES = 6


def figure_data(seen: CellTable, rows: list[dict[str, Value]] | None = None) -> dict[str, Any]:
    """Return a panel for each output: lines over the first swept number, or points over the first two.

    `rows` are the cells that are drawn: those of the picture unless given.
    """
    drawn = seen.drawn if rows is None else rows
    plan, every = seen.plan, [column for column in seen.columns if column.kind == "axis"]
    numbers = [column for column in every if column.unit]
    across = numbers[0] if numbers else seen.columns[0]
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
    """Return what stands at an axis that is swept."""
    return axis_label(column.name.replace("require.", "limit on ").replace(".", " "), column.unit)


def _label(row: dict[str, Value], others: list[Column]) -> str:
    """Return the other axes' values, as a legend says them."""
    return ", ".join(f"{row[c.name]:.4g} {c.unit}".strip() if isinstance(row[c.name], float) else str(row[c.name])
                     for c in others)  # fmt: skip


def _series(label: str, rows: list[dict[str, Value]], x: str, up: str, name: str) -> dict[str, Any]:
    there = [row for row in rows if isinstance(row[name], float) and abs(float(row[name] or 0.0)) < float("inf")]
    return {
        "label": label, "x": [row[x] for row in there], "y": [row[up or name] for row in there],
        "colour": [row[name] for row in there] if up else [],
        "met": [row["violated"] == 0 for row in there],
    }  # fmt: skip


_HOLLOW = "Hollow: a limit is violated."
_MOST_OUTPUTS = 6  # Outputs that are axes of the figure to brush
CELL_WORDS = {"title": "Cells", "one": "cell", "many": "cells"}  # Name of the points of a sweep in `front.js`


def figures(seen: CellTable, data: dict[str, Any]) -> tuple[Drawn | None, Drawn | None]:
    """Return lines over what is swept, and the cells of a sweep over two or more numbers to be brushed."""
    axes = [column for column in seen.columns if column.kind == "axis" and column.unit]
    return _lines(data), _brushed(seen) if len(axes) > 1 else None


def cell_points(columns: Iterable[Column], listed: Iterable[dict[str, Value]]) -> dict[str, Any] | None:
    """Return what `front.js` draws: every cell with an answer by its axes and its first outputs that have numbers.

    Where words alone are swept the cells lie by their numbers. None where no output has a number.
    """
    numbers = [column for column in columns if column.unit]
    axes = [column for column in numbers if column.kind == "axis"] or numbers[:1]
    outputs = [column for column in numbers if column.kind == "output"]
    rows = [row for row in listed if row["violated"] is not None]
    drawn = [column for column in outputs if any(_finite(row[column.name]) is not None for row in rows)][:_MOST_OUTPUTS]
    if not drawn:
        return None
    names = [column.name for column in (*axes, *drawn)]
    labels = [*map(axis_words, axes), *(axis_label(column.name, column.unit) for column in drawn)]
    points = [
        {"number": row["cell"], "status": "between" if row["violated"] == 0 else "violates a limit",
         "hollow": row["violated"] != 0, "values": [_finite(row[name]) for name in names]}
        for row in rows
    ]  # fmt: skip
    across = {"of": [drawn[0].name, axes[0].name], "names": names, "labels": labels}
    return {**across, "points": points, "words": CELL_WORDS}


def shown_cells(cells: SweptCells) -> dict[str, Any]:
    """Return the cells of a folder as the page draws them; no points where no cell has an answer."""
    drawn = cell_points(cells.columns, cells.listed())
    return drawn or {"of": [], "names": [], "labels": [], "points": [], "words": CELL_WORDS}


def _lines(data: dict[str, Any]) -> Drawn | None:
    """Return a panel an output; none of cells that are scattered over two axes."""
    there = {series["label"] for panel in data["panels"] for series in panel["series"] if series["y"]}
    panels = [_panel(panel, data, there) for panel in data["panels"] if any(series["y"] for series in panel["series"])]
    if data["y"] or not panels:
        return None
    of = f" Lines: {data['legend']}." if data["legend"] else ""
    violated = any(any(line["hollow"]) for panel in panels for line in panel["lines"])
    says = f"Outputs over what is swept.{of} {_HOLLOW if violated else ''}".strip()
    return Drawn("curves", "lines.js", says, {"panels": panels}, libraries=["echarts"])


def _panel(panel: dict[str, Any], data: dict[str, Any], there: set[str]) -> dict[str, Any]:
    """Return a panel with the lines that are somewhere `there`, so that each has one colour in all panels."""
    return {
        "x_label": data["x"], "y_label": panel["label"],
        "lines": [
            {
                "label": series["label"] or panel["label"], "x": series["x"], "y": series["y"], "points": True,
                "apart": not data["joined"], "hollow": [not satisfied for satisfied in series["met"]],
            }
            for series in panel["series"]
            if series["label"] in there
        ],
    }  # fmt: skip


def _brushed(seen: CellTable) -> Drawn | None:
    data = cell_points(seen.columns, seen.listed)
    if data is None:
        return None
    says = (
        "Each point, and each line, is a cell. Drag along an axis of the lower figure, or set its ends below, to keep "
        f"only the cells within, in the table too.{f' {_HOLLOW}' if any(p['hollow'] for p in data['points']) else ''}"
    )
    return Drawn("brushed", "front.js", says, data, libraries=["echarts"])


def _finite(value: Value) -> float | None:
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None
