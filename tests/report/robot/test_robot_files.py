"""`tvimdesign robot`: a folder that simulators load as it is, and what is refused."""

from __future__ import annotations

import csv
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import mujoco
import pytest
from answers import shipped_answer
from cad_designs import design_of, whole
from support import ROOT, Command
from urdf_parser_py.urdf import URDF

from tvimdesign.base.atomic_files import TABLE_ENCODING
from tvimdesign.study.design import write_design

PAGE = ROOT / "docs/how-to/robot.md"


@pytest.fixture(scope="module")
def folder(tvimdesign: Command, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """The joint of the paper's module, and what was told of it."""
    place = tmp_path_factory.mktemp("robot")
    design = write_design(shipped_answer("paper_as_published").design, place / "design.json")
    done = tvimdesign("robot", design, "--timestep", "0.1 ms", "--out", place / "robot", "--json")
    assert done.returncode == 0, done.stderr
    return place / "robot", json.loads(done.stdout)


@pytest.mark.slow
def test_the_folder_of_a_design_is_loaded_by_its_clients(folder: tuple[Path, dict[str, Any]]) -> None:
    place, told = folder
    assert told["time_step"] == pytest.approx(1e-4)
    expected = shipped_answer("paper_as_published").design.value("load_inertia")
    assert told["load_inertia"] == pytest.approx(expected, rel=1e-4)
    for state in told["states"].values():
        scene, tree = (place / name for name in state["files"])
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
    assert float(warm["joint_stiffness [N·m/rad]"]) == pytest.approx(told["states"]["cold"]["stiffness"], rel=1e-4)


@pytest.mark.slow
def test_the_arm_of_the_page_swings_soft_and_stays_where_it_froze(folder: tuple[Path, dict[str, Any]]) -> None:
    block = re.search(r'^```python title="arm.py"\n(.*?)^```', PAGE.read_text(), re.M | re.S)
    assert block
    (folder[0] / "arm.py").write_text(block.group(1))
    words = [sys.executable, "arm.py", "."]
    done = subprocess.run(words, cwd=folder[0], capture_output=True, text=True, check=True)
    assert "WARNING" not in done.stderr
    found = re.findall(r"elbow at +(\S+) mrad, swings +(\S+) mrad", done.stdout)
    (soft, swing), (frozen, still), (_, again) = ((float(at), float(by)) for at, by in found)
    assert still < 0.1 * min(swing, again)
    assert abs(frozen) > 0.5 * abs(soft) > 5.0


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
