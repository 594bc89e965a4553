"""Arguments and options that several commands have."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tvimdesign.cli import completions

StudyFile = Annotated[
    Path, typer.Argument(metavar="STUDY", help="Study file (YAML).", autocompletion=completions.study_files)
]
StudyOrDesign = Annotated[
    Path,
    typer.Argument(
        metavar="STUDY|DESIGN",
        help="Study file, or design.json or folder of a run.",
        autocompletion=completions.designs_and_studies,
    ),
]
ResultOfRun = Annotated[
    Path,
    typer.Argument(
        metavar="RESULT", help="Folder or design.json of a run.", autocompletion=completions.designs_and_studies
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Change the study for this once, as often as needed: pcl_thickness='1.2 mm' fixes an input or a choice, "
        "require.holding_torque='>= 15 N.m' sets what stands at a path.",
        autocompletion=completions.settings,
    ),
]
Out = Annotated[
    Path | None, typer.Option("--out", help="Folder for the results; results/<name of the study's file> unless given.")
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace the results of an earlier run in that folder.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print results as JSON.")]
FePython = Annotated[
    str,
    typer.Option("--fe-python", metavar="PATH", help="A Python that has netgen and ngsolve; this one unless given."),
]
