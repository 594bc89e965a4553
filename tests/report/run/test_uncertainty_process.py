"""A run whose uncertainty is not computed: it warns, says how to get it, and loses no number."""

import json
import subprocess
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from support import Command

from tvimdesign.base.child_process import start_child
from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import TimeOverError
from tvimdesign.report.run import uncertainty_process
from tvimdesign.report.run.uncertainty_process import UncertaintyProcess

STUDY = """
mode: shear
module: {transmission: unity, leg_model: ignored, spring_material: paper_wire}
require: {spring_stiffness: [">= 5.3 N.m/rad", "<= 6 N.m/rad"]}
"""


@pytest.mark.gate
@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("input(), input()\nwhile True: pass", "it was stopped after 0.2 s of processor time"),
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
    assert f"Warning: the uncertainty of the design could not be computed: {reason}" in said
    assert "run the study again" in said
    assert "the uncertainty of the design could not be computed" in done.stderr
    assert "could not be computed" in (tmp_path / "out/summary.txt").read_text()
    assert "uncertainty" not in json.loads((tmp_path / "out/results.json").read_text())
    assert (tmp_path / "out/design.json").exists()


def test_a_process_that_reads_nothing_ends_at_the_deadline(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A design does not fit into the pipe: to ask for it comes back at once all the same."""

    def start(_module: str, **options: Any) -> subprocess.Popen[Any]:
        monkeypatch.setenv("PYTHONPATH", str(tmp_path))
        return start_child("another_uncertainty", **options)

    (tmp_path / "another_uncertainty.py").write_text("import time; time.sleep(60)")
    monkeypatch.setattr(uncertainty_process, "start_child", start)
    large: Any = SimpleNamespace(model_dump_json=lambda: "x" * 1_000_000)
    with UncertaintyProcess(large) as process:
        process.begin(large)
        with pytest.raises(TimeOverError, match="before yield and intervals"):
            process.finish(Deadline(0.0, lambda: 0.0))


def test_steps_left_out_are_on_the_screen_and_in_the_results(tvimdesign: Command, tmp_path: Path) -> None:
    (tmp_path / "arm.yaml").write_text(STUDY)
    done = tvimdesign("run", "arm.yaml", "--no-cad", "--no-plots", "--out", "out", "--time-limit", "1 ms", cwd=tmp_path,
                      spread="on")  # fmt: skip
    assert done.returncode == 0, done.stderr
    said = " ".join(done.stdout.split())
    assert "Warning: the time limit of 0 s ended before these were done: yield and intervals" in said
    assert "Manufacturing" not in done.stdout
    assert "ended before these were done" in (tmp_path / "out/summary.txt").read_text()
    assert json.loads((tmp_path / "out/results.json").read_text())["left_out"] == ["yield and intervals"]
