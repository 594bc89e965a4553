"""A sweep is the same table, byte for byte, whoever computes it and however often it was stopped."""

import csv
import json
import resource
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest
from small_sweeps import plan, swept, tables
from support import ROOT, cases_of, environment, study_path

import tvimdesign as tvim
from tvimdesign.base.errors import InputError
from tvimdesign.base.results_folder import joined
from tvimdesign.study.tree import tree_of_file
from tvimdesign.sweep.plan import Cell, plan_of
from tvimdesign.sweep.pool import Pool
from tvimdesign.sweep.run_sweep import Executor, run_sweep
from tvimdesign.sweep.shards import SHARDS, Shards


def rows(out: Path) -> list[dict[str, str]]:
    with (out / "cells.csv").open(encoding="utf-8-sig") as stream:
        return list(csv.DictReader(stream))


def test_cells_are_those_of_single_evaluations(one_process):
    table = rows(one_process)
    assert [row["status"] for row in table] == ["evaluated", "refused"] * 3
    assert "arc_width is" in table[1]["reason"]
    assert table[1]["module_mass"] == ""
    alone = tvim.Study(mode="shear", module={"pcl_thickness": "1.3 mm", "pcl_inner_radius": "20 mm"})
    result = alone.evaluate(progress=False)
    for name in ("module_mass", "response_time", "spring_stiffness"):
        assert float(table[2][name]) == pytest.approx(result[name].magnitude, rel=1e-11)
    satisfied = result.requirements()["met"]
    assert int(table[2]["violated"]) == int((~satisfied).sum())


def test_the_data_base_has_the_table_s_numbers(one_process):
    connection = sqlite3.connect(one_process / "cells.sqlite")
    try:
        masses = [mass for (mass,) in connection.execute("SELECT module_mass FROM cells ORDER BY cell")]
        units = dict(connection.execute("SELECT name, unit FROM columns"))
    finally:
        connection.close()
    assert masses == [float(row["module_mass"]) if row["module_mass"] else None for row in rows(one_process)]
    assert (units["pcl_thickness"], units["module_mass"], units["reason"]) == ("mm", "g", "")
    report = json.loads((one_process / "sweep.json").read_text())
    assert {column["name"]: column["unit"] for column in report["columns"]} == units
    assert report["statuses"] == {"evaluated": 3, "refused": 3}
    least = min(float(row["module_mass"]) for row in rows(one_process) if row["violated"] == "0")
    assert report["best"]["module_mass"]["value"] == least


@pytest.mark.gate
def test_two_workers_and_a_resumed_sweep_give_the_same_bytes(study_file, one_process, tmp_path):
    out = tmp_path / "out"
    first = swept(study_file, out, workers=2)
    assert (first["reused"], first["computed"]) == (0, 6)
    assert tables(out) == tables(one_process)
    again = swept(study_file, out, resume=True, workers=1)
    assert (again["reused"], again["computed"]) == (6, 0)
    assert tables(out) == tables(one_process)


@pytest.mark.gate
def test_a_sweep_whose_workers_were_killed_in_a_line_is_resumed(study_file, one_process, tmp_path):
    out = tmp_path / "out"
    with joined(out, SHARDS) as folder:
        run_sweep(plan_of(tree_of_file(study_file)), folder, Executor(2), lambda _: None)
    for path in (folder / "shards").iterdir():
        path.write_bytes(path.read_bytes()[:-10])
    again = swept(study_file, out, resume=True, workers=1)
    assert 1 <= again["computed"] <= 2
    assert again["reused"] == 6 - again["computed"]
    assert tables(out) == tables(one_process)


@pytest.mark.slow
def test_parts_of_an_array_share_a_folder_and_the_last_gathers(tvimdesign, study_file, one_process, tmp_path):
    out = tmp_path / "out"
    for part in (3, 1, 2):
        done = tvimdesign("sweep", study_file, "--out", out, "--shard", f"{part}/3", "--workers", 1, "--no-plots")
        assert done.returncode == 0, done.stderr
        assert (out / "cells.csv").exists() == (part == 2)
    assert "0 reused, 2 computed" in done.stdout
    assert tables(out) == tables(one_process)


def test_a_sweep_over_fewer_values_finds_its_cells_there(study_file, one_process, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "shards").symlink_to(one_process / "shards")
    fewer, where = plan(study_file, "sweep.over.pcl_thickness=[0.6 mm, 2 mm]"), Executor(workers=1)
    done = run_sweep(fewer, out, where, lambda _: None)
    assert (done.reused, done.computed, done.missing) == (4, 0, 0)


