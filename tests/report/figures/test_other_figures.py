"""The figures of virtual tests, fronts, comparisons and spreads, and the one page for a mail, as an editor asks."""

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from support import study_path

from tests.helpers.figures import faults, signed
from tvimdesign.report.figures import analysis_figures, design_figures
from tvimdesign.report.figures.summary_sheet import summary
from tvimdesign.report.figures.theme import as_file
from tvimdesign.report.figures.virtual_test_figures import trial as trial_figure
from tvimdesign.report.simulate_study import figure_data
from tvimdesign.simulation.virtual_tests import TESTS, find_test
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_study
from tvimdesign.study import read_study


@pytest.fixture(
    scope="module", params=["paper_reconstructed", pytest.param("paper_compression", marks=pytest.mark.slow)]
)
def resolved(request: pytest.FixtureRequest) -> ResolvedModule:
    return resolve_study(read_study(study_path(request.param)))


@pytest.fixture(scope="module")
def shown(resolved: ResolvedModule) -> Callable[[str], dict[str, Any]]:
    """What the figure of a virtual test is drawn from; each test is simulated once."""

    @cache
    def data(test: str) -> dict[str, Any]:
        return figure_data(find_test(test)(resolved))

    return data


@pytest.mark.gate
@pytest.mark.parametrize("test", TESTS)
def test_an_editor_finds_no_fault_with_a_virtual_test(test: str, shown: Callable[[str], dict[str, Any]]) -> None:
    assert faults(signed(trial_figure(shown(test)))) == []


@pytest.mark.parametrize("test", ["release", "sine"])
def test_torque_over_angle_is_in_newton_metres_and_angle_over_time_no_blob(
    test: str, shown: Callable[[str], dict[str, Any]]
) -> None:
    panels = shown(test)["panels"]
    loops = [panel for panel in panels if panel["x_label"] == "Angle (rad)"]
    assert len(loops) == 3
    assert all(panel["y_label"] == "Torque on the link (N·m)" for panel in loops)
    figure = trial_figure({"title": test, "panels": panels})
    for axes in figure.axes:
        for line in axes.lines:
            y = np.asarray(line.get_ydata(), dtype=float)
            there_and_back = np.sum(np.abs(np.diff(y))) / np.ptp(y)
            assert there_and_back <= 30.0  # a dozen swings can be told apart on an axis, hundreds are a blob


LABELS = ["Response time (s)", "Module mass (g)", "Envelope volume (cm³)"]


@pytest.mark.parametrize("outputs", [2, 3])
def test_an_editor_finds_no_fault_with_a_front(outputs: int) -> None:
    points = [[100.0 + i, 110.0 - i, 240.0 - 3.0 * i][:outputs] for i in range(8)]
    data = {"labels": LABELS[:outputs], "points": points, "optimum": points[4], "knee": 6}
    assert faults(signed(design_figures.front(data))) == []


def test_an_editor_finds_no_fault_with_other_figures() -> None:
    def line(label: str, by: float) -> dict[str, Any]:
        return {"label": label, "x": [60.0 * by, 70.0 * by], "y": [80.0, 60.0], "optimum": [[65.0 * by], [65.0]]}

    panel = {"lines": [line("shear", 1.0), line("compression", 1.1)], "x_label": LABELS[1], "y_label": LABELS[0]}
    assert faults(signed(design_figures.fronts({"title": "Fronts", "panels": [panel, panel]}))) == []
    names = ["envelope volume", "spring stiffness", "joint damping, hot"]
    parts = [{"name": f"a contributor {i}", "shares": [14.0] * 3} for i in range(7)]
    panel = {"title": "50 % of modules within limits", "label": "Spring stiffness (N·m/rad)", "counts": [1, 5, 20, 5],
             "edges": [4.8, 5.0, 5.2, 5.4, 5.6], "limits": [5.2], "as_drawn": 5.2}  # fmt: skip
    for count in (1, 3, 4, 6):
        data = {"outputs": names, "parts": parts, "panels": [panel] * count}
        assert faults(signed(analysis_figures.spread(data))) == []


ROW = ["torque held when frozen", ">= 20 N·m", "20", "19 to 23.2", "at the limit"]


def sheet_of(picture: str = "", rows: int = 10, warnings: int = 3) -> dict[str, Any]:
    return {
        "title": "Elbow, printed " * 9, "kind": "shear module", "status": "Nominal optimum: add margins " * 4,
        "tone": "warn", "heads": ["requirement", "asked", "got", "range", "margin"], "rows": [ROW] * rows,
        "facts": [("Size and mass", "89.4 mm diameter x 31.4 mm high · 117 g (115 to 120) " * 3)] * 6,
        "warnings": [("heating stops 29.6 K below the point `hot`", "require: {x: 1}")] * warnings,
        "picture": picture, "made_by": "Written by a test.",
    }  # fmt: skip


def test_a_long_label_of_a_fact_stays_in_its_column() -> None:
    sheet = sheet_of()
    sheet["facts"] = [("Active constraints with margins", "step from floor to hub >= 0 mm")] * 3
    texts = {text.get_text(): text.get_window_extent() for text in summary(sheet).texts}
    labels = [texts["Active constraints"], texts["with margins"]]
    assert max(box.x1 for box in labels) < texts["step from floor to hub >= 0 mm"].x0


@pytest.mark.parametrize("rows", [0, 10, 60])
def test_it_is_one_sheet_of_a4(tmp_path: Path, rows: int) -> None:
    Image.new("RGB", (1800, 800), "grey").save(tmp_path / "preview.png")
    figure = summary(sheet_of(str(tmp_path / "preview.png"), rows))
    pdf = as_file(figure, "pdf")
    assert len(re.findall(rb"/Type /Page\b", pdf)) == 1
    (box,) = re.findall(rb"/MediaBox\s*\[([^\]]+)\]", pdf)
    assert tuple(map(float, box.split()[2:])) == pytest.approx((595.3, 841.9), abs=1.0)  # points, ISO 216
    places = [text.get_position() for text in figure.texts]
    assert min(y for _, y in places) > 0.04
    assert all(0.0 < x < 1.0 and y < 1.0 for x, y in places)
