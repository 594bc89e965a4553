"""MuJoCo gives the exported joint an arm: torque, sag and impact are those of the table, within 5 %."""

import re
from dataclasses import replace
from functools import cache
from typing import Any
from xml.etree import ElementTree as Xml

import mujoco
import numpy as np
import pytest
from answers import shipped_answer
from robot_models import joint_of, module_of
from support import TASKS

from tvimdesign.device.core.task import Trajectory
from tvimdesign.robot.model_files import mjcf
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_design

TOLERANCE = 0.05
"""Share by which MuJoCo may differ."""
OF_POWER = 2.5
"""Power of the accelerations in the Head Injury Criterion."""
TASK = {
    "task": "arm", "arm_length": 0.25, "arm_mass": 0.1, "payload": 0.15, "pose_time": 2.0, "sine_amplitude": 0.05,
    "sine_from": 3.0, "sine_to": 3.0, "impact_mass": 0.1, "impact_speed": 0.3,
    "trajectory": Trajectory((0.0, 0.3, 0.6), (0.0, 0.3, 0.0)),
}  # fmt: skip


@cache
def _task(name: str) -> ResolvedModule:
    """Return the published module of a mode with a task, or what a study of a task comes to."""
    if name in {path.stem for path in TASKS}:
        return resolve_design(shipped_answer(name).design)
    module = module_of(name)
    return replace(module, values={**module.values, **TASK})


def _arm(module: ResolvedModule, point: str, step: float, extra: float = 0.0, *, ball: bool = False) -> mujoco.MjModel:
    """Load the exported joint with the arm along x in place of the bench's load, gravity along -y."""
    values = module.values
    model = joint_of(module, step)
    state = next(state for state in model.states if state.point == point)
    root = Xml.fromstring(re.sub(r"<(mesh|geom) [^>]*>|<\?xml.*\?>", "", mjcf(model, state)))
    for joint in root.iter("joint"):
        joint.attrib.pop("frictionloss", None)  # the table's task has no friction
    option, length = root.find("option"), values["arm_length"]
    option.set("gravity", f"0 {-values['gravity']} 0")
    moving = next(body for body in root.iter("body") if body.get("name") == "moving")
    load = moving.find("body")
    assert load is not None
    moving.remove(load)
    bar, centre = values["arm_mass"], values["arm_centre_share"]
    across = bar * length**2 * (values["arm_inertia_share"] - centre**2)
    for name, place, mass, inertia in (
        ("bar", centre * length, bar, across), ("end", length, values["payload"] + extra, 1e-9),
    ):  # fmt: skip
        body = Xml.SubElement(moving, "body", name=name, pos=f"{place} 0 0")
        Xml.SubElement(body, "inertial", pos="0 0 0", mass=str(mass), diaginertia=f"{inertia} {inertia} {inertia}")
    if ball:
        world, keyframe = root.find("worldbody"), root.find("keyframe")
        assert world is not None
        assert keyframe is not None
        body = Xml.SubElement(world, "body", name="ball", pos=f"{length} 0 0")
        Xml.SubElement(body, "joint", name="ball", type="slide", axis="0 1 0")
        Xml.SubElement(body, "inertial", pos="0 0 0", mass=str(values["impact_mass"]), diaginertia="1e-6 1e-6 1e-6")
        root.remove(keyframe)
    return mujoco.MjModel.from_xml_string(Xml.tostring(root, encoding="unicode"))


def _followed(loaded: mujoco.MjModel, seconds: float, base: Any = None, speed: float = 0.0) -> tuple[Any, Any]:
    """Return angle and torque of the joint at each step, the base's angular acceleration given over time."""
    if base is not None or speed:
        loaded.opt.gravity[:] = 0.0
    data, full = mujoco.MjData(loaded), np.zeros((loaded.nv, loaded.nv))
    data.joint("joint").qvel[0] = speed
    mujoco.mj_forward(loaded, data)
    mujoco.mj_fullM(loaded, full, data.qM) if hasattr(data, "qM") else mujoco.mj_fullM(loaded, data, full)
    inertia, place = full[0, 0], loaded.joint("joint").dofadr[0]
    angles, torques = [], []
    for _ in range(int(seconds / loaded.opt.timestep)):
        push = 0.0 if base is None else -inertia * float(base(data.time))
        data.qfrc_applied[place] = push
        mujoco.mj_step(loaded, data)
        angles.append(data.qpos[place])
        torques.append(push - inertia * data.qacc[place])
    return np.array(angles), np.array(torques)


POINTS = [
    pytest.param(*case, marks=pytest.mark.gate)
    for case in (("shear", "cold", 2e-5), ("shear", "hot", 2e-5), ("compression", "cold", 2e-5))
]
SLOW = [pytest.param(path.stem, "cold", 2e-5, marks=pytest.mark.slow) for path in TASKS]
"""Soft, these meet their stops, which the table leaves out of sag and sine."""


@pytest.mark.parametrize(("name", "point", "step"), [*POINTS, *SLOW])
def test_sag_is_that_of_mujoco_s_arm(name, point, step):
    module = _task(name)
    seconds = module.values["pose_time"]
    step = max(step, 2e-6 * seconds)  # it ends slowly
    angles, _ = _followed(_arm(module, point, step), seconds)
    last = angles[-int(0.3 / step) :]
    sag = -np.mean(last) * module.values["arm_length"]
    assert sag == pytest.approx(module.quantity(f"sag@{point}"), rel=TOLERANCE)


