"""Files for simulators, what is refused, and a link that MuJoCo lets go."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
import zipfile
from functools import cache
from pathlib import Path
from threading import Thread
from typing import Any
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest
from answers import shipped_answer
from cad_designs import design_of, whole
from fmpy import read_model_description
from fmpy.validation import validate_fmu
from robot_models import model_of, module_of
from support import ROOT, Command, are_gone
from urdf_parser_py import xml_reflection
from urdf_parser_py.urdf import URDF

from tvimdesign.base.atomic_files import TABLE_ENCODING
from tvimdesign.base.errors import InputError
from tvimdesign.physics.motions.motion import Modes
from tvimdesign.robot.fmu_file import compiled, write_fmu
from tvimdesign.robot.joint_model import JointModel, JointState
from tvimdesign.robot.model_files import held_angles, maxwell_hinges, mjcf, ros2_control, sdf, urdf, without_spring
from tvimdesign.simulation.joint_tests.release import ANGLE, release
from tvimdesign.simulation.trial import Trial
from tvimdesign.study.design import write_design

PAGE = ROOT / "docs/how-to/robot.md"


@pytest.fixture(scope="module")
def folder(tvimdesign: Command, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """Write the joint of the paper's module, and return its folder and report."""
    place = tmp_path_factory.mktemp("robot")
    design = write_design(shipped_answer("paper_reconstructed").design, place / "design.json")
    done = tvimdesign("robot", design, "--timestep", "0.1 ms", "--out", place / "robot", "--json")
    assert done.returncode == 0, done.stderr
    return place / "robot", json.loads(done.stdout)


@pytest.mark.slow
def test_the_folder_of_a_design_is_loaded_by_its_clients(folder):
    place, data = folder
    assert data["time_step"] == pytest.approx(1e-4)
    expected = shipped_answer("paper_reconstructed").design.value("load_inertia")
    assert data["load_inertia"] == pytest.approx(expected, rel=1e-4)
    for state in data["states"].values():
        scene, tree, _ = (place / name for name in state["files"])
        loaded = mujoco.MjModel.from_xml_path(str(scene))
        assert loaded.opt.timestep == pytest.approx(1e-4)
        assert loaded.nmesh == 2
        read = URDF.from_xml_string(tree.read_bytes())
        for link in read.links:
            assert (place / link.visual.geometry.filename).exists()
        assert mujoco.MjModel.from_xml_path(str(tree)).joint("joint").damping[0] == pytest.approx(state["damping"])
    with (place / "temperatures.csv").open(encoding=TABLE_ENCODING) as table:
        rows = list(csv.DictReader(table))
    warm = next(row for row in rows if float(row["temperature [°C]"]) == 30.0)
    assert float(warm["joint_stiffness [N·m/rad]"]) == pytest.approx(data["states"]["cold"]["stiffness"], rel=1e-4)


@pytest.mark.slow
def test_the_arm_of_the_page_catches_softly_and_carries_frozen(folder):
    page = PAGE.read_text()
    block = re.search(r'^```python title="arm.py"\n(.*?)^```', page, re.M | re.S)
    assert block
    (folder[0] / "arm.py").write_text(block.group(1))
    words = [sys.executable, "arm.py", "."]
    done = subprocess.run(words, cwd=folder[0], capture_output=True, text=True, check=True)
    assert "WARNING" not in done.stderr
    lines = re.findall(r"from +(\S+) to +(\S+) mrad, at +(\S+) in the end; shoulder at most (\S+) N.m", done.stdout)
    caught, carried, hard, _ = (
        (float(low), float(high), float(end), float(torque)) for low, high, end, torque in lines
    )
    assert caught[3] < 0.9 * hard[3]
    assert abs(caught[2]) > 10.0 * abs(hard[2])
    assert carried[1] - carried[0] < 0.1 * (caught[1] - caught[0])
    assert done.stdout in page


@pytest.mark.parametrize(
    ("words", "message"), [(["nowhere"], "no such file"), (["studies/finger.yaml"], "tvimdesign run")]
)
def test_what_is_no_result_is_refused(tvimdesign, tmp_path, words, message):
    done = tvimdesign("robot", *words, "--out", tmp_path / "robot")
    assert done.returncode == 2
    assert message in done.stderr


@pytest.mark.parametrize(("step", "message"), [("-1 ms", "must be above 0"), ("1 kg", "kg"), ("1 s", "at most 0.1 s")])
def test_a_time_step_that_is_none_is_refused(tvimdesign, tmp_path, step, message):
    design = write_design(whole(design_of("paper", {})), tmp_path / "design.json")
    done = tvimdesign("robot", design, "--timestep", step, "--out", tmp_path / "robot")
    assert done.returncode == 2
    assert message in done.stderr


