"""The drawing of a part for a workshop: section and plan with what was read off the solid as dimensions."""

from __future__ import annotations

from collections.abc import Sequence

import cadquery as cq

from tvimdesign import __version__
from tvimdesign.cad.assembly import file_names
from tvimdesign.cad.drawing.call_outs import call_out, sized
from tvimdesign.cad.drawing.drawing_requirements import DrawingRequirements, Seat, ThreadCallout
from tvimdesign.cad.drawing.drawing_sheet import MARGIN, SIZE, TITLE_WIDTH, DrawingSheet, Field, ratio, to_fill_in
from tvimdesign.cad.drawing.number_text import figure
from tvimdesign.cad.drawing.placed_view import PlacedView, apart
from tvimdesign.cad.drawing.projection import View, from_above, section
from tvimdesign.cad.export.step_file import Product
from tvimdesign.cad.geometry.features import Cylinder, levels, upright_cylinders
from tvimdesign.cad.geometry.production import PRODUCTION

_SCALES = (10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1)
_WIDE, _HIGH = 165.0, 256.0
"""Room on the sheet for the two views with their dimensions [mm]."""
_MIDDLE = 132.0
"""Where the views' middle is across the sheet [mm]."""
_FIRST, _NEXT, _GAP, _BOTTOM = 8.0, 6.5, 18.0, 22.0
_OVER_TITLE = 65.0
"""Height on the sheet above which there is room beside the plan [mm]."""
_LINE = 4.6
"""Height of its lines [mm]."""
_COLUMNS = (0.0, 5.0, 43.0, 64.0, 87.0, 119.0, 129.0)
"""Where the columns of the table over the title block begin [mm]."""
_SEATS = ("", "Seat", "fit", "deviations µm", "limits of size", "Ra µm", "form")
_THREADS = ("", "Thread", "size", "hole", "hole's depth", "", "length of thread")


def part_sheet(kind: str, solid: cq.Solid, what: Product, module: str, asked: DrawingRequirements) -> DrawingSheet:
    """Draw a part: section A-A above, plan below it, first angle; levels, diameters and holes, fits and threads."""
    plan, front = from_above(solid), section(solid)
    found = upright_cylinders(solid)
    central = {2.0 * one.radius: one for one in found if one.is_central and one.is_round}
    diameters = sorted(central)
    scale = _scale(plan, front, len(diameters))
    sheet = DrawingSheet(scale)
    left, right, bottom, top = plan.bounds
    height = (top - bottom + front.bounds[3] - front.bounds[2]) * scale + _taken(len(diameters))
    below = _BOTTOM + 0.5 * max(_HIGH - height, 0.0)
    plan_at = (_MIDDLE - 0.5 * (left + right) * scale, below - bottom * scale)
    front_at = (plan_at[0], plan_at[1] + top * scale + _GAP - front.bounds[2] * scale)
    placed_plan, placed_front = PlacedView(sheet, plan, plan_at), PlacedView(sheet, front, front_at)
    placed_plan.draw()
    placed_front.draw()
    placed_plan.centre_lines([one for one in found if one.is_round])
    placed_front.axis()
    sheet.text("A – A", (_MIDDLE, front_at[1] + front.bounds[2] * scale - 4.5), 3.5, "MIDDLE_CENTER")
    placed_plan.cutting_line()
    _dimension_diameters(placed_front, [central[diameter] for diameter in diameters], asked)
    _dimension_extent(placed_front, diameters)
    _dimension_levels(placed_front, levels(solid))
    _words(sheet, kind, solid, what, module, asked)
    call_out(placed_plan, found, solid, asked, low=_table(sheet, asked))
    return sheet


def _scale(plan: View, front: View, diameters: int) -> float:
    """The largest usual scale at which both views have room."""
    left, right, bottom, top = plan.bounds
    height = top - bottom + front.bounds[3] - front.bounds[2]
    taken = _taken(diameters)
    fits = [scale for scale in _SCALES if (right - left) * scale <= _WIDE and height * scale + taken <= _HIGH]
    return fits[0] if fits else _SCALES[-1]


def _taken(diameters: int) -> float:
    """Height on paper that the views' dimensions and the gap between them take."""
    return _FIRST + _NEXT * (diameters + 1) + _GAP


def _dimension_diameters(front: PlacedView, round_faces: Sequence[Cylinder], asked: DrawingRequirements) -> None:
    """Diameters about the axis with their fits, the smallest nearest, above the section; the datum beside its own."""
    top, left = front.view.bounds[3], front.view.bounds[0]
    for index, one in enumerate(round_faces):
        level, diameter = top + front.paper(_FIRST + index * _NEXT), 2.0 * one.radius
        ends = (front.at(-one.radius, top), front.at(one.radius, top))
        front.sheet.space.add_linear_dim(
            front.at(0.0, level), *ends, text=sized(one, asked), dimstyle="SHEET", dxfattribs={"layer": "DIMENSION"}
        ).render()
        seat = asked.seat(diameter)
        if seat and seat.letter:
            front.datum(seat.letter, (-one.radius, level), left - front.paper(12.0))


