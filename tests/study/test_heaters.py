"""Heaters of a study, and checks of its records."""

import json
from pathlib import Path

import pytest
from support import study_path

from tvimdesign.base.errors import InputError
from tvimdesign.catalog import Catalog
from tvimdesign.report.rows import print_rows
from tvimdesign.report.run.run_study import describe
from tvimdesign.solve.result import answer
from tvimdesign.study import Study, given, read_study, read_study_text
from tvimdesign.study.resolve import record_checks


def test_both_modes_take_rigid_modules_as_they_are():
    study = read_study_text("mode: shear\nmodule: {heater_module: tm_31_14_85, tiles_per_arc: 1}\n", "a test")
    known = given(study)
    assert (known["heater_form"], known["heater_length"]) == ("rigid", 20e-3)
    # The drawing PC-XXX-XX-XX of Laird: max mounting pressure 2.5 MPa.
    study = read_study_text("mode: compression\nmodule: {heater_module: pc_072}\n", "a test")
    assert given(study)["heater_pressure_limit"] == 2.5e6


def test_a_missing_pressure_limit_is_reported_under_blocks():
    def reported(mode: str, module: str) -> list[str]:
        text = f"mode: {mode}\nmodule: {{{module}}}\n"
        return [line for line in record_checks(read_study_text(text, "a test")) if "pressure" in line]

    (line,) = reported("compression", "heater_module: qc_17")
    assert line.startswith("QC-17-1.0-2.5AS: its record does not say what pressure it bears; 1.5 MPa is assumed")
    assert reported("compression", "heater_module: qc_17, heater_pressure_limit: 1 MPa") == []
    assert (
        reported("compression", "heater_module: pc_072")
        == reported("compression", "heater_module: flexible_1600")
        == []
    )
    assert reported("shear", "heater_module: qc_17") == []


def test_tiles_are_refused_beside_a_sheet_and_chosen_where_listed():
    study = read_study_text("mode: shear\nmodule: {tiles_per_arc: 3}\n", "a test")
    with pytest.raises(InputError, match="tiles_per_arc: no effect, as heater_form is flexible"):
        answer(study)
    choices = "heater_module: {choose: [flexible_1600, ma10_063_05_1]}, tiles_per_arc: {from: 1, to: 2}"
    study = read_study_text(f"mode: shear\nvary: {{{choices}}}\nminimize: {{module_mass: 1}}\n", "a test")
    assert given(study)["heater_form"] == "flexible"
    assert given(study.model_copy(update={"module": {"heater_module": "ma10_063_05_1"}}))["heater_form"] == "rigid"


RECORDS = {name: Catalog().record("heaters", name) for name in Catalog().names("heaters")}
FOILS = [name for name, foil in RECORDS.items() if foil.value("seebeck") == 0.0 and foil.word("heat_source") == "pads"]


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_both_modes_take_them_and_leave_cooling_to_the_air(mode):
    assert len(FOILS) >= 8
    for name in FOILS:
        study = read_study_text(f"mode: {mode}\nmodule: {{heater_module: {name}}}\n", "a test")
        assert (given(study)["cooling_current"], given(study)["heater_seebeck"]) == (0.0, 0.0)
        assert record_checks(study) == []


@pytest.mark.parametrize(
    "sections",
    ["module: {%s, cooling_current: 0.3 A}",
     "module: {%s}\nvary: {cooling_current: [0.3 A, 0.5 A]}\nminimize: {module_mass: 1}"],
)  # fmt: skip
def test_a_study_cannot_ask_a_foil_to_cool(sections):
    study = read_study_text(f"mode: shear\n{sections % 'heater_module: silicone_9ar_04_12v'}\n", "a test")
    message = "cooling_current of 0.3 A and heater_module silicone_9ar_04_12v cannot stand together"
    with pytest.raises(InputError, match=message):
        given(study)


