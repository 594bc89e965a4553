"""A child is gone when its parent is, killed or not, and so are the children it has forked."""

import os
import signal
import subprocess
import sys
from pathlib import Path

from support import ROOT, are_gone, is_at_work

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


def test_a_child_that_is_still_imported_ends_with_its_parent(tmp_path: Path) -> None:
    parent = started("slow_child", SLOW, tmp_path)
    assert parent.stdout is not None
    child = int(parent.stdout.readline())
    assert is_at_work(child)
    parent.kill()
    parent.wait()
    parent.stdout.close()
    assert are_gone([child])


def test_children_end_with_a_parent_that_is_killed(tmp_path: Path) -> None:
    parent = started("sleeping_child", CHILD, tmp_path)
    assert parent.stdout is not None
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


def test_a_pipe_ends_a_child_if_the_kernel_cannot(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(ELSEWHERE)  # every interpreter begins with it, the child's too
    parent = started("told_child", NAMES_ITS_PIPE, tmp_path)
    assert parent.stdout is not None
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
