"""The commands `fit` and `simulate`: their folders, figures and findings."""

import csv
import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from support import ROOT, cases_of

from tvimdesign.report.output.numbers import curves_csv
from tvimdesign.report.simulate_study import figure_data, findings
from tvimdesign.simulation.trial import Column, CurveTable, Finding, Panel, PlottedLine, Trial

WEIGHTS = "mass [g]; angle [deg]\n0; 0.9\n100; 5.1\n200; 9.3\n300; 13.4\n200; 9.8\n100; 5.6\n0; 1.4\n"


@pytest.fixture
def weights(tmp_path: Path) -> Path:
    path = tmp_path / "weights.csv"
    path.write_text(WEIGHTS)
    return path


def test_a_fit_writes_its_folder_and_its_record(tvimdesign, weights, tmp_path):
    sizes = ("wire_diameter=2.413 mm", "coil_diameter=24.41 mm", "coil_count=3.25", "arm=100 mm")
    done = tvimdesign("fit", weights, *(word for size in sizes for word in ("--set", size)), "--record", "my_wire",
                      "--out", "out", cwd=tmp_path)  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "angle: 'angle [deg]' in °, 0.9 to 13.4" in done.stdout
    assert "spring_material: my_wire" in done.stdout
    files = {path.name for path in (tmp_path / "out").iterdir()}
    assert files >= {"fit.json", "residuals.csv", "fit.png", "manifest.json"}
    data = json.loads((tmp_path / "out/fit.json").read_text())
    assert [parameter["name"] for parameter in data["parameters"]] == ["stiffness", "zero_angle", "friction"]
    assert data["record"] == "my_records/spring_materials/my_wire.yaml"
    assert (tmp_path / data["record"]).exists()
    rows = (tmp_path / "out/residuals.csv").read_text(encoding="utf-8-sig").splitlines()
    assert len(rows) == 1 + 7


def test_a_fit_without_a_record_keeps_its_folder_and_json_has_it(tvimdesign, weights, tmp_path):
    done = tvimdesign(
        "fit", weights, "--set", "arm=100 mm", "--record", "mine", "--no-plots", "--out", "out", cwd=tmp_path
    )
    assert done.returncode == 4
    assert "torque_angle: nothing in it is a value of a record" in " ".join(done.stderr.split())
    assert json.loads((tmp_path / "out/fit.json").read_text())["record"] is None
    done = tvimdesign("fit", weights, "--set", "arm=100 mm", "--no-plots", "--json", cwd=tmp_path)
    printed = json.loads(done.stdout)
    assert printed.pop("folder") == "results/weights-fit"
    assert printed.pop("not_done") == []
    assert printed == json.loads((tmp_path / "results/weights-fit/fit.json").read_text())


@pytest.mark.gate
@cases_of("fit_files", "plain_files")
def test_a_file_goes_through_without_an_option(tvimdesign, tmp_path, file, kind, name, truth):
    shutil.copy(ROOT / "tests/simulation/measurement/kinds/instrument_files" / file, tmp_path / "data.txt")
    done = tvimdesign("fit", "data.txt", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    data = json.loads((tmp_path / "results/data-fit/fit.json").read_text())
    values = {entry["name"]: entry for entry in (*data["parameters"], *data["derived"])}
    assert (data["kind"], data["misfit"]) == (kind, "")
    assert values[name]["value"] == pytest.approx(truth, rel=0.15)
    assert (tmp_path / "results/data-fit/fit.png").exists()


def test_kinds_are_listed(tvimdesign):
    listed = tvimdesign("fit", "--kinds").stdout
    assert "columns: angle, torque or mass or force" in listed
    assert set(json.loads(tvimdesign("fit", "--kinds", "--json").stdout)) == {
        "torque_angle", "frequency_sweep", "temperature_ramp", "creep", "relaxation", "melt", "amplitude_sweep", "dsc",
        "pad", "release", "sine", "frozen_torque", "heating_log", "flow_curve",
    }  # fmt: skip


@cases_of("fit_files", "errors")
def test_an_error_is_reported(tvimdesign, weights, words, message):
    done = tvimdesign("fit", *words, "--no-plots", cwd=weights.parent)
    assert done.returncode == 2
    assert message in done.stderr


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


def test_sheets_figures_and_findings_have_numbers_in_their_units():
    columns, units = {c.name: c.shown for c in SHEET.columns}, {c.name: c.unit for c in SHEET.columns}
    rows = list(csv.reader(curves_csv(columns, units, "1").splitlines()))
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


@pytest.mark.gate
def test_a_test_leaves_a_whole_folder_and_says_what_it_read_off(tvimdesign, tmp_path):
    out = tmp_path / "out"
    done = tvimdesign("simulate", "studies/paper_reconstructed.yaml", "--test", "frequency", "--out", out)
    assert done.returncode == 0, done.stderr
    files = {path.name for path in out.iterdir()}
    sheets = {f"frequency_{point}.csv" for point in ("30_degC", "60_degC", "100_degC")} | {"simple_bodies.csv"}
    pictures = {f"frequency.{ending}" for ending in ("png", "pdf", "svg")}
    assert files == sheets | pictures | {"findings.json", "manifest.json", "report.html", "tested.yaml"}
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


def test_scripts_get_json(tvimdesign, tmp_path):
    done = tvimdesign("simulate", "studies/paper_reconstructed.yaml", "--test", "amplitude", "--json", "--out",
                      tmp_path / "out")  # fmt: skip
    assert done.returncode == 0, done.stderr
    reported = json.loads(done.stdout)
    assert reported["test"] == "amplitude"
    names = {finding["name"] for finding in reported["findings"]}
    assert "linear_limit@30_degC" in names


def test_an_unknown_test_leaves_no_folder(tvimdesign, tmp_path):
    done = tvimdesign("simulate", "studies/paper_reconstructed.yaml", "--test", "frequence", "--out", tmp_path / "out")
    assert done.returncode == 2
    assert "did you mean frequency?" in done.stderr
    assert not (tmp_path / "out").exists()
