"""A goal that nothing moves: the check marks it, and no search calls where it ends an optimum."""

from pathlib import Path

import pytest
from support import Command

from tvimdesign.solve.infeasibility.inspection import Inspection
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import read_study_text

STUDY = """
tvimdesign: 1
mode: shear
vary: {pcl_thickness: [0.8 mm, 2 mm]}
require: {module_mass: "<= 2 kg"}
minimize: GOAL
solver: {cells: 6, starts: 2}
"""


@pytest.mark.parametrize(("goal", "flat"), [("leg_length", True), ("spring_stiffness", False)])
def test_the_check_marks_a_goal_that_nothing_moves(goal: str, flat: bool) -> None:
    optimizer = Optimizer(read_study_text(STUDY.replace("GOAL", goal), "test"))
    assert Inspection(optimizer).structure().goal_flat == flat


@pytest.mark.gate
def test_a_search_for_nothing_is_no_optimum(tvimdesign: Command, tmp_path: Path) -> None:
    (tmp_path / "flat.yaml").write_text(STUDY.replace("GOAL", "leg_length"))
    done = tvimdesign("run", "flat.yaml", "--no-cad", "--no-plots", "--out", "out", cwd=tmp_path)
    assert done.returncode == 3
    assert "No optimum: nothing under `vary` moves what is minimised" in done.stdout
    assert "nothing under `vary` moves the goal, leg_length" in " ".join(done.stderr.split())
    checked = tvimdesign("check", "--deep", "flat.yaml", cwd=tmp_path)
    assert "! nothing under `vary` moves the goal" in checked.stdout
    assert "Look at what is marked with !." in checked.stdout
