"""The section `sweep`: axes, ranges, lists and samples, good and bad."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tvimdesign.study import Study
from tvimdesign.study.reader import read_swept
from tvimdesign.study.sections.sweep_block import SweepBlock, SweptRange
from tvimdesign.study.tree import tree_of_values


def block(tmp_path: Path, **sweep: object) -> SweepBlock:
    result = read_swept(tree_of_values({"mode": "shear", "sweep": sweep}, "study", tmp_path))[1]
    assert result is not None
    return result


def test_a_grid_has_lists_and_ranges(tmp_path: Path) -> None:
    over = {
        "pcl_thickness": {"from": "0.6 mm", "to": "2 mm", "count": 8},
        "arc_count": {"from": 3, "to": 5},
        "current": {"from": "1 A", "to": "2 A", "step": "0.25 A"},
        "rate_model": ["smi", "bending"],
        "require.module_mass": {"from": "<= 90 g", "to": "<= 120 g", "count": 4},
        "operating_points.hot.temperature": {"from": "90 degC", "to": "110 degC", "step": "5 K"},
    }
    result = block(tmp_path, over=over)
    spans = [axis.range.count if axis.range else len(axis.values) for axis in result.axes]
    assert spans == [8, 3, 5, 2, 4, 5]
    assert [axis.unit for axis in result.axes] == ["mm", "1", "A", "", "g", "degC"]
    assert [axis.number for axis in result.axes] == [True, False, True, False, False, True]
    assert result.axes[0].range == SweptRange(pytest.approx(0.6e-3), pytest.approx(2e-3), 8)
    assert result.axes[4].sense == "<="
    assert (result.method, result.task, result.seed) == ("grid", "", 1)


def test_a_sample_and_a_list(tmp_path: Path) -> None:
    drawn = block(
        tmp_path, method="sobol", count=64, seed=7, task="evaluate", outputs=["module_mass", "joint_stiffness@hot"],
        over={"coil_count": {"from": 3, "to": 8, "spacing": "logarithmic"}},
    )  # fmt: skip
    assert (drawn.count, drawn.seed, drawn.task) == (64, 7, "evaluate")
    assert drawn.axes[0].range.logarithmic
    assert drawn.outputs == ("module_mass", "joint_stiffness@hot")
    listed = block(
        tmp_path, cells=[{"current": "1 A", "rate_model": "smi"}, {"rate_model": "bending", "current": "2 A"}]
    )
    assert listed.method == "list"
    assert [[text.value for text in row] for row in listed.rows] == [["1 A", "smi"], ["2 A", "bending"]]


def test_a_study_is_the_same_with_a_sweep(read: Callable[..., Study]) -> None:
    assert read("mode: shear\nsweep: {over: {current: [1 A]}}") == read("mode: shear")