def _refuse(message: str) -> None:
    raise AssertionError(message)


def test_a_parser_reads_the_bodies_and_the_joint(mode, monkeypatch):
    monkeypatch.setattr(xml_reflection.core, "on_error", _refuse)
    model = model_of(mode)
    state = model.states[-1]
    read = URDF.from_xml_string(urdf(model, state).encode())
    read.check_valid()
    assert read.get_root() == "base"
    moving, joint = read.link_map["moving"], read.joint_map["joint"]
    assert moving.inertial.mass == pytest.approx(model.moving.mass)
    assert moving.inertial.origin.xyz == pytest.approx(list(model.moving.centre))
    tensor = moving.inertial.inertia.to_matrix()
    assert tensor == [pytest.approx(list(row)) for row in model.moving.inertia]
    assert moving.visual.geometry.filename == "moving.stl"
    assert (joint.type, joint.parent, joint.child, list(joint.axis)) == ("revolute", "base", "moving", [0.0, 0.0, 1.0])
    assert (joint.limit.lower, joint.limit.upper) == pytest.approx((-model.stop_angle, model.stop_angle))
    assert joint.limit.effort == pytest.approx(float(module_of(mode).quantity("holding_torque")))
    assert joint.dynamics.damping == pytest.approx(float(module_of(mode).quantity(f"joint_damping@{state.point}")))


def test_sdf_has_the_bodies_the_stiffness_and_the_damping(mode):
    model = model_of(mode)
    state = model.states[0]
    read = ElementTree.fromstring(sdf(model, state))
    moving = read.find("model/link[@name='moving']/inertial")
    assert moving is not None
    assert float(moving.findtext("mass", "")) == pytest.approx(model.moving.mass)
    assert [float(word) for word in moving.findtext("pose", "").split()] == pytest.approx(
        [*model.moving.centre, 0, 0, 0]
    )
    assert float(moving.findtext("inertia/iyz", "")) == pytest.approx(model.moving.inertia[1][2])
    joint = read.find("model/joint")
    assert joint is not None
    assert [joint.findtext(name) for name in ("parent", "child", "axis/xyz")] == ["base", "moving", "0 0 1"]
    names = ("limit/upper", "dynamics/spring_stiffness", "dynamics/damping")
    quantities = ("stop_angle", f"joint_stiffness@{state.point}", f"joint_damping@{state.point}")
    for name, quantity in zip(names, quantities, strict=True):
        assert float(joint.findtext(f"axis/{name}", "")) == pytest.approx(float(module_of(mode).quantity(quantity)))


def test_ros2_control_commands_the_impedance_between_the_states(mode):
    model = model_of(mode)
    joint = ElementTree.fromstring(ros2_control(model)).find("ros2_control/joint")
    assert joint is not None
    assert joint.get("name") == "joint"
    command = joint.find("command_interface[@name='impedance']")
    assert command is not None
    ends = [float(command.findtext(f"param[@name='{name}']", "")) for name in ("min", "max")]
    assert ends == pytest.approx([end(state.stiffness for state in model.states) for end in (min, max)], rel=1e-9)
    assert {interface.get("name") for interface in joint.iter("state_interface")} >= {"temperature", "stiffness"}


