"""The file itself: valid HTML, the same bytes every time, no text that escapes, no library that nothing uses."""

import base64
import gzip
import hashlib
import json
import random
import re
from dataclasses import replace

import html5lib
import pytest
import yaml
from support import ROOT

from tvimdesign.report.page.blocks import Cell, Drawn, Facts, Folded, Grid, Head, Page, Section, Words
from tvimdesign.report.page.page_file import MOST, page_html

NASTY = '</script><script>alert(1)</script> & "it\'s"'
PAGE = Page(
    "A module", "shear module", "OPTIMAL", "good", [Facts([("Weighs", "98 g")])], None,
    [Section("one", "One", [Words([NASTY])])], "Written by a test.",
)  # fmt: skip
VENDOR = ROOT / "tvimdesign/report/page/static/vendor"


@pytest.mark.gate
def test_the_page_of_a_run_is_valid_html(report):
    html5lib.HTMLParser(strict=True).parse(report.read_text("utf-8"))
    names = re.findall(r'\bid="([^"]+)"', report.read_text("utf-8"))
    assert len(names) == len(set(names))
    assert {"first", "module", "assembly", "cycle", "why", "assumptions", "front", "checks", "materials", "steps",
            "spring", "study", "versions"} <= set(names)  # fmt: skip


def test_a_page_is_the_same_bytes_its_text_text_and_its_numbers_numbers():
    drawn = Drawn("nasty", "lines.js", NASTY, {"panels": [], "text": NASTY})
    cells = Grid(NASTY, [Head(NASTY)], [[Cell(NASTY)]])
    page = replace(PAGE, title=NASTY, sections=[Section("one", NASTY, [drawn, Folded(NASTY, [cells])])])
    text = page_html(page).decode()
    assert "<script>alert" not in text
    html5lib.HTMLParser(strict=True).parse(text)
    with_meshes = replace(PAGE, first=[Drawn("solids", "solids/viewer.js", "A box", {}, b"meshes", ["three"])])
    assert page_html(with_meshes) == page_html(with_meshes)
    with pytest.raises(ValueError, match="JSON"):
        page_html(replace(PAGE, first=[Drawn("lines", "lines.js", "Lines", {"x": [float("nan")]})]))


def test_a_library_is_there_only_where_a_figure_needs_it():
    plain = page_html(PAGE)
    curves = page_html(replace(PAGE, first=[Drawn("lines", "lines.js", "Lines", {"panels": []}, b"", ["echarts"])]))
    assert not any("vendor/" in name for name in _code(plain))
    assert len(plain) < 100_000
    assert "page/vendor/echarts.js" in _code(curves)
    assert "page/vendor/three.js" not in _code(curves)


def _code(page: bytes) -> dict[str, str]:
    """Unpack the code that a page carries."""
    packed = re.search(rb'id="page-code">([^<]+)<', page)
    assert packed
    code: dict[str, str] = json.loads(gzip.decompress(base64.b64decode(packed[1])))
    return code


def test_a_page_carries_files_in_their_order_as_far_as_it_has_room():
    large, noise = bytes(1000), random.Random(1).randbytes(3_000_000)
    page = page_html(replace(PAGE, carried={"cad/a.step": large, "cad/b.3mf": noise, "cad/c.pdf": large}))
    assert re.findall(rb'data-file="([^"]+)"', page) == [b"cad/a.step", b"cad/c.pdf"]
    assert len(page) < MOST
    html5lib.HTMLParser(strict=True).parse(page.decode())


def test_the_libraries_are_those_that_are_pinned():
    pinned = yaml.safe_load((ROOT / "vendor/packages.yaml").read_text("utf-8"))
    for bundle, names in pinned["bundles"].items():
        code, licence = (VENDOR / f"{bundle}.js").read_bytes(), (VENDOR / f"{bundle}.LICENSE.txt").read_text("utf-8")
        assert hashlib.sha256(code).hexdigest() == pinned["made"][bundle], "run `make vendor`"
        for name in names:
            package = pinned["packages"][name]
            assert f"{name} {package['version']}, {package['licence']}" in licence
        assert licence.splitlines()[0] in code.decode()
