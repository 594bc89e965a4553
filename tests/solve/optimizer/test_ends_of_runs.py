"""Ends of runs, and designs within the horizon."""

import os
import signal
import threading
from contextlib import suppress
from typing import Any

import pytest
from explored import SMALL
from support import sample_text

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.interrupts import interrupt_came, interrupt_handler
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.solve import search
from tvimdesign.solve.discrete.discrete_choices import discrete_sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.infeasibility.feasibility_screen import FeasibilityScreen
from tvimdesign.solve.nlp.problem import LATEST
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import (
    FEASIBLE,
    ITERATIONS_OVER,
    MEANINGS,
    NO_DESIGN,
    NO_MODULE,
    NO_STEP,
    SOLVED,
    TIME_OVER,
    Run,
    meaning,
)
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.search import optimize
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
    raise AssertionError("a run of the solver came back after the interrupt")


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_no_run_of_the_solver_comes_back_after_an_interrupt(optimizer, share):
    before = optimizer.seconds["solve"]
    optimizer.solve()
    seconds = optimizer.seconds["solve"] - before
    signaling = threading.Timer(share * seconds, os.kill, (os.getpid(), signal.SIGTERM))
    # The handler may raise again as it is left, which must not end the tests.
    with pytest.raises(KeyboardInterrupt), interrupt_handler():
        _solve_until_interrupted(optimizer, signaling)


def test_nothing_is_started_after_an_interrupt_that_was_swallowed(optimizer):
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


def test_every_status_has_words_and_most_a_next_step():
    statuses = {SOLVED, NO_DESIGN, NO_MODULE, NO_STEP, FEASIBLE, TIME_OVER, ITERATIONS_OVER}
    assert statuses == set(MEANINGS)
    for status, entry in MEANINGS.items():
        assert entry.words
        assert "_" not in entry.words
        assert entry.step or status == SOLVED
    assert "phase of the moon" in meaning("Phase_Of_The_Moon").words


STUDY = sample_text("ended_run")


@pytest.mark.gate
def test_a_search_for_nothing_is_no_optimum(tvimdesign, tmp_path):
    (tmp_path / "flat.yaml").write_text(STUDY.replace("GOAL", "leg_length"))
    done = tvimdesign("run", "flat.yaml", "--no-cad", "--no-plots", "--out", "out", cwd=tmp_path)
    assert done.returncode == 3
    assert "No optimum: nothing under `vary` moves what is minimised" in done.stdout
    assert "nothing under `vary` moves the goal, leg_length" in " ".join(done.stderr.split())


HORIZON = 3600.0
LATE = sample_text("late_event")


@pytest.mark.gate
def test_a_switch_that_nothing_limits_ends_within_the_horizon():
    # The least peak of power heats as slowly as it may: the layer barely gets as hot as it must.
    solution = optimize(read_study_text(LATE, "test"))
    assert solution.status == "optimal"
    assert solution.values["response_time"] == pytest.approx(LATEST * HORIZON, rel=2e-3)
    holds = [limit for limit in solution.held if limit.output == "response_time"]
    assert holds[0].residual == pytest.approx(0.0, abs=2e-3)
    assert holds[0].shadow_price > 0.0


LISTED = LATE.replace("}\nmin", ", pcl_thickness: {from: 0.8 mm, to: 1.2 mm, step: 0.4 mm}}\nmin")


@pytest.mark.gate
def test_a_search_beyond_the_horizon_restarts_before_it_searches_lists(monkeypatch):
    # A random study (20264018) was through its 60 s with the lists of a switch that never ends.
    deadlines: list[Deadline] = []
    monkeypatch.setattr(search, "Deadline", lambda seconds: deadlines.append(Deadline(seconds)) or deadlines[-1])
    messages: list[str] = []
    solution = optimize(read_study_text(LISTED, "test"), messages.append)
    assert solution.status == "optimal"
    assert solution.values["response_time"] <= LATEST * HORIZON * (1.0 + 2e-3)
    again = next(place for place, words in enumerate(messages) if "beyond `horizon`" in words)
    assert not any(" solved" in words for words in messages[:again])
    assert any(" solved" in words for words in messages[again:])
    assert len(deadlines) == 1  # the study's time limit is that of both


def test_boxes_that_lead_beyond_the_horizon_are_not_gone_on_with(monkeypatch):
    # The search ends with the first box whose best design is beyond it: far beyond, IPOPT takes longest (20266007).
    study = read_study_text(LATE, "test")
    relaxation = Relaxation(0, Optimizer(study), {}, discrete_sizes(study, study.table), SolverEffort())
    ends: list[float] = []
    solve = Optimizer.solve

    def noted(self: Optimizer, *known: Any, **words: Any) -> Run:
        run = solve(self, *known, **words)
        ends.append(max(run.ends.values()))
        return run

    monkeypatch.setattr(Optimizer, "solve", noted)
    runs = relaxation.from_all_over()
    assert [run.start.converged for run in runs] == [True]
    assert all(end < 0.999 * LATEST * HORIZON for end in ends[:-1])
    assert ends[-1] == pytest.approx(LATEST * HORIZON, rel=1e-5)


def test_a_search_that_begins_where_the_switch_never_ends_begins_beside():
    """At 0.9 A the layer stays stiff; without derivatives there IPOPT would not even begin."""
    optimizer = Optimizer(read_study_text(LATE + "require: {response_time: <= 300 s}\n", "test"))
    weak = optimizer.model.start.copy()
    weak[optimizer.model.index["current"]] = 0.9
    assert optimizer.multistart.trial(weak) is None
    run, usual = optimizer.solve(begin=weak), optimizer.solve()
    assert run.start.converged
    assert run.start.objective == pytest.approx(usual.start.objective, rel=1e-4)
    nowhere = optimizer.solve({"current": (0.1, 0.9)}, begin=weak)
    assert not nowhere.start.converged
    assert nowhere.start.status == NO_MODULE
