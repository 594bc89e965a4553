"""The figure of a sweep: lines over a grid, a cloud over a sample, and what has no number left out."""

from pathlib import Path

import pytest

from tvimdesign.report.figures.analysis_figures import sweep
from tvimdesign.report.sweep.sweep_figures import figure_data
from tvimdesign.study.tree import tree_of_values
from tvimdesign.sweep.plan import SweepPlan, plan_of
from tvimdesign.sweep.swept_cells import CellTable

THICKNESS = {"from": "0.6 mm", "to": "2 mm"}


def plan(**section: object) -> SweepPlan:
    return plan_of(tree_of_values({"mode": "shear", "sweep": section}, "study", Path()))


def seen(asked: SweepPlan, masses: list[float | None]) -> CellTable:
    table = CellTable(asked)
    ends = [["evaluated", 0, 0.1, ""] if mass else ["refused", None, None, "no"] for mass in masses]
    rows = [[number + 1, *asked.axis_values(number), *end, mass, 100.0, float("inf")]
            for number, (mass, end) in enumerate(zip(masses, ends, strict=True))]  # fmt: skip
    assert list(table.seeing(rows)) == rows
    return table


def test_a_grid_has_a_line_for_each_word_and_no_cells_without_numbers() -> None:
    asked = plan(over={"pcl_thickness": {**THICKNESS, "count": 3}, "rate_model": ["smi", "bending"]})
    table = seen(asked, [5.0, 6.0, 4.0, None, 3.0, 2.0])
    data = figure_data(asked, table)
    masses = data["panels"][0]["series"]
    assert {series["label"]: series["y"] for series in masses} == {"smi": [5.0, 4.0, 3.0], "bending": [6.0, 2.0]}
    assert data["panels"][2]["series"][0]["y"] == []  # what never happens
    assert data["joined"]
    assert table.best["module_mass"] == {"cell": 6, "value": 2.0, "unit": "g"}
    assert table.statuses == {"evaluated": 5, "refused": 1}
    figure = sweep(data)
    assert [axes.get_ylabel() for axes in figure.axes] == [panel["label"] for panel in data["panels"]]
    assert figure.axes[2].get_xlabel() == "PCL thickness (mm)"


@pytest.mark.parametrize("method", ["sobol", "latin_hypercube"])
def test_a_sample_is_a_cloud_over_two_axes(method: str) -> None:
    asked = plan(method=method, count=8, over={"pcl_thickness": THICKNESS, "current": {"from": "1 A", "to": "2 A"}})
    data = figure_data(asked, seen(asked, [float(number + 1) for number in range(8)]))
    assert data["y"] == "Current (A)"
    assert data["panels"][0]["series"][0]["colour"] == [float(number + 1) for number in range(8)]
    assert len(sweep(data).axes) == 6  # each panel has its scale