def test_foils_are_refused_cooling_and_listed_without(capsys, tmp_path):
    text = "module: {heater_module: silicone_9ar_04_12v}\nvary: {cooling_current: [0 A, 0.5 A]}\n"
    study = read_study_text(f"mode: shear\n{text}minimize: {{module_mass: 1}}\n", "a test")
    assert given(study)["heater_seebeck"] == 0.0
    assert given(read_study_text("mode: shear\n", "a test"))["cooling_current"] == 0.2
    print_rows("shear", "cooling_current", as_json=True)
    (row,) = [row for row in json.loads(capsys.readouterr().out) if row["name"] == "cooling_current"]
    assert row["default"] == "0.2"
    (tmp_path / "heaters").mkdir()
    own = "{value: 0.2, unit: A, source: forgotten, status: measured}"
    text = f"title: Mine\nbased_on: silicone_9ar_04_12v\nvalues: {{cooling_current: {own}}}\n"
    (tmp_path / "heaters/mine.yaml").write_text(text, encoding="utf-8")
    study = read_study_text(f"mode: shear\ncatalog: {tmp_path}\nmodule: {{heater_module: mine}}\n", "a test")
    (message,) = record_checks(study)
    assert message.startswith("cooling_current of 0.2 A heats: Mine cannot cool")


def test_all_of_an_order_gives_the_same_heat_for_an_area():
    for name in FOILS:
        value = Catalog().record("heaters", name).value
        density = value("max_current") ** 2 * value("resistance") / value("area")
        nominal = 1.6 if name.startswith("polyimide") else int(name.split("_")[2]) / 10.0
        assert density == pytest.approx(nominal * 1e4, rel=2e-4)
        volts = float(name.rsplit("_", 1)[1].removesuffix("v"))
        assert value("max_current") * value("resistance") == pytest.approx(volts, rel=2e-4)


STUDY = "tvimdesign: 1\nname: Doubt\nmode: shear\ncatalog: records\nmodule: {heater_module: bench}\n"


@pytest.fixture
def shipped() -> Path:
    return Path(str(Catalog().path("heaters", "teci_12706")))


def _cut_to_size(sheet: Path) -> str:
    """Return the sheet of a module that is cut to the PCL."""
    bulk = "values:\n  bulk_modulus: {value: 1, unit: GPa, status: datasheet, source: a test}\n"
    text = sheet.read_text(encoding="utf-8").replace("form: rigid", "form: flexible")
    return text.replace("values:\n", bulk, 1)


def _study(folder: Path, record: str) -> Study:
    (folder / "records" / "heaters").mkdir(parents=True, exist_ok=True)
    (folder / "records" / "heaters" / "bench.yaml").write_text(record, encoding="utf-8")
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    return read_study(folder / "study.yaml")


def test_only_sheets_that_contradict_themselves_are_reported(shipped, tmp_path):
    study = _study(tmp_path, _cut_to_size(shipped))
    (message,) = record_checks(study)
    # S^2 T^2/(2 R) is V_max^2/(2 R) at the sheet's own 27 degC: 15.8^2/(2 * 2.0455) = 61.0 W.
    assert "61 W, the sheet says 51 W" in message
    assert message in describe(study).splitlines()
    text = _cut_to_size(shipped)
    study = _study(tmp_path, text.replace("value: 51, unit: W", "value: 58, unit: W"))
    assert record_checks(study) == []
    study = read_study(study_path("paper_shear"))
    assert record_checks(study) == []


def test_another_material_with_the_polymer_s_laws_is_reported_on_the_page(tmp_path):
    """Describe a metal by a few numbers of its own, based on a polymer."""
    folder = tmp_path / "records/polymers"
    folder.mkdir(parents=True)
    own = "{value: 7900, unit: kg/m^3, source: a scale, status: measured}"
    (folder / "metal.yaml").write_text(
        f"title: My metal\nbased_on: pcl_80k\nvalues: {{density_solid: {own}}}\n", encoding="utf-8"
    )
    (tmp_path / "study.yaml").write_text(
        "mode: shear\ncatalog: records\nmodule: {pcl_grade: metal}\n", encoding="utf-8"
    )
    study = read_study(tmp_path / "study.yaml")
    message = record_checks(study)
    assert [line.partition(" are those")[0].removeprefix("My metal: the ") for line in message] == [
        "kinetics of freezing", "viscosity of the melt", "losses of the solid",
    ]  # fmt: skip
    assert message[0] in describe(study).splitlines()
