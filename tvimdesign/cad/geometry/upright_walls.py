"""Reads off a solid the flat upright walls that bound slots, pockets, vanes and flats."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, hypot, pi, sin

import cadquery as cq

_DIGITS = 7
"""Decimals of a millimetre and of a radian to which two walls are alike."""
_SAME = 1e-3
"""Distance [mm] below which two places are one."""


@dataclass(frozen=True, order=True)
class Wall:
    """A flat upright face; lengths in mm, angles in rad."""

    bottom: float
    top: float
    outwards: float
    """Azimuth of its normal, out of the material."""
    offset: float
    """Distance of its plane from the axis, along the normal."""
    start: float
    end: float
    """Where it begins and ends along the horizontal line in its plane, the normal turned by +90 degrees."""

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
    found = []
    for face in solid.Faces():
        normal = face.normalAt() if face.geomType() == "PLANE" else None
        if normal is not None and abs(normal.z) < 1e-9:
            found.append(_wall(face, normal))
    return sorted(found)


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
    is_slot: bool
    """Whether the walls face each other; else they are the sides of a rib, a key or a flat."""

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
    for index, one in enumerate(walls):
        for other in walls[index + 1 :]:
            pair = _pair(one, other)
            if pair and pair.ends[1] - pair.ends[0] > 0.5 * (one.end - one.start):
                possible.append(pair)
    found: list[Pair] = []
    left = list(walls)
    # A slot is told by its width; only what no slot has for its side is a rib's.
    for pair in sorted(possible, key=lambda one: (not one.is_slot, one.width, one.walls)):
        if all(wall in left for wall in pair.walls):
            found.append(pair)
            left = [wall for wall in left if wall not in pair.walls]
    return found, left


def _pair(one: Wall, other: Wall) -> Pair | None:
    """Return two walls as a pair, if they look in opposite directions and stand between the same heights."""
    turned = abs((other.outwards - one.outwards) % (2.0 * pi) - pi)
    if turned > 1e-4 or abs(one.bottom - other.bottom) > _SAME or abs(one.top - other.top) > _SAME:
        return None
    away = one.offset + other.offset
    if abs(away) < _SAME:
        return None
    # Along the first wall's normal, the second one is at minus its own offset.
    return Pair((one, other), is_slot=away < 0.0)
