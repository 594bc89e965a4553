"""The command `sweep`: many cells of a study, on this machine, as the jobs of an array, or on a cluster."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tvimdesign.cli.folders import name_of
from tvimdesign.cli.options import AsJson, Out, Overwrite, Settings, StudyFile
from tvimdesign.cli.shared_options import Resume, Scheduler, Shard, Workers


def sweep(
    study: StudyFile,
    out: Out = None,
    overwrite: Overwrite = False,
    resume: Resume = False,
    workers: Workers = 0,
    shard: Shard = "",
    scheduler: Scheduler = "",
    parquet: Annotated[bool, typer.Option("--parquet", help="Write cells.parquet too.")] = False,
    plots: Annotated[bool, typer.Option("--plots/--no-plots", help="Draw the figure.")] = True,
    time_limit: Annotated[
        str, typer.Option("--time-limit", metavar="TIME", help="End the search of a cell then; 30 min.")
    ] = "",
    settings: Settings = None,
    json: AsJson = False,
) -> None:
    """Answer every cell of a study's `sweep:` and gather them to a table, into results/<study>-sweep."""
    from tvimdesign.report.sweep.sweep_study import sweep_study
    from tvimdesign.sweep.run_sweep import Where

    sweep_study(
        study, out or Path("results") / f"{name_of(study)}-sweep", Where.of(workers, scheduler, shard),
        overwrite=overwrite, resume=resume, parquet=parquet, plots=plots, as_json=json,
        settings=[*(settings or ()), *([f"solver.time_limit={time_limit}"] if time_limit else [])],
    )  # fmt: skip
