"""The drawing of a part for a workshop: sections and plan with what was read off the solid as dimensions."""

from collections.abc import Sequence
from math import cos, radians, sin

import cadquery as cq
from cadquery.occ_impl.exporters.dxf import DxfDocument

from tvimdesign import __version__
from tvimdesign.cad import cad_report
from tvimdesign.cad.drawing import drawing_sheet, sheet_layout
from tvimdesign.cad.drawing.drawing_requirements import DATUM, GROUND, DrawingRequirements
from tvimdesign.cad.drawing.drawing_sheet import DrawingSheet, Field, figure, ratio
from tvimdesign.cad.drawing.feature_rows import FeatureRow, feature_rows, sized
from tvimdesign.cad.drawing.iso_1101 import draw_frames
from tvimdesign.cad.drawing.placed_view import CuttingMark, PlacedView, apart
from tvimdesign.cad.drawing.projection import View, from_above, from_below, half_section, section
from tvimdesign.cad.export.step_file import Product
from tvimdesign.cad.geometry.features import Cylinder, levels, upright_cylinders
from tvimdesign.cad.geometry.kinds import PRODUCTION
from tvimdesign.cad.parts import jigs

_PLATE = 1e-6  # Largest deviation of a plate's volume from area times thickness, relative
_BESIDE = ("pocket", "raised sector", "thread", "hole", "slot")
"""Features that are looked for beside the section's plane, the first before the others.

The row of a thread describes it in full; a vane, with its slots and steps, is seen only where it is cut.
"""
_FOR_NUMBERS = 14.0  # Room between plan and underside, and below that for its name [mm]
_AZIMUTHS = "Azimuths count from x, to the right, counter-clockwise in the plan."
_SAME = 1e-3  # Difference of sizes that are one [mm]
_WALLS = "Walls: distance of their plane from the axis, azimuth of the way they face."


def part_sheet(
    kind: str, solid: cq.Solid, what: Product, module: str, requirements: DrawingRequirements, material: str = ""
) -> DrawingSheet:
    """Draw a part: section A-A above, plan below it, first angle, beside it a half section D-D where A-A meets not all.

    `material` is what the catalogue calls it, by default the record's name.
    """
    plan, front = from_above(solid), section(solid)
    cylinders = upright_cylinders(solid)
    about_axis = [face for face in cylinders if face.is_central and face.is_round]
    # Of two with one diameter that which is a seat is dimensioned.
    central = {
        2.0 * face.radius: face for face in sorted(about_axis, key=lambda face: requirements.seat(face) is not None)
    }
    rows = feature_rows(solid, requirements)
    rows = sheet_layout.with_datum(rows) if requirements.general and not central else rows
    beside = _beside(rows)
    half = half_section(solid, beside) if beside else None
    heights, table = levels(solid), sheet_layout.table_height(rows, requirements)
    place = sheet_layout.layout(plan, front, half, len(central), table)
    sheet = DrawingSheet(place.scale, place.form)
    placed_plan, placed_front = PlacedView(sheet, plan, place.plan), PlacedView(sheet, front, place.front)
    marks = _draw_plan(placed_plan, cylinders, requirements, half, beside)
    _draw_section(placed_front, "A – A", solid, cylinders, requirements, 0.0)
    if half:
        _draw_section(PlacedView(sheet, half, place.half), "D – D", solid, cylinders, requirements, beside)
    if requirements.general:
        placed_front.ground(GROUND)
    _dimension_diameters(placed_front, [central[diameter] for diameter in sorted(central)], requirements)
    _dimension_extent(placed_front, sorted(central), heights)
    _dimension_levels(placed_front, heights)
    sheet_layout.draw_tables(sheet, rows, requirements)
    room = _draw_underside(placed_plan, solid, place.room) if plan.hidden else place.room
    sheet_layout.draw_balloons(placed_plan, rows, room, marks)
    _words(sheet, kind, solid, what, module, requirements, material or what.material, rows)
    return sheet


def _beside(rows: Sequence[FeatureRow]) -> float:
    """Return azimuth [rad] at which a half section cuts what the section along x does not; 0 where that cuts all."""
    for what in _BESIDE:
        for row in rows:
            if row.what == what and row.azimuths and all(abs(azimuth % 180.0) > 0.5 for azimuth in row.azimuths):
                return radians(min(row.azimuths))
    return 0.0


def _draw_plan(
    plan: PlacedView, cylinders: Sequence[Cylinder], requirements: DrawingRequirements, half: View | None, beside: float
) -> list[CuttingMark]:
    """Draw the view from above with axes, threads, and where the sections are taken; return the marks of these."""
    plan.draw()
    plan.centre_lines([face for face in cylinders if face.is_round])
    threaded = [face for face in cylinders if face.is_round and requirements.thread(face)]
    plan.threads([(face.x, face.y, _screw(face, requirements)) for face in threaded])
    left, right = plan.view.bounds[:2]
    marks = [plan.cutting_mark("A", 0.0, right), plan.cutting_mark("A", radians(180.0), -left, on_left=True)]
    return [*marks, plan.cutting_mark("D", beside, half.bounds[1], marks)] if half else marks


