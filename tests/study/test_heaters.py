"""Heaters a study may name: rigid modules and foils in both modes, what they refuse, and their warnings."""

import json
from pathlib import Path

import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.catalog import Catalog
from tvimdesign.report.rows import print_rows
from tvimdesign.solve.result import answer
from tvimdesign.study import given, read_study_text
from tvimdesign.study.resolve import record_checks


def test_both_modes_take_rigid_modules_as_they_are() -> None:
    study = read_study_text("mode: shear\nmodule: {peltier_module: tm_31_14_85, tiles_per_arc: 1}\n", "a test")
    known = given(study)
    assert (known["heater_form"], known["peltier_length"]) == ("rigid", 20e-3)
    # The drawing PC-XXX-XX-XX of Laird: max mounting pressure 2.5 MPa.
    study = read_study_text("mode: compression\nmodule: {peltier_module: pc_072}\n", "a test")
    assert given(study)["heater_pressure_limit"] == 2.5e6


def test_a_missing_pressure_limit_is_reported_under_blocks() -> None:
    def reported(mode: str, module: str) -> list[str]:
        text = f"mode: {mode}\nmodule: {{{module}}}\n"
        return [line for line in record_checks(read_study_text(text, "a test")) if "pressure" in line]

    (line,) = reported("compression", "peltier_module: qc_17")
    assert line.startswith("QC-17-1.0-2.5AS: its record does not say what pressure it bears; 1.5 MPa is assumed")
    assert reported("compression", "peltier_module: qc_17, heater_pressure_limit: 1 MPa") == []
    assert (
        reported("compression", "peltier_module: pc_072")
        == reported("compression", "peltier_module: flexible_1600")
        == []
    )
    assert reported("shear", "peltier_module: qc_17") == []


def test_tiles_are_refused_beside_a_sheet_and_chosen_where_listed() -> None:
    study = read_study_text("mode: shear\nmodule: {tiles_per_arc: 3}\n", "a test")
    with pytest.raises(InputError, match="tiles_per_arc: no effect, as heater_form is flexible"):
        answer(study)
    choices = "peltier_module: {choose: [flexible_1600, ma10_063_05_1]}, tiles_per_arc: {from: 1, to: 2}"
    study = read_study_text(f"mode: shear\nvary: {{{choices}}}\nminimize: {{module_mass: 1}}\n", "a test")
    assert given(study)["heater_form"] == "flexible"
    assert given(study.model_copy(update={"module": {"peltier_module": "ma10_063_05_1"}}))["heater_form"] == "rigid"


RECORDS = {name: Catalog().record("peltiers", name) for name in Catalog().names("peltiers")}
FOILS = [name for name, one in RECORDS.items() if one.value("seebeck") == 0.0 and one.word("heat_source") == "pads"]


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_both_modes_take_them_and_leave_cooling_to_the_air(mode: str) -> None:
    assert len(FOILS) >= 8
    for name in FOILS:
        study = read_study_text(f"mode: {mode}\nmodule: {{peltier_module: {name}}}\n", "a test")
        assert (given(study)["cooling_current"], given(study)["peltier_seebeck"]) == (0.0, 0.0)
        assert record_checks(study) == []


@pytest.mark.parametrize(
    "sections",
    ["module: {%s, cooling_current: 0.3 A}",
     "module: {%s}\nvary: {cooling_current: [0.3 A, 0.5 A]}\nminimize: {module_mass: 1}"],
)  # fmt: skip
def test_a_study_cannot_ask_a_foil_to_cool(sections: str) -> None:
    study = read_study_text(f"mode: shear\n{sections % 'peltier_module: silicone_9ar_04_12v'}\n", "a test")
    message = "cooling_current of 0.3 A and peltier_module silicone_9ar_04_12v cannot stand together"
    with pytest.raises(InputError, match=message):
        given(study)


def test_foils_are_refused_cooling_and_listed_without(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    text = "module: {peltier_module: silicone_9ar_04_12v}\nvary: {cooling_current: [0 A, 0.5 A]}\n"
    study = read_study_text(f"mode: shear\n{text}minimize: {{module_mass: 1}}\n", "a test")
    assert given(study)["peltier_seebeck"] == 0.0
    assert given(read_study_text("mode: shear\n", "a test"))["cooling_current"] == 0.2
    print_rows("shear", "cooling_current", as_json=True)
    (row,) = [row for row in json.loads(capsys.readouterr().out) if row["name"] == "cooling_current"]
    assert row["default"] == "0.2"
    (tmp_path / "peltiers").mkdir()
    own = "{value: 0.2, unit: A, source: forgotten, status: measured}"
    text = f"title: Mine\nbased_on: silicone_9ar_04_12v\nvalues: {{cooling_current: {own}}}\n"
    (tmp_path / "peltiers/mine.yaml").write_text(text, encoding="utf-8")
    study = read_study_text(f"mode: shear\ncatalog: {tmp_path}\nmodule: {{peltier_module: mine}}\n", "a test")
    (message,) = record_checks(study)
    assert message.startswith("cooling_current of 0.2 A heats: Mine cannot cool")


def test_all_of_an_order_gives_the_same_heat_for_an_area() -> None:
    for name in FOILS:
        value = Catalog().record("peltiers", name).value
        density = value("max_current") ** 2 * value("resistance") / value("area")
        nominal = 1.6 if name.startswith("polyimide") else int(name.split("_")[2]) / 10.0
        assert density == pytest.approx(nominal * 1e4, rel=2e-4)
        volts = float(name.rsplit("_", 1)[1].removesuffix("v"))
        assert value("max_current") * value("resistance") == pytest.approx(volts, rel=2e-4)
