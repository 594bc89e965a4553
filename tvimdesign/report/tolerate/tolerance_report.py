"""A tolerance analysis on the terminal and as a page: what varies from part to part, then unmeasured inputs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rich.console import Console
from rich.markup import escape

from tvimdesign.device import Table
from tvimdesign.page.blocks import Block, Folded, Grid, Page, Picture, Points, Section
from tvimdesign.report.output.page_sections import grid, made_by_words, study_section, there, versions_section
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.tables import number
from tvimdesign.report.output.terminal import print_grid
from tvimdesign.report.tolerate.tolerance_data import spreads, unknown_rows
from tvimdesign.report.tolerate.words import of_concern
from tvimdesign.solve.nlp.constraints import in_words
from tvimdesign.solve.uncertainty.tolerance import Spread


def print_tolerances(spread: Spread, data: Mapping[str, Any], table: Table, console: Console) -> None:
    """Print what varies from part to part, and what is to be said of both blocks."""
    for note in data["notes"]:
        console.print(f"[dim]{escape(note)}[/dim]")
    for shown in (spread_table(spread, data), concern_table(spread, table), robustness_table(data)):
        print_grid(shown, console)
    for sentence in data["sentences"]:
        console.print(escape(sentence))
    print_grid(unknown_table(data["not_known"]), console)


def spread_table(spread: Spread, data: Mapping[str, Any]) -> Grid:
    """Return what is asked or minimised and spreads: by worst case, root-sum-square and modules drawn at random."""
    heads = ("", "as drawn", "worst case", "rss sd", "mc mean", "mc sd", "99.73 %", "unit", "most by")
    rows = [
        (row["output"], _shown(row["as_drawn"]), _span(row["worst_low"], row["worst_high"]),
         _shown(row["deviation_rss"]), _shown(row["mean"]), _shown(row["deviation"]),
         _span(row["low"], row["high"]), row["unit"], _most_by(spread, i))
        for i, row in enumerate(data["outputs"])
        if row["output"] in spread.asked and spreads(spread, i)
    ]  # fmt: skip
    return grid("What spreads from part to part", heads, rows, right=range(1, 7), code=(0, 8))


def concern_table(spread: Spread, table: Table) -> Grid:
    """Tabulate limits that too many modules violate, and what carries their spread."""
    rows = [
        (in_words(limit.limit, table), f"{100.0 * limit.share.share:.4g} %", f"{limit.capability:.2f}",
         _most_by(spread, spread.outputs.index(limit.limit.output)))
        for limit in of_concern(spread)
    ]  # fmt: skip
    return grid("Limits that too many modules break", ("", "yield", "C_pk", "most by"), rows, right=(1, 2))


def robustness_table(data: Mapping[str, Any]) -> Grid:
    """Tabulate minimised outputs without and with the robustness that a study asks for."""
    rows = [
        (row["output"], number(row["nominal"]), number(row["robust"]), row["unit"])
        for row in data.get("cost_of_robustness", ())
    ]
    return grid("What robustness costs", ("", "nominal optimum", "robust optimum", "unit"), rows, right=(1, 2))


def _most_by(spread: Spread, i: int) -> str:
    """Return the contributor that carries most of an output's spread, with its share."""
    most = int(spread.shares[i].argmax())
    return f"{spread.contributors[most].name} {100.0 * spread.shares[i, most]:.0f} %"


def unknown_table(data: Mapping[str, Any]) -> Grid:
    """Return the intervals of outputs over the ranges of unmeasured inputs."""
    rows = []
    for row in unknown_rows(data):
        if row["low"] == row["high"]:
            continue
        alone = _span(row["one_at_a_time_low"], row["one_at_a_time_high"])
        first = f"{row['measure_first']} {100.0 * float(row['share'] or 0.0):.0f} %" if row["measure_first"] else ""
        cells = (str(row["output"]), _shown(row["as_drawn"]), alone, _span(row["low"], row["high"]))
        rows.append((*cells, str(row["unit"]), first))
    heads = ("", "as drawn", "one at a time", "all together, 95 %", "unit", "measure first")
    return grid("Unmeasured inputs", heads, rows, right=(1, 2, 3), code=(0, 5))


def _shown(value: float | None) -> str:
    return "never" if value is None else number(value)


def _span(low: float | None, high: float | None) -> str:
    return f"{_shown(low)} to {_shown(high)}"


_FILES = {
    "outputs.csv": "spread of every output", "limits.csv": "yield of every limit",
    "contributors.csv": "who contributes", "not_known.csv": "unmeasured inputs",
}  # fmt: skip
_FIGURE = "spread.png"


def tolerance_page(
    folder: ResultsFolder, name: str, spread: Spread, data: Mapping[str, Any], table: Table, study: str
) -> Page:
    """Return the page of one module's tolerances; `data` is that of tolerances.json."""
    share = data["yield"]
    low, high = (f"{100.0 * share[end]:.3g}" for end in ("low", "high"))
    verdict = f"{100.0 * share['share']:.3g} % OF MODULES SATISFY ALL LIMITS ({low} to {high})"
    varies: list[Block] = [spread_table(spread, data)]
    varies += [
        shown_table for shown_table in (concern_table(spread, table), robustness_table(data)) if shown_table.rows
    ]
    picture = folder.path / _FIGURE
    if picture.exists():
        says = "Who contributes how much to each output's spread, and how modules drawn at random spread"
        varies.append(Picture(picture.read_bytes(), says, says))
    varies.append(Folded("Every limit and who contributes", [_limits(data), _contributors(data)]))
    unknown = unknown_table(data["not_known"])
    sections = [
        Section("parts", "From part to part", varies),
        *([Section("assumptions", "Unmeasured inputs", [unknown])] if unknown.rows else []),
        study_section(study),
        versions_section(folder),
    ]
    first = [Points(data["sentences"]), Points(data["notes"])]
    return Page(name, "tolerances", verdict, "", first, None, sections, made_by_words(folder), there(folder, _FILES))


def _limits(data: Mapping[str, Any]) -> Block:
    rows = [
        (limit["limit"], f"{100.0 * limit['yield']:.4g} %", "" if limit["cpk"] is None else f"{limit['cpk']:.3g}",
         limit["origin"])
        for limit in data["limits"]
    ]  # fmt: skip
    return grid("Limits", ("limit", "yield", "C_pk", "because"), rows, right=(1, 2))


def _contributors(data: Mapping[str, Any]) -> Block:
    rows = [
        (entry["output"], entry["contributor"], f"± {number(entry['plus_minus'])} {entry['unit']}".rstrip(),
         entry["distribution"], entry["status"], entry["source"])
        for entry in data["contributors"]
    ]  # fmt: skip
    heads = ("output", "contributor", "tolerance", "distribution", "status", "source")
    return grid("Contributors", heads, rows, code=(0, 1))
