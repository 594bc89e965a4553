"""The page of a run, and why a design is as it is."""

import csv
import io
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from xml.etree.ElementTree import Element

import html5lib
import pytest
import sample_pages
from small_studies import FOUR_SIZES_IN_SHEAR

from tvimdesign.device import table_for
from tvimdesign.engine import integrator
from tvimdesign.report.page.blocks import Folded, Grid
from tvimdesign.report.run.answered_study import AnsweredStudy, answer_study
from tvimdesign.report.run.blocks.facts import _active_constraints
from tvimdesign.report.run.blocks.requirements import requirements
from tvimdesign.report.run.blocks.sections import assumptions_section
from tvimdesign.report.run.blocks.tables import checks_grid, intervals_grid, moves, torque_path_grid
from tvimdesign.report.run.reasons import active, sentences, why_csv, why_rows
from tvimdesign.report.run.run_page import glance
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study_text
from tvimdesign.study.tree import tree_of_text


def words(element: Element) -> str:
    """Return all text of an element, with single blanks."""
    return " ".join("".join(element.itertext()).split())


def tree(path: Path) -> Element:
    """Parse the page as elements without a namespace."""
    root: Element = html5lib.parse(path.read_text("utf-8"), namespaceHTMLElements=False)
    return root


def section(page: Element, name: str) -> Element:
    element = page.find(f".//section[@id='{name}']")
    assert element is not None
    return element


@pytest.fixture(scope="module")
def answered() -> AnsweredStudy:
    return sample_pages.answered_study()