@pytest.mark.parametrize(("name", "point", "step"), [*POINTS, *SLOW])
def test_torque_of_a_sine_and_a_trajectory_is_mujoco_s(name, point, step):
    module = _task(name)
    values = module.values
    arm = _arm(module, point, step)
    torque, deflection = 0.0, 0.0
    for frequency in dict.fromkeys((values["sine_from"], values["sine_to"])) if values["sine_amplitude"] else ():
        omega = 2.0 * np.pi * frequency

        def base(time: float, omega: float = omega) -> float:
            return -values["sine_amplitude"] * omega**2 * np.sin(omega * time)

        angles, torques = _followed(arm, 9.0 / frequency, base)
        last = slice(-int(1.0 / frequency / step), None)
        torque = max(torque, 0.5 * np.ptp(torques[last]))
        deflection = max(deflection, 0.5 * np.ptp(angles[last]))
    assert torque == pytest.approx(module.quantity(f"sine_torque@{point}"), rel=TOLERANCE)
    assert deflection == pytest.approx(module.quantity(f"sine_deflection@{point}"), rel=TOLERANCE)
    if isinstance(values["trajectory"], Trajectory):
        upright = replace(module, values={**values, "gravity": 0.0})
        every, _, _, accelerations = values["trajectory"].sampled()
        times = every * np.arange(len(accelerations))
        _, torques = _followed(arm, times[-1], lambda time: np.interp(time, times, accelerations))
        assert np.max(np.abs(torques)) == pytest.approx(upright.quantity(f"trajectory_torque@{point}"), rel=TOLERANCE)


STRUCK = [*POINTS, *(pytest.param("gripper_finger", point, 2e-5, marks=pytest.mark.slow) for point in ("cold", "hot"))]


@pytest.mark.parametrize(("name", "point", "step"), STRUCK)
def test_impact_is_mujoco_s(name, point, step):
    module = _task(name)
    mass, speed, length = (module.values[part] for part in ("impact_mass", "impact_speed", "arm_length"))
    inertia = float(module.quantity("task_inertia")) + mass * length**2
    start = mass * speed * length / inertia
    angles, torques = _followed(_arm(module, point, step, extra=mass), 0.4, speed=start)
    assert np.max(np.abs(torques)) == pytest.approx(module.quantity(f"impact_torque@{point}"), rel=TOLERANCE)
    assert np.max(np.abs(angles)) == pytest.approx(module.quantity(f"impact_deflection@{point}"), rel=TOLERANCE)


@pytest.mark.parametrize(
    ("name", "point", "mass"),
    [
        *(pytest.param("shear", point, 0.1, marks=pytest.mark.gate) for point in ("cold", "hot")),
        *(pytest.param(name, "cold", 4.5, marks=pytest.mark.gate) for name in ("shear", "compression")),
        *(pytest.param("gripper_finger", point, None, marks=pytest.mark.slow) for point in ("cold", "hot")),
    ],
)
def test_force_and_injury_of_an_impact_are_mujoco_s(name, point, mass):
    module = _task(name)
    module = module if mass is None else replace(module, values={**module.values, "impact_mass": mass})
    length, mass, speed, stiffness = (
        module.values[part] for part in ("arm_length", "impact_mass", "impact_speed", "impact_stiffness")
    )
    step = 1e-5
    loaded = _arm(module, point, step, ball=True)
    loaded.opt.gravity[:] = 0.0
    data, forces = mujoco.MjData(loaded), []
    data.joint("ball").qvel[0] = speed
    for _ in range(int(4.0 * np.pi * np.sqrt(mass / stiffness) / step)):  # within, a frozen joint stops the body
        force = max(0.0, stiffness * (data.joint("ball").qpos[0] - length * data.joint("joint").qpos[0]))
        data.joint("ball").qfrc_applied[0], data.joint("joint").qfrc_applied[0] = -force, force * length
        mujoco.mj_step(loaded, data)
        forces.append(force)
    assert max(forces) == pytest.approx(float(module.quantity(f"impact_force@{point}")), rel=TOLERANCE)
    # The mean acceleration of the struck body over each window of at most 15 ms, in multiples of gravity.
    gained = np.append(0.0, np.cumsum(forces)) * step / (mass * 9.80665)
    lengths = np.arange(1, min(round(0.015 / step), len(forces)) + 1)
    worst = max(n * step * (np.max(gained[n:] - gained[:-n]) / (n * step)) ** 2.5 for n in lengths)
    assert float(module.quantity(f"head_injury@{point}")) == pytest.approx(worst, rel=OF_POWER * TOLERANCE)


@pytest.mark.parametrize("point", ["cold", "hot"])
def test_force_of_an_impact_is_that_of_the_energy(point):
    module = _task("shear")
    length, mass, speed = (module.values[part] for part in ("arm_length", "impact_mass", "impact_speed"))
    # F = v sqrt(mu k) with the reduced mass of body and free arm, which the joint hardly holds.
    reduced = 1.0 / (1.0 / mass + length**2 / float(module.quantity("task_inertia")))
    force = speed * np.sqrt(reduced * module.values["impact_stiffness"])
    assert float(module.quantity(f"impact_force@{point}")) == pytest.approx(force, rel=0.02)
