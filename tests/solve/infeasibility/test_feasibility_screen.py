"""Two measures of violated limits, minimised from several places."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from tvimdesign.solve.infeasibility.feasibility_screen import FeasibilityScreen
from tvimdesign.solve.nlp.solver_run import Array, Ends
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import read_study_text

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


def test_both_measures_come_to_the_same_where_one_limit_is_broken() -> None:
    text = STUDY.replace("minimize", "require: {spring_stiffness: '>= 400 N.m/rad'}\nminimize")
    screen = FeasibilityScreen(optimizer := Optimizer(read_study_text(text, "test")))
    begin = optimizer.model.start
    total, worst = (screen._least(solver, {}, begin) for solver in (screen._sum, screen._worst))
    assert screen.impossible({}, [begin])
    assert 0.0 < worst <= total * (1.0 + 1e-6)
