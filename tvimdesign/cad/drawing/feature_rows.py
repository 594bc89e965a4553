"""Rows of a drawing's table for upright faces of a part: one numbered row for all that are alike around the axis."""

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import atan2, cos, degrees, hypot, pi, sin
from typing import TypeVar

import cadquery as cq

from tvimdesign.cad.drawing.drawing_requirements import DrawingRequirements
from tvimdesign.cad.drawing.drawing_sheet import around, figure
from tvimdesign.cad.drawing.iso_1101 import Frame
from tvimdesign.cad.geometry.features import Cylinder, tight_box, upright_cylinders
from tvimdesign.cad.geometry.upright_walls import CORNER, Pair, Sector, Wall, pairs, sectors, upright_walls

Point = tuple[float, float]
T = TypeVar("T")
_BODY = ("flats", "sector")  # Shapes of whole parts; their place is the part's
_SAME = 1e-3  # Distance [mm] below which two places are one


@dataclass(frozen=True)
class FeatureRow:
    """All features that are alike; texts as they stand on the sheet."""

    what: str
    size: str
    place: str
    bottom: float
    top: float  # Heights between which it is, over the lowest face [mm]
    asks: str = ""  # Fit, thread or who needs it
    frames: tuple[Frame, ...] = ()
    points: tuple[Point, ...] = ()  # Where each can be pointed at in the plan
    count: int = 1
    azimuths: tuple[float, ...] = ()  # Where each is cut through its middle by a plane that holds the axis [deg]
    through: bool = False
    of: tuple[Cylinder | Wall, ...] = ()  # The faces that it describes

    @property
    def text(self) -> str:
        """The line of the table."""
        many = f"{self.count}× " if self.count > 1 else ""
        return ", ".join(filter(None, (f"{many}{self.what} {self.size}", self.place, self.heights)))

    @property
    def heights(self) -> str:
        """From where to where, and how deep or high that is."""
        if self.through:
            return "through"
        return f"h {figure(self.bottom)} to {figure(self.top)} ({figure(self.top - self.bottom)})"


def feature_rows(solid: cq.Solid, requirements: DrawingRequirements) -> list[FeatureRow]:
    """Return rows for all upright faces but the round ones about the axis without a thread: the section has these."""
    box = tight_box(solid)
    cylinders, walls = upright_cylinders(solid), upright_walls(solid)
    bounded, arcs, ends = sectors(cylinders, walls)
    beside, alone = pairs(ends)
    if not requirements.placed:
        # Without an axis, walls of different heights are dimensioned from each other, step by step.
        steps, alone = pairs(_between_levels(alone))
        beside = [*beside, *steps]
    holes = [face for face in cylinders if face.is_round and (not face.is_central or requirements.thread(face))]
    rows = [
        *_rows(_hole_row_for(requirements), holes, _hole_key),
        *_rows(_sector_row, bounded, _sector_key),
        *_rows(_pair_row, beside, _pair_key),
        *_rows(_wall_row, alone, _wall_key),
        *_rows(_arc_row_for(requirements), [arc for arc in arcs if not is_corner(arc)], _arc_key),
        *_rows(_corners_row, [arc for arc in arcs if is_corner(arc)], lambda arc: round(arc.radius, 4)),
    ]
    rows = [row if requirements.placed or row.what not in _BODY else replace(row, place="") for row in rows]
    return _distinct_rows([_over(row, box.zmin, box.zmax) for row in rows])


def _between_levels(walls: Sequence[Wall]) -> list[Wall]:
    """Return walls cut at each height at which one of them ends."""
    heights = sorted({round(height, 4) for wall in walls for height in (wall.bottom, wall.top)})
    return [
        replace(wall, bottom=low, top=high)
        for wall in walls
        for low, high in pairwise(heights)
        if wall.bottom < 0.5 * (low + high) < wall.top
    ]


def is_corner(face: Cylinder) -> bool:
    """Return whether it is the rounded corner of a pocket."""
    return face.concave and not face.is_round and face.radius <= CORNER


def _rows(row: Callable[[list[T]], FeatureRow], faces: Iterable[T], key: Callable[[T], Hashable]) -> list[FeatureRow]:
    """Return a row for each group of features that are alike."""
    groups: dict[Hashable, list[T]] = {}
    for face in faces:
        groups.setdefault(key(face), []).append(face)
    return [replace(row(group), count=len(group)) for group in groups.values()]


