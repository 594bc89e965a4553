"""The figures of runs, virtual tests, fronts, comparisons and spreads, their theme, and the process that draws."""

import io
import json
import re
import subprocess
import zlib
from collections.abc import Callable
from functools import cache
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from fontTools import subset
from fontTools.ttLib import TTFont
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from PIL import Image
from small_sweeps import SMALL
from support import sample_text, study_path

import tvimdesign as tvim
from tests.helpers.figures import faults, signed
from tvimdesign.base.child_process import start_child
from tvimdesign.report.figures import analysis_figures, design_figures, theme
from tvimdesign.report.figures.design_figures import summary
from tvimdesign.report.figures.virtual_test_figures import drawn
from tvimdesign.report.figures.virtual_test_figures import trial as trial_figure
from tvimdesign.report.output import plot_process
from tvimdesign.report.output.numbers import axis_label, name_in_words
from tvimdesign.report.run.run_page import drawings, plot_data
from tvimdesign.report.simulate_study import figure_data
from tvimdesign.simulation.virtual_tests import TESTS, find_test
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_study
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study, read_study_text


@pytest.fixture(
    scope="module", params=["paper_reconstructed", pytest.param("paper_compression", marks=pytest.mark.slow)]
)
def resolved(request: pytest.FixtureRequest) -> ResolvedModule:
    return resolve_study(read_study(study_path(request.param)))


@pytest.fixture(scope="module")
def shown(resolved: ResolvedModule) -> Callable[[str], dict[str, Any]]:
    """Return the data that a virtual test's figure is drawn from; each test is simulated once."""

    @cache
    def data(test: str) -> dict[str, Any]:
        return figure_data(find_test(test)(resolved))

    return data


@pytest.mark.gate
@pytest.mark.parametrize("test", TESTS)
def test_an_editor_finds_no_fault_with_a_virtual_test(test, shown):
    assert faults(signed(trial_figure(shown(test)))) == []


@pytest.mark.parametrize("test", ["release", "sine"])
def test_torque_over_angle_is_in_newton_metres_and_angle_over_time_no_blob(test, shown):
    panels = shown(test)["panels"]
    loops = [panel for panel in panels if panel["x_label"] == "Angle (rad)"]
    assert len(loops) == 3
    assert all(panel["y_label"] == "Torque on the link (N·m)" for panel in loops)
    figure = trial_figure({"title": test, "panels": panels})
    for axes in figure.axes:
        for line in axes.lines:
            y = np.asarray(line.get_ydata(), dtype=float)
            there_and_back = np.sum(np.abs(np.diff(y))) / np.ptp(y)
            assert there_and_back <= 30.0  # a dozen swings are distinct on an axis, hundreds are a blob


LABELS = ["Response time (s)", "Module mass (g)", "Envelope volume (cm³)"]


@pytest.mark.parametrize("outputs", [2, 3])
def test_an_editor_finds_no_fault_with_a_front(outputs):
    points = [[100.0 + i, 110.0 - i, 240.0 - 3.0 * i][:outputs] for i in range(8)]
    data = {"labels": LABELS[:outputs], "points": points, "optimum": points[4], "knee": 6}
    assert faults(signed(design_figures.front(data))) == []


def test_an_editor_finds_no_fault_with_other_figures():
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


def test_a_long_label_of_a_fact_stays_in_its_column():
    sheet = sheet_of()
    sheet["facts"] = [("Active constraints with margins", "step from floor to hub >= 0 mm")] * 3
    texts = {text.get_text(): text.get_window_extent() for text in summary(sheet).texts}
    labels = [texts["Active constraints"], texts["with margins"]]
    assert max(box.x1 for box in labels) < texts["step from floor to hub >= 0 mm"].x0


@pytest.mark.parametrize("rows", [0, 10, 60])
def test_it_is_one_sheet_of_a4(tmp_path, rows):
    Image.new("RGB", (1800, 800), "grey").save(tmp_path / "preview.png")
    figure = summary(sheet_of(str(tmp_path / "preview.png"), rows))
    pdf = theme.as_file(figure, "pdf")
    assert len(re.findall(rb"/Type /Page\b", pdf)) == 1
    (box,) = re.findall(rb"/MediaBox\s*\[([^\]]+)\]", pdf)
    assert tuple(map(float, box.split()[2:])) == pytest.approx((595.3, 841.9), abs=1.0)  # points, ISO 216
    places = [text.get_position() for text in figure.texts]
    assert min(y for _, y in places) > 0.04
    assert all(0.0 < x < 1.0 and y < 1.0 for x, y in places)


