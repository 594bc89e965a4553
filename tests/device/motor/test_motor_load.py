"""The motor's torque, heat and speed in a task, against an arm on a spring that is turned alike."""

import re
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from support import study_path

from tvimdesign.solve.result import answer
from tvimdesign.study.reader import read_study_text

MOMENTS, ANGLES = [0.0, 0.25, 0.5], np.radians([0.0, 20.0, 40.0])
LENGTH, ARM, PAYLOAD, GRAVITY = 0.1, 0.1, 0.2, 9.80665
TASK = """task:
  arm_length: 100 mm
  arm_mass: 100 g
  arm_centre_share: 0.5
  arm_inertia_share: 0.25
  payload: 200 g
  pose_angle: 60 deg
  gravity_angle: 90 deg
  trajectory: {moments: [0 s, 0.25 s, 0.5 s], angles: [0 deg, 20 deg, 40 deg]}
"""
SINE = """  sine_amplitude: 0.1 rad
  sine_from: 0.5 Hz
  sine_to: 2 Hz
"""


@cache
def _values(motor: str, more: str = "") -> dict[str, float]:
    text = study_path("driven_joint").read_text(encoding="utf-8")
    head, _, tail = text.partition("vary:\n")
    points = tail[tail.index("operating_points:") : tail.index("tolerances:")]
    text = head.replace("frameless_70x10", motor) + TASK + more + points
    return answer(read_study_text(text)).design.values


@pytest.mark.gate
def test_its_torque_is_that_of_an_arm_on_a_spring():
    values = _values("frameless_70x10")
    spline = CubicSpline(MOMENTS, ANGLES, bc_type="clamped")
    link = ARM * 0.25 * LENGTH**2 + PAYLOAD * LENGTH**2 + values["parts_inertia"]
    stiffness = values["joint_stiffness@cold"]

    def swing(time: float, state: np.ndarray) -> list[float]:
        return [state[1], -spline(time, 2) - stiffness / link * state[0]]

    times = np.linspace(0.0, 0.5, 5001)
    swung = solve_ivp(swing, (0.0, 0.5), [0.0, 0.0], t_eval=times, rtol=1e-9, atol=1e-12, max_step=1e-4)
    moment = GRAVITY * LENGTH * (0.5 * ARM + PAYLOAD) * np.sin(0.5 * np.pi + spline(times))
    torque = values["driven_inertia"] * spline(times, 2) - stiffness * swung.y[0] + moment
    # The layer damps what rings on a spring. The pose takes half as much.
    assert values["motor_torque@cold"] == pytest.approx(np.max(np.abs(torque)), rel=0.03)
    assert values["motor_rms_torque@cold"] == pytest.approx(np.sqrt(np.mean(torque**2)), rel=0.01)
    assert values["task_speed"] == pytest.approx(np.max(spline(times, 1)), rel=1e-3)


def test_its_heat_is_that_of_three_phases():
    values = _values("frameless_70x10")
    # A star of 0.235 ohm a phase; 0.109 N.m for an ampere of each phase's rms current.
    phase = values["motor_rms_torque@cold"] / 0.109
    assert values["motor_heat@cold"] == pytest.approx(3.0 * 0.235 * phase**2, rel=1e-9)
    assert values["motor_current@cold"] == pytest.approx(values["motor_torque@cold"] / 0.109)


def test_a_sine_adds_its_amplitudes():
    alone, swinging = _values("frameless_70x10"), _values("frameless_70x10", SINE)
    # A rigid link and all that the motor turns, at 2 Hz.
    link = swinging["task_inertia"] + swinging["driven_inertia"]
    added = link * 0.1 * (2.0 * np.pi * 2.0) ** 2
    assert swinging["motor_torque@cold"] == pytest.approx(
        max(alone["motor_torque@cold"], swinging["pose_torque"] + added), rel=0.02
    )


@pytest.mark.gate
@pytest.mark.parametrize(("motor", "bears"), [("frameless_50x08", False), ("frameless_85x13", True)])
def test_a_small_motor_does_not_bear_the_task(motor, *, bears):
    values = _values(motor, SINE.replace("0.1 rad", "1 rad"))
    margins = [values[name] for name in ("motor_peak_margin", "motor_heat_margin")]
    assert all(margin >= 0.0 for margin in margins) == bears
    assert values["motor_speed_margin"] > 0.0


@pytest.mark.slow
@pytest.mark.parametrize(("payload", "chosen"), [("200 g", "frameless_70x10"), ("1 kg", "frameless_85x13")])
def test_the_motor_is_chosen_with_the_module(payload, chosen):
    text = study_path("driven_joint").read_text(encoding="utf-8")
    text = re.sub(r"(?m)^  motor: .*\n|^  motor_torque_margin: .*\n|^robust: .*\n", "", text)
    motors = "  motor: {choose: [frameless_50x08, frameless_70x10, frameless_85x13]}\n"
    text = text.replace("vary:\n", f"{TASK.replace('200 g', payload)}vary:\n{motors}")
    margins = "  motor_peak_margin: '>= 0 N.m'\n  motor_heat_margin: '>= 0 N.m'\n"
    result = answer(read_study_text(text.replace("require:\n", f"require:\n{margins}")))
    assert result.feasible
    assert result.design.choices["motor"] == chosen
