"""The first screen: at most 40 lines in any width, whole names, blocks in order, and figures that the answer has."""

from __future__ import annotations

import csv
import json
import math
import re
from functools import cache
from pathlib import Path
from subprocess import CompletedProcess
from typing import NamedTuple

import pytest
from answers import shipped_answer
from comparable import COARSE, COMPRESSION, SHEAR
from support import ROOT, Command

from tvimdesign.device import Table
from tvimdesign.report.run.first_screen.requirements import lines_of
from tvimdesign.report.run.first_screen.screen import AFTER, LINES, Told, first_screen
from tvimdesign.report.run.first_screen.uncertainty_data import Uncertainty
from tvimdesign.report.run.first_screen.warnings import warnings_of
from tvimdesign.report.run.why import binding
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import Study, drawn, read_study, read_study_text
from tvimdesign.study.record_checks import record_checks

LISTED = "{catalog: music_wire_gauge, from: 2 mm, to: 3 mm}"
CHOICES = COARSE.replace("wire_diameter: [2 mm, 3 mm]", f"wire_diameter: {LISTED}").replace("5 N.m/rad", "4.5 N.m/rad")
MANY = """mode: shear
require:
  joint_stiffness@hot: [">= 1 N.m/rad", "<= 900 N.m/rad"]
  equilibrium_stiffening_time: "<= 900 s"
  far_face_cooling_time: "<= 90 min"
  structure_temperature_margin: ">= -90 K"
  stiffening_structure_margin: ">= -90 K"
  cold_side_temperature_margin: ">= 0 K"
  envelope_diameter: "<= 20 mm"
  envelope_height: "<= 90 mm"
  module_mass: "<= 300 g"
  frozen_time: "<= 900 s"
  peak_power: "<= 15 W"
  peak_voltage: "<= 12 V"
  holding_torque: ">= 1 N.m"
  impedance_range: ">= 2"
  spring_index: ">= 4"
  softening_time: "<= 300 s"
"""
COOL = """mode: shear
module:
  {process: machine_6061, target_temperature: 75 degC, pcl_thickness: 3 mm, response_criterion: mean, current: 1.8 A,
   link_screw_length: 9 mm}
operating_points: {hot: {temperature: 75 degC}}
"""


class WholeRun(NamedTuple):
    """A run with its plots and yield, in a process of its own; of the slow ones with sensitivities as well."""

    done: CompletedProcess[str]
    folder: Path


