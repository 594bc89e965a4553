"""Cells from their keys (hashes of study, settings, records, version) to the store, by processes or batch jobs."""

import hashlib
import json
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

from tvimdesign import __version__
from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record
from tvimdesign.study import Options, Study, given, read_tree
from tvimdesign.sweep.plan import Cell, SweepPlan, Texts, axis_value
from tvimdesign.sweep.pool import Pool, Usage
from tvimdesign.sweep.shards import Shards

Say = Callable[[str], None]


@dataclass(frozen=True)
class Executor:
    """Place of computing the cells: processes here, or this job of a batch system's array."""

    workers: int = 0  # Processes; as many as there are processors where it is 0
    part: tuple[int, int] = (1, 1)  # Which part of how many this is, both from 1

    @property
    def alone(self) -> bool:
        """Return whether no other job has a part of it."""
        return self.part == (1, 1)

    @classmethod
    def of(cls, workers: int, shard: str) -> Self:
        """Read the words of the command line; raises InputError for a shard that is none."""
        first, slash, last = shard.partition("/")
        if not shard:
            return cls(workers)
        if not (slash and first.isdecimal() and last.isdecimal() and 1 <= int(first) <= int(last)):
            raise InputError(f"--shard {shard}: expected part/parts, such as 1/3, 2/3 and 3/3")
        return cls(workers, (int(first), int(last)))


@dataclass(frozen=True)
class SweepDone:
    """Finished part of a sweep, or of other work."""

    cells: int  # Of the whole
    reused: int  # Of this part: cells that were there
    computed: int
    missing: int  # Cells that other parts still have to compute
    spent: Usage = field(default_factory=Usage)
    keys: tuple[str, ...] = ()  # Every cell's key, in their order; empty where cells are missing


def run_sweep(plan: SweepPlan, folder: Path, executor: Executor, say: Say) -> SweepDone:
    """Compute every cell of this part that the store in the folder does not have. Raises OutputError, TvimError."""
    say("looking for cells that are there")
    cell_keys = CellKeys(plan)
    keys = [cell_keys.key(plan.texts(number)) for number in range(plan.count)]
    first, parts = executor.part
    known, own = Shards(folder, plan.columns), range(first - 1, len(keys), parts)
    waiting = {keys[number]: Cell(keys[number], plan.texts(number)) for number in own if keys[number] not in known}
    reused = len(own) - sum(keys[number] in waiting for number in own)
    spent, there = Usage(), known

    def heard(spent: Usage) -> None:
        say(f"cell {min(spent.cells + 1, len(waiting))} of {len(waiting)}")

    if waiting:
        heard(spent)
        pool = Pool(plan, folder, executor.workers or os.cpu_count() or 1)
        spent = pool.answer(list(waiting.values()), heard)
        there = Shards(folder, plan.columns)
    missing = sum(key not in there for key in keys)
    return SweepDone(len(keys), reused, len(own) - reused, missing, spent, () if missing else tuple(keys))


_NOT_OF_THE_DESIGN = {"name", "description", "front", "write", "catalog_folder"}
_LENGTH = 32  # Letters of a key: 128 bits


class CellKeys:
    """Gives each cell of a plan its key."""

    def __init__(self, plan: SweepPlan) -> None:
        """Hash what all cells share. Raises StudyError."""
        self._plan, self._records = plan, dict[Texts, str]()
        study = plan.study.model_dump(mode="json", exclude=_NOT_OF_THE_DESIGN)
        self._shared = key_of({"study": study, "task": plan.task, "tvimdesign": __version__})

    def key(self, texts: Texts) -> str:
        """Return the key of the cell that these values make, however they are written."""
        values = {axis.name: axis_value(axis, text) for axis, text in zip(self._plan.block.axes, texts, strict=True)}
        return key_of([self._shared, values, self._records_of(texts)])

    def _records_of(self, texts: Texts) -> str:
        """Hash of the records a cell stands on, which hang on its words alone."""
        words = tuple(text for text, axis in zip(texts, self._plan.block.axes, strict=True) if not axis.unit)
        if words not in self._records:
            try:
                study = read_tree(self._plan.cell_tree(texts))
            except ValueError:
                study = self._plan.first
            self._records[words] = records_hash(study)
        return self._records[words]


def key_of(content: Any) -> str:
    """Return the key of plain data."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:_LENGTH]


def records_hash(study: Study) -> str:
    """Hash of what the table reads of the records that a study chooses, or may choose."""
    records: dict[tuple[str, str], Record] = {}
    for single in _one_by_one(study):
        records |= {(name, r.name): r for name, r in given(single).items() if isinstance(r, Record)}
    fields = {choice: study.table.fields_of(choice) for choice, _ in records}
    return key_of([[choice, _read(records[choice, name], fields[choice])] for choice, name in sorted(records)])


def _one_by_one(study: Study) -> Iterator[Study]:
    """Yield the study, and with each word alone that it may choose: others that come along with it are seen then."""
    yield study
    for name, allowed in study.vary.items():
        if isinstance(allowed, Options) and isinstance(allowed.values[0], str):
            for word in allowed.values:
                vary = {**study.vary, name: Options(values=(word,))}
                yield study.model_copy(update={"vary": vary})


def _read(record: Record, fields: frozenset[str] | None) -> Any:
    """Return the numbers of these fields of a record, and of the one it is based on; all of them without fields."""
    entries = {
        name: [entry.value, entry.low, entry.high, entry.status]
        for name, entry in record.entries.items()
        if fields is None or name in fields
    }
    words = {name: word for name, word in record.words.items() if fields is None or name in fields}
    tables = {
        name: [dict(table.columns), table.rows, table.status, table.range]
        for name, table in record.tables.items()
        if fields is None
    }
    return [record.name, entries, words, tables, record.based_on and _read(record.based_on, fields)]
