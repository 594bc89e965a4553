"""The page and the figure of a sweep: what they show and leave out."""

import json
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import html5lib
import pytest

from tvimdesign.report.figures.analysis_figures import sweep
from tvimdesign.report.output.command import Command
from tvimdesign.report.page.page_file import FILE
from tvimdesign.report.sweep.sweep_figures import figure_data
from tvimdesign.report.sweep.sweep_study import sweep_page
from tvimdesign.study.tree import tree_of_values
from tvimdesign.sweep import swept_cells as cell_table
from tvimdesign.sweep.plan import SweepPlan, plan_of
from tvimdesign.sweep.shards import columns
from tvimdesign.sweep.swept_cells import CellTable

THICKNESS = {"from": "0.6 mm", "to": "2 mm"}
GRID: dict[str, Any] = {"over": {"pcl_thickness": {**THICKNESS, "count": 3}, "rate_model": ["smi", "bending"]}}
CLOUD: dict[str, Any] = {
    "method": "sobol", "count": 8, "over": {"pcl_thickness": THICKNESS, "current": {"from": "1 A", "to": "2 A"}}
}  # fmt: skip


def plan(section: dict[str, Any]) -> SweepPlan:
    return plan_of(tree_of_values({"mode": "shear", "name": "small", "sweep": section}, "study", Path()))


def seen(sweep_plan: SweepPlan, masses: Iterable[float | None]) -> CellTable:
    """Cells with these masses, refused where there is none; every even one violates a limit, and none is ever soft."""
    table, rows = CellTable(sweep_plan), [row(sweep_plan, *cell) for cell in enumerate(masses, start=1)]
    assert list(table.seeing(rows)) == rows
    return table


def row(sweep_plan: SweepPlan, number: int, mass: float | None) -> list[Any]:
    cells = ["evaluated", (number + 1) % 2, 0.1, ""] if mass else ["refused", None, None, "no such <module>"]
    outputs = {"module_mass": mass, "envelope_diameter": 100.0 if mass else None, "response_time": float("inf")}
    names = [column.name for column in columns(sweep_plan) if column.kind == "output"]
    return [number, *sweep_plan.axis_values(number - 1), *cells, *(outputs[name] for name in names)]


def page(table: CellTable, out: Path) -> str:
    with Command(out, overwrite=True) as command:
        command.folder.write("cells.csv", "cell\n")
        command.finish("swept", {}, {}, page=sweep_page(table, command))
    text = (out / FILE).read_text("utf-8")
    html5lib.HTMLParser(strict=True).parse(text)
    return text


def drawn(text: str) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(re.findall(r'id="page-data">(.*?)</script>', text, re.DOTALL)[0])
    return data


def test_it_says_what_was_swept_and_how_it_ended(tmp_path):
    sweep_plan = plan(GRID)
    text = page(seen(sweep_plan, [5.0, 6.0, 4.0, None, 3.0, 2.0]), tmp_path / "out")
    assert "5 OF 6 CELLS EVALUATED" in text
    assert "<code>pcl_thickness</code> from 0.6 mm to 2 mm, 3 values; <code>rate_model</code>: smi, bending" in text
    assert "grid; each cell is evaluated" in text
    assert "3 g in cell 5 (" in text
    assert "), among the feasible cells" in text
    failed = text[text.index('<section id="failed"') :]
    assert "no such &lt;module&gt;" in failed[: failed.index("</section>")]
    assert "every cell as CSV" in text
    assert "the figure</a>" not in text  # there is none beside it


def test_lines_and_brushes_are_those_of_the_cells(tmp_path):
    sweep_plan = plan(GRID)
    data = drawn(page(seen(sweep_plan, [5.0, 6.0, 4.0, None, 3.0, 2.0]), tmp_path / "out"))
    assert list(data) == ["curves"]  # over one number: nothing to brush
    mass, size = data["curves"]["panels"]  # none of what never happens
    assert size["y_label"] == "Envelope diameter (mm)"
    lines = {line["label"]: (line["y"], line["hollow"]) for line in mass["lines"]}
    assert lines == {"smi": ([5.0, 4.0, 3.0], [False] * 3), "bending": ([6.0, 2.0], [True] * 2)}
    sweep_plan = plan(CLOUD)
    data = drawn(page(seen(sweep_plan, [None, *map(float, range(2, 9))]), tmp_path / "out"))
    assert list(data) == ["brushed"]
    assert data["brushed"]["names"] == ["pcl_thickness", "current", "module_mass", "envelope_diameter"]
    assert [point["number"] for point in data["brushed"]["points"]] == [2, 3, 4, 5, 6, 7, 8]
    assert data["brushed"]["points"][0]["hollow"]


def test_of_many_cells_some_are_on_the_page_and_it_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr(cell_table, "MOST_LISTED", 3)
    monkeypatch.setattr(cell_table, "MOST_FAILED", 1)
    sweep_plan = plan(CLOUD)
    text = page(seen(sweep_plan, [1.0, None, None, 4.0, 5.0, 6.0, 7.0, 8.0]), tmp_path / "out")
    assert "3 of 8 cells are in this table, one in 3. cells.csv and cells.sqlite have all." in text
    assert "The first 1 of 2; `reason` in cells.csv has all." in text
    assert [point["number"] for point in drawn(text)["brushed"]["points"]] == [1, 4, 7]


def test_a_grid_has_a_line_for_each_word_and_no_cells_without_numbers():
    sweep_plan = plan(GRID)
    table = seen(sweep_plan, [5.0, 6.0, 4.0, None, 3.0, 2.0])
    data = figure_data(table)
    masses = data["panels"][0]["series"]
    assert {series["label"]: series["y"] for series in masses} == {"smi": [5.0, 4.0, 3.0], "bending": [6.0, 2.0]}
    assert data["panels"][2]["series"][0]["y"] == []  # what never happens
    assert data["joined"]
    assert table.best["module_mass"] == {"cell": 5, "value": 3.0, "unit": "g"}  # cell 6 violates a limit
    assert table.statuses == {"evaluated": 5, "refused": 1}
    figure = sweep(data)
    assert [axes.get_ylabel() for axes in figure.axes] == [panel["label"] for panel in data["panels"]]
    assert figure.axes[2].get_xlabel() == "PCL thickness (mm)"


@pytest.mark.parametrize("method", ["sobol", "latin_hypercube"])
def test_a_sample_is_a_cloud_over_two_axes(method):
    sweep_plan = plan({**CLOUD, "method": method})
    data = figure_data(seen(sweep_plan, [float(number + 1) for number in range(8)]))
    assert data["y"] == "Current (A)"
    assert data["panels"][0]["series"][0]["colour"] == [float(number + 1) for number in range(8)]
    assert len(sweep(data).axes) == 6  # each panel has its scale
