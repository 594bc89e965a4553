"""Cells of a sweep: their summary as they pass to the files, and those that a finished sweep's folder has."""

import contextlib
import json
import math
import sqlite3
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.study import Study, StudyTree, read_tree, tree_of_file
from tvimdesign.sweep.plan import ALWAYS, SweepPlan, plan_of, set_in
from tvimdesign.sweep.shards import SHARDS, Column, Shards, Value, columns, rows, write_tables

MOST_DRAWN = 20_000  # Cells of a figure; of more, every second, third, ... is drawn.
MOST_LISTED = 2_000  # Cells of a page, which a browser draws and sorts; of more, every second, third, ... is there.
MOST_FAILED = 500  # Cells without an answer that a page lists; of more, the first
PANELS = 3


class CellTable:
    """Looks at every row of a table once."""

    def __init__(self, plan: SweepPlan) -> None:
        self.plan, self.columns = plan, columns(plan)
        self._units = {column.name: column.unit for column in self.columns}
        self._every = -(-plan.count // MOST_DRAWN)
        self.every_listed = -(-plan.count // MOST_LISTED)  # Each how many-th cell the page has
        study = plan.first
        wanted = [*study.minimize, *(limit.output for limit in study.require), *ALWAYS]
        apart = {axis.name for axis in plan.block.axes}
        self.shown = [name for name in dict.fromkeys(wanted) if name not in apart][:PANELS]
        """Outputs of the figure and of the screen."""
        self.least = [name for name in (study.minimize or self.shown) if name not in apart]
        self._ended: Counter[str] = Counter()
        self.best: dict[str, dict[str, Any]] = {}  # By minimised output: the feasible cell with the least value
        self.drawn: list[dict[str, Value]] = []  # Rows of the figure
        self.listed: list[dict[str, Value]] = []  # Rows of the page
        self.failed: list[dict[str, Value]] = []  # Rows of the first cells without an answer
        self.failures = 0  # Count of the cells without an answer
        self.keeping = 0  # Count of the feasible cells

    @property
    def statuses(self) -> dict[str, int]:
        """Count of cells by status."""
        return dict(sorted(self._ended.items()))

    def seeing(self, rows: Iterable[list[Value]]) -> Iterator[list[Value]]:
        """Hand on every row, once it is seen."""
        for number, values in enumerate(rows):
            row = dict(zip(self._units, values, strict=True))
            self._ended[str(row["status"])] += 1
            for name in self.least:
                self._compare(name, row)
            if number % self._every == 0:
                self.drawn.append(row)
            if number % self.every_listed == 0:
                self.listed.append(row)
            self.keeping += row["violated"] == 0
            if row["violated"] is None:
                self.failures += 1
                self.failed += [row] if len(self.failed) < MOST_FAILED else []
            yield values

    def _compare(self, name: str, row: dict[str, Value]) -> None:
        value = row[name]
        if row["violated"] != 0 or not isinstance(value, float) or not math.isfinite(value):
            return
        if name not in self.best or value < self.best[name]["value"]:
            self.best[name] = {"cell": row["cell"], "value": value, "unit": self._units[name]}


def gather(plan: SweepPlan, keys: Sequence[str], folder: Path) -> CellTable:
    """Write the tables of a sweep from the shards of its folder; return their summary. Raises OutputError."""
    seen = CellTable(plan)
    write_tables(plan, seen.seeing(rows(plan, keys, Shards(folder, plan.columns))), folder)
    return seen


_DIGITS = 12  # Of a number in a sweep's table
_SUMMARY, _TABLE = "sweep.json", "cells.sqlite"


def is_sweep(path: Path) -> bool:
    """Return whether a path is the folder of a sweep, finished or not."""
    return (path / _SUMMARY).is_file() or (path / SHARDS).is_dir()


@dataclass(frozen=True)
class CellFound:
    """One cell: what it is set to and what its variables came to, as texts by the path in the study."""

    number: int
    changes: dict[str, str]
    tree: StudyTree  # With the changes; what varies is free
    study: Study
    answered: bool
    at: dict[str, str]  # Empty where there is no answer


@dataclass(frozen=True)
class SweptCells:
    """The cells in the folder of a sweep."""

    folder: Path
    plan: SweepPlan
    best: tuple[int, ...]  # The feasible cells with the least of each minimised output; else the first with an answer

    @property
    def columns(self) -> list[Column]:
        """Every column of its table."""
        return columns(self.plan)

    def listed(self) -> list[dict[str, Any]]:
        """Return rows of the cells for a page, thinned for a browser."""
        every = -(-self.plan.count // MOST_LISTED)
        rows = _rows(self.folder, "WHERE (CAST(cell AS INTEGER) - 1) % ? = 0", [every])
        return [{**row, "cell": int(row["cell"])} for row in rows]

    def cell(self, number: int) -> CellFound:
        """Return a cell by its number. Raises InputError if there is none, and StudyError if it is no study."""
        if not 1 <= number <= self.plan.count:
            raise InputError(f"cell {number}: the sweep has the cells 1 to {self.plan.count}")
        row = next(iter(_rows(self.folder, "WHERE cell = ?", [number])), None)
        if row is None:
            raise InputError(f"cell {number}: {self.folder / _TABLE} has no such cell; sweep again with --resume")
        texts = self.plan.texts(number - 1)
        changes = {axis.name: text for axis, text in zip(self.plan.block.axes, texts, strict=True)}
        tree = self.plan.cell_tree(texts)
        study, answered = read_tree(tree), row["violated"] is not None
        variables = {name: row[name] for name in study.vary if answered and row.get(name) is not None}
        at = {name: _text(value, self.plan.unit(name)) for name, value in variables.items()}
        return CellFound(number, changes, tree, study, answered, at)


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
    answered = _rows(folder, "WHERE violated IS NOT NULL ORDER BY cell LIMIT 1", [])
    return SweptCells(folder, plan, tuple(dict.fromkeys(int(row["cell"]) for row in least or answered)))


def _rows(folder: Path, which: str, values: Sequence[Any]) -> list[dict[str, Any]]:
    """Return some rows of the table. Raises InputError where it cannot be read."""
    path = folder / _TABLE
    try:
        with contextlib.closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as connection:
            connection.row_factory = sqlite3.Row
            cursor = connection.execute(f"SELECT * FROM cells {which}", list(values))
            return [dict(row) for row in cursor]
    except sqlite3.Error as error:
        raise InputError(f"{path}: cannot be read: {error}; `tvimdesign sweep ... --resume` writes it anew") from error


def _text(value: Value, unit: str) -> str:
    if not isinstance(value, int | float):
        return str(value)
    return f"{value:.{_DIGITS}g}{'' if unit in {'', '1'} else f' {unit}'}"
