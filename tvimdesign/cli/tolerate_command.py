"""The command `tolerate`: worst case, spread and yield."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tvimdesign.cli.folders import name_of
from tvimdesign.cli.options import AsJson, Out, Overwrite, StudyOrDesign


def tolerate(
    study: StudyOrDesign,
    samples: Annotated[int, typer.Option("--samples", help="Modules drawn; the next power of two.")] = 65536,
    workers: Annotated[int, typer.Option("--workers", min=0, help="Threads; as many as processors unless given.")] = 0,
    out: Out = None,
    overwrite: Overwrite = False,
    json: AsJson = False,
) -> None:
    """Say what tolerances do: worst case, root-sum-square and Monte Carlo, yield, into results/<study>-tolerances."""
    from tvimdesign.report.tolerate.tolerate_study import tolerate_study

    folder = out or Path("results") / f"{name_of(study)}-tolerances"
    tolerate_study(study, folder, samples, workers, overwrite=overwrite, as_json=json)
