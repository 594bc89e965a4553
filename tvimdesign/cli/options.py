"""Arguments and options that several commands have, their completions on Tab, and where results go by default."""

from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

_STUDIES = (".yaml", ".yml")


def study_files(incomplete: str) -> list[str]:
    """Complete study files and folders that begin so; hidden ones are left out."""
    return _files(incomplete, _STUDIES)


def designs_and_studies(incomplete: str) -> list[str]:
    """Complete names of designs and studies."""
    return _files(incomplete, (*_STUDIES, ".json"))


def _completing(place: str) -> Callable[[str], list[str]]:
    """Return a completion of the names that `module:name` has, or returns; the module is loaded on Tab."""

    def complete(incomplete: str) -> list[str]:
        module, _, name = place.partition(":")
        names = getattr(import_module(module), name)
        return [name for name in (names() if callable(names) else names) if name.startswith(incomplete)]

    return complete


tests = _completing("tvimdesign.simulation.virtual_tests:TESTS")
kinds = _completing("tvimdesign.simulation.measurement.measure_files:kind_sheets")
examples = _completing("tvimdesign.study.written_studies:examples")
processes = _completing("tvimdesign.study.sizing:processes")
modes = _completing("tvimdesign.report.rows:MODES")
rows = _completing("tvimdesign.report.rows:row_names")
settings = _completing("tvimdesign.report.rows:setting_names")


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


StudyFile = Annotated[Path, Argument(metavar="STUDY", help="Study file (YAML).", autocompletion=study_files)]
StudyOrDesign = Annotated[
    Path,
    Argument(
        metavar="STUDY|DESIGN",
        help="Study file, or design.json or folder of a run.",
        autocompletion=designs_and_studies,
    ),
]
ResultOfRun = Annotated[
    Path, Argument(metavar="RESULT", help="Folder or design.json of a run.", autocompletion=designs_and_studies)
]
Settings = Annotated[
    list[str] | None,
    Option(
        "--set",
        metavar="NAME=VALUE",
        help="Change the study for this once, as often as needed: pcl_thickness='1.2 mm' fixes an input or a choice, "
        "require.holding_torque='>= 15 N.m' sets what stands at a path.",
        autocompletion=settings,
    ),
]
Out = Annotated[
    Path | None, Option("--out", help="Folder for the results; results/<name of the study's file> unless given.")
]
Overwrite = Annotated[bool, Option("--overwrite", help="Replace the results of an earlier run in that folder.")]
Cad = Annotated[bool, Option("--cad/--no-cad", help="Make the parts: STEP, 3MF, drawings, assembly.")]
Plots = Annotated[bool, Option("--plots/--no-plots", help="Draw the plots.")]
TimeLimit = Annotated[
    str, Option("--time-limit", metavar="TIME", help="End the search then, with the best design found; 30 min.")
]
AsJson = Annotated[bool, Option("--json", help="Print results as JSON.")]
FePython = Annotated[
    str, Option("--fe-python", metavar="PATH", help="A Python that has netgen and ngsolve; this one unless given.")
]
Workers = Annotated[int, Option("--workers", min=0, help="Processes here; as many as processors unless given.")]
Shard = Annotated[
    str,
    Option(
        "--shard", metavar="I/N", help="Compute part I of N: a job of a batch system's array; all share the folder."
    ),
]
Resume = Annotated[bool, Option("--resume", help="Go on in that folder: cells that are there are not computed again.")]


def changes(settings: Sequence[str] | None, time_limit: str) -> list[str]:
    """Return the changes to a study, with its time limit if one is given."""
    return [*(settings or ()), *([f"solver.time_limit={time_limit}"] if time_limit else [])]


def results(source: Path, ending: str) -> Path:
    """Return results/<name>-<ending>, the default folder of a command on a study or a result."""
    return Path("results") / f"{name_of(source)}-{ending}"


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
