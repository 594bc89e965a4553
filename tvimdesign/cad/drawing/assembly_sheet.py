"""The general-assembly drawing: sections through every kind of part, plans, balloons and the list of parts."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, permutations, product
from math import degrees
from typing import Any, NamedTuple

import cadquery as cq
import numpy as np
from scipy.optimize import linear_sum_assignment

from tvimdesign import __version__
from tvimdesign.cad import cad_report
from tvimdesign.cad.assembly.bill_of_materials import Item
from tvimdesign.cad.drawing import drawing_sheet
from tvimdesign.cad.drawing.assembly_sections import AssemblySection, assembly_sections, outlines, pointed_at
from tvimdesign.cad.drawing.drawing_sheet import MARGIN, SIZES, TITLE_WIDTH, DrawingSheet, Field, figure, ratio
from tvimdesign.cad.drawing.placed_view import PlacedView
from tvimdesign.cad.drawing.projection import Point, View, seen
from tvimdesign.cad.drawing.sheet_layout import RADIUS, SCALES, Line, clearance, crosses, draw_balloon, towards
from tvimdesign.cad.export.mesh import Array, Instance
from tvimdesign.cad.geometry.kinds import SPRINGS, kind_of
from tvimdesign.cad.geometry.spring_solids import Coil, wire_edges

LIDS = ("cover", "link", "cover_screw", "link_screw", "link_dowel")
"""Kinds that the open plan is without."""
_WHOLE = ("screw", "pin", "dowel")  # Kinds with these ends are not hatched where they are cut along (ISO 128-3)
_STYLES = tuple((turned, apart) for apart in (2.5, 1.4, 4.0) for turned in (0.0, 90.0))
"""How hatching lines are turned [deg], and their distance [mm]."""
_RING, _PITCH = 13.0, 7.5  # Distance of balloons from a view, and from each other [mm]
_BESIDE = _RING + RADIUS + 3.0  # Room beside, above and below a view [mm]
_AROUND, _NAME = 2.0 * _BESIDE, 7.0  # Room on both its sides, and for its name below it [mm]
_LINE, _TEXT, _TITLE = 4.6, 2.3, 36.0  # Height of the list's lines, of its letters, and of the title block [mm]
_ROUND = 0.05  # Largest difference of width and depth of a round module [mm]
_COLUMNS = (1.5, 11.0, 20.0, 52.0)  # Where the list's columns begin [mm]
Size = tuple[float, float]


def assembly_sheet(
    module: str, items: Sequence[Item], solids: Mapping[str, cq.Solid], placed: Mapping[str, Instance],
    coils: Mapping[str, Coil],
) -> DrawingSheet:  # fmt: skip
    """Draw a module: `items` as the bill numbers them, `solids` and `placed` in their places by name.

    `coils` are the shapes of the springs on their pins, by kind.
    """
    sections, points = assembly_sections(placed), {name: instance.points() for name, instance in placed.items()}
    springs = {kind: _simplified(coil) for kind, coil in coils.items()}
    springs = {kind: spring.mirror("XZ") if kind == "spring_left" else spring for kind, spring in springs.items()}
    shown: dict[str, cq.Shape] = {
        name: springs[kind_of(name)].moved(solid.location()) if kind_of(name) in SPRINGS else solid
        for name, solid in solids.items()
    }
    opened = [shape for name, shape in shown.items() if kind_of(name) not in LIDS]
    fronts = [
        View((), tuple(line for part in section.parts.values() for line in outlines(part))) for section in sections
    ]
    plans = [seen(cq.Compound.makeCompound(shapes), (0, 0, 1)) for shapes in (shown.values(), opened)]
    at = _arrange([_size(view) for view in fronts], [_size(view) for view in plans], _LINE * (len(items) + 1))
    sheet = DrawingSheet(at.scale, at.form)
    removed = " and ".join(kind for kind in LIDS[:2] if kind in shown)
    names = [f"{section.letter} – {section.letter}" for section in sections]
    names += [f"{text}, {ratio(at.plan_scale)}" for text in ("from above", f"without {removed}")]
    drawn = list[PlacedView]()
    for view, name, corner in zip(
        [*fronts, *(plan.at_scale(at.plan_scale / at.scale) for plan in plans)], names, at.corners, strict=True
    ):
        left, right, bottom, _ = (bound * at.scale for bound in view.bounds)
        middle, level = corner[0] + _BESIDE - left, corner[1] + _BESIDE + _NAME - bottom
        drawn.append(PlacedView(sheet, view, (middle, level)))
        drawn[-1].draw()
        sheet.text(name, (middle + 0.5 * (left + right), corner[1] + 0.5 * _NAME), 3.5, "MIDDLE_CENTER")
    numbers = {number: item.solids for number, item in enumerate(items, start=1)}
    feet, styles = pointed_at(numbers, sections, at.scale), _styles(items, sections)
    for front, section, places in zip(drawn, sections, feet, strict=False):
        for line in section.behind(shown, points):
            front.curve(line, "FINE")
        for name, part in section.parts.items():
            for piece in [] if kind_of(name).endswith(_WHOLE) else part.decompose():
                front.hatch(outlines(piece), *styles[kind_of(name)])
        front.axis()
        on_paper = {number: [front.on_paper(*point) for point in there] for number, there in places.items()}
        for number, leader in balloon_leaders(on_paper, _slots(front, on_left=front is not drawn[0])).items():
            draw_balloon(sheet, number, leader)
    closed = drawn[len(sections)]
    marks = list[Any]()
    for section in sections:
        for azimuth, on_left in ((section.right, False), (section.left, True)):
            marks.append(closed.cutting_mark(section.letter, azimuth, closed.view.bounds[1], marks, on_left=on_left))
    for plan in drawn[-2:]:
        plan.centre_lines([])
    _dimension_envelope(drawn[0], closed, np.vstack(list(points.values())))
    _list_parts(sheet, items)
    _words(sheet, module, items, sections)
    return sheet


def _size(view: View) -> Size:
    left, right, bottom, top = view.bounds
    return right - left, top - bottom


def _simplified(coil: Coil) -> cq.Shape:
    """Return the right-hand spring as drawn from afar: a tube for its coils, and its leg."""
    half, low, leg = 0.5 * coil.wire_diameter, coil.start_level - 0.5 * coil.wire_diameter, wire_edges(coil)[-1]
    outer, inner = (
        cq.Solid.makeCylinder(0.5 * coil.diameter + aside, coil.end_level - low + half, cq.Vector(0, 0, low))
        for aside in (half, -half)
    )
    way = leg.endPoint() - leg.startPoint()
    return cq.Compound.makeCompound([outer.cut(inner), cq.Solid.makeCylinder(half, way.Length, leg.startPoint(), way)])


class _Arrangement(NamedTuple):
    form: str
    scale: float
    plan_scale: float
    corners: Sequence[Point]  # Lower left ones of the room of each section, then of each plan [mm]


def _arrange(sections: Sequence[Size], plans: Sequence[Size], table: float) -> _Arrangement:
    """Return the largest scale on the smallest sheet that shows the module doubled, or on the larger one.

    Sections, of such sizes [mm], stand below each other, plans in a row below them, as large as there is room for
    beside the table.
    """
    fits = list[_Arrangement]()
    for form, (width, height) in SIZES.items():
        room = width - 2.0 * MARGIN - TITLE_WIDTH - 4.0, height - 2.0 * MARGIN
        for scale, plan in ((scale, plan) for scale in SCALES for plan in SCALES if 0.2 * scale <= plan <= scale):
            views = [*([(scale, size)] for size in sections), [(plan, size) for size in plans]]
            rows = [[(_AROUND + by * x, _AROUND + _NAME + by * y) for by, (x, y) in row] for row in views]
            spare = room[1] - max(sum(max(high for _, high in row) for row in rows), _TITLE + table)
            gaps = [(room[0] - sum(wide for wide, _ in row)) / (len(row) + 1) for row in rows]
            if spare >= 0.0 and min(gaps) >= 0.0:
                level, corners = MARGIN + room[1], list[Point]()
                for row, gap in zip(rows, gaps, strict=True):
                    level -= max(high for _, high in row) + spare / (len(rows) + 1)
                    before = np.cumsum([gap, *(wide + gap for wide, _ in row[:-1])])
                    corners += [(MARGIN + x, level) for x in before.tolist()]
                fits.append(_Arrangement(form, scale, plan, corners))
                break
    return next((fit for fit in fits if fit.scale >= 2.0), max(fits, key=lambda fit: fit.scale))


def _styles(items: Sequence[Item], sections: Sequence[AssemblySection]) -> dict[str, tuple[float, float]]:
    """Return how each kind of part is hatched, by kind: unlike those that it touches in a section."""
    touching = set[tuple[str, ...]]()
    for section in sections:
        grown = {name: part.offset(0.1) for name, part in section.parts.items()}
        for names in combinations(grown, 2):
            if not (grown[names[0]] ^ grown[names[1]]).is_empty():
                touching |= set(permutations(map(kind_of, names)))
    styles = dict[str, tuple[float, float]]()
    for kind in (kind for item in items for kind in item.solids):
        taken = {styles[other] for own, other in touching if own == kind and other in styles}
        styles[kind] = next((style for style in _STYLES if style not in taken), _STYLES[-1])
    return styles


def balloon_leaders(feet: Mapping[int, Sequence[Point]], slots: Array) -> dict[int, Line]:
    """Return a leader from a foot of each number to a slot of its own [mm on paper]: those of the least total length.

    Such leaders do not cross each other: two that do could exchange their slots and be shorter.
    """
    numbers, leaders = list(feet), dict[int, Line]()
    ways = [np.hypot(*(np.array(feet[number])[:, None] - slots).transpose(2, 0, 1)) for number in numbers]
    cost = np.array([way.min(axis=0) for way in ways]).reshape(-1, len(slots))
    for _ in range(50):
        chosen = dict(zip(*(indices.tolist() for indices in linear_sum_assignment(cost)), strict=True))
        for row, slot in chosen.items():
            foot = feet[numbers[row]][int(ways[row][:, slot].argmin())]
            leaders[numbers[row]] = foot, (float(slots[slot, 0]), float(slots[slot, 1]))
        met = {number for pair in combinations(leaders.items(), 2) for number in _obstructed(*pair)}
        for row, slot in chosen.items():
            cost[row, slot] += 20.0 if numbers[row] in met else 0.0
        if not met:
            break
    return leaders


def _obstructed(*pair: tuple[int, Line]) -> Iterator[int]:
    """Yield which of two leaders meets the other one, or the other one's balloon."""
    stems = [(foot, towards(balloon, foot)) for _, (foot, balloon) in pair]
    for own, other in ((0, 1), (1, 0)):
        if crosses(*stems) or clearance(pair[other][1][1], stems[own]) < RADIUS + 0.6:
            yield pair[own][0]


