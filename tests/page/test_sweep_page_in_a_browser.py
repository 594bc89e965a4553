"""The page of a sweep in a browser: it is drawn offline, and a brush keeps cells in the table too."""

from collections.abc import Callable
from pathlib import Path

from opened_page import Opened
from small_sweeps import plan

from tvimdesign.page.page_file import FILE
from tvimdesign.report.output.command import Command
from tvimdesign.report.sweep.sweep_page import sweep_page
from tvimdesign.sweep.gather import columns
from tvimdesign.sweep.swept_cells import CellTable

STUDY = """
mode: shear
sweep: {over: {pcl_thickness: [0.6 mm, 1 mm, 2 mm], current: [1 A, 1.2 A]}}
"""


def test_a_sweep_is_drawn_and_its_cells_are_brushed(opened: Callable[..., Opened], tmp_path: Path) -> None:
    study, out = tmp_path / "study.yaml", tmp_path / "out"
    study.write_text(STUDY)
    asked = plan(study)
    table, outputs = CellTable(asked), sum(column.kind == "output" for column in columns(asked))
    for number in range(6):
        ended = ["refused", None, None, "no"] if number == 0 else ["evaluated", number % 2, 0.1, ""]
        values = [None if number == 0 else float("inf") if number == 1 else 10.0 + number] * outputs
        list(table.seeing([[number + 1, *asked.axis_values(number), *ended, *values]]))
    with Command(out) as command:
        command.finish("swept", {}, {}, page=sweep_page(asked, table, command))
    found = opened(out / FILE)
    found.figure("curves")
    figure = found.figure("brushed")
    rows = found.page.get_by_role("table", name="Cells", exact=True).locator("tbody tr:visible")
    assert rows.count() == 6  # the one without an answer, too
    figure.get_by_text("Ends of the axes, typed").click()
    figure.get_by_role("spinbutton", name="Module mass (g) to").fill("13")
    found.page.keyboard.press("Tab")
    figure.locator(".told", has_text="2 of 5 cells are within").wait_for()
    assert rows.locator("th").all_inner_texts() == ["3", "4"]  # not what never happens
    figure.get_by_role("button", name="Keep all").click()
    assert rows.count() == 6
    assert [url for url in found.requests if not url.startswith(("file:", "data:", "blob:"))] == []
    assert found.complaints == []
