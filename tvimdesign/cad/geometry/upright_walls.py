"""Flat upright walls of a solid that bound slots, pockets, vanes and flats, and end walls about the axis."""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from math import atan2, cos, hypot, pi, sin

import cadquery as cq

from tvimdesign.cad.geometry.features import Cylinder

_DIGITS = 7  # Decimals of a millimetre and of a radian to which two walls are alike
_SAME = 1e-3  # Distance [mm] below which two places are one


@dataclass(frozen=True, order=True)
class Wall:
    """A flat upright face; lengths in mm, angles in rad."""

    bottom: float
    top: float
    outwards: float  # Azimuth of its normal, out of the material
    offset: float  # Distance of its plane from the axis, along the normal
    start: float
    end: float  # Where it begins and ends along the horizontal line in its plane, the normal turned by +90 degrees

    @property
    def middle(self) -> tuple[float, float]:
        """Its middle, seen from above."""
        along = 0.5 * (self.start + self.end)
        return self.at(along)

    def at(self, along: float) -> tuple[float, float]:
        """Return the point of it that is so far along its line."""
        cosine, sine = cos(self.outwards), sin(self.outwards)
        return self.offset * cosine - along * sine, self.offset * sine + along * cosine

    @property
    def is_radial(self) -> bool:
        """True if its plane holds the axis, and it lies to one side of that."""
        return abs(self.offset) < _SAME and self.start * self.end >= 0.0

    @property
    def radii(self) -> tuple[float, float]:
        """Distances of its two ends from the axis, the smaller first."""
        near, far = sorted(hypot(*self.at(along)) for along in (self.start, self.end))
        return near, far


def upright_walls(solid: cq.Solid) -> list[Wall]:
    """Return flat upright faces, in a fixed order."""
    walls = []
    for face in solid.Faces():
        normal = face.normalAt() if face.geomType() == "PLANE" else None
        if normal is not None and abs(normal.z) < 1e-9:
            walls.append(_wall(face, normal))
    return sorted(walls)


def _wall(face: cq.Face, normal: cq.Vector) -> Wall:
    outwards = _round(atan2(normal.y, normal.x) % (2.0 * pi))
    points = [vertex.Center() for vertex in face.Vertices()]
    along = [point.y * normal.x - point.x * normal.y for point in points]
    levels = [point.z for point in points]
    offset = points[0].x * normal.x + points[0].y * normal.y
    return Wall(*map(_round, (min(levels), max(levels), outwards, offset, min(along), max(along))))


def _round(value: float) -> float:
    return round(value, _DIGITS) + 0.0


@dataclass(frozen=True)
class Pair:
    """Two parallel walls with nothing between them, or with nothing but material."""

    walls: tuple[Wall, Wall]
    is_slot: bool  # True if the walls face each other; else they are the sides of a rib, a key or a flat

    @property
    def width(self) -> float:
        """Distance of the walls."""
        return abs(self.walls[0].offset + self.walls[1].offset)

    @property
    def mid_plane(self) -> tuple[float, float]:
        """Azimuth of the mid-plane's normal, and its distance from the axis along that."""
        first, second = self.walls
        return first.outwards, 0.5 * (first.offset - second.offset)

    @property
    def ends(self) -> tuple[float, float]:
        """Place where both walls are, along the line of the first."""
        first, second = self.walls
        return max(first.start, -second.end), min(first.end, -second.start)

    @property
    def middle(self) -> tuple[float, float]:
        """The middle between the walls, seen from above."""
        normal, away = self.mid_plane
        along = 0.5 * sum(self.ends)
        return away * cos(normal) - along * sin(normal), away * sin(normal) + along * cos(normal)


def pairs(walls: list[Wall]) -> tuple[list[Pair], list[Wall]]:
    """Return walls of one height that are parallel and beside each other, nearest first; and those that are left."""
    possible = []
    for index, first in enumerate(walls):
        for other in walls[index + 1 :]:
            pair = _pair(first, other)
            if pair and pair.ends[1] - pair.ends[0] > 0.5 * (first.end - first.start):
                possible.append(pair)
    chosen: list[Pair] = []
    left = list(walls)
    # A slot is known by its width; a rib has only walls that bound no slot.
    for pair in sorted(possible, key=lambda candidate: (not candidate.is_slot, candidate.width, candidate.walls)):
        if all(wall in left for wall in pair.walls):
            chosen.append(pair)
            left = [wall for wall in left if wall not in pair.walls]
    return chosen, left


def _pair(wall: Wall, other: Wall) -> Pair | None:
    """Return two walls as a pair, if they look in opposite directions and stand between the same heights."""
    turned = abs((other.outwards - wall.outwards) % (2.0 * pi) - pi)
    if turned > 1e-4 or abs(wall.bottom - other.bottom) > _SAME or abs(wall.top - other.top) > _SAME:
        return None
    away = wall.offset + other.offset
    if abs(away) < _SAME:
        return None
    # Along the first wall's normal, the second one is at minus its own offset.
    return Pair((wall, other), is_slot=away < 0.0)


