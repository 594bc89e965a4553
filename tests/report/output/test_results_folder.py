"""The results folder: nobody else's files are touched, nothing stands half written, one run writes at a time."""

import json
import os
import shutil
import signal
from contextlib import suppress
from pathlib import Path

import pytest
from results_written import FILES, finished, killed, texts

from tvimdesign.base import atomic_files
from tvimdesign.base.atomic_files import UNFINISHED, atomic_write
from tvimdesign.base.claim import FORMAT
from tvimdesign.base.errors import InputError, OutputError
from tvimdesign.base.interrupts import interrupt_handler
from tvimdesign.base.manifest import MANIFEST, read_manifest
from tvimdesign.base.results_folder import ResultsFolder


def test_a_manifest_lists_what_the_run_wrote_and_nothing_else_is_kept(tmp_path):
    with ResultsFolder(tmp_path) as folder:
        folder.write("results.csv", "mine")
        (tmp_path / "notes.txt").write_text("yours")
        folder.finish("optimal", {}, {})
    assert list(read_manifest(tmp_path).files) == ["results.csv"]
    assert texts(tmp_path) == {"results.csv": "mine", "notes.txt": "yours"}
    with ResultsFolder(tmp_path / "alone") as folder:
        folder.write("results.csv", "mine")
        folder.write(".cells-killed/cad/rotor.step", "half made")
        folder.finish("optimal", {}, {})
    assert texts(tmp_path / "alone") == {"results.csv": "mine"}


def test_overwriting_twice_keeps_what_the_user_put_there(tmp_path):
    finished(tmp_path)
    yours = {"my.yaml": "mode: shear", "notes.txt": "n", "cad/step/mine.step": "s", "plots/.x.part": "p"}
    for name, text in yours.items():
        (tmp_path / name).write_text(text)
    for _ in range(2):
        finished(tmp_path, {"results.csv": "new\n"}, overwrite=True)
    assert texts(tmp_path) == {**yours, "results.csv": "new\n"}
    there = {path.name for path in tmp_path.iterdir()}
    assert there == {"my.yaml", "notes.txt", "cad", "plots", "results.csv", MANIFEST}


def test_a_file_changed_by_hand_is_kept_beside_with_a_word(tmp_path, capsys):
    finished(tmp_path)
    (tmp_path / "results.csv").write_text("edited")
    (tmp_path / "plots/heat.png").write_text("edited, too")
    finished(tmp_path, {"results.csv": "new"}, overwrite=True)
    assert texts(tmp_path) == {"results.csv": "new", "results-1.csv": "edited", "plots/heat.png": "edited, too"}
    message = capsys.readouterr().err
    assert "results.csv: was changed since it was written, so it is kept as results-1.csv" in message
    assert "heat.png: was changed since it was written, so it is kept\n" in message


@pytest.mark.parametrize(
    "text",
    [
        '{"name": "my web application", "icons": []}',
        '{"files": {"thesis.tex": "sha256:0"}}',
        '{"status": "running", "files": {}}',
        json.dumps({"format": FORMAT, "run": "x", "files": {"thesis.tex": ""}, "seal": "sha256:0"}),
        "[" * 100_000,
        "no json",
    ],
)
@pytest.mark.parametrize("flags", [(False, False), (True, False), (False, True)])
def test_a_foreign_manifest_does_not_make_a_folder_ours(tmp_path, text, flags):
    yours = {"thesis.tex": "precious", "photos/1.jpg": "x"}
    for name, content in {**yours, MANIFEST: text}.items():
        write_file(tmp_path / name, content)
    with pytest.raises(InputError, match="was not written by this version"):
        ResultsFolder(tmp_path, *flags)
    assert texts(tmp_path) == yours
    assert (tmp_path / MANIFEST).read_text() == text


