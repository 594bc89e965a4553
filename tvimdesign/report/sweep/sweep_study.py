"""The command sweep, from a study file to a finished folder.

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

from tvimdesign.base.atomic_files import files_in
from tvimdesign.base.claim import IN_PARTS, Claim
from tvimdesign.base.errors import FolderInUseError, InputError
from tvimdesign.base.manifest import seed
from tvimdesign.base.results_folder import prepare, recovered, say
from tvimdesign.page.blocks import Facts, Section
from tvimdesign.page.page_file import FILE
from tvimdesign.report.output.command import Command
from tvimdesign.report.output.numbers import head
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.terminal import Progress, duration, progress_output, wide_console
from tvimdesign.report.sweep.sweep_figures import figure_data
from tvimdesign.report.sweep.sweep_page import sweep_page, swept_facts
from tvimdesign.study.tree import study_file, tree_of_file
from tvimdesign.sweep.gather import columns, rows, write_tables
from tvimdesign.sweep.plan import SweepPlan, plan_of
from tvimdesign.sweep.run_sweep import Executor, SweepDone, run_sweep
from tvimdesign.sweep.shards import SHARDS, Shards
from tvimdesign.sweep.swept_cells import CellTable


def sweep_study(
    path: Path, out: Path, executor: Executor, *, overwrite: bool, resume: bool, plots: bool, as_json: bool,
    settings: Sequence[str] = (),
) -> None:  # fmt: skip
    """Sweep a study and write its folder. Raises InputError, OutputError."""
    plan = plan_of(tree_of_file(path, settings))
    if executor.alone:
        command = Command(out, overwrite=overwrite, as_json=as_json, resume=resume, keep=SHARDS)
        summary = _swept(plan, executor, command, plots=plots)
    else:
        command = Command(out, as_json=as_json, resume=True, keep=SHARDS)
        part = _part(plan, executor, command, overwrite=overwrite, plots=plots)
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
    return _swept(plan, executor, command, plots=plots)


def _swept(plan: SweepPlan, executor: Executor, command: Command, *, plots: bool) -> dict[str, Any]:
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
    with joined(command.out, overwrite=overwrite) as shared, progress_output() as progress:
        done = run_sweep(plan, shared, executor, progress)
    with ExitStack() as stack:
        try:
            gatherer = stack.enter_context(command) if done.whole else None
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
    seen = CellTable(plan)
    every = seen.seeing(rows(plan, done.keys, Shards(folder.path, plan.columns)))
    write_tables(plan, every, folder.path)
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
        if not files_in(claim.folder):
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
