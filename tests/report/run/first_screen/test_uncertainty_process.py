"""A run whose uncertainty is not computed: it warns, says how to get it, and loses no number."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest
from support import Command

from tvimdesign.base.child_process import start_child
from tvimdesign.report.run.first_screen import uncertainty_process

STUDY = """
mode: shear
module: {transmission: unity, leg_model: ignored, spring_material: paper_wire}
require: {spring_stiffness: [">= 5.3 N.m/rad", "<= 6 N.m/rad"]}
"""


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("while True: pass", "it was stopped after 0.2 s of processor time"),
        ("import os; os._exit(7)", "its process ended with code 7"),
        ('print(\'{"error": "no start"}\')', "no start"),
    ],
)
def test_an_uncertainty_that_is_not_computed_is_a_warning(
    code: str, reason: str, tvimdesign: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def start(_module: str, **options: Any) -> subprocess.Popen[Any]:
        return start_child("another_uncertainty", **options)

    (tmp_path / "another_uncertainty.py").write_text(code)
    (tmp_path / "arm.yaml").write_text(STUDY)
    monkeypatch.setattr(uncertainty_process, "start_child", start)
    monkeypatch.setattr(uncertainty_process, "PROCESSOR_LIMIT", 0.2)
    done = tvimdesign("run", "arm.yaml", "--no-cad", "--no-plots", "--out", "out", cwd=tmp_path, spread="on",
                      PYTHONPATH=str(tmp_path))  # fmt: skip
    assert done.returncode == 4, done.stderr
    said = " ".join(done.stdout.split())
    assert f"Warning the uncertainty of the design could not be computed: {reason}" in said
    assert "run `tvimdesign tolerate` with the results folder" in said
    assert "the uncertainty of the design could not be computed" in done.stderr
    assert "could not be computed" in (tmp_path / "out/summary.txt").read_text()
    assert "uncertainty" not in json.loads((tmp_path / "out/results.json").read_text())
    assert (tmp_path / "out/design.json").exists()
