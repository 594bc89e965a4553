"""What a machine or a user can do to a command: one clear line, an exit code, and what was written before kept."""

import json
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from support import ROOT, environment, run_process

NASTY = "name: '[/bold] [red] N·m 名 :key:'\nmode: shear\n"


def run(*words: object, **more: str) -> subprocess.CompletedProcess[bytes]:
    """A process of its own, with more in its environment."""
    command = [sys.executable, "-m", "tvimdesign", *map(str, words)]
    return run_process(command, env={**environment(), **more})


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_a_terminal_that_lacks_letters_gets_plain_ones(encoding: str) -> None:
    done = run("rows", "stiff_threshold", PYTHONIOENCODING=encoding)
    assert done.returncode == 0, done.stderr
    assert ("N.m/rad" if encoding == "ascii" else "N·m/rad") in done.stdout.decode(encoding)


@pytest.mark.slow
def test_a_study_whose_name_looks_like_markup_runs_on_any_terminal(tmp_path: Path) -> None:
    (tmp_path / "nasty.yaml").write_text(NASTY, encoding="utf-8")
    words = ["--no-cad", "--no-plots", "--out", tmp_path / "[/bold]"]
    done = run("run", tmp_path / "nasty.yaml", *words, PYTHONIOENCODING="ascii", TVIMDESIGN_SPREAD="")
    assert done.returncode == 0, done.stderr
    assert b"[/bold] [red] N.m ? :key: (shear)" in done.stdout
    summary = (tmp_path / "[/bold]/summary.txt").read_text(encoding="utf-8")
    assert "Manufacturing: " in summary  # the child read those letters


@pytest.mark.parametrize(("words", "unbuffered"), [(["rows"], ""), (["--help"], "1")])
def test_output_that_cannot_be_written_is_one_line(words: list[str], unbuffered: str) -> None:
    around = {**environment(), "PYTHONUNBUFFERED": unbuffered}
    with Path("/dev/full").open("wb") as full:
        command = [sys.executable, "-m", "tvimdesign", *words]
        done = run_process(command, stdout=full, env=around)
    assert done.returncode == 4
    assert b"No space left on device" in done.stderr
    assert done.stderr.count(b"\n") == 1


@pytest.mark.gate
def test_a_file_that_cannot_be_written_is_named_and_the_others_are_kept(tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = run_process(
        [sys.executable, "-m", "tvimdesign", "run", "studies/paper_reconstructed.yaml", "--no-cad", "--no-plots",
         "--out", str(out)],
        text=True, cwd=ROOT, env=environment(),
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000)),
    )  # fmt: skip
    assert done.returncode == 4
    assert done.stderr.splitlines()[-1].startswith(f"{out}/unfinished/results.json: cannot be written: File too large;")
    assert "Traceback" not in done.stderr
    assert json.loads((out / "study.resolved.json").read_text())["mode"] == "shear"
    assert json.loads((out / "manifest.json").read_text())["status"] == "failed"
    assert not list(out.rglob(".*"))
