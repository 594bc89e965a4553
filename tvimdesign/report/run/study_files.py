"""Files a user starts from: a commented study, a shipped one, the study of a joint from five numbers, the schema."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.errors import BelowYieldError, InfeasibleError, InputError
from tvimdesign.base.units import format_quantity, parse_quantity, pretty
from tvimdesign.report.output.numbers import ends_text, label
from tvimdesign.study import given, read_study_text, written_studies
from tvimdesign.study.design import read_design
from tvimdesign.study.sizing import (
    LARGEST,
    STROKE,
    JointTask,
    diameters,
    hardware_by_fit,
    in_options,
    records_of,
    study_text,
    with_free_stroke,
)
from tvimdesign.study.text.mistakes import printable
from tvimdesign.study.tree import tree_of_text

if TYPE_CHECKING:
    from tvimdesign.report.run.answered_study import AnsweredStudy
    from tvimdesign.solve.uncertainty.robust import Extreme
    from tvimdesign.study.tree import StudyTree


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


_CANDIDATES = 3  # Sets of hardware that are tried, the best fit first
_SEEDS = (1, 2)  # Of the starts of a search that decides on hardware
_BESIDE = 2  # Sets of hardware that are tried with other numbers
_WIDER, _ROOM = (1.1, 1.25), 1.03
"""Factors on a diameter that are tried, and room over the least: ranges follow the diameter, and must allow it."""
_MORE_FRICTION = 1.0
"""Friction over the springs' torque at full stroke where less is not to be had: they still bring the joint back."""
_SHARES = (1.0, 0.9, 0.75, 0.5)  # Of the largest torque or stroke that a search finds, which are tried
_USUAL, _LESSER = 8.0 / 0.07**3, (1.0, 0.5, 0.25, 0.1)
"""Torque that usual joints hold over the cube of their diameter [N/m^2], and shares of it that are tried."""
_AN_EIGHTH = 0.125  # Usual stiffness [N*m/rad] over the torque


def size_study(file: Path, numbers: Mapping[str, str], out: Path, *, overwrite: bool, **run: Any) -> None:
    """Write the study of a joint and run it into a folder; `run` are options of `run_study`.

    The study is written for editing, too, if no hardware fits. Raises InputError for a quantity that is none and a file
    that is there, InfeasibleError for a joint that no hardware fits, and what `run_study` raises.
    """
    from tvimdesign.report.output.terminal import progress_output
    from tvimdesign.report.run.run_study import run_study

    task = JointTask.read(**numbers)
    if file.exists() and not overwrite:
        raise InputError(f"{file}: exists already; name another file, or say --overwrite")
    atomic_write(file, study_text(task, hardware_by_fit(task)[0], file.stem).encode())
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


def sized_texts(choose: Callable[[bool], str]) -> Iterator[tuple[str, bool]]:
    """Yield the studies of a joint that are to be tried until one reaches its yield, each with whether it has room.

    The first has room for the assumed values if some hardware does; `choose` returns a study with room or without.
    """
    for room in (True, False):
        text = choose(room)
        robust = read_study_text(text).robust
        cautious = robust is not None and robust.plausible is not None
        yield text, cautious
        if not cautious:
            return


def choose_sized(task: JointTask, name: str, progress: Callable[[str], None]) -> tuple[StudyTree, AnsweredStudy | None]:
    """Return the study with room for the assumed values, with its answer, or the one without if the yield is missed."""
    from tvimdesign.report.run.answered_study import answer_study
    from tvimdesign.report.run.uncertainty_data import below_yield
    from tvimdesign.solve.search import optimize

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
    progress("looking for a diameter with room for the assumed values")
    roomy, _ = _wider(replace(task, cautious=True, diameter=_ROOM * task.diameter))
    size = f"--diameter '{roomy.options()['diameter']}'" if roomy else "no larger --diameter"
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
    """Return the study of a joint, with the first hardware whose limits can hold with margins for its tolerances.

    Hardware with `room` for the assumed values comes first.
    Raises InfeasibleError, with the nearest numbers that were tried and have such hardware.
    """
    more_friction = replace(task, friction=_MORE_FRICTION)
    if longest := _too_long(more_friction):
        raise InfeasibleError(_refusal(task, name, math.inf, progress, longest))
    for allowed, words in (
        *([(replace(task, cautious=True), ", with room for the assumed values")] if room else []), (task, ""),
        (more_friction, f", friction up to {_MORE_FRICTION:g} of the springs' torque"),
    ):  # fmt: skip
        progress(f"choosing the hardware{words}")
        if hardware := _hardware(allowed):
            return study_text(allowed, hardware, name)
    changed = _with_another_record(task, name, progress)
    if changed and changed[0] <= task.diameter:
        return changed[1]
    raise InfeasibleError(_refusal(task, name, changed[0] if changed else math.inf, progress))


