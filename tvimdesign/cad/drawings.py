"""The drawing of a part for a workshop: section and plan with what was read off the solid as dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, pi, sin

import cadquery as cq

from tvimdesign import __version__
from tvimdesign.cad import names
from tvimdesign.cad.features import Cylinder, levels, upright_cylinders
from tvimdesign.cad.figures import around, figure
from tvimdesign.cad.making import MAKING
from tvimdesign.cad.projection import View, from_above, section
from tvimdesign.cad.sheet import SIZE, Field, Sheet, ratio
from tvimdesign.cad.step import Product

_SCALES = (10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1)
_WIDE, _HIGH = 165.0, 256.0
"""Room on the sheet for the two views with their dimensions [mm]."""
_MIDDLE = 132.0
"""Where the views' middle is across the sheet [mm]."""
_FIRST, _NEXT, _GAP, _BOTTOM = 8.0, 6.5, 18.0, 22.0
_CALL_OUTS = 228.0
"""Where the texts beside the plan begin [mm]."""
_OVER_TITLE = 80.0
"""Height on the sheet above which there is room beside the plan [mm]."""
_CORNER = 2.0
"""Radius up to which an arc is the corner of a pocket [mm]."""
_TOLERANCES = "ISO 2768-m if machined; ±0.3 mm if printed (assumed: print one and measure)"


def part_sheet(kind: str, solid: cq.Solid, what: Product, module: str) -> Sheet:
    """Draw a part: section A-A above, plan below it, first angle; levels, diameters and holes dimensioned."""
    plan, front = from_above(solid), section(solid)
    found = upright_cylinders(solid)
    diameters = sorted({2.0 * one.radius for one in found if one.is_central and one.is_round})
    scale = _scale(plan, front, len(diameters))
    sheet = Sheet(scale)
    left, right, bottom, top = plan.bounds
    height = (top - bottom + front.bounds[3] - front.bounds[2]) * scale + _taken(len(diameters))
    below = _BOTTOM + 0.5 * max(_HIGH - height, 0.0)
    plan_at = (_MIDDLE - 0.5 * (left + right) * scale, below - bottom * scale)
    front_at = (plan_at[0], plan_at[1] + top * scale + _GAP - front.bounds[2] * scale)
    placed_plan, placed_front = Placed(sheet, plan, plan_at), Placed(sheet, front, front_at)
    placed_plan.draw()
    placed_front.draw()
    placed_plan.centre_lines([one for one in found if one.is_round])
    placed_front.axis()
    sheet.text("A – A", (_MIDDLE, front_at[1] + front.bounds[2] * scale - 4.5), 3.5, "MIDDLE_CENTER")
    placed_plan.cutting_line()
    _dimension_diameters(placed_front, diameters)
    _dimension_extent(placed_front, diameters)
    _dimension_levels(placed_front, levels(solid))
    _call_out(placed_plan, found, solid)
    _words(sheet, kind, solid, what, module)
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


