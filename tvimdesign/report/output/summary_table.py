"""A table as text: what the terminal prints, summary.txt holds and the page shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rich.console import Console
from rich.table import Table as Grid
from rich.text import Text


@dataclass(frozen=True)
class SummaryTable:
    """A table as text: its title, the heads of its columns, its rows, and which columns are numbers."""

    title: str
    heads: Sequence[str]
    rows: Sequence[Sequence[str]]
    right: Sequence[int] = ()


def print_table(found: SummaryTable, console: Console, styles: Mapping[str, str] | None = None) -> None:
    """Print a table, where it has rows; `styles` are those of cells that are one word."""
    grid = Grid(title=found.title or None, title_justify="left", title_style="bold", box=None, pad_edge=False,
                padding=(0, 2, 0, 0), header_style="dim")  # fmt: skip
    for i, head in enumerate(found.heads):
        grid.add_column(head, justify="right" if i in found.right else "left", no_wrap=i == 0)
    for row in found.rows:
        grid.add_row(*(Text(cell, style=(styles or {}).get(cell, "")) for cell in row))
    if grid.row_count:
        console.print(grid)
