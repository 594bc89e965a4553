"""The key of a cell: a hash of its resolved study, of the records it stands on, and of the version.

Reading a study takes a millisecond, which two thousand keys have not: each value of an axis is read once, and what it
changes in the resolved study is put together for each cell.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import astuple
from typing import Any

from tvimdesign import __version__
from tvimdesign.base.record import Record
from tvimdesign.base.units import parse_quantity
from tvimdesign.study import Options, Study, given, read_tree
from tvimdesign.study.sections.sweep_block import SweptAxis
from tvimdesign.sweep.plan import SweepPlan
from tvimdesign.sweep.points import Texts, written

Leaves = dict[tuple[str | int, ...], Any]
_NOT_OF_THE_DESIGN = {"name", "description", "front", "write", "catalog_folder"}
_LENGTH = 32
"""Letters of a key: 128 bits."""


class CellKeys:
    """Gives each cell of a plan its key."""

    def __init__(self, plan: SweepPlan) -> None:
        """Read the study once with every value of every axis. Raises StudyError."""
        self._plan, self._start = plan, plan.points.texts(0)
        self._leaves = leaves_of(plan.first)
        self._changes: list[dict[str, Leaves]] = [{} for _ in plan.axes]
        self._records: dict[Texts, str] = {}
        self._ends = [self._places_between(place, axis) for place, axis in enumerate(plan.axes)]
        whole = leaves_of(plan.study) if plan.task == "optimize" else {}
        self._from = {"task": plan.task, "from": _plain(whole), "tvimdesign": __version__}

    def key(self, texts: Texts) -> str:
        """Return the key of the cell that these values make."""
        return key_of({"study": _plain(self.leaves(texts)), "records": self._records_of(texts), **self._from})

    def leaves(self, texts: Texts) -> Leaves:
        """Return the resolved study of a cell as its single values, without reading it."""
        leaves = dict(self._leaves)
        for place, text in enumerate(texts):
            leaves |= self._change(place, text)
        return leaves

    def _change(self, place: int, text: str) -> Leaves:
        """Return what a value changes in the resolved study of the first cell."""
        number, words = self._ends[place]
        if number is not None:
            axis = self._plan.axes[place]
            value = parse_quantity(text.removeprefix(axis.sense).strip(), axis.unit)
            return {number: value} | dict.fromkeys(words, text)
        known = self._changes[place]
        if text not in known:
            known[text] = self._read_change(place, text)
        return known[text]

    def _read_change(self, place: int, text: str) -> Leaves:
        leaves = leaves_of(self._read(place, text))
        return {path: value for path, value in leaves.items() if self._leaves.get(path, _NOTHING) != value}

    def _read(self, place: int, text: str) -> Study:
        return read_tree(self._plan.cell_tree((*self._start[:place], text, *self._start[place + 1 :])))

    def _places_between(self, place: int, axis: SweptAxis) -> tuple[tuple[str | int, ...] | None, list[Any]]:
        """Return where a range's number stands in the resolved study, and where its text does; None of a list."""
        if axis.range is None:
            return None, []
        low, high = (leaves_of(self._read(place, written(axis, end))) for end in (axis.range.lower, axis.range.upper))
        moved = [path for path, value in low.items() if high[path] != value]
        numbers = [path for path in moved if not isinstance(low[path], str)]
        return (numbers[0], [path for path in moved if path not in numbers]) if len(numbers) == 1 else (None, [])

    def _records_of(self, texts: Texts) -> str:
        """Hash of the records a cell stands on, which hang on its words alone."""
        words = tuple(text for text, axis in zip(texts, self._plan.axes, strict=True) if not axis.unit)
        if words not in self._records:
            try:
                study = read_tree(self._plan.cell_tree(texts))
            except ValueError:
                study = self._plan.first
            self._records[words] = records_hash(study)
        return self._records[words]


_NOTHING = object()


def key_of(content: Any) -> str:
    """Return the key of plain data."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:_LENGTH]


def leaves_of(study: Study) -> Leaves:
    """Return a resolved study as its single values by where they stand."""
    return dict(_walk(study.model_dump(mode="json", exclude=_NOT_OF_THE_DESIGN), ()))


def _walk(value: Any, path: tuple[str | int, ...]) -> Iterator[tuple[tuple[str | int, ...], Any]]:
    if isinstance(value, Mapping) and value:
        for name, item in value.items():
            yield from _walk(item, (*path, name))
    elif isinstance(value, list) and value:
        for place, item in enumerate(value):
            yield from _walk(item, (*path, place))
    else:
        yield path, value


def _plain(leaves: Leaves) -> dict[str, Any]:
    return {"/".join(map(str, path)): value for path, value in leaves.items()}


def records_hash(study: Study) -> str:
    """Hash of what the records say that a study chooses, or may choose."""
    records: dict[tuple[str, str], Record] = {}
    for single in _one_by_one(study):
        records |= {(r.category, r.name): r for r in given(single).values() if isinstance(r, Record)}
    return key_of([_record_content(records[key]) for key in sorted(records)])


def _one_by_one(study: Study) -> Iterator[Study]:
    """Yield the study, and with each word alone that it may choose: others that come along with it are seen then."""
    yield study
    for name, allowed in study.vary.items():
        if isinstance(allowed, Options) and isinstance(allowed.values[0], str):
            for word in allowed.values:
                vary = {**study.vary, name: Options(values=(word,))}
                yield study.model_copy(update={"vary": vary})


def _record_content(record: Record) -> Any:
    """Return all of a record but its file's path, which differs from machine to machine."""
    entries = {name: astuple(entry) for name, entry in record.entries.items()}
    tables = {name: [dict(table.columns), table.rows, table.source, table.status, table.range]
              for name, table in record.tables.items()}  # fmt: skip
    base = _record_content(record.based_on) if record.based_on else None
    return [record.category, record.name, record.title, entries, tables, dict(record.words), base]