def _slots(view: PlacedView, *, on_left: bool) -> Array:
    """Return places for balloons above, below and beside a view [mm on paper]."""
    left, right, bottom, top = view.view.bounds
    (left, bottom), (right, top) = view.on_paper(left, bottom), view.on_paper(right, top)
    across, upright = np.arange(left, right + 1.0, _PITCH), np.arange(bottom, top + 1.0, _PITCH)
    sides = (right + _RING, left - _RING) if on_left else (right + _RING,)
    return np.array([*product(across, (bottom - _RING, top + _RING)), *product(sides, upright)])


def _dimension_envelope(front: PlacedView, plan: PlacedView, points: Array) -> None:
    """Dimension the height left of the first section; diameter, or width and depth, at the plan."""
    looks: dict[str, Any] = {"dimstyle": "SHEET", "dxfattribs": {"layer": "DIMENSION"}}
    (width, depth, height), bottom, x = np.ptp(points, axis=0), float(points[:, 2].min()), front.view.bounds[0]
    west, east, south, north = plan.view.bounds
    upright = [(front.at(x - front.paper(8.0), 0.0), front.at(x, bottom), front.at(x, bottom + height), height)]
    if abs(width - depth) > _ROUND:
        upright.append((plan.at(east + plan.paper(15.0), 0.0), plan.at(east, south), plan.at(east, north), depth))
    for base, start, end, size in upright:
        front.sheet.space.add_linear_dim(base, start, end, text=figure(size), angle=90, **looks).render()
    across, text = (plan.at(west, north), plan.at(east, north)), f"{'⌀' * (len(upright) == 1)}{figure(width)}"
    plan.sheet.space.add_linear_dim(plan.at(0.0, north + plan.paper(15.0)), *across, text=text, **looks).render()


