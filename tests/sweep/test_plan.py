"""Cells lie where they are asked for, values are read before anything is solved, a key is of the study alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.stats import qmc
from small_sweeps import plan

from tvimdesign.base.errors import InputError
from tvimdesign.study import StudyError, read_tree
from tvimdesign.sweep.keys import CellKeys, leaves_of
from tvimdesign.sweep.plan import SweepPlan

OPTIMISED = """
mode: shear
vary: {wire_diameter: [1.5 mm, 3 mm], coil_diameter: [10 mm, 30 mm], pcl_thickness: [0.6 mm, 2 mm]}
minimize: module_mass
require: {holding_torque: '>= 10 N.m', module_mass: '<= 300 g'}
"""


def plan_over(tmp_path: Path, sweep: str, study: str = "mode: shear\n") -> SweepPlan:
    path = tmp_path / "study.yaml"
    path.write_text(f"{study}sweep: {sweep}\n")
    return plan(path)


def test_the_last_axis_of_a_grid_changes_fastest(tmp_path: Path) -> None:
    found = plan_over(tmp_path, "{over: {current: [1 A, 2 A], arc_count: {from: 3, to: 5}}}")
    cells = [found.points.texts(number) for number in range(found.count)]
    assert cells == [(current, count) for current in ("1 A", "2 A") for count in ("3", "4", "5")]


def test_logarithmic_values_have_one_ratio(tmp_path: Path) -> None:
    found = plan_over(tmp_path, "{over: {current: {from: 0.5 A, to: 8 A, count: 5, spacing: logarithmic}}}")
    assert [found.axis_values(number)[0] for number in range(5)] == pytest.approx([0.5, 1.0, 2.0, 4.0, 8.0])


def test_a_sample_is_scipy_s_between_the_ends(tmp_path: Path) -> None:
    over = "{current: {from: 1 A, to: 2 A}, pcl_thickness: {from: 0.6 mm, to: 2 mm}}"
    found = plan_over(tmp_path, f"{{method: sobol, count: 5, seed: 9, over: {over}}}")
    shares = qmc.Sobol(2, rng=9).random_base2(3)[:5]
    expected = qmc.scale(shares, [1.0, 0.6], [2.0, 2.0])
    assert np.array([found.axis_values(number) for number in range(5)]) == pytest.approx(expected, rel=1e-9)


def test_a_sample_takes_each_word_and_each_count_as_often(tmp_path: Path) -> None:
    over = "{rate_model: [smi, bending], arc_count: {from: 3, to: 6}}"
    found = plan_over(tmp_path, f"{{method: latin_hypercube, count: 8, over: {over}}}")
    words, counts = zip(*(found.points.texts(number) for number in range(8)), strict=True)
    assert sorted(words) == ["bending"] * 4 + ["smi"] * 4
    assert sorted(counts) == ["3", "3", "4", "4", "5", "5", "6", "6"]


def test_a_listed_value_that_cannot_be_is_refused_with_its_place(tmp_path: Path) -> None:
    with pytest.raises(StudyError, match=r"study.yaml:2:\d+: module.current: '99 A' is above the upper limit"):
        plan_over(tmp_path, "{over: {pcl_thickness: [1 mm], current: [1 A, 99 A]}}")
    with pytest.raises(StudyError, match="no unit"):
        plan_over(tmp_path, "{over: {pcl_thickness: [1 mm, 1 furlong]}}")


def test_too_many_cells_are_refused_unless_they_are_meant(tmp_path: Path) -> None:
    over = "over: {current: {from: 1 A, to: 2 A, count: 1000}, pcl_thickness: {from: 1 mm, to: 2 mm, count: 1000}}"
    with pytest.raises(InputError, match=r"1000000 cells; the limit is 100000; .*say `most: 1000000`"):
        plan_over(tmp_path, f"{{{over}}}")
    assert plan_over(tmp_path, f"{{most: 1000000, {over}}}").count == 1_000_000


def test_a_study_without_a_sweep_is_told_how(tmp_path: Path) -> None:
    path = tmp_path / "study.yaml"
    path.write_text("mode: shear\n")
    with pytest.raises(InputError, match=r"there is no `sweep:`; add, for one, sweep: {over: "):
        plan(path)


@pytest.mark.parametrize(
    "sweep",
    [
        "{over: {pcl_thickness: {from: 0.6 mm, to: 2 mm, count: 3}, require.holding_torque: ['>= 5 N.m', '>= 6 N.m']}}",
        "{over: {require.module_mass: {from: <= 200 g, to: <= 300 g, count: 3}, rate_model: [smi, bending]}}",
        "{over: {operating_points.hot.temperature: {from: 90 degC, to: 110 degC, count: 3}, arc_count: [3, 4]}}",
        "{over: {wire_diameter: [2 mm], coil_diameter: [20 mm, 25 mm], pcl_thickness: [1 mm, 1.2 mm]}}",
        "{method: latin_hypercube, count: 4, over: {wire_diameter: {from: 2 mm, to: 3 mm}, solver.starts: [1, 2]}}",
    ],
)
def test_what_a_key_is_made_of_is_the_cell_s_resolved_study(tmp_path: Path, sweep: str) -> None:
    found = plan_over(tmp_path, sweep, OPTIMISED)
    keys = CellKeys(found)
    for number in range(found.count):
        texts = found.points.texts(number)
        assert keys.leaves(texts) == leaves_of(read_tree(found.cell_tree(texts)))
    assert len({keys.key(found.points.texts(number)) for number in range(found.count)}) == found.count


def test_a_key_changes_with_study_and_record_not_with_other_cells(tmp_path: Path) -> None:
    def key(sweep: str = "{over: {current: [1 A, 2 A]}}", study: str = "mode: shear\n") -> str:
        found = plan_over(tmp_path, sweep, study)
        return CellKeys(found).key(found.points.texts(0))

    own = "mode: shear\ncatalog: records\nmodule: {pcl_grade: own}\n"
    records = tmp_path / "records/polymers"
    records.mkdir(parents=True)

    def with_record(title: str) -> str:
        (records / "own.yaml").write_text(f"title: {title}\nbased_on: pcl_80k\n")
        return key(study=own)

    assert key() == key() == key("{over: {current: [1 A, 3 A, 4 A]}}")
    assert key() != key(study="mode: shear\nmodule: {wire_diameter: 2.3 mm}\n")
    assert key() != key(study="mode: shear\nsolver: {cells: 20}\n")
    assert key() == key(study="mode: shear\nname: other\nwrite: {cad: false}\n")
    assert with_record("a") == with_record("a") != with_record("b")
