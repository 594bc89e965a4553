"""Controls of the explorer: each value in its quantity's own unit, with a label and a group."""

from pathlib import Path

import pytest
from explored import SMALL

from tvimdesign.explore.states.state import State, controls_shown, sized_state, tree_of
from tvimdesign.study import read_study_text, read_tree
from tvimdesign.study.sizing import JointTask, study_text
from tvimdesign.study.tree import tree_of_text

STUDY = """
mode: shear
vary:
  pcl_thickness: [0.6 mm, 2 mm]
  arc_span: [20 deg, 110 deg]
require: {envelope_diameter: "<= 0.09 m"}
minimize: {module_mass: 1}
"""


def test_controls_have_units_labels_and_groups() -> None:
    study = read_study_text(STUDY)
    at = {"pcl_thickness": "0.0012 m", "arc_span": "1.3592 rad"}
    thickness, span = controls_shown(study, study, State(way="optimize", at=at))["variables"]
    assert thickness["text"] == "1.2 mm"
    assert span["unit"] == "°"
    assert span["value"] == pytest.approx(77.8764, abs=1e-4)
    assert span["text"].endswith(" deg")
    assert span["low"] < span["value"] < span["high"]
    at = {"pcl_thickness": "1 mm", "arc_span": "60 deg"}
    shown = controls_shown(study, study, State(way="optimize", at=at))
    assert shown["requirements"][0]["label"] == "diameter"
    assert all(control["label"] and control["group"] for control in [*shown["inputs"], *shown["choices"]])
    assert all(isinstance(control["value"], float) for control in shown["inputs"])


@pytest.mark.parametrize("hardware", ["small", "heavy"])
def test_a_sized_study_takes_the_place_of_the_one_that_is_open(hardware: str) -> None:
    text = study_text(JointTask.read("8 N.m", "1 to 2 N.m/rad", "90 mm", "60 s", "24 V, 3 A"), hardware)
    base = tree_of_text(SMALL, "small.yaml", "small", Path())
    sized, alone = read_tree(tree_of(base, sized_state(base, text))), read_study_text(text)
    assert sized.model_dump() == {**alone.model_dump(), "name": sized.name}
