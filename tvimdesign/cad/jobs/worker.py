"""Does pieces of work in child processes, several at once, each with a limit of processor time.

What is kept is not done again.

A child is forked once the CAD kernel is loaded, so that it starts at once, and does one piece of work after another: a
fork for each would copy what it touches of the kernel's memory anew. One that is stuck in the kernel, or crashes, is
ended and its work named; another takes its place, and what was made is kept.
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
from tvimdesign.study.design import Design

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Job:
    """Input of a piece of work."""

    design: Design
    dims: Dimensions
    titles: Mapping[str, str]
    """What the catalogue calls the chosen records, by row."""
    needs: Mapping[str, Path]
    """Folder `kept/` of each piece of work that this one needs."""
    folder: Path
    """Where to write: files for the user under `out/`, what other pieces of work need under `kept/`."""
    progress: Progress


class Turn(IntEnum):
    """Order in which pieces of work are started, of those that need nothing that is not there."""

    FIRST = 0
    SECOND = 1
    USUAL = 2
    LATE = 3
    """No other work waits for it, but print beds."""


@dataclass(frozen=True, kw_only=True)
class Work:
    """One piece of work: a part with its files, the assembly, a set of checks, the pictures."""

    name: str
    do: Callable[[Job], list[SolidCheck]]
    """Writes its files; returns the checks it made. Raises GeometryError."""
    needs: tuple[str, ...] = ()
    named: bool = False
    """Whether the design's name is written into its files."""
    turn: Turn = Turn.USUAL
    words: str = ""
    """Short description for people; without one the name."""


@dataclass
class Done:
    """Results and failures of all pieces of work."""

    results: dict[str, Result] = field(default_factory=dict)
    failed: dict[str, str] = field(default_factory=dict)
    """Why, for each piece of work that came to nothing; it names the work."""
    lost: list[str] = field(default_factory=list)
    """Work that was not started because what it needs failed."""
    reused: list[str] = field(default_factory=list)


@dataclass
class _Hand:
    """A child process, which does what it is sent."""

    process: BaseProcess
    line: Connection


@dataclass
class _Running:
    work: Work
    hand: _Hand
    folder: Path
    watch: ProcessorLimit
    step: str
    stopped: str = ""
    """Which limit it exceeded."""
    reported: dict[str, Any] | None = None