def _over(row: FeatureRow, lowest: float, highest: float) -> FeatureRow:
    """Return the row with its heights over the part's lowest face."""
    through = row.what == "hole" and abs(row.bottom - lowest) < _SAME and abs(row.top - highest) < _SAME
    return replace(row, bottom=row.bottom - lowest, top=row.top - lowest, through=through)


def _hole_key(hole: Cylinder) -> Hashable:
    return round(hole.radius, 5), round(hypot(hole.x, hole.y), 4), hole.bottom, hole.top, hole.concave


def _hole_row_for(requirements: DrawingRequirements) -> Callable[[list[Cylinder]], FeatureRow]:
    def hole_row(group: list[Cylinder]) -> FeatureRow:
        hole = group[0]
        thread, seat, screw = requirements.thread(hole), requirements.seat(hole), requirements.clearance_hole(hole)
        about = next((called_out.about for called_out in (thread, seat, screw) if called_out), "")
        frames = thread.frames if thread else screw.frames if screw else ()
        size = thread.designation if thread else sized(hole, requirements)
        place = "on the axis" if hole.is_central else _circle(_centres(group))
        what = ("thread" if thread else "hole") if hole.concave else "boss"
        bottom = hole.bottom - (0.0 if hole.concave else requirements.foot_fillet)
        points = tuple(
            (other.x + other.radius * cos(0.25 * pi), other.y + other.radius * sin(0.25 * pi)) for other in group
        )
        return FeatureRow(what, size, place, bottom, hole.top, about, tuple(frames), points, of=tuple(group),
                          azimuths=() if hole.is_central else tuple(_directions(_centres(group))))  # fmt: skip

    return hole_row


def sized(face: Cylinder, requirements: DrawingRequirements) -> str:
    """Return a diameter with its fit."""
    seat = requirements.seat(face)
    return f"⌀{figure(seat.size)} {seat.fit}" if seat and seat.fit else f"⌀{figure(2.0 * face.radius)}"


def _centres(group: Sequence[Cylinder]) -> list[Point]:
    return [(face.x, face.y) for face in group]


def _sector_key(sector: Sector) -> Hashable:
    return sector.is_pocket, round(sector.span, 4), sector.radii, sector.levels


def _sector_row(group: list[Sector]) -> FeatureRow:
    sector = group[0]
    radii = " to ".join(f"R{figure(radius)}" for radius in sector.radii)
    size = f"{radii}, {figure(degrees(sector.span))}° between ends"
    place = f"middle {around(_azimuths([other.middle for other in group]))}"
    faces = tuple(face for other in group for face in other.faces)
    points = tuple(other.point for other in group)
    # A single one is the part itself: an arc, a block, a spreader.
    body = "raised sector" if len(group) > 1 else "sector"
    return FeatureRow("pocket" if sector.is_pocket else body, size, place, *sector.levels, points=points, of=faces,
                      azimuths=tuple(_azimuths([other.middle for other in group])))  # fmt: skip


def _pair_key(pair: Pair) -> Hashable:
    wall = pair.walls[0]
    along = round(abs(sum(pair.ends)), 3)
    return pair.is_slot, round(pair.width, 4), round(abs(pair.mid_plane[1]), 3), along, wall.bottom, wall.top


def _pair_row(group: list[Pair]) -> FeatureRow:
    pair = group[0]
    wall, (normal, away) = pair.walls[0], pair.mid_plane
    middles = [other.middle for other in group]
    if abs(away) < _SAME:
        at = around(_directions(middles)) if hypot(*middles[0]) > _SAME else f"along {figure(_along(normal))}°"
        place = f"mid-plane through the axis, {at}"
    elif abs(sum(pair.ends)) < _SAME:
        place = f"mid-plane {figure(abs(away))} from the axis, square to it {around(_directions(middles))}"
    else:
        square = around(_azimuths([other.mid_plane[0] for other in group]))
        place = f"mid-plane {figure(away)} from the axis, square to azimuths {square}"
    faces = tuple(face for other in group for face in other.walls)
    what = "slot" if pair.is_slot else "flats"
    # Pointed at on a wall: the middle of a slot at the axis is the middle of everything.
    points = tuple(other.walls[0].middle for other in group)
    return FeatureRow(what, f"{figure(pair.width)} wide", place, wall.bottom, wall.top, points=points, of=faces)


def _along(normal: float) -> float:
    """Return azimuth [deg] of the line of a mid-plane, below 180."""
    return round(degrees(normal + 0.5 * pi), 3) % 180.0


