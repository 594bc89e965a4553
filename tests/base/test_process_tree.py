"""A process is ended with all that it started, in groups of their own or not."""

import subprocess
import sys

import psutil
from support import are_gone, is_at_work

from tvimdesign.base.processes import Niceness, end_process_tree, set_low_priority, set_lower_priority

CHILD = "import time; time.sleep(600)"
PARENT = f"""
import subprocess, sys, time
others = [subprocess.Popen([sys.executable, "-c", {CHILD!r}], start_new_session=apart) for apart in (False, True)]
print(*(other.pid for other in others), flush=True)
time.sleep(600)
"""


def test_descendants_end_with_their_process() -> None:
    process = subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    others = [psutil.Process(int(number)) for number in process.stdout.readline().split()]
    assert [is_at_work(other.pid) for other in others] == [True, True]
    end_process_tree(process.pid)
    process.stdout.close()
    assert are_gone([process.pid, *(other.pid for other in others)])
    assert process.wait() != 0


def test_a_process_that_is_gone_is_none_to_end() -> None:
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    end_process_tree(process.pid)


def test_a_process_that_gives_way_and_what_it_starts_are_behind_all_others() -> None:
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
    set_low_priority(item.pid)  # it has ended: nobody is to give way


def test_who_gives_way_a_little_gives_way_further_and_others_do_not() -> None:
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
