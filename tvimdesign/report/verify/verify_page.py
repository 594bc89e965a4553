"""The page of a verification: what differs most first, then every row, the fields, and what solved them."""

from __future__ import annotations

from collections.abc import Sequence

from tvimdesign.cad.fe.run_solvers import Solved
from tvimdesign.page.blocks import Block, Page, Picture, Points, Section, Tone, Words
from tvimdesign.report.output.page_sections import grid, made_by_words, there, versions_section
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.verify.comparison import Compared
from tvimdesign.report.verify.verify_tables import HEADS, SOLVED, SOLVER_HEADS, cells, far, solver_rows, summary

_FILES = {
    "verify.md": "all of this as text",
    "verify.csv": "the rows",
    "verify.json": "rows and what each solver found",
}
_SHOWS = {
    "joint": "Stress in the frozen joint, bent by the torque on its core",
    "heat": "Temperature of half an arc or half a vane when the polymer's mean is as warm as asked",
    "spring": "Stress in one spring under the pin's force on its leg",
    "screws": "Stress in link and core under the tightened link screws",
    "link": "Stress in the link under a force in its tool hole",
}


def verify_page(folder: ResultsFolder, name: str, rows: Sequence[Compared], solved: dict[str, Solved]) -> Page:
    """The page; pictures are those that the folder has."""
    beyond = len(far(rows))
    said = "ALL WITHIN 10 %" if not beyond else f"{beyond} OF {len(rows)} BEYOND 10 %"
    first: list[Block] = [Points([summary(rows)])]
    table = grid("The model against finite elements", HEADS, [cells(row) for row in rows], right=(1, 2, 4, 5))
    fields: list[Block] = [
        Picture((folder.path / f"{key}.png").read_bytes(), _SHOWS[key], _SHOWS[key])
        for key in solved
        if (folder.path / f"{key}.png").exists()
    ]
    by: list[Block] = [
        Words([" ".join(SOLVED.split())]),
        grid("Solvers", SOLVER_HEADS, solver_rows(solved), right=(1, 2, 3)),
    ]
    sections = [
        Section("rows", "Model and finite elements", [table]),
        *([Section("fields", "Fields", fields)] if fields else []),
        Section("solved", "How it was solved", by),
        versions_section(folder),
    ]
    tone: Tone = "warn" if beyond else "good"
    files = there(folder, _FILES)
    return Page(name, "verification", said, tone, first, None, sections, made_by_words(folder), files)
