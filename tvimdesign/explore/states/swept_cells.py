"""The cells of a finished sweep: those that a page draws, and the state of the explorer that shows one of them."""

from __future__ import annotations

import contextlib
import json
import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.explore.states.state import State, beginning, set_values
from tvimdesign.report.sweep.cell_table import MOST_LISTED
from tvimdesign.report.sweep.sweep_page_figures import CELL_WORDS, cell_points
from tvimdesign.study import Study, read_tree
from tvimdesign.study.tree import tree_of_file
from tvimdesign.sweep.gather import Value
from tvimdesign.sweep.plan import SweepPlan, plan_of
from tvimdesign.sweep.shards import SHARDS

_DIGITS = 12
"""Of a number in a sweep's table."""
_TOLD, _TABLE = "sweep.json", "cells.sqlite"


def is_sweep(path: Path) -> bool:
    """Whether a path is the folder of a sweep, finished or not."""
    return (path / _TOLD).is_file() or (path / SHARDS).is_dir()


@dataclass(frozen=True)
class SweptCells:
    """The cells in the folder of a sweep."""

    folder: Path
    plan: SweepPlan
    best: int | None
    """The cell where the page begins: the least of what is minimised first, else the first with an answer."""

    def shown(self) -> dict[str, Any]:
        """The cells as the page draws them, no more than a browser draws; no points where no cell has an answer."""
        every = -(-self.plan.count // MOST_LISTED)
        listed = self._rows("WHERE (CAST(cell AS INTEGER) - 1) % ? = 0", [every])
        drawn = cell_points(self.plan, [{**row, "cell": _number(row)} for row in listed])
        return drawn or {"of": [], "names": [], "labels": [], "points": [], "words": CELL_WORDS}

    def state(self, number: int) -> State:
        """The state that shows a cell: evaluated as it was found; one without an answer is asked for once more.

        Raises InputError for a number there is not, and StudyError for a cell that is no study.
        """
        if not 1 <= number <= self.plan.count:
            raise InputError(f"cell {number}: the sweep has the cells 1 to {self.plan.count}")
        row = next(iter(self._rows("WHERE cell = ?", [number])), None)
        if row is None:
            raise InputError(f"cell {number}: {self.folder / _TABLE} has no such cell; sweep again with --resume")
        changes = self._changes(number)
        study = read_tree(set_values(self.plan.tree, changes))
        there = row["broken"] is not None
        at = {**beginning(study), **(_found(row, study, self.plan) if there else {})}
        return State(way="evaluate" if there or not study.vary else "optimize", changes=changes, at=at)

    def _changes(self, number: int) -> dict[str, Any]:
        """What a cell is set to, by the path in the study."""
        texts = self.plan.points.texts(number - 1)
        return {axis.name: text for axis, text in zip(self.plan.axes, texts, strict=True)}

    def _rows(self, which: str, values: Sequence[Any]) -> list[dict[str, Value]]:
        return _rows(self.folder, which, values)


def open_cells(folder: Path) -> SweptCells:
    """The cells of a sweep's folder. Raises InputError where it has not ended, or its files are not a sweep's."""
    try:
        told = json.loads((folder / _TOLD).read_bytes())
        least, records, count = list(told["best"].values()), told.get("catalog", ""), told["cells"]
    except FileNotFoundError:
        raise InputError(f"{folder}: its sweep has not ended; `tvimdesign sweep ... --resume` goes on") from None
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(f"{folder / _TOLD}: not written by `tvimdesign sweep`: {error!r}") from error
    tree = replace(tree_of_file(folder / "study.yaml"), folder=Path())
    plan = plan_of(set_values(tree, {"catalog": records}) if records else tree)
    if plan.count != count:
        raise InputError(f"{folder}: study.yaml asks for {plan.count} cells and the table has {count}; sweep it again")
    answered = _rows(folder, "WHERE broken IS NOT NULL ORDER BY cell LIMIT 1", [])
    first = [_number(one) for one in [*least, *answered]]
    return SweptCells(folder, plan, first[0] if first else None)


def _rows(folder: Path, which: str, values: Sequence[Any]) -> list[dict[str, Value]]:
    """Some rows of the table. Raises InputError where it cannot be read."""
    path = folder / _TABLE
    try:
        with contextlib.closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as connection:
            connection.row_factory = sqlite3.Row
            found = connection.execute(f"SELECT * FROM cells {which}", list(values))
            return [dict(row) for row in found]
    except sqlite3.Error as error:
        raise InputError(f"{path}: cannot be read: {error}; `tvimdesign sweep ... --resume` writes it anew") from error


def _found(row: dict[str, Value], study: Study, plan: SweepPlan) -> dict[str, str]:
    """The variables of a cell's answer as texts with their units, as far as the table has them."""
    return {name: _text(row[name], plan.unit(name)) for name in study.vary if row.get(name) is not None}


def _number(row: dict[str, Any]) -> int:
    return int(row["cell"])


def _text(value: Value, unit: str) -> str:
    if not isinstance(value, int | float):
        return str(value)
    return f"{value:.{_DIGITS}g}{'' if unit in {'', '1'} else f' {unit}'}"
