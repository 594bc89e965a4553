"""Finds pockets and vanes about the axis: arcs between two end walls whose planes hold the axis."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from math import atan2, cos, pi, sin

from tvimdesign.cad.geometry.features import Cylinder
from tvimdesign.cad.geometry.upright_walls import Wall

CORNER = 2.0
"""Radius [mm] up to which an arc is the corner of a pocket, whose place its walls say."""
_SAME = 1e-3
"""Lengths [mm] that differ by less are one."""


@dataclass(frozen=True)
class Sector:
    """A pocket or a vane about the axis; angles in rad."""

    ends: tuple[Wall, Wall]
    arcs: tuple[Cylinder, ...]
    is_pocket: bool
    first: float
    """Azimuth of the end wall at which it begins."""
    span: float
    """Between its end walls."""

    @property
    def middle(self) -> float:
        """Azimuth of its middle."""
        return self.first + 0.5 * self.span

    @property
    def radii(self) -> tuple[float, ...]:
        """Of its innermost and its outermost arc; one where it has no more."""
        found = sorted({round(arc.radius, 4) for arc in self.arcs})
        return (found[0], found[-1]) if len(found) > 1 else tuple(found)

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
    arcs = [one for one in cylinders if not one.is_round]
    levels: dict[Hashable, list[Wall]] = {}
    for wall in walls:
        if wall.is_radial:
            levels.setdefault((wall.bottom, wall.top, *(round(radius, 3) for radius in wall.radii)), []).append(wall)
    found = [one for group in levels.values() for one in _of_height(group, arcs)]
    told = {face for one in found for face in one.faces}
    return found, [arc for arc in arcs if arc not in told], [wall for wall in walls if wall not in told]


def _of_height(walls: Sequence[Wall], arcs: Sequence[Cylinder]) -> list[Sector]:
    """Return the sectors between walls of one height and reach: those between which an arc runs."""
    around = sorted(walls, key=_azimuth)
    found = []
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
            found.append(Sector((wall, following), whole, _empty_beyond(wall), first, span))
    return found


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


def _apart(one: float, other: float) -> float:
    """Return the difference of two azimuths, between -pi and pi."""
    return (one - other + pi) % (2.0 * pi) - pi


def _same(one: float, other: float) -> bool:
    return abs(one - other) < _SAME
