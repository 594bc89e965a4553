"""No optimum has a switch that ends beyond what is simulated, though nothing that is asked limits its time."""

from __future__ import annotations

import numpy as np
import pytest

from tvimdesign.solve import search
from tvimdesign.solve.optimizer.within_horizon import LATEST
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
    """The least peak of power heats as slowly as it may: the layer barely gets as hot as it must."""
    found = optimize(read_study_text(STUDY, "test"))
    assert found.status == "optimal"
    assert found.values["response_time"] == pytest.approx(LATEST * HORIZON, rel=2e-3)
    holds = [limit for limit in found.held if limit.output == "response_time"]
    assert holds[0].residual == pytest.approx(0.0, abs=2e-3)
    assert holds[0].shadow_price > 0.0


def test_a_design_whose_switch_does_not_end_is_not_told_as_optimal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "ending_in_time", lambda *_: None)
    found = optimize(read_study_text(STUDY, "test"))
    assert np.isinf(found.values["response_time"])
    assert found.status == "converged, but the switch does not end within `horizon`"


def test_a_time_that_is_limited_already_is_left_as_it_is() -> None:
    said: list[str] = []
    study = read_study_text(STUDY + "require: {response_time: <= 300 s}\n", "test")
    found = optimize(study, said.append)
    assert found.values["response_time"] == pytest.approx(300.0, rel=2e-3)
    assert not any("horizon" in word for word in said)
