"""Parts of chosen cells of a sweep: each cell's module as it was found, drawn into a folder of its own."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape

from tvimdesign.base.environment import require_extra
from tvimdesign.base.errors import GeometryError, InputError, TvimError
from tvimdesign.report.output.command import Command
from tvimdesign.report.output.numbers import head
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.terminal import Progress
from tvimdesign.report.run.parts_of_design import make_parts_of
from tvimdesign.report.sweep.swept_cells import CellFound, SweptCells, open_cells
from tvimdesign.solve.result import answer
from tvimdesign.study import read_tree
from tvimdesign.study.design import design_json
from tvimdesign.study.tree import StudyTree

_MADE, _FAILED, _NONE = "made", "checks_fail", "not_made"


def folder_of(number: int | str) -> str:
    """Return the folder of a cell's parts."""
    return f"cell-{number}"


def chosen_cells(words: str, cells: SweptCells) -> list[int]:
    """Return numbers from words such as `3,7-9` or `best`. Raises InputError for a word that names no cell."""
    numbers: list[int] = []
    for word in words.replace(" ", "").split(","):
        first, dash, last = word.partition("-")
        if word == "best":
            numbers += cells.best
        elif first.isdecimal() and (last.isdecimal() or not dash) and int(first) <= int(last or first):
            if int(last or first) > cells.plan.count:
                raise InputError(f"--cells {words}: the sweep has the cells 1 to {cells.plan.count}")
            numbers += range(int(first), int(last or first) + 1)
        else:
            raise InputError(f"--cells {words}: {word!r} is no cell; name some such as 3,7-9, or best")
    if not numbers:
        raise InputError(f"--cells {words}: no cell of the sweep has an answer, so no parts")
    return list(dict.fromkeys(numbers))


def _evaluated(cell: CellFound) -> StudyTree:
    """Return the study of a cell's module. Raises InputError for a cell without an answer, or with a profile."""
    if not cell.answered:
        raise InputError(f"cell {cell.number}: it has no answer, so no parts; `reason` in its table says why")
    if cell.study.profile.pieces():
        raise InputError(
            f"cell {cell.number}: its current follows a profile, which a sweep's table does not hold; the page of the "
            "sweep has the command that runs it"
        )
    return cell.fixed


def make_parts_of_cells(source: Path, out: Path, words: str, *, overwrite: bool, as_json: bool) -> None:
    """Make the parts of chosen cells of a sweep.

    Raises InputError, OutputError; GeometryError at the end where some cell's could not be made, or break a check.
    """
    require_extra("cad", "parts")
    cells = open_cells(source)
    studies = {number: _evaluated(cells.found(number)) for number in chosen_cells(words, cells)}
    with Command(out, overwrite=overwrite, as_json=as_json) as command:
        rows = [_made(command.folder, number, study, command.progress) for number, study in studies.items()]
        command.folder.write("parts.csv", _csv(rows))
        reported: dict[str, Any] = {**head(), "sweep": str(source), "cells": rows}
        command.folder.write_json("parts.json", reported)
        command.finish("parts made", {"study": source / "study.yaml"}, {})
    command.report(reported, lambda console: _print(rows, console), "Parts are")
    failed = [row for row in rows if row["status"] != _MADE]
    if failed:
        lines = [f"  cell {row['cell']}: {row['status'].replace('_', ' ')}: {row['reason']}" for row in failed]
        raise GeometryError(
            f"parts of {len(failed)} of {len(rows)} cells are not as they should be:\n" + "\n".join(lines)
        )


def _made(folder: ResultsFolder, number: int, study: StudyTree, progress: Progress) -> dict[str, Any]:
    """Make the parts of one cell; return its row of the table."""
    name, status, reason, checks, failed = folder_of(number), _MADE, "", 0, 0
    progress(f"parts of cell {number}")
    try:
        design = folder.write(f"{name}/design.json", design_json(answer(read_tree(study)).design))
        report = make_parts_of(design, design.parent / "cad", progress)
        checks, failed = len(report.checks), len(report.failed)
        if failed:
            status, reason = _FAILED, "; ".join(check.text for check in report.failed)
    except TvimError as error:
        status, reason = _NONE, str(error)
    return {"cell": number, "status": status, "checks": checks, "failed": failed, "folder": name, "reason": reason}


def _csv(rows: Sequence[dict[str, Any]]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def _print(rows: Sequence[dict[str, Any]], console: Console) -> None:
    for row in rows:
        passed = f"{row['checks'] - row['failed']} of {row['checks']} checks kept"
        console.print(f"cell {row['cell']}: {row['status'].replace('_', ' ')}, {passed}: {escape(row['folder'])}")
