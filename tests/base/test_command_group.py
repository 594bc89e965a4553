"""Commands beside this process that none outlive."""

import sys
import time
from pathlib import Path
from threading import Thread

import pytest
from support import are_gone

from tvimdesign.base.processes import CommandGroup, ProcessorTimeError

STARTS_ANOTHER = """
import os, subprocess, sys, time
other = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
open(sys.argv[1] + ".part", "w").write(f"{os.getpid()} {other.pid}")
os.rename(sys.argv[1] + ".part", sys.argv[1])
time.sleep(600)
"""


def test_what_a_command_says_and_its_code_are_given_back() -> None:
    code = "import sys; print('out'); sys.stderr.write('err'); sys.exit(3)"
    with CommandGroup() as commands:
        done = commands.run([sys.executable, "-c", code], 60.0)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (3, "out", "err")


def test_commands_of_other_threads_end_with_the_group(tmp_path: Path) -> None:
    reported, ended = tmp_path / "told", []
    with CommandGroup() as commands:
        command = [sys.executable, "-c", STARTS_ANOTHER, str(reported)]
        waits = Thread(target=lambda: ended.append(commands.run(command, 60.0)))
        waits.start()
        while not reported.exists():
            time.sleep(0.02)
    waits.join(60.0)
    assert [item.returncode < 0 for item in ended] == [True]
    _gone(reported)
    assert commands.run([sys.executable, "-c", "print(1)"], 60.0).returncode < 0


def test_a_command_that_takes_too_long_is_ended(tmp_path: Path) -> None:
    reported = tmp_path / "told"
    starts_a_burner = STARTS_ANOTHER.replace("import time; time.sleep(600)", "while True: pass")
    with CommandGroup() as commands, pytest.raises(ProcessorTimeError):
        commands.run([sys.executable, "-c", starts_a_burner, str(reported)], 0.5)
    _gone(reported)


def _gone(reported: Path) -> None:
    numbers = [int(number) for number in reported.read_text().split()]
    assert are_gone(numbers)
