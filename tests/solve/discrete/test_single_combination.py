"""When it is certain that a combination has no design: no warm run that is cut short and no bad begin leave it open."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tvimdesign.solve.discrete.discrete_choices import Box, discrete_sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.infeasibility.feasibility_screen import NOWHERE
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.statuses import NO_DESIGN, NO_MODULE
from tvimdesign.study import read_study_text

STUDY = """
mode: shear
vary: {coil_count: {from: 3, to: 5, step: 1}, current: [0.5 A, 2.5 A]}
minimize: module_mass
solver: {cells: 6, starts: 1}
"""
OVER = "Maximum_Iterations_Exceeded"


@pytest.fixture(scope="module")
def tree() -> tuple[Relaxation, Run]:
    study = read_study_text(STUDY, "test")
    relaxation = Relaxation(0, Optimizer(study), {}, discrete_sizes(study, study.table), SolverEffort())
    return relaxation, relaxation.optimizer.solve()


@pytest.mark.parametrize(
    ("cold", "box", "certain", "searches"),
    [(NO_DESIGN, ((1, 1),), True, 2), (OVER, ((1, 1),), False, 2), (NO_DESIGN, ((0, 1),), False, 1)],
)  # fmt: skip
def test_a_warm_run_cut_short_leaves_several_combinations_open(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch,
    cold: str, box: Box, certain: bool, searches: int,
) -> None:  # fmt: skip
    """Several are searched from one place alone: their halves are asked the same."""
    relaxation, near = tree
    asked: list[str] = []

    def ending(status: str) -> Callable[..., Any]:
        def ended(*_: Any) -> Run:
            asked.append(status)
            return replace(near, start=replace(near.start, status=status, converged=False))

        return ended

    monkeypatch.setattr(relaxation, "_screened", lambda *_: False)
    monkeypatch.setattr(relaxation, "_beside", ending(OVER))
    monkeypatch.setattr(relaxation, "_searched", ending(cold))
    assert relaxation.best_within(box, near) == (None, certain)
    assert asked == [OVER] + [cold] * searches


def test_no_search_starts_without_a_module_if_another_place_has_one(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    relaxation, near = tree
    here, nowhere = relaxation.optimizer.model.start, near.inputs * 1.5
    monkeypatch.setattr(relaxation._screen, "broken", lambda inputs: np.inf if inputs is nowhere else 0.0)
    assert relaxation._modules([nowhere, here]) == [here]
    assert relaxation._modules([nowhere]) == [nowhere]


def beginning_nowhere(relaxation: Relaxation, monkeypatch: pytest.MonkeyPatch, near: Run) -> list[str]:
    """Let the first run within a box begin at no module; the endings of all runs."""
    solved, endings = relaxation._solved, list[str]()

    def first_fails(*known: Any, **words: Any) -> Run:
        run = solved(*known, **words)
        if not endings:
            run = replace(near, start=replace(near.start, status=NO_MODULE, converged=False))
        endings.append(run.start.status)
        return run

    monkeypatch.setattr(relaxation, "_screened", lambda *_: False)
    monkeypatch.setattr(relaxation, "_solved", first_fails)
    return endings


def test_if_no_run_can_start_differential_evolution_finds_a_module(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Legs that do not reach their pins, say: the run nearby with another size in it is no module."""
    relaxation, near = tree
    endings = beginning_nowhere(relaxation, monkeypatch, near)
    found, certain = relaxation.best_within(((1, 1),), None)
    assert certain
    assert found is not None
    assert found.start.converged
    assert found.start.end["coil_count"] == pytest.approx(4.0)
    assert len(endings) == 2


def test_no_module_by_differential_evolution_is_certainly_no_design(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    relaxation, near = tree
    endings = beginning_nowhere(relaxation, monkeypatch, near)
    monkeypatch.setattr(relaxation._screen, "worst", lambda unknowns: np.full(unknowns.shape[1], NOWHERE))
    assert relaxation.best_within(((1, 1),), None) == (None, True)
    assert endings == [NO_MODULE]
