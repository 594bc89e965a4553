"""The command sweep, from a study file to a finished folder, and the parts of chosen cells.

The folder of a sweep that the jobs of an array share: the job after which every cell is there gathers them.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict
from pathlib import Path, PurePosixPath
from typing import Any

from rich.console import Console
from rich.markup import escape

from tvimdesign.base.atomic_files import recorded
from tvimdesign.base.claim import IN_PARTS, Claim
from tvimdesign.base.environment import require_extra
from tvimdesign.base.errors import FolderInUseError, GeometryError, InputError, TvimError
from tvimdesign.base.manifest import seed
from tvimdesign.base.results_folder import ResultsFolder, prepare, recovered, say
from tvimdesign.page.blocks import Facts, Grid, Section
from tvimdesign.page.page_file import FILE
from tvimdesign.report.output.command import Command
from tvimdesign.report.output.numbers import csv_text, head
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.terminal import Progress, duration, progress_output, wide_console
from tvimdesign.report.run.parts_of_design import make_parts_of
from tvimdesign.report.sweep.sweep_figures import figure_data
from tvimdesign.report.sweep.sweep_page import sweep_page, swept_facts
from tvimdesign.solve.result import answer
from tvimdesign.study import read_tree
from tvimdesign.study.design import design_json
from tvimdesign.study.tree import StudyTree, study_file, tree_of_file
from tvimdesign.sweep.gather import columns, parquet_library, rows, write_parquet, write_tables
from tvimdesign.sweep.plan import SweepPlan, plan_of
from tvimdesign.sweep.run_sweep import Executor, SweepDone, run_sweep
from tvimdesign.sweep.shards import SHARDS, Shards
from tvimdesign.sweep.swept_cells import CellFound, CellTable, SweptCells, open_cells


def sweep_study(
    path: Path, out: Path, executor: Executor, *, overwrite: bool, resume: bool, parquet: bool, plots: bool,
    as_json: bool, settings: Sequence[str] = (),
) -> None:  # fmt: skip
    """Sweep a study and write its folder. Raises InputError, OutputError, and TvimError for a cluster that is gone."""
    if parquet:
        parquet_library()
    plan = plan_of(tree_of_file(path, settings))
    options = {"parquet": parquet, "plots": plots}
    if executor.alone:
        command = Command(out, overwrite=overwrite, as_json=as_json, resume=resume, keep=SHARDS)
        summary = _swept(plan, executor, command, **options)
    else:
        command = Command(out, as_json=as_json, resume=True, keep=SHARDS)
        part = _part(plan, executor, command, overwrite=overwrite, **options)
        if part is None:
            return
        summary = part
    command.report(summary, f"{FILE} and the tables are")


def sweep_folder(
    plan: SweepPlan, out: Path, executor: Executor, progress: Progress, *, overwrite: bool, resume: bool,
    plots: bool = True,
) -> dict[str, Any]:  # fmt: skip
    """Answer every cell into a folder with tables, figure and page; return what is in sweep.json, and the run's times.

    Raises as `sweep_study`.
    """
    command = Command(out, overwrite=overwrite, resume=resume, keep=SHARDS, progress=progress)
    return _swept(plan, executor, command, parquet=False, plots=plots)


def _swept(plan: SweepPlan, executor: Executor, command: Command, *, parquet: bool, plots: bool) -> dict[str, Any]:
    with command:
        if plots and plan.study.write.plots:
            command.start_plotter()  # while the cells are computed
        began = time.perf_counter()
        done = run_sweep(plan, command.folder.path, executor, command.progress)
        return _gathered(plan, command, done, parquet=parquet, plots=plots, began=began)


def _part(
    plan: SweepPlan, executor: Executor, command: Command, *, overwrite: bool, parquet: bool, plots: bool
) -> dict[str, Any] | None:
    """Compute the cells of one job of an array; gather all cells if none is missing then, else return None."""
    began = time.perf_counter()
    with joined(command.out, overwrite=overwrite) as shared, progress_output() as progress:
        done = run_sweep(plan, shared, executor, progress)
    with ExitStack() as stack:
        try:
            gatherer = stack.enter_context(command) if done.whole else None
        except InputError:  # another job, which ended at the same time, gathers
            gatherer = None
        if gatherer:
            return _gathered(plan, command, done, parquet=parquet, plots=plots, began=began)
    say_part(done, executor, command.out, wide_console(), as_json=command.as_json)
    return None


def _gathered(
    plan: SweepPlan, command: Command, done: SweepDone, *, parquet: bool, plots: bool, began: float
) -> dict[str, Any]:
    """Write the tables, the figure, the page and the manifest."""
    folder = command.folder
    command.progress("gathering the cells")
    seen = CellTable(plan)
    every = seen.seeing(rows(plan, done.keys, Shards(folder.path, plan.columns)))
    write_tables(plan, every, folder.path)
    if parquet:
        write_parquet(plan, folder.path)
    results = {
        **head(), "study": plan.study.name, "task": plan.task, "method": plan.block.method, "seed": plan.block.seed,
        "cells": done.cells, "statuses": seen.statuses, "best": seen.best,
        "columns": [column._asdict() for column in columns(plan)],
    }  # fmt: skip
    if plan.study.catalog_folder:  # the explorer reads study.yaml, whose own path is relative to another folder
        results["catalog"] = str(Path(plan.study.catalog_folder).resolve())
    folder.write("study.yaml", study_file(plan.written))
    folder.write_json("sweep.json", results)
    if plots and plan.study.write.plots:
        command.start_plotter()
        drawing = Drawing("sweep", "analysis_figures.sweep", figure_data(plan, seen))
        command.begin_plots([drawing], plan.study.name, vector=plan.study.write.vector)
        folder.look_up_versions()
        command.finish_plots(again="repeat the command with --resume")
    page = sweep_page(plan, seen, command)
    spent = {name: round(value, 3) for name, value in asdict(done.spent).items()}
    seconds = time.perf_counter() - began
    timing = {"seconds": round(seconds, 3), "reused": done.reused, "computed": done.computed, **spent}
    facts = Facts([*swept_facts(plan, seen).rows, ("This run", _in_short(timing))])
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


@contextmanager
def joined(out: Path, *, overwrite: bool = False) -> Iterator[Path]:
    """Write into a folder together with other jobs; yields where. Raises InputError where it is not theirs.

    Cells of earlier results are used again.
    """
    if overwrite:
        raise InputError("--overwrite and --shard: the parts share a folder; name another one with --out")
    try:
        prepare(out)
        with suppress(FolderInUseError):  # another job prepares it, or has
            _prepare_jobs(out)
        claim = Claim(out, shared=True)
    except OSError as error:
        raise InputError(f"{out}: cannot be used as a results folder: {error.strerror or error}") from error
    try:
        yield claim.folder
    finally:
        claim.release(remove=False)


def _prepare_jobs(out: Path) -> None:
    """Make the folder that jobs write into, with the cells of earlier results. Raises FolderInUseError, OSError."""
    claim = Claim(out)
    try:
        earlier = recovered(out, claim)
        if not recorded(claim.folder):
            own = {name: digest for name, digest in earlier.files.items() if PurePosixPath(name).parts[0] == SHARDS}
            seed(out, claim.folder, own, say)
        claim.write(IN_PARTS, "")
    finally:
        claim.release(remove=False)


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


_MADE, _FAILED, _NONE = "made", "checks_fail", "not_made"


def folder_of(number: int | str) -> str:
    """Return the folder of a cell's parts."""
    return f"cell-{number}"


