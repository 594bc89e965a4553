"""Swept cells in the explorer, and its controls."""

import csv
import json
from pathlib import Path
from typing import Any

import pytest
from explored import SMALL, awaited, talking
from served_explorer import serving
from support import sample_text

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import from_si
from tvimdesign.explore.source import open_source
from tvimdesign.explore.state import State, controls_shown, sized_state, tree_of
from tvimdesign.report.output.command import Command
from tvimdesign.report.sweep.sweep_study import sweep_folder
from tvimdesign.study import read_study_text, read_tree
from tvimdesign.study.sizing import JointTask, study_text
from tvimdesign.study.tree import tree_of_text
from tvimdesign.sweep.plan import plan_of
from tvimdesign.sweep.run_sweep import Executor
from tvimdesign.sweep.shards import SHARDS

STUDY = sample_text("swept_cells")
"""The first cell has no design: its layer is too thin for the strain, which nothing that varies changes."""
OWN = sample_text("own_heat_paths")


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the sweep."""
    return _swept(tmp_path_factory.mktemp("swept"), STUDY)


def _swept(folder: Path, text: str) -> Path:
    path = folder / "swept.yaml"
    path.write_text(text, encoding="utf-8")
    plan = plan_of(tree_of_text(text, str(path), "swept", folder))
    command = Command(folder / "out", keep=SHARDS, progress=lambda _: None)
    sweep_folder(plan, Executor(workers=1), command, plots=False)
    return folder / "out"


def _table(folder: Path) -> list[dict[str, str]]:
    with (folder / "cells.csv").open(encoding="utf-8-sig", newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.gate
def test_the_page_begins_at_the_best_cell_and_opens_each(swept):
    source = open_source(swept)
    rows = _table(swept)
    assert [row["status"] for row in rows] == ["infeasible", "optimal", "optimal"]
    assert source.first.way == "evaluate"
    assert source.first.changes == {"pcl_thickness": "2 mm", "require.peak_power": "<= 11 W"}  # the faster of the two
    assert source.first.at == {"current": f"{rows[2]['current']} A"}
    shown = source.points_shown()
    assert [point["number"] for point in shown["points"]] == [2, 3]
    place = shown["names"].index("response_time")
    reported = [point["values"][place] for point in shown["points"]]
    assert reported == [float(row["response_time"]) for row in rows[1:]]
    assert shown["words"]["one"] == "cell"
    state = source.at_point(2, source.first)
    study = read_tree(tree_of(source.tree, state))
    assert from_si(study.module["pcl_thickness"], "mm") == pytest.approx(2.0, rel=1e-12)
    assert study.module["current"] == pytest.approx(float(_table(swept)[1]["current"]), rel=1e-11)
    assert [limit.limit for limit in study.require] == [9.0]
    free = read_tree(tree_of(source.tree, state, "optimize"))
    assert list(free.vary) == ["current"]
    nothing = source.at_point(1, state)
    assert (nothing.way, nothing.at) == ("optimize", {"current": "1.5 A"})  # asked once more, from the study's start


@pytest.mark.gate
def test_what_is_no_cell_or_no_finished_sweep_is_refused_in_words(swept, tmp_path):
    source = open_source(swept)
    with pytest.raises(InputError, match="cell 4: the sweep has the cells 1 to 3"):
        source.at_point(4, source.first)
    with pytest.raises(InputError, match="--set: the cells of"):
        open_source(swept, ["current=1 A"])
    (tmp_path / "shards").mkdir()
    with pytest.raises(InputError, match="its sweep has not ended"):
        open_source(tmp_path)
    for name in ("study.yaml", "sweep.json"):
        (tmp_path / name).write_bytes((swept / name).read_bytes())
    with pytest.raises(InputError, match=r"cells.sqlite: cannot be read"):
        open_source(tmp_path)
    reported = json.loads((swept / "sweep.json").read_bytes())
    (tmp_path / "sweep.json").write_text(json.dumps({**reported, "cells": 4}))
    with pytest.raises(InputError, match=r"study.yaml asks for 3 cells and the table has 4"):
        open_source(tmp_path)
    (tmp_path / "sweep.json").write_text("[]")
    with pytest.raises(InputError, match="not written by `tvimdesign sweep`"):
        open_source(tmp_path)


@pytest.mark.gate
def test_a_sweep_of_words_with_records_of_its_own_is_opened(tmp_path, monkeypatch):
    study = "mode: shear\ncatalog: records\nsolver: {cells: 6}\nsweep: {over: {spring_material: [music_wire, own]}}\n"
    records = tmp_path / "records/spring_materials"
    records.mkdir(parents=True)
    (records / "own.yaml").write_text(OWN)
    out = _swept(tmp_path, study)
    with pytest.raises(InputError, match="lies outside the study's folder"):
        open_source(out)
    monkeypatch.chdir(tmp_path)
    source = open_source(out)
    shown = source.points_shown()
    assert shown["names"][0] == "cell"
    assert source.at_point(2, source.first).changes == {"spring_material": "own"}


@pytest.mark.gate
def test_a_page_gets_the_cells_once_and_shows_the_one_it_chooses(swept, tmp_path):
    async def chosen() -> tuple[dict[str, Any], dict[str, Any], dict[str, Any], list[dict[str, Any]]]:
        async with talking(swept, tmp_path / "out") as page:
            points = await page.kind("points")
            page.heard.clear()
            state = await page.change(kind="point", number=2)
            answer = await page.until(lambda item: item["kind"] == "answer" and item["number"] == 2)
            await page.send(kind="point", number=9)
            await page.kind("refused")
            return points, state, answer, page.heard

    points, state, answer, heard = awaited(chosen())
    assert len(points["points"]["points"]) == 2
    assert not [item for item in heard if item["kind"] == "points"]
    assert (state["way"], state["undo"]) == ("evaluate", True)
    limit = next(item for item in state["controls"]["requirements"] if item["name"] == "peak_power")
    assert limit["value"] == 9.0
    names = [item["name"] for item in state["quantities"]]
    result = answer["shown"]["values"][names.index("response_time")]
    assert result == pytest.approx(float(_table(swept)[1]["response_time"]), rel=2e-3)  # as quick answers are
    assert "cell 9: the sweep has the cells 1 to 3" in heard[-1]["words"]


@pytest.mark.slow
def test_a_cell_is_clicked_and_one_is_asked_for_by_its_number(browser, swept, tmp_path):
    with serving(browser, swept, tmp_path / "out") as explorer:
        page = explorer.page
        page.get_by_role("heading", name="Cells").wait_for()
        points = page.locator("#front svg").first.locator("path[d^='M1 0A']")
        points.first.wait_for(state="attached")
        page.get_by_text("Cells, as buttons").click()
        assert page.locator("#front details button.plain").count() == points.count() == 2
        explorer.shows("peak_power <=", "11 W")
        before = explorer.number
        points.first.click(force=True)
        explorer.answered(before, "exact")
        explorer.shows("peak_power <=", "9 W")
        before = explorer.number
        page.get_by_label("Number of a cell").fill("1")
        page.get_by_role("button", name="Show this cell").click()
        explorer.answered(before, "exact")
        page.locator("#status").get_by_text("layer_strain_safety").wait_for()


CONTROLLED = sample_text("controlled_cells")


def test_controls_have_units_labels_and_groups():
    study = read_study_text(CONTROLLED)
    at = {"pcl_thickness": "0.0012 m", "arc_span": "1.3592 rad"}
    thickness, span = controls_shown(study, study, State(way="optimize", at=at))["variables"]
    assert thickness["text"] == "1.2 mm"
    assert span["unit"] == "°"
    assert span["value"] == pytest.approx(77.8764, abs=1e-4)
    assert span["text"].endswith(" deg")
    assert span["low"] < span["value"] < span["high"]
    at = {"pcl_thickness": "1 mm", "arc_span": "60 deg"}
    shown = controls_shown(study, study, State(way="optimize", at=at))
    assert shown["requirements"][0]["label"] == "diameter"
    assert all(control["label"] and control["group"] for control in [*shown["inputs"], *shown["choices"]])
    assert all(isinstance(control["value"], float) for control in shown["inputs"])


@pytest.mark.parametrize("hardware", ["small", "heavy"])
def test_a_sized_study_takes_the_place_of_the_one_that_is_open(hardware):
    text = study_text(JointTask.read("8 N.m", "1 to 2 N.m/rad", "90 mm", "60 s", "24 V, 3 A"), hardware)
    base = tree_of_text(SMALL, "small.yaml", "small", Path())
    sized, alone = read_tree(tree_of(base, sized_state(base, text))), read_study_text(text)
    assert sized.model_dump() == {**alone.model_dump(), "name": sized.name}
