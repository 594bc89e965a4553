"""Extras: a missing one is named, and the other work is done."""

import json
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from support import Command, study_path

from tvimdesign.base import environment
from tvimdesign.base.errors import InputError
from tvimdesign.cad import make_cad


@pytest.fixture
def without_cad(monkeypatch: pytest.MonkeyPatch) -> None:
    def found(name: str) -> Any:
        return None if name == "cadquery" else find_spec(name)

    monkeypatch.setattr(environment, "find_spec", found)


@pytest.mark.slow
@pytest.mark.usefixtures("without_cad")
def test_a_run_without_cad_says_so_and_does_the_rest(tvimdesign: Command, tmp_path: Path) -> None:
    study = study_path("paper_reconstructed")
    done = tvimdesign("run", study, "--no-plots", "--out", tmp_path / "run")
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("No parts: cadquery is not installed: pip install 'tvimdesign[cad]'") == 1
    assert (tmp_path / "run/report.html").exists()
    assert not (tmp_path / "run/cad").exists()
    reported = json.loads(tvimdesign("run", study, "--no-plots", "--json", "--out", tmp_path / "json").stdout)
    assert reported["not_done"] == ["parts: cadquery is not installed: pip install 'tvimdesign[cad]'"]
    refused = tvimdesign("cad", tmp_path / "run/design.json", "--out", tmp_path / "parts")
    assert refused.returncode == InputError.exit_code
    assert "pip install 'tvimdesign[cad]'" in refused.stderr


@pytest.mark.usefixtures("without_cad")
def test_parts_without_cad_are_refused_by_the_name_of_the_extra(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"parts: cadquery is not installed: pip install 'tvimdesign\[cad\]'"):
        make_cad(tmp_path / "design.json", tmp_path)


def test_what_is_there_is_not_missed() -> None:
    assert [environment.how_to_install(extra) for extra in environment.MODULES] == [""]