CORNER = 2.0  # Radius [mm] up to which an arc is the corner of a pocket, whose place its walls say


@dataclass(frozen=True)
class Sector:
    """A pocket or a vane about the axis; angles in rad."""

    ends: tuple[Wall, Wall]
    arcs: tuple[Cylinder, ...]
    is_pocket: bool
    first: float  # Azimuth of the end wall at which it begins
    span: float  # Between its end walls

    @property
    def middle(self) -> float:
        """Azimuth of its middle."""
        return self.first + 0.5 * self.span

    @property
    def radii(self) -> tuple[float, ...]:
        """Of its innermost and its outermost arc; one where it has no more."""
        radii = sorted({round(arc.radius, 4) for arc in self.arcs})
        return (radii[0], radii[-1]) if len(radii) > 1 else tuple(radii)

    @property
    def levels(self) -> tuple[float, float]:
        """Heights of its end walls."""
        return self.ends[0].bottom, self.ends[0].top

    @property
    def point(self) -> tuple[float, float]:
        """A point to point at: on its outer arc, a fifth before its end."""
        azimuth, radius = self.first + 0.8 * self.span, self.radii[-1]
        return radius * cos(azimuth), radius * sin(azimuth)

    @property
    def faces(self) -> tuple[Cylinder | Wall, ...]:
        """End walls, and the arcs that are as high as these."""
        bottom, top = self.levels
        return (*self.ends, *(arc for arc in self.arcs if _same(arc.bottom, bottom) and _same(arc.top, top)))


def sectors(cylinders: Sequence[Cylinder], walls: Sequence[Wall]) -> tuple[list[Sector], list[Cylinder], list[Wall]]:
    """Return all sectors, the partial cylinders that are in none of them, and the walls that are in none."""
    arcs = [cylinder for cylinder in cylinders if not cylinder.is_round]
    levels: dict[Hashable, list[Wall]] = {}
    for wall in walls:
        if wall.is_radial:
            levels.setdefault((wall.bottom, wall.top, *(round(radius, 3) for radius in wall.radii)), []).append(wall)
    enclosed = [sector for group in levels.values() for sector in _of_height(group, arcs)]
    used = {face for sector in enclosed for face in sector.faces}
    return enclosed, [arc for arc in arcs if arc not in used], [wall for wall in walls if wall not in used]


def _of_height(walls: Sequence[Wall], arcs: Sequence[Cylinder]) -> list[Sector]:
    """Return the sectors between walls of one height and reach: those between which an arc runs."""
    around = sorted(walls, key=_azimuth)
    enclosed = []
    for index, wall in enumerate(around):
        following = around[(index + 1) % len(around)]
        first, span = _azimuth(wall), (_azimuth(following) - _azimuth(wall)) % (2.0 * pi)
        between = tuple(
            arc for arc in arcs
            if arc.is_central and arc.bottom < wall.top - _SAME and arc.top > wall.bottom + _SAME
            and 0.5 * span < arc.span < span + 1e-4 and abs(_apart(arc.middle, first + 0.5 * span)) < 1e-4
            and _bounds(arc, wall)
        )  # fmt: skip
        whole = tuple(arc for arc in between if arc.bottom < wall.bottom + _SAME and arc.top > wall.top - _SAME)
        if len(around) > 1 and whole and _empty_beyond(wall) != _empty_beyond(following):
            enclosed.append(Sector((wall, following), whole, _empty_beyond(wall), first, span))
    return enclosed


def _bounds(arc: Cylinder, wall: Wall) -> bool:
    """Return whether an arc is at an end of a wall, its corner between, and has the sector on its own side.

    A housing's wall that runs behind a vane may be as wide as this by chance, and is none of its arcs.
    """
    near, far = wall.radii
    is_outer = arc.radius > 0.5 * (near + far)
    is_at_end = near - CORNER < arc.radius < far + CORNER
    return is_at_end and arc.concave == (is_outer == _empty_beyond(wall))


def _azimuth(wall: Wall) -> float:
    x, y = wall.middle
    return atan2(y, x) % (2.0 * pi)


def _empty_beyond(wall: Wall) -> bool:
    """Return whether there is no material beyond a radial wall, going round counter-clockwise."""
    return sin(wall.outwards - _azimuth(wall)) > 0.0


def _apart(azimuth: float, other: float) -> float:
    """Return the difference of two azimuths, between -pi and pi."""
    return (azimuth - other + pi) % (2.0 * pi) - pi


def _same(value: float, other: float) -> bool:
    return abs(value - other) < _SAME
