"""Child processes, and extras that are not installed."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import psutil
import pytest
from support import ROOT, are_gone, is_at_work, study_path

from tvimdesign.base import environment, processes
from tvimdesign.base.errors import InputError
from tvimdesign.base.processes import (
    Niceness,
    ProcessorLimit,
    ProcessorTimeError,
    communicate,
    end_process_tree,
    set_low_priority,
    set_lower_priority,
)
from tvimdesign.cad import make_cad

CHILD = """
import os, sys, time
from tvimdesign.base.child_process import follow_parent
follow_parent()
first, other = os.getpid(), os.fork()
if not other:
    follow_parent(first)
else:
    print(first, other, sys.stdout.encoding, flush=True)
time.sleep(600)
"""
PARENT = """
import time
from tvimdesign.base.child_process import start_child
start_child("sleeping_child")
time.sleep(600)
"""


SLOW = """
import os, time
print(os.getpid(), flush=True)
time.sleep(600)
"""


def started(name: str, text: str, folder: Path) -> subprocess.Popen[str]:
    """Start a parent with a child whose module has this text."""
    (folder / f"{name}.py").write_text(text)
    environment = {**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{folder}", "PYTHONIOENCODING": "ascii"}
    command = [sys.executable, "-c", PARENT.replace("sleeping_child", name)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)


def test_a_child_that_is_still_imported_ends_with_its_parent(tmp_path):
    parent = started("slow_child", SLOW, tmp_path)
    child = int(parent.stdout.readline())
    assert is_at_work(child)
    parent.kill()
    parent.wait()
    parent.stdout.close()
    assert are_gone([child])


def test_children_end_with_a_parent_that_is_killed(tmp_path):
    parent = started("sleeping_child", CHILD, tmp_path)
    first, other, encoding = parent.stdout.readline().split()
    assert encoding == "utf-8"
    assert is_at_work(int(first))
    assert is_at_work(int(other))
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    parent.stdout.close()
    assert are_gone([int(first), int(other)])


ELSEWHERE = """
import sys
from types import SimpleNamespace
from tvimdesign.base import child_process
child_process.sys = SimpleNamespace(platform="darwin", executable=sys.executable)
"""
NAMES_ITS_PIPE = """
import os, time
print(os.getpid(), os.environ["TVIMDESIGN_ALIVE"], flush=True)
time.sleep(600)
"""


def test_a_pipe_ends_a_child_if_the_kernel_cannot(tmp_path):
    (tmp_path / "sitecustomize.py").write_text(ELSEWHERE)  # every interpreter begins with it, the child's too
    parent = started("told_child", NAMES_ITS_PIPE, tmp_path)
    child, pipe = map(int, parent.stdout.readline().split())
    assert pipe > 2
    assert is_at_work(child)
    parent.kill()
    parent.wait()
    parent.stdout.close()
    gone = are_gone([child])
    if not gone:
        os.kill(child, signal.SIGKILL)
    assert gone


TREE_CHILD = "import time; time.sleep(600)"
TREE_PARENT = f"""
import subprocess, sys, time
others = [subprocess.Popen([sys.executable, "-c", {TREE_CHILD!r}], start_new_session=apart) for apart in (False, True)]
print(*(other.pid for other in others), flush=True)
time.sleep(600)
"""


def test_descendants_end_with_their_process_and_a_gone_one_is_none():
    process = subprocess.Popen([sys.executable, "-c", TREE_PARENT], stdout=subprocess.PIPE, text=True)
    others = [psutil.Process(int(number)) for number in process.stdout.readline().split()]
    assert [is_at_work(other.pid) for other in others] == [True, True]
    end_process_tree(process.pid)
    process.stdout.close()
    assert are_gone([process.pid, *(other.pid for other in others)])
    assert process.wait() != 0
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    end_process_tree(process.pid)


def test_a_process_that_gives_way_and_what_it_starts_are_behind_all_others():
    code = (
        "import subprocess, sys; sys.stdin.readline(); "
        "print(subprocess.run([sys.executable, '-c', 'import psutil; print(psutil.Process().nice())'], "
        "capture_output=True, text=True).stdout)"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as item:
        set_low_priority(item.pid)
        message, _ = item.communicate("go on\n")
    assert int(message) > psutil.Process().nice()
    set_low_priority(item.pid)  # it has ended: no priority is left to set


def test_who_gives_way_a_little_gives_way_further_and_others_do_not():
    with subprocess.Popen([sys.executable, "-c", "import sys; sys.stdin.read()"], stdin=subprocess.PIPE) as item:
        held = psutil.Process(item.pid)
        set_lower_priority(item.pid)
        assert held.nice() == psutil.Process().nice()
        set_low_priority(item.pid, Niceness.LOW)
        little = held.nice()
        set_lower_priority(item.pid)
        assert psutil.Process().nice() < little <= held.nice()
        set_low_priority(item.pid, Niceness.SOME)
        last = held.nice()
        set_lower_priority(item.pid)
        assert held.nice() == last
        item.communicate()


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
def test_a_process_that_computes_too_long_is_reported(code):
    with _running(code) as child, pytest.raises(ProcessorTimeError, match=r"0\.2 s of processor time"):
        communicate(child, 0.2)


def test_waiting_uses_no_limit_and_hanging_is_reported():
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(1); print(1)"], stdout=subprocess.PIPE)
    assert communicate(child, 0.5)[0].strip() == b"1"
    with _running(SLEEP) as child:
        limit = ProcessorLimit(child.pid, idle_limit=0.5)
        with pytest.raises(ProcessorTimeError, match="used no processor time"):
            _check(limit, 600)


def _check(limit: ProcessorLimit, times: int) -> None:
    for _ in range(times):
        time.sleep(0.05)
        limit.check()


def test_limits_count_work_and_start_again_with_progress(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(processes.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(processes, "processor_time", lambda _process: 1.0)
    limit = ProcessorLimit(1, idle_limit=1.0)
    for _ in range(8):  # the computer sleeps for an hour between two checks; each counts 0.1 s
        now[0] += 3600.0
        limit.check()
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


@pytest.fixture
def without_cad(monkeypatch: pytest.MonkeyPatch) -> None:
    def finder(name: str) -> Any:
        return None if name == "cadquery" else find_spec(name)

    monkeypatch.setattr(environment, "find_spec", finder)


@pytest.mark.slow
@pytest.mark.usefixtures("without_cad")
def test_a_run_without_cad_says_so_and_does_the_rest(tvimdesign, tmp_path):
    study = study_path("paper_reconstructed")
    done = tvimdesign("run", study, "--no-plots", "--out", tmp_path / "run")
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("No parts: cadquery is not installed: pip install 'tvimdesign[cad]'") == 1
    assert (tmp_path / "run/report.html").exists()
    assert not (tmp_path / "run/cad").exists()
    reported = json.loads(tvimdesign("run", study, "--no-plots", "--json", "--out", tmp_path / "json").stdout)
    assert reported["not_done"] == ["parts: cadquery is not installed: pip install 'tvimdesign[cad]'"]
    refused = tvimdesign("cad", tmp_path / "run/design.json", "--out", tmp_path / "parts")
    assert refused.returncode == InputError.exit_code
    assert "pip install 'tvimdesign[cad]'" in refused.stderr


@pytest.mark.usefixtures("without_cad")
def test_parts_without_cad_are_refused_by_the_name_of_the_extra(tmp_path):
    with pytest.raises(InputError, match=r"parts: cadquery is not installed: pip install 'tvimdesign\[cad\]'"):
        make_cad(tmp_path / "design.json", tmp_path)


def test_what_is_there_is_not_missed():
    assert [environment.how_to_install(extra) for extra in environment.MODULES] == [""]
