"""A front in a run's folder, the same when killed and resumed; what `check` refuses ends a run before its search."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import jsonschema
import psutil
import pytest
from comparable import SHEAR, written
from support import ROOT, Command, wait_until

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.cad.make import BackgroundPartsJob
from tvimdesign.device import table_for
from tvimdesign.report.output.plot_process import PlotProcess
from tvimdesign.report.output.tables import results_schema
from tvimdesign.report.run import answered_study
from tvimdesign.report.run import run_study as module
from tvimdesign.report.run.blocks.sections import front_section
from tvimdesign.report.run.front_report import figure_data, front_csv, in_words, plain
from tvimdesign.report.run.run_study import check_study
from tvimdesign.solve.pareto.front import Front
from tvimdesign.solve.pareto.tradeoff import Failure, Point
from tvimdesign.study.design import read_design

FRONT_STUDY = SHEAR + "front: {of: [response_time, module_mass], points: 5}\n"


@pytest.fixture(scope="module")
def run(tvimdesign: Command, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run a study with a front to its end."""
    folder = tmp_path_factory.mktemp("front")
    (study,) = written(folder, study=FRONT_STUDY)
    done = tvimdesign("run", study, "--no-cad", "--full", "--out", folder / "out")
    assert done.returncode == 0, done.stderr
    screen = done.stdout.partition("\n\n")[0].splitlines()
    assert any(re.match(r"Front: \d designs · softening time \S+ to \S+ s · mass ", line) for line in screen)
    assert "Points of the front" in done.stdout
    return folder / "out"


@pytest.mark.slow
def test_table_designs_and_figure_of_a_front_agree(run):
    with (run / "front.csv").open(encoding="utf-8-sig") as stream:
        points = list(csv.DictReader(stream))
    assert len(points) == 5
    assert {"response_time [s]", "module_mass [g]", "wire_diameter [mm]", "pcl_thickness [mm]"} <= points[0].keys()
    times = [float(point["response_time [s]"]) for point in points]
    assert times == sorted(times)
    assert points[0]["status"].startswith("least response_time")
    reported = json.loads((run / "front.json").read_text())
    assert [point["values"]["response_time"] for point in reported["points"]] == pytest.approx(times, rel=1e-6)
    assert reported["failures"] == []
    for point in reported["points"]:
        design = read_design(run / point["design"])
        assert design.status == "optimal"
        again = table_for(design.mode).evaluate(design.values, ["module_mass"])["module_mass"]
        assert again * 1e3 == pytest.approx(point["values"]["module_mass"], rel=1e-9)
    import matplotlib.image as mpimg

    picture = mpimg.imread(run / "plots/front.png")
    assert picture.shape[0] > 300
    assert picture[..., :3].std() > 0.02


