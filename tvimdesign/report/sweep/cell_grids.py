"""The cells of a sweep as tables of its page."""

from __future__ import annotations

import math

from tvimdesign.base.units import pretty
from tvimdesign.page.blocks import Cell, Grid, Head, Tone
from tvimdesign.report.output.tables import number
from tvimdesign.report.sweep.cell_table import CellTable
from tvimdesign.sweep.gather import Column, Value, columns
from tvimdesign.sweep.plan import SweepPlan

MOST_OUTPUTS = 12
"""Outputs of the page's table; `cells.csv` has all."""
_TONES: dict[str, Tone] = {"infeasible": "bad", "refused": "bad", "crashed": "bad", "above_rating": "warn"}
_NEVER = 1e300


def cells_grid(plan: SweepPlan, seen: CellTable) -> Grid:
    """A row a cell; of many cells every second, third, ... and of many outputs the first."""
    every = columns(plan)
    outputs = [column for column in every if column.kind == "output"]
    shown = [column for column in every if column.kind in {"cell", "axis"} or column.name in {"status", "broken"}]
    shown += outputs[:MOST_OUTPUTS]
    return Grid("Cells", _heads(shown), [_row(row, shown) for row in seen.listed], _left_out(plan, seen, len(outputs)))


def failed_grid(plan: SweepPlan, seen: CellTable) -> Grid:
    """The cells that have no answer, with the reason of each."""
    told = {"status", "reason"}
    shown = [column for column in columns(plan) if column.kind in {"cell", "axis"} or column.name in told]
    left = seen.failures - len(seen.failed)
    note = f"The first {len(seen.failed)} of {seen.failures}; `reason` in cells.csv has all." if left else ""
    return Grid("Cells without an answer", _heads(shown), [_row(row, shown) for row in seen.failed], note)


def _left_out(plan: SweepPlan, seen: CellTable, outputs: int) -> str:
    """What the table does not show, and where that is."""
    said = []
    if seen.every_listed > 1:
        said.append(f"{len(seen.listed)} of {plan.count} cells are in this table, one in {seen.every_listed}")
    if outputs > MOST_OUTPUTS:
        said.append(f"the first {MOST_OUTPUTS} of {outputs} outputs are in it")
    return f"{'; '.join(said)}. cells.csv and cells.sqlite have all.".capitalize() if said else ""


def _heads(shown: list[Column]) -> list[Head]:
    return [Head(f"{one.name} [{pretty(one.unit)}]" if pretty(one.unit) not in {"", "1"} else one.name, bool(one.unit))
            for one in shown]  # fmt: skip


def _row(row: dict[str, Value], shown: list[Column]) -> list[Cell]:
    return [_cell(row[column.name], column) for column in shown]


def _cell(value: Value, column: Column) -> Cell:
    if value is None:
        return Cell("")
    if isinstance(value, str):
        return Cell(value.replace("_", " ") if column.name == "status" else value, tone=_tone(value, column))
    if column.name in {"cell", "broken"}:
        return Cell(str(int(value)), value, "warn" if column.name == "broken" and value else "")
    return Cell(number(value), value if math.isfinite(value) else math.copysign(_NEVER, value))


def _tone(value: str, column: Column) -> Tone:
    return _TONES.get(value, "") if column.name == "status" else ""