def _list_parts(sheet: DrawingSheet, items: Sequence[Item]) -> None:
    """Draw the list of parts over the title block, the first item on top: numbers, quantities, kinds, titles."""
    left, level = sheet.size[0] - MARGIN - TITLE_WIDTH, MARGIN + _TITLE
    lines = [("Item", "Qty", "Part", "Material or designation")]
    for number, item in enumerate(items, start=1):
        title = sheet.cut_short(item.title, TITLE_WIDTH - _COLUMNS[-1] - 2.0, _TEXT)
        lines.append((str(number), str(item.quantity), item.kind.replace("_", " "), title))
    for line in reversed(lines):
        for column, text in zip(_COLUMNS, line, strict=True):
            sheet.text(text, (left + column, level + 1.2), _TEXT)
        level += _LINE
        sheet.lines([(left, level), (left + TITLE_WIDTH, level)], "FINE")
    sheet.lines([(left, MARGIN), (left, level), (left + TITLE_WIDTH, level)], "FRAME")


def _words(sheet: DrawingSheet, module: str, items: Sequence[Item], sections: Sequence[AssemblySection]) -> None:
    """Write notes and title block."""
    planes = [
        f"{section.letter} – {section.letter}: half planes at {figure(degrees(section.right) % 360.0)}° (right) and "
        f"{figure(degrees(section.left) % 360.0)}° (left), turned into one plane. Thin: what lies behind."
        for section in sections
    ]
    files = cad_report.BILL_OF_MATERIALS, cad_report.ASSEMBLY_NOTE, cad_report.ASSEMBLY_STEP
    notes = [
        "Millimetres. Azimuths count from x, to the right, counter-clockwise in the plan.", *planes,
        "Screws and pins are not hatched; springs behind the section and in the plan are simplified.",
        "Items as in {}; steps and torques: {}; exact shapes: {}.".format(*files),
    ]  # fmt: skip
    sheet.column(notes, (sheet.size[0] - MARGIN - TITLE_WIDTH, sheet.size[1] - MARGIN - 2.0))
    contents = [module, *notes, *(f"{item.kind} {item.quantity} {item.title} {item.mass:.2f}" for item in items)]
    cut = (cut for section in sections for cut in section.parts.items())
    contents += [f"{name} {part.area():.2f} {np.round(part.bounds(), 2).tolist()}" for name, part in cut]
    mass = sum(item.mass * item.quantity for item in items)
    sheet.title_block(
        "assembly",
        [
            drawing_sheet.issue_fields("Approved", drawing_sheet.sheet_number("assembly", contents)),
            [Field("Made by", f"tvimdesign {__version__}", 0.5),
             Field("Size, projection", f"{sheet.form}, first angle", 0.3), Field("Sheet", "1 of 1", 0.2)],
            [Field("Module", module, 0.5), Field("Mass", f"{mass:.1f} g", 0.3),
             Field("Scale", ratio(sheet.scale), 0.2)],
        ],
    )  # fmt: skip
