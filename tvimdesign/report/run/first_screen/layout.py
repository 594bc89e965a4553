"""Lines of a screen that is so many columns wide: labelled blocks, wrapped between words, so that no name is broken."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence

LABEL = 13
"""Columns that a block's label takes."""
DOT = " · "


def wrapped(text: str, width: int, begin: str = "", indent: str = "") -> list[str]:
    """A text in lines of at most `width` columns; a word that is longer has a line of its own, in one piece."""
    return textwrap.wrap(
        text, width, initial_indent=begin, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


def block(label: str, text: str, width: int) -> list[str]:
    """A paragraph that begins with its label."""
    return wrapped(text, width, label.ljust(LABEL), " " * LABEL)


def listed(label: str, texts: Sequence[str], width: int) -> list[str]:
    """A line, or a paragraph, for each text; the label stands before the first."""
    return [line for i, text in enumerate(texts) for line in block(label if i == 0 else "", text, width)]


def joined(label: str, parts: Iterable[str], width: int) -> list[str]:
    """Short parts with dots between them; a line ends between two parts where they are more than one line holds."""
    lines: list[str] = []
    for part in parts:
        longer = f"{lines[-1]}{DOT}{part}" if lines else ""
        if lines and len(longer) <= width:
            lines[-1] = longer
        else:
            lines += wrapped(
                part, width, label.ljust(LABEL) if label and not lines else " " * LABEL * bool(label), " " * LABEL
            )
    return lines


def columns(rows: Sequence[Sequence[str]], right: Sequence[int] = ()) -> list[str]:
    """Rows of cells under one another, two columns apart; an empty last cell leaves nothing behind."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))] if rows else []
    return [
        "  ".join(
            cell.rjust(width) if i in right else cell.ljust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