class WorkerPool:
    """Does pieces of work for one design."""

    def __init__(
        self,
        subject: TrackedDesign,
        store: Cache,
        progress: Progress,
        limit: float = LIMIT,
        hands: int | None = None,
        made: Callable[[Result], object] = lambda _result: None,
    ) -> None:
        """`hands` is how many pieces of work are in progress at once; as many as there are cores, at most four.

        `made` gets every result as soon as it is there.
        """
        self._made = made
        self._subject, self._store, self._progress = subject, store, progress
        self._limit = limit
        self._hands = hands or min(os.cpu_count() or 1, 4)
        # Elsewhere a fork is not safe: a library's threads may hold locks, and macOS ends such a child.
        self._context: Any = mp.get_context("fork" if sys.platform == "linux" else "spawn")
        self._idle: list[_Hand] = []
        self._plan: Sequence[Work] = ()
        self._untold: list[Result] = []

    def do(self, build_plan: Sequence[Work]) -> Done:
        """Do all pieces of work, each after those that it needs; the results stand in the plan's order."""
        done = Done()
        self._plan = build_plan
        waiting, running = sorted(build_plan, key=lambda work: work.turn), list[_Running]()
        gc.freeze()  # a child that collects what is here copies all of it
        try:
            while waiting or running:
                waiting = self._start(waiting, running, done)
                self._tell()  # while the children work on: to hand out files is to wait for the disk
                self._listen(running, done)
            self._tell()
        finally:
            gc.unfreeze()
            for one in running:
                _end(one.hand)
                self._store.discard(one.folder)
            for hand in self._idle:
                _end(hand)
            self._idle = []
        in_order = [work.name for work in build_plan if work.name in done.results]
        return Done({name: done.results[name] for name in in_order}, done.failed, done.lost, done.reused)

    def _start(self, waiting: list[Work], running: list[_Running], done: Done) -> list[Work]:
        """Start what can be started, settle what needs no doing; returns what is still waiting."""
        left = []
        for work in waiting:
            if any(need in done.failed or need in done.lost for need in work.needs):
                done.lost.append(work.name)
            elif not all(need in done.results for need in work.needs):
                left.append(work)
            elif kept := self._store.find(work.name, self._subject, self._needs(work, done)):
                done.results[work.name] = kept
                self._untold.append(kept)
                done.reused.append(work.name)
            elif len(running) < self._hands:
                running.append(self._begin(work, done, len(running)))
            else:
                left.append(work)
        return left

    def _tell(self) -> None:
        for result in self._untold:
            self._made(result)
        self._untold = []

    def _needs(self, work: Work, done: Done) -> dict[str, Result]:
        return {need: done.results[need] for need in work.needs}

    def _begin(self, work: Work, done: Done, running: int) -> _Running:
        number = len(done.results) + len(done.failed) + len(done.lost) + running + 1
        self._progress(f"{number} of {len(self._plan)}, {work.words or work.name.replace('_', ' ')}")
        hand = self._idle.pop() if self._idle else self._fork()
        folder = self._store.fresh(work.name)
        needs = {need: result.folder / "kept" for need, result in self._needs(work, done).items()}
        with contextlib.suppress(OSError):  # that it has died is heard in `_listen`
            hand.line.send((self._plan.index(work), needs, folder))
        assert hand.process.pid is not None
        return _Running(work, hand, folder, ProcessorLimit(hand.process.pid, self._limit), work.name)

    def _fork(self) -> _Hand:
        line, its_end = self._context.Pipe()
        process = self._context.Process(target=_child, args=(self._plan, self._subject, its_end), daemon=True)
        process.start()
        its_end.close()
        return _Hand(process, line)

    def _listen(self, running: list[_Running], done: Done) -> None:
        """Wait until one of those at work says something, ends, or exceeds its limit."""
        if not running:
            return
        ready = wait([one.hand.line for one in running], timeout=CHECK_EVERY)
        for one in list(running):
            over = self._hear(one) if one.hand.line in ready else _exceeds_limit(one)
            if over:
                running.remove(one)
                self._settle(one, done)

    def _hear(self, one: _Running) -> bool:
        """Take in what a child said; returns whether it has come to its end."""
        try:
            message = one.hand.line.recv()
        except (EOFError, OSError):
            return True
        if "step" in message:
            one.step = message["step"]  # where it was, if it fails
            return False
        one.reported = message
        return True

    def _settle(self, one: _Running, done: Done) -> None:
        """Keep what a child made, or say why there is nothing; one that answered waits for more."""
        name = one.work.name
        if one.reported is None:
            if not one.stopped:
                one.hand.process.join(timeout=5.0)
            why = one.stopped or f"its process ended with code {one.hand.process.exitcode}"
            at = "" if one.step == name else f" (at: {one.step})"
            done.failed[name] = f"{name}: {why}{at}"
            _end(one.hand)
        elif "error" in one.reported:
            done.failed[name] = one.reported["error"]
        else:
            checks = [SolidCheck(**check) for check in one.reported["checks"]]
            reads: Reads = one.reported["reads"]
            done.results[name] = self._store.close(name, one.folder, reads, self._needs(one.work, done), checks)
            self._untold.append(done.results[name])
        if one.reported is not None:
            self._idle.append(one.hand)
        if name in done.failed:
            self._store.discard(one.folder)


def _exceeds_limit(one: _Running) -> bool:
    """Return True if a piece of work exceeds its limit, and note which."""
    try:
        one.watch.check()
    except ProcessorTimeError as error:
        one.stopped = f"{error}; a part takes seconds: change one of its dimensions a little"
    return bool(one.stopped)


def _child(plan: Sequence[Work], subject: TrackedDesign, line: Connection) -> None:
    """Do the pieces of work that are asked for by their places in the plan, until nobody asks."""
    parent = mp.parent_process()
    if parent and sys.platform != "linux":  # the kernel does not tell of its end, and work is not left to listen
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()
    follow_parent(parent.pid if parent else None)
    gc.enable()
    with contextlib.suppress(EOFError):
        while True:
            place, needs, folder = line.recv()
            line.send(_done(plan[place], subject, needs, folder, lambda step: line.send({"step": step})))
            set_lower_priority(os.getpid())  # people wait for the first part


def _end_with(parent: BaseProcess) -> None:
    parent.join()
    os._exit(1)


def _done(
    work: Work, subject: TrackedDesign, needs: Mapping[str, Path], folder: Path, progress: Progress
) -> dict[str, Any]:
    """Do one piece of work; returns what came of it."""
    try:
        design, dims, titles, reads = subject.watched(work.named)
        checks = work.do(Job(design, dims, titles, needs, folder, progress))
        return {"checks": [check.fields() for check in checks], "reads": reads}
    except TvimError as error:
        return {"error": str(error) if str(error).startswith(work.name) else f"{work.name}: {error}"}
    except Exception as error:  # the kernel raises a dozen classes, and none of them names the part
        return {"error": f"{work.name}: cannot be made ({type(error).__name__}: {error})"}


def _end(hand: _Hand) -> None:
    hand.line.close()
    if hand.process.is_alive():
        hand.process.kill()
    hand.process.join()
