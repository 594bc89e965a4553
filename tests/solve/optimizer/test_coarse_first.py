"""The search with few elements of time first: it ends where the search with all of them does, in fewer of theirs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support import ROOT

from tvimdesign.solve.nlp.coarse_to_fine import at_points, on_finer_grid
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.nlp.transcription import ORDER, moments
from tvimdesign.solve.optimizer.coarse_first import LOWEST, all_refined, coarse_of, first_optimum, refined, search_from
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Study, read_study, read_study_text

SAME = 2e-6
"""Share of the objective that IPOPT's tolerance leaves open."""
SHEAR = """
mode: shear
module: {cold_side: sink}
vary:
  wire_diameter: [1.5 mm, 3 mm]
  pcl_thickness: [0.6 mm, 2 mm]
  current: [0.5 A, 4 A]
require:
  spring_stiffness: ">= 2 N.m/rad"
  peak_power: "<= 60 W"
minimize: {module_mass: 1, response_time: 1, switch_energy: 1}
solver: {starts: 1, cells: 6}
"""
FREEZING = SHEAR.replace("switch_energy", "return_time")
COMPRESSION = (ROOT / "studies/compare_compression.yaml").read_text().split("solver:")[0]


@pytest.fixture(scope="module")
def optimizer() -> Optimizer:
    return Optimizer(read_study_text(SHEAR))


@pytest.mark.parametrize(("few", "many"), [(1, 3), (1, 2), (2, 3), (3, 9)])
@pytest.mark.parametrize("order", [2, 5])
def test_states_that_are_polynomials_are_the_same_at_finer_points(few: int, many: int, order: int) -> None:
    def course(times: np.ndarray) -> np.ndarray:
        return np.vstack([1.0 - times**order, 3.0 * times**2 + times, np.ones_like(times)])

    coarse, finer = course(np.append(0.0, moments(few, 1.0, order=order))), course(moments(many, 1.0))
    np.testing.assert_allclose(at_points(coarse, many, order), finer, rtol=1e-12, atol=1e-12)


def test_what_kinks_between_elements_stays_within_its_element() -> None:
    coarse = np.abs(np.append(0.0, moments(2, 1.0)) - 0.5)[None]
    np.testing.assert_allclose(at_points(coarse, 6)[0], np.abs(moments(6, 1.0) - 0.5), atol=1e-12)


def _plain(text: str) -> Study:
    study = read_study_text(text)
    return study.model_copy(update={"robust": None, "solver": study.solver.model_copy(update={"cells": 6})})


@pytest.mark.gate
@pytest.mark.parametrize("text", [SHEAR, FREEZING, COMPRESSION])
def test_it_ends_where_the_search_with_all_elements_does(text: str) -> None:
    optimizer = Optimizer(_plain(text))
    coarse = coarse_of(optimizer)
    assert coarse is not None
    assert coarse.problem.unknown_count < 0.6 * optimizer.problem.unknown_count
    alone, found = optimizer.solve(), search_from(optimizer, optimizer.model.start)
    assert alone.start.converged
    assert found.start.converged
    assert found.start.objective == pytest.approx(alone.start.objective, rel=SAME)
    assert len(found.unknowns) == optimizer.problem.unknown_count


def test_the_finer_problem_begins_nearly_solved(optimizer: Optimizer) -> None:
    coarse = coarse_of(optimizer)
    assert coarse is not None
    run = coarse.solve()
    unknowns = on_finer_grid(run.unknowns, coarse.problem, optimizer.problem, run.inputs)
    fine = refined(optimizer, coarse, run)
    places = slice(len(optimizer.free), optimizer.problem.blocks[0].states.numel())
    assert np.abs(unknowns - fine.unknowns)[places].max() < 2.0  # K of some 60
    assert fine.start.iterations - run.start.iterations <= 20
    assert fine.start.seconds > run.start.seconds


def test_a_start_without_a_coarse_optimum_is_searched_with_all_elements(optimizer: Optimizer) -> None:
    coarse = coarse_of(optimizer)
    assert coarse is not None
    asked: list[Optimizer] = []

    def solve(one: Optimizer) -> Run:
        asked.append(one)
        run = one.solve()
        run.start = run.start.__class__(**{**vars(run.start), "converged": one is optimizer})
        return run

    run, grid = first_optimum([coarse, optimizer], solve)
    assert asked == [coarse, optimizer]
    assert grid is optimizer
    assert run.start.iterations > optimizer.solve().start.iterations  # with the work that came to nothing


def test_the_same_optimum_is_refined_once(optimizer: Optimizer, monkeypatch: pytest.MonkeyPatch) -> None:
    coarse = coarse_of(optimizer)
    assert coarse is not None
    run, again = coarse.solve(), coarse.solve()
    again.start = run.start.__class__(**{**vars(again.start), "begin": {"wire_diameter": 1e-3}})
    beginnings: list[str | None] = []
    solve = Optimizer.solve

    def watched(self: Optimizer, *known: Any, **named: Any) -> Run:
        beginnings.append(named.get("beginning"))
        return solve(self, *known, **named)

    monkeypatch.setattr(Optimizer, "solve", watched)
    first, second = all_refined(optimizer, coarse, [run, again])
    assert beginnings == ["refined"]
    assert first.start.begin == run.start.begin
    assert second.start.begin == {"wire_diameter": 1e-3}
    assert second.start.end == first.start.end


def test_pieces_of_a_free_current_have_fewer_points() -> None:
    study = read_study(ROOT / "studies/fast_switch.yaml")
    optimizer = Optimizer(study.model_copy(update={"robust": None}))
    coarse = coarse_of(optimizer)
    assert coarse is not None
    for few, many in zip(coarse.problem.blocks, optimizer.problem.blocks, strict=True):
        assert few.states.shape[1] / LOWEST == many.states.shape[1] / ORDER  # as many elements
    start = optimizer.model.start
    begin, here = optimizer.guess(start), coarse.guess(start)
    unknowns = on_finer_grid(here, coarse.problem, optimizer.problem, start)
    assert len(unknowns) == len(begin)
    states = optimizer.problem.blocks[0].states.numel()
    first = len(optimizer.free)
    assert unknowns[first : first + states] == pytest.approx(begin[first : first + states], abs=8.0)  # K of some 80
    assert unknowns[:first] == pytest.approx(begin[:first])
    assert unknowns[-len(optimizer.problem.peaks) :] == pytest.approx(begin[-len(optimizer.problem.peaks) :])


def test_there_is_none_where_a_steady_state_is_unknown_too() -> None:
    assert coarse_of(Optimizer(read_study_text(SHEAR.replace("switch_energy", "hold_power")))) is None


def test_problems_that_differ_in_records_alone_share_the_coarse_one(optimizer: Optimizer) -> None:
    other = optimizer.with_records(optimizer.study)
    assert other is not None
    one, same = coarse_of(optimizer), coarse_of(other)
    assert one is not None
    assert same is not None
    assert same.problem is one.problem
    assert same.model is other.model
