"""The store of a sweep: files to which each writer alone appends, a line a cell, and the tables made from them.

A shard begins with a line that names its columns. A line that has no end was being written when its writer was killed:
it is no cell. Whoever goes on writes a shard of its own.
"""

import contextlib
import csv
import json
import os
import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Self

from tvimdesign import __version__
from tvimdesign.base.atomic_files import TABLE_ENCODING, make_folder, whole_file
from tvimdesign.base.errors import OutputError
from tvimdesign.base.units import from_si
from tvimdesign.study.sections.sweeps import SweptAxis
from tvimdesign.sweep.plan import CellAnswer, SweepPlan, is_words, rounded, senses

SHARDS = "shards"  # Folder of the shards in the folder of a sweep
_GOES_ON = "the cells before are kept: make room, then the same command with --resume goes on"
_KEY = slice(2, 34)  # Where the key stands in a line: `["0123...", ...`


class ShardWriter:
    """Appends to a shard of its own, which is made with the first cells."""

    def __init__(self, folder: Path, columns: Sequence[str]) -> None:
        self._folder, self._columns = folder / SHARDS, list(columns)
        self._path: Path | None = None
        self._file = -1

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

    def append(self, cells: Sequence[tuple[str, CellAnswer, float]]) -> None:
        """Write cells, each with its key and what it took [s], and flush them to the disk.

        Raises OutputError where there is no room; what was there before stays whole.
        """
        try:
            if self._file < 0:
                self._begin()
            lines = (
                json.dumps([key, *answer[:-1], int(answer.warm), round(seconds, 4)]) for key, answer, seconds in cells
            )
            self._write("".join(f"{line}\n" for line in lines).encode())
        except OSError as error:
            raise OutputError(
                f"{self._path or self._folder}: cannot be written: {error.strerror or error}; {_GOES_ON}"
            ) from error

    def _begin(self) -> None:
        make_folder(self._folder)
        number = len(list(self._folder.glob("*.jsonl")))
        while self._file < 0:
            number += 1
            self._path = self._folder / f"{number:05d}.jsonl"
            try:
                self._file = os.open(self._path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND, 0o666)
            except FileExistsError:
                continue
        self._write((json.dumps({"tvimdesign": __version__, "columns": self._columns}) + "\n").encode())

    def _write(self, data: bytes) -> None:
        """Append all of some lines, or nothing."""
        assert self._path is not None
        before = os.fstat(self._file).st_size
        try:
            left = memoryview(data)
            while left:
                left = left[os.write(self._file, left) :]
            os.fsync(self._file)
        except OSError:
            os.ftruncate(self._file, before)
            raise


class Shards:
    """All cells that the shards of a folder hold, by key; only where they stand is kept in memory."""

    def __init__(self, folder: Path, columns: Sequence[str]) -> None:
        """Look through every shard that has these columns; others are of a sweep that asked for less."""
        self._files: list[tuple[Path, list[int]]] = []
        self._places: dict[str, tuple[int, int]] = {}
        for path in sorted((folder / SHARDS).glob("*.jsonl")):
            self._look_through(path, columns)

    def __contains__(self, key: str) -> bool:
        return key in self._places

    def __len__(self) -> int:
        return len(self._places)

    def cells(self, keys: Iterator[str]) -> Iterator[CellAnswer]:
        """Yield the answers of some keys, in their order. Raises KeyError for one that is not there."""
        opened = [path.open("rb") for path, _ in self._files]
        try:
            for key in keys:
                file, place = self._places[key]
                opened[file].seek(place)
                _, status, reason, violated, margin, values, warm, _ = json.loads(opened[file].readline())
                own = tuple(values[i] for i in self._files[file][1])
                yield CellAnswer(status, reason, violated, margin, own, bool(warm))
        finally:
            for stream in opened:
                stream.close()

    def _look_through(self, path: Path, columns: Sequence[str]) -> None:
        with path.open("rb") as stream:
            head = stream.readline()
            named = _columns_of(head)
            if named is None or not set(columns) <= set(named):
                return
            self._files.append((path, [named.index(name) for name in columns]))
            place = len(head)
            for line in stream:
                if line.startswith(b'["') and line.endswith(b"]\n"):
                    self._places.setdefault(line[_KEY].decode("ascii", "replace"), (len(self._files) - 1, place))
                place += len(line)


def _columns_of(head: bytes) -> list[str] | None:
    """Return the columns that a shard's first line names; None where it is none."""
    try:
        header = json.loads(head) if head.endswith(b"\n") else {}
    except ValueError:
        return None
    return header.get("columns") if isinstance(header, dict) else None


Value = float | int | str | None
_ENDINGS = {
    "status": "evaluated, optimal, above_rating, below_yield, infeasible, refused, ...",
    "violated": "limits that are violated",
    "margin": "the least margin over all limits, as a share of the limit",
    "reason": "why there is no design, what it violates, or the yield it reaches",
}
"""What a cell came to beside its outputs, as `status_values` has it."""


class Column(NamedTuple):
    """One column of the table."""

    name: str
    unit: str  # `1` of a number without unit, empty for words
    kind: str  # `cell`, `axis`, `told` or `output`
    meaning: str


def columns(plan: SweepPlan) -> list[Column]:
    """Return every column of a sweep's table."""
    swept = plan.block.axes
    names = {axis.name for axis in swept}  # An output of such a name has another one in the table
    axes = [Column(axis.name, "" if is_words(axis) else axis.unit, "axis", _meaning(plan, axis)) for axis in swept]
    numbers = {"violated", "margin"}
    endings = [Column(name, "1" if name in numbers else "", "told", says) for name, says in _ENDINGS.items()]
    outputs = [
        Column(f"{name}_found" if name in names else name, plan.unit(name), "output", _about(plan, name))
        for name in plan.columns
    ]
    return [Column("cell", "1", "cell", "number of the cell, from 1"), *axes, *endings, *outputs]


def _meaning(plan: SweepPlan, axis: SweptAxis) -> str:
    about = _about(plan, axis.name.removeprefix("require.").rpartition(".")[2])
    return f"limit {' and '.join(sorted(senses(axis)))} on: {about}" if axis.name.startswith("require.") else about


def _about(plan: SweepPlan, name: str) -> str:
    row = plan.study.table.by_name.get(name.partition("@")[0])
    return str(getattr(row, "description", "")) if row else ""


def rows(plan: SweepPlan, keys: Iterable[str], shards: Shards) -> Iterator[list[Value]]:
    """Yield every cell as a row of the table, in order, numbers in the units of the columns."""
    units = [plan.unit(name) for name in plan.columns]
    for number, answer in enumerate(shards.cells(iter(keys))):
        yield [number + 1, *plan.axis_values(number), *status_values(answer, units)]


def status_values(answer: CellAnswer, units: Sequence[str]) -> list[Value]:
    """Return what a cell came to, in the units of the columns."""
    values = [
        rounded(from_si(value, unit)) if isinstance(value, float) and unit else value
        for value, unit in zip(answer.values, units, strict=True)
    ]
    margin = None if answer.margin is None else rounded(answer.margin)
    return [answer.status, answer.violated, margin, answer.reason, *values]


def write_tables(plan: SweepPlan, every: Iterable[list[Value]], folder: Path) -> None:
    """Write cells.csv and cells.sqlite in one go through the cells. Raises OutputError.

    In text a number that there is none of is empty, and what never happens `inf`.
    """
    try:
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
    except sqlite3.OperationalError as error:
        raise OutputError(f"{folder / 'cells.sqlite'}: cannot be written: {error}; the cells are kept") from error


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
