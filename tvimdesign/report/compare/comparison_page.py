"""The page of a comparison, and what its figures are drawn from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tvimdesign.base.units import from_si
from tvimdesign.page.blocks import Block, Drawn, Folded, Listing, Page, Points, Section, Warned, Words
from tvimdesign.report.compare.comparison import COMPARISONS, Outcome
from tvimdesign.report.compare.comparison_summary import reported_rows, side_by_side, warnings_of
from tvimdesign.report.figures.plot_process import Drawing
from tvimdesign.report.output.axis_labels import axis_label
from tvimdesign.report.output.page_sections import made_by_words, there, tone_of, versions_section
from tvimdesign.report.output.results_folder import ResultsFolder

_STILL = 1e-3
"""Share of its angle by which a released link has moved where its curve begins: the axis of time is logarithmic."""


def drawings(outcome: Outcome) -> list[Drawing]:
    """Return every picture there is something for."""
    figures = []
    if outcome.fronts:
        figures.append(Drawing("fronts", "comparison_figures.fronts", _fronts(outcome)))
    if any(outcome.which in answer["release"] for answer in outcome.found.values()):
        figures.append(Drawing("release", "virtual_test_figures.trial", _release(outcome)))
    if any(outcome.which in answer["heat"] for answer in outcome.found.values()):
        figures.append(Drawing("heat", "comparison_figures.heat", _heat(outcome)))
    return figures


def _title(outcome: Outcome, of: str) -> str:
    return f"{of}, {COMPARISONS[outcome.which]}"


def _fronts(outcome: Outcome) -> dict[str, Any]:
    panels = []
    for (first, second), fronts in outcome.fronts.items():
        units = {name: outcome.unit(name) for name in (first, second)}

        def shown(name: str, values: Any, units: dict[str, str] = units) -> float:
            return from_si(values[name], units[name])

        lines = []
        for label, front in fronts.items():
            points = sorted((shown(second, p["values"]), shown(first, p["values"])) for p in front["points"])
            optimum = outcome.designs["optimised"][label].values
            lines.append({
                "label": label, "x": [x for x, _ in points], "y": [y for _, y in points],
                "optimum": [[shown(second, optimum)], [shown(first, optimum)]],
            })  # fmt: skip
        axes = {f"{axis}_label": axis_label(name, units[name]) for axis, name in (("x", second), ("y", first))}
        panels.append({"lines": lines, **axes})
    return {"title": "Fronts; filled: each study's optimum", "panels": panels}


def _release(outcome: Outcome) -> dict[str, Any]:
    """Return a panel for each operating point, a colour for each study."""
    panels: dict[str, dict[str, Any]] = {}
    for label, answer in outcome.found.items():
        release = answer["release"].get(outcome.which, {})
        for line in release.get("lines", ()):
            point, _, remainder = line["label"].partition(", ")
            temperature, _, history = remainder.partition(", ")
            panel = panels.setdefault(point, {
                "title": f"{point}, {temperature}", "x_label": release["x_label"],
                "y_label": release["y_label"], "log_x": True, "log_y": False, "lines": [],
            })  # fmt: skip
            panel["lines"].append({**line, "label": f"{label}, {history}" if history else label})
    for panel in panels.values():
        panel["lines"] = _from_where_it_moves(panel["lines"])
    return {"title": _title(outcome, "Released from the same angle"), "panels": list(panels.values())}


def _from_where_it_moves(lines: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Cut lines of a panel to the time from which the first of them has left where it began by a thousandth."""
    start = min(_begins_to_move(line["x"], line["y"]) for line in lines)
    moved = []
    for line in lines:
        later = [pair for pair in zip(line["x"], line["y"], strict=True) if pair[0] >= start]
        moved.append({**line, "x": [x for x, _ in later], "y": [y for _, y in later]})
    return moved


def _begins_to_move(times: list[float], angles: list[float]) -> float:
    still = _STILL * abs(angles[0])
    return next((x for x, y in zip(times, angles, strict=True) if abs(y - angles[0]) > still), times[-1])


def _heat(outcome: Outcome) -> dict[str, Any]:
    which = outcome.which
    studies = [
        {"label": label, **answer["heat"][which]} for label, answer in outcome.found.items() if which in answer["heat"]
    ]
    every = [value for study_data in studies for row in study_data["temperature"] for value in row]
    design = outcome.designs[which][studies[0]["label"]]
    melting = [from_si(design.value(name), "degC") for name in ("pcl_melting_start", "pcl_melting_end")]
    title = _title(outcome, "Heat through the PCL until the switch ends (lines: melting range)")
    return {"title": title, "studies": studies, "coldest": min(every), "hottest": max(every), "melting": melting}


_FILES = {"summary.txt": "all of this as text", "compare.csv": "every output", "fronts.csv": "the fronts"}
_LINES = {
    "fronts": "The fronts: each point is a whole design.",
    "release": "The link of each module released from the same angle.",
}
"""Figures of lines, with what they show."""


def comparison_page(folder: ResultsFolder, outcome: Outcome, texts: Mapping[str, str]) -> Page:
    """Return the page of compared studies; `texts` are the studies' files."""
    troubles = outcome.failures
    verdict = "PARTLY DONE" if troubles else f"COMPARED {COMPARISONS[outcome.which].upper()}"
    warnings = [(text, "") for text in warnings_of(outcome)]
    lead, *others = outcome.conclusions
    first: list[Block] = [Words([lead]), *([Warned(warnings)] if warnings else [])]
    follows = [Section("follows", "What follows", [Points(others)])] if others else []
    sections = [*follows, _side_by_side(outcome), *_figures(outcome)]
    sections += [Section("not-done", "Not done", [Points(troubles)])] if troubles else []
    sections += [_studies(texts), versions_section(folder)]
    title = " against ".join(entrant.study.name for entrant in outcome.entrants.values())
    return Page(
        title,
        "comparison",
        verdict,
        tone_of(verdict),
        first,
        None,
        sections,
        made_by_words(folder),
        there(folder, _FILES),
    )


def _side_by_side(outcome: Outcome) -> Section:
    """Show headlines and requirements; then everything that all studies have."""
    lines = reported_rows(outcome)
    every = [side_by_side(COMPARISONS[which], rows) for which, rows in outcome.rows.items()]
    blocks: list[Block] = [*lines, *([Folded("Every output that all studies have", every)] if every else [])]
    return Section("side-by-side", "Side by side", blocks)


def _figures(outcome: Outcome) -> list[Section]:
    """Return fronts and curves, where there are any."""
    drawn: list[Block] = [
        Drawn(drawing.file, "lines.js", _LINES[drawing.file], _panels(drawing.data), libraries=["echarts"])
        for drawing in drawings(outcome)
        if drawing.file in _LINES
    ]
    return [Section("curves", "Fronts and curves", drawn)] if drawn else []


def _panels(data: dict[str, Any]) -> dict[str, Any]:
    """Return panels as the page draws them: a front's points are marked."""
    return {
        "panels": [
            {**panel, "lines": [{**line, "points": "optimum" in line} for line in panel["lines"]]}
            for panel in data["panels"]
        ]
    }


def _studies(texts: Mapping[str, str]) -> Section:
    listed = [Folded(label, [Listing(f"Study of {label}", text)]) for label, text in texts.items()]
    return Section("study", "Studies", listed)
