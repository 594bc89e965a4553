"""Processes watched: their priority, limits of processor time, their end with all descendants, and groups of them."""

import contextlib
import os
import queue
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from enum import IntEnum
from queue import SimpleQueue
from types import TracebackType
from typing import IO, Any, Self, TypeVar

import psutil

from tvimdesign.base import run_watched
from tvimdesign.base.errors import TvimError


class Niceness(IntEnum):
    """Niceness of a process; on Linux each step is a fifth less of a processor that two processes want."""

    LOW = 5
    SOME = 10
    FAR = 14


def end_process_tree(process: int) -> None:
    """Kill a process and its descendants, those it starts meanwhile included; one that is gone is none to end.

    Whoever started the process waits for it.
    """
    try:
        root = psutil.Process(process)
    except psutil.NoSuchProcess:
        return
    with contextlib.suppress(psutil.NoSuchProcess):
        root.suspend()  # so that it starts no more
    killed: list[psutil.Process] = []
    while new := [child for child in _descendants(root) if child not in killed]:
        killed += new
        for child in new:
            _kill(child)
    _kill(root)


def set_low_priority(process: int, behind: Niceness = Niceness.SOME) -> None:
    """Let a process, and those it starts from now on, compute where others leave a processor free."""
    with contextlib.suppress(psutil.Error):  # Windows has classes in place of numbers
        psutil.Process(process).nice(int(getattr(psutil, "BELOW_NORMAL_PRIORITY_CLASS", behind)))


def set_lower_priority(process: int) -> None:
    """Lower the priority of a process at `Niceness.LOW` to `FAR`; leave others unchanged."""
    with contextlib.suppress(psutil.Error):
        if psutil.Process(process).nice() == Niceness.LOW:
            set_low_priority(process, Niceness.FAR)


def _descendants(root: psutil.Process) -> list[psutil.Process]:
    try:
        return root.children(recursive=True)
    except psutil.NoSuchProcess:
        return []


def _kill(process: psutil.Process) -> None:
    with contextlib.suppress(psutil.NoSuchProcess):
        process.kill()


LIMIT = 600.0  # Seconds of processor time for one task; each task that uses it takes some seconds
IDLE_LIMIT = 600.0  # Seconds without any processor time, by which a deadlocked process is recognised
CHECK_EVERY = 1.0  # s
Result = TypeVar("Result")
_TRY_AGAIN = (subprocess.TimeoutExpired, queue.Empty)


class ProcessorTimeError(TvimError):
    """A child process has used its processor time, or hangs without using any."""


class ProcessorLimit:
    """Limit the processor time of a process with its descendants; whoever waits for it calls `check`."""

    def __init__(self, process: int, limit: float = LIMIT, idle_limit: float = IDLE_LIMIT) -> None:
        """Count from the first check on, so that a short task costs nothing."""
        self._process, self._limit, self._idle_limit = process, limit, idle_limit
        self.restart()

    def restart(self) -> None:
        """Count anew: the process has reported progress."""
        self._start = self._last = -1.0
        self._idle, self._checked = 0.0, time.monotonic()

    def check(self) -> None:
        """Raise ProcessorTimeError if a limit is exceeded; call it every `CHECK_EVERY` seconds, or more often.

        Idle time is the sum of the intervals between checks, each counted as at most two seconds. A computer that
        sleeps, or a stopped process group, therefore adds no idle time.
        """
        now = time.monotonic()
        if now - self._checked < 0.9 * CHECK_EVERY:
            return
        used = processor_time(self._process)
        if self._start < 0.0:
            self._start = used
        self._idle = 0.0 if used != self._last else self._idle + min(now - self._checked, 2.0 * CHECK_EVERY)
        self._last, self._checked = used, now
        if used - self._start > self._limit:
            raise ProcessorTimeError(f"it was stopped after {self._limit:g} s of processor time")
        if self._idle > self._idle_limit:
            raise ProcessorTimeError(f"it was stopped: it used no processor time for {self._idle_limit:g} s")


def wait_for(watch: ProcessorLimit, wait: Callable[[float], Result]) -> Result:
    """Return what `wait` returns, which takes a timeout [s] as Popen.wait and Queue.get do.

    Raises ProcessorTimeError if the process exceeds its limit first.
    """
    while True:
        try:
            return wait(CHECK_EVERY)
        except _TRY_AGAIN:
            watch.check()


