"""What `check` proves impossible `run` proves first, and leaves its reason in the folder."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.report.output.results_format import results_schema
from tvimdesign.report.run import run_study as module
from tvimdesign.solve import result

STUDY = """mode: shear
vary: {wire_diameter: [1.2 mm, 3.2 mm], coil_diameter: [8 mm, 32 mm]}
require: {envelope_diameter: "<= 120 mm"}
minimize: module_mass
"""


def _run(path: Path, out: Path, *, as_json: bool = False) -> None:
    module.run_study(path, out, overwrite=False, cad=False, plots=False, as_json=as_json)


def test_nothing_is_solved_of_what_bounds_prove_impossible(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path, out = tmp_path / "impossible.yaml", tmp_path / "out"
    path.write_text(STUDY)
    monkeypatch.setattr(result, "optimize", lambda *_, **__: pytest.fail("it was solved"))
    with pytest.raises(InfeasibleError, match="envelope_diameter <= 120 mm cannot hold") as refused:
        _run(path, out, as_json=True)
    assert refused.value.exit_code == 3
    reported = json.loads((out / "results.json").read_text())
    jsonschema.validate(reported, results_schema())
    assert (reported["status"], reported["feasible"]) == ("infeasible", False)
    assert "envelope_diameter <= 120 mm cannot hold" in reported["reason"]
    assert reported["reason"] in (out / "summary.txt").read_text()
    assert json.loads((out / "study.resolved.json").read_text())["require"][0]["output"] == "envelope_diameter"
    assert (out / "study.yaml").read_text() == STUDY
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["status"] == "infeasible"
    assert {"results.json", "summary.txt", "study.yaml", "study.resolved.json"} <= manifest["files"].keys()
    said = json.loads(capsys.readouterr().out)
    jsonschema.validate(said, results_schema())
    assert said["folder"] == str(out)


def test_a_reason_found_only_by_the_search_is_left_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, out = tmp_path / "study.yaml", tmp_path / "out"
    path.write_text(STUDY.replace("<= 120 mm", "<= 300 mm"))

    def refuse(*_: object, **__: object) -> None:
        raise InfeasibleError("no start keeps it")

    monkeypatch.setattr(result, "optimize", refuse)
    with pytest.raises(InfeasibleError):
        _run(path, out)
    assert json.loads((out / "results.json").read_text())["reason"] == "no start keeps it"
