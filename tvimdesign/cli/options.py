"""Arguments and options that several commands have, and where their results go by default."""

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
Workers = Annotated[int, typer.Option("--workers", min=0, help="Processes here; as many as processors unless given.")]
Shard = Annotated[
    str,
    typer.Option(
        "--shard", metavar="I/N", help="Compute part I of N: a job of a batch system's array; all share the folder."
    ),
]
Scheduler = Annotated[
    str, typer.Option("--scheduler", metavar="ADDRESS", help="Compute on a dask cluster, such as tcp://host:8786.")
]
Resume = Annotated[
    bool, typer.Option("--resume", help="Go on in that folder: cells that are there are not computed again.")
]


def default_folder(source: Path) -> Path:
    """Return results/<study>; for a design a folder beside the run's, with -cad after the design's name."""
    if source.suffix != ".json":
        return Path("results") / source.stem
    folder = source.resolve().parent
    beside = folder.parent.parent if folder.name == "front" and source.name != "design.json" else folder.parent
    return beside / f"{name_of(source)}-cad"


def name_of(source: Path) -> str:
    """Return the name for folders of a study or a design: <run>, or <run>-front-03 of one of several in a folder."""
    if source.suffix != ".json":
        return source.resolve().name if source.is_dir() else source.stem
    folder, own = source.resolve().parent, source.name.removesuffix(".json").removesuffix(".design")
    if own == "design":
        return folder.name
    return f"{folder.parent.name}-front-{own}" if folder.name == "front" else f"{folder.name}-{own}"
