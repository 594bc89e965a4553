"""Parts of chosen cells of a sweep: each cell's module as it was found, drawn into a folder of its own."""

from __future__ import annotations

import csv
import io
import json
import tempfile
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.markup import escape

from tvimdesign.base.errors import GeometryError, InputError, TvimError
from tvimdesign.base.extras import require_extra
from tvimdesign.base.journal import UNFINISHED
from tvimdesign.report.output.number_format import head
from tvimdesign.report.output.progress import progress_output, wide_console
from tvimdesign.report.output.shared_folder import CellsAsked, answered_cells, own_half_made, say_part
from tvimdesign.report.run.parts_of_design import make_parts_of
from tvimdesign.report.sweep.swept_cells import CellFound, SweptCells, open_cells
from tvimdesign.solve.result import answer
from tvimdesign.study import read_tree
from tvimdesign.study.design import design_json
from tvimdesign.study.tree import StudyTree
from tvimdesign.sweep.keys import key_of, said_of
from tvimdesign.sweep.run_sweep import Where
from tvimdesign.sweep.work import Cell, CellAnswer, found_anywhere

_MADE, _FAILED, _NONE = "made", "checks_fail", "not_made"
_COLUMNS = ("checks", "failed", "files")
_HALF_MADE = ".cells-"
"""What the names of folders begin with in which cells are being made, beside those that are."""


@dataclass(frozen=True)
class PartsWork:
    """The studies of chosen cells; a cell is set to its number in the sweep."""

    trees: tuple[tuple[str, StudyTree], ...]
    """By the cell's number."""
    beside: Path | None = None
    """Where cells are made, whose files then come with the answer; the system's folder where this one is not there."""
    own: str = ""
    """What the names of the folders begin with that are made there."""
    columns: tuple[str, ...] = _COLUMNS
    numbers: tuple[bool, ...] = (True,)

    def answers(self) -> PartsWork:
        """Nothing is prepared: parts are made in a child process."""
        return self

    def answer(self, cell: Cell) -> CellAnswer:
        """Make the parts of one cell; its files come with the answer, those of a cell that fails too."""
        (number,) = cell.texts
        beside = self.beside if self.beside and self.beside.is_dir() else None
        with tempfile.TemporaryDirectory(dir=beside, prefix=self.own or None) as place:
            own = Path(place)
            try:
                design = answer(read_tree(dict(self.trees)[number])).design
                (own / "design.json").write_bytes(design_json(design))
                report = make_parts_of(own / "design.json", own / "cad", lambda _: None)
            except TvimError as error:
                return _told(number, own, _NONE, str(error), 0, 0)
            failed = [check.text for check in report.failed]
            return _told(number, own, _FAILED if failed else _MADE, "; ".join(failed), len(report.checks), len(failed))


def _told(number: str, own: Path, status: str, reason: str, checks: int, failed: int) -> CellAnswer:
    paths = sorted(path for path in own.rglob("*") if path.is_file() and not path.name.startswith("."))
    names = [f"{folder_of(number)}/{path.relative_to(own).as_posix()}" for path in paths]
    files = tuple((name, path.read_bytes()) for name, path in zip(names, paths, strict=True))
    values = (float(checks), float(failed), json.dumps(names))
    return CellAnswer(status, reason.replace(str(own), ""), None, None, values, files=files)


def folder_of(number: int | str) -> str:
    """The folder of a cell's parts."""
    return f"cell-{number}"


def chosen_cells(words: str, cells: SweptCells) -> list[int]:
    """Numbers from words such as `3,7-9` or `best`. Raises InputError for what is none, or not in the sweep."""
    found: list[int] = []
    for word in words.replace(" ", "").split(","):
        first, dash, last = word.partition("-")
        if word == "best":
            found += cells.best
        elif first.isdecimal() and (last.isdecimal() or not dash) and int(first) <= int(last or first):
            if int(last or first) > cells.plan.count:
                raise InputError(f"--cells {words}: the sweep has the cells 1 to {cells.plan.count}")
            found += range(int(first), int(last or first) + 1)
        else:
            raise InputError(f"--cells {words}: {word!r} is no cell; name some such as 3,7-9, or best")
    if not found:
        raise InputError(f"--cells {words}: no cell of the sweep has an answer, so no parts")
    return list(dict.fromkeys(found))


