"""Solvers run beside this process: what is missing and what fails is said in words."""

import sys
from pathlib import Path

import pytest

from tvimdesign.base.errors import InputError, SimulationError
from tvimdesign.cad.fe import run_solvers


def python_that(tmp_path: Path, does: str) -> str:
    """Return a stand-in for an interpreter."""
    fake = tmp_path / "python"
    fake.write_text(f"#!{sys.executable}\n{does}\n")
    fake.chmod(0o755)
    return str(fake)


def test_solvers_are_run_on_both_meshes_or_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"tvimdesign\[fe\].*--fe-python"):
        run_solvers.require_fe(python_that(tmp_path, "raise SystemExit(1)"))
    with pytest.raises(InputError, match="there is no such program"):
        run_solvers.require_fe(str(tmp_path / "none"))
    python = python_that(
        tmp_path,
        "import json, sys; from pathlib import Path\n"
        "Path(sys.argv[3]).write_text(json.dumps({'link': float(sys.argv[5]), 'field': float('--field' in sys.argv)}))",
    )
    said: list[str] = []
    found = run_solvers.run_solvers(["link", "joint"], tmp_path, tmp_path, python, said.append)
    assert found["link"].found == {"link": 1.0, "field": 1.0}
    assert found["joint"].coarse == {"link": run_solvers.COARSER, "field": 0.0}
    assert len(said) == 4


@pytest.mark.parametrize("does", ["print('NOT ALL FACES'); import sys", "raise SystemExit('no mesh')"])
def test_a_solver_that_fails_is_named(tmp_path: Path, does: str) -> None:
    with pytest.raises(SimulationError, match=r"verify: link, (fine|coarse) mesh: (no mesh|NOT ALL FACES)"):
        run_solvers.run_solvers(["link"], tmp_path, tmp_path, python_that(tmp_path, does), lambda _: None)
