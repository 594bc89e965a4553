"""The sections `tolerances` and `robust`: values, shares and rows, and every problem with its place."""

from __future__ import annotations

import pytest

from tvimdesign.base.units import parse_quantity
from tvimdesign.device import MODES, Input, table_for
from tvimdesign.study import Robust, Study, StudyError, read_study_text, standard_tolerances
from tvimdesign.study.sections.tolerances import standard_entries

SEARCH = "vary: {current: [0.5 A, 2 A]}\nminimize: module_mass\n"


def _read(text: str) -> Study:
    return read_study_text(f"mode: shear\n{text}", "x.yaml")


def test_a_tolerance_is_a_quantity_or_a_share() -> None:
    found = _read("tolerances: {wire_diameter: 0.025 mm, peltier_seebeck: 10 %, temperature@hot: 2 K}").tolerances
    assert found["wire_diameter"].plus_minus == pytest.approx(25e-6)
    assert (found["peltier_seebeck"].share, found["peltier_seebeck"].plus_minus) == (pytest.approx(0.1), None)
    assert found["temperature@hot"].plus_minus == 2.0
    assert {one.status for one in found.values()} == {"stated"}


def test_everything_of_a_tolerance_can_be_said() -> None:
    text = "{plus_minus: 5 deg, distribution: uniform, sigma: 2, adjustable: true, adjusted_to: 1 deg}"
    one = _read(f"tolerances: {{preload_angle: {text}}}").tolerances["preload_angle"]
    assert (one.distribution, one.sigma, one.adjustable) == ("uniform", 2.0, True)
    assert one.plus_minus == pytest.approx(5.0 * one.adjusted_to) == pytest.approx(0.0872665, rel=1e-6)


def test_standard_tolerances_are_those_of_the_mode_and_may_be_overridden() -> None:
    assert _read("tolerances: standard").tolerances == standard_tolerances(table_for("shear"))
    assert {"pcl_thickness", "block_depth"} & set(standard_tolerances(table_for("compression"))) == {"block_depth"}
    found = _read("tolerances: {standard: true, current: 3 %, preload_angle: {adjustable: true}}").tolerances
    assert found["current"].share == pytest.approx(0.03)
    assert (found["preload_angle"].row, found["preload_angle"].adjustable) == ("free_angle_tolerance", True)
    assert found["wire_diameter"].plus_minus == pytest.approx(25e-6)


@pytest.mark.parametrize("name", standard_entries())
def test_every_standard_tolerance_has_a_row_a_source_and_a_status(name: str) -> None:
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


def test_robust_is_a_count_of_deviations_or_a_yield() -> None:
    asked = f"{SEARCH}tolerances: standard\nrobust: "
    assert _read(asked + "{sigma: 2.5}").robust == Robust(sigma=2.5)
    robust = _read(asked + "{yield: 95 %}").robust
    assert robust is not None
    assert robust.share == pytest.approx(0.95)
    assert _read(asked).robust is None


def test_a_study_with_tolerances_survives_json() -> None:
    study = _read(f"{SEARCH}tolerances: standard\nrobust: {{sigma: 2}}")
    assert Study.model_validate_json(study.model_dump_json()) == study


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("tolerances: standart", "x.yaml:2:13: tolerances: the value 'standart' does not fit here; expected standard"),
        ("tolerances: {wire_diamter: 1 mm}", "2:14: tolerances.wire_diamter: no such input"),
        ("tolerances: {wire_diamter: 1 mm}", "did you mean 'wire_diameter'?"),
        ("tolerances: {block_depth: 1 mm}", "block_depth is of compression mode, this study is shear mode"),
        ("tolerances: {spring_pairs: 1}", "tolerances.spring_pairs: counts whole things and has no tolerance"),
        ("tolerances: {module_mass: 1 g}", "is a result and has no tolerance of its own; expected an input"),
        ("tolerances: {rate_model: 1}", "is a word and has no tolerance of its own"),
        ("tolerances: {temperature: 2 K}", "belongs to an operating point; expected temperature@<operating point>"),
        ("tolerances: {current@hot: 2 A}", "has no points; expected 'current'"),
        ("tolerances: {temperature@hott: 2 K}", "no such operating point: 'hott'; expected one of cold, hot"),
        ("tolerances: {ambient_temperature: 5 %}", "2:35: tolerances.ambient_temperature: '5 %': a temperature has no"),
        ("tolerances: {ambient_temperature: 5 degC}", "degC"),
        ("tolerances: {wire_diameter: -1 mm}", "'-1 mm' cannot be a tolerance; expected 0 or more"),
        ("tolerances: {wire_diameter: 100 %}", "expected 0 to 100 %"),
        ("tolerances: {wire_diameter: 1 m}", "is wider than all that wire_diameter may be; expected 0.3 mm to 10 mm"),
        ("tolerances: {wire_diameter: 0.1}", "tolerances.wire_diameter"),
        ("tolerances: {wire_diameter: [1 mm]}", "a list does not fit here; expected a plus-minus value such as"),
        ("tolerances: {wire_diameter: {sigma: 3}}", "'plus_minus' missing"),
        ("tolerances: {wire_diameter: {plus_minus: 1 mm, row: coil_diameter_tolerance}}", "both 'plus_minus' and"),
        ("tolerances: {wire_diameter: {row: free_angle_tolerance}}", "free_angle_tolerance is in deg; expected a row"),
        ("tolerances: {wire_diameter: {row: module_mass}}", "no such row that gives a tolerance: 'module_mass'"),
        ("tolerances: {wire_diameter: {plus_minus: 1 mm, sigma: 0}}", "0 is out of range; expected a count of"),
        ("tolerances: {wire_diameter: {plus_minus: 1 mm, distribution: gauss}}", "no such distribution: 'gauss'"),
        ("tolerances: {wire_diameter: {plus_minus: 1 mm, adjusted_to: 5 %}}", "is a share; expected a value in mm"),
        ("tolerances: {wire_diameter: {plus_minus: 1 mm, adjust: true}}", "no such key"),
        ("tolerances: standard\nrobust: {sigma: 3}", "3:9: robust: nothing may change: `vary` is missing"),
        ("robust: {sigma: 3}", "robust: there is nothing to be robust against: `tolerances` is missing"),
        ("tolerances: standard\nrobust: {sigma: 3, yield: 0.9}", "3:9: robust: both 'sigma' and 'yield'"),
        ("tolerances: standard\nrobust: {sigma: 9}", "robust.sigma: 9 is out of range"),
        ("tolerances: standard\nrobust: {yield: 30 %}", "robust.yield: 0.3 is out of range; expected above 50 %"),
        ("tolerances: standard\nrobust: 3", "robust: the value '3' does not fit here; expected {sigma: 3} or"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(text: str, said: str) -> None:
    with pytest.raises(StudyError) as caught:
        _read(text)
    assert said in str(caught.value)
