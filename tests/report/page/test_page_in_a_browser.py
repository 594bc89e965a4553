"""The pages of runs and sweeps in a browser."""

import io
import re
from collections.abc import Callable

import numpy as np
import pytest
import sample_pages
from opened_page import Opened, serious_faults
from PIL import Image
from small_sweeps import plan

from tvimdesign.report.output.command import Command
from tvimdesign.report.page.blocks import Cell, Grid, Head, Page, Section
from tvimdesign.report.page.page_file import FILE, MOST, page_html
from tvimdesign.report.sweep.sweep_study import sweep_page
from tvimdesign.sweep.shards import columns
from tvimdesign.sweep.swept_cells import CellTable

pytestmark = pytest.mark.gate
Open = Callable[..., Opened]


FIGURES = ("cycle", "front", "solids")


def test_it_opens_offline_and_complains_of_nothing(screen, report):
    view = screen
    for name in FIGURES:
        view.figure(name)
    assert [url for url in view.requests if not url.startswith(("file:", "data:", "blob:"))] == []
    assert [url for url in view.requests if url.startswith("file:")] == [report.as_uri()]
    assert view.complaints == []
    assert report.stat().st_size < MOST


@pytest.mark.parametrize(("colours", "rules"), [("light", None), ("dark", ["color-contrast"])])
def test_axe_finds_no_serious_fault(opened, report, colours, rules):
    view = opened(report, color_scheme=colours, bypass_csp=True)
    for name in FIGURES:
        view.figure(name)
    view.page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    # Rows of a table are alike, and axe looks at each of thousands of cells.
    alike = (
        "document.querySelectorAll('tbody').forEach(({ rows }) => [...rows].slice(4).forEach((row) => row.remove()))"
    )
    view.page.evaluate(alike)
    assert serious_faults(view.page, **({"runOnly": rules} if rules else {})) == []


def test_a_page_is_dark_where_the_reader_is_without_white_slabs(opened, report):
    def brightness(colours: str) -> int:
        page = opened(report, color_scheme=colours).page
        ground = page.evaluate("getComputedStyle(document.body).backgroundColor")
        return sum(map(int, re.findall(r"\d+", ground)[:3]))

    assert brightness("light") > 700
    assert brightness("dark") < 120
    page = opened(report, color_scheme="dark").page
    page.wait_for_selector("html[data-ready=all]")
    page.get_by_role("heading", name="Assembly steps").click()
    page.add_style_tag(content=".stage canvas, .steps img { visibility: hidden }")  # the sample's parts are white
    assert page.locator(".picture img").count() == 2
    with Image.open(io.BytesIO(page.screenshot(full_page=True))) as picture:
        grey = np.asarray(picture.convert("L").reduce(8))
    assert (grey > 235).mean() < 2e-3


def test_a_page_fits_a_phone_and_is_read_without_its_code(opened, report):
    view = opened(report, viewport={"width": 360, "height": 740})
    for name in FIGURES:
        view.figure(name)
    assert view.page.evaluate("document.documentElement.scrollWidth") <= 360
    page = opened(report, java_script_enabled=False).page
    page.get_by_role("heading", name="Module", exact=True).click()
    assert page.get_by_role("table", name="At the operating points").is_visible()
    assert "needs JavaScript" in page.locator("#figure-cycle").inner_text()


@pytest.mark.parametrize("size", [(1400, 900), (1200, 900), (390, 844)], ids=["desktop", "laptop", "phone"])
def test_the_answer_is_seen_without_scrolling(opened, report, size):
    page = opened(report, viewport={"width": size[0], "height": size[1]}).page
    table = page.get_by_role("table", name="Requirements")
    assert table.locator("tbody tr").count() == len(sample_pages.REQUIREMENTS)
    for seen in (page.locator(".status"), table):
        box = seen.bounding_box()
        assert box
        assert 0 <= box["x"] < box["x"] + box["width"] <= size[0]
        assert 0 <= box["y"] < box["y"] + box["height"] <= size[1]


def test_a_page_is_read_in_minutes_and_links_unfold_the_rest(screen):
    words = "document.body.innerText.split(/\\s+/).length"
    assert screen.page.evaluate(words) < 2500
    assert screen.page.evaluate("document.body.textContent.split(/\\s+/).length") > 10_000
    place = screen.page.locator("#spring details")
    assert place.get_attribute("open") is None
    screen.page.get_by_role("navigation", name="Sections").get_by_role("link", name="Spring sheet").click()
    screen.page.wait_for_selector("#spring details[open]")
    place.locator("summary").click()
    screen.page.evaluate("history.replaceState(null, '', location.pathname)")


