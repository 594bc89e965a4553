"""The command `sweep`, from a study file to a finished folder, alone or by the jobs of an array."""

import json
import os
import time
from collections.abc import Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape

from tvimdesign.base.errors import InputError
from tvimdesign.base.results_folder import joined
from tvimdesign.base.units import pretty
from tvimdesign.report.output.command import Command
from tvimdesign.report.output.numbers import head, number
from tvimdesign.report.output.page_sections import number_cell
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.terminal import duration, progress_output, wide_console
from tvimdesign.report.page.blocks import Cell, Facts, Grid, Head, Page, Section, Tone
from tvimdesign.report.page.page_file import FILE
from tvimdesign.report.sweep.sweep_figures import figure_data, figures
from tvimdesign.study import study_file, study_text, tree_of_file
from tvimdesign.sweep.plan import SweepPlan, plan_of, written
from tvimdesign.sweep.run_sweep import Executor, SweepDone, run_sweep
from tvimdesign.sweep.shards import SHARDS, Column, Value
from tvimdesign.sweep.swept_cells import CellTable, gather

MOST_OUTPUTS = 12  # Outputs of the page's table; `cells.csv` has all
_TONES: dict[str, Tone] = {"infeasible": "bad", "refused": "bad", "crashed": "bad", "above_rating": "warn"}


def cells_grid(seen: CellTable) -> Grid:
    """Return a row a cell; of many cells every second, third, ... and of many outputs the first."""
    outputs = [column for column in seen.columns if column.kind == "output"]
    shown = [*_named(seen, "status", "violated"), *outputs[:MOST_OUTPUTS]]
    return Grid("Cells", _heads(shown), _cells(seen.listed, shown), _left_out(seen, len(outputs)))


def failed_grid(seen: CellTable) -> Grid:
    """Return the cells that have no answer, with the reason of each."""
    shown, left = _named(seen, "status", "reason"), seen.failures - len(seen.failed)
    note = f"The first {len(seen.failed)} of {seen.failures}; `reason` in cells.csv has all." if left else ""
    return Grid("Cells without an answer", _heads(shown), _cells(seen.failed, shown), note)


def _named(seen: CellTable, *names: str) -> list[Column]:
    return [column for column in seen.columns if column.kind in {"cell", "axis"} or column.name in names]


def _left_out(seen: CellTable, outputs: int) -> str:
    """Return what the table does not show, and where that is."""
    sentences = []
    if seen.every_listed > 1:
        sentences.append(f"{len(seen.listed)} of {seen.plan.count} cells are in this table, one in {seen.every_listed}")
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
_FEW = 8  # Values of an axis that are listed one by one


def sweep_page(seen: CellTable, command: Command) -> Page:
    """Return the page of a sweep, whose tables and figure the folder has."""
    plan = seen.plan
    answered = plan.count - seen.failures
    done = "EVALUATED" if plan.task == "evaluate" else "OPTIMISED"
    verdict = f"{answered if seen.failures == 0 else f'{answered} OF {plan.count}'} CELLS {done}"
    lines, brushed = figures(seen, figure_data(seen, seen.listed))
    sections = [Section("curves", "Figure", [lines])] if lines else []
    sections += [Section("cells", "Cells", [*([brushed] if brushed else []), cells_grid(seen)])]
    sections += [Section("failed", "Cells without an answer", [failed_grid(seen)])] if seen.failures else []
    return command.page(
        plan.study.name, f"sweep of a {plan.study.mode} module", verdict, [swept_facts(seen)], sections,
        tone="warn" if seen.failures else "", files=_FILES, study=study_text(plan.written),
    )  # fmt: skip


def swept_facts(seen: CellTable) -> Facts:
    """Return what was swept and how, how the cells ended, and the least of what is to be small."""
    plan = seen.plan
    ended = ", ".join(f"{count} {status.replace('_', ' ')}" for status, count in seen.statuses.items())
    task = "each cell is evaluated" if plan.task == "evaluate" else "each cell is optimised"
    seed = f", seed {plan.block.seed}" if plan.block.count else ""
    rows = [("Swept", "; ".join(_axis(plan, place) for place in range(len(plan.block.axes))))]
    rows += [("Method", f"{plan.block.method.replace('_', ' ')}{seed}; {task}"), ("Cells", f"{plan.count}: {ended}")]
    rows += [("Every limit met", f"in {seen.keeping} of {plan.count} cells")]
    for name, best in seen.best.items():
        value = f"{number(best['value'])} {pretty(best['unit'])}".strip()
        texts = plan.texts(int(best["cell"]) - 1)
        at = ", ".join(f"{axis.name} {text}" for axis, text in zip(plan.block.axes, texts, strict=True))
        rows += [(f"Least {name}", f"{value} in cell {best['cell']:g} ({at}), among the feasible cells")]
    if not seen.best:
        rows += [("Feasible", "no cell: `reason` in the table says which limits each violates")]
    return Facts(rows)


def _axis(plan: SweepPlan, place: int) -> str:
    """Return one axis: its values, or their ends and how many there are."""
    axis = plan.block.axes[place]
    if axis.range:
        ends = (written(axis, end) for end in (axis.range.lower, axis.range.upper))
        count = f", {axis.range.count} values" if axis.range.count else ""
        spacing = ", logarithmic" if axis.range.logarithmic else ""
        return f"`{axis.name}` from {' to '.join(ends)}{count}{spacing}"
    listed = [row[place] for row in plan.block.rows] or axis.values
    values = list(dict.fromkeys(text.value for text in listed))
    shown = ", ".join(values) if len(values) <= _FEW else f"{values[0]} ... {values[-1]}, {len(values)} values"
    return f"`{axis.name}`: {shown}"


