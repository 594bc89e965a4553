"""Foil heaters where Peltier pads are named: the air cools by default, and asking them to cool is told."""

import json

import pytest

from tvimdesign.catalog import Catalog
from tvimdesign.report.rows import print_rows
from tvimdesign.study import given, read_study_text
from tvimdesign.study.record_checks import record_checks

FOILS = [name for name in Catalog().names("peltiers") if Catalog().record("peltiers", name).value("seebeck") == 0.0]


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_both_modes_take_them_and_leave_cooling_to_the_air(mode: str) -> None:
    assert len(FOILS) >= 8
    for name in FOILS:
        study = read_study_text(f"mode: {mode}\nmodule: {{peltier_module: {name}}}\n", "a test")
        assert (given(study)["cooling_current"], given(study)["peltier_seebeck"]) == (0.0, 0.0)
        assert record_checks(study) == []


def test_a_cooling_current_through_a_foil_is_told() -> None:
    module = "{peltier_module: silicone_9ar_04_12v, cooling_current: 0.3 A}"
    (said,) = record_checks(read_study_text(f"mode: shear\nmodule: {module}\n", "a test"))
    assert said.startswith("cooling_current of 0.3 A heats: Silicone heater 9AR")


def test_a_peltier_module_keeps_the_default(capsys: pytest.CaptureFixture[str]) -> None:
    assert given(read_study_text("mode: shear\n", "a test"))["cooling_current"] == 0.2
    print_rows("shear", "cooling_current", as_json=True)
    (row,) = [row for row in json.loads(capsys.readouterr().out) if row["name"] == "cooling_current"]
    assert row["default"] == "0.2"


def test_all_of_an_order_gives_the_same_heat_for_an_area() -> None:
    for name in FOILS:
        value = Catalog().record("peltiers", name).value
        density = value("max_current") ** 2 * value("resistance") / value("area")
        asked = 1.6 if name.startswith("polyimide") else int(name.split("_")[2]) / 10.0
        assert density == pytest.approx(asked * 1e4, rel=2e-4)
        volts = float(name.rsplit("_", 1)[1].removesuffix("v"))
        assert value("max_current") * value("resistance") == pytest.approx(volts, rel=2e-4)
