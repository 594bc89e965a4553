"""Ends of runs: every status of IPOPT has words, an interrupt ends a search, and a flat goal has no optimum."""

import os
import re
import signal
import threading
from contextlib import suppress
from pathlib import Path

import casadi
import pytest
from explored import SMALL
from support import Command

from tvimdesign.base.interrupts import interrupt_came, interrupt_handler
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.solve.infeasibility.feasibility_screen import FeasibilityScreen
from tvimdesign.solve.nlp.solver_run import MEANINGS, meaning
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import read_study_text


@pytest.fixture(scope="module")
def optimizer() -> Optimizer:
    """Return a small problem, its solver built."""
    built = Optimizer(read_study_text(SMALL))
    built.solve()
    return built


def _swallowed() -> None:
    with suppress(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGTERM)


def _solve_until_interrupted(optimizer: Optimizer, signaling: threading.Timer) -> None:
    signaling.start()
    while not interrupt_came():
        optimizer.solve()


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_no_run_of_the_solver_comes_back_after_an_interrupt(optimizer: Optimizer, share: float) -> None:
    before = optimizer.seconds["solve"]
    optimizer.solve()
    seconds = optimizer.seconds["solve"] - before
    signaling = threading.Timer(share * seconds, os.kill, (os.getpid(), signal.SIGTERM))
    with interrupt_handler(), pytest.raises(KeyboardInterrupt):
        _solve_until_interrupted(optimizer, signaling)


def test_nothing_is_begun_after_an_interrupt_that_was_swallowed(optimizer: Optimizer) -> None:
    study = optimizer.study
    simulator = Simulator(resolve_study(study).functions)
    screen = FeasibilityScreen(optimizer)
    with interrupt_handler():
        _swallowed()
        with pytest.raises(KeyboardInterrupt):
            optimizer.solve()
        with pytest.raises(KeyboardInterrupt):
            simulator.run(simulator.model.start)
        with pytest.raises(KeyboardInterrupt):
            screen.impossible({}, [optimizer.model.start])


def _statuses() -> set[str]:
    """Return the statuses in CasADi's interface to IPOPT, read off the library itself."""
    found = sorted(Path(casadi.__file__).parent.glob("*casadi_nlpsol_ipopt*"))
    assert found, "CasADi keeps its interface to IPOPT elsewhere: look there"
    words = re.findall(rb"\0([A-Z][A-Za-z]+(?:_[A-Za-z]+)+)(?=\0)", found[0].read_bytes())
    return {word.decode() for word in words if not word.decode().isupper()}


def test_every_status_of_ipopt_has_words_and_most_a_next_step() -> None:
    statuses = _statuses()
    assert {"Solve_Succeeded", "Infeasible_Problem_Detected", "Restoration_Failed"} <= statuses
    assert statuses <= set(MEANINGS)
    for status, found in MEANINGS.items():
        assert found.words
        assert "_" not in found.words
        assert found.step or status == "Solve_Succeeded"
    assert "phase of the moon" in meaning("Phase_Of_The_Moon").words


STUDY = """
tvimdesign: 1
mode: shear
vary: {pcl_thickness: [0.8 mm, 2 mm]}
require: {module_mass: "<= 2 kg"}
minimize: GOAL
solver: {cells: 6, starts: 2}
"""


@pytest.mark.gate
def test_a_search_for_nothing_is_no_optimum(tvimdesign: Command, tmp_path: Path) -> None:
    (tmp_path / "flat.yaml").write_text(STUDY.replace("GOAL", "leg_length"))
    done = tvimdesign("run", "flat.yaml", "--no-cad", "--no-plots", "--out", "out", cwd=tmp_path)
    assert done.returncode == 3
    assert "No optimum: nothing under `vary` moves what is minimised" in done.stdout
    assert "nothing under `vary` moves the goal, leg_length" in " ".join(done.stderr.split())