@pytest.mark.gate
def test_the_first_screen_says_what_the_terminal_says(tvimdesign, tmp_path):
    done = tvimdesign("run", sample_pages.STUDY, "--no-cad", "--no-plots", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert f"{tmp_path / 'out'}/report.html" in done.stdout
    summary = " ".join((tmp_path / "out/summary.txt").read_text("utf-8").split())
    first = section(tree(tmp_path / "out/report.html"), "first")
    facts = [(words(fact[0]), words(fact[1])) for fact in first.findall(".//dl/div")]
    assert {"Size and mass", "Times", "Heating", "Soft", "Stiff", "Idealized ~"} <= {label for label, _ in facts}
    of_the_width = {"Starts", "Stroke"}  # their notes stand in a line that has room for them
    parts = [part for label, text in facts if label not in of_the_width for part in text.split(" · ")]
    assert [part for part in parts if part not in summary] == []
    warnings = [words(item).removeprefix("Warning ").partition(";")[0] for item in first.findall(".//ul/li")]
    assert len(warnings) > 3  # the folded ones, too
    assert [warning for warning in warnings if warning not in summary.replace("`", "")] == []


@pytest.mark.gate
def test_a_run_shows_its_parts_or_says_how_to_make_them(tmp_path):
    page = tree(sample_pages.run_page(tmp_path / "run", parts=False))
    assert "`" not in words(section(page, "assembly"))
    assert "tvimdesign run paper_reconstructed.yaml --overwrite makes them" in words(section(page, "assembly"))
    assert page.find(".//section[@id='checks']") is None
    with_parts = tree(sample_pages.run_page(tmp_path / "with_parts"))
    assert "housing" in words(section(with_parts, "materials"))
    assert with_parts.find(".//section[@id='checks']") is not None


def test_an_input_is_named_with_the_outputs_it_moves(answered):
    interval: dict[str, Any] = {
        "value": 1.0, "low": 0.5, "high": 2.0, "unit": "s", "to_halve": [],
        "one_at_a_time": {"low": 0.8, "high": 1.5}, "before": None,
    }  # fmt: skip
    shares = {"a": {"core_radius": 0.3, "wire_diameter": 0.01}, "b": {"core_radius": 0.6}}
    intervals = {name: {**interval, "shares": share} for name, share in shares.items()}
    assert moves("core_radius", intervals) == [("b", 0.6), ("a", 0.3)]
    assert moves("wire_diameter", intervals) == []  # a hundredth is nothing to report
    unmeasured = [{"name": name, "value": 9.0, "low": 8.0, "high": 10.0, "unit": "mm", "status": "assumed"}
                  for name in ("wire_diameter", "core_radius")]  # fmt: skip
    uncertainty = {"intervals": intervals, "unmeasured": unmeasured, "held": {"core_web >=": 0.5}, "draws": 512}
    folded = assumptions_section(replace(answered, uncertainty=uncertainty)).blocks[-1]
    assert isinstance(folded, Folded)
    (grid,) = folded.blocks
    assert isinstance(grid, Grid)
    rows = [[cell.text for cell in row] for row in grid.rows]
    assert [row[0] for row in rows] == ["core_radius", "wire_diameter"]  # what moves most comes first
    assert rows[0][5] == "b 60 %, a 30 %"


def test_a_page_tells_how_sure_it_is_and_what_a_measurement_bought(answered):
    assert "was not computed" in str(assumptions_section(answered).blocks[0])
    assert all("Manufacturing" not in str(block) for block in glance(answered))
    interval = {"value": 100.0, "low": 90.0, "high": 120.0, "unit": "s", "before": {"low": 40.0, "high": 240.0},
           "one_at_a_time": {"low": 95.0, "high": 110.0}, "shares": {}, "to_halve": []}  # fmt: skip
    uncertainty = {"intervals": {"stiffening_rate": interval}, "unmeasured": [], "held": {}, "draws": 512}
    table = assumptions_section(replace(answered, uncertainty=uncertainty)).blocks[0]
    assert isinstance(table, Grid)
    shown = dict(zip((head.text for head in table.heads), (cell.text for cell in table.rows[0]), strict=True))
    assert (shown["low"], shown["high"], shown["before measuring"]) == ("90", "120", "40 to 240")


TABLE = table_for("shear")
ACTIVE_STUDY = f"""{FOUR_SIZES_IN_SHEAR}
require: {{spring_stiffness: [">= 5 N.m/rad", "<= 8 N.m/rad"], peak_power: "<= 9 W"}}
minimize: {{module_mass: 1, response_time: 1}}
solver: {{starts: 1}}
"""


@pytest.fixture(scope="module")
def optimum() -> StudyResult:
    return answer(read_study_text(ACTIVE_STUDY, "a test"))


def test_more_stiffness_costs_mass_and_less_power_time(optimum):
    held = next(held for held in active(optimum) if held.name == "spring_stiffness_full_stroke >=")  # the least
    cost = held.sensitivity["module_mass"]
    assert 0.0 < cost < 1.0
    begin = "1 % more spring_stiffness_full_stroke (now >= 5 N·m/rad) costs"
    sentence = next(text for text in sentences(optimum) if text.startswith(begin))
    assert f"{cost:.2g} % module_mass" in sentence
    sentence = next(text for text in sentences(optimum) if "peak_power" in text)
    assert sentence.startswith("1 % less peak_power (now <= 9 W) costs")
    assert "response_time" in sentence


def test_a_step_that_costs_more_than_everything_has_no_room(optimum):
    held = replace(active(optimum)[0], shadow_price=2.4e3, sensitivity={})
    steep = replace(optimum, solution=replace(optimum.solution, held=(held,)))
    (sentence,) = sentences(steep)
    assert sentence.endswith(f"(now{held.text.removeprefix(held.output)}): no room.")
    (fact,) = _active_constraints(steep)
    assert fact.note == f"no room for {held.step} of the first"


def test_each_limit_is_active_touches_or_has_room_in_its_order(optimum):
    rows = why_rows(optimum)
    assert len(rows) == len(optimum.solution.held)
    by_text = {row["limit"]: row for row in rows}
    assert by_text["spring_stiffness_full_stroke >= 5 N·m/rad"]["stands"] == "active"
    assert by_text["spring_stiffness >= 5 N·m/rad"]["stands"] == "slack"  # at rest the springs are stiffer
    upper = by_text["spring_stiffness <= 8 N·m/rad"]
    assert upper["stands"] == "slack"
    assert upper["margin"] == pytest.approx(1.0 - optimum.design.value("spring_stiffness") / 8.0, rel=1e-3)
    for row in rows:
        assert (row["stands"] == "slack") == (row["margin"] > 0.0 and row["shadow_price"] < 1e-3) or row[
            "stands"
        ] == "touches"
    slack = [row["limit"] for row in rows if row["stands"] == "slack"]
    rooms = {held.text: held.margin for held in optimum.solution.held}
    assert slack == sorted(slack, key=rooms.__getitem__)
    room = optimum.design.value("spring_stiffness_seven_tenths_stroke") / 5.0 - 1.0
    assert by_text["spring_stiffness_seven_tenths_stroke >= 5 N·m/rad"]["margin"] == pytest.approx(room, rel=1e-3)
    rows = list(csv.DictReader(io.StringIO(why_csv(optimum))))
    first = active(optimum)[0]
    assert rows[0]["limit"] == first.text
    for name, saving in first.sensitivity.items():
        assert float(rows[0][f"sensitivity of {name} [%]"]) == pytest.approx(saving, rel=1e-5, abs=1e-12)


def test_a_limit_active_at_its_tolerance_margin_is_so_everywhere(optimum):
    costly = {held.text for held in active(optimum)}
    assert "peak_power <= 9 W" in costly
    checks = tuple(replace(each, margin=0.05, worst=0.05) for each in optimum.checks if each.text in costly)
    with_margins = replace(optimum, checks=checks)
    (row,) = [row for row in requirements(with_margins, {}) if row.name == "peak_power"]
    assert row.stands == "5 %, active"
    table = checks_grid(with_margins)
    assert len(table.rows) == len(checks) >= 2
    assert {row[0].text for row in table.rows} == {"active"}


def test_the_load_path_shows_the_strength_behind_each_part(optimum):
    table = torque_path_grid(optimum)
    strengths = {row[0].text: row[3].text for row in table.rows}
    values = optimum.design.values
    assert float(strengths["layer_holding_torque"]) == pytest.approx(1e-6 * values["bond_strength"], rel=5e-3)
    steel = 1e-6 * values["link_dowel_shear_strength"]
    assert float(strengths["dowel_shear_holding_torque"]) == pytest.approx(steel, rel=5e-3)
    assert "strengths at 30 °C" in table.caption


def test_the_first_run_says_that_it_compiles(tmp_path, monkeypatch):
    class FirstMessageError(Exception):
        """The first message of a run, which ends it."""

    def end_with(text: str) -> None:
        raise FirstMessageError(text)

    monkeypatch.setattr(integrator, "advance", SimpleNamespace(stats=SimpleNamespace(cache_path=tmp_path)))
    tree = tree_of_text("mode: shear", "study.yaml", "study", tmp_path)
    with pytest.raises(FirstMessageError, match="equations: the first run after an installation compiles them"):
        answer_study(tree, end_with)
    (tmp_path / "integrator.advance-263.py311.nbi").touch()
    with pytest.raises(FirstMessageError, match=r"^preparing the equations$"):
        answer_study(tree, end_with)


def test_a_range_without_an_end_is_a_row():
    alone = {"low": 1293.0, "high": None}
    never = {"value": 1742.0, **alone, "one_at_a_time": alone, "shares": {}, "to_halve": [], "unit": "s"}
    (row,) = intervals_grid({"softening_time": never}).rows
    assert [cell.text for cell in row[1:5]] == ["1742", "1293", "never", "1293 to never"]
