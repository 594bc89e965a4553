"""A real dask cluster on this machine: a scheduler and worker processes that tests may kill and start again."""

from __future__ import annotations

import socket
import subprocess
import sys
import time
from pathlib import Path
from types import TracebackType

from support import ROOT, environment

from tvimdesign.base.processes import end_process_tree


class LocalCluster:
    """A scheduler at a port of its own, and workers of one thread each."""

    def __init__(self, folder: Path) -> None:
        """Choose a port; nothing is started yet."""
        self._folder = folder
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.scheduler: subprocess.Popen[bytes] | None = None
        self.workers: list[subprocess.Popen[bytes]] = []

    def start_scheduler(self) -> None:
        """Start the scheduler, or start it again, and wait until it listens."""
        self.scheduler = self._start("scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard")
        end = time.monotonic() + 600.0
        while time.monotonic() < end and self.scheduler.poll() is None:
            with socket.socket() as client:
                if client.connect_ex(("127.0.0.1", self.port)) == 0:
                    return
            time.sleep(0.1)
        raise AssertionError((self._folder / "said.txt").read_text())

    def start_worker(self) -> None:
        """Start a worker, which waits for the scheduler."""
        own = self._folder / f"worker-{len(self.workers)}"
        own.mkdir()
        self.workers.append(
            self._start("worker", self.address, "--nthreads", "1", "--no-dashboard", "--local-directory", str(own))
        )

    def _start(self, kind: str, *words: str) -> subprocess.Popen[bytes]:
        with (self._folder / "said.txt").open("ab") as said:
            command = [sys.executable, "-m", "dask", kind, *words]
            return subprocess.Popen(command, stdout=said, stderr=said, env=environment(), cwd=ROOT)

    def kill_scheduler(self) -> None:
        """End the scheduler at once."""
        assert self.scheduler is not None
        _kill(self.scheduler)

    def kill_worker(self, number: int) -> None:
        """End a worker at once, the process that watches over it included."""
        _kill(self.workers[number])

    def __enter__(self) -> LocalCluster:
        """Start a scheduler and three workers."""
        self.start_scheduler()
        for _ in range(3):
            self.start_worker()
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        """End all of it."""
        for process in [*self.workers, *filter(None, [self.scheduler])]:
            _kill(process)


def _kill(process: subprocess.Popen[bytes]) -> None:
    end_process_tree(process.pid)
    process.wait()
