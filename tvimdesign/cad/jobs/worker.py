"""Does pieces of work in child processes, several at once, each with a limit of processor time.

Results in the cache are not made again. Workers are forked once the CAD kernel is loaded, so that they start at once,
and do one piece of work after another: a fork for each would copy memory of the kernel again. A worker that is stuck or
crashes is stopped and its work named; another takes its place.
"""

import contextlib
import gc
import multiprocessing as mp
import os
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

from tvimdesign.base.child_process import follow_parent
from tvimdesign.base.errors import TvimError
from tvimdesign.base.processes import CHECK_EVERY, LIMIT, ProcessorLimit, ProcessorTimeError, set_lower_priority
from tvimdesign.cad.cad_report import SolidCheck
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.jobs.cache import Cache, Reads, Result, TrackedDesign
from tvimdesign.study import Design

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Job:
    """Input of a piece of work."""

    design: Design
    dims: Dimensions
    titles: Mapping[str, str]  # Titles of the chosen records, by row
    needs: Mapping[str, Path]  # Folder `kept/` of each piece of work that this one needs
    folder: Path  # Where to write: files for the user under `out/`, what other pieces of work need under `kept/`


class Turn(IntEnum):
    """Order in which pieces of work are started, of those that need nothing that is not there."""

    FIRST = 0
    SECOND = 1
    USUAL = 2
    LATE = 3  # No other work waits for it, but print beds


@dataclass(frozen=True, kw_only=True)
class Work:
    """One piece of work: a part with its files, the assembly, a set of checks, the pictures."""

    name: str
    do: Callable[[Job], list[SolidCheck]]  # Writes its files; returns the checks it made. Raises GeometryError.
    needs: tuple[str, ...] = ()
    named: bool = False  # True if the design's name is written into its files
    turn: Turn = Turn.USUAL
    words: str = ""  # Short description for people; without one the name


@dataclass
class Done:
    """Results and failures of all pieces of work."""

    results: dict[str, Result] = field(default_factory=dict)
    failed: dict[str, str] = field(default_factory=dict)
    """Why, for each piece of work that came to nothing; it names the work."""
    lost: list[str] = field(default_factory=list)  # Work that was not started because what it needs failed
    reused: list[str] = field(default_factory=list)


@dataclass
class _Worker:
    """A child process that does the work it is sent."""

    process: BaseProcess
    pipe: Connection


@dataclass
class _Task:
    """A piece of work in progress."""

    work: Work
    worker: _Worker
    folder: Path
    watch: ProcessorLimit
    stopped: str = ""  # Which limit it exceeded
    reported: dict[str, Any] | None = None


