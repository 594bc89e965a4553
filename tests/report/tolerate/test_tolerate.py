"""`tvimdesign tolerate`: one folder of tables and a figure, the same as JSON, and sentences people can act on."""

import csv
import json
from pathlib import Path

import pytest
from support import Command, sample_text

STUDY = sample_text("tolerated")


@pytest.fixture(scope="module")
def results(tvimdesign: Command, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, object], str]:
    folder = tmp_path_factory.mktemp("tolerate")
    (folder / "arm.yaml").write_text(STUDY)
    done = tvimdesign("tolerate", "arm.yaml", "--samples", 4000, "--json", cwd=folder)
    assert done.returncode == 0, done.stderr
    return folder / "results/arm-tolerances", json.loads(done.stdout), done.stderr


@pytest.mark.gate
def test_the_folder_has_tables_in_si_and_a_manifest(results):
    folder, reported, _ = results
    expected = {"contributors.csv", "limits.csv", "manifest.json",
                "outputs.csv", "spread.pdf", "spread.png",
                "spread.svg", "tolerances.json", "report.html",
                "tolerated.yaml"}  # fmt: skip
    assert {path.name for path in folder.iterdir()} == expected
    stored = json.loads((folder / "tolerances.json").read_text())
    assert stored == {name: value for name, value in reported.items() if name not in {"folder", "not_done"}}
    assert stored["samples"] == 4096
    rows = list(csv.DictReader((folder / "outputs.csv").read_text("utf-8-sig").splitlines()))
    (stiffness,) = [row for row in rows if row["output"] == "spring_stiffness"]
    worst, drawn = float(stiffness["worst_high"]), float(stiffness["high"])
    assert float(stiffness["as_drawn"]) < drawn < worst
    assert float(stiffness["deviation"]) == pytest.approx(float(stiffness["deviation_rss"]), rel=0.02)
    reported = results[1]
    assert (reported["format"], reported["units"]) == (1, "SI")
    rows = {row["output"]: row for row in reported["outputs"]}
    stiffness = rows["spring_stiffness"]
    assert stiffness["si"]["unit"] == stiffness["unit"] == "N·m/rad"
    for name in ("as_drawn", "low", "high", "worst_low", "deviation"):
        assert stiffness["si"][name] == pytest.approx(stiffness[name])
    assert any(note.startswith("Soft is dynamic stiffness <= ") for note in reported["notes"])
    rows = list(csv.DictReader((results[0] / "contributors.csv").read_text("utf-8-sig").splitlines()))
    mine = [row for row in rows if row["output"] == "spring_stiffness"]
    assert sum(float(row["share"]) for row in mine) == pytest.approx(1.0, abs=1e-4)
    assert max(mine, key=lambda row: float(row["share"]))["contributor"] == "wire_diameter"
    # d ln K/d ln d = 4: with 2.413 mm and 5.609 N.m/rad that is 9.3 N.m/rad for each millimetre.
    (wire,) = [row for row in mine if row["contributor"] == "wire_diameter"]
    assert (float(wire["derivative"]), wire["derivative_unit"]) == (pytest.approx(9.3, rel=0.01), "N·m/rad / mm")
    text = " ".join(results[1]["sentences"])
    assert text.startswith("In the worst case ")
    assert "Tighten preload_angle first" in text
    assert "(±18.7° by DIN 2194, grade 2) is 3.1 times the stroke" in text
    assert "with the preload adjusted to within ±1°, 100 % do" in text


@pytest.mark.gate
def test_a_design_and_its_tables_are_printed_and_bad_input_is_reported(tvimdesign, tmp_path):
    (tmp_path / "arm.yaml").write_text(STUDY)
    done = tvimdesign("tolerate", "arm.yaml", "--samples", 300, "--out", "again", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    for words in (
        "What spreads",
        "worst case",
        "Limits that fewer than 99.73 % of modules meet",
        "preload_margin >= 0 rad",
    ):
        assert words in done.stdout
    wrong = {("--samples", 10): "--samples 10: must be 256 to 4194304", ("--out", "arm.yaml"): "is a file"}
    for arguments, message in wrong.items():
        done = tvimdesign("tolerate", "arm.yaml", *arguments, cwd=tmp_path)
        assert (done.returncode, "Traceback" in done.stderr) == (2, False)
        assert message in done.stderr
