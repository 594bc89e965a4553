"""No optimum has a switch that ends beyond what is simulated, though nothing that is asked limits its time."""

from typing import Any

import pytest

from tvimdesign.base.deadline import Deadline
from tvimdesign.solve import search
from tvimdesign.solve.discrete.discrete_choices import discrete_sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.problem import LATEST
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import NO_MODULE, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.search import optimize
from tvimdesign.study import read_study_text

HORIZON = 3600.0
STUDY = """
mode: shear
vary: {current: [0.1 A, 3 A]}
minimize: peak_power
solver: {cells: 6, starts: 1}
"""


def test_a_switch_that_nothing_limits_ends_within_the_horizon() -> None:
    # The least peak of power heats as slowly as it may: the layer barely gets as hot as it must.
    found = optimize(read_study_text(STUDY, "test"))
    assert found.status == "optimal"
    assert found.values["response_time"] == pytest.approx(LATEST * HORIZON, rel=2e-3)
    holds = [limit for limit in found.held if limit.output == "response_time"]
    assert holds[0].residual == pytest.approx(0.0, abs=2e-3)
    assert holds[0].shadow_price > 0.0


LISTED = STUDY.replace("}\nmin", ", pcl_thickness: {from: 0.8 mm, to: 1.2 mm, step: 0.4 mm}}\nmin")


@pytest.mark.gate
def test_a_search_beyond_the_horizon_restarts_before_it_searches_lists(monkeypatch: pytest.MonkeyPatch) -> None:
    # A random study (20264018) was through its 60 s with the lists of a switch that never ends.
    deadlines: list[Deadline] = []
    monkeypatch.setattr(search, "Deadline", lambda seconds: deadlines.append(Deadline(seconds)) or deadlines[-1])
    said: list[str] = []
    found = optimize(read_study_text(LISTED, "test"), said.append)
    assert found.status == "optimal"
    assert found.values["response_time"] <= LATEST * HORIZON * (1.0 + 2e-3)
    again = next(place for place, words in enumerate(said) if "beyond `horizon`" in words)
    assert not any(" solved" in words for words in said[:again])
    assert any(" solved" in words for words in said[again:])
    assert len(deadlines) == 1  # the study's time limit is that of both


def test_boxes_that_lead_beyond_the_horizon_are_not_gone_on_with(monkeypatch: pytest.MonkeyPatch) -> None:
    # The search ends with the first box whose best design is beyond it: far beyond, IPOPT takes longest (20266007).
    study = read_study_text(STUDY, "test")
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


def test_a_search_that_begins_where_the_switch_never_ends_begins_beside() -> None:
    """At 0.9 A the layer stays stiff; without derivatives there IPOPT would not even begin."""
    optimizer = Optimizer(read_study_text(STUDY + "require: {response_time: <= 300 s}\n", "test"))
    weak = optimizer.model.start.copy()
    weak[optimizer.model.index["current"]] = 0.9
    assert optimizer.multistart.trial(weak) is None
    run, usual = optimizer.solve(begin=weak), optimizer.solve()
    assert run.start.converged
    assert run.start.objective == pytest.approx(usual.start.objective, rel=1e-4)
    nowhere = optimizer.solve({"current": (0.1, 0.9)}, begin=weak)
    assert not nowhere.start.converged
    assert nowhere.start.status == NO_MODULE
