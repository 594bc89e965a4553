"""MuJoCo lets the link go as `simulate --test release` does, and the PCL's hinges are as stiff as in closed form."""

import re
from functools import cache

import mujoco
import numpy as np
import pytest
from robot_models import model_of, module_of

from tvimdesign.physics.motions.motion import Modes
from tvimdesign.robot.joint_model import JointModel, JointState
from tvimdesign.robot.model_files import held_angles, maxwell_hinges, mjcf, without_spring
from tvimdesign.simulation.joint_tests.release import ANGLE, release
from tvimdesign.simulation.trial import Trial


@cache
def _released(mode: str, angle: float) -> Trial:
    return release(module_of(mode), angle, kelvin_voigt=False)


def _loaded(model: JointModel, point: str) -> mujoco.MjModel:
    """The model of an operating point without its meshes, which are not made here."""
    state = next(one for one in model.states if one.point == point)
    return mujoco.MjModel.from_xml_string(re.sub(r"<(mesh|geom) [^>]*>", "", mjcf(model, state)))


SHARE = 0.01
"""Of the angle it is released from, which MuJoCo may be off."""
SMALL = 5e-3
"""Angle [rad] at which a frozen layer bears its torque: from that of the virtual test it slips, in MuJoCo it cannot."""


@pytest.mark.parametrize(
    ("mode", "point", "step", "seconds", "angle"),
    [
        ("shear", "cold", None, 0.04, SMALL),
        ("shear", "hot", None, 0.04, ANGLE),
        ("shear", "hot", 1e-4, 2.0, ANGLE),
        ("compression", "hot", 1e-4, 2.0, ANGLE),
        pytest.param("compression", "cold", None, 0.04, ANGLE, marks=pytest.mark.slow),
        pytest.param("compression", "hot", None, 0.04, ANGLE, marks=pytest.mark.slow),
    ],
)
def test_the_link_let_go_moves_as_in_the_virtual_test(
    mode: str, point: str, step: float | None, seconds: float, angle: float
) -> None:
    model = model_of(mode, step)
    loaded = _loaded(model, point)
    data = mujoco.MjData(loaded)
    mujoco.mj_resetDataKeyframe(loaded, data, 0)
    data.qpos *= angle / data.joint("joint").qpos[0]  # all that is held is in proportion to the angle
    angles = [data.joint("joint").qpos[0]]
    for _ in range(int(seconds / model.step)):
        mujoco.mj_step(loaded, data)
        angles.append(data.joint("joint").qpos[0])
    sheet = next(
        one for one in _released(mode, angle).sheets if one.name in {f"release_{point}", f"release_{point}_nominal"}
    )
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


MODES: Modes = [(40.0, 3.0), (0.2, 120.0), (1e-3, 55.0)]


def _stiffness(modes: Modes, omega: np.ndarray) -> np.ndarray:
    times, stiffnesses = np.array(modes).T
    turns = 1j * omega[:, None] * times
    return np.sum(stiffnesses * turns / (1.0 + turns), axis=1)


def test_elements_come_back_with_the_spring_and_quick_ones_are_damping() -> None:
    omega, spring = np.geomspace(1e-3, 1e5, 33), 700.0
    rest = without_spring(MODES, spring)
    np.testing.assert_allclose(
        1.0 / (1.0 / _stiffness(rest, omega) + 1.0 / spring), _stiffness(MODES, omega), rtol=1e-9
    )
    made = maxwell_hinges(_state(False), 5, step=1e-3)
    assert made.merged == 1
    assert made.damping == pytest.approx(1e-3 * 55.0)
    assert [spring.stiffness for spring in made.springs] == [3.0, 120.0, 0.0, 0.0, 0.0]


def _state(one_sided: bool) -> JointState:
    return JointState(
        point="hot", temperature=373.15, frequency=1.0, stiffness=1.0, damping=1.0, springs=5.0, friction=0.0,
        inertia=4e-4, one_sided=one_sided, hold=0.5, modes=MODES,
    )  # fmt: skip


@pytest.mark.parametrize("one_sided", [False, True])
def test_after_a_hold_the_torque_is_what_has_not_relaxed(one_sided: bool) -> None:
    state, angle = _state(one_sided), 0.1
    made = maxwell_hinges(state, len(MODES), step=1e-5)
    angles = held_angles(state, made, angle)
    torque = 0.0
    for spring in made.springs:
        turned = sum(part * angles[name] for name, part in spring.coefficients.items())
        if "joint" in spring.coefficients and not (spring.pushes and turned < 0.0):
            torque += spring.stiffness * turned * spring.coefficients["joint"]
    expected = sum(k * angle * np.exp(-state.hold / tau) for tau, k in MODES)
    assert torque == pytest.approx(expected, rel=1e-9)


def test_all_states_have_the_same_hinges(mode: str) -> None:
    model = model_of(mode)
    names = [[hinge.name for hinge in maxwell_hinges(state, model.count, model.step).hinges] for state in model.states]
    assert all(one == names[0] for one in names)
