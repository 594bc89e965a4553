"""The tables over the title block: every numbered feature, and the seats with their limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tvimdesign.cad.drawing.drawing_requirements import DATUM, DrawingRequirements, Seat
from tvimdesign.cad.drawing.drawing_sheet import MARGIN, TITLE_WIDTH, DrawingSheet
from tvimdesign.cad.drawing.feature_rows import FeatureRow
from tvimdesign.cad.drawing.iso_1101 import draw_frames
from tvimdesign.cad.drawing.number_text import figure

OVER_TITLE = 65.0
"""Height on the sheet above which there is room over the title block [mm]."""
_LINE, _FRAME = 4.6, 5.2
"""Height of its lines, and of those with tolerance frames [mm]."""
_OVER = 0.8
"""What is left free over and below a feature with a second line [mm]."""
_SMALL, _TEXT = 1.8, 2.3
_INDENT = 9.0
_COLUMNS = (0.0, 5.0, 40.0, 59.0, 73.0, 102.0, 112.0)
"""Where the columns of the seats begin [mm]."""
_SEATS = ("", "Seat", "fit", "limits µm", "limits of size", "Ra µm", "form and place")
_ABOUT = 42.0
"""Where the frames of a feature begin, behind what it is for [mm]."""


def table_height(rows: Sequence[FeatureRow], asked: DrawingRequirements) -> float:
    """Height on paper that both tables take [mm]."""
    features = sum(_LINE + (_FRAME + 2.0 * _OVER if _asks(row) else 0.0) for row in rows)
    return features + 2.0 * _LINE + (len(asked.seats) * (_FRAME + 0.8) + _LINE if asked.seats else 0.0)


def draw_tables(sheet: DrawingSheet, rows: Sequence[FeatureRow], asked: DrawingRequirements) -> None:
    """Draw seats over the title block and features over them, the first number on top."""
    left = sheet.size[0] - MARGIN - TITLE_WIDTH
    level = OVER_TITLE
    for seat in reversed(asked.seats):
        _draw_seat(sheet, seat, (left, level))
        level += _FRAME + 0.8
    if asked.seats:
        _cells(sheet, _SEATS, (left, level), _SMALL)
        level += _LINE + 2.0
    for index, row in reversed(list(enumerate(rows, start=1))):
        if _asks(row):
            level += _OVER
            sheet.text(row.asks, (left + _INDENT, level), _TEXT)
            draw_frames(sheet, row.frames, (left + _ABOUT, level - 0.8))
            level += _FRAME
        sheet.text(str(index), (left, level), _TEXT)
        sheet.text(row.text, (left + _INDENT, level), _TEXT, room=TITLE_WIDTH - _INDENT - 1.0)
        level += _LINE + (_OVER if _asks(row) else 0.0)
    if rows:
        sheet.text("Number in the plan, feature", (left, level), _SMALL)


def _asks(row: FeatureRow) -> bool:
    """Whether a second line is needed."""
    return bool(row.asks or row.frames)


def _draw_seat(sheet: DrawingSheet, one: Seat, at: tuple[float, float]) -> None:
    """What the table says of a seat."""
    left, level = at
    lower, upper = (f"{1e3 * limit:+.4g}" if limit else "0" for limit in one.limits)
    within = f"{one.size + one.limits.lower:.3f} to {one.size + one.limits.upper:.3f}"
    fitted = (f"⌀{figure(one.size)} {one.fit}", f"{upper} / {lower}", within)
    cells = fitted if one.fit else (f"⌀{figure(one.drawn)}", "as drawn", "general")
    _cells(sheet, (one.letter, one.about, *cells, f"{one.roughness:g}", one.form), at, _TEXT)
    draw_frames(sheet, one.frames, (left + _COLUMNS[-1], level - 0.8))


def _cells(sheet: DrawingSheet, texts: Sequence[str], at: tuple[float, float], height: float) -> None:
    for column, text in zip(_COLUMNS, texts, strict=True):
        if text:
            sheet.text(text, (at[0] + column, at[1]), height)


def with_datum(rows: Sequence[FeatureRow]) -> list[FeatureRow]:
    """The rows, the first arc about the axis told as datum: for a part, such as a link, with no round face about it."""
    told = list(rows)
    for index, row in enumerate(rows):
        if row.place.startswith("about the axis"):
            told[index] = replace(row, asks=f"datum {DATUM}: its axis")
            break
    return told
