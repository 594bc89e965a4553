"""The command `sweep`, from a study file to a finished folder: the order of things, and what is written."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import TvimError
from tvimdesign.report.command import PARTLY_DONE, done_in_part, not_done, noting
from tvimdesign.report.output.number_format import head
from tvimdesign.report.output.progress import Progress, progress_output, wide_console
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.shared_folder import gatherer, joined, say_part
from tvimdesign.report.sweep.cell_table import CellTable
from tvimdesign.report.sweep.sweep_drawing import DRAWN_FROM, KeptFigure, SweepDrawing, kept_figure
from tvimdesign.report.sweep.sweep_page import kept_page, write_sweep_page
from tvimdesign.report.sweep.sweep_screen import print_sweep
from tvimdesign.study.tree import study_file, tree_of_file
from tvimdesign.sweep.gather import columns, parquet_library, rows, write_parquet, write_tables
from tvimdesign.sweep.plan import SweepPlan, plan_of
from tvimdesign.sweep.run_sweep import SweepDone, Where, run_sweep
from tvimdesign.sweep.shards import SHARDS, Shards


def sweep_study(
    path: Path, out: Path, where: Where, *, overwrite: bool, resume: bool, parquet: bool, plots: bool, as_json: bool,
    settings: Sequence[str] = (),
) -> None:  # fmt: skip
    """Sweep a study and write its folder. Raises InputError, OutputError, and TvimError for a cluster that is gone."""
    if parquet:
        parquet_library()
    plan = plan_of(tree_of_file(path, settings))
    if not where.alone:
        _part(plan, out, where, overwrite=overwrite, parquet=parquet, plots=plots, as_json=as_json)
        return
    with progress_output() as progress:
        told = sweep_folder(
            plan, out, where, progress, overwrite=overwrite, resume=resume, parquet=parquet, plots=plots
        )
    _say(told, plan, out, as_json=as_json)


def sweep_folder(
    plan: SweepPlan, out: Path, where: Where, progress: Progress, *, overwrite: bool, resume: bool,
    parquet: bool = False, plots: bool = True,
) -> dict[str, Any]:  # fmt: skip
    """Answer every cell into a folder with tables, figure and page; returns what is told. Raises as `sweep_study`."""
    with ExitStack() as stack:
        kept = kept_figure(out) if resume else KeptFigure()
        page = kept_page(out) if resume else b""
        figure = SweepDrawing(stack, kept) if plots and plan.study.write.plots else None
        folder = stack.enter_context(ResultsFolder(out, overwrite, resume, SHARDS))
        if figure:
            figure.expect()
        began = time.perf_counter()
        done = run_sweep(plan, folder.path, where, progress)
        return _gathered(plan, folder, done, progress, figure, page, parquet=parquet, began=began)


def _part(
    plan: SweepPlan, out: Path, where: Where, *, overwrite: bool, parquet: bool, plots: bool, as_json: bool
) -> None:
    """One job of an array: its cells alone; the job after which every cell is there gathers them."""
    with ExitStack() as stack:
        progress = stack.enter_context(progress_output())
        began = time.perf_counter()
        with joined(out, overwrite=overwrite) as shared:
            done = run_sweep(plan, shared, where, progress)
        folder = gatherer(stack, out) if done.whole else None
        if folder is None:
            say_part(done, where, out, wide_console(), as_json=as_json)
            return
        figure = SweepDrawing(stack, KeptFigure()) if plots and plan.study.write.plots else None
        told = _gathered(plan, folder, done, progress, figure, parquet=parquet, began=began)
    _say(told, plan, out, as_json=as_json)


def _gathered(
    plan: SweepPlan, folder: ResultsFolder, done: SweepDone, progress: Progress, figure: SweepDrawing | None,
    kept: bytes = b"", *, parquet: bool, began: float,
) -> dict[str, Any]:  # fmt: skip
    """Write the tables, the figure, the page and the manifest; returns what is told. `kept` is the page of before."""
    progress("gathering the cells")
    seen = CellTable(plan)
    every = seen.seeing(rows(plan, done.keys, Shards(folder.path, plan.columns)))
    write_tables(plan, every, folder.path)
    if parquet:
        write_parquet(plan, folder.path)
    found = {
        **head(), "study": plan.study.name, "task": plan.task, "method": plan.block.method, "seed": plan.block.seed,
        "cells": done.cells, "statuses": seen.statuses, "best": seen.best,
        "columns": [column._asdict() for column in columns(plan)],
    }  # fmt: skip
    if plan.study.catalog_folder:  # the explorer reads study.yaml, whose own word for it is as seen from elsewhere
        found["catalog"] = str(Path(plan.study.catalog_folder).resolve())
    folder.write("study.yaml", study_file(plan.written))
    folder.write_json("sweep.json", found)
    failures: list[TvimError] = []
    if figure:
        with noting(failures):
            found[DRAWN_FROM] = figure.draw(plan, seen, folder)
            folder.write_json("sweep.json", found)
    write_sweep_page(plan, seen, folder, kept)
    spent = {name: round(value, 3) for name, value in asdict(done.spent).items()}
    seconds = time.perf_counter() - began
    timing = {"seconds": round(seconds, 3), "reused": done.reused, "computed": done.computed, **spent}
    status = PARTLY_DONE if failures else "swept"
    folder.finish(
        status, {"study": plan.tree.path} if plan.tree.path else {}, {"solver": {"seed": plan.block.seed}}, timing
    )
    progress("")
    return {**found, "run": timing, "folder": str(folder.out), **not_done(failures)}


def _say(told: dict[str, Any], plan: SweepPlan, out: Path, *, as_json: bool) -> None:
    """Print the results. Raises TvimError if the figure is missing."""
    if as_json:
        print(json.dumps(told, indent=2, allow_nan=False))
    else:
        print_sweep(told, plan, out, wide_console())
    if told["not_done"]:
        raise done_in_part([TvimError(text) for text in told["not_done"]])
