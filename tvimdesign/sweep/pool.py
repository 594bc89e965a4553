"""Worker processes here: each answers chunk after chunk; one that dies is replaced, its cells tried again.

Run as a program, this is a worker: it reads on standard input a line with the job, then a line of JSON with cells,
again and again, and answers each with one: how many cells are done and what they took, or the error that ends it.

A chunk is some cells of a kind that go to a worker together, enough for half a second.
"""

import base64
import contextlib
import json
import os
import pickle
import queue
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter, deque
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from tvimdesign.base.child_process import follow_parent, line_writer, read_lines, start_child
from tvimdesign.base.environment import NAMES
from tvimdesign.base.errors import OutputError, TvimError
from tvimdesign.base.processes import last_line
from tvimdesign.sweep.plan import Cell, CellAnswer, SweepPlan
from tvimdesign.sweep.shards import Shards, ShardWriter

CHUNK = 0.5  # Seconds that a chunk is to take
MOST = 1000  # Cells in one


class CellQueue:
    """The cells that are left, by kind: a worker stays with the kind it has compiled a module or a problem for."""

    def __init__(self, cells: Iterable[Cell], plan: SweepPlan, workers: int) -> None:
        """Sort the cells by the words they are set to."""
        self._groups: dict[Hashable, deque[Cell]] = {}
        self._plan, self._workers = plan, max(workers, 1)
        self._at: dict[int, Hashable] = {}
        self._alone: set[str] = set()
        self._seconds = 0.0
        self._done = 0
        for cell in cells:
            self._groups.setdefault(self._plan.words(cell.texts), deque()).append(cell)

    def __len__(self) -> int:
        return sum(map(len, self._groups.values()))

    def next(self, worker: int) -> list[Cell]:
        """Return the next chunk of a worker, by its number; empty where none is left."""
        kind = self._kind_for(worker)
        if kind is None:
            return []
        self._at[worker] = kind
        group = self._groups[kind]
        size = 1 if group[0].key in self._alone else min(self._size(), len(group))
        chunk = [group.popleft() for _ in range(size)]
        if not group:
            del self._groups[kind]
        return chunk

    def put_back(self, cells: Sequence[Cell]) -> None:
        """Take cells again whose worker has died; each is tried alone, so that the one to blame is found."""
        self._alone |= {cell.key for cell in cells}
        for cell in reversed(cells):
            self._groups.setdefault(self._plan.words(cell.texts), deque()).appendleft(cell)

    def done(self, cells: int, seconds: float) -> None:
        """Learn what cells take."""
        self._done, self._seconds = self._done + cells, self._seconds + seconds

    def _kind_for(self, worker: int) -> Hashable | None:
        if self._at.get(worker) in self._groups:
            return self._at[worker]
        taken = {kind for other, kind in self._at.items() if other != worker}
        free = [kind for kind in self._groups if kind not in taken]
        return free[0] if free else max(self._groups, key=lambda kind: len(self._groups[kind]), default=None)

    def _size(self) -> int:
        if not self._done or not self._seconds:
            return 1
        fair = len(self) // (2 * self._workers)  # so that no worker has the last chunk while others wait
        return max(1, min(round(CHUNK * self._done / self._seconds), fair, MOST))


Heard = Callable[["Usage"], None]
MOST_DEATHS = 2  # Workers that a cell may take along before it is left as crashed


@dataclass
class Usage:
    """Work that a sweep has done, and its cost so far."""

    cells: int = 0
    warm: int = 0
    cells_s: float = 0.0  # Seconds of the processor in the cells themselves
    cpu_s: float = 0.0  # Seconds of the processor in chunks: reading them and keeping what they came to included
    chunk_s: float = 0.0  # Seconds of chunks by the clock, of all workers
    died: int = 0  # Workers that ended before their time

    def add(self, reply: dict[str, Any]) -> None:
        """Count a chunk."""
        self.cells += reply["done"]
        self.warm += reply["warm"]
        for name in ("cells_s", "cpu_s", "chunk_s"):
            setattr(self, name, getattr(self, name) + reply[name])


@dataclass
class _Worker:
    number: int
    process: subprocess.Popen[str]
    chunk: list[Cell] = field(default_factory=list)
    error: str = ""


