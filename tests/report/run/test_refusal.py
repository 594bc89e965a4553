"""A run ends before its search with what `check` refuses; parts and figures give way to the search."""

import json
import os
import signal
from contextlib import suppress
from pathlib import Path

import jsonschema
import psutil
import pytest
from support import wait_until

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.report.output.plot_process import PlotProcess
from tvimdesign.report.output.results_format import results_schema
from tvimdesign.report.run import answered_study
from tvimdesign.report.run import run_study as module
from tvimdesign.report.run.check_study import check_study
from tvimdesign.report.run.parts_of_design import BackgroundPartsJob

STUDY = """mode: shear
vary: {wire_diameter: [1.2 mm, 3.2 mm], coil_diameter: [8 mm, 32 mm]}
require: {envelope_diameter: "<= 120 mm"}
minimize: module_mass
solver: {starts: 30}
"""


def _run(path: Path, out: Path, *, as_json: bool = False) -> None:
    module.run_study(path, out, overwrite=False, cad=False, plots=False, as_json=as_json)


def test_what_check_refuses_ends_a_run_before_its_folder_is_touched(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answered_study, "answer", lambda *_, **__: pytest.fail("it searched"))
    path, out = tmp_path / "impossible.yaml", tmp_path / "out"
    path.write_text(STUDY)
    with pytest.raises(InfeasibleError, match="envelope_diameter <= 120 mm cannot hold") as checked:
        check_study(path, as_json=False)
    with pytest.raises(InfeasibleError) as refused:
        _run(path, out, as_json=True)
    assert (str(refused.value), refused.value.exit_code) == (str(checked.value), 3)
    assert not out.exists()
    said = json.loads(capsys.readouterr().out)
    jsonschema.validate(said, results_schema())
    assert (said["status"], said["reason"]) == ("infeasible", str(checked.value))


def test_a_reason_that_ends_the_run_early_is_left_in_the_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path, out = tmp_path / "study.yaml", tmp_path / "out"
    path.write_text(STUDY.replace("<= 120 mm", "<= 300 mm"))

    def refuse(*_: object, **__: object) -> None:
        raise InfeasibleError("no start keeps it")

    monkeypatch.setattr(answered_study, "answer", refuse)
    with pytest.raises(InfeasibleError):
        _run(path, out, as_json=True)
    reported = json.loads((out / "results.json").read_text())
    jsonschema.validate(reported, results_schema())
    assert (reported["status"], reported["reason"]) == ("infeasible", "no start keeps it")
    assert reported["reason"] in (out / "summary.txt").read_text()
    assert reported["reason"] in (out / "report.html").read_text()
    assert json.loads((out / "study.resolved.json").read_text())["require"][0]["output"] == "envelope_diameter"
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["status"] == "infeasible"
    assert {"results.json", "summary.txt", "study.yaml", "study.resolved.json"} <= manifest["files"].keys()
    assert json.loads(capsys.readouterr().out)["reason"] == "no start keeps it"


def test_a_swallowed_interrupt_is_no_conflict(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, out = tmp_path / "study.yaml", tmp_path / "out"
    path.write_text(STUDY.replace("<= 120 mm", "<= 300 mm"))

    def swallow(*_: object, **__: object) -> None:
        with suppress(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
        raise InfeasibleError("the solver stopped, which looks like a conflict")

    monkeypatch.setattr(answered_study, "answer", swallow)
    with pytest.raises(KeyboardInterrupt):
        _run(path, out)
    assert json.loads((out / "manifest.json").read_text())["status"] == "interrupted"
    assert not (out / "results.json").exists()


def test_parts_and_figures_give_way_only_where_others_wait() -> None:
    with BackgroundPartsJob(), PlotProcess(gives_way=True):
        assert wait_until(lambda: len(_priorities()) == 2)
        behind = _priorities()
    assert psutil.Process().nice() < behind["cad.jobs.main"] < behind["plot_process"]
    with PlotProcess():
        assert wait_until(lambda: bool(_priorities()))
        behind = _priorities()
    assert behind == {"plot_process": psutil.Process().nice()}
    with BackgroundPartsJob(gives_way=False):
        assert wait_until(lambda: bool(_priorities()))
        behind = _priorities()
    assert behind == {"cad.jobs.main": psutil.Process().nice()}


def _priorities() -> dict[str, int]:
    """Return the niceness by name; Linux gives a process its command line once the program is loaded."""
    others = {" ".join(one.cmdline()): one.nice() for one in psutil.Process().children()}
    asked = ("cad.jobs.main", "plot_process")
    return {name: nice for name in asked for command, nice in others.items() if name in command}