def chosen_cells(words: str, cells: SweptCells) -> list[int]:
    """Return numbers from words such as `3,7-9` or `best`. Raises InputError for a word that names no cell."""
    numbers: list[int] = []
    for word in words.replace(" ", "").split(","):
        first, dash, last = word.partition("-")
        if word == "best":
            numbers += cells.best
        elif first.isdecimal() and (last.isdecimal() or not dash) and int(first) <= int(last or first):
            if int(last or first) > cells.plan.count:
                raise InputError(f"--cells {words}: the sweep has the cells 1 to {cells.plan.count}")
            numbers += range(int(first), int(last or first) + 1)
        else:
            raise InputError(f"--cells {words}: {word!r} is no cell; name some such as 3,7-9, or best")
    if not numbers:
        raise InputError(f"--cells {words}: no cell of the sweep has an answer, so no parts")
    return list(dict.fromkeys(numbers))


def _evaluated(cell: CellFound) -> StudyTree:
    """Return the study of a cell's module. Raises InputError for a cell without an answer, or with a profile."""
    if not cell.answered:
        raise InputError(f"cell {cell.number}: it has no answer, so no parts; `reason` in its table says why")
    if cell.study.profile.pieces():
        raise InputError(
            f"cell {cell.number}: its current follows a profile, which a sweep's table does not hold; `run` it "
            "with its values, each by --set"
        )
    return cell.fixed


def make_parts_of_cells(source: Path, out: Path, words: str, *, overwrite: bool, as_json: bool) -> None:
    """Make the parts of chosen cells of a sweep.

    Raises InputError, OutputError; GeometryError at the end where some cell's could not be made, or break a check.
    """
    require_extra("cad", "parts")
    cells = open_cells(source)
    studies = {number: _evaluated(cells.cell(number)) for number in chosen_cells(words, cells)}
    with Command(out, overwrite=overwrite, as_json=as_json) as command:
        rows = [_made(command.folder, number, study, command.progress) for number, study in studies.items()]
        command.folder.write("parts.csv", csv_text(rows))
        reported: dict[str, Any] = {**head(), "sweep": str(source), "cells": rows}
        command.folder.write_json("parts.json", reported)
        command.headline, command.shown = f"Parts of {len(rows)} cells", [Section("cells", "", [_table(rows)])]
        command.finish("parts made", {"study": source / "study.yaml"}, {})
    command.report(reported, "Parts are")
    failed = [row for row in rows if row["status"] != _MADE]
    if failed:
        lines = [f"  cell {row['cell']}: {row['status'].replace('_', ' ')}: {row['reason']}" for row in failed]
        raise GeometryError(
            f"parts of {len(failed)} of {len(rows)} cells are not as they should be:\n" + "\n".join(lines)
        )


def _made(folder: ResultsFolder, number: int, study: StudyTree, progress: Progress) -> dict[str, Any]:
    """Make the parts of one cell; return its row of the table."""
    name, status, reason, checks, failed = folder_of(number), _MADE, "", 0, 0
    progress(f"parts of cell {number}")
    try:
        design = folder.write(f"{name}/design.json", design_json(answer(read_tree(study)).design))
        report = make_parts_of(design, design.parent / "cad", progress)
        checks, failed = len(report.checks), len(report.failed)
        if failed:
            status, reason = _FAILED, "; ".join(check.text for check in report.failed)
    except TvimError as error:
        status, reason = _NONE, str(error)
    return {"cell": number, "status": status, "checks": checks, "failed": failed, "folder": name, "reason": reason}


def _table(rows: Sequence[dict[str, Any]]) -> Grid:
    cells = [
        (str(row["cell"]), row["status"].replace("_", " "), f"{row['checks'] - row['failed']} of {row['checks']}",
         row["folder"])
        for row in rows
    ]  # fmt: skip
    return grid("", ("cell", "parts", "checks that pass", "folder"), cells, right=(0, 2))
