"""Sections put into a page that is there, and the last line of tests where there is no browser."""

import sys

import pytest
from support import ROOT, environment, run_process

from tvimdesign.page.blocks import Page, Points, Section, Words
from tvimdesign.page.page_file import page_html, with_section

PAGE = Page(
    "Elbow", "shear module", "OPTIMAL", "good", [Points(["first"])], None,
    [Section("cycle", "Cycle", [Words(["a cycle"])]), Section("study", "Study", [Words(["a study"])])], "made", {},
)  # fmt: skip


def written(*sections: Section) -> str:
    return page_html(PAGE if not sections else Page(**{**PAGE.__dict__, "sections": list(sections)})).decode()


def test_a_page_with_a_section_put_in_is_the_page_written_with_it() -> None:
    late = Section("verification", "Finite elements", [Words(["a < b"])])
    cycle, study = PAGE.sections
    assert with_section(written(), late, "study") == written(cycle, late, study)


def test_the_section_of_before_goes() -> None:
    first = with_section(written(), Section("verification", "Finite elements", [Words(["told before"])]), "study")
    assert first is not None
    second = with_section(first, Section("verification", "Finite elements", [Words(["told anew"])]), "study")
    assert second is not None
    assert second.count('id="verification"') == second.count('href="#verification"') == 1
    assert "told anew" in second
    assert "told before" not in second


def test_what_is_no_such_page_is_left_alone() -> None:
    assert with_section("<html></html>", PAGE.sections[0], "study") is None


@pytest.mark.slow
def test_the_last_line_says_how_many_tests_no_browser_has_run() -> None:
    words = ["tests/page/test_page_in_a_browser.py", "-q", "-k", "sorts or filtered", "-p", "no:cacheprovider"]
    command = [sys.executable, "-m", "pytest", *words]
    found = run_process(command, cwd=ROOT, env={**environment(), "PATH": ""}, text=True)
    last = found.stdout.rstrip().splitlines()[-1]
    assert last == "NO BROWSER: 2 tests of the pages were not run; install chromium and run them again", found.stdout