def _wall_key(wall: Wall) -> Hashable:
    reach = sorted((round(abs(wall.start), 3), round(abs(wall.end), 3)))
    return round(wall.offset, 3), *reach, wall.bottom, wall.top, wall.is_radial and _faces_onwards(wall)


def _faces_onwards(wall: Wall) -> bool:
    """Return whether a wall through the axis faces counter-clockwise."""
    x, y = wall.middle
    return sin(wall.outwards - atan2(y, x)) > 0.0


def _wall_row(group: list[Wall]) -> FeatureRow:
    """Return where its plane is and which way it faces: along that way the plane is before or behind the axis."""
    wall = group[0]
    size = "through the axis" if abs(wall.offset) < _SAME else f"{figure(abs(wall.offset))} from the axis"
    faced = _azimuths([other.outwards for other in group])
    middles = [other.middle for other in group]
    if wall.is_radial:
        way = "counter-clockwise" if _faces_onwards(wall) else "clockwise"
        place = f"{_reach(wall)} {around(_directions(middles))}, faces {way}"
    else:
        way = "" if abs(wall.offset) < _SAME else " outwards" if wall.offset > 0.0 else " inwards"
        # Two that face one way stand beside each other, as far to the left as to the right.
        both = "" if len(set(faced)) == len(faced) else ", two beside each other"
        place = f"faces{way} {around(sorted(set(faced)))}{both}"
    return FeatureRow("wall", size, place, wall.bottom, wall.top, points=tuple(middles), of=tuple(group))


def _reach(wall: Wall) -> str:
    near, far = wall.radii
    return f"R{figure(near)} to R{figure(far)}"


def _distinct_rows(rows: Sequence[FeatureRow]) -> list[FeatureRow]:
    """Return the rows, with the ends of walls where rows would read the same without."""
    alike = Counter(row.text for row in rows)
    distinct = []
    for row in rows:
        wall = row.of[0] if row.what in ("slot", "flats", "wall") else None
        if alike[row.text] > 1 and isinstance(wall, Wall):
            distinct.append(replace(row, place=f"{row.place}, {_reach(wall)}"))
        else:
            distinct.append(row)
    return distinct


def _arc_key(arc: Cylinder) -> Hashable:
    return round(arc.radius, 5), round(hypot(arc.x, arc.y), 3), arc.bottom, arc.top, arc.concave, round(arc.span, 4)


def _arc_row_for(requirements: DrawingRequirements) -> Callable[[list[Cylinder]], FeatureRow]:
    def arc_row(group: list[Cylinder]) -> FeatureRow:
        arc = group[0]
        size = sized(arc, requirements) if requirements.seat(arc) else f"R{figure(arc.radius)}"
        over = f"{figure(degrees(arc.span))}°"
        if arc.is_central:
            place = f"about the axis over {over}, middle {around(_azimuths([other.middle for other in group]))}"
        else:
            place = f"over {over}, {_circle(_centres(group))}"
        points = tuple(
            (other.x + other.radius * cos(way), other.y + other.radius * sin(way))
            for other in group for way in (other.middle + share * other.span for share in (0.0, 0.3, -0.3))
        )  # fmt: skip
        what = "arc inside" if arc.concave else "arc outside"
        return FeatureRow(what, size, place, arc.bottom, arc.top, points=points, of=tuple(group))

    return arc_row


def _corners_row(group: list[Cylinder]) -> FeatureRow:
    corner = group[0]
    bottom, top = min(other.bottom for other in group), max(other.top for other in group)
    points = tuple(
        (other.x + other.radius * cos(other.middle), other.y + other.radius * sin(other.middle)) for other in group
    )
    return FeatureRow(
        "corners", f"R{figure(corner.radius)}", "where walls meet", bottom, top, points=points, of=tuple(group)
    )


def _circle(places: Sequence[Point]) -> str:
    """Return on which circle places are, and at which azimuths; or where the only one is."""
    if len(places) == 1:
        return f"x {figure(places[0][0])}, y {figure(places[0][1])}"
    return f"on ⌀{figure(2.0 * hypot(*places[0]))} {around(_directions(places))}"


def _directions(places: Sequence[Point]) -> list[float]:
    return _azimuths([atan2(y, x) for x, y in places])


def _azimuths(angles: Sequence[float]) -> list[float]:
    """Return azimuths [deg] from angles [rad], ascending."""
    return sorted(round(degrees(angle) % 360.0, 3) % 360.0 for angle in angles)