def write_file(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


@pytest.mark.parametrize("name", ["thesis.tex", "unfinished/ch1.tex", "unfinished"])
@pytest.mark.parametrize("flags", [(False, False), (True, False), (False, True)])
def test_a_folder_with_other_files_is_refused(tmp_path, name, flags):
    write_file(tmp_path / name, "precious")
    with pytest.raises(InputError):
        ResultsFolder(tmp_path, *flags)
    assert texts(tmp_path) == {name: "precious"}


def test_an_edited_manifest_does_not_vouch_for_files(tmp_path):
    finished(tmp_path)
    content = json.loads((tmp_path / MANIFEST).read_text())
    (tmp_path / MANIFEST).write_text(json.dumps({**content, "note": "mine"}))
    with pytest.raises(InputError, match="was changed since"):
        ResultsFolder(tmp_path, overwrite=True)
    assert set(texts(tmp_path)) == set(FILES)


@pytest.mark.parametrize("words", [(), ("overwrite",)])
@pytest.mark.parametrize("flags", [(True, False), (False, True)])
def test_after_sigkill_what_the_user_added_is_the_user_s(tmp_path, words, flags):
    out = tmp_path / "out"
    if words:
        finished(out)
    killed(out, *words)
    yours = {"thesis/ch1.tex": "one", "front/progress/note.txt": "three"}
    for name, text in yours.items():
        write_file(out / name, text)
    with ResultsFolder(out, *flags) as folder:
        assert (folder.path / "front/progress/0001.json").exists() == flags[1]
        folder.write("results.csv", "new")
        folder.remove("front/progress")
        folder.finish("optimal", {}, {})
    assert texts(out) == {**yours, "results.csv": "new"}


def test_files_of_a_killed_run_are_replaced_on_request_alone(tmp_path):
    killed(tmp_path)
    with pytest.raises(InputError, match="holds what an unfinished run has written"):
        ResultsFolder(tmp_path)
    assert texts(tmp_path)["unfinished/results.csv"] == "of the killed run"
    finished(tmp_path, {"results.csv": "new"}, overwrite=True)
    assert texts(tmp_path) == {"results.csv": "new"}


def test_a_link_is_refused_before_anything_is_removed(tmp_path):
    out, elsewhere = tmp_path / "out", tmp_path / "elsewhere"
    finished(out)
    shutil.move(out / "cad", elsewhere)
    (out / "cad").symlink_to(elsewhere)
    before = texts(tmp_path)
    with pytest.raises(InputError, match=r"cad: leads to .*elsewhere"):
        ResultsFolder(out, overwrite=True)
    assert texts(tmp_path) == before


def test_a_link_that_comes_while_a_run_is_going_leaves_both_results_whole(tmp_path):
    out, elsewhere = tmp_path / "out", tmp_path / "elsewhere"
    elsewhere.mkdir()
    finished(out, {"results.csv": "old"})
    folder = ResultsFolder(out, overwrite=True)
    folder.write("results.csv", "new")
    folder.write("cad/rotor.step", "new")
    (out / "cad").symlink_to(elsewhere)
    with pytest.raises(OutputError, match="whole in"), folder:
        folder.finish("optimal", {}, {})
    assert (out / "results.csv").read_text("utf-8-sig") == "old"
    assert list(elsewhere.iterdir()) == []
    (out / "cad").unlink()
    finished(out, {"summary.txt": "newer"}, overwrite=True)  # the results are put in place, then replaced
    assert texts(out) == {"summary.txt": "newer"}


def test_a_link_in_place_of_a_file_is_not_followed(tmp_path):
    out, precious = tmp_path / "out", tmp_path / "precious.csv"
    finished(out, {"results.csv": "old"})
    precious.write_text("precious")
    (out / "results.csv").unlink()
    (out / "results.csv").symlink_to(precious)
    finished(out, {"results.csv": "new"}, overwrite=True)
    assert precious.read_text() == "precious"
    assert (out / "results-1.csv").is_symlink()
    assert (out / "results.csv").read_text("utf-8-sig") == "new"


@pytest.mark.parametrize("error", [ZeroDivisionError, KeyboardInterrupt])
def test_a_run_that_fails_leaves_the_earlier_results_whole(tmp_path, error):
    finished(tmp_path)
    before, manifest = texts(tmp_path), (tmp_path / MANIFEST).read_bytes()
    with suppress(error), ResultsFolder(tmp_path, overwrite=True) as folder:
        folder.write("results.csv", "half of it")
        raise error
    unfinished = {name for name in texts(tmp_path) if name.startswith(UNFINISHED)}
    assert f"{UNFINISHED}/results.csv" in unfinished
    assert {name: text for name, text in texts(tmp_path).items() if name not in unfinished} == before
    assert (tmp_path / MANIFEST).read_bytes() == manifest
    finished(tmp_path, {"results.csv": "new"}, overwrite=True)
    assert texts(tmp_path) == {"results.csv": "new"}


def test_a_run_that_is_killed_as_its_results_are_put_in_place_is_completed(tmp_path, monkeypatch):
    finished(tmp_path)
    moves = Path.replace

    def ended(self: Path, target: Path) -> Path:
        if self.name == "b.csv":
            raise SystemExit
        return moves(self, target)

    folder = ResultsFolder(tmp_path, overwrite=True)
    for name in "ac":
        folder.write(f"{name}.csv", "new")
    atomic_write(folder.path / "b.csv", b"new")
    monkeypatch.setattr(Path, "replace", ended)
    with pytest.raises(SystemExit):
        folder.finish("optimal", {}, {})
    monkeypatch.undo()
    folder._claim.release()  # as the system does with a process that is gone
    (tmp_path / "a.csv").write_text("edited meanwhile")
    with pytest.raises(InputError, match="holds results already"):
        ResultsFolder(tmp_path)
    assert texts(tmp_path) == {"a.csv": "edited meanwhile", "b.csv": "new", "c.csv": "new"}


@pytest.mark.parametrize("mask", [0o077, 0o022, 0o002])
def test_files_respect_the_umask(tmp_path, mask):
    before = os.umask(mask)
    try:
        finished(tmp_path / "out")
    finally:
        os.umask(before)
    modes = {path.stat().st_mode & 0o777 for path in (tmp_path / "out").rglob("*") if path.is_file()}
    assert modes == {0o666 & ~mask}


def test_an_interrupt_while_the_manifest_is_made_is_noted_in_it(tmp_path, monkeypatch):
    usual = atomic_files.digest_of

    def interrupted(_: Path) -> str:
        monkeypatch.setattr(atomic_files, "digest_of", usual)
        raise KeyboardInterrupt

    with suppress(KeyboardInterrupt), ResultsFolder(tmp_path / "out") as folder:
        folder.write("results.csv", "whole")
        monkeypatch.setattr(atomic_files, "digest_of", interrupted)
        folder.finish("optimal", {}, {})
    manifest = json.loads((tmp_path / "out" / MANIFEST).read_bytes())
    assert (manifest["status"], list(manifest["files"])) == ("interrupted", ["results.csv"])


def test_nothing_after_a_swallowed_interrupt_counts_as_done(tmp_path):
    with interrupt_handler(), suppress(KeyboardInterrupt), ResultsFolder(tmp_path / "out") as folder:
        with suppress(KeyboardInterrupt):  # as some library does
            os.kill(os.getpid(), signal.SIGTERM)
        folder.finish("optimal", {}, {})
    assert json.loads((tmp_path / "out" / MANIFEST).read_bytes())["status"] == "interrupted"


def test_a_run_that_fails_leaves_a_manifest_that_says_so(tmp_path):
    with suppress(ZeroDivisionError), ResultsFolder(tmp_path / "out") as folder:
        folder.write("results.csv", "half of it")
        raise ZeroDivisionError
    assert json.loads((tmp_path / "out" / MANIFEST).read_text())["status"] == "failed"
    assert texts(tmp_path / "out") == {"results.csv": "half of it"}


def test_a_file_in_the_way_is_named(tmp_path):
    (tmp_path / "out").write_text("")
    with pytest.raises(InputError, match="is a file"):
        ResultsFolder(tmp_path / "out")


def test_a_write_that_fails_leaves_nothing_behind(tmp_path, monkeypatch):
    with ResultsFolder(tmp_path / "out") as folder:
        monkeypatch.setattr(os, "fsync", lambda _: (_ for _ in ()).throw(OSError("disk full")))
        with pytest.raises(OutputError, match=r"results\.csv: cannot be written: disk full"):
            folder.write("results.csv", "a,b\n")
        monkeypatch.undo()
        folder.finish("failed", {}, {})
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [MANIFEST]