class WorkerPool:
    """Does pieces of work for one design."""

    def __init__(
        self,
        subject: TrackedDesign,
        store: Cache,
        progress: Progress,
        limit: float = LIMIT,
        workers: int | None = None,
        made: Callable[[Result], object] = lambda _result: None,
    ) -> None:
        """Prepare. By default there are as many `workers` as cores, at most four; `made` gets every result at once."""
        self._made = made
        self._subject, self._store, self._progress = subject, store, progress
        self._limit = limit
        self._workers = workers or min(os.cpu_count() or 1, 4)
        # Elsewhere a fork is not safe: a library's threads may hold locks, and macOS ends such a child.
        self._context: Any = mp.get_context("fork" if sys.platform == "linux" else "spawn")
        self._idle: list[_Worker] = []
        self._plan: Sequence[Work] = ()
        self._pending_results: list[Result] = []

    def do(self, build_plan: Sequence[Work]) -> Done:
        """Do all pieces of work, each after those that it needs; return the results in the plan's order."""
        done = Done()
        self._plan = build_plan
        waiting, running = sorted(build_plan, key=lambda work: work.turn), list[_Task]()
        gc.freeze()  # a child that collects what is here copies all of it
        try:
            while waiting or running:
                waiting = self._start(waiting, running, done)
                self._report()  # while the workers go on, because copying files waits for the disk
                self._poll(running, done)
            self._report()
        finally:
            gc.unfreeze()
            for task in running:
                _stop(task.worker)
                self._store.discard(task.folder)
            for worker in self._idle:
                _stop(worker)
            self._idle = []
        in_order = [work.name for work in build_plan if work.name in done.results]
        return Done({name: done.results[name] for name in in_order}, done.failed, done.lost, done.reused)

    def _start(self, waiting: list[Work], running: list[_Task], done: Done) -> list[Work]:
        """Start what can be started, and take from the cache what is there; return what is still waiting."""
        left = []
        for work in waiting:
            if any(need in done.failed or need in done.lost for need in work.needs):
                done.lost.append(work.name)
            elif not all(need in done.results for need in work.needs):
                left.append(work)
            elif cached := self._store.find(work.name, self._subject, self._needs(work, done)):
                done.results[work.name] = cached
                self._pending_results.append(cached)
                done.reused.append(work.name)
            elif len(running) < self._workers:
                running.append(self._begin(work, done, len(running)))
            else:
                left.append(work)
        return left

    def _report(self) -> None:
        for result in self._pending_results:
            self._made(result)
        self._pending_results = []

    def _needs(self, work: Work, done: Done) -> dict[str, Result]:
        return {need: done.results[need] for need in work.needs}

    def _begin(self, work: Work, done: Done, running: int) -> _Task:
        number = len(done.results) + len(done.failed) + len(done.lost) + running + 1
        self._progress(f"{number} of {len(self._plan)}, {work.words or work.name.replace('_', ' ')}")
        worker = self._idle.pop() if self._idle else self._fork()
        folder = self._store.fresh(work.name)
        needs = {need: result.folder / "kept" for need, result in self._needs(work, done).items()}
        with contextlib.suppress(OSError):  # `_poll` notices a dead worker
            worker.pipe.send((self._plan.index(work), needs, folder))
        assert worker.process.pid is not None
        return _Task(work, worker, folder, ProcessorLimit(worker.process.pid, self._limit))

    def _fork(self) -> _Worker:
        pipe, its_end = self._context.Pipe()
        process = self._context.Process(target=_child, args=(self._plan, self._subject, its_end), daemon=True)
        process.start()
        its_end.close()
        return _Worker(process, pipe)

    def _poll(self, running: list[_Task], done: Done) -> None:
        """Wait until a worker answers, ends, or exceeds its limit."""
        if not running:
            return
        ready = wait([task.worker.pipe for task in running], timeout=CHECK_EVERY)
        for task in list(running):
            is_ready = task.worker.pipe in ready
            if is_ready:
                with contextlib.suppress(EOFError, OSError):
                    task.reported = task.worker.pipe.recv()
            if is_ready or _exceeds_limit(task):
                running.remove(task)
                self._finish(task, done)

    def _finish(self, task: _Task, done: Done) -> None:
        """Store the result of a piece of work, or note why there is none; a worker that answered becomes idle."""
        name = task.work.name
        if task.reported is None:
            if not task.stopped:
                task.worker.process.join(timeout=5.0)
            why = task.stopped or f"its process ended with code {task.worker.process.exitcode}"
            done.failed[name] = f"{name}: {why}"
            _stop(task.worker)
        elif "error" in task.reported:
            done.failed[name] = task.reported["error"]
        else:
            checks = [SolidCheck(**check) for check in task.reported["checks"]]
            reads: Reads = task.reported["reads"]
            done.results[name] = self._store.close(name, task.folder, reads, self._needs(task.work, done), checks)
            self._pending_results.append(done.results[name])
        if task.reported is not None:
            self._idle.append(task.worker)
        if name in done.failed:
            self._store.discard(task.folder)


def _exceeds_limit(task: _Task) -> bool:
    """Return True if a piece of work exceeds its limit, and note which."""
    try:
        task.watch.check()
    except ProcessorTimeError as error:
        task.stopped = f"{error}; a part takes seconds: change one of its dimensions a little"
    return bool(task.stopped)


def _child(plan: Sequence[Work], subject: TrackedDesign, pipe: Connection) -> None:
    """Do the requested pieces of work, given by their places in the plan, until the pipe closes."""
    parent = mp.parent_process()
    if parent and sys.platform != "linux":  # no signal comes when the parent ends, so a thread waits for it
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()
    follow_parent(parent.pid if parent else None)
    gc.enable()
    with contextlib.suppress(EOFError):
        while True:
            place, needs, folder = pipe.recv()
            pipe.send(_done(plan[place], subject, needs, folder))
            set_lower_priority(os.getpid())  # people wait for the first part


def _end_with(parent: BaseProcess) -> None:
    parent.join()
    os._exit(1)


def _done(work: Work, subject: TrackedDesign, needs: Mapping[str, Path], folder: Path) -> dict[str, Any]:
    """Do one piece of work; return its checks and what it read, or the error."""
    try:
        design, dims, titles, reads = subject.watched(work.named)
        checks = work.do(Job(design, dims, titles, needs, folder))
        return {"checks": [check.fields() for check in checks], "reads": reads}
    except TvimError as error:
        return {"error": str(error) if str(error).startswith(work.name) else f"{work.name}: {error}"}
    except Exception as error:  # the kernel raises a dozen classes, and none of them names the part
        return {"error": f"{work.name}: cannot be made ({type(error).__name__}: {error})"}


def _stop(worker: _Worker) -> None:
    worker.pipe.close()
    if worker.process.is_alive():
        worker.process.kill()
    worker.process.join()
