"""The pair calibrated to the paper's 70 and 140 s: it takes them, differs by geometry alone, and proves nothing."""

import pytest

from tvimdesign.report.paper import paper_case
from tvimdesign.study import given, read_study_text

STATED = (70.0, 140.0)  # the paper, Discussion
OF_ONE_MODE = {"coil_diameter", "coil_count", "pcl_inner_radius", "pcl_outer_radius", "rotor_rim"}
"""Inputs of both modes that belong to the geometry of one: room for its PCL, and for springs beside that."""


def test_the_pair_takes_the_paper_s_times() -> None:
    assert [times["mean_time"] for times in paper_case.pair_times()] == pytest.approx(STATED, rel=0.01)


def test_both_modules_differ_by_geometry_alone() -> None:
    shear, compression = (given(read_study_text(text)) for text in paper_case.case()["studies"].values())
    different = {name for name in shear.keys() & compression.keys() if shear[name] != compression[name]}
    assert different == OF_ONE_MODE


def test_the_ratio_can_turn_round() -> None:
    metal = paper_case.pair_times(structure_material=paper_case.case()["material"])
    # A metal rotor takes the shear layer's heat, and hardly the blocks'.
    assert metal[1]["mean_time"] < metal[0]["mean_time"]
    near, far = ([times[f"{place}_face_time"] for times in paper_case.pair_times()] for place in ("near", "far"))
    assert near[1] < 1.1 * near[0]  # heat that has just entered does not know how deep the PCL is
    assert far[1] > 2.0 * far[0]
