"""Studies of results, and conditions between their inputs."""

import json
from pathlib import Path

import numpy as np
import pytest
from cad_designs import shipped_design
from comparable import COMPRESSION, SHEAR, cases
from support import ROOT, refused, sample_text

from tvimdesign.base.units import parse_quantity
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.solve.result import answer
from tvimdesign.study import Study, StudyError, read_study_text
from tvimdesign.study.conditions import refuse_unequal
from tvimdesign.study.design import Design
from tvimdesign.study.study import Options, Range, Robust, Tolerance
from tvimdesign.study.text.values import exactly
from tvimdesign.study.written_studies import evaluating, study_text

SEARCHED = sample_text("searched_result")


def values_of(folder: Path) -> dict[str, float | str]:
    result: dict[str, float | str] = json.loads((folder / "design.json").read_text())["values"]
    return result


@pytest.mark.gate
def test_a_result_as_a_study_is_answered_the_same_to_the_last_digit(tvimdesign, tmp_path):
    (tmp_path / "searched.yaml").write_text(SEARCHED)
    words, again = ["--no-cad", "--no-plots", "--out"], tmp_path / "again.yaml"
    first = tvimdesign("run", tmp_path / "searched.yaml", *words, tmp_path / "first")
    assert first.returncode == 0, first.stderr
    assert tvimdesign("new", again, "--from", tmp_path / "first").returncode == 0
    done = tvimdesign("run", again, *words, tmp_path / "second")
    assert done.returncode == 0, done.stderr
    result = values_of(tmp_path / "first")
    assert values_of(tmp_path / "second") == result
    # The list with a zero in it was searched, and what presses on an end of its range is exactly there.
    assert result["hub_depth"] == 0.0
    assert result["current"] == 2.5


SPREAD = {"pcl_thickness": Tolerance(plus_minus=5e-5).model_dump()}


def design(**changes: object) -> Design:
    return shipped_design("paper_shear").model_copy(update=changes)


def test_what_the_module_lacks_is_left_out():
    released = design()
    vary = {
        **released.study["vary"],
        "motor": Options(values=("none", "gl40")).model_dump(),
        "motor_wall": Range(lower=1e-3, upper=2e-3).model_dump(),
    }
    study = evaluating(design(study={**released.study, "vary": vary}))
    assert study.module["motor"] == "none"
    assert "motor_wall" not in study.module
    assert study.module["wire_diameter"] == released.values["wire_diameter"]
    assert study.task == "evaluate"


def test_a_yield_that_was_asked_for_is_still_asked_of_the_result():
    robust = Robust(share=parse_quantity("95 %", "1"), plausible=0.8).model_dump()
    released = design(study={**design().study, "robust": robust, "tolerances": SPREAD})
    text = study_text(evaluating(released), "written", ROOT)
    assert "robust: {yield: 95 %, plausible: 80 %}" in text
    again = read_study_text(text, "again", ROOT)
    assert again.robust is not None
    assert (again.robust.share, again.task) == (pytest.approx(0.95), "evaluate")


@pytest.mark.parametrize("unit", ["mm", "deg", "degC", "MPa", "g/cm^3", "%"])
def test_a_number_is_written_in_the_unit_of_its_quantity_to_the_last_digit(unit):
    for value in np.random.default_rng(1).uniform(200.0, 900.0, 50):
        written = exactly(float(value), unit)
        assert written.endswith(f" {unit}")
        assert parse_quantity(written, unit) == value


def test_a_copied_example_is_named_by_its_file(tvimdesign, tmp_path):
    for file, name in (("mine.yaml", "mine"), ("finger.yaml", "Finger")):
        assert tvimdesign("new", tmp_path / file, "--example", "finger").returncode == 0
        assert f"\nname: {name}\n" in (tmp_path / file).read_text()


PROFILES = {
    "softening": {"moments": [0.0, 0.1, 7.3, 40.0], "currents": [0.0, 1.0 / 3.0, 2.0, 1.2]},
    "stiffening": {"moments": [0.0, 0.1], "currents": [0.0, -0.3]},
}


def test_a_current_profile_becomes_given_currents():
    study = evaluating(design(current_profiles=PROFILES))
    assert {phase: item.model_dump(mode="json") for phase, item in study.currents.items()} == PROFILES
    again = read_study_text(study_text(study, "written", ROOT), "again", ROOT)
    assert again.currents == study.currents  # to the last digit
    assert resolve_study(again).current_profiles["softening"].plain() == PROFILES["softening"]


