"""The PCL as hinges and springs: as stiff at every frequency, and as relaxed after a hold, as it is in closed form."""

import numpy as np
import pytest
from robot_models import model_of

from tvimdesign.physics.motions.motion import Modes
from tvimdesign.report.robot.joint_state import JointState
from tvimdesign.report.robot.maxwell_hinges import held_angles, maxwell_hinges, without_spring

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