STUDIES = {"optimised": "figures_of_shear", "evaluated, in compression": "figures_of_compression"}
NAMES = ("cycle", "stiffness_and_damping", "power_and_energy", "impedance", "torque")


@pytest.fixture(scope="module", params=STUDIES)
def result(request: pytest.FixtureRequest) -> StudyResult:
    study = read_study_text(sample_text(STUDIES[request.param]), "a test")
    return answer(study)


@pytest.fixture(scope="module")
def data(result: StudyResult) -> dict[str, Any]:
    return plot_data(result)


def figure_of(figure: str, data: dict[str, Any]) -> Figure:
    """Return a figure by `file.function`."""
    file, _, function = figure.partition(".")
    made: Figure = getattr(import_module(f"tvimdesign.report.figures.{file}"), function)(data)
    return made


@pytest.mark.parametrize("name", NAMES)
def test_an_editor_finds_no_fault(name, result):
    (drawing,) = [candidate for candidate in drawings(result) if candidate.file == name]
    assert faults(signed(figure_of(drawing.figure, drawing.data))) == []


def test_files_have_their_pixels(data):
    figure = figure_of("design_figures.torque", data["torque"])
    picture = Image.open(io.BytesIO(theme.png(figure)))
    assert picture.size == (2130, 780)  # 7.1 by 2.6 inches of 300 dots
    assert picture.mode == "RGB"
    assert picture.info["dpi"] == pytest.approx((300.0, 300.0), abs=0.01)