def parts_asked(cells: SweptCells, numbers: Sequence[int], out: Path) -> CellsAsked:
    """A cell of parts for each chosen cell, made in the folder `out`.

    Raises InputError for one without an answer, or with a current profile.
    """
    chosen = [cells.found(number) for number in numbers]
    trees = tuple((str(one.number), found_anywhere(_evaluated(one))) for one in chosen)
    keys = [key_of({"parts of": said_of(read_tree(tree)), "cell": number}) for number, tree in trees]
    folders = [folder_of(number) for number in numbers]
    work = PartsWork(trees, (out / UNFINISHED).resolve(), own_half_made(_HALF_MADE))
    return CellsAsked(work, keys, lambda place: (trees[place][0],), "parts of cell", folders, _HALF_MADE)


def _evaluated(one: CellFound) -> StudyTree:
    if not one.answered:
        raise InputError(f"cell {one.number}: it has no answer, so no parts; `reason` in its table says why")
    if one.study.profile.pieces():
        raise InputError(
            f"cell {one.number}: its current follows a profile, which a sweep's table does not hold; the page of the "
            "sweep has the command that runs it"
        )
    return one.fixed


def make_parts_of_cells(
    source: Path, out: Path, words: str, where: Where, *, overwrite: bool, resume: bool, as_json: bool
) -> None:
    """Make the parts of chosen cells of a sweep. Raises InputError, OutputError; GeometryError at the end where some
    cell's could not be made, or break a check.
    """
    require_extra("cad", "parts")
    cells = open_cells(source)
    asked = parts_asked(cells, chosen_cells(words, cells), out)
    with ExitStack() as stack:
        progress = stack.enter_context(progress_output())
        folder, done = answered_cells(stack, out, asked, where, progress, overwrite=overwrite, resume=resume)
        if folder is None:
            say_part(done, where, out, wide_console(), as_json=as_json)
            return
        rows = _rows(asked, folder.path)
        folder.write("parts.csv", _csv(rows))
        told: dict[str, Any] = {**head(), "sweep": str(source), "cells": rows}
        folder.write_json("parts.json", told)
        folder.finish("parts made", {"study": source / "study.yaml"}, {})
    _say(told, out, as_json=as_json)
    failed = [row for row in rows if row["status"] != _MADE]
    if failed:
        lines = [f"  cell {row['cell']}: {row['status'].replace('_', ' ')}: {row['reason']}" for row in failed]
        raise GeometryError(
            f"parts of {len(failed)} of {len(rows)} cells are not as they should be:\n" + "\n".join(lines)
        )


def _rows(asked: CellsAsked, out: Path) -> list[dict[str, Any]]:
    """What became of each cell. Raises InputError where its files are gone."""
    rows = []
    for place, kept in enumerate(asked.there(out)):
        (number,), answered = asked.texts(place), kept.answer
        checks, failed, names = answered.values
        gone = [name for name in json.loads(str(names or "[]")) if not (out / name).is_file()]
        if gone:
            raise InputError(f"{out / gone[0]}: is gone since it was made; --overwrite makes all parts again")
        rows.append({
            "cell": int(number), "status": answered.status, "checks": int(float(checks or 0)),
            "failed": int(float(failed or 0)), "folder": folder_of(number), "reason": answered.reason,
        })  # fmt: skip
    return rows


def _csv(rows: Sequence[dict[str, Any]]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def _say(told: dict[str, Any], out: Path, *, as_json: bool) -> None:
    if as_json:
        print(json.dumps({**told, "folder": str(out)}, indent=2, allow_nan=False))
        return
    console = wide_console()
    for row in told["cells"]:
        kept = f"{row['checks'] - row['failed']} of {row['checks']} checks kept"
        console.print(f"cell {row['cell']}: {row['status'].replace('_', ' ')}, {kept}: {escape(row['folder'])}")
    console.print(f"\nParts are in [bold]{escape(str(out))}[/bold]", soft_wrap=True)
