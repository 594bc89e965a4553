"""A study or a design with a name of an earlier release is read as what it is called now."""

import warnings

import pytest

from tvimdesign.base.errors import RenamedWarning
from tvimdesign.study import StudyError, read_study_text
from tvimdesign.study.design import Design

STUDY = """
mode: shear
name: my_reserve
vary: {current: [0.5 A, 2 A]}
require: {peltier_temperature_reserve: ">= 0 K"}
minimize: {response_time: 1}
"""


def test_an_old_name_is_read_and_the_new_one_is_said() -> None:
    with pytest.warns(RenamedWarning, match="peltier_temperature_reserve is now peltier_temperature_margin"):
        study = read_study_text(STUDY, "x.yaml")
    assert [one.output for one in study.require] == ["peltier_temperature_margin"]
    assert study.name == "my_reserve"


def test_the_new_name_is_read_without_a_word() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read_study_text(STUDY.replace("temperature_reserve", "temperature_margin"), "x.yaml")


def test_both_names_at_once_are_a_mistake() -> None:
    both = STUDY.replace('K"}', 'K", peltier_temperature_margin: ">= 1 K"}')
    with pytest.raises(StudyError, match="no such output"):
        read_study_text(both, "x.yaml")


def test_a_design_of_an_earlier_release_is_read() -> None:
    old = {
        "tvimdesign": "0.1.0", "name": "old_reserve", "mode": "shear", "status": "optimal", "choices": {},
        "values": {"preload_reserve": 0.1, "joint_stiffness@hot": 3.0},
        "study": {"require": [{"output": "preload_reserve"}]}, "drives": {"softening": {}},
    }  # fmt: skip
    design = Design.model_validate(old)
    assert design.values == {"preload_margin": 0.1, "joint_stiffness@hot": 3.0}
    assert design.study["require"][0]["output"] == "preload_margin"
    assert design.current_profiles == {"softening": {}}
    assert design.name == "old_reserve"
