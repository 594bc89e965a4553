"""The claim on a results folder: one run writes it at a time, jobs of an array share it."""

import json
import os
import platform
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from results_written import finished, killed, texts

from tvimdesign.base.atomic_files import RUN, UNFINISHED, atomic_write
from tvimdesign.base.claim import FORMAT
from tvimdesign.base.errors import FolderInUseError
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.report.sweep.sweep_study import joined
from tvimdesign.sweep.shards import SHARDS


def test_a_folder_another_run_is_writing_is_refused(tmp_path: Path) -> None:
    with ResultsFolder(tmp_path) as folder:
        for flags in ((False, False), (True, False), (False, True)):
            with pytest.raises(FolderInUseError, match=rf"another run \(process {os.getpid()}\)"):
                ResultsFolder(tmp_path, *flags)
        folder.finish("optimal", {}, {})


def test_a_run_on_another_host_is_not_taken_for_dead(tmp_path: Path) -> None:
    killed(tmp_path)
    said = json.loads((tmp_path / UNFINISHED / RUN).read_text())
    assert said["host"] == platform.node()
    assert psutil.Process().create_time() <= said["started"] <= time.time()
    (tmp_path / UNFINISHED / RUN).write_text(json.dumps({**said, "host": "elsewhere"}))
    with pytest.raises(FolderInUseError, match=r"on elsewhere\) is writing it; .*or remove .*\.run\.json if"):
        ResultsFolder(tmp_path, overwrite=True)


def test_without_locks_the_process_that_a_claim_names_is_looked_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tvimdesign.base.claim._locked", lambda *_, **__: None)
    with ResultsFolder(tmp_path) as folder, pytest.raises(FolderInUseError):
        ResultsFolder(folder.out)
    killed(tmp_path, "overwrite")
    finished(tmp_path, overwrite=True)
    path = tmp_path / UNFINISHED / RUN
    path.parent.mkdir()
    said = {"format": FORMAT, "status": "running", "host": platform.node(), "process": os.getpid(), "started": 1.0}
    path.write_text(json.dumps(said))  # the number was given to another process since
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


def test_of_two_processes_one_claims_a_folder(tmp_path: Path) -> None:
    outs = [str(tmp_path / str(number)) for number in range(100)]
    pair = [
        subprocess.Popen(
            [sys.executable, "-c", _CLAIMS, *outs], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )
        for _ in range(2)
    ]
    said = []
    for _ in range(len(outs) + 1):
        said.append(sorted(str(process.stdout and process.stdout.readline()).strip() for process in pair))
        for process in pair:
            process.stdin.write("\n")
            process.stdin.flush()
    for process in pair:
        process.communicate()
    assert said == [["ready", "ready"], *[["claimed", "refused"]] * len(outs)]


def test_jobs_share_a_folder_and_one_of_them_gathers(tmp_path: Path) -> None:
    with joined(tmp_path) as first, joined(tmp_path) as second:
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
    with joined(tmp_path) as again:  # cells that are there are used again
        assert (again / "shards/00001.jsonl").read_text() == "cells"
    with ResultsFolder(tmp_path, resume=True, progress=SHARDS) as folder:
        folder.finish("swept", {}, {})
    assert texts(tmp_path) == {"shards/00001.jsonl": "cells"}
