"""Designs that were optimal with the states of every cycle as unknowns are so, or nearly so, to the problem of now."""

import json
from typing import Any

import numpy as np
import pytest
from support import ROOT

from tvimdesign.solve.infeasibility.inspection import row_names
from tvimdesign.solve.nlp.problem_parts import Objective
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import read_study

NUMBERS_ALONE = ["paper_shear", "elbow_printed", "machined_shear", "wrist_joint"]
"""Shipped studies that choose no record and drive no phase, of those whose optima were frozen under today's rules."""


def _frozen(name: str) -> tuple[Optimizer, np.ndarray, dict[str, Any]]:
    """Return a study's problem, and the inputs and the optimum that are frozen."""
    frozen = json.loads((ROOT / "campaigns/frozen/studies" / f"{name}.json").read_text(encoding="utf-8"))
    optimizer = Optimizer(read_study(ROOT / "studies" / f"{name}.yaml"), frozen["optimum"]["reference"])
    inputs = optimizer.model.start.copy()
    for one, value in frozen["chosen"].items():
        inputs[optimizer.model.index[one]] = value
    return optimizer, inputs, frozen["optimum"]


def test_a_frozen_optimum_is_found_from_beside_it() -> None:
    optimizer, inputs, optimum = _frozen("paper_shear")
    run = optimizer.solve(begin=inputs, beginning="near")
    assert run.start.converged
    assert run.start.objective == pytest.approx(optimum["objective"], rel=1e-4)
    for free in optimizer.free:
        place = optimizer.model.index[free.name]
        assert run.inputs[place] == pytest.approx(inputs[place], rel=2e-3), free.name


@pytest.mark.gate
@pytest.mark.parametrize("name", NUMBERS_ALONE)
def test_a_frozen_design_keeps_its_limits_and_its_objective(name: str) -> None:
    """With margins, too: what is not within its limits by them is so without."""
    optimizer, inputs, optimum = _frozen(name)
    x, parameters = optimizer.guess(inputs), optimizer.parameters(Objective(optimizer.study.minimize))
    optimizer.problem.place_grids(x, parameters)
    point = optimizer.problem.at(x, parameters)
    assert point.objective == pytest.approx(optimum["objective"], rel=1e-3)
    worst = int(np.argmax(point.rows))
    assert point.rows[worst] < 1e-3, row_names(optimizer.problem)[worst]
