"""The cells of a finished sweep: those that a page draws, and the study of one of them with what was found."""

from __future__ import annotations

import contextlib
import json
import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.report.sweep.sweep_figures import CELL_WORDS, MOST_LISTED, cell_points
from tvimdesign.study import Study, read_tree
from tvimdesign.study.tree import StudyTree, tree_of_file, without_section
from tvimdesign.sweep.gather import Value
from tvimdesign.sweep.plan import SweepPlan, plan_of, set_in
from tvimdesign.sweep.shards import SHARDS

_OF_SEARCHES = ("robust", "profile")
_DIGITS = 12
"""Of a number in a sweep's table."""
_SUMMARY, _TABLE = "sweep.json", "cells.sqlite"


def is_sweep(path: Path) -> bool:
    """Return whether a path is the folder of a sweep, finished or not."""
    return (path / _SUMMARY).is_file() or (path / SHARDS).is_dir()


@dataclass(frozen=True)
class CellFound:
    """One cell: what it is set to and what its variables came to, as texts by the path in the study."""

    number: int
    changes: dict[str, str]
    tree: StudyTree
    """With the changes; what varies is free."""
    study: Study
    answered: bool
    at: dict[str, str]
    """Empty where there is no answer."""

    @property
    def fixed(self) -> StudyTree:
        """The study of the module that was found: nothing varies, so that it is evaluated."""
        tree = self.tree
        for name in _OF_SEARCHES:
            tree = without_section(tree, name)
        return set_in(tree, list(self.at), list(self.at.values()))


@dataclass(frozen=True)
class SweptCells:
    """The cells in the folder of a sweep."""

    folder: Path
    plan: SweepPlan
    best: tuple[int, ...]
    """The feasible cells with the least of each minimised output; else the first with an answer."""

    def shown(self) -> dict[str, Any]:
        """Return the cells as the page draws them, thinned for a browser; no points where no cell has an answer."""
        every = -(-self.plan.count // MOST_LISTED)
        listed = self._rows("WHERE (CAST(cell AS INTEGER) - 1) % ? = 0", [every])
        drawn = cell_points(self.plan, [{**row, "cell": _number(row)} for row in listed])
        return drawn or {"of": [], "names": [], "labels": [], "points": [], "words": CELL_WORDS}

    def found(self, number: int) -> CellFound:
        """Return a cell by its number. Raises InputError if there is none, and StudyError if it is no study."""
        if not 1 <= number <= self.plan.count:
            raise InputError(f"cell {number}: the sweep has the cells 1 to {self.plan.count}")
        row = next(iter(self._rows("WHERE cell = ?", [number])), None)
        if row is None:
            raise InputError(f"cell {number}: {self.folder / _TABLE} has no such cell; sweep again with --resume")
        texts = self.plan.points.texts(number - 1)
        changes = {axis.name: text for axis, text in zip(self.plan.axes, texts, strict=True)}
        tree = self.plan.cell_tree(texts)
        study, answered = read_tree(tree), row["broken"] is not None
        return CellFound(number, changes, tree, study, answered, _at(row, study, self.plan) if answered else {})

    def _rows(self, which: str, values: Sequence[Any]) -> list[dict[str, Value]]:
        return _rows(self.folder, which, values)


def open_cells(folder: Path) -> SweptCells:
    """Open the cells of a sweep's folder. Raises InputError where it has not ended, or its files are not a sweep's."""
    try:
        summary = json.loads((folder / _SUMMARY).read_bytes())
        least, records, count = list(summary["best"].values()), summary.get("catalog", ""), summary["cells"]
    except FileNotFoundError:
        raise InputError(f"{folder}: its sweep has not ended; `tvimdesign sweep ... --resume` goes on") from None
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(f"{folder / _SUMMARY}: not written by `tvimdesign sweep`: {error!r}") from error
    tree = replace(tree_of_file(folder / "study.yaml"), folder=Path())
    plan = plan_of(set_in(tree, ["catalog"], [records]) if records else tree)
    if plan.count != count:
        raise InputError(f"{folder}: study.yaml asks for {plan.count} cells and the table has {count}; sweep it again")
    answered = _rows(folder, "WHERE broken IS NOT NULL ORDER BY cell LIMIT 1", [])
    return SweptCells(folder, plan, tuple(dict.fromkeys(_number(row) for row in least or answered)))


def _rows(folder: Path, which: str, values: Sequence[Any]) -> list[dict[str, Value]]:
    """Return some rows of the table. Raises InputError where it cannot be read."""
    path = folder / _TABLE
    try:
        with contextlib.closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as connection:
            connection.row_factory = sqlite3.Row
            cursor = connection.execute(f"SELECT * FROM cells {which}", list(values))
            return [dict(row) for row in cursor]
    except sqlite3.Error as error:
        raise InputError(f"{path}: cannot be read: {error}; `tvimdesign sweep ... --resume` writes it anew") from error


def _at(row: dict[str, Value], study: Study, plan: SweepPlan) -> dict[str, str]:
    """Return the variables of a cell's answer as texts with their units, as far as the table has them."""
    return {name: _text(row[name], plan.unit(name)) for name in study.vary if row.get(name) is not None}


def _number(row: dict[str, Any]) -> int:
    return int(row["cell"])


def _text(value: Value, unit: str) -> str:
    if not isinstance(value, int | float):
        return str(value)
    return f"{value:.{_DIGITS}g}{'' if unit in {'', '1'} else f' {unit}'}"
