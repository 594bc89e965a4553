"""The summary of a comparison, for the terminal and for summary.txt."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Sequence
from typing import Any

from rich.console import Console
from rich.markup import escape

from tvimdesign.base.units import format_quantity, from_si, pretty
from tvimdesign.page.blocks import Grid
from tvimdesign.report.compare.comparison import COMPARISONS, Outcome
from tvimdesign.report.compare.comparison_table import Row
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.progress import WIDTH
from tvimdesign.report.output.tables import number
from tvimdesign.report.output.terminal import OwnMarkupConsole, print_grid


def print_comparison(outcome: Outcome, console: Console) -> None:
    """Print a comparison for people: what follows first, then the tables it follows from."""
    console.print(f"[bold]{escape(' against '.join(outcome.entrants))}[/bold]")
    for sentence in outcome.conclusions:
        console.print(f"- {escape(sentence)}")
    console.print()
    for table in reported_rows(outcome):
        print_grid(table, console)
    for which, alone in outcome.alone.items():
        shown = [f"{label}: {row.name} {_value(row, label, with_unit=True)}" for label, row in alone if row.headline]
        if shown:
            console.print(
                f"[dim]{COMPARISONS[which].capitalize()}, not in every study: {escape('; '.join(shown))}.[/dim]"
            )
    _print_soft(outcome, console)
    _print_searches(outcome, console)
    _print_fronts(outcome, console)
    _print_warnings(outcome, console)
    for failure in outcome.failures:
        console.print(f"[red]Not done[/red] {escape(failure)}")


def summary_text(outcome: Outcome) -> str:
    """Format the summary as plain text."""
    stream = io.StringIO()
    print_comparison(outcome, OwnMarkupConsole(file=stream, width=WIDTH, highlight=False, color_system=None))
    return stream.getvalue()


def reported_rows(outcome: Outcome) -> list[Grid]:
    """Tabulate headlines and requirements side by side, a table for each comparison."""
    required = {r.output for entrant in outcome.entrants.values() for r in entrant.study.require}
    return [
        side_by_side(COMPARISONS[which].capitalize(), [row for row in rows if row.headline or row.name in required])
        for which, rows in outcome.rows.items()
    ]


def side_by_side(title: str, rows: Sequence[Row]) -> Grid:
    """Tabulate outputs of all studies beside one another, with each one's ratio to the first."""
    labels = list(rows[0].values) if rows else []
    heads = ["", *labels, "unit"]
    heads += [head for label in labels[1:] for head in (f"{label} / {labels[0]}", f"{label} is")]
    cells = []
    for row in rows:
        against: list[str] = []
        for label in labels[1:]:
            ratio = row.ratio(label)
            against += ["" if ratio is None else number(ratio, 3), row.verdict(label)]
        cells.append([row.name, *(_value(row, label) for label in labels), pretty(row.unit), *against])
    ratios = range(len(labels) + 2, len(heads), 2)
    right, toned = (*range(1, len(labels) + 1), *ratios), range(len(labels) + 3, len(heads), 2)
    return grid(title, heads, cells, right=right, toned=toned)


def _value(row: Row, label: str, *, with_unit: bool = False) -> str:
    """Return a value for people; low to high where history leaves it open."""
    if label in row.ends:
        return " to ".join(number(from_si(end, row.unit), 2) for end in row.ends[label])
    value = row.values[label]
    if with_unit and math.isfinite(value):
        return format_quantity(value, row.unit)
    return "-" if math.isnan(value) else number(from_si(value, row.unit))


def _print_soft(outcome: Outcome, console: Console) -> None:
    """Print at which impedance the joint counts as soft: it differs between studies."""
    which = outcome.which
    texts = [f"{label}: {answer[which]['soft']}" for label, answer in outcome.found.items() if which in answer]
    if texts:
        console.print(f"[dim]Soft is, {COMPARISONS[which]}, {escape('; '.join(texts))}.[/dim]")


def _print_searches(outcome: Outcome, console: Console) -> None:
    for label, answer in outcome.found.items():
        reported: dict[str, Any] | None = answer.get("optimised")
        if reported is None:
            continue
        if not reported["optima"]:
            continue
        seconds = answer["seconds"].get("optimised")
        optima = [f"{optimum['objective']:.5g}" for optimum in reported["optima"]]
        agree = "all at one optimum" if len(optima) == 1 else f"at {len(optima)} optima"
        console.print(
            f"[dim]{escape(label)}: {reported['converged']} of {reported['starts']} starts converged, {agree}, "
            f"objective {', '.join(optima)} over what is drawn on average"
            f"{'' if seconds is None else f'; {seconds:.1f} s'}.[/dim]"
        )


def _print_warnings(outcome: Outcome, console: Console) -> None:
    for label, names in accepted(outcome):
        console.print(f"{escape(label)} is beyond its rating, as its study accepts: {', '.join(names)}.")
    for warning in warnings_of(outcome):
        console.print(f"[yellow]Warning[/yellow] {escape(warning)}.")


def accepted(outcome: Outcome) -> Iterator[tuple[str, list[str]]]:
    """Return (study, ratings) of what is beyond its rating, as its study accepts."""
    for label, answer in outcome.found.items():
        if names := answer.get(outcome.which, {}).get("accepting"):
            yield label, names


def warnings_of(outcome: Outcome) -> Iterator[str]:
    """Yield the advice that the compared designs do not follow."""
    for label, answer in outcome.found.items():
        for warning in answer.get(outcome.which, {"warnings": []})["warnings"]:
            value = math.inf if warning["value"] is None else warning["value"]
            value = format_quantity(value, outcome.unit(warning["output"]))
            yield f"{label}: {warning['output']} is {value}: {warning['because']}"


def _print_fronts(outcome: Outcome, console: Console) -> None:
    for (first, second), fronts in outcome.fronts.items():
        for label, front in fronts.items():
            reported = [f"{len(front['points'])} points", *front["notes"]]
            reported += [f"{front['dominated']} more are no better in anything"] if front["dominated"] else []
            reported += [f"no design at {failure['where']}: {failure['reason']}" for failure in front["failures"]]
            console.print(
                f"[dim]Front of {first} against {second}, {escape(label)}: {escape('; '.join(reported))}.[/dim]"
            )
