"""Controls of the explorer: each value in its quantity's own unit, with a label and a group."""

import pytest

from tvimdesign.explore.states.state import State, controls_shown
from tvimdesign.study import read_study_text

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
