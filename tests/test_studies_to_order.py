"""Studies whose module can be ordered: within every rating, with the yield they ask for, of heaters that are bought."""

from __future__ import annotations

import pytest
from answers import shipped_answer
from support import ROOT

from tvimdesign.study import read_study

TO_ORDER = ("ankle", "elbow_machined", "elbow_printed", "finger")
named = pytest.mark.parametrize("name", TO_ORDER)


@named
def test_a_study_to_order_asks_for_a_yield_of_bought_heaters(name: str) -> None:
    study = read_study(ROOT / f"studies/{name}.yaml")
    assert study.robust is not None
    assert study.robust.share == pytest.approx(0.95)
    assert {"wire_diameter", "coil_diameter", "pcl_thickness", "current"} <= set(study.tolerances)
    assert study.accept == ()
    assert study.module["peltier_module"] != "flexible_1600"  # no maker's table of it could be read


@pytest.mark.slow
@named
def test_its_optimum_is_within_every_rating_and_reaches_the_yield(name: str) -> None:
    found = shipped_answer(name)
    assert found.design.status == "optimal"
    assert found.design.accepting == ()
    assert found.feasible
    assert found.solution is not None
    assert found.solution.yield_reached is not None
    assert found.solution.yield_reached.together >= 0.95