@pytest.mark.slow
def test_a_front_that_was_killed_goes_on_and_ends_with_the_same_bytes(tvimdesign, run, tmp_path):
    (study,) = written(tmp_path, study=FRONT_STUDY)
    out = tmp_path / "out"
    progress = out / "unfinished/front/progress"
    process = subprocess.Popen(
        [sys.executable, "-m", "tvimdesign", "run", str(study), "--no-cad", "--no-plots", "--out", str(out)],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert wait_until((progress / "0002.json").exists)
    process.kill()
    process.wait()
    assert 3 <= len(list(progress.glob("0*.json"))) < 7
    assert not (out / "front.csv").exists()
    done = tvimdesign("run", study, "--no-cad", "--no-plots", "--resume", "--out", out)
    assert done.returncode == 0, done.stderr
    assert "then module_mass" not in done.stderr  # the ends were known
    for name in ("front.csv", "front.json", "front/03.design.json"):
        assert (out / name).read_bytes() == (run / name).read_bytes(), name
    assert not progress.exists()
    refused = tvimdesign("run", study, "--no-cad", "--resume", "--out", out)
    assert refused.returncode == 2
    assert "nothing to resume" in refused.stderr


def test_the_front_of_another_study_is_not_gone_on_with(tvimdesign, tmp_path):
    (study,) = written(tmp_path, study=FRONT_STUDY)
    out = tmp_path / "out"
    with suppress(KeyboardInterrupt), ResultsFolder(out) as folder:
        folder.write_json("front/progress/asked.json", {"tvimdesign": "0.0.1", "study": {}})
        raise KeyboardInterrupt
    done = tvimdesign("run", study, "--no-cad", "--no-plots", "--resume", "--out", out)
    assert done.returncode == 2
    assert "another study or version" in done.stderr


def test_the_words_say_what_a_hundredth_less_costs_beyond_the_knee():
    """Time and mass by hand: from the knee 10 % less time costs 30 % mass, 10 % less mass 50 % time."""
    pairs = [(0.9, 1.3), (1.0, 1.0), (1.5, 0.9)]
    points = tuple(Point("", {"response_time": 100.0 * t, "module_mass": 0.1 * m}, {}) for t, m in pairs)
    (sentence,) = in_words(Front(("response_time", "module_mass"), points), table_for("shear"))
    assert "The knee is point 2: response_time 100 s, module_mass 100 g." in sentence
    # ln 1.3 / ln (1/0.9) = 2.49, ln 1.5 / ln (1/0.9) = 3.85
    assert "1 % less response_time costs 2.5 % module_mass (point 1)" in sentence
    assert "1 % less module_mass costs 3.8 % response_time (point 3)" in sentence


def test_a_front_that_is_no_trade_has_no_knee():
    """Find no knee in the same bend as above with a hundredth of the mass. Nobody chooses by 0.4 g."""
    pairs = [(0.9, 1.013), (1.0, 1.01), (1.5, 1.009)]
    points = tuple(Point("", {"response_time": 100.0 * t, "module_mass": 0.1 * m}, {}) for t, m in pairs)
    front, table = Front(("response_time", "module_mass"), points), table_for("shear")
    (sentence,) = in_words(front, table)
    assert "no trade to speak of: over the whole front module_mass spans 0.40% (100.9 g to 101.3 g)" in sentence
    reported = plain(front, list(front.outputs), table)
    assert reported["knee"] is None
    assert "knee" not in front_csv(reported)
    assert figure_data(front, points[0], table)["knee"] is None
    rows = [(0.9, 1.3, 1.0), (1.0, 1.0, 1.01), (1.5, 0.9, 1.02)]
    names = ("response_time", "module_mass", "envelope_diameter")
    points = tuple(Point("", dict(zip(names, row, strict=True)), {}) for row in rows)
    front = Front(names, points)
    (sentence,) = in_words(front, table_for("shear"))
    assert sentence.startswith("There is no trade to speak of in envelope_diameter: ")
    assert sentence.endswith("ask for a front of response_time and module_mass.")
    assert front.knee is None
    table, words = table_for("shear"), "converged, but simulated it violates response_time <= 100 s: 100.6 s"
    front = Front(("response_time", "module_mass"), (), failures=(Failure("least response_time", words),), sought=2)
    assert front.knee is None
    reported = plain(front, list(front.outputs), table)
    assert reported["points"] == []
    assert reported["in_words"] == [f"No design at least response_time: {words}."]
    assert front_csv(reported).splitlines() == ["point,status,response_time [s],module_mass [g]"]
    (block,) = front_section(reported, list(front.outputs)).blocks
    assert words in str(block)


STUDY = """mode: shear
vary: {wire_diameter: [1.2 mm, 3.2 mm], coil_diameter: [8 mm, 32 mm]}
require: {envelope_diameter: "<= 120 mm"}
minimize: module_mass
solver: {starts: 30}
"""


def _run(path: Path, out: Path, *, as_json: bool = False) -> None:
    module.run_study(path, out, overwrite=False, cad=False, plots=False, as_json=as_json)


@pytest.mark.gate
def test_what_check_refuses_ends_a_run_before_its_folder_is_touched(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(answered_study, "answer", lambda *_, **__: pytest.fail("it searched"))
    path, out = tmp_path / "impossible.yaml", tmp_path / "out"
    path.write_text(STUDY)
    with pytest.raises(InfeasibleError, match="envelope_diameter <= 120 mm cannot hold") as checked:
        check_study(path, as_json=False)
    with pytest.raises(InfeasibleError) as refused:
        _run(path, out, as_json=True)
    assert (str(refused.value), refused.value.exit_code) == (str(checked.value), 3)
    assert not out.exists()
    report = json.loads(capsys.readouterr().out)
    jsonschema.validate(report, results_schema())
    assert (report["status"], report["reason"]) == ("infeasible", str(checked.value))


def test_a_reason_that_ends_the_run_early_is_left_in_the_folder(tmp_path, monkeypatch, capsys):
    path, out = tmp_path / "study.yaml", tmp_path / "out"
    path.write_text(STUDY.replace("<= 120 mm", "<= 300 mm"))

    def refuse(*_: object, **__: object) -> None:
        raise InfeasibleError("no start keeps it")

    monkeypatch.setattr(answered_study, "answer", refuse)
    with pytest.raises(InfeasibleError):
        _run(path, out, as_json=True)
    reported = json.loads((out / "results.json").read_text())
    jsonschema.validate(reported, results_schema())
    assert (reported["status"], reported["reason"]) == ("infeasible", "no start keeps it")
    assert reported["reason"] in (out / "summary.txt").read_text()
    assert reported["reason"] in (out / "report.html").read_text()
    assert json.loads((out / "study.resolved.json").read_text())["require"][0]["output"] == "envelope_diameter"
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["status"] == "infeasible"
    assert {"results.json", "summary.txt", "study.yaml", "study.resolved.json"} <= manifest["files"].keys()
    assert json.loads(capsys.readouterr().out)["reason"] == "no start keeps it"


def test_a_swallowed_interrupt_is_no_conflict(tmp_path, monkeypatch):
    path, out = tmp_path / "study.yaml", tmp_path / "out"
    path.write_text(STUDY.replace("<= 120 mm", "<= 300 mm"))

    def swallow(*_: object, **__: object) -> None:
        with suppress(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
        raise InfeasibleError("the solver stopped, which looks like a conflict")

    monkeypatch.setattr(answered_study, "answer", swallow)
    with pytest.raises(KeyboardInterrupt):
        _run(path, out)
    assert json.loads((out / "manifest.json").read_text())["status"] == "interrupted"
    assert not (out / "results.json").exists()


def test_parts_and_figures_lower_their_priority_only_where_others_wait():
    with BackgroundPartsJob(), PlotProcess(gives_way=True):
        assert wait_until(lambda: len(_priorities()) == 2)
        behind = _priorities()
    assert psutil.Process().nice() < behind["cad.jobs.main"] < behind["plot_process"]
    with PlotProcess():
        assert wait_until(lambda: bool(_priorities()))
        behind = _priorities()
    assert behind == {"plot_process": psutil.Process().nice()}
    with BackgroundPartsJob(gives_way=False):
        assert wait_until(lambda: bool(_priorities()))
        behind = _priorities()
    assert behind == {"cad.jobs.main": psutil.Process().nice()}


def _priorities() -> dict[str, int]:
    """Return the niceness by name; Linux gives a process its command line once the program is loaded."""
    others = {" ".join(process.cmdline()): process.nice() for process in psutil.Process().children()}
    commands = ("cad.jobs.main", "plot_process")
    return {name: nice for name in commands for command, nice in others.items() if name in command}
