"""A process that answers jobs as lines of JSON: the newest job wins, and interrupts a slow one."""

import asyncio
import contextlib
import json
import signal
import subprocess
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tvimdesign.base.child_process import start_child
from tvimdesign.base.processes import set_low_priority

Reply = dict[str, Any]
_STARTS = 2  # Times the worker may end without an answer before its job is given up


@dataclass(frozen=True)
class Job:
    """A task of a worker."""

    number: int
    data: Mapping[str, Any]
    """Sent to the worker with the number, as JSON; `stage` says how exactly a state is to be answered."""
    fallback: Reply  # The reply if the worker ends without one
    interruptible: bool = False  # True if another job interrupts it

    @property
    def stage(self) -> str:
        """Required exactness of an answer; empty for a job without a stage."""
        return str(self.data.get("stage", ""))


class WorkerProcess:
    """A worker process, and the one job that waits for it. To be used in an event loop."""

    def __init__(
        self, module: str, arguments: Sequence[str], report: Callable[[Job, Reply], None], *, low_priority: bool = False
    ) -> None:
        """Start the worker, a module with arguments; `report` is called with every reply to a job."""
        self._low_priority = low_priority
        self._module, self._arguments, self._report = module, list(arguments), report
        self._loop = asyncio.get_running_loop()
        self.under_way: Job | None = None  # The job that is being answered
        self._waiting: Job | None = None
        self._interrupted = False
        self._ended = 0  # Times it has ended by itself since its last answer
        self._closed = False
        self._start()

    def ask(self, job: Job) -> None:
        """Answer a job next; the one that waited is dropped, an interruptible one is interrupted."""
        if self.under_way is None:
            if self._ended >= _STARTS:
                self._start()
            self._send(job)
            return
        self._waiting = job
        if self.under_way.interruptible and not self._interrupted:
            self._interrupted = True
            self._child.send_signal(signal.SIGINT)

    @property
    def process(self) -> int:
        """Number of the worker's process."""
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
        if self._low_priority:
            set_low_priority(self._child.pid)
        self._thread = threading.Thread(target=self._read, args=(self._child,), daemon=True)
        self._thread.start()

    def _read(self, child: subprocess.Popen[str]) -> None:
        """Hand every line to the loop; runs in a thread."""
        assert child.stdout is not None
        with child.stdout:
            for line in child.stdout:
                self._call(self._receive, json.loads(line))
        if child.stdin:
            with contextlib.suppress(OSError):
                child.stdin.close()
        self._call(self._restart)

    def _call(self, function: Callable[..., None], *arguments: Any) -> None:
        with contextlib.suppress(RuntimeError):  # the loop is closed
            self._loop.call_soon_threadsafe(function, *arguments)

    def _send(self, job: Job) -> None:
        self.under_way, self._interrupted = job, False
        assert self._child.stdin is not None
        with contextlib.suppress(OSError, ValueError):  # a worker that has died is started again when that is heard
            self._child.stdin.write(json.dumps({"number": job.number, **job.data}) + "\n")
            self._child.stdin.flush()

    def _receive(self, reply: Reply) -> None:
        job = self.under_way
        if job is None or reply.get("number") != job.number:
            return
        if "progress" in reply:
            self._report(job, reply)
            return
        self.under_way, self._ended = None, 0
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            self._send(waiting)
        self._report(job, reply)

    def _restart(self) -> None:
        """Start a worker that has ended by itself again, with the newest job."""
        if self._closed:
            return
        self._child.wait()
        self._ended += 1
        job, self.under_way = self._waiting or self.under_way, None
        self._waiting = None
        if self._ended < _STARTS:
            self._start()
            if job is not None:
                self._send(job)
        elif job is not None:  # started again when something else is asked
            self._report(job, job.fallback)
