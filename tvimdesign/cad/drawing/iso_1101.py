"""Tolerance frames by ISO 1101 and the marks of datums by ISO 5459, drawn as lines: no font has all their symbols."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

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


def _cell(text: str) -> float:
    return _LETTER * len(text) + 1.8


def draw_frames(sheet: DrawingSheet, frames: Sequence[Frame], at: Point) -> None:
    """Draw frames side by side, the first with its lower left corner at a place on paper."""
    x, y = at
    for frame in frames:
        _box(sheet, x, y, _HIGH + 0.8)
        SYMBOLS[frame.asks].draw(sheet, (x + 0.5 * (_HIGH + 0.8), y + 0.5 * _HIGH))
        left = x + _HIGH + 0.8
        for text in frame.cells:
            _box(sheet, left, y, _cell(text))
            sheet.text(text, (left + 0.5 * _cell(text), y + 0.5 * _HIGH), 2.2, "MIDDLE_CENTER")
            left += _cell(text)
        x = left + 2.0


def _box(sheet: DrawingSheet, x: float, y: float, width: float) -> None:
    sheet.lines([(x, y), (x + width, y), (x + width, y + _HIGH), (x, y + _HIGH), (x, y)], "FINE")


class Symbol(NamedTuple):
    """A symbol about its middle [mm]: radii of circles, lines, and the radius of a half circle on a base line."""

    circles: tuple[float, ...] = ()
    lines: tuple[tuple[Point, ...], ...] = ()
    arch: float = 0.0

    def draw(self, sheet: DrawingSheet, at: Point) -> None:
        """Draw it about a place on paper."""
        x, y = at
        for radius in self.circles:
            sheet.space.add_circle(sheet.at(at), radius / sheet.scale, dxfattribs={"layer": "FINE"})
        for line in self.lines:
            sheet.lines([(x + right, y + up) for right, up in line], "FINE")
        if self.arch:
            base = sheet.at((x, y + self.lines[0][0][1]))
            sheet.space.add_arc(base, self.arch / sheet.scale, 0.0, 180.0, dxfattribs={"layer": "FINE"})


SYMBOLS = {
    "position": Symbol((0.9,), (((-1.6, 0.0), (1.6, 0.0)), ((0.0, -1.6), (0.0, 1.6)))),
    "coaxial": Symbol((0.8, 1.5)),
    "cylindrical": Symbol((0.9,), (((-1.75, -1.5), (-0.55, 1.5)), ((0.55, -1.5), (1.75, 1.5)))),
    "run-out": Symbol((), (((-1.3, -1.3), (1.3, 1.3)), ((0.2, 1.0), (1.3, 1.3), (1.0, 0.2)))),
    "profile": Symbol((), (((-1.5, -0.7), (1.5, -0.7)),), 1.5),
}
"""By what each asks: ISO 1101, table of symbols."""
