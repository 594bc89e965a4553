"""The sections `tolerances`, `sweep` and `task` of a study."""

from pathlib import Path

import pytest

from tvimdesign.base.units import parse_quantity
from tvimdesign.device import MODES, Input, table_for
from tvimdesign.study import Study, read_study_text, standard_tolerances
from tvimdesign.study.reader import read_swept
from tvimdesign.study.sections.sweeps import SweepBlock, SweptRange
from tvimdesign.study.sections.tolerances import standard_entries
from tvimdesign.study.study import Robust
from tvimdesign.study.tree import tree_of_values

SEARCH = "vary: {current: [0.5 A, 2 A]}\nminimize: module_mass\n"


def _read(text: str) -> Study:
    return read_study_text(f"mode: shear\n{text}", "x.yaml")


def test_a_tolerance_is_a_quantity_a_share_or_all_that_can_be_stated():
    result = _read("tolerances: {wire_diameter: 0.025 mm, heater_seebeck: 10 %, temperature@hot: 2 K}").tolerances
    assert result["wire_diameter"].plus_minus == pytest.approx(25e-6)
    assert (result["heater_seebeck"].share, result["heater_seebeck"].plus_minus) == (pytest.approx(0.1), None)
    assert result["temperature@hot"].plus_minus == 2.0
    assert {item.status for item in result.values()} == {"stated"}
    text = "{plus_minus: 5 deg, distribution: uniform, sigma: 2, adjustable: true, adjusted_to: 1 deg}"
    item = _read(f"tolerances: {{preload_angle: {text}}}").tolerances["preload_angle"]
    assert (item.distribution, item.sigma, item.adjustable) == ("uniform", 2.0, True)
    assert item.plus_minus == pytest.approx(5.0 * item.adjusted_to) == pytest.approx(0.0872665, rel=1e-6)


def test_standard_tolerances_are_those_of_the_mode_and_may_be_overridden():
    assert _read("tolerances: standard").tolerances == standard_tolerances(table_for("shear"))
    assert {"pcl_thickness", "block_depth"} & set(standard_tolerances(table_for("compression"))) == {"block_depth"}
    result = _read("tolerances: {standard: true, current: 3 %, preload_angle: {adjustable: true}}").tolerances
    assert result["current"].share == pytest.approx(0.03)
    assert (result["preload_angle"].row, result["preload_angle"].adjustable) == ("free_angle_tolerance", True)
    assert result["wire_diameter"].plus_minus == pytest.approx(25e-6)


@pytest.mark.parametrize("name", standard_entries())
def test_every_standard_tolerance_has_a_row_a_source_and_a_status(name):
    entry = standard_entries()[name]
    rows = [row for mode in MODES for row in table_for(mode).inputs if row.name == name]
    assert rows
    assert isinstance(rows[0], Input)
    assert entry["source"]
    assert entry["status"] in {"handbook", "assumed"}
    if entry["status"] == "assumed":
        low, value, high = (_size(str(entry[key]), rows[0].unit) for key in ("low", "plus_minus", "high"))
        assert low < value < high


def _size(written: str, unit: str) -> float:
    return parse_quantity(written, "%" if written.endswith("%") else "K" if unit == "degC" else unit)


def test_robust_is_a_count_of_deviations_or_a_yield():
    request = f"{SEARCH}tolerances: standard\nrobust: "
    assert _read(request + "{sigma: 2.5}").robust == Robust(sigma=2.5)
    robust = _read(request + "{yield: 95 %}").robust
    assert robust.share == pytest.approx(0.95)
    assert _read(request).robust is None
    study = _read(f"{SEARCH}tolerances: standard\nrobust: {{sigma: 2}}")
    assert Study.model_validate_json(study.model_dump_json()) == study


def block(tmp_path: Path, **sweep: object) -> SweepBlock:
    result = read_swept(tree_of_values({"mode": "shear", "sweep": sweep}, "study", tmp_path))[1]
    assert result is not None
    return result


def test_a_grid_has_lists_and_ranges(tmp_path):
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


def test_a_sample_and_a_list(tmp_path):
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


def test_a_study_is_the_same_with_a_sweep(read):
    assert read("mode: shear\nsweep: {over: {current: [1 A]}}") == read("mode: shear")
