"""The explorer as a person uses it: drags, types, undoes, pins, saves, loses the connection, on a phone too."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import axe_playwright_python
import pytest
from served_explorer import Explorer, Served

from tvimdesign.report.run.answered_study import answer_study
from tvimdesign.study.tree import tree_of_file

AXE = (Path(axe_playwright_python.__file__).parent / "axe.min.js").read_text("utf-8")


def test_a_requirement_is_dragged_the_optimum_moves_and_what_binds_lights_up(explorer: Explorer) -> None:
    page, power = explorer.page, explorer.knob("peak_power <=")
    current = explorer.knob("current").get_by_role("textbox").first
    before, number = current.input_value(), explorer.number
    power.get_by_role("slider").focus()
    for _ in range(40):
        page.keyboard.press("ArrowLeft")
    explorer.answered(number + 1)
    power.locator(".stands").filter(has_text="binds").wait_for()
    assert current.input_value() != before
    assert page.locator("#limits tr.binds").count() >= 1
    assert explorer.complaints == []


@pytest.mark.slow
def test_nonsense_is_refused_in_words_where_it_was_typed(explorer: Explorer) -> None:
    field = explorer.knob("peak_power <=").get_by_role("textbox")
    field.fill("ten wats")
    field.press("Enter")
    refusal = explorer.knob("peak_power <=").get_by_role("alert")
    refusal.filter(has_text="expected").wait_for()
    assert "ten wats" in refusal.inner_text()


@pytest.mark.slow
def test_evaluating_follows_a_slider_and_undo_goes_back(explorer: Explorer) -> None:
    page = explorer.page
    page.get_by_role("button", name="Evaluate").click()
    page.get_by_text("Variables", exact=True).wait_for()
    knob = explorer.knob("pcl_thickness")
    before, number = knob.get_by_role("textbox").input_value(), explorer.number
    knob.get_by_role("textbox").fill("1.2 mm")
    knob.get_by_role("textbox").press("Enter")
    explorer.answered(number)
    page.get_by_role("button", name="Undo").click()
    explorer.shows("pcl_thickness", before)


@pytest.mark.slow
def test_a_design_is_pinned_and_a_study_saved_that_run_answers_the_same(explorer: Explorer, served: Served) -> None:
    page, number = explorer.page, explorer.number
    page.get_by_role("button", name="Pin", exact=True).click()
    page.get_by_role("columnheader", name="pin 1").wait_for()
    field = explorer.knob("peak_power <=").get_by_role("textbox")
    field.fill("9 W")
    field.press("Enter")
    explorer.answered(number, "exact")
    page.get_by_role("textbox", name="File to save").fill("mine.yaml")
    page.get_by_role("button", name="Save as study").click()
    page.get_by_text("Saved:").wait_for()
    shown = explorer.knob("pcl_thickness").get_by_role("textbox").first.input_value()
    design = answer_study(tree_of_file(served.folder / "mine.yaml"), lambda _: None).result.design
    assert float(shown.split()[0]) == pytest.approx(1e3 * design.values["pcl_thickness"], rel=1e-3)
    assert page.locator("#report section").count() > 3
    page.get_by_role("button", name="Let pin 1 go").click()
    page.locator("#pins-section").wait_for(state="hidden")


@pytest.mark.slow
def test_two_tabs_show_the_same(explorer: Explorer, another: Callable[..., Explorer]) -> None:
    other = another()
    field = explorer.knob("peak_power <=").get_by_role("textbox")
    field.fill("8.5 W")
    field.press("Enter")
    other.shows("peak_power <=", "8.5 W")


@pytest.mark.slow
@pytest.mark.parametrize("colours", ["light", "dark"])
def test_a_phone_has_it_all_in_its_width_and_axe_finds_no_serious_fault(
    another: Callable[..., Explorer], colours: str
) -> None:
    page = another(viewport={"width": 360, "height": 740}, color_scheme=colours, bypass_csp=True).page
    page.locator("#report[data-report]").wait_for()
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    page.evaluate("document.getElementById('report').remove()")  # the report has its own test
    page.evaluate(AXE)
    faults = page.evaluate("axe.run(document, { resultTypes: ['violations'] }).then(({ violations }) => violations)")
    serious = [one for one in faults if one["impact"] in {"serious", "critical"}]
    assert [(one["id"], [node["html"][:120] for node in one["nodes"][:3]]) for one in serious] == []


@pytest.mark.slow
def test_the_connection_is_cut_the_page_says_so_and_comes_back_with_what_was_done(
    explorer: Explorer, served: Served
) -> None:
    page = explorer.page
    field = explorer.knob("peak_power <=").get_by_role("textbox")
    number = explorer.number
    field.fill("8.8 W")
    field.press("Enter")
    explorer.answered(number)
    served.end()
    page.get_by_text("No connection to the server").wait_for()
    served.begin()
    explorer.until("document.documentElement.dataset.connected === 'yes'")
    assert page.locator("#connection").inner_text() == ""
    assert field.input_value() == "8.8 W"
    explorer.answered(0)
