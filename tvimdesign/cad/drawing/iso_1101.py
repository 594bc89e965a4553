"""Tolerance frames by ISO 1101 and the marks of datums by ISO 5459, drawn as lines: no font has all their symbols."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tvimdesign.cad.drawing.drawing_sheet import DrawingSheet

Point = tuple[float, float]
_HIGH = 4.0  # Height of a frame [mm]
_LETTER = 1.75  # Width that a letter of 2.2 mm takes [mm]


@dataclass(frozen=True)
class Frame:
    """One tolerance: what is asked, within what, against which datums."""

    asks: str  # A word of `SYMBOLS`
    within: str  # The zone [mm], with its diameter sign or `CZ`
    datums: str = ""  # Letters, the first datum first

    @property
    def cells(self) -> tuple[str, ...]:
        """Texts of the boxes behind the symbol."""
        return (self.within, *self.datums)

    @property
    def width(self) -> float:
        """On paper [mm]."""
        return _HIGH + 0.8 + sum(map(_cell, self.cells))


def _cell(text: str) -> float:
    return _LETTER * len(text) + 1.8


def draw_frames(sheet: DrawingSheet, frames: Sequence[Frame], at: Point) -> None:
    """Draw frames side by side, the first with its lower left corner at a place on paper."""
    x, y = at
    for frame in frames:
        _box(sheet, x, y, _HIGH + 0.8)
        SYMBOLS[frame.asks](sheet, (x + 0.5 * (_HIGH + 0.8), y + 0.5 * _HIGH))
        left = x + _HIGH + 0.8
        for text in frame.cells:
            _box(sheet, left, y, _cell(text))
            sheet.text(text, (left + 0.5 * _cell(text), y + 0.5 * _HIGH), 2.2, "MIDDLE_CENTER")
            left += _cell(text)
        x = left + 2.0


def _box(sheet: DrawingSheet, x: float, y: float, width: float) -> None:
    sheet.lines([(x, y), (x + width, y), (x + width, y + _HIGH), (x, y + _HIGH), (x, y)], "FINE")


def _circle(sheet: DrawingSheet, at: Point, radius: float) -> None:
    sheet.space.add_circle(sheet.at(at), radius / sheet.scale, dxfattribs={"layer": "FINE"})


def _position(sheet: DrawingSheet, at: Point) -> None:
    x, y = at
    _circle(sheet, at, 0.9)
    sheet.lines([(x - 1.6, y), (x + 1.6, y)], "FINE")
    sheet.lines([(x, y - 1.6), (x, y + 1.6)], "FINE")


def _coaxial(sheet: DrawingSheet, at: Point) -> None:
    _circle(sheet, at, 0.8)
    _circle(sheet, at, 1.5)


def _cylindrical(sheet: DrawingSheet, at: Point) -> None:
    x, y = at
    _circle(sheet, at, 0.9)
    for side in (-1.0, 1.0):
        sheet.lines([(x + 1.15 * side - 0.6, y - 1.5), (x + 1.15 * side + 0.6, y + 1.5)], "FINE")


def _run_out(sheet: DrawingSheet, at: Point) -> None:
    x, y = at
    sheet.lines([(x - 1.3, y - 1.3), (x + 1.3, y + 1.3)], "FINE")
    sheet.lines([(x + 0.2, y + 1.0), (x + 1.3, y + 1.3), (x + 1.0, y + 0.2)], "FINE")


def _profile(sheet: DrawingSheet, at: Point) -> None:
    x, y = at
    sheet.lines([(x - 1.5, y - 0.7), (x + 1.5, y - 0.7)], "FINE")
    sheet.space.add_arc(sheet.at((x, y - 0.7)), 1.5 / sheet.scale, 0.0, 180.0, dxfattribs={"layer": "FINE"})


SYMBOLS: dict[str, Callable[[DrawingSheet, Point], None]] = {
    "position": _position,
    "coaxial": _coaxial,
    "cylindrical": _cylindrical,
    "run-out": _run_out,
    "profile": _profile,
}
"""How each symbol is drawn about its middle, by what it asks: ISO 1101, table of symbols."""