def sweep_study(
    path: Path, out: Path, executor: Executor, *, overwrite: bool, resume: bool, plots: bool, as_json: bool,
    settings: Sequence[str] = (),
) -> None:  # fmt: skip
    """Sweep a study and write its folder. Raises InputError, OutputError."""
    plan = plan_of(tree_of_file(path, settings))
    if executor.alone:
        command = Command(out, overwrite=overwrite, as_json=as_json, resume=resume, keep=SHARDS)
        summary = sweep_folder(plan, executor, command, plots=plots)
    else:
        command = Command(out, as_json=as_json, resume=True, keep=SHARDS)
        part = _part(plan, executor, command, overwrite=overwrite, plots=plots)
        if part is None:
            return
        summary = part
    command.report(summary, f"{FILE} and the tables are")


def sweep_folder(plan: SweepPlan, executor: Executor, command: Command, *, plots: bool) -> dict[str, Any]:
    """Answer every cell into a folder with tables, figure and page; return what is in sweep.json, and the run's times.

    Raises as `sweep_study`.
    """
    with command:
        if plots and plan.study.write.plots:
            command.start_plotter()  # while the cells are computed
        began = time.perf_counter()
        done = run_sweep(plan, command.folder.path, executor, command.progress)
        return _gathered(plan, command, done, plots=plots, began=began)


def _part(
    plan: SweepPlan, executor: Executor, command: Command, *, overwrite: bool, plots: bool
) -> dict[str, Any] | None:
    """Compute the cells of one job of an array; gather all cells if none is missing then, else return None."""
    began = time.perf_counter()
    with joined(command.out, SHARDS, overwrite=overwrite) as shared, progress_output() as progress:
        done = run_sweep(plan, shared, executor, progress)
    with ExitStack() as stack:
        try:
            gatherer = stack.enter_context(command) if not done.missing else None
        except InputError:  # another job, which ended at the same time, gathers
            gatherer = None
        if gatherer:
            return _gathered(plan, command, done, plots=plots, began=began)
    say_part(done, executor, command.out, wide_console(), as_json=command.as_json)
    return None


def _gathered(plan: SweepPlan, command: Command, done: SweepDone, *, plots: bool, began: float) -> dict[str, Any]:
    """Write the tables, the figure, the page and the manifest."""
    folder = command.folder
    command.progress("gathering the cells")
    seen = gather(plan, done.keys, folder.path)
    results = {
        **head(), "study": plan.study.name, "task": plan.task, "method": plan.block.method, "seed": plan.block.seed,
        "cells": done.cells, "statuses": seen.statuses, "best": seen.best,
        "columns": [column._asdict() for column in seen.columns],
    }  # fmt: skip
    if plan.study.catalog_folder:  # the explorer reads study.yaml, whose own path is relative to another folder
        results["catalog"] = str(Path(plan.study.catalog_folder).resolve())
    folder.write("study.yaml", study_file(plan.written))
    folder.write_json("sweep.json", results)
    if plots and plan.study.write.plots:
        command.start_plotter()
        drawing = Drawing("sweep", "analysis_figures.sweep", figure_data(seen))
        command.begin_plots([drawing], plan.study.name, vector=plan.study.write.vector)
        folder.look_up_versions()
        command.finish_plots(again="repeat the command with --resume")
    page = sweep_page(seen, command)
    spent = {name: round(value, 3) for name, value in asdict(done.spent).items()}
    seconds = time.perf_counter() - began
    timing = {"seconds": round(seconds, 3), "reused": done.reused, "computed": done.computed, **spent}
    facts = Facts([*swept_facts(seen).rows, ("This run", _in_short(timing))])
    command.shown = [Section("sweep", "", [facts])]
    inputs = {"study": plan.tree.path} if plan.tree.path else {}
    command.finish("swept", inputs, {"solver": {"seed": plan.block.seed}}, timing, page)
    return {**results, "run": timing, **command.account()}


def _in_short(run: Mapping[str, Any]) -> str:
    """Return how many cells a run reused and computed, in which time."""
    clauses = [f"{run['reused']} reused, {run['computed']} computed in {duration(run['seconds'])}"]
    if run["computed"]:
        clauses.append(f"{1e3 * run['cells_s'] / max(run['cells'], 1):.0f} ms of the processor a cell")
    return ", ".join([*clauses, *([f"{run['died']} workers died and were replaced"] if run["died"] else [])])


def say_part(done: SweepDone, executor: Executor, out: Path, console: Console, *, as_json: bool) -> None:
    """Print what one job of an array has done."""
    counts = {"cells": done.cells, "reused": done.reused, "computed": done.computed, "missing": done.missing}
    if as_json:
        print(
            json.dumps({**counts, "shard": list(executor.part), "process": os.getpid(), "folder": str(out)}, indent=2)
        )
        return
    others = f"{done.missing} of {done.cells} cells are still with other parts"
    console.print(
        f"Part {executor.part[0]} of {executor.part[1]}: {done.reused} cells reused, {done.computed} computed; "
        f"{others if done.missing else 'all cells are there'}. The part that ends last gathers them in "
        f"[bold]{escape(str(out))}[/bold]",
        soft_wrap=True,
    )
