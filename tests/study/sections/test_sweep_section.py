"""The section `sweep`: axes, ranges, lists and samples, good and bad."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tvimdesign.study import Study, StudyError
from tvimdesign.study.reader import read_swept
from tvimdesign.study.sections.sweep_block import SweepBlock, SweptRange
from tvimdesign.study.tree import tree_of_values

Refuse = Callable[..., list[str]]


def block(tmp_path: Path, **sweep: object) -> SweepBlock:
    found = read_swept(tree_of_values({"mode": "shear", "sweep": sweep}, "study", tmp_path))[1]
    assert found is not None
    return found


def test_a_grid_has_lists_and_ranges(tmp_path: Path) -> None:
    over = {
        "pcl_thickness": {"from": "0.6 mm", "to": "2 mm", "count": 8},
        "arc_count": {"from": 3, "to": 5},
        "current": {"from": "1 A", "to": "2 A", "step": "0.25 A"},
        "rate_model": ["smi", "bending"],
        "require.module_mass": {"from": "<= 90 g", "to": "<= 120 g", "count": 4},
        "operating_points.hot.temperature": {"from": "90 degC", "to": "110 degC", "step": "5 K"},
    }
    found = block(tmp_path, over=over)
    spans = [axis.range.count if axis.range else len(axis.values) for axis in found.axes]
    assert spans == [8, 3, 5, 2, 4, 5]
    assert [axis.unit for axis in found.axes] == ["mm", "1", "A", "", "g", "degC"]
    assert [axis.number for axis in found.axes] == [True, False, True, False, False, True]
    assert found.axes[0].range == SweptRange(pytest.approx(0.6e-3), pytest.approx(2e-3), 8)
    assert found.axes[4].sense == "<="
    assert (found.method, found.task, found.seed) == ("grid", "", 1)


def test_a_sample_and_a_list(tmp_path: Path) -> None:
    drawn = block(
        tmp_path, method="sobol", count=64, seed=7, task="evaluate", outputs=["module_mass", "joint_stiffness@hot"],
        over={"coil_count": {"from": 3, "to": 8, "spacing": "logarithmic"}},
    )  # fmt: skip
    assert (drawn.count, drawn.seed, drawn.task) == (64, 7, "evaluate")
    assert drawn.axes[0].range is not None
    assert drawn.axes[0].range.logarithmic
    assert drawn.outputs == ("module_mass", "joint_stiffness@hot")
    listed = block(
        tmp_path, cells=[{"current": "1 A", "rate_model": "smi"}, {"rate_model": "bending", "current": "2 A"}]
    )
    assert listed.method == "list"
    assert [[text.value for text in row] for row in listed.rows] == [["1 A", "smi"], ["2 A", "bending"]]


def test_a_study_is_the_same_with_a_sweep(read: Callable[..., Study]) -> None:
    assert read("mode: shear\nsweep: {over: {current: [1 A]}}") == read("mode: shear")


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("{over: {pcl_thicknes: [1 mm]}}", "no such input or choice; .* did you mean 'pcl_thickness'"),
        ("{over: {module_mass: [1 g]}}", "is a result and cannot be set; expected 'require.mod"),
        (
            "{over: {temperature: [1 degC]}}",
            "belongs to an operating point; expected 'operating_points.hot",
        ),
        ("{over: {require.modul_mass: ['<= 1 g']}}", "no such output"),
        ("{over: {write.plots: [true]}}", "no such section to sweep in: 'write'"),
        ("{over: {current: 1 A}}", "is no list of values"),
        ("{over: {current: []}}", "is an empty list"),
        ("{over: {current: [[1 A]]}}", "a list does not fit here; expected one value"),
        ("{over: {current: {from: 1 A}}}", "'to' missing"),
        ("{over: {current: {from: 1 A, to: 2 A}}}", "needs 'count' or 'step', one of the two"),
        ("{over: {current: {from: 1 A, to: 2 A, count: 3, step: 1 A}}}", "one of the two"),
        ("{over: {current: {from: 2 A, to: 1 A, count: 3}}}", "upside down"),
        ("{over: {current: {from: 1 A, to: 2 A, count: 1}}}", "1 values between two ends; expected 2 or more"),
        ("{over: {current: {from: 1 A, to: 2 A, step: -1 A}}}", "leads nowhere"),
        ("{over: {current: {from: 1 A, to: 99 A, count: 3}}}", "above the upper limit 20 A"),
        ("{over: {current: {from: 1 mm, to: 2 A, count: 3}}}", "not of that kind"),
        ("{over: {cooling_current: {from: 0 A, to: 2 A, count: 3, spacing: logarithmic}}}", "begins above 0"),
        ("{over: {rate_model: {from: smi, to: bending}}}", "has no numbers between two ends"),
        ("{over: {require.module_mass: {from: <= 1 g, to: '>= 2 g', count: 3}}}", "the same sense at both ends"),
        ("{method: grid, over: {current: [1 A]}, cells: []}", "a grid has no list of cells"),
        ("{over: {}}", "nothing is swept"),
        ("{seed: 1}", "nothing is swept"),
        ("{method: random, over: {current: [1 A]}}", "no such method: 'random'"),
        ("{task: solve, over: {current: [1 A]}}", "no such task"),
        ("{method: sobol, over: {current: [1 A]}}", r"how many cells are drawn is missing \(sobol\)"),
        ("{count: 3, over: {current: [1 A]}}", "a grid has as many cells as its axes give"),
        ("{method: sobol, count: 4, over: {current: {from: 1 A, to: 2 A, count: 2}}}", "draws between the ends"),
        ("{cells: [{current: 1 A}, {rate_model: smi}]}", "is not in the first cell"),
        ("{cells: [{current: 1 A, rate_model: smi}, {current: 1 A}]}", "has no rate_model"),
        ("{cells: [{current: [1 A]}]}", "expected one value"),
        ("{cells: 3}", "there is no list of cells"),
        ("{cells: [{current: 1 A}], over: {current: [1 A]}}", "a list of cells has no axes of its own"),
        ("{outputs: [modul_mass], over: {current: [1 A]}}", "did you mean 'module_mass'"),
        ("{outputs: module_mass, over: {current: [1 A]}}", "expected a list of outputs, or all"),
        ("{most: 0, over: {current: [1 A]}}", "0 does not fit here; expected 1 to"),
        ("{axes: 1}", "no such key"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(read: Callable[..., Study], written: str, said: str) -> None:
    with pytest.raises(StudyError, match=rf"test:2:\d+: sweep.*{said}"):
        read(f"mode: shear\nsweep: {written}", name="test")
