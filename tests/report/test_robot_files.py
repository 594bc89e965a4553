"""`tvimdesign robot`: a folder that simulators load as it is, and what is refused."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import mujoco
import pytest
from answers import shipped_answer
from cad_designs import design_of, whole
from support import Command
from urdf_parser_py.urdf import URDF

from tvimdesign.base.whole_files import TABLE_ENCODING
from tvimdesign.study.design import write_design


@pytest.mark.slow
def test_the_folder_of_a_design_is_loaded_by_its_clients(tvimdesign: Command, tmp_path: Path) -> None:
    answered = shipped_answer("paper_as_published")
    design = write_design(answered.design, tmp_path / "design.json")
    done = tvimdesign("robot", design, "--timestep", "0.2 ms", "--out", tmp_path / "robot", "--json")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["time_step"] == pytest.approx(2e-4)
    assert told["load_inertia"] == pytest.approx(answered.design.value("load_inertia"), rel=1e-4)
    for state in told["states"].values():
        scene, tree = (tmp_path / "robot" / name for name in state["files"])
        loaded = mujoco.MjModel.from_xml_path(str(scene))
        assert loaded.opt.timestep == pytest.approx(2e-4)
        assert loaded.nmesh == 2
        read = URDF.from_xml_file(str(tree))
        for link in read.links:
            assert (tmp_path / "robot" / link.visual.geometry.filename).exists()
        assert mujoco.MjModel.from_xml_path(str(tree)).joint("joint").damping[0] == pytest.approx(state["damping"])
    with (tmp_path / "robot/temperatures.csv").open(encoding=TABLE_ENCODING) as table:
        rows = list(csv.DictReader(table))
    warm = next(row for row in rows if float(row["temperature [°C]"]) == 30.0)
    assert float(warm["joint_stiffness [N·m/rad]"]) == pytest.approx(told["states"]["cold"]["stiffness"], rel=1e-4)


@pytest.mark.parametrize(
    ("words", "said"),
    [(["nowhere"], "no such file"), (["studies/paper_shear.yaml"], "tvimdesign run")],
)
def test_what_is_no_result_is_refused(tvimdesign: Command, tmp_path: Path, words: list[str], said: str) -> None:
    done = tvimdesign("robot", *words, "--out", tmp_path / "robot")
    assert done.returncode == 2
    assert said in done.stderr


@pytest.mark.parametrize(("step", "said"), [("-1 ms", "must be above 0"), ("1 kg", "kg"), ("1 s", "at most 0.1 s")])
def test_a_time_step_that_is_none_is_refused(tvimdesign: Command, tmp_path: Path, step: str, said: str) -> None:
    design = write_design(whole(design_of("paper", {})), tmp_path / "design.json")
    done = tvimdesign("robot", design, "--timestep", step, "--out", tmp_path / "robot")
    assert done.returncode == 2
    assert said in done.stderr
