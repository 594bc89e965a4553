"""Files made beside the results stand in their folder: a process that is killed leaves no temporary folder."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest
from cad_designs import design_of, whole

from tvimdesign.base.atomic_files import UNFINISHED
from tvimdesign.base.errors import SimulationError
from tvimdesign.cad import make
from tvimdesign.cad.fe import model_comparison
from tvimdesign.report import verify_design
from tvimdesign.study.design import read_design, write_design


@pytest.fixture
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder of temporary files for this test alone."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


def test_the_design_of_parts_under_way_is_no_temporary_folder(tmp_path, temporary, monkeypatch):
    idle = [sys.executable, "-c", "import time; time.sleep(600)"]
    monkeypatch.setattr(make, "start_child", lambda _job, _arguments, **options: subprocess.Popen(idle, **options))
    out = tmp_path / "out/cad"
    with make.BackgroundPartsJob() as parts:
        parts.begin_with(whole(design_of("paper", {})), out)
        (design,) = out.iterdir()
        assert read_design(design).mode == "shear"
        assert list(temporary.iterdir()) == []
    assert list(out.iterdir()) == []


def test_what_is_verified_stands_beside_the_results_while_it_is_solved(tmp_path, temporary, monkeypatch):
    seen: list[Path] = []

    def solve(_names: Any, parts: Path, work: Path, *_: Any) -> None:
        seen.append(work)
        assert parts.is_relative_to(work)
        assert list(temporary.iterdir()) == []
        raise SimulationError("the mesh has no end")

    monkeypatch.setattr(model_comparison, "require_fe", lambda _: None)
    monkeypatch.setattr(model_comparison, "load_kernel", lambda: None)
    monkeypatch.setattr(model_comparison, "export_parts", lambda *_: None)
    monkeypatch.setattr(model_comparison, "run_solvers", solve)
    out = tmp_path / "out"
    design = write_design(whole(design_of("paper", {})), tmp_path / "design.json")
    with pytest.raises(SimulationError, match="the mesh has no end"):
        verify_design.verify_design(design, out, "", overwrite=True, as_json=False)
    assert seen[0].parent == out / UNFINISHED
    assert [path.name for path in out.iterdir()] == ["manifest.json"]
