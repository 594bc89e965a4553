"""An atlas of one family: its cells against searches of their own and attacks, its keys, its folder."""

import csv
import itertools
import json
import math
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import attack
import psutil
import pytest
import yaml
from support import are_gone, wait_until

from tvimdesign.base.errors import InputError
from tvimdesign.base.processes import end_process_tree
from tvimdesign.report.sweep.atlas_page import rows_of
from tvimdesign.solve.search import optimize
from tvimdesign.study import read_study
from tvimdesign.study.atlas_studies import Atlas
from tvimdesign.sweep.atlas import OUTPUTS, AtlasCell, _key, cells_of, compute, study_of

PLAN = Path(__file__).parent / "atlas.yaml"
MASS = "module_mass"


@pytest.fixture(scope="module")
def plan():
    return Atlas.read(PLAN)


@pytest.fixture(scope="module")
def folder(plan, tmp_path_factory):
    folder = tmp_path_factory.mktemp("atlas")
    compute(plan, folder, 1, lambda _: None)
    return folder


@pytest.fixture(scope="module")
def cells(plan, folder):
    return {(cell.torque, cell.cycle): cell for cell in cells_of(plan, folder)}


@pytest.mark.gate
def test_more_torque_and_less_time_cost_mass(cells):
    masses = {place: cell.values[MASS] for place, cell in cells.items() if cell.status == "optimal"}
    assert set(masses) == set(itertools.product((5.0, 7.0), (120.0, 300.0)))
    for (torque, cycle), mass in masses.items():
        for (other, longer), less in masses.items():
            if other <= torque and longer >= cycle:
                assert less <= mass * (1.0 + 2e-3)


@pytest.mark.slow
def test_a_cell_is_what_its_own_study_comes_to(plan, cells):
    cell = cells[7.0, 120.0]
    solution = optimize(study_of(plan, cell))
    assert solution.status == "optimal"
    assert solution.values[MASS] == pytest.approx(cell.values[MASS], rel=5e-3)


@pytest.mark.gate
def test_an_empty_cell_names_what_ends_it_and_withstands_an_attack(plan, cells, monkeypatch):
    monkeypatch.setattr(attack, "TRIED", 1500)
    cell = cells[5.0, 20.0]
    assert cell.status == "empty"
    assert cell.limits
    assert cell.values["cycle_time"] > 20.0
    assert not attack.Attack(study_of(plan, cell)).finds_a_design(seed=1)


@pytest.mark.gate
def test_a_cell_is_open_while_a_family_is_missing(plan, folder):
    larger = replace(plan, hardware=(*plan.hardware, "heavy"))
    statuses = {cell.status for cell in cells_of(larger, folder)}
    assert "empty" in {cell.status for cell in cells_of(plan, folder)}
    assert statuses == {"optimal", "unanswered"}


@pytest.mark.gate
def test_designs_that_no_other_beats_have_intervals(cells):
    optima = [cell for cell in cells.values() if cell.status == "optimal"]
    best = max(optima, key=lambda cell: (cell.density, -cell.cycle))
    least, most = best.intervals["holding_torque"]
    assert least < best.values["holding_torque"] < most
    assert any(not cell.intervals for cell in optima)


@pytest.mark.gate
def test_a_family_is_computed_again_only_after_a_change(plan, folder):
    assert compute(plan, folder, 1, lambda _: None)[0]["computed"] == 0
    study = plan.study("foil", "middle")
    assert _key(plan, study) != _key(
        plan, study.model_copy(update={"module": {**study.module, "pcl_grade": "pcl_80k"}})
    )


@pytest.mark.gate
def test_families_of_another_atlas_are_reused(plan, folder, tmp_path):
    assert compute(plan, tmp_path, 1, lambda _: None, (folder,))[0]["computed"] == 0
    assert cells_of(plan, tmp_path) == cells_of(plan, folder)
    with pytest.raises(InputError, match="no folder of an atlas"):
        compute(plan, tmp_path, 1, lambda _: None, (tmp_path / "none",))


def test_a_time_that_may_never_come_has_no_high_end():
    values = dict.fromkeys(OUTPUTS, 1.0)
    cell = AtlasCell("foil", 5.0, 60.0, "optimal", "middle", values, (), {"cycle_time": (30.0, math.inf)})
    (row,) = rows_of([cell])
    assert row["cycle_time low"] == 30.0
    assert row["cycle_time high"] is None


def test_a_plan_refuses_a_kind_it_lacks(plan):
    with pytest.raises(InputError, match="no kind 'wood' in the atlas; it has foil"):
        plan.only(("wood",))


@pytest.mark.gate
def test_the_command_writes_tables_and_studies(tvimdesign, tmp_path):
    values = yaml.safe_load(PLAN.read_text(encoding="utf-8"))
    small = tmp_path / "small.yaml"
    small.write_text(yaml.safe_dump({**values, "torques": ["5 N.m"], "cycles": ["300 s"]}), encoding="utf-8")
    out = tmp_path / "atlas"
    answer = json.loads(tvimdesign("atlas", small, "--out", out, "--workers", "1", "--json").stdout)
    assert answer["statuses"] == {"optimal": 1}
    (row,) = csv.DictReader((out / "atlas.csv").read_text(encoding="utf-8").splitlines())
    assert float(row["density [N*m/kg]"]) == pytest.approx(5e3 / float(row["module_mass [g]"]))
    study = read_study(out / "studies/foil-5Nm-300s.yaml")
    assert {limit.output for limit in study.require} >= {"holding_torque", "cycle_time", "joint_stiffness@hot"}
    assert (out / "atlas.svg").exists()
    assert (out / "report.html").exists()


@pytest.mark.gate
@pytest.mark.parametrize("number", ["SIGTERM", "SIGKILL"])
def test_its_workers_end_with_the_command(tmp_path, number):
    if number == "SIGKILL" and sys.platform != "linux":
        pytest.skip("only Linux ends the workers of a process that is killed outright")
    process = subprocess.Popen(
        [sys.executable, "-m", "tvimdesign", "atlas", PLAN, "--out", tmp_path, "--workers", "2", "--no-plots"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    workers: list[int] = []

    def started():
        tree = psutil.Process(process.pid).children(recursive=True)
        workers[:] = [child.pid for child in tree if any("spawn_main" in word for word in child.cmdline())]
        return bool(workers)

    try:
        assert wait_until(started, 60.0)
        process.send_signal(getattr(signal, number))
        assert process.wait(30.0) in (128 + signal.SIGTERM, -9)
        assert are_gone(workers)
    finally:
        for each in (process.pid, *workers):
            end_process_tree(each)