MODULE = sample_text("given_currents")


def study(currents: str) -> Study:
    return read_study_text(f"{MODULE}currents: {currents}", "given", Path())


@pytest.mark.gate
def test_a_given_current_is_followed_and_a_constant_one_is_the_same():
    """Compare with constant currents, which are inputs of their own: the two ways share only the integrator."""
    flat = "{softening: {moments: [0 s, 5 s], currents: [1.5 A, 1500 mA]},"
    flat += " stiffening: {moments: [0 s, 1 min], currents: [-0.3 A, -0.3 A]}}"
    given = answer(study(flat)).design.values
    constant = answer(read_study_text(MODULE, "constant", Path())).design.values
    assert given["response_time"] == pytest.approx(constant["response_time"], rel=1e-5)
    assert given["stiffening_energy"] == pytest.approx(constant["stiffening_energy"], rel=1e-4)
    # Energy is the integral of power, so twice the current from the middle on heats sooner; none never heats.
    later = answer(study("{softening: {moments: [0 s, 20 s, 21 s], currents: [1.5 A, 1.5 A, 2.5 A]}}")).design
    assert later.values["response_time"] < answer(read_study_text(MODULE, "c", Path())).design.values["response_time"]
    never = answer(study("{softening: {moments: [0 s, 1 s], currents: [0 A, 0 A]}}")).design
    assert never.values["response_time"] == float("inf")
    assert never.current_profiles == {"softening": {"moments": [0.0, 1.0], "currents": [0.0, 0.0]}}


@pytest.mark.gate
def test_tolerate_leaves_out_the_constant_current_that_a_profile_replaces(tvimdesign, tmp_path):
    (tmp_path / "given.yaml").write_text(
        MODULE + "require: {holding_torque: '>= 1 N.m'}\n"
        "currents: {softening: {moments: [0 s, 5 s], currents: [1 A, 1.5 A]}}\n"
    )
    words = ["--out", tmp_path / "spread", "--samples", "256"]
    done = tvimdesign("tolerate", tmp_path / "given.yaml", *words)
    assert done.returncode == 0, done.stderr
    named = (tmp_path / "spread/contributors.csv").read_text()
    assert "pcl_thickness" in named
    assert ",current," not in named


def problems_of(folder: Path, *texts: str) -> list[str]:
    try:
        refuse_unequal(cases(folder, *texts))
    except StudyError as error:
        return [str(problem) for problem in error.problems]
    return []


def test_two_modes_with_one_task_can_be_compared(tmp_path):
    assert problems_of(tmp_path, SHEAR, COMPRESSION) == []
    own = "  spring_material: stainless_302\n  floor_thickness: 5 mm\n  leg_model: ignored\n  current: 1.5 A"
    assert problems_of(tmp_path, SHEAR, SHEAR.replace("  current: 1.5 A", own)) == []
    strain = SHEAR.replace("require:", 'require:\n  layer_strain: "<= 4"')
    blocks = COMPRESSION.replace("require:", 'require:\n  block_strain: "<= 0.45"')
    assert problems_of(tmp_path, strain, blocks) == []
    assert "layer_strain <= 4 is required here" in problems_of(tmp_path, SHEAR, strain)[0]


@pytest.mark.parametrize(("old", "new", "place", "words"), refused("conditions"))
def test_a_different_task_or_condition_is_reported_with_both_places(tmp_path, old, new, place, words):
    assert old in COMPRESSION
    reported = problems_of(tmp_path, SHEAR, COMPRESSION.replace(old, new))
    assert len(reported) == 1
    assert place in reported[0]
    assert words in reported[0]
    assert reported[0].count("study_0.yaml:") + reported[0].count("study_1.yaml:") == 2


def test_ranges_and_limits_are_compared_with_their_places(tmp_path):
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


def test_another_record_or_an_evaluated_study_is_one_difference(tmp_path):
    start, end = COMPRESSION.index("vary:"), COMPRESSION.index("require:")
    drawn = (COMPRESSION[:start] + COMPRESSION[end:]).replace("minimize: {module_mass: 1, response_time: 1}\n", "")
    reported = problems_of(tmp_path, SHEAR, drawn)
    assert len(reported) == 1
    assert "vary: missing: this study is evaluated only" in reported[0]
    item = cases(tmp_path, SHEAR)
    with pytest.raises(StudyError, match=r"study_0\.yaml: given twice"):
        refuse_unequal([*item, *item])
