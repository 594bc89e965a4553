"""Which Peltier modules a study may name: rigid ones in shear mode, where they lie as they are, not in compression."""

import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.solve.result import answer
from tvimdesign.study import given, read_study_text
from tvimdesign.study.text.mistakes import StudyError


def test_shear_takes_rigid_modules_as_tiles() -> None:
    study = read_study_text("mode: shear\nmodule: {peltier_module: tm_31_14_85, tiles_per_arc: 1}\n", "a test")
    known = given(study)
    assert (known["heater_form"], known["peltier_length"]) == ("rigid", 20e-3)


def test_compression_has_pads_cut_to_its_blocks_and_refuses_them() -> None:
    with pytest.raises(StudyError, match=r"tm_31_14_85 has the form rigid.*cannot be cut"):
        read_study_text("mode: compression\nmodule: {peltier_module: tm_31_14_85}\n", "a test")


def test_what_counts_only_with_tiles_is_refused_beside_a_sheet() -> None:
    study = read_study_text("mode: shear\nmodule: {tiles_per_arc: 3}\n", "a test")
    with pytest.raises(InputError, match="tiles_per_arc: no effect, as heater_form is flexible"):
        answer(study)


def test_a_study_may_choose_between_a_sheet_and_tiles() -> None:
    choices = "peltier_module: {choose: [flexible_1600, ma10_063_05_1]}, tiles_per_arc: {from: 1, to: 2}"
    study = read_study_text(f"mode: shear\nvary: {{{choices}}}\nminimize: {{module_mass: 1}}\n", "a test")
    assert given(study)["heater_form"] == "flexible"
    assert given(study.model_copy(update={"module": {"peltier_module": "ma10_063_05_1"}}))["heater_form"] == "rigid"
