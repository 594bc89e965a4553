"""Files a user starts from: a commented study, a shipped one, the study of a joint from five numbers, the schema."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.errors import BelowYieldError, InfeasibleError, InputError
from tvimdesign.base.units import format_quantity, pretty
from tvimdesign.report.output.numbers import ends_text, held_by, label
from tvimdesign.study import read_design, tree_of_text, written_studies
from tvimdesign.study.sizing import STROKE, JointTask, in_options
from tvimdesign.study.text.mistakes import printable

if TYPE_CHECKING:
    from tvimdesign.report.run.answered_study import AnsweredStudy
    from tvimdesign.solve.sized_joint import NoHardware
    from tvimdesign.study import StudyTree


def list_examples() -> None:
    """Print the shipped studies, each with what it is about."""
    for name, about in written_studies.examples().items():
        print(f"{name}\n    {about}")


def write_new_study(file: Path | None, example: str = "", result: Path | None = None, *, built: bool = False) -> None:
    """Write a commented study, a copy of a shipped one, or the module of a result as a study that evaluates it.

    Raises InputError where the file is there already, or the result is none.
    """
    if example and result:
        raise InputError("--example and --from: choose one")
    if built and not result:
        raise InputError("--built: name the result by --from")
    file = file or Path(f"{example or 'study'}.yaml")
    text = written_studies.example_text(example, file.stem) if example else written_studies.template_text()
    if result:
        source = result / "design.json" if result.is_dir() else result
        text = written_studies.result_text(read_design(source), printable(source), file.resolve().parent, built=built)
    try:
        with file.open("x", encoding="utf-8") as stream:
            stream.write(text)
    except FileExistsError as error:
        raise InputError(f"{file}: exists already; name another file") from error
    except OSError as error:
        raise InputError(f"{file}: cannot be written: {error.strerror}") from error
    print(f"{file} written; next: tvimdesign run {file}")
    print(f"names and units while you type: tvimdesign schema > {file.with_name(written_studies.SCHEMA_FILE)}")


def size_study(file: Path, numbers: Mapping[str, str], out: Path, *, overwrite: bool, **run: Any) -> None:
    """Write the study of a joint and run it into a folder; `run` are options of `run_study`.

    The study is written for editing, too, if no hardware fits. Raises InputError for a quantity that is none and a file
    that is there, InfeasibleError for a joint that no hardware fits, and what `run_study` raises.
    """
    from tvimdesign.report.output.terminal import progress_output
    from tvimdesign.report.run.run_study import run_study
    from tvimdesign.solve.sized_joint import sized_texts  # it loads the compiler

    task = JointTask.read(**numbers)
    if file.exists() and not overwrite:
        raise InputError(f"{file}: exists already; name another file, or say --overwrite")
    atomic_write(file, task.draft(file.stem).encode())
    notes = [f"stroke of {STROKE} to either side of rest assumed; --stroke changes it"] if task.assumes_stroke else []
    first = True
    for text, cautious in sized_texts(partial(_chosen, file, task)):
        notes += [] if task.process or not first else [f"{process_of(text)}; --process changes it"]
        if not cautious:
            with progress_output() as progress:
                notes.append(no_room(task, progress))
        atomic_write(file, (text if cautious else described(text, notes[-1])).encode())
        print(*notes, sep="\n", file=sys.stderr)
        try:
            run_study(file, out, overwrite=overwrite or not first, gives_up=cautious, **run)
        except InfeasibleError as error:
            if not (cautious and isinstance(error, BelowYieldError)):
                raise type(error)(in_options(str(error), label)) from error
            notes, first = ["with room for the assumed values the yield is missed"], False
        else:
            return


def described(text: str, note: str) -> str:
    """Return a study that `size` wrote with a note as its description."""
    return text.replace("\nmode: ", f'\ndescription: "{note[0].upper()}{note[1:]}."\nmode: ', 1)


def choose_sized(task: JointTask, name: str, progress: Callable[[str], None]) -> tuple[StudyTree, AnsweredStudy | None]:
    """Return the study with room for the assumed values, with its answer, or the one without if the yield is missed."""
    from tvimdesign.report.run.answered_study import answer_study
    from tvimdesign.report.run.uncertainty_data import below_yield
    from tvimdesign.solve.search import optimize
    from tvimdesign.solve.sized_joint import sized_texts

    for text, cautious in sized_texts(lambda room: sized_text(task, name, progress, room=room)):
        tree = tree_of_text(text, f"{name}.yaml", name, Path())
        answered = answer_study(tree, progress, search=optimize) if cautious else None
        if answered is not None and not below_yield(answered.result):
            break
    return tree, answered


def _chosen(file: Path, task: JointTask, room: bool) -> str:
    """Return the study of a joint; a refusal names the options of `size`, and the file of the study as asked."""
    from tvimdesign.report.output.terminal import progress_output

    with progress_output() as progress:
        try:
            return sized_text(task, file.stem, progress, room=room)
        except InfeasibleError as error:
            as_asked = f"{file} has the study as it was asked; --overwrite replaces it."
            raise InfeasibleError(f"{in_options(str(error), label)}\n{as_asked}") from error


def no_room(task: JointTask, progress: Callable[[str], None]) -> str:
    """Return what it means that no hardware has room for the assumed values, and the next diameter that has."""
    from tvimdesign.solve.sized_joint import roomy_diameter

    progress("looking for a diameter with room for the assumed values")
    roomy = roomy_diameter(task)
    size = f"--diameter '{roomy}'" if roomy else "no larger --diameter"
    return (
        "no listed hardware leaves room for errors of assumed values: where one is worse than assumed, the module may "
        f"miss a limit; {size} leaves room for most of them, by estimate: for each limit alone, not for all at once"
    )


def process_of(text: str) -> str:
    """Return which process a study that `size` wrote takes, and why, as its line says."""
    line = next((line.strip() for line in text.splitlines() if line.startswith("  process: ")), "process: the default")
    process, _, why = line.removeprefix("process: ").partition("#")
    return ": ".join(filter(None, [f"made by {process.strip()}", why.strip()]))


def sized_text(
    task: JointTask, name: str, progress: Callable[[str], None] = lambda _: None, *, room: bool = True
) -> str:
    """Return the study of a joint, with hardware that fits; hardware with `room` for the assumed values comes first.

    Raises InfeasibleError, with the nearest numbers that were tried and have such hardware.
    """
    from tvimdesign.solve.sized_joint import find_hardware

    text = find_hardware(task, name, progress, room=room)
    if isinstance(text, str):
        return text
    raise InfeasibleError(refusal(task, name, text))


def refusal(task: JointTask, name: str, none: NoHardware) -> str:
    """Return why there is no study of a joint, and what to ask for instead."""
    size, hold = format_quantity(task.diameter, "mm", 3), format_quantity(task.torque, "N*m", 3)
    soft = f"{ends_text(*task.stiffness)} {pretty('N*m/rad')} soft over ±{format_quantity(task.stroke, 'deg', 3)}"
    lines = [f"{name}: no joint of {size} holds {hold} frozen and has {soft}, with margins for its tolerances."]
    if none.longest:
        most = format_quantity(none.longest.value, "deg", 3)
        lines.append(f"±{most} is the largest stroke that {held_by(none.longest.held_by)} allow at that diameter.")
    if none.least:
        least = format_quantity(none.least.value, "mm", 3)
        lines.append(f"{least} is the least that {held_by(none.least.held_by)} allow.")
    ways = ["  " + " ".join(f"--{option} '{value}'" for option, value in way.items()) for way in none.ways]
    if not ways:
        least = (
            f"{100.0 * none.tried_down_to:.0f} % of the torque usual at this diameter, and an eighth of it as stiffness"
        )
        return "\n".join([*lines, f"Nothing down to {least}, fits: another --diameter or --process."])
    lines.append("These fit by arithmetic, with margins by estimate; a run decides, on times too. Others as given:")
    other = "torque" if task.assumes_stroke else "stroke"
    ways += [] if any(f"--{other}" in way for way in ways) else [f"No lesser {other} alone was found that fits."]
    return "\n".join([*lines, *ways])
