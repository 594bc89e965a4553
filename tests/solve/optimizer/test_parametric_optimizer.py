"""A problem solved again with other numbers is the problem that is built with them."""

from pathlib import Path

import pytest
from explored import SMALL

from tvimdesign.solve.optimizer.optimizer import SETTLED, Optimizer
from tvimdesign.solve.optimizer.parametric_optimizer import ParametricOptimizer
from tvimdesign.study import Study, read_tree
from tvimdesign.study.reader import read_study_text
from tvimdesign.study.tree import tree_of_text, with_settings


def _with(*settings: str) -> Study:
    return read_tree(with_settings(tree_of_text(SMALL, "small.yaml", "small", Path()), settings))


MOVED = {
    "a limit that binds": ["require.peak_power=<= 9 W"],
    "ends of a range": ["vary.current=[0.8 A, 1.2 A]"],
    "a weight": ["minimize.module_mass=4"],
    "a fixed number": ["core_radius=9.4 mm"],
    "all of them": ["require.peak_power=<= 10 W", "vary.pcl_thickness=[0.9 mm, 2.2 mm]", "minimize.response_time=2",
                    "stroke=0.09 rad"],
}  # fmt: skip


@pytest.fixture(scope="module")
def built() -> ParametricOptimizer:
    return ParametricOptimizer(read_study_text(SMALL))


@pytest.mark.parametrize("name", MOVED)
def test_a_moved_problem_has_the_optimum_of_one_built_for_it(built: ParametricOptimizer, name: str) -> None:
    first, study = built.solve(built.study), _with(*MOVED[name])
    assert built.fits(study)
    moved = built.solve(study, first.run)
    fresh = Optimizer(study, built.optimizer.reference).solve()
    assert moved.converged
    # Both are optima, each with the steps that were placed on its way: these differ most where a range ends.
    apart = SETTLED if name == "ends of a range" else 2e-6
    assert moved.run.start.objective == pytest.approx(fresh.start.objective, rel=apart)
    for variable, value in fresh.start.end.items():
        assert moved.run.start.end[variable] == pytest.approx(value, rel=10.0 * SETTLED)
        assert abs(value / first.run.start.end[variable] - 1.0) > 1e-6 or name != "all of them"


def test_what_binds_is_told_with_the_ends_of_ranges(built: ParametricOptimizer) -> None:
    bound = built.solve(_with("require.peak_power=<= 9 W"))
    assert "peak_power <=" in bound.binding
    ended = built.solve(_with("vary.current=[0.8 A, 1.1 A]"))
    assert ended.ends["current"] == "upper"


def test_what_is_built_in_does_not_fit(built: ParametricOptimizer) -> None:
    assert not built.fits(_with("cover=plate"))
    assert not built.fits(_with("require.holding_torque=>= 1 N.m"))
    assert not built.fits(_with("solver.cells=10"))
