"""The figures of runs, virtual tests, fronts, comparisons and spreads, as an editor asks."""

import io
import re
from collections.abc import Callable
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image
from support import study_path

from tests.helpers.figures import faults, signed
from tvimdesign.device import table_for
from tvimdesign.report.figures import analysis_figures, design_figures
from tvimdesign.report.figures.summary_sheet import summary
from tvimdesign.report.figures.theme import as_file, png
from tvimdesign.report.figures.virtual_test_figures import trial as trial_figure
from tvimdesign.report.run.run_plot_data import drawings, plot_data
from tvimdesign.report.simulate_study import figure_data
from tvimdesign.simulation.virtual_tests import TESTS, find_test
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_study
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study, read_study_text


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


STUDIES = {
    "optimised": """
mode: shear
vary: {wire_diameter: [1.5 mm, 3 mm], pcl_thickness: [0.6 mm, 2 mm]}
minimize: {module_mass: 1, response_time: 1}
solver: {starts: 1, cells: 8}
""",
    "evaluated, in compression": """
mode: compression
module: {response_criterion: softening, current: 2 A}
solver: {cells: 8}
""",
}
NAMES = ("cycle", "stiffness_and_damping", "power_and_energy", "impedance", "torque")


@pytest.fixture(scope="module", params=STUDIES)
def found(request: pytest.FixtureRequest) -> StudyResult:
    study = read_study_text(STUDIES[request.param], "a test")
    return answer(study)


@pytest.fixture(scope="module")
def data(found: StudyResult) -> dict[str, Any]:
    return plot_data(found, table_for(found.design.mode))


def drawn(figure: str, data: dict[str, Any]) -> Figure:
    """A figure by `file.function`."""
    file, _, function = figure.partition(".")
    made: Figure = getattr(import_module(f"tvimdesign.report.figures.{file}"), function)(data)
    return made


@pytest.mark.parametrize("name", NAMES)
def test_an_editor_finds_no_fault(name: str, found: StudyResult) -> None:
    (asked,) = [one for one in drawings(found, table_for(found.design.mode)) if one.file == name]
    assert faults(signed(drawn(asked.figure, asked.data))) == []


def test_files_have_their_pixels(data: dict[str, Any]) -> None:
    figure = drawn("design_figures.torque", data["torque"])
    picture = Image.open(io.BytesIO(png(figure)))
    assert picture.size == (2130, 780)  # 7.1 by 2.6 inches of 300 dots
    assert picture.mode == "RGB"
    assert picture.info["dpi"] == pytest.approx((300.0, 300.0), abs=0.01)


@pytest.mark.parametrize("found", ["optimised"], indirect=True)
def test_vector_files_are_what_they_say_and_the_same_each_time(data: dict[str, Any]) -> None:
    pdf, svg = ([as_file(signed(drawn("design_figures.torque", data["torque"])), ending) for _ in range(2)]
                for ending in ("pdf", "svg"))  # fmt: skip
    assert pdf[0] == pdf[1]
    assert svg[0] == svg[1]
    assert pdf[0].startswith(b"%PDF-")
    assert pdf[0].rstrip().endswith(b"%%EOF")
    assert b"/Type3" not in pdf[0]
    assert b"/Subtype /Image" not in pdf[0]
    page = re.search(rb"/MediaBox \[ 0 0 ([0-9.]+) ([0-9.]+) \]", pdf[0])
    assert page
    assert [float(size) for size in page.groups()] == pytest.approx([72.0 * 7.1, 72.0 * 2.6])
    root = ElementTree.fromstring(svg[0])
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert len(list(root.iter("{http://www.w3.org/2000/svg}path"))) > 20
    assert not list(root.iter("{http://www.w3.org/2000/svg}image"))


def test_curves_and_loops_are_those_of_the_table(found: StudyResult, data: dict[str, Any]) -> None:
    for phase, curves in found.histories.items():
        point = "hot" if phase == "softening" else "cold"
        turning = 2.0 * np.pi * found.design.value(f"frequency@{point}")
        both = np.hypot(curves["joint_stiffness"], turning * np.array(curves["joint_damping"]))
        assert both == pytest.approx(np.array(curves["joint_impedance"]), rel=1e-9)
    curves = found.histories["softening"]
    assert curves["electrical_energy"][0] == 0.0
    assert curves["electrical_energy"][-1] == pytest.approx(found.design.value("switch_energy"), rel=2e-3)
    assert max(curves["electrical_power"]) == pytest.approx(found.design.value("peak_power"), rel=2e-3)
    stroke = found.design.value("stroke")
    for point, loop in zip(found.design.study["operating_points"], data["torque"]["loops"], strict=True):
        angle, torque = np.array(loop["angle"]), np.array(loop["torque"])
        top = int(np.argmax(angle))
        assert torque[top] == pytest.approx(found.design.value(f"joint_stiffness@{point}") * stroke, rel=1e-6)
        lossy = 2.0 * np.pi * found.design.value(f"frequency@{point}") * found.design.value(f"joint_damping@{point}")
        assert np.trapezoid(torque, angle) == pytest.approx(np.pi * lossy * stroke**2, rel=2e-3)  # of a Kelvin body
    history, depths = data["cycle"]["softening"], data["cycle"]["depths"]
    assert len(depths) == 10  # eight cells between two faces
    assert np.all(np.diff(depths) > 0.0)
    assert history["profiles"][0]["time"] == curves["time"][0]
    assert history["profiles"][-1]["time"] == curves["time"][-1]
    for profile in history["profiles"]:
        at = curves["time"].index(profile["time"])
        assert len(profile["temperatures"]) == len(depths)
        assert profile["temperatures"][0] == curves["near_face"][at]
        assert profile["temperatures"][-1] == curves["far_face"][at]