def _draw_underside(plan: PlacedView, solid: cq.Solid, room: sheet_layout.Room) -> sheet_layout.Room:
    """Draw the view from below right of the plan, at the largest standard scale for which there is room.

    Return the room that is left around the plan.
    """
    sheet, whole, (left, right, bottom, top) = plan.sheet, from_below(solid), room
    start = plan.on_paper(plan.view.bounds[1], 0.0)[0] + _FOR_NUMBERS
    wide, high = whole.bounds[1] - whole.bounds[0], whole.bounds[3] - whole.bounds[2]
    fits = [
        size
        for size in sheet_layout.SCALES
        if size * wide <= right - start and size * high + _FOR_NUMBERS <= top - bottom
    ]
    if not fits:
        return room
    scale = min(fits[0], sheet.scale)
    view = whole.at_scale(scale / sheet.scale)
    middle = min(max(plan.origin[1], bottom - whole.bounds[2] * scale + _FOR_NUMBERS), top - whole.bounds[3] * scale)
    placed = PlacedView(sheet, view, (right - whole.bounds[1] * scale, middle))
    placed.draw()
    name = f"from below, {ratio(scale)}"
    sheet.text(
        name, placed.on_paper(0.5 * sum(view.bounds[:2]), view.bounds[2] - plan.paper(6.0)), 3.5, "MIDDLE_CENTER"
    )
    return left, placed.on_paper(view.bounds[0], 0.0)[0] - 4.0, bottom, top


def _screw(hole: Cylinder, requirements: DrawingRequirements) -> float:
    """Return the diameter of the screw of a threaded hole [mm]."""
    thread = requirements.thread(hole)
    return float(thread.screw.removeprefix("M")) if thread else 0.0


def _draw_section(
    view: PlacedView, name: str, solid: cq.Solid, cylinders: Sequence[Cylinder], requirements: DrawingRequirements,
    azimuth: float,
) -> None:  # fmt: skip
    """Draw a section with its name, the module's axis, and the threads that it cuts."""
    view.draw()
    view.axis()
    scale, (x, y) = view.sheet.scale, view.origin
    left, right, bottom, _ = view.view.bounds
    view.sheet.text(name, (x + 0.5 * (left + right) * scale, y + bottom * scale - 6.0), 3.5, "MIDDLE_CENTER")
    for face in cylinders:
        thread = requirements.thread(face) if face.is_round else None
        # Where the hole stands in the plane of the section: before it, and to its right.
        along = face.x * cos(azimuth) + face.y * sin(azimuth)
        aside = face.y * cos(azimuth) - face.x * sin(azimuth)
        if thread and abs(aside) < 1e-3 and (not azimuth or along > 1e-3):
            is_open_below = not solid.isInside(cq.Vector(face.x, face.y, face.bottom - 1e-2))
            mouth, way = (face.bottom, 1.0) if is_open_below else (face.top, -1.0)
            view.cut_thread(along, _screw(face, requirements), mouth, mouth + way * thread.length)


def _dimension_diameters(front: PlacedView, round_faces: Sequence[Cylinder], requirements: DrawingRequirements) -> None:
    """Dimension diameters about the axis with their fits, the smallest nearest, above the section.

    The datum beside its own.
    """
    top, left = front.view.bounds[3], front.view.bounds[0]
    seats = [requirements.seat(face) for face in round_faces]
    has_seat = any(seat and seat.letter for seat in seats)
    for index, (face, seat) in enumerate(zip(round_faces, seats, strict=True)):
        level = top + front.paper(sheet_layout.FIRST + index * sheet_layout.NEXT)
        size, ends = sized(face, requirements), (front.at(-face.radius, top), front.at(face.radius, top))
        front.sheet.space.add_linear_dim(
            front.at(0.0, level), *ends, text=size, dimstyle="SHEET", dxfattribs={"layer": "DIMENSION"}
        ).render()
        # Without a seat the largest round face is what the part is held by, and measured from.
        if (seat and seat.letter) or (requirements.general and not has_seat and face is round_faces[-1]):
            front.datum(DATUM, (-face.radius, level), left - front.paper(12.0))


