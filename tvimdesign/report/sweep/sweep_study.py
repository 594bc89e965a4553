"""The command sweep, from a study file to a finished folder: the order of things, what is written and shown.

The folder of a sweep that the jobs of an array share: the job after which every cell is there gathers them.
"""

from __future__ import annotations

import hashlib
import json
import os
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from rich.console import Console
from rich.markup import escape

from tvimdesign import __version__
from tvimdesign.base.atomic_files import recorded
from tvimdesign.base.errors import FolderInUseError, InputError
from tvimdesign.base.units import pretty
from tvimdesign.page.page_file import FILE
from tvimdesign.report.output.claim import IN_PARTS, Claim
from tvimdesign.report.output.command import Command, not_done
from tvimdesign.report.output.manifest import seed
from tvimdesign.report.output.numbers import head, number
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.results_folder import prepare, recovered, say
from tvimdesign.report.output.terminal import Progress, duration, progress_output, wide_console
from tvimdesign.report.sweep.sweep_figures import CellTable, figure_data
from tvimdesign.report.sweep.sweep_page import kept_page, write_sweep_page
from tvimdesign.study.tree import study_file, tree_of_file
from tvimdesign.sweep.gather import columns, parquet_library, rows, write_parquet, write_tables
from tvimdesign.sweep.plan import SweepPlan, plan_of
from tvimdesign.sweep.run_sweep import Executor, SweepDone, run_sweep
from tvimdesign.sweep.shards import SHARDS, Shards

DRAWN_FROM = "drawn_from"
"""Name of the figure's mark in sweep.json."""


def print_sweep(summary: dict[str, Any], plan: SweepPlan, console: Console) -> None:
    """Print how the cells ended, the best of them, and where to look first."""
    run = summary["run"]
    done = "evaluated" if summary["task"] == "evaluate" else "optimised"
    console.print(f"[bold]{escape(summary['study'])}[/bold]: {summary['cells']} cells {done} ({summary['method']})")
    ended = ", ".join(f"{count} {status.replace('_', ' ')}" for status, count in summary["statuses"].items())
    console.print(f"  {escape(ended)}", soft_wrap=True)
    console.print(f"  {run['reused']} reused, {run['computed']} computed in {duration(run['seconds'])}{_work(run)}")
    for name, best in summary["best"].items():
        console.print(f"  least {name}: {_best(best, plan)}", soft_wrap=True)
    if not summary["best"]:
        console.print("  no cell is feasible: `reason` in the table says which limits each breaks")


def _work(run: dict[str, Any]) -> str:
    if not run["computed"]:
        return ""
    each = f", {1e3 * run['cells_s'] / max(run['cells'], 1):.0f} ms of the processor a cell"
    died = f", {run['died']} workers died and were replaced" if run["died"] else ""
    return each + died


def _best(best: dict[str, Any], plan: SweepPlan) -> str:
    texts = plan.points.texts(int(best["cell"]) - 1)
    at = ", ".join(f"{axis.name} {text}" for axis, text in zip(plan.axes, texts, strict=True))
    unit = pretty(best["unit"])
    return escape(f"{number(best['value'])}{f' {unit}' if unit else ''} in cell {best['cell']:g} ({at})")


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
    command.report(summary, lambda console: print_sweep(summary, plan, console), f"{FILE} and the tables are")


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
    resume = command.resume
    earlier = (kept_figure(command.out), kept_page(command.out)) if resume else (KeptFigure(), b"")
    with command:
        if plots and plan.study.write.plots and not earlier[0].mark:
            command.start_plotter()  # while the cells are computed
        began = time.perf_counter()
        done = run_sweep(plan, command.folder.path, executor, command.progress)
        return _gathered(plan, command, done, earlier, parquet=parquet, plots=plots, began=began)


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
            return _gathered(plan, command, done, (KeptFigure(), b""), parquet=parquet, plots=plots, began=began)
    say_part(done, executor, command.out, wide_console(), as_json=command.as_json)
    return None


def _gathered(
    plan: SweepPlan, command: Command, done: SweepDone, prior: tuple[KeptFigure, bytes], *, parquet: bool, plots: bool,
    began: float,
) -> dict[str, Any]:  # fmt: skip
    """Write the tables, the figure, the page and the manifest; `kept` are figure and page of an earlier sweep."""
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
        mark = _draw(plan, command, figure_data(plan, seen), prior[0])
        if not command.failures:
            results[DRAWN_FROM] = mark
            folder.write_json("sweep.json", results)
    write_sweep_page(plan, seen, folder, prior[1])
    spent = {name: round(value, 3) for name, value in asdict(done.spent).items()}
    seconds = time.perf_counter() - began
    timing = {"seconds": round(seconds, 3), "reused": done.reused, "computed": done.computed, **spent}
    inputs = {"study": plan.tree.path} if plan.tree.path else {}
    command.finish("swept", inputs, {"solver": {"seed": plan.block.seed}}, timing)
    return {**results, "run": timing, "folder": str(folder.out), **not_done(command.failures)}


@dataclass(frozen=True)
class KeptFigure:
    """Files of a figure, and the mark of what it was drawn from; both empty where there is none."""

    mark: str = ""
    files: dict[str, bytes] = field(default_factory=dict)


def mark_of(data: dict[str, Any], *, vector: bool) -> str:
    """Mark of a figure: of its data, its forms, and the version that draws it."""
    text = json.dumps([__version__, vector, data], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def kept_figure(folder: Path) -> KeptFigure:
    """Return the figure that a folder has; its files are read, as a sweep that is resumed clears them away."""
    try:
        mark = json.loads((folder / "sweep.json").read_bytes()).get(DRAWN_FROM, "")
        files = {path.name: path.read_bytes() for path in folder.glob("sweep.*") if path.suffix != ".json"}
    except (OSError, ValueError, AttributeError):
        return KeptFigure()
    return KeptFigure(mark, files) if mark and files else KeptFigure()


def _draw(plan: SweepPlan, command: Command, data: dict[str, Any], earlier: KeptFigure) -> str:
    """Draw the figure, or restore an earlier one that was drawn from the same; return its mark."""
    vector, folder = plan.study.write.vector, command.folder
    mark = mark_of(data, vector=vector)
    if mark == earlier.mark:
        for name, content in earlier.files.items():
            folder.write(name, content)
        return mark
    command.start_plotter()
    command.begin_plots([Drawing("sweep", "analysis_figures.sweep", data)], plan.study.name, vector=vector)
    folder.look_up_versions()
    command.finish_plots(again="repeat the command with --resume")
    return mark


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
