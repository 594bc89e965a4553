"""Shared parts of all commands' pages: grids from rows of text, the study's file, versions, and writing a page."""

import math
import re
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.report.output.numbers import number
from tvimdesign.report.page.blocks import Cell, Facts, Grid, Head, Listing, Page, Section, Tone, Words
from tvimdesign.report.page.page_file import FILE, page_html

NEVER = 1e300  # Number that `never` is sorted by
_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?", re.IGNORECASE)
_TONES: tuple[tuple[Tone, re.Pattern[str]], ...] = (
    ("bad", re.compile(r"\bviolated\b|\bfailure\b|\bworse\b")),
    ("warn", re.compile(r"\bactive\b|\bopen\b|\bwarning\b|partly done")),
    ("good", re.compile(r"^ok$|^pass$|\bbetter\b")),
)
"""Words that say how something stands, worst first."""


def tone_of(text: str) -> Tone:
    """Return what a word that says how something stands means."""
    return next((tone for tone, pattern in _TONES if pattern.search(text)), "")


def grid(
    caption: str, heads: Sequence[str], rows: Sequence[Sequence[str]], *, right: Collection[int] = (),
    code: Collection[int] = (0,), toned: Collection[int] = (), note: str = "",
) -> Grid:  # fmt: skip
    """Return a grid from rows of text.

    Columns of `right` are numbers, of `code` names of the study; those of `toned` say how something stands.
    """
    cells = [
        [
            Cell(text, sort_key(text) if i in right else None, tone_of(text) if i in toned else "", i in code)
            for i, text in enumerate(row)
        ]
        for row in rows
    ]
    named = [text or ("name" if i in code else "state" if i in toned else "") for i, text in enumerate(heads)]
    return Grid(caption, [Head(text, i in right) for i, text in enumerate(named)], cells, note)


def number_cell(value: float | None, digits: int = 4) -> Cell:
    """Return a number as a cell; what never happens is sorted beyond all others."""
    beyond = value is None or not math.isfinite(value)
    return Cell(number(value, digits), math.copysign(NEVER, value or 1.0) if beyond else value)


def sort_key(text: str) -> float | None:
    """Return the number a text begins with; of `never` one beyond all others."""
    if text == "never":
        return NEVER
    match = _NUMBER.match(text.replace("−", "-"))
    return float(match[0]) if match else None


def study_section(text: str) -> Section:
    """Return the study's own file."""
    return Section("study", "Study", [Listing("The study's file", text)])


def versions_section(folder: ResultsFolder) -> Section:
    """Return what made the page: versions and commit."""
    made_by = folder.made_by
    libraries = ", ".join(f"{name} {version}" for name, version in made_by["libraries"].items() if version)
    rows = [
        ("tvimdesign", f"{made_by['tvimdesign']}{commit_words(made_by)}"),
        ("Python", f"{made_by['python']} on {made_by['platform']}"),
        ("Libraries", libraries),
    ]
    words = Words(["`manifest.json` beside this page has hashes of everything that went in and came out."])
    return Section("versions", "Versions", [Facts(rows), words])


def commit_words(made_by: Mapping[str, Any]) -> str:
    """Return the commit in short, where the program runs from a source tree."""
    return f", commit {made_by['commit'][:12]}" if made_by["commit"] else ""


def made_by_words(folder: ResultsFolder) -> str:
    """Return the page's last line."""
    return f"Written by tvimdesign {folder.made_by['tvimdesign']}{commit_words(folder.made_by)}."


def there(folder: ResultsFolder, files: Mapping[str, str]) -> dict[str, str]:
    """Return those of some files that the folder has."""
    return {name: says for name, says in files.items() if (folder.path / name).exists()}


def write_page(folder: ResultsFolder, page: Page) -> None:
    """Write report.html."""
    folder.write(FILE, page_html(page))
