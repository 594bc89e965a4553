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
_BODY = ("flats", "sector")
"""What a part is as a whole, whose place is that of the part."""
_SAME = 1e-3
"""Distance [mm] below which two places are one."""


@dataclass(frozen=True)
class FeatureRow:
    """All features that are alike; texts as they stand on the sheet."""

    what: str
    size: str
    place: str
    bottom: float
    top: float
    """Heights between which it is, over the lowest face [mm]."""
    asks: str = ""
    """Fit, thread or who needs it."""
    frames: tuple[Frame, ...] = ()
    points: tuple[Point, ...] = ()
    """Where each can be pointed at in the plan."""
    count: int = 1
    azimuths: tuple[float, ...] = ()
    """Where each is cut through its middle by a plane that holds the axis [deg]."""
    through: bool = False
    of: tuple[Cylinder | Wall, ...] = ()
    """The faces that it describes."""

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


def feature_rows(solid: cq.Solid, asked: DrawingRequirements) -> list[FeatureRow]:
    """Return rows for all upright faces but the round ones about the axis without a thread: the section has these."""
    box = tight_box(solid)
    cylinders, walls = upright_cylinders(solid), upright_walls(solid)
    bounded, arcs, ends = sectors(cylinders, walls)
    beside, alone = pairs(ends)
    if not asked.placed:
        # Without an axis, walls of different heights are dimensioned from each other, step by step.
        steps, alone = pairs(_between_levels(alone))
        beside = [*beside, *steps]
    rows = [
        *_like(_told_of_hole(asked), _holes(cylinders, asked), _hole_key),
        *_like(_told_of_sector, bounded, _sector_key),
        *_like(_told_of_pair, beside, _pair_key),
        *_like(_told_of_wall, alone, _wall_key),
        *_like(_told_of_arc(asked), [one for one in arcs if not is_corner(one)], _arc_key),
        *_like(_told_of_corners, [one for one in arcs if is_corner(one)], lambda one: round(one.radius, 4)),
    ]
    rows = [row if asked.placed or row.what not in _BODY else replace(row, place="") for row in rows]
    return _unlike([_over(row, box.zmin, box.zmax) for row in rows])


def _between_levels(walls: Sequence[Wall]) -> list[Wall]:
    """Return walls cut at each height at which one of them ends."""
    heights = sorted({round(height, 4) for wall in walls for height in (wall.bottom, wall.top)})
    return [
        replace(wall, bottom=low, top=high)
        for wall in walls
        for low, high in pairwise(heights)
        if wall.bottom < 0.5 * (low + high) < wall.top
    ]


def is_corner(one: Cylinder) -> bool:
    """Return whether it is the rounded corner of a pocket."""
    return one.concave and not one.is_round and one.radius <= CORNER


def _like(told: Callable[[list[T]], FeatureRow], found: Iterable[T], key: Callable[[T], Hashable]) -> list[FeatureRow]:
    """Return a row for each group of features that are alike."""
    groups: dict[Hashable, list[T]] = {}
    for one in found:
        groups.setdefault(key(one), []).append(one)
    return [replace(told(group), count=len(group)) for group in groups.values()]


def _over(row: FeatureRow, lowest: float, highest: float) -> FeatureRow:
    """Return the row with its heights over the part's lowest face."""
    through = row.what == "hole" and abs(row.bottom - lowest) < _SAME and abs(row.top - highest) < _SAME
    return replace(row, bottom=row.bottom - lowest, top=row.top - lowest, through=through)


# --- round holes and bosses ------------------------------------------------------------------------------------------


def _holes(found: Sequence[Cylinder], asked: DrawingRequirements) -> list[Cylinder]:
    return [one for one in found if one.is_round and (not one.is_central or asked.thread(one))]


def _hole_key(one: Cylinder) -> Hashable:
    return round(one.radius, 5), round(hypot(one.x, one.y), 4), one.bottom, one.top, one.concave


