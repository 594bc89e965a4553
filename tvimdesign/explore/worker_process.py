"""A process that answers jobs as lines of JSON: the newest job wins, and what is slow gives way to it."""

from __future__ import annotations

import asyncio
import contextlib
import json
import signal
import subprocess
import threading
from collections.abc import Callable, Sequence
from typing import Any, Generic, Protocol, TypeVar

from tvimdesign.base.child_process import start_child
from tvimdesign.base.process_tree import set_low_priority

Told = dict[str, Any]
_STARTS = 2
"""Times the worker may end without an answer before its job is given up."""


class Work(Protocol):
    """What a worker is asked."""

    @property
    def number(self) -> int:
        """By which an answer is known to be its."""

    @property
    def gives_way(self) -> bool:
        """Whether it is interrupted when another job comes."""

    def line(self) -> str:
        """As the worker reads it."""

    def given_up(self) -> Told:
        """What is told where the worker ended over it."""


Job = TypeVar("Job", bound=Work)


class WorkerProcess(Generic[Job]):
    """A worker process, and the one job that waits for it. To be used in an event loop."""

    def __init__(
        self, module: str, arguments: Sequence[str], told: Callable[[Job, Told], None], *, behind: bool = False
    ) -> None:
        """Start the worker, a module with arguments; `told` is called with all it says of a job.

        One that stands `behind` computes where other processes leave a processor free.
        """
        self._behind = behind
        self._module, self._arguments, self._told = module, list(arguments), told
        self._loop = asyncio.get_running_loop()
        self._under_way: Job | None = None
        self._waiting: Job | None = None
        self._interrupted = False
        self._ended = 0
        """Times it has ended by itself since its last answer."""
        self._closed = False
        self._start()

    def ask(self, job: Job) -> None:
        """Answer a job as soon as may be; what waited before it is dropped, what is slow is interrupted."""
        if self._under_way is None:
            if self._ended >= _STARTS:
                self._start()
            self._send(job)
            return
        self._waiting = job
        if self._under_way.gives_way and not self._interrupted:
            self._interrupted = True
            self._child.send_signal(signal.SIGINT)

    @property
    def under_way(self) -> Job | None:
        """What is being answered, if anything is."""
        return self._under_way

    @property
    def process(self) -> int:
        """The worker's number."""
        return self._child.pid

    def close(self) -> None:
        """End the worker."""
        self._closed = True
        self._child.kill()
        self._child.wait()
        self._thread.join()

    def _start(self) -> None:
        self._child = start_child(
            self._module, self._arguments,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8", bufsize=1,
            process_group=0,  # no session of its own, between which `set_low_priority` has no meaning on Linux
        )  # fmt: skip
        if self._behind:
            set_low_priority(self._child.pid)
        self._thread = threading.Thread(target=self._read, args=(self._child,), daemon=True)
        self._thread.start()

    def _read(self, child: subprocess.Popen[str]) -> None:
        """In a thread: hand every line to the loop."""
        assert child.stdout is not None
        with child.stdout:
            for line in child.stdout:
                self._call(self._heard, json.loads(line))
        if child.stdin:
            with contextlib.suppress(OSError):
                child.stdin.close()
        self._call(self._lost)

    def _call(self, function: Callable[..., None], *arguments: Any) -> None:
        with contextlib.suppress(RuntimeError):  # the loop is closed: nobody listens any more
            self._loop.call_soon_threadsafe(function, *arguments)

    def _send(self, job: Job) -> None:
        self._under_way, self._interrupted = job, False
        assert self._child.stdin is not None
        with contextlib.suppress(OSError, ValueError):  # a worker that has died is started again when that is heard
            self._child.stdin.write(job.line())
            self._child.stdin.flush()

    def _heard(self, told: Told) -> None:
        job = self._under_way
        if job is None or told.get("number") != job.number:
            return
        if "progress" in told:
            self._told(job, told)
            return
        self._under_way, self._ended = None, 0
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            self._send(waiting)
        self._told(job, told)

    def _lost(self) -> None:
        """The worker has ended by itself: start it again, with the job that is newest."""
        if self._closed:
            return
        self._child.wait()
        self._ended += 1
        job, self._under_way = self._waiting or self._under_way, None
        self._waiting = None
        if self._ended < _STARTS:
            self._start()
            if job is not None:
                self._send(job)
        elif job is not None:  # started again when something else is asked
            self._told(job, job.given_up())
