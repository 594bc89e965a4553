"""A sweep from its plan to all cells in the store: what is there is not computed again."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from tvimdesign.base.errors import InputError
from tvimdesign.sweep.job import Cell, Job
from tvimdesign.sweep.keys import CellKeys
from tvimdesign.sweep.plan import SweepPlan
from tvimdesign.sweep.pool import Pool, Spent
from tvimdesign.sweep.shards import Shards

Say = Callable[[str], None]


@dataclass(frozen=True)
class Where:
    """Who computes the cells: processes here, the workers of a scheduler, or this job of a batch system's array."""

    workers: int = 0
    """Processes; as many as there are processors where it is 0."""
    scheduler: str = ""
    """Address of a dask scheduler; empty for processes here."""
    part: tuple[int, int] = (1, 1)
    """Which part of how many this is, both from 1."""

    @classmethod
    def of(cls, workers: int, scheduler: str, shard: str) -> Where:
        """From the words of the command line; raises InputError for a shard that is none."""
        first, slash, last = shard.partition("/")
        if not shard:
            return cls(workers, scheduler)
        if not (slash and first.isdecimal() and last.isdecimal() and 1 <= int(first) <= int(last)):
            raise InputError(f"--shard {shard}: expected part/parts, such as 1/3, 2/3 and 3/3")
        return cls(workers, scheduler, (int(first), int(last)))


@dataclass(frozen=True)
class SweepDone:
    """What of a sweep is done."""

    cells: int
    """Of the whole sweep."""
    reused: int
    """Of this part: cells that were there."""
    computed: int
    missing: int
    """Cells that other parts still have to compute."""
    spent: Spent = field(default_factory=Spent)
    keys: tuple[str, ...] = ()
    """Every cell's key, in their order; empty where cells are missing."""

    @property
    def whole(self) -> bool:
        """Whether every cell is there."""
        return not self.missing


def run_sweep(plan: SweepPlan, folder: Path, where: Where, say: Say) -> SweepDone:
    """Compute every cell of this part that the store in the folder does not have. Raises OutputError, TvimError."""
    first, parts = where.part
    say("looking for cells that are there")
    keys, known = CellKeys(plan), Shards(folder, plan.columns)
    own = {number: keys.key(plan.points.texts(number)) for number in range(first - 1, plan.count, parts)}
    waiting = {key: Cell(key, plan.points.texts(number)) for number, key in own.items() if key not in known}
    reused = len(own) - sum(key in waiting for key in own.values())
    spent = Spent()
    if waiting:
        spent = _answered(Job.of(plan), list(waiting.values()), folder, where, say)
    every = [own[number] if number in own else keys.key(plan.points.texts(number)) for number in range(plan.count)]
    there = Shards(folder, plan.columns)
    missing = sum(key not in there for key in every)
    return SweepDone(plan.count, reused, len(own) - reused, missing, spent, () if missing else tuple(every))


def _answered(job: Job, cells: list[Cell], folder: Path, where: Where, say: Say) -> Spent:
    def heard(spent: Spent) -> None:
        say(f"cell {min(spent.cells + 1, len(cells))} of {len(cells)}")

    heard(Spent())
    if where.scheduler:
        from tvimdesign.sweep.cluster import Cluster

        return Cluster(where.scheduler, job, folder).answer(cells, heard)
    return Pool(job, folder, where.workers or os.cpu_count() or 1).answer(cells, heard)
