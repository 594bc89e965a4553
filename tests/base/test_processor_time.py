"""Limits on processor time: a child that computes too long or hangs is stopped, one that has to wait is not."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from tvimdesign.base import processes
from tvimdesign.base.processes import ProcessorLimit, ProcessorTimeError, communicate

BURN = "while True: pass"
FORKED = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {BURN!r}])"
SLEEP = "import time; time.sleep(600)"


@contextmanager
def _running(code: str) -> Iterator[subprocess.Popen[bytes]]:
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        yield child
    finally:
        for item in processes.psutil.Process(child.pid).children():
            item.kill()
        child.kill()
        child.communicate()


@pytest.fixture(autouse=True)
def _checks_often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processes, "CHECK_EVERY", 0.05)


@pytest.mark.parametrize("code", [BURN, FORKED])
def test_a_process_that_computes_too_long_is_reported(code: str) -> None:
    with _running(code) as child, pytest.raises(ProcessorTimeError, match=r"0\.2 s of processor time"):
        communicate(child, 0.2)


def test_a_process_that_waits_uses_no_limit() -> None:
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(1); print(1)"], stdout=subprocess.PIPE)
    assert communicate(child, 0.5)[0].strip() == b"1"


def test_a_hanging_process_is_reported() -> None:
    with _running(SLEEP) as child:
        limit = ProcessorLimit(child.pid, idle_limit=0.5)
        with pytest.raises(ProcessorTimeError, match="used no processor time"):
            _check(limit, 600)


def _check(limit: ProcessorLimit, times: int) -> None:
    for _ in range(times):
        time.sleep(0.05)
        limit.check()


def test_time_without_checks_is_no_idle_time(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr(processes.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(processes, "processor_time", lambda _process: 1.0)
    limit = ProcessorLimit(1, idle_limit=1.0)
    for _ in range(8):  # the computer sleeps for an hour between two checks, each of which counts 0.1 s
        now[0] += 3600.0
        limit.check()


def test_the_count_starts_again_with_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    used = [0.0]
    monkeypatch.setattr(processes, "CHECK_EVERY", 0.0)
    monkeypatch.setattr(processes, "processor_time", lambda _process: used[0])
    limit = ProcessorLimit(1, 5.0)
    for _ in range(4):
        limit.check()
        used[0] += 4.0
        limit.check()
        limit.restart()
    limit.check()
    used[0] += 6.0
    with pytest.raises(ProcessorTimeError):
        limit.check()
