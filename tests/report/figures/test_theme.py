"""The theme of figures, and the process that draws them."""

import io
import json
import re
import subprocess
import zlib
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools import subset
from fontTools.ttLib import TTFont
from hypothesis import given
from hypothesis import strategies as st
from small_sweeps import SMALL
from support import Command

import tvimdesign as tvim
from tvimdesign.base.child_process import start_child
from tvimdesign.report.figures.theme import (
    BROKEN,
    COLOURS,
    LINE_STYLES,
    as_file,
    log_ticks,
    new_figure,
    place,
    plain,
    style_of,
)
from tvimdesign.report.figures.virtual_test_figures import drawn
from tvimdesign.report.output import plot_process
from tvimdesign.report.output.numbers import axis_label, name_in_words

OKABE_ITO = {"#000000", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7"}


def luminance(colour: str) -> float:
    """Return how light a colour `#rrggbb` prints in grey, from 0 to 1 (ITU-R BT.601)."""
    red, green, blue = (int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5))
    return 0.299 * red + 0.587 * green + 0.114 * blue


def test_colours_are_okabe_and_ito_s_and_like_greys_have_other_lines() -> None:
    assert {*COLOURS, BROKEN} <= OKABE_ITO
    assert BROKEN not in COLOURS
    for one, other in pairwise((*COLOURS, COLOURS[0])):
        assert abs(luminance(one) - luminance(other)) > 0.15, (one, other)
    assert luminance("#ffffff") == pytest.approx(1.0)
    for i in range(len(LINE_STYLES)):
        for j in range(i):
            assert style_of(i)["linestyle"] != style_of(j)["linestyle"]


@given(low=st.floats(1e-12, 1e9), decades=st.floats(1e-3, 12.0))
def test_logarithmic_axes_have_at_least_two_ticks(low: float, decades: float) -> None:
    axes = place(new_figure(3.0), 1.0, 1.0, 2.0, 1.0)
    axes.set_yscale("log")
    axes.set_ylim(low, low * 10.0**decades)
    log_ticks(axes.yaxis)
    bottom, top = axes.get_ylim()
    inside = [tick for tick in axes.yaxis.get_majorticklocs() if bottom <= tick <= top]
    assert 2 <= len(inside) <= 12
    assert len({plain(tick) for tick in inside}) >= 2


def test_ticks_are_plain_and_names_are_words_with_units() -> None:
    assert [plain(value) for value in (0.0, 0.5, 200.0, 1e6, 2e-7)] == ["0", "0.5", "200", "10⁶", "2·10⁻⁷"]
    assert name_in_words("joint_damping@hot") == "joint damping, hot"
    assert axis_label("pcl_thickness", "mm") == "PCL thickness (mm)"
    assert axis_label("impedance_range", "1") == "Impedance range (–)"


def test_swings_are_lines_or_the_band_that_holds_them() -> None:
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


def test_fonts_in_a_pdf_have_the_letters_and_nothing_that_lays_out_text() -> None:
    usual = subset.Options
    axes = place(new_figure(3.0), 1.0, 1.0, 2.0, 1.0)
    axes.set_xlabel("torque")
    figure = axes.figure
    assert figure is not None
    made = as_file(figure, "pdf")
    assert subset.Options is usual
    streams = [zlib.decompress(one) for one in re.findall(rb"stream\n(.*?)\nendstream", made, re.DOTALL)]
    fonts = [TTFont(io.BytesIO(one)) for one in streams if one.startswith((b"\0\1\0\0", b"true"))]
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


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.gate] if name in {"run", "sweep"} else []) for name in COMMANDS]
)
def test_plots_that_take_too_long_cost_no_number(
    name: str, tvimdesign: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "arm.yaml").write_text(STUDY)
    (tmp_path / "grid.yaml").write_text(SMALL)
    (tmp_path / "weights.csv").write_text(WEIGHTS)
    _draws_by(BURNS, tmp_path, monkeypatch)
    words, files = COMMANDS[name]
    out = tmp_path / "out"
    done = tvimdesign(*words, "--out", out, "--json", cwd=tmp_path, PYTHONPATH=str(tmp_path))
    assert done.returncode == 4, done.stderr
    said = " ".join(done.stderr.split())
    assert "the plots could not be drawn: it was stopped after 0.2 s of processor time" in said
    assert f"for the plots, repeat the command with --{'resume' if name == 'sweep' else 'overwrite'}" in said
    (missing,) = json.loads(done.stdout)["not_done"]
    assert missing.startswith("the plots could not be drawn")
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["files"].keys() >= files | {"report.html"} - ({"report.html"} if name == "fit" else set())
    if name != "run":
        assert manifest["status"] == "partly done"


def test_a_drawing_process_that_fails_says_why(
    tvimdesign: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "weights.csv").write_text(WEIGHTS)
    _draws_by(FAILS, tmp_path, monkeypatch)
    words, _ = COMMANDS["fit"]
    done = tvimdesign(*words, "--out", tmp_path / "out", cwd=tmp_path, PYTHONPATH=str(tmp_path))
    assert done.returncode == 4
    assert re.search(r"stiffness .*N·m/rad", done.stdout)
    assert "could not be drawn: RuntimeError: no fonts" in " ".join(done.stderr.split())


def test_a_result_that_is_saved_without_plots_warns(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _draws_by(BURNS, tmp_path, monkeypatch)
    result = tvim.example("paper_reconstructed").evaluate(progress=False)
    with pytest.warns(UserWarning, match=r"0\.2 s of processor time.*save again with overwrite=True"):
        result.save(tmp_path / "out")
    assert {"report.html", "design.json", "results.json"} <= {path.name for path in (tmp_path / "out").iterdir()}
