"""A search ends when it is interrupted, though CasADi takes a signal for a function that cannot be evaluated."""

from __future__ import annotations

import os
import signal
import threading
from contextlib import suppress

import pytest
from explored import SMALL

from tvimdesign.base.interrupts import interrupt_came, interrupt_handler
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.infeasibility.feasibility_screen import FeasibilityScreen
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import given, read_study_text


@pytest.fixture(scope="module")
def optimizer() -> Optimizer:
    """Return a small problem, its solver built."""
    built = Optimizer(read_study_text(SMALL))
    built.solve()
    return built


def _swallowed() -> None:
    with suppress(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGTERM)


def _solve_until_interrupted(optimizer: Optimizer) -> None:
    while not interrupt_came():
        optimizer.solve()


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_no_run_of_the_solver_comes_back_after_an_interrupt(optimizer: Optimizer, share: float) -> None:
    before = optimizer.seconds["solve"]
    optimizer.solve()
    seconds = optimizer.seconds["solve"] - before
    signaling = threading.Timer(share * seconds, os.kill, (os.getpid(), signal.SIGTERM))
    with interrupt_handler():
        signaling.start()
        with pytest.raises(KeyboardInterrupt):
            _solve_until_interrupted(optimizer)


def test_nothing_is_begun_after_an_interrupt_that_was_swallowed(optimizer: Optimizer) -> None:
    study = optimizer.study
    simulator = Simulator(DeviceFunctions(study.table, given(study), tuple(study.operating_points), study.solver.cells))
    screen = FeasibilityScreen(optimizer)
    with interrupt_handler():
        _swallowed()
        with pytest.raises(KeyboardInterrupt):
            optimizer.solve()
        with pytest.raises(KeyboardInterrupt):
            simulator.run(simulator.model.start)
        with pytest.raises(KeyboardInterrupt):
            screen.impossible({}, [optimizer.model.start])
