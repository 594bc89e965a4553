"""The command `compare`: studies against each other, answered here, as the jobs of an array, or on a cluster."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tvimdesign.cli import completions
from tvimdesign.cli.options import AsJson, Overwrite, Settings
from tvimdesign.cli.shared_options import Resume, Scheduler, Shard


def compare(
    studies: Annotated[
        list[Path],
        typer.Argument(
            metavar="STUDY STUDY...", help="Study files, of any modes.", autocompletion=completions.study_files
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option("--out", help="Folder for the results; results/<first>-vs-<second> unless given."),
    ] = None,
    points: Annotated[int, typer.Option("--points", min=0, help="Points of each front; 0 draws none.")] = 6,
    workers: Annotated[
        int,
        typer.Option(
            "--workers",
            min=0,
            help="Processes with --shard or --resume: one a processor unless given; else two.",
        ),
    ] = 0,
    shard: Shard = "",
    scheduler: Scheduler = "",
    resume: Resume = False,
    overwrite: Overwrite = False,
    plots: Annotated[bool, typer.Option("--plots/--no-plots", help="Draw the plots.")] = True,
    settings: Settings = None,
    json: AsJson = False,
) -> None:
    """Hold studies with the same requirements against each other: as drawn, and each optimised for itself."""
    from tvimdesign.report.compare.compare_studies import compare_studies
    from tvimdesign.sweep.run_sweep import Where

    where = Where.of(workers, scheduler, shard)
    compare_studies(
        studies, out or Path("results") / "-vs-".join(study.stem for study in studies), points=points,
        overwrite=overwrite, plots=plots, as_json=json, settings=settings or (),
        where=where if where.said else Where(workers) if resume else None, resume=resume,
    )  # fmt: skip
