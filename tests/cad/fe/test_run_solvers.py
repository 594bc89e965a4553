"""Solvers run beside this process: what is missing and what fails is said in words."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from support import ROOT, are_gone

from tvimdesign.base.errors import InputError, SimulationError
from tvimdesign.cad.fe import run_solvers


def python_that(tmp_path: Path, does: str) -> str:
    """Return a stand-in for an interpreter."""
    fake = tmp_path / "python"
    fake.write_text(f"#!{sys.executable}\n{does}\n")
    fake.chmod(0o755)
    return str(fake)


def test_a_python_without_ngsolve_is_refused_with_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"tvimdesign\[fe\].*--fe-python"):
        run_solvers.require_fe(python_that(tmp_path, "raise SystemExit(1)"))
    with pytest.raises(InputError, match="there is no such program"):
        run_solvers.require_fe(str(tmp_path / "none"))


def test_what_each_solver_finds_on_both_meshes_is_given_back(tmp_path: Path) -> None:
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


SOLVES = """
import sys
from pathlib import Path
from tvimdesign.base.interrupts import interrupt_handler
from tvimdesign.cad.fe.run_solvers import run_solvers
folder = Path(sys.argv[1])
with interrupt_handler():
    run_solvers(["link", "joint", "spring"], folder, folder, sys.argv[2], lambda _: None)
"""
AT_WORK = """
import os, sys, time
open(sys.argv[3] + ".part", "w").write(str(os.getpid()))
os.rename(sys.argv[3] + ".part", sys.argv[3] + ".told")
time.sleep(600)
"""


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="Windows has no process groups, by which these end")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_solvers_end_with_a_command_that_is_ended(number: signal.Signals, tmp_path: Path) -> None:
    python = python_that(tmp_path, AT_WORK)
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", SOLVES, str(tmp_path), python]
    with subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL) as parent:
        while len(list(tmp_path.glob("*.told"))) < run_solvers.AT_ONCE and parent.poll() is None:
            time.sleep(0.02)
        solvers = [int(told.read_text()) for told in tmp_path.glob("*.told")]
        parent.send_signal(number)
        assert are_gone([parent.pid])
    assert len(solvers) == run_solvers.AT_ONCE
    assert are_gone(solvers)