def _dimension_extent(front: PlacedView, diameters: Sequence[float], heights: Sequence[float]) -> None:
    """Dimension the overall length and height, where no diameter and no level gives them."""
    left, right, bottom, top = front.view.bounds
    space = front.sheet.space
    if all(abs(right - left - diameter) > _SAME for diameter in diameters):
        base = front.at(0.0, top + front.paper(sheet_layout.FIRST + len(diameters) * sheet_layout.NEXT))
        ends = front.at(left, top), front.at(right, top)
        space.add_linear_dim(
            base, *ends, text=figure(right - left), dimstyle="SHEET", dxfattribs={"layer": "DIMENSION"}
        ).render()
    if any(abs(top - height) < _SAME for height in heights):
        return
    base = front.at(left - front.paper(10.0), 0.0)
    ends = front.at(left, bottom), front.at(left, top)
    space.add_linear_dim(
        base, *ends, text=figure(top - bottom), angle=90, dimstyle="SHEET", dxfattribs={"layer": "DIMENSION"}
    ).render()


def _dimension_levels(front: PlacedView, heights: Sequence[float]) -> None:
    """Dimension heights of the flat faces over the lowest, right of the section, their figures apart from each other.

    Running dimensions by ISO 129-1: a small circle marks the origin.
    """
    right, bottom = front.view.bounds[1] + front.paper(2.0), front.view.bounds[2]
    places = apart(heights, front.paper(4.2))
    lowest = front.at(0.0, bottom)
    front.sheet.space.add_circle(front.at(right, bottom), front.paper(0.9), dxfattribs={"layer": "DIMENSION"})
    for height, place in zip(heights, places, strict=True):
        front.sheet.space.add_ordinate_y_dim(
            front.at(right, height), (front.paper(14.0), place - height), origin=lowest, text=figure(height - bottom),
            dimstyle="SHEET", dxfattribs={"layer": "DIMENSION"},
        ).render()  # fmt: skip


def _words(
    sheet: DrawingSheet, kind: str, solid: cq.Solid, what: Product, module: str, requirements: DrawingRequirements,
    material: str, rows: Sequence[FeatureRow],
) -> None:  # fmt: skip
    """Write notes and title block."""
    volume = solid.Volume()
    making = jigs.MAKING.get(kind) or PRODUCTION[kind]
    lying = "standing as in the section" if making.down == "bottom" else "turned over"
    notes = [
        "Millimetres. Heights h are over the lowest face; in brackets what lies between.",
        *([_AZIMUTHS] if any("°" in row.place for row in rows) else []),
        *([_WALLS] if any(row.what == "wall" for row in rows) else []),
        f"Exact shape: {cad_report.step(kind)}.",
        *requirements.notes,
        *([f"Printing: {lying}; print/ has it so, with wider holes."] if requirements.printed else []),
    ]
    # What decides whether a part is another one, to the figures that are printed.
    contents = [
        material, requirements.tolerances, requirements.surface, f"{volume:.1f}", *notes,
        *(row.text + row.asks for row in rows), *map(repr, requirements.seats),
    ]  # fmt: skip
    left = sheet.size[0] - drawing_sheet.MARGIN - drawing_sheet.TITLE_WIDTH
    sheet.column(notes, (left, sheet.size[1] - drawing_sheet.MARGIN - 2.0))
    sheet.title_block(
        kind.replace("_", " "),
        [
            drawing_sheet.issue_fields("Approved", drawing_sheet.sheet_number(kind, contents)),
            [Field("Made by", f"tvimdesign {__version__}", 0.5),
             Field("Size, projection", f"{sheet.form}, first angle", 0.3), Field("Sheet", "1 of 1", 0.2)],
            [Field("General tolerances", requirements.tolerances, 0.65),
             Field("Surface, Ra in µm", requirements.surface, 0.35)],
            [Field("Mass", f"{volume * what.density * 1e-6:.2f} g", 0.25),
             Field("Volume", f"{volume * 1e-3:.3f} cm³", 0.25),
             Field("Density", f"{what.density:g} kg/m³", 0.3), Field("Scale", ratio(sheet.scale), 0.2)],
            [Field("Material", material, 0.5), Field("Module", module, 0.5)],
        ],
    )  # fmt: skip
    draw_frames(sheet, requirements.general, (left + 66.0, drawing_sheet.MARGIN + 2.0 * drawing_sheet.TITLE_ROW + 1.0))


def plate_outline(solid: cq.Solid) -> bytes | None:
    """Return what a laser or a water jet cuts of a plate, as DXF without a word; None where a part is no plate.

    A plate has two flat faces of one area, their distance apart, which enclose all of its volume.
    """
    faces = sorted((face for face in solid.Faces() if face.geomType() == "PLANE"), key=cq.Face.Area)[-2:]
    if len(faces) < 2:
        return None
    below, above = faces
    apart = abs((above.Center() - below.Center()).dot(above.normalAt()))
    if abs(below.Area() * apart / solid.Volume() - 1.0) > _PLATE or abs(below.Area() / above.Area() - 1.0) > _PLATE:
        return None
    with drawing_sheet.undated():
        drawn = DxfDocument("R2010", doc_units=4)
        drawn.add_shape(cq.Workplane(cq.Plane(above.Center(), normal=above.normalAt())).newObject([above]))
    return drawing_sheet.dxf_bytes(drawn.document)