@pytest.mark.parametrize("result", ["optimised"], indirect=True)
def test_vector_files_are_what_they_say_and_the_same_each_time(data):
    pdf, svg = ([theme.as_file(signed(figure_of("design_figures.torque", data["torque"])), ending) for _ in range(2)]
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


def test_curves_and_loops_are_those_of_the_table(result, data):
    for phase, curves in result.histories.items():
        point = "hot" if phase == "softening" else "cold"
        turning = 2.0 * np.pi * result.design.value(f"frequency@{point}")
        both = np.hypot(curves["joint_stiffness"], turning * np.array(curves["joint_damping"]))
        assert both == pytest.approx(np.array(curves["joint_impedance"]), rel=1e-9)
    curves = result.histories["softening"]
    assert curves["electrical_energy"][0] == 0.0
    assert curves["electrical_energy"][-1] == pytest.approx(result.design.value("switch_energy"), rel=2e-3)
    assert max(curves["electrical_power"]) == pytest.approx(result.design.value("peak_power"), rel=2e-3)
    full, held = result.design.value("stroke"), result.design.value("holding_torque")
    for point, loop in zip(result.design.study["operating_points"], data["torque"]["loops"], strict=True):
        angle, torque = np.array(loop["angle"]), np.array(loop["torque"])
        stiffness, top = result.design.value(f"joint_stiffness@{point}"), int(np.argmax(angle))
        stroke = min(full, held / stiffness)  # a frozen joint breaks beyond what it holds
        assert (stroke < full) == (point == "cold")
        assert torque[top] == pytest.approx(stiffness * stroke, rel=1e-6)
        lossy = 2.0 * np.pi * result.design.value(f"frequency@{point}") * result.design.value(f"joint_damping@{point}")
        assert np.trapezoid(torque, angle) == pytest.approx(np.pi * lossy * stroke**2, rel=2e-3)  # of a Kelvin body
        angle, torque = np.array(loop["spring_angle"]), np.array(loop["springs"])
        assert angle[[0, -1]] == pytest.approx([-full, full])
        assert torque[[0, -1]] == pytest.approx(np.array([-1, 1]) * result.design.value("spring_torque_full_stroke"))
        slope = np.gradient(torque, angle, edge_order=2)
        for at, name in ((0.0, ""), (0.5, "_half_stroke"), (1.0, "_full_stroke")):
            slope_there = np.interp(at * full, angle, slope)
            assert slope_there == pytest.approx(result.design.value(f"spring_stiffness{name}"), rel=5e-3)
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


OKABE_ITO = {"#000000", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7"}


def luminance(colour: str) -> float:
    """Return how light a colour `#rrggbb` prints in grey, from 0 to 1 (ITU-R BT.601)."""
    red, green, blue = (int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5))
    return 0.299 * red + 0.587 * green + 0.114 * blue


def test_colours_are_okabe_and_ito_s_and_like_greys_have_other_lines():
    assert {*theme.COLOURS, theme.BROKEN} <= OKABE_ITO
    assert theme.BROKEN not in theme.COLOURS
    for first, other in pairwise((*theme.COLOURS, theme.COLOURS[0])):
        assert abs(luminance(first) - luminance(other)) > 0.15, (first, other)
    assert luminance("#ffffff") == pytest.approx(1.0)
    for i in range(len(theme.LINE_STYLES)):
        for j in range(i):
            assert theme.style_of(i)["linestyle"] != theme.style_of(j)["linestyle"]


@given(low=st.floats(1e-12, 1e9), decades=st.floats(1e-3, 12.0))
def test_logarithmic_axes_have_at_least_two_ticks(low, decades):
    axes = theme.place(theme.new_figure(3.0), 1.0, 1.0, 2.0, 1.0)
    axes.set_yscale("log")
    axes.set_ylim(low, low * 10.0**decades)
    theme.log_ticks(axes.yaxis)
    bottom, top = axes.get_ylim()
    inside = [tick for tick in axes.yaxis.get_majorticklocs() if bottom <= tick <= top]
    assert 2 <= len(inside) <= 12
    assert len({theme.plain(tick) for tick in inside}) >= 2


def test_ticks_are_plain_and_names_are_words_with_units():
    assert [theme.plain(value) for value in (0.0, 0.5, 200.0, 1e6, 2e-7)] == ["0", "0.5", "200", "10⁶", "2·10⁻⁷"]
    assert name_in_words("joint_damping@hot") == "joint damping, hot"
    assert axis_label("pcl_thickness", "mm") == "PCL thickness (mm)"
    assert axis_label("impedance_range", "1") == "Impedance range (–)"


def test_swings_are_lines_or_the_band_that_holds_them():
    x = np.linspace(0.0, 1.0, 500)
    parts = drawn(x, np.cos(8.0 * np.pi * x))
    assert len(parts.lines) == 1
    assert len(parts.band_x) == 0
    x = np.linspace(0.0, 20.0, 40001)
    y = np.cos(2.0 * np.pi * 10.0 * x) + 1e-3 * np.cos(2.0 * np.pi * 190.0 * x)
    parts = drawn(x, y)
    assert len(parts.band_x) > 300
    assert parts.high.min() > 0.99
    assert len(parts.lines[0][0]) == pytest.approx(6.5 / 200.0 * len(x), rel=0.02)  # six swings and a half
    decay = np.exp(-x)
    y = decay * np.cos(2.0 * np.pi * 10.0 * x)
    parts = drawn(x, y)
    assert len(parts.band_x) > 0
    size = np.exp(-parts.band_x)
    assert parts.high == pytest.approx(size, abs=0.03)
    assert parts.low == pytest.approx(-size, abs=0.03)
    assert parts.lines[0][0][-1] == parts.band_x[0]
    assert parts.lines[1][0][0] == parts.band_x[-1]
    assert parts.lines[1][0][-1] == x[-1]


def test_fonts_in_a_pdf_have_the_letters_and_nothing_that_lays_out_text():
    usual = subset.Options
    axes = theme.place(theme.new_figure(3.0), 1.0, 1.0, 2.0, 1.0)
    axes.set_xlabel("torque")
    figure = axes.figure
    assert figure is not None
    made = theme.as_file(figure, "pdf")
    assert subset.Options is usual
    streams = [zlib.decompress(raw) for raw in re.findall(rb"stream\n(.*?)\nendstream", made, re.DOTALL)]
    fonts = [TTFont(io.BytesIO(stream)) for stream in streams if stream.startswith((b"\0\1\0\0", b"true"))]
    assert fonts
    assert all(not {"GSUB", "GPOS", "GDEF", "kern"} & set(font.keys()) for font in fonts)
    assert any(set("torque") <= set(font.getGlyphOrder()) for font in fonts)


BURNS = "while True: pass"
FAILS = "raise RuntimeError('no fonts')"
WEIGHTS = "mass [g]; angle [deg]\n0; 0.9\n100; 5.1\n200; 9.3\n300; 13.4\n200; 9.8\n100; 5.6\n0; 1.4\n"
STUDY = """
mode: shear
module: {transmission: unity, leg_model: ignored, spring_material: paper_wire}
require: {spring_stiffness: [">= 5.3 N.m/rad", "<= 6 N.m/rad"]}
"""
# The shell of every command draws alike; `fit` has no page, and `sweep` is resumed in place of overwritten.
COMMANDS = {
    "run": (["run", "arm.yaml", "--no-cad"], {"results.json", "design.json", "summary.txt"}),
    "fit": (["fit", "weights.csv", "--set", "arm=100 mm"], {"fit.json", "residuals.csv"}),
    "sweep": (["sweep", "grid.yaml", "--workers", "1"], {"sweep.json", "cells.csv"}),
}


def _draws_by(code: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the drawing process run this code."""
    (folder / "another_drawer.py").write_text(code)
    monkeypatch.setenv("PYTHONPATH", str(folder))

    def start(_module: str, **options: Any) -> subprocess.Popen[Any]:
        return start_child("another_drawer", **options)

    monkeypatch.setattr(plot_process, "start_child", start)
    monkeypatch.setattr(plot_process, "PROCESSOR_LIMIT", 0.2)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.gate] if name in {"run", "sweep"} else []) for name in COMMANDS]
)
def test_plots_that_take_too_long_cost_no_number(name, tvimdesign, tmp_path, monkeypatch):
    (tmp_path / "arm.yaml").write_text(STUDY)
    (tmp_path / "grid.yaml").write_text(SMALL)
    (tmp_path / "weights.csv").write_text(WEIGHTS)
    _draws_by(BURNS, tmp_path, monkeypatch)
    words, files = COMMANDS[name]
    out = tmp_path / "out"
    done = tvimdesign(*words, "--out", out, "--json", cwd=tmp_path, PYTHONPATH=str(tmp_path))
    assert done.returncode == 4, done.stderr
    message = " ".join(done.stderr.split())
    assert "the plots could not be drawn: it was stopped after 0.2 s of processor time" in message
    assert f"for the plots, repeat the command with --{'resume' if name == 'sweep' else 'overwrite'}" in message
    (missing,) = json.loads(done.stdout)["not_done"]
    assert missing.startswith("the plots could not be drawn")
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["files"].keys() >= files | {"report.html"} - ({"report.html"} if name == "fit" else set())
    if name != "run":
        assert manifest["status"] == "partly done"


def test_a_drawing_process_that_fails_says_why(tvimdesign, tmp_path, monkeypatch):
    (tmp_path / "weights.csv").write_text(WEIGHTS)
    _draws_by(FAILS, tmp_path, monkeypatch)
    words, _ = COMMANDS["fit"]
    done = tvimdesign(*words, "--out", tmp_path / "out", cwd=tmp_path, PYTHONPATH=str(tmp_path))
    assert done.returncode == 4
    assert re.search(r"stiffness .*N·m/rad", done.stdout)
    assert "could not be drawn: RuntimeError: no fonts" in " ".join(done.stderr.split())


@pytest.mark.gate
def test_a_result_that_is_saved_without_plots_warns(tmp_path, monkeypatch):
    _draws_by(BURNS, tmp_path, monkeypatch)
    result = tvim.example("paper_reconstructed").evaluate(progress=False)
    with pytest.warns(UserWarning, match=r"0\.2 s of processor time.*save again with overwrite=True"):
        result.save(tmp_path / "out")
    assert {"report.html", "design.json", "results.json"} <= {path.name for path in (tmp_path / "out").iterdir()}
