"""Files a user starts from: a commented study, a shipped one, the study of a joint from five numbers, the schema."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.errors import InfeasibleError, InputError
from tvimdesign.base.units import format_quantity
from tvimdesign.study import read_study_text
from tvimdesign.study.design import read_design
from tvimdesign.study.sizing import LARGEST, JointTask, hardware_by_fit, study_text
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
_WIDER = (1.1, 1.25, 1.5, 2.0)
"""Factors on the diameter that are tried if none fits."""


def size_study(file: Path, numbers: Mapping[str, str], out: Path, *, overwrite: bool, **run: Any) -> None:
    """Write the study of a joint and run it into a folder; `run` are options of `run_study`.

    Raises InputError for a quantity that is none and a file that is there, InfeasibleError for a joint that no hardware
    fits, and what `run_study` raises.
    """
    from tvimdesign.report.run.run_study import run_study

    task = JointTask.read(**numbers)
    if file.exists() and not overwrite:
        raise InputError(f"{file}: exists already; name another file, or say --overwrite")
    atomic_write(file, sized_text(task, file.stem).encode())
    run_study(file, out, overwrite=overwrite, **run)


def sized_text(task: JointTask, name: str) -> str:
    """Return the study of a joint, with the first hardware whose limits can hold together.

    Raises InfeasibleError, naming the limits that conflict and the next diameter without a conflict, if there is none.
    """
    refusals = []
    for hardware in hardware_by_fit(task)[:_CANDIDATES]:
        text = study_text(task, hardware, name)
        refusal = _refusal(text, name)
        if not refusal:
            return text
        refusals.append(refusal)
    diameters = [factor * task.diameter for factor in _WIDER if factor * task.diameter <= LARGEST]
    wider = (diameter for diameter in diameters if _fits(replace(task, diameter=diameter)))
    enough = next(wider, None)
    ways = f"\nThe limits can hold at a diameter of {format_quantity(enough, 'mm', 3)}." if enough else ""
    raise InfeasibleError(f"{refusals[0]}{ways}")


def _fits(task: JointTask) -> bool:
    return not _refusal(study_text(task, hardware_by_fit(task)[0]), "joint")


def _refusal(text: str, name: str) -> str:
    """Return why a study cannot be answered; empty if no conflict is seen before the search."""
    from tvimdesign.solve.infeasibility.early_checks import refuse_what_cannot_be

    try:
        refuse_what_cannot_be(read_study_text(text, name))
    except (InputError, InfeasibleError) as error:
        return str(error)
    return ""
