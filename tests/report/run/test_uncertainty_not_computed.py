"""A run whose uncertainty is not computed: it warns, says how to get it, and loses no number."""

import json
from pathlib import Path
from typing import Any

import pytest
from support import Command

from tvimdesign.base.errors import TvimError
from tvimdesign.report.run.uncertainty_data import Uncertainty

STUDY = """
mode: shear
module: {transmission: unity, leg_model: ignored, spring_material: paper_wire}
require: {spring_stiffness: [">= 5.3 N.m/rad", "<= 6 N.m/rad"]}
"""


@pytest.mark.gate
def test_an_uncertainty_that_is_not_computed_is_a_warning(
    tvimdesign: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_start(*_: Any, **__: Any) -> None:
        raise TvimError("no start")

    (tmp_path / "arm.yaml").write_text(STUDY)
    monkeypatch.setattr(Uncertainty, "data", no_start)
    done = tvimdesign("run", "arm.yaml", "--no-cad", "--no-plots", "--out", "out", cwd=tmp_path, spread="on")
    assert done.returncode == 4, done.stderr
    said = " ".join(done.stdout.split())
    assert "Warning: the uncertainty of the design could not be computed: no start" in said
    assert "run the study again" in said
    assert "the uncertainty of the design could not be computed" in done.stderr
    assert "could not be computed" in (tmp_path / "out/summary.txt").read_text()
    assert "uncertainty" not in json.loads((tmp_path / "out/results.json").read_text())
    assert (tmp_path / "out/design.json").exists()


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
