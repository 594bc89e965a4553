"""The figures of a sweep's page, from what its picture is drawn from: lines over an axis, and the cells to brush."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from tvimdesign.page.blocks import Drawn
from tvimdesign.report.output.axis_labels import axis_label
from tvimdesign.report.sweep.cell_table import CellTable
from tvimdesign.report.sweep.sweep_plot_data import axis_words
from tvimdesign.sweep.gather import Value, columns
from tvimdesign.sweep.plan import SweepPlan

_HOLLOW = "Hollow: a limit is broken."
_MOST_OUTPUTS = 6
"""Outputs that are axes of the figure to brush."""
CELL_WORDS = {"title": "Cells", "one": "cell", "many": "cells"}
"""What `front.js` calls the points of a sweep."""


def figures(plan: SweepPlan, seen: CellTable, data: dict[str, Any]) -> tuple[Drawn | None, Drawn | None]:
    """Lines over what is swept, and the cells of a sweep over two or more numbers to be brushed."""
    axes = [column for column in columns(plan) if column.kind == "axis" and column.unit]
    return _lines(data), _brushed(plan, seen) if len(axes) > 1 else None


def cell_points(plan: SweepPlan, listed: Iterable[dict[str, Value]]) -> dict[str, Any] | None:
    """What `front.js` draws: every cell with an answer by its axes and its first outputs that have numbers.

    Where words alone are swept the cells lie by their numbers. None where no output has a number.
    """
    numbers = [column for column in columns(plan) if column.unit]
    axes = [column for column in numbers if column.kind == "axis"] or numbers[:1]
    outputs = [column for column in numbers if column.kind == "output"]
    rows = [row for row in listed if row["broken"] is not None]
    told = [column for column in outputs if any(_finite(row[column.name]) is not None for row in rows)][:_MOST_OUTPUTS]
    if not told:
        return None
    names = [column.name for column in (*axes, *told)]
    labels = [*map(axis_words, axes), *(axis_label(column.name, column.unit) for column in told)]
    points = [
        {"number": row["cell"], "status": "between" if row["broken"] == 0 else "breaks a limit",
         "hollow": row["broken"] != 0, "values": [_finite(row[name]) for name in names]}
        for row in rows
    ]  # fmt: skip
    across = {"of": [told[0].name, axes[0].name], "names": names, "labels": labels}
    return {**across, "points": points, "words": CELL_WORDS}


def _lines(data: dict[str, Any]) -> Drawn | None:
    """A panel an output; none of cells that are scattered over two axes."""
    there = {series["label"] for panel in data["panels"] for series in panel["series"] if series["y"]}
    panels = [_panel(panel, data, there) for panel in data["panels"] if any(series["y"] for series in panel["series"])]
    if data["y"] or not panels:
        return None
    of = f" Lines: {data['legend']}." if data["legend"] else ""
    broken = any(any(line["hollow"]) for panel in panels for line in panel["lines"])
    says = f"Outputs over what is swept.{of} {_HOLLOW if broken else ''}".strip()
    return Drawn("curves", "lines.js", says, {"panels": panels}, libraries=["echarts"])


def _panel(panel: dict[str, Any], data: dict[str, Any], there: set[str]) -> dict[str, Any]:
    """A panel with the lines that are somewhere `there`, so that each has one colour in all panels."""
    return {
        "x_label": data["x"], "y_label": panel["label"],
        "lines": [
            {
                "label": series["label"] or panel["label"], "x": series["x"], "y": series["y"], "points": True,
                "apart": not data["joined"], "hollow": [not kept for kept in series["kept"]],
            }
            for series in panel["series"]
            if series["label"] in there
        ],
    }  # fmt: skip


def _brushed(plan: SweepPlan, seen: CellTable) -> Drawn | None:
    """The cells, to be brushed."""
    data = cell_points(plan, seen.listed)
    if data is None:
        return None
    says = (
        "Each point, and each line, is a cell. Drag along an axis of the lower figure, or set its ends below, to keep "
        f"only the cells within, in the table too.{f' {_HOLLOW}' if any(p['hollow'] for p in data['points']) else ''}"
    )
    return Drawn("brushed", "front.js", says, data, libraries=["echarts"])


def _finite(value: Value) -> float | None:
    """A number that can be drawn."""
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None
