"""The page of a tolerance analysis: what varies from part to part and, apart from it, what nobody knows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tvimdesign.device import Table
from tvimdesign.page.blocks import Block, Folded, Page, Picture, Points, Section
from tvimdesign.report.output.page_sections import grid, made_by_words, study_section, there, versions_section
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.tables import number
from tvimdesign.report.tolerate.tolerance_screen import (
    concern_table,
    robustness_table,
    spread_table,
    unknown_table,
)
from tvimdesign.solve.uncertainty.tolerance import Spread

_FILES = {
    "outputs.csv": "spread of every output", "limits.csv": "yield of every limit",
    "contributors.csv": "who contributes", "not_known.csv": "what nobody knows",
}  # fmt: skip
_FIGURE = "spread.png"


def tolerance_page(
    folder: ResultsFolder, name: str, found: Spread, data: Mapping[str, Any], table: Table, study: str
) -> Page:
    """The page of one module's tolerances; `data` is that of tolerances.json."""
    share = data["yield"]
    low, high = (f"{100.0 * share[end]:.3g}" for end in ("low", "high"))
    said = f"{100.0 * share['share']:.3g} % OF MODULES KEEP ALL LIMITS ({low} to {high})"
    varies: list[Block] = [spread_table(found, data)]
    varies += [one for one in (concern_table(found, table), robustness_table(data)) if one.rows]
    picture = folder.path / _FIGURE
    if picture.exists():
        says = "Who contributes how much to each output's spread, and how modules drawn at random spread"
        varies.append(Picture(picture.read_bytes(), says, says))
    varies.append(Folded("Every limit and who contributes", [_limits(data), _contributors(data)]))
    unknown = unknown_table(data["not_known"])
    sections = [
        Section("parts", "From part to part", varies),
        *([Section("assumptions", "What nobody knows", [unknown])] if unknown.rows else []),
        study_section(study),
        versions_section(folder),
    ]
    first = [Points(data["sentences"]), Points(data["notes"])]
    return Page(name, "tolerances", said, "", first, None, sections, made_by_words(folder), there(folder, _FILES))


def _limits(data: Mapping[str, Any]) -> Block:
    rows = [
        (one["limit"], f"{100.0 * one['yield']:.4g} %", "" if one["cpk"] is None else f"{one['cpk']:.3g}",
         one["origin"])
        for one in data["limits"]
    ]  # fmt: skip
    return grid("Limits", ("limit", "yield", "C_pk", "because"), rows, right=(1, 2))


def _contributors(data: Mapping[str, Any]) -> Block:
    rows = [
        (one["output"], one["contributor"], f"± {number(one['plus_minus'])} {one['unit']}".rstrip(),
         one["distribution"], one["status"], one["source"])
        for one in data["contributors"]
    ]  # fmt: skip
    heads = ("output", "contributor", "tolerance", "distribution", "status", "source")
    return grid("Contributors", heads, rows, code=(0, 1))
