"""A search that knows a design within all limits and no optimum tells that design, and does not say there is none."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tvimdesign.report.run.infeasible_report import complaint
from tvimdesign.solve import search
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.solver_run import Array, Run
from tvimdesign.solve.optimizer.statuses import FEASIBLE
from tvimdesign.solve.result import answer
from tvimdesign.study import read_study_text

STUDY = """
mode: shear
vary: {current: {from: 0.8 A, to: 2.5 A, start: 1.5 A}}
require: {peak_power: "<= 60 W"}
minimize: {response_time: 1}
solver: {cells: 6, starts: 2}
"""


@pytest.mark.parametrize("first", [True, False])
def test_a_feasible_design_is_reported_before_a_better_infeasible_one(
    monkeypatch: pytest.MonkeyPatch, first: bool
) -> None:
    study = read_study_text(STUDY, "test")
    made: list[Run] = []

    def failing(self: Relaxation, begin: Array) -> Run:
        run = self.optimizer.solve(begin=begin)
        kept = first is not bool(made)
        status, objective = (FEASIBLE, run.start.objective) if kept else ("Maximum_Iterations_Exceeded", 0.0)
        inputs = run.inputs.copy()
        if not kept:
            inputs[self.optimizer.model.index["current"]] = 2.5
        run = replace(run, inputs=inputs)
        run.start = replace(run.start, status=status, objective=objective, converged=False)
        made.append(run)
        return run

    monkeypatch.setattr(Relaxation, "_from_one_of_each", failing)
    monkeypatch.setattr(Relaxation, "from_all_over", lambda _: [])
    monkeypatch.setattr(search, "find_conflicts", lambda *_: None)
    found = answer(study)
    assert len(made) == 2
    assert not found.found
    assert found.solution is not None
    assert found.solution.feasible
    assert complaint(found, study.table).startswith(
        "test: no design known to be the best one (not converged: a feasible design"
    )
