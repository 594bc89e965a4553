"""The section `task`: its values reach the module, its limits the requirements, its trajectory the table."""

import numpy as np
import pytest
import yaml
from support import ROOT, cases_of, study_path

from tvimdesign.device import table_for
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.study import given
from tvimdesign.study.reader import read_study_text
from tvimdesign.study.sections import written
from tvimdesign.study.text.mistakes import StudyError

STUDY = study_path("paper_shear").read_text()
TASK = {
    "payload": "3 kg", "arm_mass": "0.6 kg", "arm_length": "0.2 m", "allowed_sag": "5 mm", "allowed_force": "60 N",
    "allowed_hic": 700,
    "gravity_angle": "90 deg",
    "trajectory": {"moments": ["0 s", "1 s"], "angles": ["0 deg", "90 deg"]},
}  # fmt: skip


def _text(task: dict[str, object]) -> str:
    return f"{STUDY}\n{yaml.safe_dump({'task': task})}"


def test_a_task_is_read_written_and_evaluated():
    study = read_study_text(_text(TASK))
    assert study.module["payload"] == 3.0
    limits = {limit.output: limit.limit for limit in study.require}
    assert limits["sag@cold"] == 0.005
    assert limits["impact_force@cold"] == 60.0
    assert limits["head_injury@cold"] == 700.0
    again = read_study_text(yaml.safe_dump(written(study), allow_unicode=True))
    assert again.module == study.module
    assert again.trajectory == study.trajectory
    values = table_for("shear").evaluate(given(study), ["pose_torque", "trajectory_torque@cold", "task_inertia"])
    # m g L of the payload, and of the uniform bar half of it.
    assert values["pose_torque"] == pytest.approx(9.80665 * 0.2 * 3.3, rel=1e-9)
    # A cubic between rest and rest begins with 6 angle/time^2, at once, so that the stiff joint overshoots up to twice
    # that; there the arm is horizontal, and gravity adds to it.
    inertial = 6.0 * np.pi / 2.0 * values["task_inertia"]
    beyond = (values["trajectory_torque@cold"] - values["pose_torque"]) / inertial
    assert 1.7 < beyond < 2.0


def test_a_csv_is_a_trajectory_and_what_is_none_is_refused(tmp_path):
    (tmp_path / "gait.csv").write_text("time,angle\n0,0\n0.5,0.3\n1,0\n")
    study = read_study_text(_text({**TASK, "trajectory": "gait.csv"}), folder=tmp_path)
    assert study.trajectory.angles == (0.0, 0.3, 0.0)
    (tmp_path / "gait.csv").write_text("time,angle\n0,0\n0.5\n")
    for trajectory, words in (
        ("gait.csv", "needs a heading"), ("none.csv", "cannot be read"),
        ({"moments": ["1 s", "0 s"], "angles": ["0 rad", "1 rad"]}, "do not rise"),
    ):  # fmt: skip
        with pytest.raises(StudyError, match=words):
            read_study_text(_text({**TASK, "trajectory": trajectory}), folder=tmp_path)


def test_a_margin_is_limited_by_each_part_that_holds():
    study = read_study_text(_text({**TASK, "payload": "1 kg"}))
    table, chosen = study.table, given(study)
    whole = table.output("task_torque_margin")
    parts = [name for name in whole.least_of if table.output(name).exists(chosen)]
    values = table.evaluate(chosen, [whole.name, *parts])
    assert values[whole.name] == min(values[name] for name in parts)
    limited = {limit.output for limit in constraints_of(study, table, chosen)}
    assert limited.issuperset(parts)
    assert whole.name not in limited


URDF = (ROOT / "tests/studies/texts/arm.urdf").read_text()


def test_an_arm_of_a_urdf_is_that_of_mujoco(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(URDF)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    inertia = np.zeros(model.nv)
    mujoco.mj_mulM(model, data, inertia, np.eye(model.nv)[0])
    # Gravity across the axis: its moment is largest where the centre of mass is beside the axis.
    axis = np.array([0.1, 0.9, 0.2]) / np.linalg.norm([0.1, 0.9, 0.2])
    model.opt.gravity[:] = 9.80665 * np.cross(axis, [1.0, 0.0, 0.0]) / np.linalg.norm(np.cross(axis, [1.0, 0.0, 0.0]))
    moments = []
    for data.qpos[0] in np.linspace(0.0, 2.0 * np.pi, 721):
        mujoco.mj_forward(model, data)
        moments.append(data.qfrc_bias[0])
    (tmp_path / "arm.urdf").write_text(URDF)
    study = read_study_text(_text({"urdf": "arm.urdf", "joint": "elbow", "payload": "1 kg"}), folder=tmp_path)
    length, mass, centre, share = (
        study.module[name] for name in ("arm_length", "arm_mass", "arm_centre_share", "arm_inertia_share")
    )
    assert share * mass * length**2 == pytest.approx(inertia[0], rel=1e-9)
    assert 9.80665 * mass * centre * length == pytest.approx(np.max(moments), rel=1e-4)
    assert mass == pytest.approx(1.1)
    assert study.module["payload"] == 1.0
    longer = read_study_text(
        _text({"urdf": "arm.urdf", "joint": "elbow", "arm_length": "0.5 m", "arm_mass": "2 kg"}), folder=tmp_path
    )
    assert longer.module["arm_centre_share"] * 0.5 == pytest.approx(centre * length)
    assert longer.module["arm_mass"] == 2.0


@cases_of("task", "wrong_arms")
def test_a_urdf_without_an_arm_is_refused(task, old, new, words, tmp_path):
    assert old in URDF
    (tmp_path / "arm.urdf").write_text(URDF.replace(old, new) if old else URDF)
    with pytest.raises(StudyError, match=words):
        read_study_text(_text(task), folder=tmp_path)
