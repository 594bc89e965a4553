"""The figures of a run: nothing on them is cut off, and they show what the run came to."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.report.figures import run_figures
from tvimdesign.report.figures.canvas import png
from tvimdesign.report.run.run_plot_data import plot_data
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study_text

STUDIES = {
    "optimised": """
mode: shear
vary: {wire_diameter: [1.5 mm, 3 mm], pcl_thickness: [0.6 mm, 2 mm]}
minimize: {module_mass: 1, response_time: 1}
solver: {starts: 1, cells: 8}
""",
    "evaluated, in compression": "mode: compression\nsolver: {cells: 8}\n",
}
NAMES = ("cycle", "impedance", "mass", "bounds")


@pytest.fixture(scope="module", params=STUDIES)
def found(request: pytest.FixtureRequest) -> StudyResult:
    study = read_study_text(STUDIES[request.param], "a test")
    return answer(study, Catalog(), table_for(study.mode))


@pytest.fixture(scope="module")
def data(found: StudyResult) -> dict[str, Any]:
    return plot_data(found, table_for(found.design.mode))


def drawn(name: str, data: dict[str, Any]) -> Figure:
    figure: Figure = getattr(run_figures, name)(data[name])
    return figure


def whole(figure: Figure) -> bool:
    """Whether all that is drawn lies on the page."""
    png(figure)
    used, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
    return min(used.x0, used.y0) >= 0.0 and used.x1 <= width and used.y1 <= height


@pytest.mark.parametrize("name", NAMES)
def test_nothing_is_cut_off(name: str, data: dict[str, Any]) -> None:
    assert whole(drawn(name, data))


@pytest.mark.parametrize("count", [0, 1, 80])
def test_bounds_have_room_for_any_number_of_limits(count: int, data: dict[str, Any]) -> None:
    limits = data["bounds"]["limits"]
    many = (limits * (count // len(limits) + 1))[:count]
    assert whole(drawn("bounds", {"bounds": data["bounds"] | {"limits": many}}))


def test_a_file_has_the_pixels_of_its_size_and_no_transparent_ones(data: dict[str, Any]) -> None:
    picture = Image.open(io.BytesIO(png(drawn("mass", data))))
    assert picture.size == (960, 420)  # 8 by 3.5 inches of 120 dots
    assert picture.mode == "RGB"


def test_profiles_run_from_face_to_face_at_moments_of_the_stage(found: StudyResult, data: dict[str, Any]) -> None:
    history, depths = data["cycle"]["softening"], data["cycle"]["depths"]
    curves = found.histories["softening"]
    assert len(depths) == 10  # eight cells between two faces
    assert np.all(np.diff(depths) > 0.0)
    assert history["profiles"][0]["time"] == curves["time"][0]
    assert history["profiles"][-1]["time"] == curves["time"][-1]
    for profile in history["profiles"]:
        at = curves["time"].index(profile["time"])
        assert len(profile["temperatures"]) == len(depths)
        assert profile["temperatures"][0] == curves["near_face"][at]
        assert profile["temperatures"][-1] == curves["far_face"][at]


def test_bars_are_the_parts_the_module_has_and_add_up_to_its_mass(found: StudyResult, data: dict[str, Any]) -> None:
    (axes,) = drawn("mass", data).axes
    bars = [bar.get_width() for bar in axes.patches]
    assert min(bars) > 0.0
    assert sum(bars) == pytest.approx(1e3 * found.design.value("module_mass"), rel=1e-9)
