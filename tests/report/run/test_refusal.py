"""A run ends before its search with what `check` refuses; a later refusal leaves its reason in the folder."""

import json
import os
import signal
from contextlib import suppress
from pathlib import Path

import jsonschema
import pytest

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.report.output.results_format import results_schema
from tvimdesign.report.run import answered_study
from tvimdesign.report.run import run_study as module
from tvimdesign.report.run.check_study import check_study

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
