"""Claims on a results folder, and the progress of a run."""

import io
import itertools
import json
import os
import platform
import re
import signal
import subprocess
import sys
import time
from contextlib import suppress

import psutil
import pytest
from results_written import finished, killed, texts
from rich.markup import escape
from rich.table import Table
from support import wait_until

from tvimdesign.base.atomic_files import RUN, UNFINISHED, atomic_write
from tvimdesign.base.claim import FORMAT
from tvimdesign.base.errors import FolderInUseError, InputError
from tvimdesign.base.results_folder import ResultsFolder, joined
from tvimdesign.report.output import terminal
from tvimdesign.report.output.terminal import OwnMarkupConsole, RemainingTime, clock, duration
from tvimdesign.sweep.shards import SHARDS


def test_a_folder_another_run_is_writing_is_refused(tmp_path):
    with ResultsFolder(tmp_path) as folder:
        for flags in ((False, False), (True, False), (False, True)):
            with pytest.raises(FolderInUseError, match=rf"another run \(process {os.getpid()}\)"):
                ResultsFolder(tmp_path, *flags)
        folder.finish("optimal", {}, {})


def test_a_run_on_another_host_is_not_taken_for_dead(tmp_path):
    killed(tmp_path)
    claim = json.loads((tmp_path / UNFINISHED / RUN).read_text())
    assert claim["host"] == platform.node()
    assert psutil.Process().create_time() <= claim["started"] <= time.time()
    (tmp_path / UNFINISHED / RUN).write_text(json.dumps({**claim, "host": "elsewhere"}))
    with pytest.raises(FolderInUseError, match=r"on elsewhere\) is writing it; .*or remove .*\.run\.json if"):
        ResultsFolder(tmp_path, overwrite=True)


def test_without_locks_the_process_that_a_claim_names_is_looked_up(tmp_path, monkeypatch):
    monkeypatch.setattr("tvimdesign.base.claim._locked", lambda *_, **__: None)
    with ResultsFolder(tmp_path) as folder, pytest.raises(FolderInUseError):
        ResultsFolder(folder.out)
    killed(tmp_path, "overwrite")
    finished(tmp_path, overwrite=True)
    path = tmp_path / UNFINISHED / RUN
    path.parent.mkdir()
    claim = {"format": FORMAT, "status": "running", "host": platform.node(), "process": os.getpid(), "started": 1.0}
    path.write_text(json.dumps(claim))  # the number was given to another process since
    finished(tmp_path, overwrite=True)


_CLAIMS = (
    "import sys, time; from pathlib import Path\n"
    "from tvimdesign.base.results_folder import ResultsFolder\n"
    "from tvimdesign.base.errors import InputError\n"
    "print('ready', flush=True); sys.stdin.readline()\n"
    "for out in sys.argv[1:]:\n"
    "    try:\n"
    "        folder = ResultsFolder(Path(out))\n"
    "    except InputError:\n"
    "        print('refused', flush=True)\n"
    "    else:\n"
    "        print('claimed', flush=True)\n"
    "    sys.stdin.readline()\n"
)


def test_of_two_processes_one_claims_a_folder(tmp_path):
    outs = [str(tmp_path / str(number)) for number in range(100)]
    pair = [
        subprocess.Popen(
            [sys.executable, "-c", _CLAIMS, *outs], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )
        for _ in range(2)
    ]
    answers = []
    for _ in range(len(outs) + 1):
        answers.append(sorted(str(process.stdout and process.stdout.readline()).strip() for process in pair))
        for process in pair:
            process.stdin.write("\n")
            process.stdin.flush()
    for process in pair:
        process.communicate()
    assert answers == [["ready", "ready"], *[["claimed", "refused"]] * len(outs)]


def test_jobs_share_a_folder_and_one_of_them_gathers(tmp_path):
    with joined(tmp_path, SHARDS) as first, joined(tmp_path, SHARDS) as second:
        assert first == second
        (first / "shards").mkdir()
        atomic_write(first / "shards/00001.jsonl", b"cells")
        with pytest.raises(FolderInUseError):
            ResultsFolder(tmp_path, overwrite=True)
        with pytest.raises(FolderInUseError):
            ResultsFolder(tmp_path, resume=True, progress=SHARDS)
    with ResultsFolder(tmp_path, resume=True, progress=SHARDS) as folder:
        folder.finish("swept", {}, {})
    assert texts(tmp_path) == {"shards/00001.jsonl": "cells"}
    with joined(tmp_path, SHARDS) as again:  # cells that are there are used again
        assert (again / "shards/00001.jsonl").read_text() == "cells"
    with ResultsFolder(tmp_path, resume=True, progress=SHARDS) as folder:
        folder.finish("swept", {}, {})
    assert texts(tmp_path) == {"shards/00001.jsonl": "cells"}


