"""What the terminal says of a tolerance analysis: what varies from part to part; apart from it, what nobody knows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from tvimdesign.device import Table
from tvimdesign.report.output.tables import number
from tvimdesign.report.tolerate.tolerance_tables import spreads
from tvimdesign.report.tolerate.unknown import unknown_rows
from tvimdesign.report.tolerate.words import of_concern
from tvimdesign.solve.nlp.constraints import in_words
from tvimdesign.solve.uncertainty.tolerance import Spread


def print_tolerances(found: Spread, data: dict[str, Any], table: Table, console: Console) -> None:
    """Print what varies from part to part, and what is to be said of both blocks."""
    for note in data["notes"]:
        console.print(f"[dim]{escape(note)}[/dim]")
    grid = _grid(
        "What spreads from part to part",
        ("", "as drawn", "worst case", "rss sd", "mc mean", "mc sd", "99.73 %", "unit", "most by"),
    )
    for i, row in enumerate(data["outputs"]):
        if row["output"] in found.asked and spreads(found, i):
            most = int(found.shares[i].argmax())
            by = f"{found.contributors[most].name} {100.0 * found.shares[i, most]:.0f} %"
            grid.add_row(
                row["output"], _shown(row["as_drawn"]), _span(row["worst_low"], row["worst_high"]),
                _shown(row["deviation_rss"]), _shown(row["mean"]), _shown(row["deviation"]),
                _span(row["low"], row["high"]), row["unit"], by,
            )  # fmt: skip
    console.print(grid)
    concern = of_concern(found)
    if concern:
        grid = _grid("Limits that too many modules break", ("", "yield", "C_pk", "most by"))
        for kept in concern:
            i = found.outputs.index(kept.limit.output)
            most = int(found.shares[i].argmax())
            by = f"{found.contributors[most].name} {100.0 * found.shares[i, most]:.0f} %"
            grid.add_row(in_words(kept.limit, table), f"{100.0 * kept.share.share:.4g} %", f"{kept.capability:.2f}", by)
        console.print(grid)
    if "cost_of_robustness" in data:
        grid = _grid("What robustness costs", ("", "nominal optimum", "robust optimum", "unit"))
        for row in data["cost_of_robustness"]:
            grid.add_row(row["output"], number(row["nominal"]), number(row["robust"]), row["unit"])
        console.print(grid)
    for sentence in data["sentences"]:
        console.print(escape(sentence))


def print_unknown(data: Mapping[str, Any], console: Console) -> None:
    """The second block, under its own heading."""
    heads = ("", "as drawn", "one at a time", "all together, 95 %", "unit", "measure first")
    shown = _grid("What nobody knows", heads)
    for row in unknown_rows(data):
        if row["low"] == row["high"]:
            continue
        alone = _span(row["one_at_a_time_low"], row["one_at_a_time_high"])
        first = f"{row['measure_first']} {100.0 * float(row['share'] or 0.0):.0f} %" if row["measure_first"] else ""
        cells = (str(row["output"]), _shown(row["as_drawn"]), alone, _span(row["low"], row["high"]))
        shown.add_row(*cells, str(row["unit"]), first)
    if shown.row_count:
        console.print(shown)


def _grid(title: str, columns: Sequence[str]) -> Grid:
    grid = Grid(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False, padding=(0, 2, 0, 0),
                header_style="dim")  # fmt: skip
    for i, name in enumerate(columns):
        grid.add_column(name, justify="left" if i in (0, len(columns) - 1) or name == "unit" else "right")
    return grid


def _shown(value: float | None) -> str:
    return "never" if value is None else number(value)


def _span(low: float | None, high: float | None) -> str:
    return f"{_shown(low)} to {_shown(high)}"