def processor_time(process: int) -> float:
    """Return the processor time [s] of a process with its descendants; 0 if the process is gone."""
    try:
        root = psutil.Process(process)
        return sum(map(_own_time, [root, *root.children(recursive=True)]))
    except psutil.NoSuchProcess:
        return 0.0


def _own_time(process: psutil.Process) -> float:
    try:
        times = process.cpu_times()
    except psutil.Error:
        return 0.0
    return float(times.user + times.system + times.children_user + times.children_system)


def communicate(process: subprocess.Popen[Any], limit: float = LIMIT) -> tuple[Any, Any]:
    """Wait for a process and return its output and its errors, as Popen.communicate does.

    Raises ProcessorTimeError if the process exceeds its limit; the caller then ends it.
    """
    return wait_for(ProcessorLimit(process.pid, limit), lambda seconds: process.communicate(timeout=seconds))


def last_line(output: IO[bytes]) -> str:
    """Return the last line of what processes wrote to a file."""
    output.seek(0)
    return " ".join(output.read().decode(errors="replace").strip().splitlines()[-1:])


class FedProcess:
    """A child process that is sent lines of text while this one works on; ended if it has not ended when it is left.

    A thread sends them: a pipe holds little, and a process that loads its libraries reads nothing.
    """

    def __init__(self, child: subprocess.Popen[str], niceness: Niceness | None = None) -> None:
        """Take a process whose input is a pipe of text."""
        self.child, stream = child, child.stdin
        assert stream is not None
        child.stdin = None  # closed by the thread, which `communicate` must not do meanwhile
        if niceness is not None:
            set_low_priority(child.pid, niceness)
        self._lines: SimpleQueue[str | None] = SimpleQueue()
        self._sender = threading.Thread(target=self._send_all, args=(stream,), daemon=True)
        self._sender.start()

    def send(self, text: str) -> None:
        """Send a line, and come back at once."""
        self._lines.put(f"{text}\n")

    def send_no_more(self) -> None:
        """Close the input of the process once everything is sent."""
        self._lines.put(None)

    def _send_all(self, stream: IO[str]) -> None:
        with suppress(OSError, ValueError):  # a process that has died reads no more
            for line in iter(self._lines.get, None):
                stream.write(line)
                stream.flush()
        with suppress(OSError):
            stream.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        """End the process and all that it started, if it has not ended."""
        if self.child.poll() is None:
            end_process_tree(self.child.pid)
        self.send_no_more()
        self._sender.join()
        self.child.communicate()


_GROUPS = os.name == "posix"  # True if processes have groups, and a pipe can be handed on to one


class CommandGroup:
    """Runs commands, from any thread, until it is left; those that are at work then are ended."""

    def __init__(self) -> None:
        self._at_work: set[subprocess.Popen[str]] = set()
        self._guard = threading.Lock()
        self._over = False
        self._reads, self._holds = os.pipe() if _GROUPS else (-1, -1)  # neither is inherited unless it is handed on

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        """End what is at work; a command that is asked for from now on does not begin."""
        with self._guard:
            self._over = True
            for process in self._at_work:
                _end(process)
        if _GROUPS:
            os.close(self._holds)  # its watchers end with it
            os.close(self._reads)

    def run(self, command: Sequence[str], limit: float, **options: Any) -> subprocess.CompletedProcess[str]:
        """Run a command to its end and give back what it says; `options` are Popen's.

        Raises ProcessorTimeError after `limit` seconds of processor time. The code is negative if the group is left.
        """
        process = self._started(command, options)
        if process is None:
            return subprocess.CompletedProcess(command, -int(signal.SIGTERM), "", "")
        try:
            out, err = communicate(process, limit)
        except BaseException:
            _end(process)
            process.communicate()
            raise
        finally:
            with self._guard:
                self._at_work.discard(process)
        return subprocess.CompletedProcess(command, process.returncode, out, err)

    def _started(self, command: Sequence[str], options: dict[str, Any]) -> subprocess.Popen[str] | None:
        words = list(command)
        if _GROUPS:
            words = [sys.executable, "-I", "-S", run_watched.__file__, str(self._reads), *words]
            options = {**options, "pass_fds": (self._reads,), "start_new_session": True}
        with self._guard:
            if self._over:
                return None
            process = subprocess.Popen(
                words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                errors="replace", **options,
            )  # fmt: skip
            self._at_work.add(process)
        return process


def _end(process: subprocess.Popen[str]) -> None:
    """Kill a process and its group; one that is gone is none to end."""
    with suppress(ProcessLookupError, PermissionError):  # the second is macOS's word for a group that has ended
        if _GROUPS:
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
