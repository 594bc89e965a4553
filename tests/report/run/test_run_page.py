"""The page of a run says what summary.txt and results.json say, and what to do where there is nothing to show."""

from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import html5lib
import pytest
import sample_pages
from support import Command

from tvimdesign.page.blocks import Folded, Grid
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.blocks.sections import assumptions_section
from tvimdesign.report.run.blocks.tables import moves
from tvimdesign.report.run.run_page import glance


def words(element: Element) -> str:
    """All text of an element, blanks made one."""
    return " ".join("".join(element.itertext()).split())


def tree(path: Path) -> Element:
    """The page as elements without a namespace."""
    found: Element = html5lib.parse(path.read_text("utf-8"), namespaceHTMLElements=False)
    return found


def section(page: Element, name: str) -> Element:
    found = page.find(f".//section[@id='{name}']")
    assert found is not None
    return found


@pytest.fixture(scope="module")
def answered() -> AnsweredStudy:
    return sample_pages.answered_study()


@pytest.mark.gate
def test_the_first_screen_says_what_the_terminal_says(tvimdesign: Command, tmp_path: Path) -> None:
    done = tvimdesign("run", sample_pages.STUDY, "--no-cad", "--no-plots", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert f"{tmp_path / 'out'}/report.html" in done.stdout
    summary = " ".join((tmp_path / "out/summary.txt").read_text("utf-8").split())
    first = section(tree(tmp_path / "out/report.html"), "first")
    facts = [(words(one[0]), words(one[1])) for one in first.findall(".//dl/div")]
    assert {"Size and mass", "Times", "Heating", "Soft", "Stiff", "Idealized ~"} <= {label for label, _ in facts}
    of_the_width = {
        "Starts",
        "Much lost motion",
        "Little lost motion",
        "Little friction",
    }  # their notes stand in a line that has room for them
    parts = [part for label, text in facts if label not in of_the_width for part in text.split(" · ")]
    assert [part for part in parts if part not in summary] == []
    warnings = [words(one).removeprefix("Warning ").partition(";")[0] for one in first.findall(".//ul/li")]
    assert len(warnings) > 3  # the folded ones, too
    assert [one for one in warnings if one not in summary.replace("`", "")] == []


def test_a_run_shows_its_parts_or_says_how_to_make_them(tmp_path: Path) -> None:
    page = tree(sample_pages.run_page(tmp_path / "run", parts=False))
    assert "`" not in words(section(page, "assembly"))
    assert "tvimdesign run paper_reconstructed.yaml --overwrite makes them" in words(section(page, "assembly"))
    assert page.find(".//section[@id='checks']") is None
    with_parts = tree(sample_pages.run_page(tmp_path / "with_parts"))
    assert "housing" in words(section(with_parts, "materials"))
    assert with_parts.find(".//section[@id='checks']") is not None


def test_an_input_is_named_with_the_outputs_it_moves(answered: AnsweredStudy) -> None:
    interval: dict[str, Any] = {
        "value": 1.0, "low": 0.5, "high": 2.0, "unit": "s", "to_halve": [],
        "one_at_a_time": {"low": 0.8, "high": 1.5}, "before": None,
    }  # fmt: skip
    shares = {"a": {"core_radius": 0.3, "wire_diameter": 0.01}, "b": {"core_radius": 0.6}}
    intervals = {name: {**interval, "shares": share} for name, share in shares.items()}
    assert moves("core_radius", intervals) == [("b", 0.6), ("a", 0.3)]
    assert moves("wire_diameter", intervals) == []  # a hundredth is nothing to be told of
    unmeasured = [{"name": name, "value": 9.0, "low": 8.0, "high": 10.0, "unit": "mm", "status": "assumed"}
                  for name in ("wire_diameter", "core_radius")]  # fmt: skip
    uncertainty = {"intervals": intervals, "unmeasured": unmeasured, "held": {"x >=": 0.5}}
    folded = assumptions_section(replace(answered, uncertainty=uncertainty)).blocks[-1]
    assert isinstance(folded, Folded)
    (grid,) = folded.blocks
    assert isinstance(grid, Grid)
    rows = [[cell.text for cell in row] for row in grid.rows]
    assert [row[0] for row in rows] == ["core_radius", "wire_diameter"]  # what moves most comes first
    assert rows[0][5] == "b 60 %, a 30 %"


def test_a_page_tells_how_sure_it_is_and_what_a_measurement_bought(answered: AnsweredStudy) -> None:
    assert "was not computed" in str(assumptions_section(answered).blocks[0])
    assert all("Manufacturing" not in str(block) for block in glance(answered))
    one = {"value": 100.0, "low": 90.0, "high": 120.0, "unit": "s", "before": {"low": 40.0, "high": 240.0},
           "one_at_a_time": {"low": 95.0, "high": 110.0}, "shares": {}, "to_halve": []}  # fmt: skip
    told = {"intervals": {"stiffening_rate": one}, "unmeasured": [], "held": {}}
    table = assumptions_section(replace(answered, uncertainty=told)).blocks[0]
    assert isinstance(table, Grid)
    shown = dict(zip((head.text for head in table.heads), (cell.text for cell in table.rows[0]), strict=True))
    assert (shown["low"], shown["high"], shown["before measuring"]) == ("90", "120", "40 to 240")