@pytest.mark.parametrize("wide", [1400, 1200, 375])  # a phone of 390 less a scroll bar
def test_no_table_is_cut_and_hidden_columns_are_named(opened, report, wide):
    page = opened(report, viewport={"width": wide, "height": 844}).page
    page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    cut = "[...document.querySelectorAll('.grid, .listing')].filter((one) => one.scrollHeight > one.clientHeight + 1)"
    assert page.evaluate(f"{cut}.map((one) => one.ariaLabel)") == []
    table = page.get_by_role("table", name="Requirements")
    table.evaluate("(one) => { one.rows[1].cells[0].innerText = 'friction over spring torque'; }")  # as of an optimum
    table.evaluate("(one) => { [...one.rows[1].cells].at(-1).innerHTML = '<b>0.24 %, active</b>'; }")
    assert table.evaluate("(one) => one.parentElement.scrollWidth - one.parentElement.clientWidth") <= 0
    hidden = table.get_by_role("columnheader", name="plausible range")
    box = page.get_by_role("checkbox", name="Also show: plausible range, depends most on")
    assert hidden.is_visible() == (wide > 1000)
    assert box.is_visible() == (wide < 1000)
    if wide < 1000:
        box.check()
        assert hidden.is_visible()


def test_it_prints_on_a4_with_its_figures(opened, report, tmp_path):
    view = opened(report, color_scheme="dark")
    view.page.wait_for_selector("html[data-ready=all]")
    assert [view.page.locator(f"#figure-{name}").get_attribute("data-state") for name in FIGURES] == ["drawn"] * 3
    printed = view.page.pdf(path=tmp_path / "report.pdf", prefer_css_page_size=True, print_background=True)
    boxes = {tuple(map(float, box.split())) for box in re.findall(rb"/MediaBox\s*\[([^\]]+)\]", printed)}
    assert boxes
    for _, _, wide, high in boxes:
        assert (wide, high) == pytest.approx((595.3, 841.9), abs=1.5)  # A4 in points, ISO 216
    view.page.emulate_media(media="print")
    assert not view.page.get_by_role("navigation", name="Sections").is_visible()
    assert view.page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    cut = "[...document.querySelectorAll('.grid')].filter((one) => one.scrollHeight > one.clientHeight + 1).length"
    assert view.page.evaluate(cut) == 0


def test_tables_are_sorted_and_filtered(screen):
    page = screen.page
    table = page.get_by_role("table", name="Points of the front")
    column = "(one) => [...one.tBodies[0].rows].map((row) => Number(row.cells[1].textContent))"
    head = table.get_by_role("columnheader").nth(1)
    button = head.get_by_role("button")
    button.focus()
    page.keyboard.press("Enter")
    assert head.get_attribute("aria-sort") == "ascending"
    assert table.evaluate(column) == [45.0, 50.0, 60.0, 80.0, 100.0]
    button.click()
    assert table.evaluate(column) == [100.0, 80.0, 60.0, 50.0, 45.0]
    button.click()
    assert head.get_attribute("aria-sort") is None
    assert table.evaluate(column) == [100.0, 80.0, 60.0, 50.0, 45.0]
    page.get_by_role("heading", name="Module", exact=True).click()
    page.get_by_text("inputs and outputs, with their sources").click()
    block = page.locator("details details", has_text="inputs and outputs, with their sources")
    block.get_by_role("searchbox").fill("module_mass")
    rows = block.locator("tbody tr:visible")
    assert 0 < rows.count() < 20
    assert "module_mass" in rows.first.inner_text()


def test_the_cursor_of_time_moves_by_keys_and_tells_what_is_then(screen):
    figure = screen.figure("cycle")
    assert "softening at 0 s" in figure.locator(".told").inner_text()
    time = figure.get_by_role("slider", name="Time")
    time.focus()
    figure.page.keyboard.press("End")
    assert "stiffening at" in figure.locator(".told").inner_text()
    assert time.get_attribute("aria-valuetext") == figure.locator(".told").inner_text()


