"""The command `tolerate`: what tolerances do, drawn here, as the jobs of an array, or on a cluster."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tvimdesign.cli.folders import name_of
from tvimdesign.cli.options import AsJson, Out, Overwrite, StudyOrDesign
from tvimdesign.cli.shared_options import Resume, Scheduler, Shard


def tolerate(
    study: StudyOrDesign,
    samples: Annotated[int, typer.Option("--samples", help="Modules drawn; the next power of two.")] = 65536,
    workers: Annotated[
        int,
        typer.Option(
            "--workers",
            min=0,
            help="Threads; processes with --shard or --resume; as many as processors unless given.",
        ),
    ] = 0,
    shard: Shard = "",
    scheduler: Scheduler = "",
    resume: Resume = False,
    out: Out = None,
    overwrite: Overwrite = False,
    json: AsJson = False,
) -> None:
    """Say what tolerances do: worst case, root-sum-square and Monte Carlo, yield, into results/<study>-tolerances."""
    from tvimdesign.report.tolerate.tolerate_study import tolerate_study
    from tvimdesign.sweep.run_sweep import Where

    folder, where = out or Path("results") / f"{name_of(study)}-tolerances", Where.of(workers, scheduler, shard)
    tolerate_study(
        study, folder, samples, workers, overwrite=overwrite, as_json=json, where=where if where.said else None,
        resume=resume,
    )  # fmt: skip
