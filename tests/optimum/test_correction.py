"""A limit on a time that the optimiser's points in time get wrong is moved until the simulated design keeps it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.solve.account import SWITCH_TOLERANCE
from tvimdesign.solve.correction import corrected
from tvimdesign.solve.optimizer import Optimizer
from tvimdesign.solve.search import optimize
from tvimdesign.solve.solution import Solution
from tvimdesign.study import Study, read_study_text

TABLE = table_for("shear")
COARSE = """
mode: shear
vary:
  pcl_thickness: [0.6 mm, 2 mm]
  current: [0.3 A, 3 A]
require:
  layer_holding_torque: ">= 40 N.m"
  response_time: "<= 100 s"
minimize: peak_power
solver: {starts: 1, elements: 1}
"""


def asked(text: str) -> Study:
    return read_study_text(text, "a test")


def residual(solution: Solution) -> float:
    (held,) = (one for one in solution.held if one.output == "response_time")
    return held.residual


def test_one_element_alone_breaks_a_limit_on_the_response_time() -> None:
    # Without this the next test would say nothing.
    optimizer = Optimizer(asked(COARSE), Catalog(), TABLE)
    run = optimizer.solve()
    simulated = optimizer.simulator.run(run.inputs, stages=["softening"]).values["response_time"]
    assert run.start.converged
    assert abs(simulated - 100.0) > 2.0 * SWITCH_TOLERANCE * 100.0


def test_the_optimum_keeps_the_limit_when_it_is_simulated_and_is_that_of_many_elements() -> None:
    told: list[str] = []
    coarse = optimize(asked(COARSE), Catalog(), TABLE, told.append)
    fine = optimize(asked(COARSE.replace("elements: 1", "elements: 8")), Catalog(), TABLE)
    assert coarse.status == fine.status == "optimal"
    assert abs(residual(coarse)) < SWITCH_TOLERANCE
    assert coarse.objective == pytest.approx(fine.objective, rel=1e-4)
    assert any("moving the limits on times" in words for words in told)


def test_a_limit_that_is_right_or_slack_moves_nothing() -> None:
    for text in (COARSE.replace("elements: 1", "elements: 3"), COARSE.replace("100 s", "1 h")):
        optimizer = Optimizer(asked(text), Catalog(), TABLE)
        run = optimizer.solve()
        assert corrected(optimizer, run, {}) is run
        assert optimizer.margins == {}


def test_a_switch_that_never_ends_moves_nothing() -> None:
    optimizer = Optimizer(asked(COARSE), Catalog(), TABLE)
    run = optimizer.solve()
    weak = replace(run, inputs=run.inputs.copy())
    weak.inputs[optimizer.model.index["current"]] = 0.05
    assert corrected(optimizer, weak, {}) is weak
    assert optimizer.margins == {}


def test_where_no_round_keeps_the_limit_the_first_run_is_what_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    optimizer = Optimizer(asked(COARSE), Catalog(), TABLE)
    run = optimizer.solve()
    monkeypatch.setattr("tvimdesign.solve.correction.ROUNDS", 0)
    assert corrected(optimizer, run, {}) is run
    assert optimizer.margins == {}
