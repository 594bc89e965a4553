"""The figures of a run: nothing on them is cut off, and they show what the run came to."""

import io
import re
from importlib import import_module
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from tests.helpers.figures import faults, signed
from tvimdesign.device import table_for
from tvimdesign.report.figures.theme import as_file, png
from tvimdesign.report.run.run_plot_data import drawings, plot_data
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study_text

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
