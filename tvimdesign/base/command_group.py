"""Commands of other programs, run beside this process: none outlives it, or whoever asked for it, nor does what it
starts."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Sequence
from contextlib import suppress
from types import TracebackType
from typing import Any

from tvimdesign.base import run_watched
from tvimdesign.base.processor_time import communicate

_GROUPS = os.name == "posix"
"""Whether processes have groups, and a pipe can be handed on to one."""


class CommandGroup:
    """Runs commands, from any thread, until it is left; those that are at work then are ended."""

    def __init__(self) -> None:
        """Start without a running command."""
        self._at_work: set[subprocess.Popen[str]] = set()
        self._guard = threading.Lock()
        self._over = False
        self._reads, self._holds = os.pipe() if _GROUPS else (-1, -1)  # neither is inherited unless it is handed on

    def __enter__(self) -> CommandGroup:
        """Begin."""
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
