"""The explorer as a person uses it: drags, types, undoes, pins, saves, loses the connection, on a phone too."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from explored import SMALL, small_study
from opened_page import Opened, serious_faults
from served_explorer import serving
from support import environment

WANTED = "minimize: {response_time: 1, module_mass: 1}"
FRONT = "minimize: {response_time: 1, peak_power: 1}\nfront: {of: [response_time, peak_power], points: 3}"
CELLS = "(one) => [...one.tBodies[0].rows].map((row) => [...row.cells].map((cell) => cell.innerText))"
"""Of a table."""


def run(study: Path, out: Path) -> None:
    """Answer the study by the command `run`."""
    words = ["run", str(study), "--out", str(out), "--no-cad", "--no-plots", "--overwrite"]
    subprocess.run([sys.executable, "-m", "tvimdesign", *words], check=True, env=environment(), capture_output=True)


@pytest.mark.gate
def test_dragging_a_requirement_moves_the_optimum(explorer):
    page, power = explorer.page, explorer.knob("peak_power <=")
    current = explorer.knob("current").get_by_role("textbox").first
    before, number = current.input_value(), explorer.number
    power.get_by_role("slider").focus()
    for _ in range(40):
        page.keyboard.press("ArrowLeft")
    explorer.answered(number + 1)
    power.locator(".stands").filter(has_text="active").wait_for()
    assert current.input_value() != before
    assert page.locator("#limits tr.active").count() >= 1
    assert explorer.complaints == []


@pytest.mark.gate
def test_an_input_is_found_by_a_word_and_its_group_opens(explorer):
    page = explorer.page
    page.get_by_role("searchbox", name="Search inputs and choices").fill("ambient")
    rows = page.locator(".inputs .knob:visible")
    assert 0 < rows.count() < 20
    assert "ambient" in " ".join(rows.all_inner_texts())
    page.get_by_role("searchbox", name="Search inputs and choices").fill("")
    assert rows.count() == 0


@pytest.mark.slow
def test_a_joint_is_sized_by_the_form_and_undo_goes_back(explorer):
    page = explorer.page
    page.get_by_text("Size a joint from a few numbers").click()
    page.get_by_label("Largest diameter").fill("70")
    page.get_by_role("button", name="Size it").click()
    page.locator("#told").filter(has_text="diameter").wait_for()  # no unit
    page.get_by_label("Largest diameter").fill("76 mm")
    page.get_by_label("Stiff again within").fill("15 min")
    before = explorer.number
    page.get_by_role("button", name="Size it").click()
    explorer.knob("envelope_diameter <=").wait_for()
    explorer.answered(before, "exact")
    assert page.locator("#status").inner_text().startswith("Build it")
    for limit, value in (("envelope_diameter <=", "76 mm"), ("stiffening_time <=", "900 s")):
        assert explorer.knob(limit).get_by_role("textbox").input_value() == value
    page.get_by_role("button", name="Undo").click()
    explorer.knob("envelope_diameter <=").wait_for(state="detached")
    assert explorer.complaints == []


@pytest.mark.slow
def test_a_dragged_slider_is_answered_quickly_then_exactly(explorer):
    page, power = explorer.page, explorer.knob("peak_power <=")
    slider, field = power.get_by_role("slider"), power.get_by_role("textbox")
    explorer.answered(0, "exact")
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    assert box
    least, most, stands = (float(slider.evaluate(f"(one) => one.{what}")) for what in ("min", "max", "value"))
    x, y = box["x"] + box["width"] * (stands - least) / (most - least), box["y"] + box["height"] / 2
    before, texts, mouse = explorer.number, [field.input_value()], page.mouse
    mouse.move(x, y)
    mouse.down()
    for share in (0.06, 0.12):
        mouse.move(x - share * box["width"], y, steps=3)
        texts.append(field.input_value())
        explorer.answered(before, "quick")
        before = explorer.number
    mouse.up()
    explorer.answered(before - 1, "exact")
    watts = [float(text.removeprefix("<=").split()[0]) for text in texts]
    assert watts == sorted(watts, reverse=True)
    assert len(set(watts)) == 3
    assert field.input_value() == texts[-1]
    assert power.locator(".stands").inner_text().startswith("active")
    assert explorer.complaints == []


@pytest.mark.slow
def test_nonsense_is_refused_and_undo_goes_back(explorer):
    field = explorer.knob("peak_power <=").get_by_role("textbox")
    field.fill("ten wats")
    field.press("Enter")
    refusal = explorer.knob("peak_power <=").get_by_role("alert")
    refusal.filter(has_text="expected").wait_for()
    assert "ten wats" in refusal.inner_text()
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
def test_a_design_is_pinned_and_a_study_saved_that_run_answers_the_same(explorer, served):
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
    report = page.locator("#report")
    reported = {row[0]: row[1:] for row in report.get_by_role("table").first.evaluate(CELLS)}
    run(served.folder / "mine.yaml", served.folder / "run")
    result = Opened(explorer.page.context.new_page())
    result.page.goto((served.folder / "run/report.html").as_uri())
    assert {row[0]: row[1:] for row in result.page.get_by_role("table").first.evaluate(CELLS)} == reported
    design = json.loads((served.folder / "run/design.json").read_text("utf-8"))["values"]
    for name, unit in (("pcl_thickness", 1e-3), ("current", 1.0)):
        shown = explorer.knob(name).get_by_role("textbox").first.input_value()
        assert float(shown.split()[0]) * unit == pytest.approx(design[name], rel=5e-4)  # four digits are shown
    assert page.locator("#report section").count() > 3
    page.get_by_role("button", name="Let pin 1 go").click()
    page.locator("#pins-section").wait_for(state="hidden")


@pytest.mark.slow
def test_a_browser_that_is_closed_and_opened_again_goes_on_where_it_was(explorer, another):
    page, number = explorer.page, explorer.number
    field = explorer.knob("peak_power <=").get_by_role("textbox")
    before = field.input_value()
    field.fill("9.3 W")
    field.press("Enter")
    explorer.answered(number)
    page.get_by_role("button", name="Pin", exact=True).click()
    page.get_by_role("columnheader", name="pin 1").wait_for()
    page.context.close()
    again = another()
    again.shows("peak_power <=", "9.3 W")
    again.page.get_by_role("columnheader", name="pin 1").wait_for()
    again.page.get_by_role("button", name="Undo").click()
    again.shows("peak_power <=", before)
    again.page.get_by_role("button", name="Let pin 1 go").click()
    again.page.locator("#pins-section").wait_for(state="hidden")


@pytest.mark.slow
@pytest.mark.parametrize("colours", ["light", "dark"])
def test_a_phone_has_it_all_in_its_width_and_axe_finds_no_serious_fault(another, colours):
    page = another(viewport={"width": 360, "height": 740}, color_scheme=colours, bypass_csp=True).page
    page.locator("#report[data-report]").wait_for()
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    place = "document.getElementById(id).getBoundingClientRect().top"
    tops = page.evaluate(f"['draft', 'controls', 'limits'].map((id) => {place})")
    assert tops == sorted(tops)  # the module in 3-D is seen first
    page.evaluate("document.getElementById('report').remove()")  # the report has its own test
    assert serious_faults(page) == []


@pytest.mark.slow
def test_a_cut_connection_comes_back_with_the_same_state(explorer, served):
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
def test_the_draft_in_3d_follows_a_slider_that_is_held(explorer):
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
def test_a_point_of_a_front_is_clicked_its_module_seen_and_its_parts_made(browser, tmp_path):
    study = small_study(tmp_path, SMALL.replace(WANTED, FRONT))
    run(study, tmp_path / "run")
    with serving(browser, tmp_path / "run", tmp_path / "out") as explorer:
        page = explorer.page
        points = page.locator("#front svg path[d^='M1 0A']")
        points.first.wait_for(state="attached")
        page.get_by_text("Points, as buttons").click()
        names = page.locator("#front details button")
        assert (names.count(), points.count()) == (3, 2)  # the knee is a diamond
        before = explorer.number
        points.last.click(force=True)
        page.get_by_text("Variables", exact=True).wait_for()
        explorer.answered(before, "exact")
        page.get_by_role("button", name="Make CAD").click()
        page.locator("#report #assembly").wait_for()
        figure = page.locator("#figure-solids")
        figure.scroll_into_view_if_needed()
        page.wait_for_selector("#figure-solids[data-state=drawn]")
