"""Arguments and options that several commands have, their completions on Tab, and where results go by default."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import typer

_STUDIES = (".yaml", ".yml")


def study_files(incomplete: str) -> list[str]:
    """Complete study files and folders that begin so; hidden ones are left out."""
    return _files(incomplete, _STUDIES)


def designs_and_studies(incomplete: str) -> list[str]:
    """Complete names of designs and studies."""
    return _files(incomplete, (*_STUDIES, ".json"))


def tests(incomplete: str) -> list[str]:
    """Complete virtual tests."""
    from tvimdesign.simulation.virtual_tests import TESTS

    return _beginning(TESTS, incomplete)


def kinds(incomplete: str) -> list[str]:
    """Complete kinds of measurement."""
    from tvimdesign.report.fit import kind_sheets

    return _beginning(kind_sheets(), incomplete)


def examples(incomplete: str) -> list[str]:
    """Complete shipped studies."""
    from tvimdesign.report.run.study_files import example_names

    return _beginning(example_names(), incomplete)


def modes(incomplete: str) -> list[str]:
    """Complete modes of a module."""
    from tvimdesign.report.rows import mode_names

    return _beginning(mode_names(), incomplete)


def rows(incomplete: str) -> list[str]:
    """Complete names of rows of either mode."""
    from tvimdesign.report.rows import row_names

    return _beginning(row_names(), incomplete)


def settings(incomplete: str) -> list[str]:
    """Complete inputs and choices, and outputs after `require.`, each with the `=` of a setting."""
    from tvimdesign.report.rows import setting_names

    return _beginning(setting_names(), incomplete)


def _beginning(names: Iterable[str], incomplete: str) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]


def _files(incomplete: str, endings: tuple[str, ...]) -> list[str]:
    start = Path(incomplete or ".")
    folder, begin = (start, "") if not incomplete or incomplete.endswith("/") else (start.parent, start.name)
    prefix = incomplete[: len(incomplete) - len(begin)] if begin else incomplete
    try:
        paths = sorted(folder.iterdir())
    except OSError:
        return []
    shown = [path for path in paths if path.name.startswith(begin) and not path.name.startswith(".")]
    folders = [f"{prefix}{path.name}/" for path in shown if path.is_dir()]
    return [f"{prefix}{path.name}" for path in shown if path.suffix in endings] + folders


StudyFile = Annotated[Path, typer.Argument(metavar="STUDY", help="Study file (YAML).", autocompletion=study_files)]
StudyOrDesign = Annotated[
    Path,
    typer.Argument(
        metavar="STUDY|DESIGN",
        help="Study file, or design.json or folder of a run.",
        autocompletion=designs_and_studies,
    ),
]
ResultOfRun = Annotated[
    Path,
    typer.Argument(metavar="RESULT", help="Folder or design.json of a run.", autocompletion=designs_and_studies),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Change the study for this once, as often as needed: pcl_thickness='1.2 mm' fixes an input or a choice, "
        "require.holding_torque='>= 15 N.m' sets what stands at a path.",
        autocompletion=settings,
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