@cases_of("same_table", "refused")
def test_what_cannot_be_done_is_reported_in_a_line(tvimdesign, study_file, tmp_path, words, message):
    done = tvimdesign("sweep", study_file, "--out", tmp_path / "out", *words)
    assert done.returncode == 2, done.stderr
    assert message in done.stderr
    assert "Traceback" not in done.stderr


def test_a_folder_of_results_is_not_written_over(tvimdesign, study_file, one_process):
    done = tvimdesign("sweep", study_file, "--out", one_process)
    assert done.returncode == 2
    assert "--resume goes on with a front or a sweep" in done.stderr


@pytest.mark.gate
def test_a_cell_that_kills_its_workers_is_a_row_and_the_others_are_kept(study_file, tmp_path, monkeypatch):
    (tmp_path / "sitecustomize.py").write_text(KILLED_BY_TWO_MILLIMETRES)
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{ROOT}")
    sweep_plan = plan(study_file, "sweep.over.pcl_inner_radius=[20 mm]")
    cells = [Cell(f"{number:032x}", sweep_plan.texts(number)) for number in range(3)]
    spent = Pool(sweep_plan, tmp_path, 1).answer(cells, lambda _: None)
    shards = Shards(tmp_path, sweep_plan.columns)
    stored_answers = list(shards.cells(cell.key for cell in cells))
    assert [stored.status for stored in stored_answers] == ["evaluated", "evaluated", "crashed"]
    assert stored_answers[2].reason.startswith("its process ended with code -9")
    assert (spent.cells, spent.died) == (3, 2)


KILLED_BY_TWO_MILLIMETRES = """
import os, signal, sys
if sys.argv[0] == "-m" and "tvimdesign.sweep.pool" in sys.orig_argv:
    from tvimdesign.sweep.answers import CellAnswers
    answer = CellAnswers.answer
    def deadly(self, cell):
        if cell.texts[0] == "2 mm":
            os.kill(os.getpid(), signal.SIGKILL)
        return answer(self, cell)
    CellAnswers.answer = deadly
"""


def test_outputs_and_executors_are_read_from_words(study_file):
    assert Executor.of(2, "").part == (1, 1)
    assert Executor.of(0, "3/8").part == (3, 8)
    for wrong in ("0/3", "4/3", "a/3", "3", "1/"):
        with pytest.raises(InputError, match="expected part/parts"):
            Executor.of(0, wrong)
    sweep_plan = plan(study_file)
    assert sweep_plan.columns == ("module_mass", "envelope_diameter", "response_time", "spring_stiffness")
    assert sweep_plan.count == 6


@pytest.mark.slow
def test_a_disk_that_fills_once_costs_no_cell(study_file, one_process, tmp_path):
    out, room = tmp_path / "out", 900  # B: the manifest has 850, six cells have 1050
    words = ["sweep", str(study_file), "--out", str(out), "--no-plots", "--workers", "1"]
    full = subprocess.run(
        [sys.executable, "-m", "tvimdesign", *words], env=environment(), cwd=ROOT, capture_output=True,
        text=True, check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room, room)),
    )  # fmt: skip
    assert full.returncode == 4, full.stderr
    assert "the cells before are kept: make room, then the same command with --resume goes on" in full.stderr
    assert "Traceback" not in full.stderr
    count = len(Shards(out, plan(study_file).columns))
    assert 0 < count < 6
    assert swept(study_file, out, resume=True, workers=1)["reused"] == count
    assert tables(out) == tables(one_process)


@pytest.mark.slow
def test_optimised_cells_are_the_same_bytes_for_one_and_two_workers(tmp_path):
    path = tmp_path / "optimised.yaml"
    text = study_path("paper_shear").read_text()
    over = (
        "{pcl_thickness: {from: 0.6 mm, to: 1.2 mm, count: 6}, operating_points.hot.temperature: [100 degC, 105 degC]}"
    )
    path.write_text(f"{text}\nsweep: {{over: {over}}}\n")
    first = swept(path, tmp_path / "one", workers=1)
    second = swept(path, tmp_path / "two", workers=2)
    assert tables(tmp_path / "one") == tables(tmp_path / "two")
    assert first["warm"] == second["warm"] == 12
    cold = tvim.load(path).set(pcl_thickness="1.2 mm").run(progress=False)
    table = rows(tmp_path / "one")
    assert float(table[-2]["module_mass"]) == pytest.approx(cold["module_mass"].magnitude, rel=2e-2)
