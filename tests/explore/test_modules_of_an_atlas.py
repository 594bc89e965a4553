"""Modules of an atlas in the explorer: a click on a point shows its module in 3-D."""

import json
from pathlib import Path

import pytest
from explored import SMALL
from served_explorer import serving

from tvimdesign.base.errors import InputError
from tvimdesign.explore.source import open_source
from tvimdesign.explore.state import tree_of
from tvimdesign.report.sweep.atlas_page import STUDIES, SUMMARY, rows_of
from tvimdesign.study import read_study_text, read_tree
from tvimdesign.sweep.atlas import OUTPUTS, AtlasCell

WAX = SMALL.replace("module: {", "module: {pcl_grade: paraffin_rt60, ")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return the folder of an atlas with two modules and an empty cell between them."""
    values = dict.fromkeys(OUTPUTS, 1.0)
    cells = [
        AtlasCell(kind, 5.0, cycle, status, "middle", values, (), {})
        for kind, cycle, status in (("foil", 60.0, "optimal"), ("foil", 3.0, "empty"), ("wax", 60.0, "optimal"))
    ]
    (tmp_path / STUDIES).mkdir()
    (tmp_path / SUMMARY).write_text(json.dumps({"rows": rows_of(cells)}))
    for kind, text in (("foil", SMALL), ("wax", WAX)):
        (tmp_path / STUDIES / f"{kind}-5Nm-60s.yaml").write_text(text)
    return tmp_path


def test_each_point_is_the_study_of_its_cell(folder):
    source = open_source(folder)
    assert [(point["number"], point["status"]) for point in source.points_shown()["points"]] == [
        (1, "foil"),
        (2, "wax"),
    ]
    shown = read_tree(tree_of(source.tree, source.at_point(2, source.first), "optimize"))
    alone = read_study_text(WAX)
    assert shown.model_dump() == {**alone.model_dump(), "name": shown.name}
    with pytest.raises(InputError, match="module 3: the atlas has the modules 1 to 2"):
        source.at_point(3, source.first)


def test_what_holds_no_module_of_its_mode_is_refused(folder):
    source = open_source(folder)
    (folder / STUDIES / "wax-5Nm-60s.yaml").write_text("mode: compression")
    with pytest.raises(InputError, match="module 2: it is of another mode; explore"):
        source.at_point(2, source.first)
    (folder / SUMMARY).write_text('{"rows": []}')
    with pytest.raises(InputError, match="no modules of `tvimdesign atlas` can be read"):
        open_source(folder)


@pytest.mark.slow
def test_a_clicked_module_is_seen_in_3_d(browser, folder, tmp_path):
    with serving(browser, folder, tmp_path / "out") as explorer:
        points = explorer.page.locator("#front svg path[d^='M1 0A']")
        points.first.wait_for(state="attached")
        assert points.count() == 2
        before = explorer.number
        points.last.click(force=True)
        explorer.answered(before)
        explorer.until("(after) => Number(document.getElementById('draft').dataset.draft) > after", before)
        assert explorer.page.evaluate("document.getElementById('draft').viewer.parts.size") > 10
        assert explorer.page.get_by_text("paraffin_rt60").count()
