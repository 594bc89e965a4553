"""Conditions of a comparison: each difference is reported with both places."""

from pathlib import Path

import pytest
from comparable import COMPRESSION, SHEAR, entrants

from tvimdesign.study import StudyError
from tvimdesign.study.conditions import refuse_unequal


def problems_of(folder: Path, *texts: str) -> list[str]:
    try:
        refuse_unequal(entrants(folder, *texts))
    except StudyError as error:
        return [str(problem) for problem in error.problems]
    return []


def test_two_modes_with_one_task_can_be_compared(tmp_path: Path) -> None:
    assert problems_of(tmp_path, SHEAR, COMPRESSION) == []
    own = "  spring_material: stainless_302\n  floor_thickness: 5 mm\n  leg_model: ignored\n  current: 1.5 A"
    assert problems_of(tmp_path, SHEAR, SHEAR.replace("  current: 1.5 A", own)) == []
    strain = SHEAR.replace("require:", 'require:\n  layer_strain: "<= 4"')
    blocks = COMPRESSION.replace("require:", 'require:\n  block_strain: "<= 0.45"')
    assert problems_of(tmp_path, strain, blocks) == []
    assert "layer_strain <= 4 is required here" in problems_of(tmp_path, SHEAR, strain)[0]


@pytest.mark.parametrize(
    ("old", "new", "place", "words"),
    [
        ("  current: 1.5 A", "  current: 2 A", "4:3: module.current", "2 A here, 1.5 A in"),
        ("  current", "  ambient_temperature: 30 degC\n  current", "4:3: module.ambient_temperature",
         "30 °C here, 22 °C in"),
        ("  current: 1.5 A", "  structure_material: aluminum_6061_t6\n  current: 1.5 A", "module.structure_material",
         "aluminum_6061_t6 here, petg in"),
        ("  current", "  peltier_seebeck: 0.04 V/K\n  current", "module.peltier_seebeck", "0.04 V/K here"),
        ("response_criterion: softening", "response_criterion: mean", "module.response_criterion", "mean here"),
        ("{temperature: 100 degC", "{temperature: 90 degC", "operating_points.hot.temperature",
         "90 °C here, 100 °C in"),
        ("  hot:", "  warm: {temperature: 60 degC, frequency: 1 Hz}\n  hot:", "operating_points",
         "there is no operating point warm here"),
        ('holding_torque: ">= 5 N.m"', 'holding_torque: ">= 6 N.m"', "require.holding_torque",
         "holding_torque >= 6 N·m here, holding_torque >= 5 N·m in"),
        ('  holding_torque: ">= 5 N.m"\n', "", "require", "holding_torque >= 5 N·m is not required here"),
        ("require:", 'require:\n  module_mass: "<= 1 kg"', "require.module_mass", "is required here, and not in"),
        ("module_mass: 1,", "module_mass: 2,", "minimize", "the objective is module_mass 2, response_time 1 here"),
        ("solver: {starts: 1}", "solver: {starts: 1, cells: 20}", "solver.cells", "20 here, 28 in"),
        ("solver: {starts: 1}", "solver: {starts: 1}\ntolerances: standard\nrobust: {sigma: 2}", "robust",
         "limits are satisfied by 2 standard deviations here, limits are satisfied by 0 standard deviations in"),
    ],
)  # fmt: skip
def test_a_different_task_or_condition_is_reported_with_both_places(
    tmp_path: Path, old: str, new: str, place: str, words: str
) -> None:
    assert old in COMPRESSION
    reported = problems_of(tmp_path, SHEAR, COMPRESSION.replace(old, new))
    assert len(reported) == 1
    assert place in reported[0]
    assert words in reported[0]
    assert reported[0].count("study_0.yaml:") + reported[0].count("study_1.yaml:") == 2


def test_ranges_and_limits_are_compared_with_their_places(tmp_path: Path) -> None:
    ranged = COMPRESSION.replace("vary:", "vary:\n  current: [1 A, 2 A]")
    reported = problems_of(tmp_path, SHEAR, ranged)
    assert len(reported) == 1
    assert "vary.current: 1 A to 2 A, drawn with 1.5 A here, 1.5 A in" in reported[0]
    assert problems_of(tmp_path, SHEAR.replace("vary:", "vary:\n  current: [1 A, 2 A]"), ranged) == []
    other = COMPRESSION.replace("current: 1.5 A", "current: 2 A").replace(">= 5 N.m/rad", ">= 4 N.m/rad")
    reported = problems_of(tmp_path, SHEAR, other)
    assert ["module.current" in reported[0], "require.spring_stiffness" in reported[1]] == [True, True]
    assert len(reported) == 2
    strict = COMPRESSION.replace("require:", 'require:\n  block_strain: "<= 0.4"')
    reported = problems_of(tmp_path, SHEAR, COMPRESSION, strict)
    assert len(reported) == 1
    assert "study_2.yaml" in reported[0]
    assert "block_strain <= 0.4 is required here" in reported[0]


def test_another_record_or_an_evaluated_study_is_one_difference(tmp_path: Path) -> None:
    start, end = COMPRESSION.index("vary:"), COMPRESSION.index("require:")
    drawn = (COMPRESSION[:start] + COMPRESSION[end:]).replace("minimize: {module_mass: 1, response_time: 1}\n", "")
    reported = problems_of(tmp_path, SHEAR, drawn)
    assert len(reported) == 1
    assert "vary: missing: this study is evaluated only" in reported[0]
    item = entrants(tmp_path, SHEAR)
    with pytest.raises(StudyError, match=r"study_0\.yaml: given twice"):
        refuse_unequal([*item, *item])
