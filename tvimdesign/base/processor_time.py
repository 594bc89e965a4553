"""Limits on the processor time of child processes: no answer depends on how busy the machine is."""

from __future__ import annotations

import queue
import subprocess
import time
from collections.abc import Callable
from typing import Any, TypeVar

import psutil

from tvimdesign.base.errors import TvimError

LIMIT = 600.0
"""Seconds of processor time for one task; each task that uses it takes some seconds."""
IDLE_LIMIT = 600.0
"""Seconds without any processor time, by which a deadlocked process is recognised."""
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
