"""One page for a mail or a lab book: verdict, requirements, facts, warnings and the module, on A4."""

import textwrap
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from tvimdesign.report.figures.theme import FAINT, NAME_STRIP, new_figure

_WIDE, _HIGH = 8.27, 11.69  # inches: A4
_LEFT, _BOTTOM = 0.7, 0.6
_ACROSS = _WIDE - 2.0 * _LEFT
_LINE, _SMALL, _SIZE = 0.165, 7.5, 8.5  # inches of a line; points
_LETTERS = 100
"""Letters of a line of text across the page."""
_LABEL = 1.3  # inches that the labels of facts take
_TONES = {"good": "#1b6b3a", "warn": "#8a5300", "bad": "#a8201a", "": "black"}
_MOST_ROWS = 22
_PICTURE = 2.9  # inches high at most


class _Sheet:
    """A figure that is filled from the top down."""

    def __init__(self) -> None:
        self.figure = new_figure(_HIGH, _WIDE)
        self.left = _HIGH - _BOTTOM - NAME_STRIP
        """Inches from the foot of the page up to the next line."""

    def text(self, text: str, at: float = 0.0, size: float = _SIZE, **more: Any) -> None:
        """Write at a distance from the left margin [inches], on the line of now."""
        place = ((_LEFT + at) / _WIDE, self.left / _HIGH)
        self.figure.text(*place, text, va="top", fontsize=size, parse_math=False, **more)

    def down(self, inches: float = _LINE) -> None:
        """Go on to the next line."""
        self.left -= inches

    def rule(self) -> None:
        """Draw a thin line across the page."""
        line = self.figure.add_axes((_LEFT / _WIDE, (self.left + 0.04) / _HIGH, _ACROSS / _WIDE, 1e-4))
        line.axhline(0.0, color=FAINT, linewidth=0.6)
        line.set_axis_off()

    def lines(self, text: str, label: str, **style: Any) -> None:
        """Write a text behind its label, each in as many lines as it takes."""
        wide, narrow = (int(_LETTERS * inches / _ACROSS) for inches in (_ACROSS - _LABEL, _LABEL))
        for left, right in zip_longest(textwrap.wrap(label, narrow), textwrap.wrap(text, wide), fillvalue=""):
            self.text(left, **style)
            self.text(right, _LABEL)
            self.down()


def summary(data: dict[str, Any]) -> Figure:
    """Return the page of a run's first screen."""
    sheet = _Sheet()
    sheet.text(textwrap.shorten(data["title"], 60, placeholder=" …"), size=15.0, weight="bold")
    sheet.down(0.3)
    sheet.text(data["kind"], color="0.35")
    sheet.down(1.4 * _LINE)
    for line in textwrap.wrap(data["status"], 70):
        sheet.text(line, size=12.0, weight="bold", color=_TONES[data["tone"]])
        sheet.down(0.24)
    sheet.down(0.5 * _LINE)
    if data["rows"]:
        _table(sheet, data["heads"], data["rows"])
    for label, text in data["facts"]:
        sheet.lines(text, label, color="0.35")
    for text, cure in data["warnings"]:
        sheet.lines(text + (f"; {cure}" if cure else ""), "Warning", color=_TONES["warn"], weight="bold")
    if data["picture"]:
        _picture(sheet, Path(data["picture"]))
    sheet.left = _BOTTOM
    sheet.text(data["made_by"], size=_SMALL, color="0.35")
    return sheet.figure


def _table(sheet: _Sheet, heads: list[str], rows: list[list[str]]) -> None:
    """Write the requirements: as many as have a place, and how many more there are."""
    ends = (0.0, 1.9, 3.05, 4.35, 5.4)
    for at, head in zip(ends, heads, strict=False):
        sheet.text(head, at, color="0.35")
    sheet.down()
    for row in rows[:_MOST_ROWS]:
        sheet.rule()
        for at, text in zip(ends, row, strict=False):
            tone = "bad" if text.startswith("violated") else "warn" if text == "at the limit" else ""
            sheet.text(textwrap.shorten(text, 32, placeholder=" …"), at, color=_TONES[tone])
        sheet.down()
    if len(rows) > _MOST_ROWS:
        sheet.text(f"{len(rows) - _MOST_ROWS} more in report.html", color="0.35")
        sheet.down()
    sheet.rule()
    sheet.down(0.5 * _LINE)


def _picture(sheet: _Sheet, path: Path) -> None:
    """Draw the module in the room that is left, if there is enough to see it."""
    sheet.down(0.5 * _LINE)
    room = min(_PICTURE, sheet.left - _BOTTOM - _LINE)
    if room < 0.8:
        return
    with Image.open(path) as opened:
        pixels = np.asarray(opened.convert("RGB").reduce(2))
    high = min(room, _ACROSS * pixels.shape[0] / pixels.shape[1])
    wide = high * pixels.shape[1] / pixels.shape[0]
    axes = sheet.figure.add_axes((_LEFT / _WIDE, (sheet.left - high) / _HIGH, wide / _WIDE, high / _HIGH))
    axes.imshow(pixels, interpolation="none", aspect="auto")
    axes.set_axis_off()
