"""A child is gone when its parent is, killed or not, and so are the children it has forked."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from support import ROOT, is_at_work

CHILD = """
import os, sys, time
from tvimdesign.base.child_process import follow_parent
follow_parent()
first, other = os.getpid(), os.fork()
if not other:
    follow_parent(first)
else:
    print(first, other, sys.stdout.encoding, flush=True)
time.sleep(60)
"""
PARENT = """
import time
from tvimdesign.base.child_process import start_child
start_child("sleeping_child")
time.sleep(60)
"""


def test_children_end_with_a_parent_that_is_killed(tmp_path: Path) -> None:
    (tmp_path / "sleeping_child.py").write_text(CHILD)
    environment = {**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{tmp_path}", "PYTHONIOENCODING": "ascii"}
    parent = subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True, env=environment)
    assert parent.stdout is not None
    first, other, encoding = parent.stdout.readline().split()
    assert encoding == "utf-8"
    assert is_at_work(int(first))
    assert is_at_work(int(other))
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    parent.stdout.close()
    end = time.monotonic() + 2.0
    while time.monotonic() < end and (is_at_work(int(first)) or is_at_work(int(other))):
        time.sleep(0.02)
    assert not is_at_work(int(first))
    assert not is_at_work(int(other))