def test_a_brush_keeps_the_designs_within(screen):
    view = screen
    figure = view.figure("front")
    axes = figure.locator("[role=img]").nth(1)
    axes.scroll_into_view_if_needed()
    box = axes.bounding_box()
    assert box
    # The first axis stands 60 px from the left, from 76 px below the top down to 24 px above the bottom.
    left, top, high = box["x"] + 60, box["y"] + 76, box["height"] - 100
    mouse = view.page.mouse
    mouse.move(left, top + 0.5 * high)
    mouse.down()
    mouse.move(left, top + 0.2 * high, steps=4)
    mouse.move(left, top - 8, steps=4)
    mouse.up()
    rows = view.page.get_by_role("table", name="Points of the front").locator("tbody tr:visible")
    figure.locator(".told", has_text="of 5 designs are within").wait_for()
    assert rows.count() == 2
    figure.get_by_role("button", name="Keep all").click()
    assert rows.count() == 5
    figure.get_by_text("Ends of the axes, typed").click()
    figure.get_by_role("spinbutton", name="Module mass (g) to").fill("75")
    view.page.keyboard.press("Tab")
    assert rows.count() == 2


def test_files_of_parts_are_saved_from_a_page_that_came_alone_in_a_mail(opened, tmp_path):
    data = b"ISO-10303-21;\r\n" + bytes(range(256))
    links = Cell("STEP 3MF", links=[("STEP", "cad/step/housing.step"), ("3MF", "cad/print/housing.3mf")])
    sections = [Section("materials", "Bill of materials", [Grid("Parts", [Head("files")], [[links]])])]
    page = Page("A module", "shear module", "OPTIMAL", "good", [], None, sections, "Written by a test.",
                carried={"cad/step/housing.step": data, "cad/print/housing.3mf": b"PK"})  # fmt: skip
    alone = tmp_path / "report.html"
    alone.write_bytes(page_html(page))
    view = opened(alone)
    view.page.wait_for_selector("html[data-ready]")  # until then a link leads to the folder beside the page
    for ending, held in (("STEP", data), ("3MF", b"PK")):
        with view.page.expect_download() as saved:
            view.page.get_by_role("link", name=ending).press("Enter")
        assert saved.value.suggested_filename == f"housing.{ending.lower()}"
        assert saved.value.path().read_bytes() == held
    assert view.complaints == []
    assert view.page.url == alone.as_uri()


def test_the_page_of_a_run_carries_the_files_of_its_parts(report):
    carried = re.findall(r'data-file="([^"]+)"', report.read_text("utf-8"))
    assert carried[0] == "cad/step/housing.step"
    assert "cad/step/pcl_arc_1.step" in carried
    assert carried[-1] == "cad/print/housing.3mf"


STUDY = """
mode: shear
sweep: {over: {pcl_thickness: [0.6 mm, 1 mm, 2 mm], current: [1 A, 1.2 A]}}
"""


def test_a_sweep_is_drawn_and_its_cells_are_brushed(opened, tmp_path):
    study, out = tmp_path / "study.yaml", tmp_path / "out"
    study.write_text(STUDY)
    sweep_plan = plan(study)
    table, outputs = CellTable(sweep_plan), sum(column.kind == "output" for column in columns(sweep_plan))
    for number in range(6):
        ended = ["refused", None, None, "no"] if number == 0 else ["evaluated", number % 2, 0.1, ""]
        values = [None if number == 0 else float("inf") if number == 1 else 10.0 + number] * outputs
        list(table.seeing([[number + 1, *sweep_plan.axis_values(number), *ended, *values]]))
    with Command(out) as command:
        command.finish("swept", {}, {}, page=sweep_page(table, command))
    view = opened(out / FILE)
    view.figure("curves")
    figure = view.figure("brushed")
    rows = view.page.get_by_role("table", name="Cells", exact=True).locator("tbody tr:visible")
    assert rows.count() == 6  # the one without an answer, too
    figure.get_by_text("Ends of the axes, typed").click()
    figure.get_by_role("spinbutton", name="Module mass (g) to").fill("13")
    view.page.keyboard.press("Tab")
    figure.locator(".told", has_text="2 of 5 cells are within").wait_for()
    assert rows.locator("th").all_inner_texts() == ["3", "4"]  # not what never happens
    figure.get_by_role("button", name="Keep all").click()
    assert rows.count() == 6
    marked = view.page.locator("tr[aria-current=true] th")
    assert marked.count() == 0
    figure.locator("svg path[d^='M1 0A']").last.click(force=True)
    assert marked.all_inner_texts() == ["6"]
    assert [url for url in view.requests if not url.startswith(("file:", "data:", "blob:"))] == []
    assert view.complaints == []
