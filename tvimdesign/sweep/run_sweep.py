"""Cells from their keys to the store, by processes here, a batch job or a cluster: what is there is not done again."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from tvimdesign.base.errors import InputError
from tvimdesign.sweep.keys import CellKeys
from tvimdesign.sweep.plan import SweepPlan
from tvimdesign.sweep.pool import Pool, Usage
from tvimdesign.sweep.shards import Shards
from tvimdesign.sweep.work import Cell, SweptStudy

Say = Callable[[str], None]


@dataclass(frozen=True)
class Executor:
    """Place of computing the cells: processes here, a scheduler's workers, or this job of a batch system's array."""

    workers: int = 0
    """Processes; as many as there are processors where it is 0."""
    scheduler: str = ""
    """Address of a dask scheduler; empty for processes here."""
    part: tuple[int, int] = (1, 1)
    """Which part of how many this is, both from 1."""

    @property
    def alone(self) -> bool:
        """Return whether no other job has a part of it."""
        return self.part == (1, 1)

    @property
    def said(self) -> bool:
        """Return whether the user chose another place than here."""
        return bool(self.scheduler) or not self.alone

    @classmethod
    def of(cls, workers: int, scheduler: str, shard: str) -> Executor:
        """Read the words of the command line; raises InputError for a shard that is none."""
        first, slash, last = shard.partition("/")
        if not shard:
            return cls(workers, scheduler)
        if not (slash and first.isdecimal() and last.isdecimal() and 1 <= int(first) <= int(last)):
            raise InputError(f"--shard {shard}: expected part/parts, such as 1/3, 2/3 and 3/3")
        return cls(workers, scheduler, (int(first), int(last)))


@dataclass(frozen=True)
class SweepDone:
    """Finished part of a sweep, or of other work."""

    cells: int
    """Of the whole."""
    reused: int
    """Of this part: cells that were there."""
    computed: int
    missing: int
    """Cells that other parts still have to compute."""
    spent: Usage = field(default_factory=Usage)
    keys: tuple[str, ...] = ()
    """Every cell's key, in their order; empty where cells are missing."""

    @property
    def whole(self) -> bool:
        """Return whether every cell is there."""
        return not self.missing


def run_sweep(plan: SweepPlan, folder: Path, executor: Executor, say: Say) -> SweepDone:
    """Compute every cell of this part that the store in the folder does not have. Raises OutputError, TvimError."""
    say("looking for cells that are there")
    cell_keys, points = CellKeys(plan), plan.points
    work, keys = SweptStudy.of(plan), [cell_keys.key(points.texts(number)) for number in range(plan.count)]
    first, parts = executor.part
    known, own = Shards(folder, work.columns), range(first - 1, len(keys), parts)
    waiting = {keys[number]: Cell(keys[number], points.texts(number)) for number in own if keys[number] not in known}
    reused = len(own) - sum(keys[number] in waiting for number in own)
    spent, there = Usage(), known
    if waiting:
        spent = _answered(work, list(waiting.values()), folder, executor, say)
        there = Shards(folder, work.columns)
    missing = sum(key not in there for key in keys)
    return SweepDone(len(keys), reused, len(own) - reused, missing, spent, () if missing else tuple(keys))


def _answered(work: SweptStudy, cells: list[Cell], folder: Path, executor: Executor, say: Say) -> Usage:
    def heard(spent: Usage) -> None:
        say(f"cell {min(spent.cells + 1, len(cells))} of {len(cells)}")

    heard(Usage())
    if executor.scheduler:
        from tvimdesign.sweep.cluster import Cluster

        return Cluster(executor.scheduler, work, folder).answer(cells, heard)
    return Pool(work, folder, executor.workers or os.cpu_count() or 1).answer(cells, heard)
