"""Sections of the whole module: half planes from its axis that together cut every kind of part, two to a section."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, cos, degrees, pi, radians, sin

import cadquery as cq
import numpy as np
from manifold3d import CrossSection, Manifold
from matplotlib.path import Path

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.drawing.projection import Chain, Point, seen_lines
from tvimdesign.cad.export.mesh import Array, Instance
from tvimdesign.cad.export.print_files import body_of
from tvimdesign.cad.geometry.kinds import KINDS, is_of_structure, kind_of

_HAIR = 1e-3  # Distance of a plane from the axis [mm]: faces that lie in it would be cut or not by chance
_STRAIGHT, _SNAP = radians(15.0), radians(1.6)  # Planes near a multiple of the first are taken there
_STEP = 0.1  # Length of the pieces of lines that are looked at [mm]
_CLEAR = 0.8  # Least way from the place pointed at to the outline for a section to be preferred [mm on paper]
_body = lru_cache(maxsize=256)(body_of)


@dataclass(frozen=True)
class AssemblySection:
    """A section of two half planes from the axis, turned into one: azimuths [rad] of the right one and the left one."""

    letter: str
    right: float
    left: float
    parts: Mapping[str, CrossSection]  # By name: x to the right, z upwards [mm]

    def behind(self, solids: Mapping[str, cq.Shape], points: Mapping[str, Array]) -> list[Chain]:
        """Return what is seen behind the cut faces: of parts that are not cut, and of the structure's that are alone.

        `points` are the vertices of the parts' meshes.
        """
        lines = list[Chain]()
        for turn, side in ((self.right, 1.0), (self.left + pi, -1.0)):
            shown = list[cq.Shape]()
            for name, solid in solids.items():
                along = side * (points[name] @ (cos(turn), sin(turn), 0.0))
                ahead = points[name] @ (-sin(turn), cos(turn), 0.0)
                is_cut = min(along.min(), ahead.min()) < 0.0
                if min(along.max(), ahead.max()) > 0.0 and (not is_cut or (name in KINDS and is_of_structure(name))):
                    there = solid.rotate(cq.Vector(), cq.Vector(0, 0, 1), -degrees(turn))
                    size = 4.0 * float(np.abs(points[name]).max())
                    corner = cq.Vector(0.5 * (side - 1.0) * size, 0, -0.5 * size)
                    shown.append(there.intersect(cq.Solid.makeBox(size, size, size, corner)) if is_cut else there)
            lines += seen_lines(cq.Compound.makeCompound(shown), (0, -1, 0))
        return list(
            _outside(lines, [Path(ring) for ring in _together(self.parts.values()).offset(_HAIR).to_polygons()])
        )


def outlines(part: CrossSection) -> tuple[Chain, ...]:
    """Return the closed outlines of a cut part."""
    return tuple(Chain(tuple((x, y) for x, y in [*ring.tolist(), ring[0].tolist()])) for ring in part.to_polygons())


def _together(parts: Iterable[CrossSection]) -> CrossSection:
    return sum(parts, CrossSection())


def _outside(lines: Sequence[Chain], rings: Sequence[Path]) -> Iterator[Chain]:
    """Yield the pieces of lines that lie within no cut face, nor on the axis where two halves meet."""
    fine = list[Array]()
    for line in lines:
        points = np.array(line.points)
        way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
        finer = np.union1d(way, np.linspace(0.0, way[-1], ceil(way[-1] / _STEP) + 1))
        fine.append(np.stack([np.interp(finer, way, column) for column in points.T], axis=-1))
    middles = np.concatenate([0.5 * (points[1:] + points[:-1]) for points in fine])
    inside = np.array([ring.contains_points(middles) for ring in rings]).sum(axis=0) % 2 == 1
    hidden = inside | (np.abs(middles[:, 0]) < _HAIR)
    for points, off in zip(fine, np.split(hidden, np.cumsum([len(points) - 1 for points in fine])[:-1]), strict=True):
        ends = np.flatnonzero(np.diff(np.concatenate([[True], off, [True]]).astype(int)))
        for start, end in zip(ends[::2], ends[1::2], strict=True):
            yield Chain(tuple((x, y) for x, y in points[start : end + 1].tolist()))


def assembly_sections(placed: Mapping[str, Instance]) -> list[AssemblySection]:
    """Return the fewest sections, as a greedy choice finds them, that together cut every kind of part."""
    bodies = dict[str, Manifold]()
    for name, instance in placed.items():
        with suppress(GeometryError):  # a mesh that does not close fails a check of its own
            bodies[name] = _body(kind_of(name), instance.mesh).transform(instance.matrix[:3])
    points = {name: placed[name].points() for name in bodies}
    size = 4.0 * max(float(np.abs(at).max()) for at in points.values())

    def met(azimuth: float) -> list[str]:
        """Return the parts on both sides of a plane that are not all behind the axis."""
        along, across = (cos(azimuth), sin(azimuth), 0.0), (sin(azimuth), -cos(azimuth), 0.0)
        return [
            name for name, at in points.items() if np.ptp(np.sign(at @ across + _HAIR)) and (at @ along).max() > 0.0
        ]

    def cut(azimuth: float, side: float) -> dict[str, CrossSection]:
        """Cut along a half plane, drawn on the right (1) or the left (-1) side."""
        x, y = side * cos(azimuth), side * sin(azimuth)
        half = CrossSection.square((size, 2.0 * size)).translate((-_HAIR if side > 0.0 else _HAIR - size, -size))
        to_view = np.array([[x, y, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [y, -x, 0.0, _HAIR]])
        parts = {name: (bodies[name].transform(to_view).slice(0.0) ^ half).simplify(_HAIR) for name in met(azimuth)}
        return {name: part for name, part in parts.items() if part.area() > _HAIR}

    middles = {float(np.arctan2(y, x)) for x, y, _ in (at.mean(axis=0) for at in points.values())}
    straight = {_STRAIGHT * round(azimuth / _STRAIGHT) for azimuth in middles}
    straight = {azimuth for azimuth in straight if min(abs(azimuth - middle) for middle in middles) < _SNAP}
    kinds = {azimuth: {*map(kind_of, met(azimuth))} for azimuth in sorted(straight | middles)}
    left, chosen = set[str]().union(*kinds.values()), list[float]()
    while left and kinds:
        # Of equals, that which is straight and lies opposite to the one before it.
        before = chosen[-1] if chosen else pi
        ranks = ((len(there & left), at in straight, -cos(at - before), at) for at, there in kinds.items())
        best = max(ranks)[-1]
        del kinds[best]
        if new := left & {*map(kind_of, cut(best, 1.0))}:
            chosen.append(best)
            left -= new
    sections = []
    for start in range(0, len(chosen), 2):
        right, other = sorted([*chosen[start : start + 2], chosen[start] + pi][:2], key=cos, reverse=True)
        halves = cut(right, 1.0), cut(other, -1.0)
        names = [name for name in bodies if name in halves[0] or name in halves[1]]
        parts = {name: _together(half[name] for half in halves if name in half) for name in names}
        sections.append(AssemblySection("ABCDEFGH"[start // 2], right, other, parts))
    return sections


def _inside(part: CrossSection) -> Iterator[tuple[float, Point]]:
    """Yield a point well inside each piece of a cut part, with its distance from the outline [mm]."""
    for piece in (piece for piece in part.decompose() if piece.area() > _HAIR**2):
        left, low, right, high = piece.bounds()
        depth = 0.5 * min(right - left, high - low)
        while (inner := piece.offset(-depth)).is_empty() and depth > _HAIR:
            depth *= 0.8
        yield from ((depth, (float(x), float(y))) for x, y in (ring[0] for ring in inner.to_polygons()[:1]))


def pointed_at(
    items: Mapping[int, Sequence[str]], sections: Sequence[AssemblySection], scale: float
) -> list[dict[int, list[Point]]]:
    """Return where each item can be pointed at, by its number, in one section; `items` are the kinds that each is.

    That is the first section that shows it well at a scale, else that which shows it best. What others overlap is
    pointed at only if nothing else is left.
    """
    chosen: list[dict[int, list[Point]]] = [{} for _ in sections]
    for number, kinds in items.items():
        places = list[list[tuple[float, Point]]]()
        for section in sections:
            own = {name: part for name, part in section.parts.items() if kind_of(name) in kinds}
            others = _together(part for name, part in section.parts.items() if name not in own)
            free = [depth for part in own.values() for depth in _inside(part - others)]
            deep = free or [depth for part in own.values() for depth in _inside(part)]
            places.append(sorted(deep, reverse=True))
        best = [place[0][0] * scale if place else 0.0 for place in places]
        index = next((index for index, depth in enumerate(best) if depth > _CLEAR), int(np.argmax(best)))
        if best[index]:
            least = min(_CLEAR, 0.9 * best[index])
            chosen[index][number] = [at for depth, at in places[index] if depth * scale > least]
    return chosen