@pytest.fixture(
    scope="module",
    params=[
        (COARSE, []),
        pytest.param((SHEAR, ["--sensitivities"]), marks=pytest.mark.slow),
        pytest.param((COMPRESSION, ["--sensitivities"]), marks=pytest.mark.slow),
    ],
    ids=["quick", "shear", "compression"],
)
def whole_run(request: pytest.FixtureRequest, process: Command, tmp_path_factory: pytest.TempPathFactory) -> WholeRun:
    folder = tmp_path_factory.mktemp("whole")
    text, more = request.param
    (folder / "study.yaml").write_text(text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONWARNINGS", "always")
        words = ("run", folder / "study.yaml", "--no-cad", *more, "--out", folder / "out")
        done = process(*words, spread="on")
    assert done.returncode == 0, done.stderr
    return WholeRun(done, folder / "out")


BLOCKS = ("Weighs", "Soft after", "Stiff again", "Needs", "Chosen", "Held back by", "Warning", "Yield")


class Case(NamedTuple):
    """A study answered, with what its screen tells beside the answer."""

    study: Study
    table: Table
    found: StudyResult
    told: Told

    def screen(self, width: int) -> list[str]:
        """The lines in so many columns."""
        return first_screen(self.found, self.table, self.told, width)


@cache
def case(asked: str) -> Case:
    """A shipped study as it is drawn or optimised, or one of the texts above; `alone` without what it may be."""
    name = asked.removesuffix(" alone")
    texts = {"choices": CHOICES, "many": MANY, "aluminum": COOL}
    study = read_study_text(texts[name], name) if name in texts else read_study(ROOT / f"studies/{name}.yaml")
    study = study.model_copy(update={"name": f"A {name} study"}) if name in texts else study
    table = study.table
    if name in ("wrist_joint", "paper_compression"):
        study = drawn(study)
    shipped = name in ("paper_shear", "paper_as_published")
    found = shipped_answer(name) if shipped else answer(study)
    data = Uncertainty(study).data(found.design, 256) if name == asked else {}
    return Case(study, table, found, Told(12.3, data, warnings_of(found, table, record_checks(study))))


CASES = [
    "paper_shear",
    *(pytest.param(name, marks=pytest.mark.slow)
      for name in ("paper_as_published", "paper_compression", "wrist_joint", "choices", "many")),
]  # fmt: skip
uncertain = pytest.mark.parametrize("name", CASES)
each = pytest.mark.parametrize("name", [*CASES, "choices alone", "many alone"])
"""With what each may be, and two without it, which takes longer than the answer."""
widths = pytest.mark.parametrize("width", [80, 100, 140])


@widths
@each
def test_no_screen_has_more_than_forty_lines_nor_a_line_that_is_too_wide(name: str, width: int) -> None:
    lines = case(name).screen(width)
    assert len(lines) + AFTER <= LINES == 40
    assert max(map(len, lines)) <= width
    assert all(lines)


@widths
@each
def test_no_name_is_broken(name: str, width: int) -> None:
    one = case(name)
    records = {path.stem for path in (ROOT / "tvimdesign/catalog/data").rglob("*.yaml")}
    words = {word for row in one.table.choices for word in row.options}
    known = {*one.table.by_name, *records, *words}
    for line in one.screen(width):
        for found in re.findall(r"[a-z]\w*_\w*", line):
            assert found in known, line


@widths
@each
def test_every_requirement_is_there_by_the_name_the_study_gives_it(name: str, width: int) -> None:
    one = case(name)
    text = "\n".join(one.screen(width))
    asked = {requirement.output for requirement in one.study.require}
    shown = {output for output in asked if re.search(rf"^{re.escape(output)}(\s|$)", text, re.MULTILINE)}
    assert asked == shown or (shown < asked and "more with larger margins" in text)
    broken = {check.output for check in one.found.checks if not check.kept}
    assert all(re.search(rf"^{re.escape(output)}\s.*BROKEN", text, re.MULTILINE) for output in broken & asked)


@widths
@each
def test_the_blocks_stand_in_their_order(name: str, width: int) -> None:
    lines = case(name).screen(width)
    places = [(i, block) for block in BLOCKS for i, line in enumerate(lines) if line.startswith(f"{block} ")]
    assert places == sorted(places)
    told = {"Yield"} if case(name).told.uncertainty else set()
    assert {"Weighs", "Soft after", "Stiff again", "Needs", *told} <= {block for _, block in places}
    assert case(name).study.name in lines[0]


@pytest.mark.gate
def test_the_first_line_says_mode_status_starts_and_seconds() -> None:
    accepted = "ACCEPTING: structure_temperature_margin(, stiffening_structure_margin)?"  # the optimum may not need it
    published = case("paper_as_published alone")
    first, second = (" ".join(one.screen(140)[:2]) for one in (case("paper_shear"), published))
    solution = case("paper_shear").found.solution
    assert solution is not None
    ends = [start.objective for start in solution.starts if start.converged]
    same = sum(end == pytest.approx(solution.objective, rel=1e-4) for end in ends)
    tried = len(ends)
    agree = f"{same} of {tried} starts agree" if same > 1 else f"found by 1 of {tried} starts"
    assert re.search(rf" · shear · OPTIMAL, {accepted}( ·)? {agree} · 12 s", first)
    # PETG and pads are hotter than they are rated for, as its study accepts.
    assert re.search(r" · shear( ·)? EVALUATED, ACCEPTING: [\w, ]+_margin( ·)? 12 s", second)
    assert "EVALUATED, ALL LIMITS KEPT · 12 s" in " ".join(case("aluminum alone").screen(140)[:1])
    assert re.search(r"EVALUATED, \d+ OF \d+ LIMITS BROKEN", case("many alone").screen(140)[0])


def test_what_is_asked_and_got_is_what_the_answer_has() -> None:
    one = case("paper_shear")
    lines = {line.name: line for line in lines_of(one.found, one.table, {})}
    values = one.found.design.values
    assert lines["spring_stiffness"].asked == "5.2 to 5.8 N·m/rad"
    least, most = map(float, lines["spring_stiffness"].got.split(" to "))  # over the stroke
    assert least == pytest.approx(values["least_spring_stiffness"], rel=1e-3)
    assert least <= values["spring_stiffness"] * 1.001
    assert most >= values["spring_stiffness"] * 0.999
    assert lines["spring_stiffness"].stands == "BINDS"
    assert lines["holding_torque"].asked == ">= 12 N·m"  # told as asked, though it is the least of three
    assert lines["holding_torque"].stands == "BINDS"
    assert lines["impedance_range"].stands == f"{100.0 * (values['impedance_range'] / 50.0 - 1.0):.2g} %"
    assert lines["peltier_temperature_margin"].got == "0"


def test_what_holds_it_back_has_the_largest_shadow_prices() -> None:
    one = case("paper_shear")
    screen = one.screen(140)
    first = next(i for i, line in enumerate(screen) if line.startswith("Held back by"))
    prices = sorted((held.shadow_price for held in binding(one.found)), reverse=True)
    found = [re.search(r"(\S+) .*shadow price (\S+) %", line[13:]) for line in screen[first : first + 3]]
    assert [match and match[2] for match in found] == [f"{price:.2g}" for price in prices[:3]]
    held = {one.output for one in binding(one.found)}
    assert all(match and match[1] in held for match in found)


@uncertain
def test_every_headline_and_requirement_is_told_with_what_it_may_be(name: str) -> None:
    one = case(name)
    intervals, text = one.told.uncertainty["intervals"], "\n".join(one.screen(140))
    asked = {requirement.output for requirement in one.study.require}
    assert asked | {"module_mass", "softening_time", "stiffening_time", "frozen_time", "peak_power"} <= set(intervals)
    for output, interval in intervals.items():
        low, high = (math.inf if interval[end] is None else interval[end] for end in ("low", "high"))
        value = math.inf if interval["value"] is None else interval["value"]
        assert low <= value <= high, output
    soft = intervals["softening_time"]
    ends = ["never" if soft[end] is None else f"{soft[end]:.3g}" for end in ("low", "high")]
    assert f"({ends[0]} to {ends[1]})" in text
    assert f"measure first: {next(iter(soft['shares']))}" in text
    lines = {line.name: line for line in lines_of(one.found, one.table, {}, intervals)}
    told = [line for line in lines.values() if line.may_be]
    assert told or not one.study.require
    assert name == "many" or all(re.search(rf"^{line.name}\s.*{line.may_be}", text, re.MULTILINE) for line in told)


def test_what_the_stiffness_may_be_covers_the_whole_stroke() -> None:
    # A limit on the stiffness holds at every angle; at rest it is stiffest, at full stroke softest.
    one = case("paper_shear")
    intervals = one.told.uncertainty["intervals"]
    (line,) = [line for line in lines_of(one.found, one.table, {}, intervals) if line.name == "spring_stiffness"]
    low, high = (float(end) for end in line.may_be.split(" to "))
    angles = ("spring_stiffness", *one.table.output("spring_stiffness").also_limited)
    assert len(angles) == 5
    assert low == pytest.approx(min(intervals[angle]["low"] for angle in angles), rel=5e-3)
    assert high == pytest.approx(max(intervals[angle]["high"] for angle in angles), rel=5e-3)
    assert low < intervals["spring_stiffness"]["low"] - 0.01


def test_a_limit_that_binds_and_nothing_moves_is_not_told_as_broken() -> None:
    # The stiffness at full stroke over that at rest is of the geometry alone; the optimum is on its limit.
    held = case("paper_shear").told.uncertainty["held"]
    assert held.get("stiffness_over_stroke >=", 1.0) > 0.4


def test_the_yield_and_what_is_not_known_are_two_lines() -> None:
    data, text = case("paper_shear").told.uncertainty, case("paper_shear").screen(140)
    (parts,) = [line for line in text if line.startswith("Yield ")]
    (unknown,) = [line for line in text if line.startswith("Not known ")]
    assert f"{100.0 * data['parts_yield']['share']:.3g} %" in parts
    assert f"hold in {100.0 * data['ranges_hold']['share']:.3g} % of the ranges" in unknown


TABLES = ("At the operating points", "What the module is", "What rests on what is assumed")


@pytest.mark.gate
def test_a_run_prints_the_screen_and_keeps_every_table_in_its_folder(whole_run: WholeRun) -> None:
    lines, folder = whole_run.done.stdout.splitlines(), whole_run.folder
    assert len(lines) <= LINES
    assert lines[-1].lstrip().endswith("--full")
    for table in TABLES:
        assert table not in whole_run.done.stdout
        assert table in (folder / "summary.txt").read_text()
    reported = json.loads((folder / "results.json").read_text())
    assert reported["format"] == 1
    soft = reported["uncertainty"]["intervals"]["softening_time"]
    text = (folder / "results.csv").read_text("utf-8-sig")
    rows = {row["name"]: row for row in csv.DictReader(text.splitlines())}
    may_be = [float(rows["softening_time"][f"may_be_{end}"]) for end in ("low", "high")]
    assert may_be == pytest.approx([soft["low"], soft["high"]])
    assert rows["softening_time"]["measure_first"] == next(iter(soft["shares"]))
    assert soft["si"]["low"] == soft["low"] < soft["one_at_a_time"]["low"]


@pytest.mark.gate
def test_every_table_is_printed_where_that_is_asked(tvimdesign: Command, tmp_path: Path) -> None:
    study = ROOT / "studies/paper_as_published.yaml"
    full = tvimdesign("run", study, "--no-cad", "--no-plots", "--full", "--out", tmp_path / "out").stdout
    assert all(table in full for table in TABLES[:2])  # the third is of the yield's run
    assert len(full.splitlines()) > LINES


@pytest.mark.slow
def test_the_same_study_leaves_the_same_tables_whatever_is_printed(tvimdesign: Command, tmp_path: Path) -> None:
    """What a run took is in its manifest alone."""
    study = ROOT / "studies/paper_as_published.yaml"
    done = {}
    for name, more in (("short", []), ("full", ["--full"])):
        done[name] = tvimdesign("run", study, "--no-cad", "--no-plots", *more, "--out", tmp_path / name, spread="on")
    assert all(table in done["full"].stdout for table in TABLES)
    assert (tmp_path / "short/summary.txt").read_bytes() == (tmp_path / "full/summary.txt").read_bytes()


INFEASIBLE = (
    "mode: shear\nname: Too much asked\n"
    "vary: {wire_diameter: [1.2 mm, 3.2 mm], coil_diameter: [8 mm, 32 mm], coil_count: [3, 8]}\n"
    'require: {spring_stiffness: ">= 20 N.m/rad", spring_fatigue_safety: ">= 3"}\nminimize: module_mass\n'
    "solver: {starts: 1, max_iterations: 60}\n"
)


@pytest.mark.gate
def test_where_there_is_no_design_the_screen_says_so_and_nothing_but_our_lines_is_on_standard_error(
    process: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONWARNINGS", "always")
    (tmp_path / "study.yaml").write_text(INFEASIBLE)
    done = process("run", tmp_path / "study.yaml", "--no-cad", "--no-plots", "--out", tmp_path / "out", spread="on")
    assert done.returncode == 3
    lines = done.stdout.splitlines()
    assert lines[0].startswith("Too much asked · shear · NO DESIGN FOUND")
    assert "BROKEN" in done.stdout
    progress = [line for line in done.stderr.splitlines() if line.startswith("... ")]
    said = [line for line in done.stderr.splitlines() if not line.startswith("... ")]
    assert progress
    assert said[0].startswith("Too much asked: no design found that keeps every limit")
    assert len(lines) + len(said) <= LINES
    assert "Where the solver ended" in (tmp_path / "out/summary.txt").read_text()


@pytest.mark.gate
def test_no_library_warns_on_standard_error(whole_run: WholeRun) -> None:
    assert [line for line in whole_run.done.stderr.splitlines() if not line.startswith("... ")] == []
    assert whole_run.done.stdout.splitlines()[0].startswith("study · ")