def _with_another_record(task: JointTask, name: str, progress: Callable[[str], None]) -> tuple[float, str] | None:
    """Return the least diameter [m] of the sets of hardware with one record replaced, and the study; None without."""
    from tvimdesign.solve.infeasibility.early_checks import cures_of  # they load the compiler
    from tvimdesign.solve.uncertainty.robust import least_with_margins

    fitting: list[tuple[float, str]] = []
    for hardware in hardware_by_fit(task)[:_BESIDE]:
        progress(f"trying other screws, pins and springs in the hardware for {1e3 * diameters()[hardware]:.0f} mm")
        try:
            cures = cures_of(read_study_text(study_text(task, hardware)))
        except InputError:  # no module at the start of the ranges
            continue
        for record in cures.items():
            text = study_text(task, hardware, name, record)
            least = least_with_margins(read_study_text(text), "envelope_diameter")
            if record[0] in records_of(hardware) and least:
                fitting.append((least.value, text))
        if fitting and min(fitting)[0] <= task.diameter:
            break
    return min(fitting, default=None)


def _refusal(
    task: JointTask, name: str, least_changed: float, progress: Callable[[str], None], longest: Extreme | None = None
) -> str:
    """Return why there is no study of a joint, and what to ask for instead.

    `least_changed` is the least diameter [m] with another record in a set of hardware; `longest` the largest stroke
    that it can have, if that is too short.
    """
    from tvimdesign.report.run.blocks.remedies import held_by  # it loads the compiler

    size, hold = format_quantity(task.diameter, "mm", 3), format_quantity(task.torque, "N*m", 3)
    soft = f"{ends_text(*task.stiffness)} {pretty('N*m/rad')} soft over ±{format_quantity(task.stroke, 'deg', 3)}"
    lines = [f"{name}: no joint of {size} holds {hold} frozen and has {soft}, with margins for its tolerances."]
    if longest:
        most = format_quantity(longest.value, "deg", 3)
        lines.append(f"±{most} is the largest stroke that {held_by(longest)} allow at that diameter.")
    progress("looking for the nearest diameter that fits")
    wider, held_there = _wider(task)
    nearer = replace(task, diameter=1e-3 * math.ceil(_ROOM * min(least_changed, LARGEST) / 1e-3))
    if nearer.diameter < (wider.diameter if wider else LARGEST):
        changed = _with_another_record(nearer, name, progress)
        wider, held_there = (nearer, "") if changed and changed[0] <= nearer.diameter else (wider, held_there)
    lines += [held_there] if held_there else []
    progress(f"looking for another {'torque' if task.assumes_stroke else 'stroke'} or stiffness that fits")
    ways = ["  " + " ".join(f"--{option} '{value}'" for option, value in way.items()) for way in _nearest(task, wider)]
    if ways:
        lines.append("These fit by arithmetic, with margins by estimate; a run decides, on times too. Others as given:")
        other = "torque" if task.assumes_stroke else "stroke"
        ways += [] if any(f"--{other}" in way for way in ways) else [f"No lesser {other} alone was found that fits."]
    least = f"{100.0 * _LESSER[-1]:.0f} % of the torque usual at this diameter, and an eighth of it as stiffness"
    none = f"Nothing down to {least}, fits: another --diameter or --process."
    return "\n".join([*lines, *ways] if ways else [*lines, none])


def _candidates(task: JointTask) -> list[str]:
    return hardware_by_fit(task)[:_CANDIDATES]


def _hardware(task: JointTask) -> str:
    """Return the best set of hardware with which the limits can hold with margins; empty if none does."""
    return next((hardware for hardware in _candidates(task) if _least_diameter(task, hardware)), "")


def _least_diameter(task: JointTask, hardware: str) -> float | None:
    """Return the least diameter with margins, for ranges that suit the one asked for; None if that is not enough."""
    least = _extreme(task, hardware, "envelope_diameter")
    return least.value if least and least.value <= task.diameter else None


def _extreme(
    task: JointTask, hardware: str, output: str, weight: float = 1.0, *, margins: bool = True
) -> Extreme | None:
    """Return the least value of an output that the other limits allow; with a negative weight the largest."""
    from tvimdesign.solve.uncertainty.robust import least_with_margins  # it loads the compiler

    try:
        study = read_study_text(study_text(task, hardware))
    except InputError:  # no module at the start of the ranges
        return None
    beyond = 0.0
    if output == "stroke":
        study, output, beyond = with_free_stroke(study), "stop_angle", given(study)["stop_margin"]
    for seed in _SEEDS:
        solver = study.solver.model_copy(update={"seed": seed})
        seeded = study.model_copy(update={"solver": solver})
        if extreme := least_with_margins(seeded, output, weight, margins=margins):
            return extreme._replace(value=extreme.value - beyond)
    return None


