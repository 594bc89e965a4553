"""Every shipped study but the paper's own is a module that somebody can order: read off file and answer."""

from __future__ import annotations

from pathlib import Path

import pytest
from answers import shipped_answer
from support import STUDIES

from tvimdesign.study import Study, read_study
from tvimdesign.study.conditions import Case, refuse_unequal
from tvimdesign.study.sections.tolerances import standard_tolerances
from tvimdesign.study.study import Options

PAPER = ("paper_", "calibrated_")
"""How the names of the paper's own modules begin: they stay as it has them, advice and all."""
ORDERED = [path for path in STUDIES if not path.stem.startswith(PAPER)]
PAIRS = [
    ("compare_shear", "compare_compression"), ("wrist_joint", "wrist_compression"),
    ("machined_shear", "machined_compression"), ("rigid_modules", "rigid_modules_compression"),
]  # fmt: skip
"""Studies of the two modes that are asked the same."""
to_order = pytest.mark.parametrize("path", ORDERED, ids=lambda path: str(path.stem))
STUDY_FOLDER = STUDIES[0].parent


def _of(name: str) -> Study:
    return read_study(STUDY_FOLDER / f"{name}.yaml")


@to_order
def test_a_study_accepts_no_rating_and_requires_a_yield_of_95_percent(path: Path) -> None:
    study = read_study(path)
    assert not study.accept
    assert study.robust is not None
    assert study.robust.share == pytest.approx(0.95)
    assert set(standard_tolerances(study.table)) <= set(study.tolerances), "`standard: true`, and what differs from it"


@to_order
def test_the_heater_can_be_bought_and_the_structure_is_not_petg(path: Path) -> None:
    study = read_study(path)
    free = study.vary.get("peltier_module")
    heaters = free.values if isinstance(free, Options) else [study.module.get("peltier_module", "flexible_1600")]
    assert "flexible_1600" not in heaters, "no maker's table has it"
    assert study.module.get("process", "print_petg") != "print_petg"


@to_order
def test_springs_are_set_one_by_one_where_the_tolerances_say_so(path: Path) -> None:
    study = read_study(path)
    assert study.tolerances["preload_angle"].adjustable == (study.module.get("preload_adjuster") == "rotary")


@pytest.mark.parametrize("names", PAIRS[:2], ids=lambda names: str(names[0]))
def test_both_of_a_pair_with_one_heater_may_be_compared(names: tuple[str, str]) -> None:
    refuse_unequal([Case(STUDY_FOLDER / f"{name}.yaml", _of(name)) for name in names])
    shear, compression = map(_of, names)
    both = (shear.module.keys() & compression.module.keys()) - shear.vary.keys() - compression.vary.keys()
    assert {one: shear.module[one] for one in both} == {one: compression.module[one] for one in both}


@pytest.mark.parametrize("names", PAIRS, ids=lambda names: str(names[0]))
def test_both_modes_of_a_pair_are_asked_the_same(names: tuple[str, str]) -> None:
    shear, compression = map(_of, names)
    only_compression = {row.name for row in compression.table.outputs} - {row.name for row in shear.table.outputs}
    asked = {
        (limit.output, limit.sense, limit.limit)
        for limit in compression.require
        if limit.output not in only_compression
    }
    assert asked == {(limit.output, limit.sense, limit.limit) for limit in shear.require}
    for what in ("minimize", "operating_points", "robust"):
        assert getattr(shear, what) == getattr(compression, what), what
    both = shear.tolerances.keys() & compression.tolerances.keys()
    assert {one: shear.tolerances[one] for one in both} == {one: compression.tolerances[one] for one in both}
    assert shear.module["process"] == compression.module["process"]


@pytest.mark.slow
@to_order
def test_a_study_comes_to_an_optimum_that_95_percent_of_the_modules_keep(path: Path) -> None:
    found = shipped_answer(path.stem)
    assert found.design.status == "optimal"
    assert found.design.accepting == ()
    assert found.feasible
    assert found.solution is not None
    assert found.solution.yield_reached is not None
    assert found.solution.yield_reached.together >= 0.95
