"""The studies of tasks: each comes to an optimum that does its task, and to parts."""

import json
from time import process_time

import pytest
import yaml
from answers import shipped_answer
from support import TASKS

from tvimdesign.solve.result import answer
from tvimdesign.study import read_study
from tvimdesign.study.reader import read_study_text

pytestmark = pytest.mark.slow
every = pytest.mark.parametrize("path", TASKS, ids=lambda path: path.stem)
LONGER = 1.5
"""Processor time of a study over that of the same one without its task."""


@every
def test_a_task_comes_to_an_optimum_that_95_percent_of_the_modules_keep(path):
    result = shipped_answer(path.stem)
    assert result.design.status == "optimal"
    assert result.feasible
    assert result.solution is not None
    assert result.solution.yield_reached is not None
    assert result.solution.yield_reached.together >= 0.95
    values = result.design.values
    assert values["holding_torque"] >= values["load_safety"] * values["task_torque@cold"] * (1.0 - 1e-6)


@every
def test_a_task_takes_no_longer_than_its_torque(path):
    values, text = shipped_answer(path.stem).design.values, yaml.safe_load(path.read_text())
    del text["task"]
    struck = values["impact_torque@cold"] if text["require"].pop("impact_torque_margin", None) else 0.0
    torque = max(struck, values["load_safety"] * values["task_torque@cold"])
    text["require"]["holding_torque"] = f">= {torque} N.m"
    plain = read_study_text(yaml.safe_dump(text, allow_unicode=True))
    times = []
    for study in (plain, read_study(path)):
        start = process_time()
        answer(study)
        times.append(process_time() - start)
    assert times[1] < LONGER * times[0]


@every
def test_a_task_becomes_parts_that_pass_every_check(tvimdesign, tmp_path, path):
    done = tvimdesign("run", path, "--no-plots", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert all(check["ok"] for check in json.loads((tmp_path / "out/cad/checks.json").read_text())["checks"])