def _told_of_hole(asked: DrawingRequirements) -> Callable[[list[Cylinder]], FeatureRow]:
    def told(group: list[Cylinder]) -> FeatureRow:
        one = group[0]
        thread, seat, screw = asked.thread(one), asked.seat(one), asked.clearance_hole(one)
        about = next((reported.about for reported in (thread, seat, screw) if reported), "")
        frames = thread.frames if thread else screw.frames if screw else ()
        size = thread.designation if thread else sized(one, asked)
        place = "on the axis" if one.is_central else _circle(_centres(group))
        what = ("thread" if thread else "hole") if one.concave else "boss"
        points = tuple(
            (other.x + other.radius * cos(0.25 * pi), other.y + other.radius * sin(0.25 * pi)) for other in group
        )
        return FeatureRow(what, size, place, one.bottom, one.top, about, tuple(frames), points, of=tuple(group),
                          azimuths=() if one.is_central else tuple(_directions(_centres(group))))  # fmt: skip

    return told


def sized(one: Cylinder, asked: DrawingRequirements) -> str:
    """Return a diameter with its fit."""
    seat = asked.seat(one)
    return f"⌀{figure(seat.size)} {seat.fit}" if seat and seat.fit else f"⌀{figure(2.0 * one.radius)}"


def _centres(group: Sequence[Cylinder]) -> list[Point]:
    return [(one.x, one.y) for one in group]


# --- sectors between end walls through the axis ----------------------------------------------------------------------


def _sector_key(one: Sector) -> Hashable:
    return one.is_pocket, round(one.span, 4), one.radii, one.levels


def _told_of_sector(group: list[Sector]) -> FeatureRow:
    one = group[0]
    size = f"{' to '.join(f'R{figure(radius)}' for radius in one.radii)}, {figure(degrees(one.span))}° between ends"
    place = f"middle {around(_azimuths([other.middle for other in group]))}"
    faces = tuple(face for other in group for face in other.faces)
    points = tuple(other.point for other in group)
    # A single one is no vane of a part with an axis, but the part: an arc, a block, a spreader.
    body = "vane" if len(group) > 1 else "sector"
    return FeatureRow("pocket" if one.is_pocket else body, size, place, *one.levels, points=points, of=faces,
                      azimuths=tuple(_azimuths([other.middle for other in group])))  # fmt: skip


# --- slots, ribs and single walls ------------------------------------------------------------------------------------


def _pair_key(one: Pair) -> Hashable:
    wall = one.walls[0]
    along = round(abs(sum(one.ends)), 3)
    return one.is_slot, round(one.width, 4), round(abs(one.mid_plane[1]), 3), along, wall.bottom, wall.top


def _told_of_pair(group: list[Pair]) -> FeatureRow:
    one = group[0]
    wall, (normal, away) = one.walls[0], one.mid_plane
    middles = [other.middle for other in group]
    if abs(away) < _SAME:
        at = around(_directions(middles)) if hypot(*middles[0]) > _SAME else f"along {figure(_along(normal))}°"
        place = f"mid-plane through the axis, {at}"
    elif abs(sum(one.ends)) < _SAME:
        place = f"mid-plane {figure(abs(away))} from the axis, square to it {around(_directions(middles))}"
    else:
        square = around(_azimuths([other.mid_plane[0] for other in group]))
        place = f"mid-plane {figure(away)} from the axis, square to azimuths {square}"
    faces = tuple(face for other in group for face in other.walls)
    what = "slot" if one.is_slot else "flats"
    # Pointed at on a wall: the middle of a slot at the axis is the middle of everything.
    points = tuple(other.walls[0].middle for other in group)
    return FeatureRow(what, f"{figure(one.width)} wide", place, wall.bottom, wall.top, points=points, of=faces)


