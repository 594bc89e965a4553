"""A drawing process that fails or uses its processor time: every number is written and the command ends partly done."""

import json
import re
import subprocess
from pathlib import Path
from typing import Any

import pytest
from small_sweeps import SMALL
from support import Command

import tvimdesign as tvim
from tvimdesign.base.child_process import start_child
from tvimdesign.report.output import plot_process

BURNS = "while True: pass"
FAILS = "raise RuntimeError('no fonts')"
WEIGHTS = "mass [g]; angle [deg]\n0; 0.9\n100; 5.1\n200; 9.3\n300; 13.4\n200; 9.8\n100; 5.6\n0; 1.4\n"
STUDY = """
mode: shear
module: {transmission: unity, leg_model: ignored, spring_material: paper_wire}
require: {spring_stiffness: [">= 5.3 N.m/rad", "<= 6 N.m/rad"]}
"""
# The shell of every command draws alike; `fit` has no page, and `sweep` is resumed in place of overwritten.
COMMANDS = {
    "run": (["run", "arm.yaml", "--no-cad"], {"results.json", "design.json", "summary.txt"}),
    "fit": (["fit", "weights.csv", "--set", "arm=100 mm"], {"fit.json", "residuals.csv"}),
    "sweep": (["sweep", "grid.yaml", "--workers", "1"], {"sweep.json", "cells.csv"}),
}


def _draws_by(code: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the drawing process run this code."""
    (folder / "another_drawer.py").write_text(code)
    monkeypatch.setenv("PYTHONPATH", str(folder))

    def start(_module: str, **options: Any) -> subprocess.Popen[Any]:
        return start_child("another_drawer", **options)

    monkeypatch.setattr(plot_process, "start_child", start)
    monkeypatch.setattr(plot_process, "PROCESSOR_LIMIT", 0.2)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.gate] if name in {"run", "sweep"} else []) for name in COMMANDS]
)
def test_plots_that_take_too_long_cost_no_number(
    name: str, tvimdesign: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "arm.yaml").write_text(STUDY)
    (tmp_path / "grid.yaml").write_text(SMALL)
    (tmp_path / "weights.csv").write_text(WEIGHTS)
    _draws_by(BURNS, tmp_path, monkeypatch)
    words, files = COMMANDS[name]
    out = tmp_path / "out"
    done = tvimdesign(*words, "--out", out, "--json", cwd=tmp_path, PYTHONPATH=str(tmp_path))
    assert done.returncode == 4, done.stderr
    said = " ".join(done.stderr.split())
    assert "the plots could not be drawn: it was stopped after 0.2 s of processor time" in said
    assert f"for the plots, repeat the command with --{'resume' if name == 'sweep' else 'overwrite'}" in said
    (missing,) = json.loads(done.stdout)["not_done"]
    assert missing.startswith("the plots could not be drawn")
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["files"].keys() >= files | {"report.html"} - ({"report.html"} if name == "fit" else set())
    if name != "run":
        assert manifest["status"] == "partly done"


def test_a_drawing_process_that_fails_says_why(
    tvimdesign: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "weights.csv").write_text(WEIGHTS)
    _draws_by(FAILS, tmp_path, monkeypatch)
    words, _ = COMMANDS["fit"]
    done = tvimdesign(*words, "--out", tmp_path / "out", cwd=tmp_path, PYTHONPATH=str(tmp_path))
    assert done.returncode == 4
    assert re.search(r"stiffness .*N·m/rad", done.stdout)
    assert "could not be drawn: RuntimeError: no fonts" in " ".join(done.stderr.split())


def test_a_result_that_is_saved_without_plots_warns(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _draws_by(BURNS, tmp_path, monkeypatch)
    result = tvim.example("paper_reconstructed").evaluate(progress=False)
    with pytest.warns(UserWarning, match=r"0\.2 s of processor time.*save again with overwrite=True"):
        result.save(tmp_path / "out")
    assert {"report.html", "design.json", "results.json"} <= {path.name for path in (tmp_path / "out").iterdir()}
