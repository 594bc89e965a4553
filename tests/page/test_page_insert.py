"""Sections put into a page that is there, and the last line of tests where there is no browser."""

from tvimdesign.page.blocks import Page, Points, Section, Words
from tvimdesign.page.page_file import page_html, with_section

PAGE = Page(
    "Elbow", "shear module", "OPTIMAL", "good", [Points(["first"])], None,
    [Section("cycle", "Cycle", [Words(["a cycle"])]), Section("study", "Study", [Words(["a study"])])], "made", {},
)  # fmt: skip


def written(*sections: Section) -> str:
    return page_html(PAGE if not sections else Page(**{**PAGE.__dict__, "sections": list(sections)})).decode()


def test_a_section_is_put_in_once_and_only_into_a_page() -> None:
    late = Section("verification", "Finite elements", [Words(["a < b"])])
    cycle, study = PAGE.sections
    assert with_section(written(), late, "study") == written(cycle, late, study)
    first = with_section(written(), Section("verification", "Finite elements", [Words(["told before"])]), "study")
    assert first is not None
    second = with_section(first, Section("verification", "Finite elements", [Words(["told anew"])]), "study")
    assert second is not None
    assert second.count('id="verification"') == second.count('href="#verification"') == 1
    assert "told anew" in second
    assert "told before" not in second
    assert with_section("<html></html>", PAGE.sections[0], "study") is None
