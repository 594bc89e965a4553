"""Which Peltier modules a study may name: rigid ones in both modes, as they are, and their warnings."""

import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.solve.result import answer
from tvimdesign.study import given, read_study_text
from tvimdesign.study.record_checks import record_checks


def test_shear_takes_rigid_modules_as_tiles() -> None:
    study = read_study_text("mode: shear\nmodule: {peltier_module: tm_31_14_85, tiles_per_arc: 1}\n", "a test")
    known = given(study)
    assert (known["heater_form"], known["peltier_length"]) == ("rigid", 20e-3)


def test_compression_takes_them_as_they_are_too() -> None:
    study = read_study_text("mode: compression\nmodule: {peltier_module: tm_31_14_85}\n", "a test")
    known = given(study)
    assert (known["heater_form"], known["tiles_per_block"]) == ("rigid", 1.0)


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


def test_the_pressure_of_a_sheet_comes_before_the_assumed_one() -> None:
    # The drawing PC-XXX-XX-XX of Laird: max mounting pressure 2.5 MPa.
    study = read_study_text("mode: compression\nmodule: {peltier_module: pc_072}\n", "a test")
    assert given(study)["heater_pressure_limit"] == 2.5e6


def test_what_counts_only_with_tiles_is_refused_beside_a_sheet() -> None:
    study = read_study_text("mode: shear\nmodule: {tiles_per_arc: 3}\n", "a test")
    with pytest.raises(InputError, match="tiles_per_arc: no effect, as heater_form is flexible"):
        answer(study)


def test_a_study_may_choose_between_a_sheet_and_tiles() -> None:
    choices = "peltier_module: {choose: [flexible_1600, ma10_063_05_1]}, tiles_per_arc: {from: 1, to: 2}"
    study = read_study_text(f"mode: shear\nvary: {{{choices}}}\nminimize: {{module_mass: 1}}\n", "a test")
    assert given(study)["heater_form"] == "flexible"
    assert given(study.model_copy(update={"module": {"peltier_module": "ma10_063_05_1"}}))["heater_form"] == "rigid"
