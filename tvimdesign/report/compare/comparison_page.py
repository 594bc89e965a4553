"""The page of a comparison: what follows first, then the studies side by side, their fronts and curves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tvimdesign.page.blocks import Block, Drawn, Folded, Listing, Page, Points, Section, Warned, Words
from tvimdesign.report.compare.comparison import COMPARISONS, Outcome
from tvimdesign.report.compare.comparison_plot_data import drawings
from tvimdesign.report.compare.comparison_summary import side_by_side, told_rows, warnings_of
from tvimdesign.report.output.page_sections import made_by_words, there, tone_of, versions_section
from tvimdesign.report.output.results_folder import ResultsFolder

_FILES = {"summary.txt": "all of this as text", "compare.csv": "every output", "fronts.csv": "the fronts"}
_LINES = {
    "fronts": "The fronts: each point is a whole design.",
    "release": "The link of each module released from the same angle.",
}
"""Figures of lines, with what they show."""


def comparison_page(folder: ResultsFolder, outcome: Outcome, texts: Mapping[str, str]) -> Page:
    """Return the page of compared studies; `texts` are the studies' files."""
    troubles = outcome.failures
    said = "PARTLY DONE" if troubles else f"COMPARED {COMPARISONS[outcome.which].upper()}"
    warnings = [(text, "") for text in warnings_of(outcome)]
    lead, *rest = outcome.conclusions
    first: list[Block] = [Words([lead]), *([Warned(warnings)] if warnings else [])]
    follows = [Section("follows", "What follows", [Points(rest)])] if rest else []
    sections = [*follows, _side_by_side(outcome), *_figures(outcome)]
    sections += [Section("not-done", "Not done", [Points(troubles)])] if troubles else []
    sections += [_studies(texts), versions_section(folder)]
    title = " against ".join(one.study.name for one in outcome.entrants.values())
    return Page(
        title, "comparison", said, tone_of(said), first, None, sections, made_by_words(folder), there(folder, _FILES)
    )


def _side_by_side(outcome: Outcome) -> Section:
    """Headlines and what is asked; then everything that all studies have."""
    told = told_rows(outcome)
    every = [side_by_side(COMPARISONS[which], rows) for which, rows in outcome.rows.items()]
    blocks: list[Block] = [*told, *([Folded("Every output that all studies have", every)] if every else [])]
    return Section("side-by-side", "Side by side", blocks)


def _figures(outcome: Outcome) -> list[Section]:
    """Fronts and curves, where there are any."""
    drawn: list[Block] = [
        Drawn(one.file, "lines.js", _LINES[one.file], _panels(one.data), libraries=["echarts"])
        for one in drawings(outcome)
        if one.file in _LINES
    ]
    return [Section("curves", "Fronts and curves", drawn)] if drawn else []


def _panels(data: dict[str, Any]) -> dict[str, Any]:
    """Panels as the page draws them: a front's points are marked."""
    return {
        "panels": [
            {**panel, "lines": [{**line, "points": "optimum" in line} for line in panel["lines"]]}
            for panel in data["panels"]
        ]
    }


def _studies(texts: Mapping[str, str]) -> Section:
    listed = [Folded(label, [Listing(f"Study of {label}", text)]) for label, text in texts.items()]
    return Section("study", "Studies", listed)