@dataclass(frozen=True)
class Placed:
    """A view on a sheet, its own origin at a place on paper."""

    sheet: Sheet
    view: View
    origin: tuple[float, float]

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Where a point of the view is in the drawing's coordinates."""
        left, bottom = self.sheet.at(self.origin)
        return left + x, bottom + y

    def paper(self, length: float) -> float:
        """A length on paper [mm] in the drawing's coordinates."""
        return length / self.sheet.scale

    def draw(self) -> None:
        """Draw outlines and hatching."""
        space, outline = self.sheet.space, {"layer": "OUTLINE"}
        for chain in self.view.hidden:
            space.add_lwpolyline([self.at(*point) for point in chain.points], dxfattribs={"layer": "HIDDEN"})
        for arc in self.view.arcs:
            if arc.end - arc.start == 360.0:
                space.add_circle(self.at(*arc.centre), arc.radius, dxfattribs=outline)
            else:
                space.add_arc(self.at(*arc.centre), arc.radius, arc.start, arc.end, dxfattribs=outline)
        for chain in self.view.chains:
            space.add_lwpolyline([self.at(*point) for point in chain.points], dxfattribs=outline)
        for outlines in self.view.cut:
            hatch = space.add_hatch(dxfattribs={"layer": "HATCH"})
            hatch.set_pattern_fill("ANSI31", scale=0.8 / self.sheet.scale)
            for index, one in enumerate(outlines):
                points = [self.at(*point) for point in one.points]
                hatch.paths.add_polyline_path(points, is_closed=True, flags=1 if index == 0 else 16)

    def line(self, start: tuple[float, float], end: tuple[float, float], layer: str = "CENTRE") -> None:
        """Draw a line between two points of the view."""
        self.sheet.space.add_line(self.at(*start), self.at(*end), dxfattribs={"layer": layer})

    def axis(self) -> None:
        """Draw the axis of the module in a view from the front."""
        over = self.paper(3.0)
        self.line((0.0, self.view.bounds[2] - over), (0.0, self.view.bounds[3] + over))

    def centre_lines(self, rounds: Sequence[Cylinder]) -> None:
        """Draw a cross at the axis, the circles on which holes and pins stand, and a cross at each of those."""
        left, right, bottom, top = self.view.bounds
        over = self.paper(3.0)
        self.line((left - over, 0.0), (right + over, 0.0))
        self.line((0.0, bottom - over), (0.0, top + over))
        beside = [one for one in rounds if not one.is_central]
        pitches = [round(hypot(one.x, one.y), 4) for one in beside]
        for pitch in sorted({pitch for pitch in pitches if pitches.count(pitch) > 1}):
            self.sheet.space.add_circle(self.at(0.0, 0.0), pitch, dxfattribs={"layer": "CENTRE"})
        for x, y, radius in sorted({(one.x, one.y, one.radius) for one in beside}):
            arm = radius + self.paper(1.5)
            self.line((x - arm, y), (x + arm, y))
            self.line((x, y - arm), (x, y + arm))

    def cutting_line(self) -> None:
        """Mark where the section above is taken, with arrows in the direction of view."""
        left, right = self.view.bounds[:2]
        for x, side in ((left, -1.0), (right, 1.0)):
            start, end = x + side * self.paper(3.0), x + side * self.paper(8.0)
            self.line((start, 0.0), (end, 0.0), "OUTLINE")
            tip, half = self.paper(5.0), self.paper(0.8)
            self.line((end, 0.0), (end, tip), "FINE")
            self.sheet.space.add_solid(
                [self.at(end - half, 0.55 * tip), self.at(end + half, 0.55 * tip), self.at(end, tip)],
                dxfattribs={"layer": "FINE"},
            )
            paper_x = self.origin[0] + end * self.sheet.scale
            self.sheet.text("A", (paper_x, self.origin[1] - 3.5), 3.5, "MIDDLE_CENTER")


def _dimension_diameters(front: Placed, diameters: Sequence[float]) -> None:
    """Diameters about the axis, the smallest nearest, above the section."""
    top = front.view.bounds[3]
    for index, diameter in enumerate(diameters):
        base = front.at(0.0, top + front.paper(_FIRST + index * _NEXT))
        ends = (front.at(-0.5 * diameter, top), front.at(0.5 * diameter, top))
        front.sheet.space.add_linear_dim(
            base, *ends, text="⌀<>", dimstyle="SHEET", dxfattribs={"layer": "DIMENSION"}
        ).render()


def _dimension_extent(front: Placed, diameters: Sequence[float]) -> None:
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


def _dimension_levels(front: Placed, heights: Sequence[float]) -> None:
    """Heights of the flat faces over the lowest, right of the section, their figures apart from each other."""
    right = front.view.bounds[1] + front.paper(2.0)
    places = _apart(heights, front.paper(4.2))
    lowest = front.at(0.0, front.view.bounds[2])
    for height, place in zip(heights, places, strict=True):
        front.sheet.space.add_ordinate_y_dim(
            front.at(right, height), (front.paper(14.0), place - height), origin=lowest, dimstyle="SHEET",
            dxfattribs={"layer": "DIMENSION"},
        ).render()  # fmt: skip


def _apart(wanted: Sequence[float], least: float) -> list[float]:
    """Places in ascending order, at least so far apart, as near as possible to those wanted."""
    groups: list[tuple[float, int]] = []
    for place in wanted:
        groups.append((place, 1))
        while len(groups) > 1 and groups[-1][0] - groups[-2][0] < 0.5 * least * (groups[-1][1] + groups[-2][1]):
            (one, few), (other, more) = groups[-2:]
            groups[-2:] = [((one * few + other * more) / (few + more), few + more)]
    return [middle + (index - 0.5 * (count - 1)) * least for middle, count in groups for index in range(count)]