def _along(normal: float) -> float:
    """Return azimuth [deg] of the line of a mid-plane, below 180."""
    return round(degrees(normal + 0.5 * pi), 3) % 180.0


def _wall_key(one: Wall) -> Hashable:
    reach = sorted((round(abs(one.start), 3), round(abs(one.end), 3)))
    return round(one.offset, 3), *reach, one.bottom, one.top, one.is_radial and _faces_onwards(one)


def _faces_onwards(one: Wall) -> bool:
    """Return whether a wall through the axis faces counter-clockwise."""
    x, y = one.middle
    return sin(one.outwards - atan2(y, x)) > 0.0


def _told_of_wall(group: list[Wall]) -> FeatureRow:
    """Return where its plane is and which way it faces: along that way the plane is before or behind the axis."""
    one = group[0]
    size = "through the axis" if abs(one.offset) < _SAME else f"{figure(abs(one.offset))} from the axis"
    faced = _azimuths([other.outwards for other in group])
    middles = [other.middle for other in group]
    if one.is_radial:
        way = "counter-clockwise" if _faces_onwards(one) else "clockwise"
        place = f"{_reach(one)} {around(_directions(middles))}, faces {way}"
    else:
        way = "" if abs(one.offset) < _SAME else " outwards" if one.offset > 0.0 else " inwards"
        # Two that face one way stand beside each other, as far to the left as to the right.
        both = "" if len(set(faced)) == len(faced) else ", two beside each other"
        place = f"faces{way} {around(sorted(set(faced)))}{both}"
    return FeatureRow("wall", size, place, one.bottom, one.top, points=tuple(middles), of=tuple(group))


def _reach(one: Wall) -> str:
    near, far = one.radii
    return f"R{figure(near)} to R{figure(far)}"


def _unlike(rows: Sequence[FeatureRow]) -> list[FeatureRow]:
    """Return the rows, with the ends of walls told where nothing else tells these from those of another row."""
    alike = Counter(row.text for row in rows)
    told = []
    for row in rows:
        wall = row.of[0] if row.what in ("slot", "flats", "wall") else None
        if alike[row.text] > 1 and isinstance(wall, Wall):
            told.append(replace(row, place=f"{row.place}, {_reach(wall)}"))
        else:
            told.append(row)
    return told


# --- arcs ------------------------------------------------------------------------------------------------------------


def _arc_key(one: Cylinder) -> Hashable:
    return round(one.radius, 5), round(hypot(one.x, one.y), 3), one.bottom, one.top, one.concave, round(one.span, 4)


def _told_of_arc(asked: DrawingRequirements) -> Callable[[list[Cylinder]], FeatureRow]:
    def told(group: list[Cylinder]) -> FeatureRow:
        one = group[0]
        size = sized(one, asked) if asked.seat(one) else f"R{figure(one.radius)}"
        over = f"{figure(degrees(one.span))}°"
        if one.is_central:
            place = f"about the axis over {over}, middle {around(_azimuths([other.middle for other in group]))}"
        else:
            place = f"over {over}, {_circle(_centres(group))}"
        points = tuple(
            (other.x + other.radius * cos(way), other.y + other.radius * sin(way))
            for other in group for way in (other.middle + share * other.span for share in (0.0, 0.3, -0.3))
        )  # fmt: skip
        what = "arc inside" if one.concave else "arc outside"
        return FeatureRow(what, size, place, one.bottom, one.top, points=points, of=tuple(group))

    return told


def _told_of_corners(group: list[Cylinder]) -> FeatureRow:
    one = group[0]
    bottom, top = min(other.bottom for other in group), max(other.top for other in group)
    points = tuple(
        (other.x + other.radius * cos(other.middle), other.y + other.radius * sin(other.middle)) for other in group
    )
    return FeatureRow(
        "corners", f"R{figure(one.radius)}", "where walls meet", bottom, top, points=points, of=tuple(group)
    )


# --- places ----------------------------------------------------------------------------------------------------------


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
