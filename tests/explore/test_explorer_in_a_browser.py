"""The explorer as a person uses it: drags, types, undoes, pins, saves, loses the connection, on a phone too."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import axe_playwright_python
import pytest
from explored import SMALL, small_study
from playwright.sync_api import Browser
from served_explorer import Explorer, Served, exploring
from support import environment

from tvimdesign.report.run.answered_study import answer_study
from tvimdesign.study.tree import tree_of_file

FRONT = """
accept: [structure_temperature_margin, peltier_temperature_margin, stiffening_structure_margin]
minimize: {response_time: 1, peak_power: 1}
front: {of: [response_time, peak_power], points: 3}
"""
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


@pytest.mark.slow
def test_the_draft_in_3d_follows_a_slider_that_is_held(explorer: Explorer) -> None:
    page, number = explorer.page, explorer.number
    page.get_by_role("button", name="Evaluate").click()
    explorer.answered(number, "exact")
    draft = page.locator("#draft")
    page.locator("#draft[data-draft]").wait_for()
    drawn = "document.getElementById('draft').viewer"
    layer = f"{drawn}.parts.get('pcl_arc_1').geometry"
    high = f"({layer}.computeBoundingBox(), {layer}.boundingBox.max.z)"
    page.get_by_text("Parts shown").click()
    draft.get_by_role("checkbox", name="housing", exact=True).uncheck()
    explorer.until("(now) => Number(document.getElementById('draft').dataset.draft) >= now", explorer.number)
    number = explorer.number
    thickness = float(explorer.knob("pcl_thickness").get_by_role("textbox").input_value().split()[0])
    before = page.evaluate(high)
    thicker = 1.9 if thickness < 1.3 else 0.7
    slider = explorer.knob("pcl_thickness").get_by_role("slider")
    hold = "(one, value) => { one.value = value; one.dispatchEvent(new Event('input')); }"  # held, not let go
    slider.evaluate(hold, thicker)
    explorer.until("(after) => Number(document.getElementById('draft').dataset.draft) > after", number)
    assert page.evaluate(high) == pytest.approx(before + thicker - thickness, abs=3e-3)  # a step of the slider
    assert page.evaluate(f"{drawn}.parts.get('housing').object.visible") is False
    slider.dispatch_event("change")
    assert explorer.complaints == []


@pytest.mark.slow
def test_where_nothing_is_feasible_the_page_says_so_and_shows_the_nearest_design(explorer: Explorer) -> None:
    page, number = explorer.page, explorer.number
    field = explorer.knob("peak_power <=").get_by_role("textbox")
    field.fill("0.5 W")
    field.press("Enter")
    explorer.answered(number, "exact")
    assert "no design found that keeps every limit" in page.locator("#status").inner_text()
    explorer.knob("peak_power <=").locator(".stands").filter(has_text="broken").wait_for()
    assert page.locator("#limits tr.broken").count() >= 1


@pytest.mark.slow
def test_a_point_of_a_front_is_clicked_its_module_seen_and_its_parts_made(browser: Browser, tmp_path: Path) -> None:
    study = small_study(tmp_path, SMALL.replace("minimize: {response_time: 1, module_mass: 1}", FRONT))
    run = ["run", str(study), "--out", str(tmp_path / "run"), "--no-cad", "--no-plots"]
    subprocess.run([sys.executable, "-m", "tvimdesign", *run], check=True, env=environment(), capture_output=True)
    found = Served(tmp_path / "run", tmp_path / "out")
    found.begin()
    try:
        with exploring(browser, found.address) as explorer:
            page = explorer.page
            points = page.locator("#front svg path[d^='M1 0A']")
            points.first.wait_for(state="attached")
            page.get_by_text("Points, as buttons").click()
            names = page.locator("#front details button")
            assert names.count() == points.count() >= 1
            before = explorer.number
            points.last.click(force=True)
            page.get_by_text("Variables", exact=True).wait_for()
            explorer.answered(before, "exact")
            page.get_by_role("button", name="Make CAD").click()
            page.locator("#report #assembly").wait_for(timeout=300_000)
            figure = page.locator("#figure-solids")
            figure.scroll_into_view_if_needed()
            page.wait_for_selector("#figure-solids[data-state=drawn]", timeout=120_000)
            assert explorer.complaints == []
    finally:
        found.end()
