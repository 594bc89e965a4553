"""MuJoCo takes the MJCF, and lets the link go as `simulate --test release` does."""

import re
from functools import cache

import mujoco
import numpy as np
import pytest
from robot_models import model_of, module_of

from tvimdesign.report.robot.joint_model import JointModel
from tvimdesign.report.robot.model_files import mjcf
from tvimdesign.simulation.joint_tests.release import release
from tvimdesign.simulation.trial import Trial


@cache
def _released(mode: str) -> Trial:
    return release(module_of(mode), kelvin_voigt=False)


def _loaded(model: JointModel, point: str) -> mujoco.MjModel:
    """The model of an operating point without its meshes, which are not made here."""
    state = next(one for one in model.states if one.point == point)
    return mujoco.MjModel.from_xml_string(re.sub(r"<(mesh|geom) [^>]*>", "", mjcf(model, state)))


SHARE = 0.01
"""Of the angle it is released from, which MuJoCo may be off."""


@pytest.mark.parametrize(
    ("mode", "point", "step", "seconds"),
    [
        ("shear", "cold", None, 0.04),
        ("shear", "hot", None, 0.04),
        ("shear", "hot", 1e-4, 2.0),
        ("compression", "hot", 1e-4, 2.0),
        pytest.param("compression", "cold", None, 0.04, marks=pytest.mark.slow),
        pytest.param("compression", "hot", None, 0.04, marks=pytest.mark.slow),
    ],
)
def test_the_link_let_go_moves_as_in_the_virtual_test(
    mode: str, point: str, step: float | None, seconds: float
) -> None:
    model = model_of(mode, step)
    loaded = _loaded(model, point)
    data = mujoco.MjData(loaded)
    mujoco.mj_resetDataKeyframe(loaded, data, 0)
    angles = [data.joint("joint").qpos[0]]
    for _ in range(int(seconds / model.step)):
        mujoco.mj_step(loaded, data)
        angles.append(data.joint("joint").qpos[0])
    sheet = next(one for one in _released(mode).sheets if one.name in {f"release_{point}", f"release_{point}_nominal"})
    times, expected = sheet.column("time").values, sheet.column("angle").values
    seen = times < seconds
    found = np.interp(times[seen], model.step * np.arange(len(angles)), angles)
    assert np.max(np.abs(found - expected[seen])) < SHARE * expected[0]


def test_inertia_limits_friction_and_springs_are_the_module_s(mode: str) -> None:
    loaded = _loaded(model_of(mode), "cold")
    data = mujoco.MjData(loaded)
    mujoco.mj_forward(loaded, data)
    torques = np.zeros(loaded.nv)
    mujoco.mj_mulM(loaded, data, torques, np.eye(loaded.nv)[0])
    assert torques[0] == pytest.approx(float(module_of(mode).quantity("moving_inertia")), rel=1e-6)
    loaded, resolved = _loaded(model_of(mode), "hot"), module_of(mode)
    joint = loaded.joint("joint")
    stop = float(resolved.quantity("stop_angle"))
    assert joint.range == pytest.approx([-stop, stop])
    assert joint.stiffness[0] == pytest.approx(float(resolved.quantity("spring_stiffness")))
    assert joint.frictionloss[0] == pytest.approx(float(resolved.quantity("pin_friction_torque")))