def test_time_left_is_the_mean_of_the_steps_of_a_series():
    left = RemainingTime()
    left.heard("start 1 of 4", 10.0)
    assert left.left(12.0) is None
    left.heard("start 2 of 4", 14.0)
    assert left.left(14.0) == pytest.approx(12.0)
    left.heard("a word between", 15.0)
    assert left.left(15.0) == pytest.approx(11.0)
    left.heard("start 4 of 4", 30.0)
    assert left.left(30.0) == pytest.approx(20.0 / 3.0)
    left.heard("drawing the plots", 36.0)
    assert left.left(36.0) is None
    left = RemainingTime()
    left.heard("start 1 of 2", 0.0)
    left.heard("start 2 of 2", 5.0)
    left.heard("point 1 of 9", 10.0)
    assert left.left(10.0) is None
    left.heard("point 3 of 9", 14.0)
    assert left.left(14.0) is None
    left.heard("point 4 of 9", 16.0)
    assert left.left(16.0) == pytest.approx(12.0)
    assert [duration(seconds) for seconds in (8.2, 59.4, 125.0, 4320.0)] == ["8 s", "59 s", "2 min 05 s", "1 h 12 min"]
    assert clock(0.4, 9.0) == ""
    assert clock(3.0, None) == "3 s"
    assert clock(3.0, 0.2) == "3 s"
    assert clock(3.0, 90.0) == "3 s, about 1 min 30 s left"


def read_on(capsys: pytest.CaptureFixture[str], lines: list[str]) -> list[str]:
    """Add what was printed since to lines, and return them."""
    lines += capsys.readouterr().err.splitlines()
    return lines


@pytest.mark.gate
def test_plain_lines_come_every_few_seconds(capsys, monkeypatch):
    monkeypatch.setattr(terminal, "PLAIN_EVERY", 1.2)
    with terminal.progress_output() as say:
        for i in range(10):
            say(f"start {i + 1} of 40")
        lines = list[str]()
        assert wait_until(lambda: len(read_on(capsys, lines)) == 3)  # a thread prints the last, then that it goes on
        say("")
    assert len(read_on(capsys, lines)) == 3
    assert lines[0].startswith("... start 1 of 40 · ░")
    assert re.fullmatch(r"\.\.\. start 10 of 40 · █{4}░{16} 22% · \d+ s(, about .* left)?", lines[1])
    assert re.fullmatch(r"\.\.\. still start 10 of 40 · █{4}░{16} 22% · \d+ s(, about .* left)?", lines[2])


def test_what_goes_on_is_shown_again_without_its_figures(capsys, monkeypatch):
    monkeypatch.setattr(terminal, "PLAIN_EVERY", 0.0)
    with terminal.progress_output() as say:
        for _ in range(3):
            say("adding margins: 3 % so far")
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "... adding margins: 3 % so far"
    assert {line.partition(" · ")[0] for line in lines[1:]} == {"... still adding margins"}


@pytest.mark.gate
def test_silence_never_lasts_three_seconds(capsys):
    lines, times = list[str](), [time.monotonic()]
    with terminal.progress_output() as say:
        say("searching")
        for _ in range(2):
            before = len(lines)
            assert wait_until(lambda count=before: len(read_on(capsys, lines)) > count)
            times.append(time.monotonic())
    assert max(b - a for a, b in itertools.pairwise(times)) < 3.0
    assert len(set(lines)) == len(lines)


@pytest.mark.parametrize("error", [SystemError, RuntimeError, InputError])
def test_what_a_library_raises_after_an_interrupt_is_the_interrupt(error):
    def fail(*, interrupted: bool) -> None:
        with terminal.progress_output():
            if interrupted:
                with suppress(KeyboardInterrupt):
                    os.kill(os.getpid(), signal.SIGINT)
            raise error("a result with an exception set")

    with pytest.raises(KeyboardInterrupt):
        fail(interrupted=True)
    with pytest.raises(error):
        fail(interrupted=False)


TEXTS = ["[/bold]", "a [/] b", "[link=http://x]u[/link]", "x[1, 2]", "[[", "]", "[bold", "[/red] [/bold]", ":key:"]


def shown(what: object) -> str:
    stream = io.StringIO()
    OwnMarkupConsole(file=stream, width=80, color_system=None, highlight=False).print(what)
    return stream.getvalue()


@pytest.mark.parametrize("text", TEXTS)
def test_a_user_s_text_is_shown_as_it_stands(text):
    assert text in shown(f"Results are in [bold]{escape(text)}[/bold]")
    assert text in shown(f"Results are in {text}")
    table = Table()
    table.add_column(text)
    table.add_row(text, text)
    assert shown(table).count(text) == 3
    assert shown("[bold]a[/bold] [dim]b[/dim] [red]c[/]") == "a b c\n"
