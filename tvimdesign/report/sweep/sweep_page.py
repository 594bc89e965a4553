"""The page of a sweep: what was swept and how, figures, and cells as tables."""

from __future__ import annotations

from collections.abc import Iterable

from tvimdesign.base.units import pretty
from tvimdesign.page.blocks import Cell, Facts, Grid, Head, Page, Section, Tone
from tvimdesign.report.output.command import Command
from tvimdesign.report.output.numbers import number
from tvimdesign.report.output.page_sections import number_cell
from tvimdesign.report.sweep.sweep_figures import figure_data, figures
from tvimdesign.study.tree import study_text
from tvimdesign.sweep.gather import Column, Value, columns
from tvimdesign.sweep.plan import SweepPlan, written
from tvimdesign.sweep.swept_cells import CellTable

MOST_OUTPUTS = 12
"""Outputs of the page's table; `cells.csv` has all."""
_TONES: dict[str, Tone] = {"infeasible": "bad", "refused": "bad", "crashed": "bad", "above_rating": "warn"}


def cells_grid(plan: SweepPlan, seen: CellTable) -> Grid:
    """Return a row a cell; of many cells every second, third, ... and of many outputs the first."""
    every = columns(plan)
    outputs = [column for column in every if column.kind == "output"]
    shown = [column for column in every if column.kind in {"cell", "axis"} or column.name in {"status", "violated"}]
    shown += outputs[:MOST_OUTPUTS]
    return Grid("Cells", _heads(shown), _cells(seen.listed, shown), _left_out(plan, seen, len(outputs)))


def failed_grid(plan: SweepPlan, seen: CellTable) -> Grid:
    """Return the cells that have no answer, with the reason of each."""
    shown_columns = {"status", "reason"}
    shown = [column for column in columns(plan) if column.kind in {"cell", "axis"} or column.name in shown_columns]
    left = seen.failures - len(seen.failed)
    note = f"The first {len(seen.failed)} of {seen.failures}; `reason` in cells.csv has all." if left else ""
    return Grid("Cells without an answer", _heads(shown), _cells(seen.failed, shown), note)


def _left_out(plan: SweepPlan, seen: CellTable, outputs: int) -> str:
    """Return what the table does not show, and where that is."""
    sentences = []
    if seen.every_listed > 1:
        sentences.append(f"{len(seen.listed)} of {plan.count} cells are in this table, one in {seen.every_listed}")
    if outputs > MOST_OUTPUTS:
        sentences.append(f"the first {MOST_OUTPUTS} of {outputs} outputs are in it")
    return f"{'; '.join(sentences)}. cells.csv and cells.sqlite have all.".capitalize() if sentences else ""


def _heads(shown: list[Column]) -> list[Head]:
    names = (
        f"{column.name} [{pretty(column.unit)}]" if pretty(column.unit) not in {"", "1"} else column.name
        for column in shown
    )
    return [Head(name, bool(column.unit)) for name, column in zip(names, shown, strict=True)]


def _cells(rows: Iterable[dict[str, Value]], shown: list[Column]) -> list[list[Cell]]:
    return [[_cell(row[column.name], column) for column in shown] for row in rows]


def _cell(value: Value, column: Column) -> Cell:
    if value is None:
        return Cell("")
    if isinstance(value, str):
        tone = _TONES.get(value, "") if column.name == "status" else ""
        return Cell(value.replace("_", " ") if column.name == "status" else value, tone=tone)
    if column.name in {"cell", "violated"}:
        return Cell(str(int(value)), value, "warn" if column.name == "violated" and value else "")
    return number_cell(value)


_FILES = {
    "cells.csv": "every cell as CSV", "cells.sqlite": "as SQLite",
    "sweep.json": "columns with units and meanings", "sweep.png": "the figure",
}  # fmt: skip
_FEW = 8
"""Values of an axis that are listed one by one."""


def sweep_page(plan: SweepPlan, seen: CellTable, command: Command) -> Page:
    """Return the page of a sweep, whose tables and figure the folder has."""
    answered = plan.count - seen.failures
    done = "EVALUATED" if plan.task == "evaluate" else "OPTIMISED"
    verdict = f"{answered if seen.failures == 0 else f'{answered} OF {plan.count}'} CELLS {done}"
    lines, brushed = figures(plan, seen, figure_data(plan, seen, seen.listed))
    sections = [Section("curves", "Figure", [lines])] if lines else []
    sections += [Section("cells", "Cells", [*([brushed] if brushed else []), cells_grid(plan, seen)])]
    sections += [Section("failed", "Cells without an answer", [failed_grid(plan, seen)])] if seen.failures else []
    return command.page(
        plan.study.name, f"sweep of a {plan.study.mode} module", verdict, [swept_facts(plan, seen)], sections,
        tone="warn" if seen.failures else "", files=_FILES, study=study_text(plan.written),
    )  # fmt: skip


def swept_facts(plan: SweepPlan, seen: CellTable) -> Facts:
    """Return what was swept and how, how the cells ended, and the least of what is to be small."""
    ended = ", ".join(f"{count} {status.replace('_', ' ')}" for status, count in seen.statuses.items())
    task = "each cell is evaluated" if plan.task == "evaluate" else "each cell is optimised"
    seed = f", seed {plan.block.seed}" if plan.block.count else ""
    rows = [("Swept", "; ".join(_axis(plan, place) for place in range(len(plan.axes))))]
    rows += [("Method", f"{plan.block.method.replace('_', ' ')}{seed}; {task}"), ("Cells", f"{plan.count}: {ended}")]
    rows += [("Every limit met", f"in {seen.keeping} of {plan.count} cells")]
    for name, best in seen.best.items():
        value = f"{number(best['value'])} {pretty(best['unit'])}".strip()
        texts = plan.points.texts(int(best["cell"]) - 1)
        at = ", ".join(f"{axis.name} {text}" for axis, text in zip(plan.axes, texts, strict=True))
        rows += [(f"Least {name}", f"{value} in cell {best['cell']:g} ({at}), among the feasible cells")]
    if not seen.best:
        rows += [("Feasible", "no cell: `reason` in the table says which limits each violates")]
    return Facts(rows)


def _axis(plan: SweepPlan, place: int) -> str:
    """Return one axis: its values, or their ends and how many there are."""
    axis = plan.axes[place]
    if axis.range:
        ends = (written(axis, end) for end in (axis.range.lower, axis.range.upper))
        count = f", {axis.range.count} values" if axis.range.count else ""
        spacing = ", logarithmic" if axis.range.logarithmic else ""
        return f"`{axis.name}` from {' to '.join(ends)}{count}{spacing}"
    listed = [row[place] for row in plan.block.rows] or axis.values
    values = list(dict.fromkeys(text.value for text in listed))
    shown = ", ".join(values) if len(values) <= _FEW else f"{values[0]} ... {values[-1]}, {len(values)} values"
    return f"`{axis.name}`: {shown}"
