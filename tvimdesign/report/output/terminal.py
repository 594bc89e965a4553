"""Blocks as lines of text for the terminal and summary.txt, and the progress of a run on standard error."""

import io
import os
import re
import textwrap
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from rich.box import HORIZONTALS
from rich.console import Console
from rich.errors import MarkupError
from rich.markup import escape
from rich.status import Status
from rich.table import Table
from rich.text import Text

from tvimdesign.base.interrupts import interrupt_handler, raise_pending
from tvimdesign.report.page.blocks import Block, Facts, Folded, Grid, Points, Section, Warned, Words

LABEL = 20  # Columns that a label takes
DOT = " · "
_STYLES = {"bad": "red", "warn": "yellow", "good": "green", "": ""}


def wrapped(text: str, width: int, begin: str = "", indent: str = "") -> list[str]:
    """Return a text in lines of at most `width` columns; a longer word has a line of its own, in one piece."""
    return textwrap.wrap(
        text, width, initial_indent=begin, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


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


def print_section(section: Section, console: Console, *, folded: bool = True) -> None:
    """Print the text and the tables of a section under its title; figures and pictures are left to the page."""
    blocks = [item for item in section.blocks if _is_text(item, folded=folded)]
    if blocks and section.title:
        console.print(f"\n[bold]{section.title.upper()}[/bold]")
    for item in blocks:
        print_block(item, console)


def _is_text(item: Block, *, folded: bool) -> bool:
    if isinstance(item, Folded):
        return folded
    if isinstance(item, Words | Points):
        return bool(item.lines)
    return isinstance(item, Grid | Facts | Warned) and bool(item.rows)


def plain_text(show: Callable[[Console], None], width: int) -> str:
    """Return what is printed on a console as text for a file."""
    stream = io.StringIO()
    show(OwnMarkupConsole(file=stream, width=width, color_system=None, highlight=False))
    return "\n".join(line.rstrip() for line in stream.getvalue().splitlines()) + "\n"


def print_block(item: Block, console: Console) -> None:
    """Print one block, if it is of text."""
    if isinstance(item, Grid):
        print_grid(item, console)
    elif isinstance(item, Facts):
        column = max([LABEL, *(len(label) + 1 for label, _ in item.rows)])
        for label, text in item.rows:
            print_lines(wrapped(text, console.width, label.ljust(column), " " * column), console)
    elif isinstance(item, Words | Points):
        for line in item.lines:
            console.print(escape(line))
    elif isinstance(item, Warned):
        for text, cure in item.rows:
            console.print(f"[yellow]Warning[/yellow] {escape(text)}" + (f"; {escape(cure)}" if cure else ""))
    elif isinstance(item, Folded) and item.file:
        console.print(f"{item.title}: {item.file}", markup=False)
    elif isinstance(item, Folded):
        for within in item.blocks:
            print_block(within, console)


def print_grid(grid: Grid, console: Console, *, lines: bool = False) -> None:
    """Print a table that has rows, and its note; `lines` between rows of long texts."""
    if not grid.rows:
        return
    table = Table(title=grid.caption or None, title_justify="left", title_style="bold", padding=(0, 2, 0, 0),
                  show_lines=lines, box=HORIZONTALS if lines else None, pad_edge=False, header_style="dim")  # fmt: skip
    for i, head in enumerate(grid.heads):
        table.add_column(head.text, justify="right" if head.right else "left", no_wrap=i == 0 and not lines,
                         overflow="fold")  # fmt: skip
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


Progress = Callable[[str], None]
WIDTH = 132
PLAIN_EVERY = 2.2  # s
"""Time between plain lines: the next new message, or how long the last one goes on; others are left out."""
_TICK = 0.25  # s


def wide_console() -> Console:
    """Return standard output: as wide as the terminal, and wide enough for a table where there is none."""
    console = OwnMarkupConsole(highlight=False)
    wide = not console.is_terminal and "COLUMNS" not in os.environ
    return OwnMarkupConsole(highlight=False, width=WIDTH) if wide else console


@contextmanager
def progress_output() -> Iterator[Progress]:
    """Say on standard error what is going on, for how long, and what is left where that is known.

    One moving line on a terminal; plain lines, one every few seconds, elsewhere. What goes on, or comes again, is
    shorter; it has a bar where the end is known. An interrupt that a library swallows is raised again at the next thing
    said; CasADi swallows some. An empty text ends the line, to print something else.
    """
    shown = _Shown(Console(stderr=True, highlight=False, markup=False))

    def say(text: str) -> None:
        raise_pending()
        shown.say(text)

    with interrupt_handler():
        try:
            yield say
        finally:
            shown.end()


class _Shown:
    """The progress line, shown with the time by a thread that ticks, as work reports only now and then."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._status = Status("", console=console) if console.is_terminal else None
        self._text, self._remaining = "", RemainingTime()
        self._shown: set[str] = set()
        self._began = time.monotonic()
        self._printed = self._began - PLAIN_EVERY
        self._lock, self._ended = threading.Lock(), threading.Event()
        self._thread = threading.Thread(target=self._tick, daemon=True)
        self._thread.start()

    def say(self, text: str) -> None:
        """Show a text from now on; an empty one ends the line."""
        with self._lock:
            self._text = text
            self._remaining.heard(text, time.monotonic())
            if self._status is not None and not text:
                self._status.stop()
            self._show()

    def end(self) -> None:
        """Show nothing more."""
        self._ended.set()
        self._thread.join()
        if self._status is not None:
            self._status.stop()

    def _tick(self) -> None:
        while not self._ended.wait(_TICK):
            with self._lock:
                self._show()

    def _show(self) -> None:
        now = time.monotonic()
        if not self._text or (self._status is None and now - self._printed < PLAIN_EVERY):
            return
        elapsed, part = now - self._began, share_done(self._text)
        times = clock(elapsed, self._remaining.left(now))
        if self._status is not None:
            self._status.update(" · ".join(filter(None, [self._text, part, times])))
            self._status.start()
            return
        text = f"still {self._text.partition(':')[0]}" if self._text in self._shown else self._text
        self._console.print(f"... {' · '.join(filter(None, [text, part, times]))}", soft_wrap=True)
        self._shown.add(self._text)
        self._printed = now


_CELLS = 20  # Cells of a bar


def share_done(text: str) -> str:
    """Return a bar with its percentage for `3 of 12`, the step that runs now; empty for a text without an end."""
    match = _COUNTED.match(text)
    if match is None or int(match["all"]) < 2:
        return ""
    share = max(int(match["done"]) - 1, 0) / int(match["all"])
    cells = round(_CELLS * min(share, 1.0))
    return f"{'█' * cells}{'░' * (_CELLS - cells)} {min(share, 1.0):.0%}"


_COUNTED = re.compile(r"(?P<of>.*?)(?P<done>\d+) of (?:about )?(?P<all>\d+)")


class RemainingTime:
    """The remaining time of a series, by the mean time of its steps so far; unknown before a quarter of them is done.

    Steps differ: an estimate from the first few is several times off.

    A message between two steps belongs to the one before it; after the last step it is something else.
    """

    def __init__(self) -> None:
        self._series: tuple[str, str] | None = None
        self._first, self._began = 0, 0.0
        self._end: float | None = None
        self._last = False

    def heard(self, text: str, now: float) -> None:
        """Take a message at a time [s]: a step that starts says its number."""
        match = _COUNTED.match(text)
        if match is None:
            self._end = None if self._last else self._end
            return
        number, last = int(match["done"]), int(match["all"])
        self._last = number >= last
        if self._series != (match["of"], match["all"]) or number < self._first:
            self._series = (match["of"], match["all"])
            self._first, self._began, self._end = number, now, None
        elif self._first < number <= last:
            done, ahead = number - self._first, last - number + 1
            self._end = now + (now - self._began) / done * ahead if 3 * done >= ahead else None

    def left(self, now: float) -> float | None:
        """Return seconds that are left; None where nothing can be said of it."""
        return None if self._end is None else max(self._end - now, 0.0)


def clock(elapsed: float, left: float | None) -> str:
    """Return `12 s, about 30 s left`; nothing within the first second."""
    if elapsed < 1.0:
        return ""
    return duration(elapsed) + ("" if left is None or left < 1.0 else f", about {duration(left)} left")


def duration(seconds: float) -> str:
    """Return `8 s`, `2 min 05 s`, `1 h 12 min`."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    return f"{whole // 3600} h {whole % 3600 // 60:02d} min"
