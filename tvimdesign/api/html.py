"""Small tables for notebooks; every text is escaped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape


def heading(title: str, more: str) -> str:
    """A title in bold, and a line about it."""
    return f"<p><b>{escape(title)}</b> &middot; {escape(more)}</p>"


def grid(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; nothing where it has no rows."""
    lines = [_line("td", row) for row in rows]
    return f"<table><thead>{_line('th', columns)}</thead><tbody>{''.join(lines)}</tbody></table>" if lines else ""


def _line(tag: str, cells: Sequence[str]) -> str:
    return "<tr>" + "".join(f'<{tag} style="text-align:left">{escape(cell)}</{tag}>' for cell in cells) + "</tr>"
