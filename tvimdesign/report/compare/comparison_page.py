"""A comparison as sections of text, tables and figures, and what its pictures are drawn from."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.markup import escape

from tvimdesign.base.units import from_si, pretty
from tvimdesign.page.blocks import Block, Drawn, Folded, Grid, Listing, Points, Section, Warned, Words
from tvimdesign.report.compare.comparison import COMPARISONS, Outcome
from tvimdesign.report.compare.comparison_table import Row
from tvimdesign.report.output.numbers import axis_label, in_unit, number
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.terminal import WIDTH, plain_text, print_section
from tvimdesign.report.run.blocks.warnings import advice_text


def drawings(outcome: Outcome) -> list[Drawing]:
    """Return every picture there is something for."""
    return [Drawing("fronts", "design_figures.fronts", _fronts(outcome))] if outcome.fronts else []


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
                "points": True, "optimum": [[shown(second, optimum)], [shown(first, optimum)]],
            })  # fmt: skip
        axes = {f"{axis}_label": axis_label(name, units[name]) for axis, name in (("x", second), ("y", first))}
        panels.append({"lines": lines, **axes})
    return {"title": "Fronts; filled: each study's optimum", "panels": panels}


FILES = {"summary.txt": "all of this as text", "compare.csv": "every output", "fronts.csv": "the fronts"}


def comparison_sections(outcome: Outcome, texts: Mapping[str, str]) -> list[Section]:
    """Return what follows, the tables it follows from, figures and the studies; `texts` are the studies' files."""
    follows, troubles = outcome.conclusions[1:], outcome.failures
    fronts: list[Block] = [
        Drawn("fronts", "lines.js", "The fronts: each point is a whole design.", drawing.data, libraries=["echarts"])
        for drawing in drawings(outcome)
    ]
    return [
        *([Section("follows", "What follows", [Points(follows)])] if follows else []),
        _side_by_side(outcome),
        *([Section("curves", "Fronts", fronts)] if fronts else []),
        *([Section("differ", "Different conditions", [Points(outcome.differences)])] if outcome.differences else []),
        Section("searches", "How they were found", [Points(list(_searches(outcome)))]),
        *([Section("not-done", "Not done", [Points(troubles)])] if troubles else []),
        Section(
            "study", "Studies", [Folded(label, [Listing(f"Study of {label}", text)]) for label, text in texts.items()]
        ),
    ]


def first_blocks(outcome: Outcome) -> list[Block]:
    """Return the conclusion with its conditions, and the warnings."""
    warnings = [(text, "") for text in warnings_of(outcome)]
    return [Words(outcome.conclusions[:1]), *([Warned(warnings)] if warnings else [])]


def title_of(outcome: Outcome) -> str:
    """Return the names of the studies."""
    return " against ".join(entrant.study.name for entrant in outcome.entrants.values())


def summary_text(outcome: Outcome) -> str:
    """Return the text and the tables of the page that are not folded."""

    def show(console: Console) -> None:
        console.print(f"[bold]{escape(title_of(outcome))}[/bold]", soft_wrap=True)
        for section in (Section("first", "", first_blocks(outcome)), *comparison_sections(outcome, {})):
            print_section(section, console, folded=False)

    return plain_text(show, WIDTH)


def _side_by_side(outcome: Outcome) -> Section:
    """Show headlines and requirements; then everything that all studies have."""
    lines = reported_rows(outcome)
    every = [side_by_side(COMPARISONS[which], rows) for which, rows in outcome.rows.items()]
    blocks: list[Block] = [*lines, *([Folded("Every output that all studies have", every)] if every else [])]
    return Section("side-by-side", "Side by side", blocks)


def reported_rows(outcome: Outcome) -> list[Grid]:
    """Tabulate headlines and requirements side by side, a table for each comparison."""
    required = {r.output for entrant in outcome.entrants.values() for r in entrant.study.require}
    return [
        side_by_side(COMPARISONS[which].capitalize(), [row for row in rows if row.headline or row.name in required])
        for which, rows in outcome.rows.items()
    ]


def side_by_side(title: str, rows: Sequence[Row]) -> Grid:
    """Tabulate outputs that differ in four digits between the studies, with each one's ratio to the first."""
    labels = list(rows[0].values) if rows else []
    heads = ["", *labels, "unit"]
    heads += [head for label in labels[1:] for head in (f"{label} / {labels[0]}", f"{label} is")]
    differing = [row for row in rows if len({_value(row, label) for label in labels}) > 1]
    equal = len(rows) - len(differing)
    cells = []
    for row in differing:
        against: list[str] = []
        for label in labels[1:]:
            ratio = row.ratio(label)
            against += ["" if ratio is None else number(ratio, 3), row.verdict(label)]
        cells.append([row.name, *(_value(row, label) for label in labels), pretty(row.unit), *against])
    ratios = range(len(labels) + 2, len(heads), 2)
    right, toned = (*range(1, len(labels) + 1), *ratios), range(len(labels) + 3, len(heads), 2)
    return grid(title, heads, cells, right=right, toned=toned, note=f"{equal} more are equal." if equal else "")


def _value(row: Row, label: str) -> str:
    """Return a value for people; low to high where history leaves it open."""
    if label in row.ends:
        return " to ".join(in_unit(end, row.unit, 2) for end in row.ends[label])
    value = row.values[label]
    return "-" if math.isnan(value) else in_unit(value, row.unit)


def _searches(outcome: Outcome) -> Iterator[str]:
    """Yield what soft means, how optima and fronts were found, and what is accepted."""
    which = outcome.which
    texts = [f"{label}: {answer[which]['soft']}" for label, answer in outcome.found.items() if which in answer]
    if texts:
        yield f"Soft is, {COMPARISONS[which]}, {'; '.join(texts)}."
    for label, answer in outcome.found.items():
        search, seconds = answer.get("optimised"), answer["seconds"].get("optimised")
        if search and search["optima"]:
            optima = [f"{optimum['objective']:.5g}" for optimum in search["optima"]]
            agree = "all at one optimum" if len(optima) == 1 else f"at {len(optima)} optima"
            took = "" if seconds is None else f"; {seconds:.1f} s"
            yield (
                f"{label}: {search['converged']} of {search['starts']} starts converged, {agree}, objective "
                f"{', '.join(optima)} over what is drawn on average{took}."
            )
        if names := answer.get(which, {}).get("accepting"):
            yield f"{label} is beyond its rating, as its study accepts: {', '.join(names)}."
    for (first, second), fronts in outcome.fronts.items():
        for label, front in fronts.items():
            points = [f"{len(front['points'])} points", *front["notes"]]
            points += [f"{front['dominated']} more are no better in anything"] if front["dominated"] else []
            points += [f"no design at {failure['where']}: {failure['reason']}" for failure in front["failures"]]
            yield f"Front of {first} against {second}, {label}: {'; '.join(points)}."


def warnings_of(outcome: Outcome) -> Iterator[str]:
    """Yield the advice that the compared designs do not follow."""
    for label, answer in outcome.found.items():
        for warning in answer.get(outcome.which, {"warnings": []})["warnings"]:
            value = math.inf if warning["value"] is None else warning["value"]
            yield f"{label}: {advice_text(warning['output'], value, warning['because'], outcome.tables[label])}"
