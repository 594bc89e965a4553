"""Blocks as lines of text of so many columns: what the terminal prints and summary.txt holds."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from typing import Any

from rich.console import Console
from rich.errors import MarkupError
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from tvimdesign.page.blocks import Block, Facts, Folded, Grid, Points, Section, Warned, Words

LABEL = 20
"""Columns that a label takes."""
DOT = " · "
_STYLES = {"bad": "red", "warn": "yellow", "good": "green", "": ""}


def wrapped(text: str, width: int, begin: str = "", indent: str = "") -> list[str]:
    """Return a text in lines of at most `width` columns; a longer word has a line of its own, in one piece."""
    return textwrap.wrap(
        text, width, initial_indent=begin, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


def block(label: str, text: str, width: int) -> list[str]:
    """Return a paragraph that begins with its label."""
    return wrapped(text, width, label.ljust(LABEL), " " * LABEL)


def joined(parts: Iterable[str], width: int, indent: str = "") -> list[str]:
    """Return short parts with dots between them; a line ends between two parts if they are more than it holds."""
    lines: list[str] = []
    for part in parts:
        longer = f"{lines[-1]}{DOT}{part}" if lines else ""
        if lines and len(longer) <= width:
            lines[-1] = longer
        else:
            lines += wrapped(part, width, indent if lines else "", indent)
    return lines


def columns(rows: Sequence[Sequence[str]], right: Sequence[int] = ()) -> list[str]:
    """Return rows of cells under one another, two columns apart; an empty last cell leaves nothing behind."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))] if rows else []
    return [
        "  ".join(
            cell.rjust(width) if i in right else cell.ljust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def print_section(section: Section, console: Console) -> None:
    """Print the text and the tables of a section under its title; figures and pictures are left to the page."""
    console.print(f"\n[bold]{section.title.upper()}[/bold]")
    for item in section.blocks:
        print_block(item, console)


def print_block(item: Block, console: Console) -> None:
    """Print one block, if it is of text."""
    if isinstance(item, Grid):
        print_grid(item, console)
    elif isinstance(item, Facts):
        for label, text in item.rows:
            print_lines(block(label, text, console.width), console)
    elif isinstance(item, Words | Points):
        for line in item.lines:
            console.print(escape(line))
    elif isinstance(item, Warned):
        for text, cure in item.rows:
            console.print(f"[yellow]Warning[/yellow] {escape(text)}" + (f"; write {escape(cure)}" if cure else ""))
    elif isinstance(item, Folded):
        for within in item.blocks:
            print_block(within, console)


def print_grid(grid: Grid, console: Console) -> None:
    """Print a table that has rows, and its note."""
    if not grid.rows:
        return
    table = Table(title=grid.caption or None, title_justify="left", title_style="bold", box=None, pad_edge=False,
                  padding=(0, 2, 0, 0), header_style="dim")  # fmt: skip
    for i, head in enumerate(grid.heads):
        table.add_column(head.text, justify="right" if head.right else "left", no_wrap=i == 0)
    for row in grid.rows:
        table.add_row(*(Text(cell.text, style=_STYLES[cell.tone]) for cell in row))
    console.print(table)
    if grid.note:
        console.print(f"[dim]{escape(grid.note)}[/dim]")


def print_lines(lines: Iterable[str], console: Console, styles: dict[str, str] | None = None) -> None:
    """Print lines as they are: none is wrapped again; `styles` has patterns by the style of what they match."""
    for line in lines:
        text = Text(line)
        for style, pattern in (styles or {}).items():
            text.highlight_regex(pattern, style)
        console.print(text, soft_wrap=True)


_OTHER_TAG = re.compile(r"(?<!\\)(\\\\)*\[(?!/?(?:bold|dim|red|yellow|green)\]|/\])")


class OwnMarkupConsole(Console):
    """A rich console on which names, paths and sentences of a user never are markup, and never an error."""

    def render_str(self, text: str, **options: Any) -> Text:
        """Return a text with this package's own tags obeyed; without any if they do not match, as in a file's name."""
        markup = options.pop("markup", None)
        options |= {"emoji": False}  # or `:key:` would be a picture
        if not (markup or (markup is None and self._markup)):
            return super().render_str(text, markup=False, **options)
        try:
            return super().render_str(_OTHER_TAG.sub(r"\1\\[", text), markup=True, **options)
        except MarkupError:
            return super().render_str(text, markup=False, **options)
