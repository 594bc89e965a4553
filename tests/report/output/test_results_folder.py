"""The results folder: nobody else's files are touched, nothing stands half written."""

from __future__ import annotations

import json
import os
import platform
import signal
from contextlib import suppress
from pathlib import Path

import pytest

from tvimdesign.base.errors import InputError, OutputError
from tvimdesign.base.interrupts import heeding_interrupts
from tvimdesign.report.output import results_folder
from tvimdesign.report.output.results_folder import MANIFEST, ResultsFolder


def test_a_folder_with_other_files_is_refused_even_to_overwrite(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("precious")
    for overwrite in (False, True):
        with pytest.raises(InputError):
            ResultsFolder(tmp_path, overwrite)
    assert (tmp_path / "thesis.tex").read_text() == "precious"


def test_overwriting_takes_the_earlier_run_s_files_and_no_others(tmp_path: Path) -> None:
    with ResultsFolder(tmp_path / "out") as folder:
        folder.write("plots/old.png", b"x")
        folder.finish("optimal", {}, {})
    (tmp_path / "out/notes.txt").write_text("mine")
    with ResultsFolder(tmp_path / "out", overwrite=True) as folder:
        folder.finish("optimal", {}, {})
    assert not (tmp_path / "out/plots").exists()
    assert (tmp_path / "out/notes.txt").read_text() == "mine"


def test_a_manifest_that_names_a_file_outside_does_not_delete_it(tmp_path: Path) -> None:
    (tmp_path / "outside").write_text("precious")
    out = tmp_path / "out"
    out.mkdir()
    (out / MANIFEST).write_text(json.dumps({"status": "optimal", "files": {"../outside": "sha256:0"}}))
    with ResultsFolder(out, overwrite=True) as folder:
        folder.finish("optimal", {}, {})
    assert (tmp_path / "outside").read_text() == "precious"


def test_a_folder_another_run_is_writing_is_refused(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    said = {"status": "running", "process": os.getppid(), "host": platform.node()}
    (out / MANIFEST).write_text(json.dumps(said))
    with pytest.raises(InputError, match="another run"):
        ResultsFolder(out, overwrite=True)


def test_an_interrupt_while_the_manifest_is_made_is_told_in_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    usual = results_folder.hash_of

    def interrupted(_: Path) -> str:
        monkeypatch.setattr(results_folder, "hash_of", usual)
        raise KeyboardInterrupt

    with suppress(KeyboardInterrupt), ResultsFolder(tmp_path / "out") as folder:
        folder.write("results.csv", "whole")
        monkeypatch.setattr(results_folder, "hash_of", interrupted)
        folder.finish("optimal", {}, {})
    said = json.loads((tmp_path / "out" / MANIFEST).read_bytes())
    assert (said["status"], list(said["files"])) == ("interrupted", ["results.csv"])


def test_what_was_made_after_an_interrupt_that_was_swallowed_is_not_told_as_done(tmp_path: Path) -> None:
    with heeding_interrupts(), suppress(KeyboardInterrupt), ResultsFolder(tmp_path / "out") as folder:
        with suppress(KeyboardInterrupt):  # as some library does
            os.kill(os.getpid(), signal.SIGTERM)
        folder.finish("optimal", {}, {})
    assert json.loads((tmp_path / "out" / MANIFEST).read_bytes())["status"] == "interrupted"


def test_a_killed_run_s_folder_can_be_used_again(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / MANIFEST).write_text(json.dumps({"status": "running", "process": 2**22 + 1, "host": platform.node()}))
    (out / "results.csv").write_text("half")
    with ResultsFolder(out, overwrite=True) as folder:
        folder.finish("optimal", {}, {})
    assert not (out / "results.csv").exists()


def test_a_run_that_fails_leaves_a_manifest_that_says_so(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), ResultsFolder(tmp_path / "out"):
        raise ZeroDivisionError
    assert json.loads((tmp_path / "out" / MANIFEST).read_text())["status"] == "failed"


def test_a_file_in_the_way_is_named(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")
    with pytest.raises(InputError, match="is a file"):
        ResultsFolder(tmp_path / "out")


def test_a_write_that_fails_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with ResultsFolder(tmp_path / "out") as folder:
        monkeypatch.setattr(os, "fsync", lambda _: (_ for _ in ()).throw(OSError("disk full")))
        with pytest.raises(OutputError, match=r"results\.csv: cannot be written: disk full"):
            folder.write("results.csv", "a,b\n")
        monkeypatch.undo()
        folder.finish("failed", {}, {})
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [MANIFEST]
