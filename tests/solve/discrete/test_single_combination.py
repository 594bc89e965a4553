"""When it is certain that a combination has no design: a warm run that is cut short does not leave it open."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from tvimdesign.solve.discrete.discrete_choices import Box, discrete_sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.statuses import NO_DESIGN
from tvimdesign.study import read_study_text

STUDY = """
mode: shear
vary: {coil_count: [3, 4, 5], current: [0.5 A, 2.5 A]}
minimize: module_mass
solver: {cells: 6, starts: 1}
"""
OVER = "Maximum_Iterations_Exceeded"


@pytest.fixture(scope="module")
def tree() -> tuple[Relaxation, Run]:
    study = read_study_text(STUDY.replace("[3, 4, 5]", "{from: 3, to: 5, step: 1}"), "test")
    relaxation = Relaxation(0, Optimizer(study), {}, discrete_sizes(study, study.table), SolverEffort())
    return relaxation, relaxation.optimizer.solve()


@pytest.mark.parametrize(
    ("cold", "box", "certain"),
    [(NO_DESIGN, ((1, 1),), True), (NO_DESIGN, ((0, 1),), False), (OVER, ((1, 1),), False)],
)
def test_a_warm_run_that_is_cut_short_leaves_several_combinations_open_and_not_one(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch, cold: str, box: Box, certain: bool
) -> None:
    relaxation, near = tree

    def ending(status: str) -> Callable[..., Any]:
        return lambda *_, **__: replace(near, start=replace(near.start, status=status, converged=False))

    monkeypatch.setattr(relaxation, "_screened", lambda *_: False)
    monkeypatch.setattr(relaxation, "_beside", ending(OVER))
    monkeypatch.setattr(relaxation, "_solved", ending(cold))
    assert relaxation.best_within(box, near) == (None, certain)