def _call_out(plan: Placed, found: Sequence[Cylinder], solid: cq.Solid) -> None:
    """One text for all holes, pins and arcs that are alike, beside the plan, with a leader to one of them."""
    alike: dict[tuple[object, ...], list[Cylinder]] = {}
    for one in found:
        if not (one.is_central and one.is_round):
            pitch = round(hypot(one.x, one.y), 4)
            stands = () if _is_corner(one) else (pitch, one.bottom, one.top)
            key = (round(one.radius, 6), *stands, one.concave, one.is_round)
            alike.setdefault(key, []).append(one)
    groups = sorted(alike.values(), key=lambda group: _pointed_at(group)[1])
    box = solid.BoundingBox()
    low = max(plan.view.bounds[2], (_OVER_TITLE - plan.origin[1]) / plan.sheet.scale)
    wanted = [max(_pointed_at(group)[1], low) for group in groups]
    x = (_CALL_OUTS - plan.origin[0]) / plan.sheet.scale
    for group, height in zip(groups, _apart(wanted, plan.paper(5.5)), strict=True):
        text = _said_of(group, box.zmin, box.zmax)
        start = _pointed_at(group)
        knee, end = (x - plan.paper(4.0), height), (x, height)
        for points in ((start, knee), (knee, end)):
            plan.line(*points, "DIMENSION")
        plan.sheet.space.add_circle(plan.at(*start), plan.paper(0.5), dxfattribs={"layer": "DIMENSION"})
        place = plan.origin[0] + x * plan.sheet.scale + 1.0, plan.origin[1] + height * plan.sheet.scale
        plan.sheet.text(text, place, align="MIDDLE_LEFT")


def _pointed_at(group: Sequence[Cylinder]) -> tuple[float, float]:
    """Point of the plan to which the leader goes: on one of those that are alike, towards the text."""
    places = []
    for one in group:
        ways = (0.25 * pi,) if one.is_round else tuple(one.middle + share * one.span for share in (-0.35, 0.0, 0.35))
        places += [(one.x + one.radius * cos(way), one.y + one.radius * sin(way)) for way in ways]
    return max(places, key=lambda place: (round(place[0] + 0.5 * place[1], 4), place))


def _said_of(group: Sequence[Cylinder], bottom: float, top: float) -> str:
    """What a call-out says: how many, how large, where, and between which heights."""
    one = group[0]
    if _is_corner(one):
        return f"{len(group)}× R{figure(one.radius)} inner corners"
    size = (
        f"⌀{figure(2.0 * one.radius)}" if one.is_round else f"R{figure(one.radius)} over {figure(degrees(one.span))}°"
    )
    what = ("hole" if one.concave else "boss") if one.is_round else ("inside" if one.concave else "outside")
    through = one.concave and one.is_round and abs(one.bottom - bottom) < 1e-3 and abs(one.top - top) < 1e-3
    deep = "through" if through else f"h {figure(one.bottom - bottom)} to {figure(one.top - bottom)}"
    many = f"{len(group)}× " if len(group) > 1 else ""
    return ", ".join(filter(None, (f"{many}{size} {what}", _where(group), deep)))


def _is_corner(one: Cylinder) -> bool:
    """Whether it is the rounded corner of a pocket, whose place its walls say."""
    return one.concave and not one.is_round and one.radius <= _CORNER


def _where(group: Sequence[Cylinder]) -> str:
    """Where those that are alike stand: on which circle, from which azimuth on, or at which place."""
    one = group[0]
    pitch = 2.0 * hypot(one.x, one.y)
    if pitch < 1e-3:
        return ""
    if len(group) == 1:
        return f"x {figure(one.x)}, y {figure(one.y)}"
    azimuths = sorted(round(degrees(atan2(other.y, other.x)) % 360.0, 3) % 360.0 for other in group)
    return f"on ⌀{figure(pitch)} {around(azimuths)}"


def _words(sheet: Sheet, kind: str, solid: cq.Solid, what: Product, module: str) -> None:
    """Notes and title block."""
    volume = solid.Volume()
    notes = [
        "Millimetres. Heights h, and those beside the section, are over the lowest face.",
        "Section A – A is taken through the module's axis; azimuths count from x, to the right.",
        f"What is not dimensioned: {names.step(kind)}.",
        "Break sharp edges 0.2 to 0.4.",
        "Printing: " + ("standing as in the section" if MAKING[kind].down == "bottom" else "turned over")
        + "; print/ has it so, with wider holes.",
    ]  # fmt: skip
    sheet.column(notes, (256.0, SIZE[1] - 14.0))
    sheet.title_block(
        kind.replace("_", " "),
        [
            [Field("Made by", f"tvimdesign {__version__}", 0.5), Field("Size, projection", "A3, first angle", 0.3),
             Field("Sheet", "1 of 1", 0.2)],
            [Field("General tolerances", _TOLERANCES, 1.0)],
            [Field("Mass", f"{volume * what.density * 1e-6:.2f} g", 0.25),
             Field("Volume", f"{volume * 1e-3:.3f} cm³", 0.25),
             Field("Density", f"{what.density:g} kg/m³", 0.3), Field("Scale", ratio(sheet.scale), 0.2)],
            [Field("Material", what.material, 0.5), Field("Module", module, 0.5)],
        ],
    )  # fmt: skip
