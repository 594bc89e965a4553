"""`size`: a study from five numbers, for a joint of 20 to 200 mm, and what it reports if none fits."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import cache

import pytest
from support import refused

from tvimdesign.base.errors import InfeasibleError, InputError
from tvimdesign.report.output.numbers import label
from tvimdesign.report.run import study_files
from tvimdesign.report.run.study_files import no_room, process_of, refusal, sized_text
from tvimdesign.solve import sized_joint
from tvimdesign.solve.infeasibility.early_checks import refuse_what_cannot_be
from tvimdesign.solve.sized_joint import nearest, sized_texts
from tvimdesign.study import Range, Study, read_study_text
from tvimdesign.study.sizing import JointTask, diameters, in_options, study_text

WRIST = {"torque": "8 N.m", "stiffness": "1.5 N.m/rad", "diameter": "70 mm", "time": "60 s", "supply": "24 V, 3 A"}


@cache
def sized(**numbers: str) -> Study:
    """Return the study of the wrist with other numbers."""
    return read_study_text(sized_text(JointTask.read(**WRIST | numbers), "joint"), "joint.yaml")


@pytest.mark.gate
@pytest.mark.parametrize(
    ("diameter", "torque", "stiffness"),
    [
        (70, 8, 1.5),
        *(pytest.param(*row, marks=pytest.mark.gate)
          for row in ((20, 0.05, 0.012), (30, 0.2, 0.08), (40, 0.5, 0.2), (58, 1.2, 0.5), (66, 3, 1), (80, 10, 2),
                      (90, 15, 2.5), (110, 35, 5), (140, 60, 12), (170, 90, 20), (200, 150, 40))),
    ],
)  # fmt: skip
def test_a_joint_of_each_size_has_hardware_that_fits(diameter, torque, stiffness):
    study = sized(diameter=f"{diameter} mm", torque=f"{torque} N.m", stiffness=f"{stiffness} N.m/rad")
    refuse_what_cannot_be(study)
    vary = study.vary["placement_radius"]
    assert isinstance(vary, Range)
    assert vary.lower < vary.start < 0.5 * diameter / 1000.0
    limits = {(limit.output, limit.sense): limit.limit for limit in study.require}
    assert limits["holding_torque", ">="] == torque
    assert limits["joint_stiffness@hot", "<="] == pytest.approx(1.2 * stiffness)


def test_a_stroke_moves_the_preload_and_is_named_as_assumed_if_not_given():
    task = JointTask.read(**WRIST, stroke="9 deg")
    wide = study_text(task, "middle")
    assert "stroke: 0.1571 rad  # to either side of rest\n" in wide
    preload = read_study_text(wide, "joint.yaml").vary["preload_angle"]
    assert isinstance(preload, Range)
    assert preload.lower == pytest.approx(1.15 * task.stroke, rel=5e-3)
    assert task.stroke < preload.start < preload.upper
    assert "assumed, as --stroke was not given" in study_text(JointTask.read(**WRIST), "middle")


def test_a_study_names_what_gives_room_for_the_assumed_values():
    task = JointTask.read(**WRIST)
    line = study_text(replace(task, cautious=True), "middle").splitlines()[1]
    assert line.startswith("# Room for assumed values: minimum_feature, slip_clearance, ")
    assert line.endswith(", softening_band, plausible.")
    assert study_text(task, "middle").splitlines()[1].startswith("# No room for assumed values")


def test_a_study_without_room_follows_one_with_room():
    task = JointTask.read(**WRIST)
    with_room, without = (study_text(replace(task, cautious=cautious), "middle") for cautious in (True, False))
    assert list(sized_texts(lambda room: with_room if room else without)) == [(with_room, True), (without, False)]
    assert list(sized_texts(lambda _: without)) == [(without, False)]


def test_a_study_without_room_names_a_diameter_that_has_some(monkeypatch):
    task = JointTask.read(**WRIST)
    roomy = replace(task, diameter=0.084)
    monkeypatch.setattr(sized_joint, "_wider", lambda joint: (roomy, None) if joint.cautious else 0)
    note = no_room(task, lambda _: None)
    assert "; --diameter '84 mm' leaves room for most of them, by estimate: for each limit alone" in note
    study = read_study_text(study_files.described(study_text(task, "middle"), note), "joint.yaml")
    assert study.description.lower() == f"{note}."
    monkeypatch.setattr(sized_joint, "_wider", lambda _: (None, None))
    assert "; no larger --diameter leaves room" in no_room(task, lambda _: None)


def test_a_stroke_that_no_hardware_bears_is_refused_before_the_search(monkeypatch):
    steps: list[str] = []
    monkeypatch.setattr(sized_joint, "_wider", lambda _: (None, None))
    with pytest.raises(InfeasibleError, match=r"±1[12].*° is the largest stroke that .* allow") as refusal:
        sized_text(JointTask.read(**WRIST, stroke="20 deg"), "joint", steps.append)
    (largest,) = map(float, re.findall(r"±(1[12].*?)° is the largest", str(refusal.value)))
    (advised,) = map(float, re.findall(r"--stroke '(.*) deg'", str(refusal.value)))
    assert 9.0 < advised < largest  # with margins for tolerances
    assert sized_text(JointTask.read(**WRIST, stroke=f"{advised} deg"), "joint")
    assert not any("choosing" in step for step in steps)


def test_what_no_number_alone_cures_is_cured_by_several(monkeypatch):
    """Name half the usual torque of 100 mm, 8 N*m (100/70)^3 = 23 N*m, and an eighth of it as stiffness."""
    task = JointTask.read(**WRIST | {"diameter": "100 mm", "torque": "500 N.m"})
    for alone in ("_other_stiffness", "_less"):
        monkeypatch.setattr(sized_joint, alone, lambda _: None)
    monkeypatch.setattr(sized_joint, "_wider", lambda _: (None, None))
    for fits, words in (12.0, "--torque '11 N.m' --stiffness '1.3 N.m/rad'"), (0.0, "down to 10 % of the torque usual"):
        monkeypatch.setattr(sized_joint, "_hardware", lambda joint, most=fits: "large" if joint.torque < most else "")
        assert words in refusal(task, "joint", nearest(task, "joint", math.inf, lambda _: None))


@pytest.mark.gate
def test_a_range_of_stiffness_and_the_supply_are_taken_as_written():
    study = sized(stiffness="1 to 1.5 N.m/rad", supply="12 V, 2 A", diameter="76 mm")
    limits = {(limit.output, limit.sense): limit.limit for limit in study.require}
    assert [limits["joint_stiffness@hot", sense] for sense in (">=", "<=")] == [1.0, 1.5]
    assert (limits["peak_voltage", "<="], limits["peak_current", "<="]) == (12.0, 2.0)
    assert study.module["heater_module"] == "polyimide_foil_12v"


def test_a_supply_without_a_current_leaves_the_heater_s_rating():
    task = JointTask.read(**WRIST | {"supply": "24 V"})
    assert task.options()["supply"] == "24 V"
    study = read_study_text(study_text(task, "middle"), "joint.yaml")
    assert {"peak_voltage", "current_margin"} <= {limit.output for limit in study.require}
    assert "peak_current" not in {limit.output for limit in study.require}
    current = study.vary["current"]
    assert isinstance(current, Range)
    assert current.upper == pytest.approx(0.9375, rel=1e-3)  # amperes, a quarter of the way from 0.75 to 1.5


def test_the_time_to_stiffen_is_required_where_it_is_asked():
    quick, usual = (
        read_study_text(study_text(JointTask.read(**WRIST, **more), "middle"), "joint.yaml")
        for more in ({"stiff_time": "5 min"}, {})
    )
    limits = {limit.output: limit.limit for limit in quick.require}
    assert (limits["stiffening_time"], limits["response_time"]) == (300.0, 60.0)
    assert "stiffening_time" not in {limit.output for limit in usual.require}


@pytest.mark.slow
@pytest.mark.parametrize("numbers", [{"diameter": "66 mm"}, {"torque": "10 N.m"}])
def test_a_joint_that_is_too_small_names_a_diameter_that_is_not(numbers):
    with pytest.raises(InfeasibleError, match="fit by arithmetic, with margins by estimate") as refusal:
        sized(**numbers)
    enough = re.search(r"--diameter '(\d+) mm'", str(refusal.value))
    assert enough
    assert int(enough[1]) <= 74
    refuse_what_cannot_be(sized(**numbers | {"diameter": f"{enough[1]} mm"}))


@pytest.mark.slow
def test_a_small_joint_that_is_too_small_names_the_least_diameter():
    small = {"diameter": "20 mm", "torque": "0.2 N.m", "stiffness": "0.08 N.m/rad"}
    with pytest.raises(InfeasibleError, match=r"2\d(\.\d)? mm is the least that .* allow") as refusal:
        sized(**small)
    enough = re.search(r"--diameter '(\d+) mm'", str(refusal.value))
    assert enough
    assert 25 <= int(enough[1]) <= 30
    refuse_what_cannot_be(sized(**small | {"diameter": f"{enough[1]} mm"}))


@pytest.mark.parametrize("hardware", diameters())
def test_a_set_s_own_values_replace_shared_ones(hardware):
    text = study_text(replace(JointTask.read(**WRIST), diameter=diameters()[hardware]), hardware)
    module = re.findall(r"(?m)^  (\w+):", text.partition("\nvary:")[0])
    assert len(module) == len(set(module))
    assert read_study_text(text, "joint.yaml").module["process"] == (
        "sla_fine" if hardware in ("micro", "tiny", "mini") else "print_pc_bambu"
    )


@pytest.mark.parametrize("hardware", ["mini", "middle"])
def test_the_process_is_the_one_asked_for(hardware):
    task = JointTask.read(**WRIST, process="print_pa6_cf")
    study = read_study_text(study_text(replace(task, diameter=diameters()[hardware]), hardware), "joint.yaml")
    assert study.module["process"] == task.options()["process"] == "print_pa6_cf"


@pytest.mark.parametrize("hardware", ["small", "middle", "heavy"])
def test_milled_parts_have_a_liner_a_cutter_and_a_heater_below_spreaders(hardware):
    task = JointTask.read(**WRIST, process="machine_6061")
    study = read_study_text(study_text(replace(task, diameter=diameters()[hardware]), hardware), "joint.yaml")
    module = {"process": "machine_6061", "liner_material": "pei_1010", "heater_module": "ma10_063_05_1"}
    assert module.items() <= study.module.items()
    assert study.module["floor_thickness"] == pytest.approx(6.5e-3)
    assert study.module["spreader_thickness"] == pytest.approx(0.5e-3)  # a sheet as it is sold
    assert "liner_thickness" in study.vary
    assert not {"floor_thickness", "spreader_thickness"} & set(study.vary)
    assert study.tolerances["pcl_thickness"].plus_minus == pytest.approx(5e-5)


def test_the_process_is_named_with_its_reason():
    text = study_text(JointTask.read(**WRIST), "middle")
    assert process_of(text).startswith("made by print_pc_bambu: polycarbonate bears the heat, ")
    assert process_of(study_text(JointTask.read(**WRIST, process="print_peek"), "middle")) == "made by print_peek"


def test_a_refusal_names_the_options_of_size():
    text = "Lost to\n  response_time <= 60 s\nOther sizes do if diameter <= 72.1 mm or\n joint_stiffness@hot >= 1 N.m"
    reported = "Lost to\n  --time <= 60 s\nOther sizes do if --diameter <= 72.1 mm or\n --stiffness >= 1 N.m"
    assert in_options(text, label) == reported
    others = "inner diameter <= 2 mm, layer_response_time <= 3 s"
    assert in_options(others, label) == others


@pytest.mark.parametrize(("numbers", "message"), refused("sizes"))
def test_a_number_that_is_none_is_named(numbers, message):
    with pytest.raises(InputError, match=message):
        JointTask.read(**WRIST | numbers)


def test_options_that_are_missing_or_no_number_are_named_at_once(tvimdesign):
    done = tvimdesign("size", "--torque", "8", "--stiffness", "1.5", "--supply", "24 V", "--time", "60 s")
    assert done.returncode == 2
    named = [line.partition(":")[0] for line in done.stderr.splitlines()]
    assert named == ["stiffness", "torque", "diameter"]
    assert "diameter: missing; write for instance '70 mm'" in done.stderr


@pytest.mark.slow
def test_a_set_of_hardware_with_another_record_is_tried():
    study = sized(torque="9 N.m")  # within the set's wave spring the core bears less
    assert study.module["axial_preload"] == "wave_19_8x20_8"
    refuse_what_cannot_be(study)


def test_a_study_that_is_there_is_left_alone(tvimdesign, tmp_path):
    file = tmp_path / "joint.yaml"
    file.write_text("mine")
    options = [part for name, value in WRIST.items() for part in (f"--{name}", value)]
    done = tvimdesign("size", *options, "--study", file)
    assert done.returncode == 2
    assert "exists already" in done.stderr
    assert file.read_text() == "mine"