@pytest.fixture(scope="module")
def without_compiler(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv("CC", "no-such-compiler")
        written = write_fmu(module_of("shear"), tmp_path_factory.mktemp("fmu") / "joint.fmu")
    assert written.platform == ""
    assert "no C compiler was found (cc, gcc, clang, or the one that CC names)" in written.summary
    return written.path


def test_the_description_is_without_fault_and_all_sources_are_there(without_compiler):
    assert validate_fmu(str(without_compiler)) == []
    (build,) = read_model_description(str(without_compiler)).buildConfigurations
    with zipfile.ZipFile(without_compiler) as archive:
        names = archive.namelist()
    assert {f"sources/{name}" for part in build.sourceFileSets for name in part.sourceFiles} <= set(names)
    assert not [name for name in names if name.startswith("binaries")]


def test_current_and_angle_go_in_and_torque_and_temperatures_come_out(without_compiler):
    description = read_model_description(str(without_compiler))
    variables = {variable.name: variable for variable in description.modelVariables}
    inputs = {name for name, variable in variables.items() if variable.causality == "input"}
    assert inputs == {"current", "angle", "ambient_temperature", "impedance_command"}
    assert {variables[name].causality for name in ("torque", "temperature_far_face", "frozen")} == {"output"}
    cells = module_of("shear").study.solver.cells
    assert f"temperature_cell_{cells}" in variables
    assert f"temperature_cell_{cells + 1}" not in variables
    resolved = module_of("shear")
    assert float(variables["stroke"].start) == pytest.approx(float(resolved.quantity("stroke")))
    assert float(variables["ambient_temperature"].start) == pytest.approx(
        float(resolved.quantity("ambient_temperature"))
    )


def test_a_compiler_that_fails_is_named(tmp_path, monkeypatch):
    monkeypatch.setenv("CC", f"{sys.executable} -c 'import sys; sys.exit(\"no room\")'")
    with pytest.raises(InputError, match="cannot build the FMU"):
        compiled({"one.c": ""}, ".so", tmp_path)


COMPILER = """
import os, subprocess, sys, tempfile, time
own = tempfile.mkstemp()[1]
worker = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
open(os.environ["TOLD"] + ".part", "w").write(f"{worker.pid} {own}")
os.rename(os.environ["TOLD"] + ".part", os.environ["TOLD"])
time.sleep(600)
"""


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="Windows has no process groups, by which these end")
def test_an_interrupt_ends_the_compiler_s_processes(tmp_path, monkeypatch):
    started = tmp_path / "told"
    (tmp_path / "cc.py").write_text(COMPILER)
    monkeypatch.setenv("CC", f"{sys.executable} {tmp_path / 'cc.py'}")
    monkeypatch.setenv("TOLD", str(started))
    (tmp_path / "beside").mkdir()

    def interrupt() -> None:
        while not started.exists():
            time.sleep(0.02)
        os.kill(os.getpid(), signal.SIGINT)

    Thread(target=interrupt, daemon=True).start()
    with pytest.raises(KeyboardInterrupt):
        compiled({"one.c": ""}, ".so", tmp_path / "beside")
    number, own = started.read_text().split()
    assert are_gone([int(number)])
    assert Path(own).parent == tmp_path / "beside"


KILLED = """
import sys
from pathlib import Path
from tvimdesign.robot.fmu_file import compiled
compiled({"one.c": ""}, ".so", Path(sys.argv[1]))
"""


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="Windows has no process groups, by which these end")
def test_all_that_a_compiler_started_ends_with_a_command_that_is_killed(tmp_path):
    started = tmp_path / "told"
    (tmp_path / "cc.py").write_text(COMPILER)
    own = {"CC": f"{sys.executable} {tmp_path / 'cc.py'}", "TOLD": str(started), "PYTHONPATH": str(ROOT)}
    with subprocess.Popen([sys.executable, "-c", KILLED, str(tmp_path)], env={**os.environ, **own}) as parent:
        while not started.exists() and parent.poll() is None:
            time.sleep(0.02)
        parent.kill()
    number = int(started.read_text().split()[0])
    assert are_gone([number])


@cache
def _released(mode: str, angle: float) -> Trial:
    return release(module_of(mode), angle, kelvin_voigt=False)


def _loaded(model: JointModel, point: str) -> mujoco.MjModel:
    """Return the model of an operating point without its meshes, which are not made here."""
    state = next(loaded for loaded in model.states if loaded.point == point)
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
def test_the_link_let_go_moves_as_in_the_virtual_test(mode, point, step, seconds, angle):
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
        table
        for table in _released(mode, angle).sheets
        if table.name in {f"release_{point}", f"release_{point}_nominal"}
    )
    times, expected = sheet.column("time").values, sheet.column("angle").values
    seen = times < seconds
    turned = np.interp(times[seen], model.step * np.arange(len(angles)), angles)
    assert np.max(np.abs(turned - expected[seen])) < SHARE * expected[0]


def test_inertia_limits_friction_and_springs_are_the_module_s(mode):
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


def test_elements_come_back_with_the_spring_and_quick_ones_are_damping():
    omega, spring = np.geomspace(1e-3, 1e5, 33), 700.0
    others = without_spring(MODES, spring)
    np.testing.assert_allclose(
        1.0 / (1.0 / _stiffness(others, omega) + 1.0 / spring), _stiffness(MODES, omega), rtol=1e-9
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
def test_after_a_hold_the_torque_is_what_has_not_relaxed(one_sided):
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


def test_all_states_have_the_same_hinges(mode):
    model = model_of(mode)
    names = [[hinge.name for hinge in maxwell_hinges(state, model.count, model.step).hinges] for state in model.states]
    assert all(hinges == names[0] for hinges in names)
