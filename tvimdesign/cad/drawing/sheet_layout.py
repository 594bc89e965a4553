"""Layout of a part's views: the sheet, its scale, each view's origin, and the table of features."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tvimdesign.cad.drawing.drawing_requirements import DATUM, DrawingRequirements, Seat
from tvimdesign.cad.drawing.drawing_sheet import MARGIN, SIZES, TITLE_WIDTH, DrawingSheet, figure
from tvimdesign.cad.drawing.feature_rows import FeatureRow
from tvimdesign.cad.drawing.iso_1101 import draw_frames
from tvimdesign.cad.drawing.projection import View

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
    """Return the height on paper that both tables take [mm]."""
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
    """Return whether a second line is needed."""
    return bool(row.asks or row.frames)


def _draw_seat(sheet: DrawingSheet, one: Seat, at: tuple[float, float]) -> None:
    """Write the table's line of a seat."""
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
    """Return the rows, the first arc about the axis told as datum: for a part, such as a link, with no round face
    about it."""
    told = list(rows)
    for index, row in enumerate(rows):
        if row.place.startswith("about the axis"):
            told[index] = replace(row, asks=f"datum {DATUM}: its axis")
            break
    return told


_SCALES = (20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1)
"""Of ISO 5455."""
_LARGE = 2.0
"""Scale from which the smaller sheet will do."""
FIRST, NEXT = 8.0, 6.5
"""Height of the first dimension over a section, and of each further one over that [mm]."""
_LEFT, _LEVELS, _BETWEEN, _BELOW = 24.0, 36.0, 24.0, 18.0
"""Room left of the views, right of a section for its heights, between section and plan, and below the plan [mm]."""
_NOTES = 44.0
"""Height that notes take over the tables [mm]."""


@dataclass(frozen=True)
class Layout:
    """Places of the views' origins on a sheet [mm]."""

    form: str
    scale: float
    plan: tuple[float, float]
    front: tuple[float, float]
    half: tuple[float, float]
    """Of the half section beside the front view."""
    room: tuple[float, float, float, float]
    """Where numbers may stand around the plan: least and largest x, then y."""


def layout(plan: View, front: View, half: View | None, diameters: int, table: float) -> Layout:
    """Return the largest standard scale on the smallest sheet that shows the part doubled, or on the larger sheet."""
    over = FIRST + NEXT * (diameters + 1)
    best = [(_scale_on(size, plan, front, half, over, table), name) for name, size in SIZES.items()]
    scale, form = next((one for one in best if one[0] >= _LARGE), max(best, key=lambda one: one[0]))
    scale = scale or _SCALES[-1]
    wide, high = _needed(plan, front, half, over, scale)
    right, top = SIZES[form][0] - MARGIN - TITLE_WIDTH - 6.0, SIZES[form][1] - MARGIN
    start = MARGIN + 0.5 * max(right - MARGIN - wide, 0.0) + _LEFT
    level = MARGIN + 0.5 * max(top - MARGIN - high, 0.0) + _BELOW
    x = start - min(plan.bounds[0], front.bounds[0]) * scale
    plan_at = (x, level - plan.bounds[2] * scale)
    front_at = (x, plan_at[1] + plan.bounds[3] * scale + _BETWEEN - front.bounds[2] * scale)
    half_x = x + front.bounds[1] * scale + _LEVELS - (min(half.bounds[0], 0.0) * scale if half else 0.0)
    bottom_of_front = front_at[1] + front.bounds[2] * scale
    room = (MARGIN + 4.0, right - 2.0, MARGIN + 4.0, bottom_of_front - 10.0)
    return Layout(form, scale, plan_at, front_at, (half_x, front_at[1]), room)


def _needed(plan: View, front: View, half: View | None, over: float, scale: float) -> tuple[float, float]:
    """Return width and height on paper of all views with their dimensions."""
    section = (front.bounds[1] - front.bounds[0] + (half.bounds[1] if half else 0.0)) * scale + _LEVELS
    wide = _LEFT + max(section, (plan.bounds[1] - plan.bounds[0]) * scale + _LEFT)
    high = (plan.bounds[3] - plan.bounds[2] + front.bounds[3] - front.bounds[2]) * scale
    return wide, high + _BELOW + _BETWEEN + over


def _scale_on(
    size: tuple[float, float], plan: View, front: View, half: View | None, over: float, table: float
) -> float:
    """Return the largest scale at which a sheet has room for views and table; 0 where it has none."""
    width, height = size[0] - 2.0 * MARGIN - TITLE_WIDTH - 6.0, size[1] - 2.0 * MARGIN
    if OVER_TITLE - MARGIN + table + _NOTES > height:
        return 0.0
    for scale in _SCALES:
        wide, high = _needed(plan, front, half, over, scale)
        if wide <= width and high <= height:
            return scale
    return 0.0
