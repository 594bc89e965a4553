"""Files a user starts from: a commented study, a shipped one, the study of a joint from five numbers, the schema."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.errors import InfeasibleError, InputError
from tvimdesign.base.units import format_quantity
from tvimdesign.study import read_study_text
from tvimdesign.study.design import read_design
from tvimdesign.study.sizing import LARGEST, STROKE, JointTask, diameters, hardware_by_fit, study_text
from tvimdesign.study.text.source import printable
from tvimdesign.study.written_studies import (
    SCHEMA_FILE,
    example_text,
    examples,
    result_text,
    schema_text,
    template_text,
)


def list_examples() -> None:
    """Print the shipped studies, each with what it is about."""
    for name, about in examples().items():
        print(f"{name}\n    {about}")


def write_new_study(file: Path | None, example: str = "", result: Path | None = None) -> None:
    """Write a commented study, a copy of a shipped one, or the module of a result as a study that evaluates it.

    Raises InputError where the file is there already, or the result is none.
    """
    if example and result:
        raise InputError("--example and --from: choose one")
    file = file or Path(f"{example or 'study'}.yaml")
    text = example_text(example) if example else template_text()
    if result:
        source = result / "design.json" if result.is_dir() else result
        text = result_text(read_design(source), printable(source), file.resolve().parent)
    try:
        with file.open("x", encoding="utf-8") as stream:
            stream.write(text)
    except FileExistsError as error:
        raise InputError(f"{file}: exists already; name another file") from error
    except OSError as error:
        raise InputError(f"{file}: cannot be written: {error.strerror}") from error
    print(f"{file} written; next: tvimdesign run {file}")
    print(f"names and units while you type: tvimdesign schema > {file.with_name(SCHEMA_FILE)}")


def print_schema() -> None:
    """Print the JSON Schema of studies."""
    print(schema_text(), end="")


_CANDIDATES = 3
"""Sets of hardware that are tried, the best fit first."""
_WIDER = 1.12
"""Step between diameters that are tried if no hardware fits."""


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
    with progress_output() as progress:
        text = sized_text(task, file.stem, progress)
    atomic_write(file, text.encode())
    if task.assumes_stroke:
        print(f"stroke of {STROKE} to either side of rest assumed; --stroke changes it", file=sys.stderr)
    run_study(file, out, overwrite=overwrite, **run)


def sized_text(task: JointTask, name: str, progress: Callable[[str], None] = lambda _: None) -> str:
    """Return the study of a joint, with the first hardware whose limits can hold with margins for its tolerances.

    Raises InfeasibleError, with the conflict and the nearest numbers that were tried and have none.
    """
    progress("choosing the hardware")
    for hardware in hardware_by_fit(task)[:_CANDIDATES]:
        if _least_diameter(task, hardware) <= task.diameter:
            return study_text(task, hardware, name)
    progress("looking for the nearest numbers that fit")
    raise InfeasibleError(_refusal(task, name))


def _least_diameter(task: JointTask, hardware: str) -> float:
    """Return the least diameter with margins, for ranges that suit the one asked for; infinite if there is none."""
    from tvimdesign.solve.uncertainty.robust import least_with_margins  # it loads the compiler

    least = least_with_margins(read_study_text(study_text(task, hardware)), "envelope_diameter")
    return math.inf if least is None else least


def _refusal(task: JointTask, name: str) -> str:
    """Return the conflict, and the smallest diameter and the largest torque that the limits allow with margins."""
    from tvimdesign.solve.infeasibility.early_checks import refuse_what_cannot_be

    size, hold = format_quantity(task.diameter, "mm", 3), format_quantity(task.torque, "N*m", 3)
    try:
        refuse_what_cannot_be(read_study_text(study_text(task, hardware_by_fit(task)[0]), name))
        lines = [f"{name}: a joint of {size} cannot hold {hold} with margins for the tolerances."]
    except (InputError, InfeasibleError) as error:
        lines = [str(error)]
    enough, most = _smallest(task), _most_torque(task)
    ways = [f"a diameter of {format_quantity(enough, 'mm', 4)}"] if enough else []
    ways += [f"{size} and {format_quantity(most, 'N*m', 3)}"] if most else []
    lines += [f"With margins the limits can hold for {', or for '.join(ways)}: size it with these numbers."] * bool(
        ways
    )
    return "\n".join(lines)


def _smallest(task: JointTask) -> float | None:
    """Return the smallest diameter [m], in whole millimetres, that some hardware bears; None if none is known to."""
    diameter = max(task.diameter, min(diameters().values()))
    while diameter <= LARGEST:
        wider = replace(task, diameter=diameter)
        for hardware in hardware_by_fit(wider)[:2]:
            least = max(_least_diameter(wider, hardware), task.diameter)
            if least <= diameter:
                smaller = replace(task, diameter=1e-3 * math.ceil(least / 1e-3 + 0.2))
                fits = smaller.diameter < diameter and _least_diameter(smaller, hardware) <= smaller.diameter
                return smaller.diameter if fits else 1e-3 * math.ceil(diameter / 1e-3)
        diameter *= _WIDER
    return None


def _most_torque(task: JointTask) -> float | None:
    """Return the largest torque [N m], rounded down, that some hardware of this diameter holds; None if none does."""
    from tvimdesign.solve.uncertainty.robust import least_with_margins

    studies = (read_study_text(study_text(task, hardware)) for hardware in hardware_by_fit(task)[:2])
    most = max(least_with_margins(study, "holding_torque", -1.0) or 0.0 for study in studies)
    digits = 10.0 ** (math.floor(math.log10(most)) - 1) if most > 0.0 else 1.0
    return math.floor(most / digits) * digits if 0.0 < most < task.torque else None