class Pool:
    """Some worker processes on one job, which keep their cells in shards of a folder."""

    def __init__(self, plan: SweepPlan, folder: Path, workers: int) -> None:
        self._plan, self._folder, self._count = plan, folder, workers
        self._lines: queue.Queue[tuple[int, str | None]] = queue.Queue()
        self._workers: dict[int, _Worker] = {}
        self._started = 0
        self._deaths: Counter[str] = Counter()
        self._errors: IO[bytes]  # What all of them write to standard error

    def answer(self, cells: Sequence[Cell], heard: Heard) -> Usage:
        """Answer every cell; `heard` is called after each chunk. Raises OutputError, TvimError if workers fail."""
        with tempfile.TemporaryFile() as self._errors:
            return self._answer(CellQueue(cells, self._plan, self._count), min(self._count, len(cells)), heard)

    def _answer(self, left: CellQueue, processes: int, heard: Heard) -> Usage:
        spent = Usage()
        try:
            for _ in range(processes):
                self._start(left)
            while self._workers:
                number, line = self._lines.get()
                worker = self._workers[number]
                if line is None:
                    self._handle_dead_worker(worker, left, spent)
                    continue
                reply = json.loads(line)
                if "error" in reply:
                    worker.error = reply["error"]
                    continue
                spent.add(reply)
                left.done(reply["done"], reply["chunk_s"])
                heard(spent)
                self._feed(worker, left)
        finally:
            for worker in self._workers.values():
                worker.process.kill()
                worker.process.wait()
        return spent

    def _start(self, left: CellQueue) -> None:
        self._started += 1
        number = self._started
        process = start_child(
            "tvimdesign.sweep.pool", stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors, text=True,
            encoding="utf-8",
        )  # fmt: skip
        read_lines(process, lambda line: self._lines.put((number, line)))
        worker = self._workers[number] = _Worker(number, process)
        job = pickle.dumps((self._plan, str(self._folder)))
        self._tell(worker, base64.b64encode(job).decode())
        self._feed(worker, left)

    def _feed(self, worker: _Worker, left: CellQueue) -> None:
        """Give a worker its next chunk; without one it ends."""
        worker.chunk = left.next(worker.number)
        if worker.chunk:
            self._tell(worker, json.dumps(worker.chunk))
        elif worker.process.stdin:
            with contextlib.suppress(BrokenPipeError):
                worker.process.stdin.close()

    @staticmethod
    def _tell(worker: _Worker, line: str) -> None:
        assert worker.process.stdin is not None
        with contextlib.suppress(BrokenPipeError):  # it has died, which is heard of in its turn
            worker.process.stdin.write(f"{line}\n")
            worker.process.stdin.flush()

    def _handle_dead_worker(self, worker: _Worker, left: CellQueue, spent: Usage) -> None:
        """Take a worker that has ended from the list; where it had cells, another one tries them again, one by one."""
        code = worker.process.wait()
        del self._workers[worker.number]
        complaint = last_line(self._errors)
        if worker.error:
            raise (OutputError if code == OutputError.exit_code else TvimError)(worker.error)
        if worker.process.stdin:
            with contextlib.suppress(BrokenPipeError):
                worker.process.stdin.close()
        if not worker.chunk:
            return
        spent.died += 1
        if not spent.cells and spent.died > self._count * MOST_DEATHS:
            raise TvimError(f"no worker process comes to its first cell: the last ended with code {code}: {complaint}")
        shards = Shards(self._folder, self._plan.columns)
        again = [cell for cell in worker.chunk if cell.key not in shards]
        spent.cells += len(worker.chunk) - len(again)
        if len(again) == 1:
            self._deaths[again[0].key] += 1
            if self._deaths[again[0].key] >= MOST_DEATHS:
                self._give_up(again[0], code, complaint)
                spent.cells += 1
                again = []
        left.put_back(again)
        if len(left):
            self._start(left)

    def _give_up(self, cell: Cell, code: int, complaint: str) -> None:
        """Keep a cell that ends whoever computes it."""
        nothing = (None,) * len(self._plan.columns)
        reason = f"its process ended with code {code}" + (f": {complaint}" if complaint else "")
        with ShardWriter(self._folder, self._plan.columns) as shard:
            shard.append([(cell.key, CellAnswer("crashed", reason, None, None, nothing), 0.0)])


def main() -> int:
    """Answer cells until there are no more."""
    from tvimdesign.sweep.answers import CellAnswers  # loads CasADi, which only workers need

    follow_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's to handle
    os.environ.update(dict.fromkeys(NAMES, "1"))  # there is a process for each core
    say = line_writer()
    plan, folder = pickle.loads(base64.b64decode(sys.stdin.readline()))
    answers = CellAnswers(plan)
    with ShardWriter(Path(folder), plan.columns) as shard:
        for line in sys.stdin:
            began, spent = time.perf_counter(), time.process_time()
            try:
                reply = []
                for key, texts in json.loads(line):
                    start = time.process_time()
                    answer = answers.answer(Cell(key, tuple(texts)))
                    reply.append((key, answer, time.process_time() - start))
                shard.append(reply)
            except TvimError as error:
                say({"error": str(error)})
                return error.exit_code
            cells = sum(seconds for _, _, seconds in reply)
            say({
                "done": len(reply), "cells_s": cells, "chunk_s": time.perf_counter() - began,
                "cpu_s": time.process_time() - spent, "warm": sum(answer.warm for _, answer, _ in reply),
            })  # fmt: skip
    return 0


if __name__ == "__main__":
    sys.exit(main())
