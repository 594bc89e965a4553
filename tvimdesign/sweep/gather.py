"""The cells of a finished sweep gathered to tables: CSV and SQLite."""

import contextlib
import csv
import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from tvimdesign.base.atomic_files import TABLE_ENCODING, whole_file
from tvimdesign.base.errors import OutputError
from tvimdesign.base.units import from_si
from tvimdesign.study.sections.sweeps import SweptAxis
from tvimdesign.sweep.plan import SweepPlan, is_words, rounded, senses
from tvimdesign.sweep.shards import Shards, StoredCell

Value = float | int | str | None
_STATUS_COLUMNS = ("status", "violated", "margin", "reason")


class Column(NamedTuple):
    """One column of the table."""

    name: str
    unit: str
    """`1` of a number without unit, empty for words."""
    kind: str
    """`cell`, `axis`, `told` or `output`."""
    meaning: str


def columns(plan: SweepPlan) -> list[Column]:
    """Return every column of a sweep's table."""
    axes = [Column(axis.name, "" if is_words(axis) else axis.unit, "axis", _meaning(plan, axis)) for axis in plan.axes]
    about = {
        "status": "evaluated, optimal, above_rating, below_yield, infeasible, refused, ...",
        "violated": "limits that are violated",
        "margin": "the least margin over all limits, as a share of the limit",
        "reason": "why there is no design, what it violates, or the yield it reaches",
    }
    status_columns = [
        Column(name, "1" if name in {"violated", "margin"} else "", "told", about[name]) for name in _STATUS_COLUMNS
    ]
    outputs = [Column(_apart(name, plan), plan.unit(name), "output", _about(plan, name)) for name in plan.columns]
    return [Column("cell", "1", "cell", "number of the cell, from 1"), *axes, *status_columns, *outputs]


def _apart(name: str, plan: SweepPlan) -> str:
    """Return a column of its own where an axis has the name already."""
    return f"{name}_found" if name in {axis.name for axis in plan.axes} else name


def _meaning(plan: SweepPlan, axis: SweptAxis) -> str:
    about = _about(plan, axis.name.removeprefix("require.").rpartition(".")[2])
    return f"limit {' and '.join(sorted(senses(axis)))} on: {about}" if axis.name.startswith("require.") else about


def _about(plan: SweepPlan, name: str) -> str:
    row = plan.study.table.by_name.get(name.partition("@")[0])
    return str(getattr(row, "description", "")) if row else ""


def rows(plan: SweepPlan, keys: Iterable[str], shards: Shards) -> Iterator[list[Value]]:
    """Yield every cell as a row of the table, in order, numbers in the units of the columns."""
    units = [plan.unit(name) for name in plan.columns]
    for number, cell in enumerate(shards.kept(iter(keys))):
        yield [number + 1, *plan.axis_values(number), *status_values(cell, units)]


def status_values(cell: StoredCell, units: Sequence[str]) -> list[Value]:
    """Return what a cell came to, in the units of the columns."""
    answer = cell.answer
    values = [_in_unit(value, unit) for value, unit in zip(answer.values, units, strict=True)]
    margin = None if answer.margin is None else rounded(answer.margin)
    return [answer.status, answer.violated, margin, answer.reason, *values]


def _in_unit(value: float | str | None, unit: str) -> Value:
    return rounded(from_si(value, unit)) if isinstance(value, float) and unit else value


# --- files ---


def write_tables(plan: SweepPlan, every: Iterable[list[Value]], folder: Path) -> None:
    """Write cells.csv and cells.sqlite in one go through the cells. Raises OutputError.

    In text a number that there is none of is empty, and what never happens `inf`.
    """
    try:
        _write_tables(plan, every, folder)
    except sqlite3.OperationalError as error:
        raise OutputError(f"{folder / 'cells.sqlite'}: cannot be written: {error}; the cells are kept") from error


def _write_tables(plan: SweepPlan, every: Iterable[list[Value]], folder: Path) -> None:
    with (
        whole_file(folder / "cells.csv") as text,
        whole_file(folder / "cells.sqlite") as base,
        text.open("w", encoding=TABLE_ENCODING, newline="") as stream,
        contextlib.closing(sqlite3.connect(base)) as connection,
    ):
        connection.execute("PRAGMA journal_mode = OFF")  # it appears whole or not at all
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow([column.name for column in columns(plan)])
        writer.writerows(_into(connection, plan, every))
        connection.commit()


def _into(connection: sqlite3.Connection, plan: SweepPlan, every: Iterable[list[Value]]) -> Iterator[list[Value]]:
    """Hand on each row, once it stands in the database."""
    named = columns(plan)
    types = ["REAL" if column.unit else "TEXT" for column in named]
    listed = ", ".join(f'"{column.name}" {kind}' for column, kind in zip(named, types, strict=True))
    connection.execute(f"CREATE TABLE cells ({listed})")
    connection.execute("CREATE TABLE columns (name TEXT, unit TEXT, kind TEXT, meaning TEXT)")
    connection.executemany("INSERT INTO columns VALUES (?, ?, ?, ?)", named)
    marks = ", ".join("?" * len(named))
    for row in every:
        connection.execute(f"INSERT INTO cells VALUES ({marks})", row)
        yield row
