"""Interrupted searches: the study is started at the best design so far."""

import json
import os
import signal
from pathlib import Path

import pytest
from explored import SMALL

from tvimdesign.base.interrupts import interrupt_handler
from tvimdesign.report.run.run_study import run_study
from tvimdesign.solve.best_so_far import SearchInterrupted
from tvimdesign.solve.result import answer
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, drawn, given, read_study, read_study_text
from tvimdesign.study.written_studies import study_text

TWO_STARTS = SMALL.replace("starts: 1", "starts: 2")
LISTED = SMALL.replace("pcl_thickness: [0.6", "pcl_thickness: {choose: [0.6").replace("2 mm]", "1 mm, 2 mm]}")


def _interrupted(study: Study, at: str) -> Study | None:
    """Return the best design so far where an interrupt comes at a certain word of the search."""

    def progress(text: str) -> None:
        if at in text:
            os.kill(os.getpid(), signal.SIGTERM)

    with interrupt_handler(), pytest.raises(SearchInterrupted) as interrupted:
        optimize(study, progress)
    return interrupted.value.best


@pytest.mark.parametrize("text", [TWO_STARTS, LISTED])
def test_the_study_begins_at_a_design_that_keeps_all_limits(text: str, tmp_path: Path) -> None:
    best = _interrupted(read_study_text(text), "so far")
    (tmp_path / "best.yaml").write_text(study_text(best, "the best", tmp_path))
    read = read_study(tmp_path / "best.yaml")
    assert read.vary.keys() == best.vary.keys()
    names = list(best.vary)
    assert [given(read)[name] for name in names] == [given(best)[name] for name in names]
    found, begun = (answer(drawn(study)) for study in (read, read_study_text(text)))
    assert found.feasible
    assert found.design.values["response_time"] < 0.9 * begun.design.values["response_time"]


def test_before_the_first_design_there_is_none() -> None:
    assert _interrupted(read_study_text(TWO_STARTS), "start 1 of 2") is None


def test_an_interrupted_run_keeps_it_and_says_where(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path, out = tmp_path / "study.yaml", tmp_path / "out"
    path.write_text(TWO_STARTS)
    best = read_study_text(TWO_STARTS)

    def interrupted(*_: object, **__: object) -> None:
        try:
            os.kill(os.getpid(), signal.SIGTERM)
        except KeyboardInterrupt as interrupt:
            raise SearchInterrupted(best) from interrupt

    monkeypatch.setattr("tvimdesign.report.run.answered_study.answer", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run_study(path, out, overwrite=False, cad=False, plots=False, as_json=False)
    assert f"the best design so far is where {out / 'best_so_far.yaml'} begins\n" in capsys.readouterr().err
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["status"] == "interrupted"
    assert list(manifest["files"]) == ["best_so_far.yaml"]
    assert given(read_study(out / "best_so_far.yaml")) == given(best)


@pytest.mark.gate
def test_a_design_that_is_found_is_kept_until_it_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, out = tmp_path / "study.yaml", tmp_path / "out"
    path.write_text(SMALL)

    def interrupted(*_: object) -> None:
        os.kill(os.getpid(), signal.SIGTERM)

    monkeypatch.setattr("tvimdesign.report.run.run_page.write_answer", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run_study(path, out, overwrite=False, cad=False, plots=False, as_json=False)
    assert answer(drawn(read_study(out / "best_so_far.yaml"))).feasible