def _nearest(task: JointTask, wider: JointTask | None) -> list[dict[str, str]]:
    """Return options of `size` with which hardware fits: changed alone, else with a stiffness."""
    changed = [wider, _less(task)]
    changed += [] if any(changed) else [_other_stiffness(task)]
    changed = [way for way in changed if way] or [_less_of_all(task)]
    own = task.options()
    return [{name: text for name, text in way.options().items() if text != own[name]} for way in changed if way]


def _wider(task: JointTask) -> tuple[JointTask | None, str]:
    """Return the task with the smallest diameter that some hardware bears, in whole millimetres, and what ends it."""
    from tvimdesign.report.run.blocks.remedies import held_by  # it loads the compiler

    for wider, hardware in _wider_ones(task):
        nominal = _extreme(wider, hardware, "envelope_diameter", margins=False)
        if nominal and nominal.value <= wider.diameter:
            least = _extreme(wider, hardware, "envelope_diameter")
            if least and least.value <= wider.diameter:
                snug = replace(task, diameter=1e-3 * math.ceil(max(_ROOM * least.value, task.diameter) / 1e-3))
                ends = f"{format_quantity(least.value, 'mm', 3)} is the least that {held_by(least)} allow."
                return snug if snug.diameter < wider.diameter and _hardware(snug) else wider, ends
    return None, ""


def _wider_ones(task: JointTask) -> Iterator[tuple[JointTask, str]]:
    """Yield the task with larger and larger diameters, each with the hardware that suits it."""
    own = hardware_by_fit(task)[0]
    yield from ((replace(task, diameter=factor * task.diameter), own) for factor in _WIDER
                if task.diameter * factor <= LARGEST and task.diameter >= diameters()[own] / factor)  # fmt: skip
    for hardware, diameter in diameters().items():
        if diameter > task.diameter:
            yield replace(task, diameter=diameter), hardware


def _other_stiffness(task: JointTask) -> JointTask | None:
    """Return the task with the nearest stiffness that hardware of its diameter has."""
    for hardware in hardware_by_fit(task)[:_BESIDE]:
        for weight in (1.0, -1.0):
            end = _extreme(task, hardware, "joint_stiffness@hot", weight, margins=False)
            if end and weight * end.value > weight * task.stiffness[weight > 0.0]:
                other = task.with_stiffness(_down(end.value))
                if _hardware(other):
                    return other
    return None


def _less(task: JointTask) -> JointTask | None:
    """Return the task with the largest stroke, or torque where none was given, that hardware of its diameter has."""
    by_torque = task.assumes_stroke
    requested, most = (
        task.torque if by_torque else task.stroke,
        _most(task, "holding_torque" if by_torque else "stroke"),
    )
    values = [_down(share * min(most.value if most else requested, requested)) for share in _SHARES]
    lesser = (replace(task, torque=value) if by_torque else replace(task, stroke=value) for value in values)
    return next((other for other in lesser if other != task and _hardware(other)), None)


def _most(task: JointTask, output: str, *, margins: bool = True) -> Extreme | None:
    """Return the largest value of an output that hardware for a diameter allows; None if no search finds one."""
    values = [_extreme(task, hardware, output, -1.0, margins=margins) for hardware in _candidates(task)]
    return max((most for most in values if most), default=None)


def _too_long(task: JointTask) -> Extreme | None:
    """Return the largest stroke of a diameter if the one asked for is beyond it, without margins even."""
    longest = None if task.assumes_stroke else _most(task, "stroke", margins=False)
    if longest is None or longest.value >= task.stroke:
        return None
    searches = (_extreme(task, hardware, "envelope_diameter", margins=False) for hardware in _candidates(task))
    return None if any(least and least.value <= task.diameter for least in searches) else longest


def _less_of_all(task: JointTask) -> JointTask | None:
    """Return the task with less torque, its usual stiffness and at most the usual stroke, which fit together."""
    torques = [_down(share * min(task.torque, _USUAL * task.diameter**3)) for share in _LESSER]
    stroke = min(task.stroke, parse_quantity(STROKE, "rad"))
    lesser = (
        replace(task, torque=torque, stroke=stroke).with_stiffness(_down(_AN_EIGHTH * torque)) for torque in torques
    )
    return next((other for other in lesser if _hardware(other)), None)


def _down(value: float) -> float:
    """Return a number rounded down to two digits."""
    digits = 10.0 ** (math.floor(math.log10(value)) - 1) if value > 0.0 else 1.0
    return math.floor(value / digits) * digits
