"""Files made beside the results stand in their folder: a process that is killed leaves no temporary folder."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Any

import pytest
from cad_designs import design_of, whole

from tvimdesign.base.atomic_files import UNFINISHED
from tvimdesign.base.errors import SimulationError
from tvimdesign.report import verify_design
from tvimdesign.report.run import parts_of_design
from tvimdesign.study.design import read_design, write_design


@pytest.fixture
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder of temporary files for this test alone."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


class NoProcess:
    """Stands in for the process that makes the parts: notes what it is asked for."""

    process = os.getpid()
    design: Path

    def __init__(self, **_: object) -> None:
        pass

    def __enter__(self) -> NoProcess:
        return self

    def __exit__(self, *raised: object) -> None:
        pass

    def begin(self, design: Path, _: Path) -> None:
        NoProcess.design = design


def test_the_design_of_parts_under_way_is_no_temporary_folder(tmp_path, temporary, monkeypatch):
    monkeypatch.setattr("tvimdesign.cad.make.PartsProcess", NoProcess)
    monkeypatch.setattr(parts_of_design, "set_low_priority", lambda *_: None)
    out = tmp_path / "out/cad"
    with parts_of_design.BackgroundPartsJob() as parts:
        parts.begin(whole(design_of("paper", {})), out)
        assert list(out.iterdir()) == [NoProcess.design]
        assert read_design(NoProcess.design).mode == "shear"
        assert list(temporary.iterdir()) == []
    assert list(out.iterdir()) == []


def test_what_is_verified_stands_beside_the_results_while_it_is_solved(tmp_path, temporary, monkeypatch):
    seen: list[Path] = []

    def solve(_names: Any, parts: Path, work: Path, *_: Any) -> None:
        seen.append(work)
        assert parts.is_relative_to(work)
        assert list(temporary.iterdir()) == []
        raise SimulationError("the mesh has no end")

    monkeypatch.setattr(verify_design, "require_fe", lambda _: None)
    monkeypatch.setattr(verify_design, "_export", lambda *_: None)
    monkeypatch.setattr(verify_design, "run_solvers", solve)
    out = tmp_path / "out"
    design = write_design(whole(design_of("paper", {})), tmp_path / "design.json")
    with pytest.raises(SimulationError, match="the mesh has no end"):
        verify_design.verify_design(design, out, "", overwrite=True, as_json=False)
    assert seen[0].parent == out / UNFINISHED
    assert [path.name for path in out.iterdir()] == ["manifest.json"]
