"""The command `compare`: what it refuses, what it leaves behind, and what it says when a study has no design."""

import csv
import json
import tempfile
from pathlib import Path
from typing import Any

import pytest
from comparable import COARSE, COMPRESSION, SHEAR, written
from support import Command, cases_of

from tvimdesign.report.compare.compare_studies import answers

PICTURES = {f"fronts.{ending}" for ending in ("png", "pdf", "svg")}


def _report(folder: Path) -> dict[str, Any]:
    reported: dict[str, Any] = json.loads((folder / "compare.json").read_text())
    return reported


@pytest.fixture(scope="module")
def pair(tvimdesign: Command, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Shear against compression, with fronts and pictures; both are drawn with wire that gives the stiffness asked."""
    folder = tmp_path_factory.mktemp("pair")
    stiff = "module:\n", "module:\n  wire_diameter: 2.8 mm\n"
    paths = written(folder, mine=SHEAR.replace(*stiff), yours=COMPRESSION.replace(*stiff))
    done = tvimdesign("compare", *paths, "--points", 3, "--out", folder / "out")
    assert done.returncode == 0, done.stderr
    assert "COMPARED EACH OPTIMISED FOR ITSELF" in done.stdout
    return folder / "out"


@pytest.mark.slow
def test_folder_and_ratios_are_those_of_the_written_designs(pair):
    names = {path.relative_to(pair).as_posix() for path in pair.rglob("*") if path.is_file()}
    each = {
        f"{mode}/{file}" for mode in ("shear", "compression") for file in ("drawn.json", "optimised.json", "study.yaml")
    }
    assert names == PICTURES | each | {
        "compare.csv", "compare.json", "fronts.csv", "fronts.json", "manifest.json", "report.html", "summary.txt",
    }  # fmt: skip
    manifest = json.loads((pair / "manifest.json").read_text())
    assert manifest["status"] == "compared"
    assert manifest["files"].keys() == names - {"manifest.json"}
    reported = _report(pair)
    for which in ("drawn", "optimised"):
        values = [
            json.loads((pair / f"{mode}/{which}.json").read_text())["values"] for mode in ("shear", "compression")
        ]
        rows = {row["name"]: row for row in reported["comparisons"][which]}
        for name in ("module_mass", "response_time", "cycle_time", "holding_torque"):
            assert rows[name]["ratio"]["compression"] == pytest.approx(values[1][name] / values[0][name])
        less = values[1]["module_mass"] < values[0]["module_mass"]
        assert rows["module_mass"]["verdict"]["compression"] == ("better" if less else "worse")
        assert "joint_stiffness@hot" in rows
        assert "layer_strain" not in rows


@pytest.mark.slow
def test_studies_minimise_over_the_mean_of_the_drawn_modules(pair):
    drawn, optimised = (
        [json.loads((pair / f"{mode}/{which}.json").read_text()) for mode in ("shear", "compression")]
        for which in ("drawn", "optimised")
    )
    references = [design["solution"]["reference"] for design in optimised]
    for name in ("module_mass", "response_time"):
        mean = (drawn[0]["values"][name] * drawn[1]["values"][name]) ** 0.5
        assert [reference[name] for reference in references] == pytest.approx([mean, mean], rel=1e-4)
    for design in optimised:
        expected = sum(design["values"][name] / value for name, value in references[0].items())
        assert design["solution"]["objective"] == pytest.approx(expected, rel=1e-3)


@pytest.mark.slow
def test_contact_and_warnings_are_reported(pair):
    reported = _report(pair)
    rows = {row["name"]: row for row in reported["comparisons"]["optimised"]}
    lost = rows["contact_lost@hot"]
    assert lost["values"]["shear"] == 0.0
    assert lost["values"]["compression"] > 0.3
    assert lost["verdict"]["compression"] == "worse"
    summary = " ".join((pair / "summary.txt").read_text().split())
    for mode in ("shear", "compression"):
        design = json.loads((pair / mode / "optimised.json").read_text())
        # PETG beside hot pads, as both studies accept: no warning, and told all the same.
        assert f"{mode} is beyond its rating, as its study accepts: {', '.join(design['accepting'])}." in summary


@pytest.mark.slow
def test_leads_follow_from_the_fronts_and_the_tables_agree(pair):
    reported = _report(pair)
    fronts = [front for front in reported["fronts"]["fronts"] if front["second"] == "module_mass"]
    lightest = {front["study"]: min(p["values"]["module_mass"] for p in front["points"]) for front in fronts}
    by_mass = next(lead for lead in reported["leads"] if lead["limited"] == "module_mass")
    assert by_mass["gained"] == "response_time"
    first = by_mass["leads"][0]
    assert first["alone"]
    assert first["best"] == min(lightest, key=lambda study: lightest[study])
    assert first["from"] == pytest.approx(min(lightest.values()))
    assert first["to"] == pytest.approx(max(lightest.values()))
    assert first["best"] in reported["sentence"]
    assert "holding_torque >= 5 N·m" in reported["sentence"]
    with (pair / "compare.csv").open(encoding="utf-8-sig") as stream:
        lines = {(line["comparison"], line["output"]): line for line in csv.DictReader(stream)}
    for which, rows in reported["comparisons"].items():
        for row in rows:
            assert lines[which, row["name"]]["verdict compression"] == row["verdict"]["compression"]
    summary = " ".join((pair / "summary.txt").read_text().split())
    for sentence in reported["conclusions"]:
        assert sentence in summary
    with (pair / "fronts.csv").open(encoding="utf-8-sig") as stream:
        points = list(csv.DictReader(stream))
    assert len(points) == sum(len(front["points"]) for front in reported["fronts"]["fronts"])
    assert all(float(point["module_mass [g]"]) > 0.0 for point in points)


@pytest.mark.slow
def test_renamed_copy_is_equal(tvimdesign, tmp_path):
    paths = written(tmp_path, one=SHEAR, copy=SHEAR)
    done = tvimdesign("compare", *paths, "--points", 2, "--no-plots", "--json", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    reported = json.loads(done.stdout)
    assert reported["studies"].keys() == {"one", "copy"}
    for which in ("drawn", "optimised"):
        for row in reported["comparisons"][which]:
            nothing = row["unit"] == "°C" or row["values"]["one"] is None
            assert row["ratio"]["copy"] == (None if row["unit"] == "°C" else 1.0) or nothing, row["name"]
            assert row["verdict"]["copy"] in {"same", ""}
    assert all(part["best"] is None for lead in reported["leads"] for part in lead["leads"])
    assert "copy and one do not differ" in reported["sentence"]


@pytest.mark.slow
def test_study_without_a_design_leaves_the_other(tvimdesign, tmp_path):
    limits = '  holding_torque: ">= 5 N.m"', '  holding_torque: ">= 5 N.m"\n  response_time: "<= 120 s"'
    paths = written(tmp_path, fast=SHEAR.replace(*limits), slow=COMPRESSION.replace(*limits))
    done = tvimdesign("compare", *paths, "--points", 2, "--json", "--out", tmp_path / "out")
    assert done.returncode == 3
    reported = json.loads(done.stdout)
    assert "slow" not in reported["studies"]  # called by their modes
    assert reported["studies"]["compression"]["troubles"][0]["step"] == "optimised"
    assert "optimised" in reported["studies"]["shear"]
    assert (tmp_path / "out/shear/optimised.json").exists()
    assert "no feasible design was found for compression" in reported["sentence"]
    assert "compression, optimised" in done.stderr
    assert reported["comparisons"].keys() == {"drawn"}
    assert {front["study"] for front in reported["fronts"]["fronts"]} == {"shear"}


@pytest.mark.slow
def test_process_that_dies_leaves_the_other(tmp_path, monkeypatch):
    evaluated = SHEAR[: SHEAR.index("vary:")] + SHEAR[SHEAR.index("operating_points:") :]
    (path,) = written(tmp_path, there=evaluated)
    out, elsewhere = tmp_path / "out", tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(elsewhere))
    out.mkdir()
    beside: list[list[Path]] = []
    studies = {"gone": tmp_path / "gone.yaml", "there": path}
    handed_over: list[tuple[str, dict[str, Any]]] = []
    answered = answers(
        studies, out, 2, lambda _: None, lambda: beside.append([*out.iterdir(), *elsewhere.iterdir()]),
        keep=lambda label, part: handed_over.append((label, part)),
    )  # fmt: skip
    assert answered["gone"]["troubles"][0]["exit_code"] == 4
    assert "no such file" in answered["gone"]["troubles"][0]["error"]
    assert answered["there"]["troubles"] == []
    assert handed_over[0][0] == "there"
    assert "drawn" in handed_over[0][1]
    assert handed_over[-1][1] == {**answered["there"], "seconds": handed_over[-1][1]["seconds"]}
    assert answered["there"]["drawn"]["verdict"]
    assert [path.parent for path in beside[0]] == [out]  # what a kill leaves is in the folder of results
    assert list(out.iterdir()) == []


@pytest.mark.gate
def test_finished_runs_are_compared_without_computing(tvimdesign, tmp_path, monkeypatch):
    """Two runs of modules that differ in wire and current; nothing is simulated for their comparison."""
    fixed = COARSE[: COARSE.index("vary:")] + COARSE[COARSE.index("operating_points:") :]
    for name, wire, current in (("thin", 2.4, 1.5), ("thick", 2.8, 1.4)):
        text = fixed.replace("module:\n", f"module:\n  wire_diameter: {wire} mm\n")
        (path,) = written(tmp_path, **{name: text.replace("current: 1.5 A", f"current: {current} A")})
        assert tvimdesign("run", path, "--no-cad", "--no-plots", "--out", tmp_path / name / "out").returncode == 0
    runs = [tmp_path / name / "out" for name in ("thin", "thick")]
    monkeypatch.setattr("tvimdesign.report.compare.compare_studies.answers", None)
    names = [runs[0] / "design.json", runs[1]]
    done = tvimdesign("compare", *names, "--json", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    compared = json.loads(done.stdout)
    (difference,) = compared["differences"]
    assert "module.current: 1.4 A here, 1.5 A in" in difference
    assert sum(text.startswith("Verdict on ") for text in compared["conclusions"]) == 2
    rows = {row["name"]: row for row in compared["comparisons"]["drawn"]}
    designs = [json.loads((run / "design.json").read_text())["values"]["spring_stiffness"] for run in runs]
    assert [*rows["spring_stiffness"]["ratio"].values()] == [pytest.approx(designs[1] / designs[0])]
    assert (tmp_path / "out/report.html").exists()
    assert len([*(tmp_path / "out").glob("*/drawn.json")]) == 2


@cases_of("compare", "refused_paths")
def test_refused_paths(tvimdesign, tmp_path, names, words):
    written(tmp_path, one=SHEAR)
    done = tvimdesign("compare", *(tmp_path / name for name in names), "--out", tmp_path / "out")
    assert done.returncode == 2
    assert words in done.stderr
    assert not (tmp_path / "out").exists()


def test_problems_of_all_studies_are_listed_at_once(tvimdesign, tmp_path):
    wrong = COMPRESSION.replace("require:", 'require:\n  layer_strain: "<= 3"')
    worse = SHEAR.replace("coil", "coyl").replace("pcl_thickness", "pcl_thikness")
    paths = written(tmp_path, a=worse, b=wrong)
    done = tvimdesign("compare", *paths, "--out", tmp_path / "out", "--json")
    assert done.returncode == 2
    assert "a.yaml:10:3: vary.pcl_thikness" in done.stderr
    assert "layer_strain is of shear mode, this study is compression mode" in done.stderr
    assert {Path(problem["file"]).name for problem in json.loads(done.stdout)["problems"]} == {"a.yaml", "b.yaml"}
    assert not (tmp_path / "out").exists()
