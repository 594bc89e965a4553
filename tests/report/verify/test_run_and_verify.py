"""`run --verify`: finite elements that cannot be had are told before the run, whose design is verified."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
from support import Command

from tvimdesign.cli import commands

STUDY = "mode: shear\n"


def test_what_finite_elements_lack_is_told_before_the_run(tmp_path: Path, tvimdesign: Command) -> None:
    (tmp_path / "mine.yaml").write_text(STUDY)
    said = tvimdesign("run", "mine.yaml", "--verify", "--fe-python", str(tmp_path / "none"), cwd=tmp_path)
    assert said.returncode == 2
    assert "--fe-python" in said.stderr
    assert not (tmp_path / "results").exists()


def test_the_run_comes_first_and_its_folder_is_verified(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    done: list[Any] = []
    monkeypatch.setattr("tvimdesign.report.run.run_study.run_study", lambda *_, **__: done.append("run"))
    monkeypatch.setattr("tvimdesign.cad.fe.run_solvers.require_fe", done.append)
    monkeypatch.setattr(
        "tvimdesign.report.verify.verify_design.verify_design",
        lambda path, out, _, **given: done.append((path, out, given["told"])),
    )
    out = tmp_path / "wrist"
    commands.run(tmp_path / "mine.yaml", out=out, verified=True, json=True)
    assert done == [sys.executable, "run", (out, tmp_path / "wrist-verified", False)]