def _dimension_extent(front: PlacedView, diameters: Sequence[float]) -> None:
    """Overall length, where no diameter says it, and overall height."""
    left, right, bottom, top = front.view.bounds
    space = front.sheet.space
    if all(abs(right - left - diameter) > 1e-3 for diameter in diameters):
        base = front.at(0.0, top + front.paper(_FIRST + len(diameters) * _NEXT))
        ends = front.at(left, top), front.at(right, top)
        space.add_linear_dim(base, *ends, dimstyle="SHEET", dxfattribs={"layer": "DIMENSION"}).render()
    base = front.at(left - front.paper(10.0), 0.0)
    ends = front.at(left, bottom), front.at(left, top)
    space.add_linear_dim(base, *ends, angle=90, dimstyle="SHEET", dxfattribs={"layer": "DIMENSION"}).render()


def _dimension_levels(front: PlacedView, heights: Sequence[float]) -> None:
    """Heights of the flat faces over the lowest, right of the section, their figures apart from each other."""
    right = front.view.bounds[1] + front.paper(2.0)
    places = apart(heights, front.paper(4.2))
    lowest = front.at(0.0, front.view.bounds[2])
    for height, place in zip(heights, places, strict=True):
        front.sheet.space.add_ordinate_y_dim(
            front.at(right, height), (front.paper(14.0), place - height), origin=lowest, dimstyle="SHEET",
            dxfattribs={"layer": "DIMENSION"},
        ).render()  # fmt: skip


def _table(sheet: DrawingSheet, asked: DrawingRequirements) -> float:
    """Seats and threads over the title block; returns the height on the sheet that is free above."""
    rows = [*([_SEATS] if asked.seats else []), *map(_seat_row, asked.seats),
            *([_THREADS] if asked.threads else []), *map(_thread_row, asked.threads)]  # fmt: skip
    left = SIZE[0] - MARGIN - TITLE_WIDTH
    for index, cells in enumerate(reversed(rows)):
        level = _OVER_TITLE + index * _LINE
        for place, text in zip(_COLUMNS, cells, strict=True):
            if text:
                sheet.text(text, (left + place, level), 1.8 if cells in (_SEATS, _THREADS) else 2.5)
    return _OVER_TITLE + len(rows) * _LINE + 4.0


def _seat_row(one: Seat) -> tuple[str, ...]:
    """What the table says of a seat."""
    if not one.fit:
        return one.letter, one.about, f"⌀{figure(one.drawn)}", "as drawn", "general", f"{one.roughness:g}", one.form
    lower, upper = (f"{1e3 * limit:+.4g}" if limit else "0" for limit in one.limits)
    within = f"{one.size + one.limits.lower:.3f} to {one.size + one.limits.upper:.3f}"
    return (
        one.letter,
        one.about,
        f"⌀{figure(one.size)} {one.fit}",
        f"{upper} / {lower}",
        within,
        f"{one.roughness:g}",
        one.form,
    )


def _thread_row(one: ThreadCallout) -> tuple[str, ...]:
    """What the table says of a thread."""
    return "", one.about, one.screw, f"⌀{figure(one.hole)}", figure(one.depth), "", f"{figure(one.length)}, {one.made}"


def _words(
    sheet: DrawingSheet, kind: str, solid: cq.Solid, what: Product, module: str, asked: DrawingRequirements
) -> None:
    """Notes and title block."""
    volume = solid.Volume()
    lying = "standing as in the section" if PRODUCTION[kind].down == "bottom" else "turned over"
    notes = [
        "Millimetres. Heights h, and those beside the section, are over the lowest face.",
        "Section A – A is taken through the module's axis; azimuths count from x, to the right.",
        f"What is not dimensioned: {file_names.step(kind)}.",
        *asked.notes,
        *([f"Printing: {lying}; print/ has it so, with wider holes."] if asked.printed else []),
    ]  # fmt: skip
    sheet.column(notes, (256.0, SIZE[1] - 14.0))
    sheet.title_block(
        kind.replace("_", " "),
        [
            to_fill_in("Approved", "Number", "Revision", "Date"),
            [Field("Made by", f"tvimdesign {__version__}", 0.5), Field("Size, projection", "A3, first angle", 0.3),
             Field("Sheet", "1 of 1", 0.2)],
            [Field("General tolerances", asked.tolerances, 0.65), Field("Surface, Ra in µm", asked.surface, 0.35)],
            [Field("Mass", f"{volume * what.density * 1e-6:.2f} g", 0.25),
             Field("Volume", f"{volume * 1e-3:.3f} cm³", 0.25),
             Field("Density", f"{what.density:g} kg/m³", 0.3), Field("Scale", ratio(sheet.scale), 0.2)],
            [Field("Material", what.material, 0.5), Field("Module", module, 0.5)],
        ],
    )  # fmt: skip
