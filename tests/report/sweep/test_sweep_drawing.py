"""A sweep that is resumed draws its figure again only where it would be another."""

import json
from pathlib import Path
from typing import Any

import pytest
from small_sweeps import SMALL, plan

from tvimdesign.report.output import command
from tvimdesign.report.sweep.sweep_study import DRAWN_FROM, KeptFigure, kept_figure, sweep_folder
from tvimdesign.sweep.run_sweep import Executor

pytestmark = pytest.mark.slow


def _swept(folder: Path, *, resume: bool) -> None:
    study = folder / "small.yaml"
    study.write_text(SMALL)
    sweep_folder(plan(study), folder / "out", Executor(workers=1), lambda _: None, overwrite=False, resume=resume)


def test_the_figure_of_a_finished_sweep_stays_and_none_stays_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _swept(tmp_path, resume=False)
    out = tmp_path / "out"
    before = {path.name: path.read_bytes() for path in out.glob("sweep.*")}
    assert {"sweep.png", "sweep.json"} <= set(before)

    def none(*_: Any) -> None:
        raise AssertionError("nothing is to be drawn")

    with monkeypatch.context() as patched:
        patched.setattr(command, "PlotProcess", none)
        _swept(tmp_path, resume=True)
    assert {path.name: path.read_bytes() for path in out.glob("sweep.*")} == before
    assert set(json.loads((out / "manifest.json").read_text())["files"]) >= set(before)
    # Of another figure: drawn anew.
    told = json.loads(before["sweep.json"])
    (out / "sweep.json").write_text(json.dumps({**told, DRAWN_FROM: "another"}))
    (out / "sweep.png").write_bytes(b"another")
    _swept(tmp_path, resume=True)
    assert (out / "sweep.png").read_bytes() == before["sweep.png"]
    assert kept_figure(tmp_path) == KeptFigure()
    (tmp_path / "sweep.json").write_text("{}")
    assert kept_figure(tmp_path) == KeptFigure()
