"""The command `compare`: studies beside each other."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tvimdesign.cli import completions
from tvimdesign.cli.options import AsJson, Overwrite, Settings


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
    overwrite: Overwrite = False,
    plots: Annotated[bool, typer.Option("--plots/--no-plots", help="Draw the plots.")] = True,
    settings: Settings = None,
    json: AsJson = False,
) -> None:
    """Hold studies with the same requirements against each other: as drawn, and each optimised for itself."""
    from tvimdesign.report.compare.compare_studies import compare_studies

    compare_studies(
        studies, out or Path("results") / "-vs-".join(study.stem for study in studies), points=points,
        overwrite=overwrite, plots=plots, as_json=json, settings=settings or (),
    )  # fmt: skip
