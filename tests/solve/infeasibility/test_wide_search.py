"""Designs all over the ranges keep what depends on no cycle; limits that no point keeps are found infeasible."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support import ROOT, study_path

from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.infeasibility.feasibility_screen import FeasibilityScreen, _broken, _one_design, designs_all_over
from tvimdesign.solve.nlp.solver_run import Array, Ends, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.search import optimize
from tvimdesign.study import read_study, read_study_text, read_tree
from tvimdesign.study.tree import tree_of_text

ONLY_THE_CYCLE = """
mode: shear
vary: {current: {from: 0.8 A, to: 2.5 A, start: 1.5 A}}
require: {peak_power: "<= 1 W"}
minimize: {response_time: 1}
solver: {cells: 8, starts: 1}
"""
"""Its one free number changes nothing but the working cycle."""


@pytest.mark.gate
def test_designs_from_all_over_keep_the_arithmetic_limits_and_differ() -> None:
    optimizer = Optimizer(read_study(study_path("paper_shear")))
    screen = FeasibilityScreen(optimizer)
    designs = list(designs_all_over(optimizer))
    assert len(designs) == 3
    assert all(screen.broken(inputs) < 0.0 for inputs in designs)
    assert not np.allclose(designs[0], designs[1], rtol=1e-3)
    broken = [_broken(optimizer, inputs) for inputs in designs]
    assert broken == sorted(broken)  # as simulated
    assert np.isfinite(broken[:2]).all()  # the switch of the last may never end
    unknowns = np.array([
        [free.to_unknown(inputs[optimizer.model.index[free.name]]) for inputs in designs] for free in optimizer.free
    ])  # fmt: skip
    together = screen.worst(unknowns)
    assert np.allclose(together, [screen.broken(inputs) for inputs in designs])


def test_where_no_limit_is_of_arithmetic_every_design_keeps_them() -> None:
    study = read_tree(tree_of_text(ONLY_THE_CYCLE, "one.yaml", "one", ROOT))
    optimizer = Optimizer(study)
    screen = FeasibilityScreen(optimizer)
    assert screen.worst(np.zeros((1, 4))).tolist() == [-1.0] * 4
    assert _one_design(optimizer, screen, 1) is not None


@pytest.mark.slow
def test_a_start_that_ends_in_a_valley_is_not_the_last_word(monkeypatch: pytest.MonkeyPatch) -> None:
    # Where no start comes to a design, those from all over do: here every start is made to fail.
    study = read_study(study_path("paper_shear"))
    usual = optimize(study)
    starts = Relaxation._from_one_of_each

    def failing(self: Relaxation, begin: Array) -> Run:
        run = starts(self, begin)
        run.start = replace(run.start, converged=False)
        return run

    monkeypatch.setattr(Relaxation, "_from_one_of_each", failing)
    found = optimize(study)
    assert found.status == "optimal"
    assert found.objective <= usual.objective * (1.0 + 1e-6)


STUDY = """
mode: shear
vary: {coil_count: [3, 5], pcl_thickness: [0.6 mm, 2 mm]}
minimize: module_mass
solver: {cells: 6, starts: 1}
"""


@pytest.fixture(scope="module")
def screen() -> FeasibilityScreen:
    return FeasibilityScreen(Optimizer(read_study_text(STUDY, "test")))


@pytest.mark.parametrize(
    ("sums", "worsts", "impossible", "asked"),
    [([0.1, 0.2, 0.1], [0.1, 0.3], True, 5), ([0.1, 0.0, 0.1], [], False, 2), ([0.1, np.nan, 0.1], [], False, 2),
     ([0.1, 0.2, 0.1], [0.1, 0.0], False, 5), ([0.1, 0.2, 0.1], [np.nan, np.nan], True, 5)],
    ids=["neither finds one", "the sum finds one", "a sum has no least", "a worst finds one", "a worst has no least"],
)  # fmt: skip
def test_limits_are_infeasible_if_neither_measure_finds_a_point(
    screen: FeasibilityScreen, monkeypatch: pytest.MonkeyPatch,
    sums: list[float], worsts: list[float], impossible: bool, asked: int,
) -> None:  # fmt: skip
    begins = [np.full(2, float(place)) for place in range(3)]
    left = {"sum": iter(sums), "worst": iter(worsts)}
    places: list[float] = []

    def least(solver: Any, _within: Mapping[str, Ends], begin: Array) -> float:
        places.append(float(begin[0]))
        return next(left["sum" if solver is screen._sum else "worst"])

    monkeypatch.setattr(screen, "_least", least)
    assert screen.impossible({}, begins) is impossible
    assert places == [0.0, 1.0, 2.0, 0.0, 2.0][:asked]
