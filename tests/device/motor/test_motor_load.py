"""The motor's torque, heat and speed in a task, against an arm on a spring that is turned alike; and its driver."""

import re
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from support import sample_text, study_path

from tvimdesign.catalog import Catalog
from tvimdesign.device.motor import motor_load
from tvimdesign.solve.result import answer
from tvimdesign.study.reader import read_study_text

MOMENTS, ANGLES = [0.0, 0.25, 0.5], np.radians([0.0, 20.0, 40.0])
LENGTH, ARM, PAYLOAD, GRAVITY = 0.1, 0.1, 0.2, 9.80665
TASK = sample_text("task_of_a_motor")
SINE = """  sine_amplitude: 0.1 rad
  sine_from: 0.5 Hz
  sine_to: 2 Hz
"""


@cache
def _values(motor: str, more: str = "") -> dict[str, float]:
    text = study_path("driven_joint").read_text(encoding="utf-8")
    head, _, tail = text.partition("vary:\n")
    points = tail[tail.index("operating_points:") : tail.index("tolerances:")]
    text = head.replace("ilm_e70x10", f"{motor}\n  motor_driver: moteus_c1") + TASK + more + points
    return answer(read_study_text(text)).design.values


@pytest.mark.gate
def test_its_torque_is_that_of_an_arm_on_a_spring():
    values = _values("ilm_e70x10")
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
    values = _values("ilm_e70x10")
    # A star of 0.249 ohm a phase; 0.157 N.m for an ampere of each phase's rms current.
    phase = values["motor_rms_torque@cold"] / 0.157
    assert values["motor_heat@cold"] == pytest.approx(3.0 * 0.249 * phase**2, rel=1e-9)
    assert values["motor_current@cold"] == pytest.approx(values["motor_torque@cold"] / 0.157)


@pytest.mark.parametrize(
    ("motor", "watts"),
    [("ilm_e50x08", 11.3), ("ilm_e70x10", 11.7), ("ilm_e70x18", 21.1), ("ilm_e85x13", 16.9), ("ilm_e85x30", 33.9)],
)
def test_the_heat_of_rated_torque_is_that_of_the_sheet(motor, watts):
    record = Catalog().record("motors", motor)
    winding = {name: record.value(name) for name in ("torque_constant", "winding_resistance")}
    rated = SimpleNamespace(drive_motor=SimpleNamespace(**winding), motor_rms_torque=record.value("continuous_torque"))
    assert motor_load.motor_heat(rated) == pytest.approx(watts, rel=0.02)


def test_a_sine_adds_its_amplitudes():
    alone, swinging = _values("ilm_e70x10"), _values("ilm_e70x10", SINE)
    # A rigid link and all that the motor turns, at 2 Hz.
    link = swinging["task_inertia"] + swinging["driven_inertia"]
    added = link * 0.1 * (2.0 * np.pi * 2.0) ** 2
    assert swinging["motor_torque@cold"] == pytest.approx(
        max(alone["motor_torque@cold"], swinging["pose_torque"] + added), rel=0.02
    )


@pytest.mark.gate
@pytest.mark.parametrize(("motor", "bears"), [("ilm_e50x08", False), ("ilm_e85x13", True)])
def test_a_small_motor_does_not_bear_the_task(motor, *, bears):
    values = _values(motor, SINE.replace("0.1 rad", "1 rad"))
    margins = [values[name] for name in ("motor_peak_margin", "motor_heat_margin")]
    assert all(margin >= 0.0 for margin in margins) == bears
    assert values["motor_speed_margin"] > 0.0


def test_its_voltage_is_that_of_a_star_of_three_phases():
    """0.12 N.m for an ampere of rms current, 0.71 ohm a phase, 2 A rms at 10 rad/s, its phases drawn over a turn."""
    turn = np.linspace(0.0, 2.0 * np.pi, 100001)
    current, other = (np.sqrt(2.0) * 2.0 * np.cos(turn - shift) for shift in (0.0, 2.0 * np.pi / 3.0))
    # The phases share the power of 0.24 N.m at 10 rad/s: 2.4 W = 3 E 2 A, so E is 0.4 V rms.
    emf, next_emf = (np.sqrt(2.0) * 0.4 * np.cos(turn - shift) for shift in (0.0, 2.0 * np.pi / 3.0))
    largest = np.max(emf + 0.71 * current - next_emf - 0.71 * other)
    motor = SimpleNamespace(torque_constant=0.12, winding_resistance=1.42)
    module = SimpleNamespace(drive_motor=motor, task_speed=10.0, motor_current_at_hot=1.0, motor_current_at_cold=2.0)
    assert motor_load.motor_voltage(module) == pytest.approx(largest, rel=1e-6)
    # Its speed constant is 8.27 over the torque for an ampere of amplitude, 0.0849 N.m: 97.5 rpm/V, here at 95.5 rpm.
    assert largest - np.sqrt(6.0) * 2.0 * 0.71 == pytest.approx(95.5 / 97.5, rel=1e-3)


def test_its_driver_has_what_the_task_leaves():
    values = _values("ilm_e70x10")
    # moteus-c1: 5 A and 20 A of amplitude, 0.8 of 24 V, 10 V to 51 V; the motor has 0.157 N.m/A rms, 0.498 ohm.
    peak = max(values["motor_torque@hot"], values["motor_torque@cold"]) / 0.157
    rms = max(values["motor_rms_torque@hot"], values["motor_rms_torque@cold"]) / 0.157
    assert values["motor_driver_peak_margin"] == pytest.approx(20.0 - 1.41421356 * peak)
    assert values["motor_driver_current_margin"] == pytest.approx(5.0 - 1.41421356 * rms)
    wanted = 0.81649658 * 0.157 * values["task_speed"] + 1.22474487 * 0.498 * peak
    assert values["motor_driver_voltage_margin"] == pytest.approx(19.2 - wanted)
    assert values["motor_driver_supply_margin"] == pytest.approx(14.0)
    assert values["motor_driver_mass"] == pytest.approx(8.9e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("payload", "chosen"), [("200 g", ("ilm_e70x10", "moteus_c1")), ("1 kg", ("ilm_e85x13", "moteus_x1"))]
)
def test_motor_and_driver_are_chosen_with_the_module(payload, chosen):
    text = study_path("driven_joint").read_text(encoding="utf-8")
    text = re.sub(r"(?m)^  motor: .*\n|^  motor_torque_margin: .*\n|^robust: .*\n", "", text)
    motors = "  motor: {choose: [ilm_e50x08, ilm_e70x10, ilm_e85x13]}\n"
    motors += "  motor_driver: {choose: [moteus_c1, moteus_x1]}\n"
    text = text.replace("response_time: 1}", "response_time: 1, motor_driver_mass: 1}")
    text = text.replace("vary:\n", f"{TASK.replace('200 g', payload)}vary:\n{motors}")
    margins = "  motor_peak_margin: '>= 0 N.m'\n  motor_heat_margin: '>= 0 N.m'\n"
    margins += "".join(f"  motor_driver_{name}_margin: '>= 0 A'\n" for name in ("peak", "current"))
    result = answer(read_study_text(text.replace("require:\n", f"require:\n{margins}")))
    assert result.feasible
    assert (result.design.choices["motor"], result.design.choices["motor_driver"]) == chosen
