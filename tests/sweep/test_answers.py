"""A cell's answer depends on its study alone: not on the cells before it, nor on the compiled module it shares."""

from __future__ import annotations

from pathlib import Path

import pytest
from small_sweeps import plan

import tvimdesign as tvim
from tvimdesign.sweep.answers import CellAnswers
from tvimdesign.sweep.chunks import CellQueue
from tvimdesign.sweep.work import Cell, CellAnswer, SweptStudy


def answers(path: Path, order: list[int], *settings: str) -> dict[int, CellAnswer]:
    asked = plan(path, *settings)
    found = CellAnswers(SweptStudy.of(asked))
    return {number: found.answer(Cell("", asked.points.texts(number))) for number in order}


def test_the_order_of_cells_changes_no_digit(study_file: Path) -> None:
    over = "sweep.over={pcl_thickness: [0.6 mm, 1 mm], arc_count: [3, 4]}"
    forward, backward = answers(study_file, [0, 1, 2, 3], over), answers(study_file, [3, 0], over)
    assert backward == {number: forward[number] for number in backward}
    assert len({one.values for one in forward.values()}) == 4


@pytest.mark.slow
def test_optimised_cells_are_the_same_in_any_order(tmp_path: Path) -> None:
    path = tmp_path / "study.yaml"
    path.write_text(tvim.example("paper_shear").text)
    over = "sweep={over: {pcl_thickness: [0.6 mm, 0.9 mm], require.holding_torque: ['>= 12 N.m', '>= 120 N.m']}}"
    one = "solver.starts=1"
    forward, backward = answers(path, [0, 1, 2, 3], over, one), answers(path, [2, 0], over, one)
    assert backward == {number: forward[number] for number in backward}
    assert [forward[number].warm for number in (0, 2)] == [True, True]
    assert forward[1].status == "infeasible"
    assert "breaks" in forward[1].reason


def test_workers_stay_with_a_kind_and_a_dead_one_s_cells_run_alone(study_file: Path) -> None:
    asked = plan(study_file, "sweep.over={pcl_thickness: [1 mm, 2 mm], rate_model: [smi, bending]}")
    cells = [Cell(str(number), asked.points.texts(number)) for number in range(4)]
    left = CellQueue(cells, SweptStudy.of(asked), workers=2)
    first, other, second = left.next(1), left.next(2), left.next(1)
    assert [one.texts[1] for one in (*first, *other, *second)] == ["smi", "bending", "smi"]
    left.done(1000, 1.0)
    left.put_back([*first, *second])
    assert [len(left.next(1)) for _ in range(3)] == [1, 1, 1]
    assert left.next(1) == []
    assert len(left) == 0


def test_own_records_are_found_by_a_worker_that_began_in_another_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = "mode: shear\ncatalog: records\nsolver: {cells: 6}\nsweep: {over: {spring_material: [own]}}\n"
    own = "title: Own\nbased_on: music_wire\nvalues: {stress_relief_temperature: {value: 250, unit: degC, "
    (tmp_path / "records/spring_materials").mkdir(parents=True)
    (tmp_path / "records/spring_materials/own.yaml").write_text(f"{own}status: datasheet, source: a sheet}}}}\n")
    (tmp_path / "study.yaml").write_text(study)
    monkeypatch.chdir(tmp_path)
    asked = plan(Path("study.yaml"))
    job = SweptStudy.of(asked)
    monkeypatch.chdir("/")
    assert CellAnswers(job).answer(Cell("key", asked.points.texts(0))).status == "evaluated"
