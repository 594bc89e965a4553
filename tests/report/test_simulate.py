"""`tvimdesign simulate`: a folder with sheets, figure and findings that agree with one another."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from support import Command

from tvimdesign.report.simulate_study import figure_data, findings, sheet_csv
from tvimdesign.simulation.trial import Column, CurveTable, Finding, Panel, PlottedLine, Trial

SHEET = CurveTable(
    "warm",
    (
        Column("temperature", "degC", np.array([273.15, 333.15])),
        Column("strain", "%", np.array([0.01, 0.02])),
        Column("strain_low", "%", np.array([0.0, 0.01])),
        Column("strain_high", "%", np.array([0.02, 0.03])),
    ),
)
LINE = PlottedLine("warm", "temperature", "strain", "as is", ("strain_low", "strain_high"))
TRIAL = Trial(
    test="none",
    title="No test",
    sheets=(SHEET,),
    panels=(Panel("A panel", "temperature (°C)", "strain (%)", (LINE,), log_y=True),),
    findings=(
        Finding("sure", 0.02, "%", "one number"),
        Finding("unsure", 0.02, "%", "an interval", 0.01, 0.03),
        Finding("never", float("inf"), "s", "does not happen"),
    ),
)


def test_sheets_figures_and_findings_have_numbers_in_their_units() -> None:
    rows = list(csv.reader(sheet_csv(SHEET).splitlines()))
    assert rows[0] == ["temperature [°C]", "strain [%]", "strain_low [%]", "strain_high [%]"]
    assert [float(value) for value in rows[2]] == pytest.approx([60.0, 2.0, 1.0, 3.0])
    line = figure_data(TRIAL)["panels"][0]["lines"][0]
    assert line["x"] == pytest.approx([0.0, 60.0])
    assert line["y"] == pytest.approx([1.0, 2.0])
    assert line["band"] == [pytest.approx([0.0, 1.0]), pytest.approx([2.0, 3.0])]
    sure, unsure, never = findings(TRIAL)["findings"]
    assert sure["value"] == pytest.approx(2.0)
    assert sure["unit"] == "%"
    assert "value" not in unsure
    assert (unsure["low"], unsure["nominal"], unsure["high"]) == pytest.approx((1.0, 2.0, 3.0))
    assert never["value"] is None
    json.dumps(findings(TRIAL), allow_nan=False)


def test_a_test_leaves_a_whole_folder_and_says_what_it_read_off(tvimdesign: Command, tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = tvimdesign("simulate", "studies/paper_reconstructed.yaml", "--test", "frequency", "--out", out)
    assert done.returncode == 0, done.stderr
    files = {path.name for path in out.iterdir()}
    sheets = {f"frequency_{point}.csv" for point in ("30_degC", "60_degC", "100_degC")} | {"simple_bodies.csv"}
    assert files == sheets | {f"frequency.{ending}" for ending in ("png", "pdf", "svg")} | {
        "findings.json",
        "manifest.json",
        "report.html",
        "tested.yaml",
    }
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["status"] == "tested"
    assert manifest["files"].keys() == files - {"manifest.json"}
    assert "polymers/pcl_80k" in manifest["inputs"]
    line = next(line for line in done.stdout.splitlines() if line.startswith("storage_modulus@60_degC"))
    assert " to " in line

    import matplotlib.image as mpimg

    picture = mpimg.imread(out / "frequency.png")
    assert picture.shape[0] > 500
    assert np.std(picture[..., :3]) > 0.05

    again = tvimdesign("simulate", "studies/paper_reconstructed.yaml", "--test", "frequency", "--out", out)
    assert again.returncode == 2
    assert "--overwrite" in again.stderr


def test_scripts_get_json(tvimdesign: Command, tmp_path: Path) -> None:
    done = tvimdesign("simulate", "studies/paper_reconstructed.yaml", "--test", "amplitude", "--json", "--out",
                      tmp_path / "out")  # fmt: skip
    assert done.returncode == 0, done.stderr
    reported = json.loads(done.stdout)
    assert reported["test"] == "amplitude"
    names = {found["name"] for found in reported["findings"]}
    assert "linear_limit@30_degC" in names


def test_an_unknown_test_leaves_no_folder(tvimdesign: Command, tmp_path: Path) -> None:
    done = tvimdesign("simulate", "studies/paper_reconstructed.yaml", "--test", "frequence", "--out", tmp_path / "out")
    assert done.returncode == 2
    assert "did you mean frequency?" in done.stderr
    assert not (tmp_path / "out").exists()
