"""A module drafted: every part as closed triangles (manifold3d), a hundred times faster than exact solids.

A circle is a polygon within `CHORD` of it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import acos, atan2, ceil, cos, pi, radians
from typing import Any

import numpy as np
from manifold3d import CrossSection, FillRule, JoinType, Manifold, OpType
from manifold3d import Mesh as ManifoldMesh
from numpy.typing import NDArray

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import MODULES, installed_coils, lifts, spring_locations
from tvimdesign.cad.export.mesh import Instance, Mesh, spring_meshes
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.exact_kernel import Arc, Outline, Point, Segment, placement
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.geometry.solids import drawn_by

CHORD = 0.2  # Largest distance of a polygon from its circle [mm]
_FEWEST, _MOST = 16, 120  # Corners of a circle
_LINE = 2  # Points of a segment that is a line
_FLAT = 1e-9  # Doubled area [mm2] below which three points are on a line
Array = NDArray[np.float64]


class DraftSolid:
    """A closed mesh and where it stands; copies share the mesh."""

    def __init__(self, body: Manifold, matrix: Array | None = None) -> None:
        """`matrix` is 4 x 4, from the mesh's coordinates to the module's."""
        self.body = body
        self.matrix = np.eye(4) if matrix is None else matrix

    @property
    def placed(self) -> Manifold:
        """The mesh in the module's coordinates."""
        return self.body if np.array_equal(self.matrix, np.eye(4)) else self.body.transform(self.matrix[:3])

    def moved(self, location: Any) -> DraftSolid:
        """Return the same at another place: a location of CadQuery."""
        return DraftSolid(self.body, placement(location) @ self.matrix)

    def cut(self, *others: DraftSolid) -> DraftSolid:
        """Return less what others take of it."""
        return self._with(others, OpType.Subtract)

    def fuse(self, *others: DraftSolid) -> DraftSolid:
        """Return with others that it overlaps or touches."""
        return self._with(others, OpType.Add)

    def clean(self) -> DraftSolid:
        """Return itself: triangles have no seams."""
        return self

    def _with(self, others: Sequence[DraftSolid], how: OpType) -> DraftSolid:
        return DraftSolid(Manifold.batch_boolean([self.placed, *(other.placed for other in others)], how))


class DraftKernel:
    """Draws meshes."""

    def cylinder(self, radius: float, bottom: float, top: float, at: Point) -> DraftSolid:
        """Draw a cylinder about an upright axis through a point."""
        return DraftSolid(_upright(_section(radius), bottom, top).body.translate((*at, 0.0)))

    def block(self, along_x: Point, width: float, bottom: float, top: float) -> DraftSolid:
        """Draw a block across the x axis, between two places on it."""
        start, end = along_x
        body = Manifold.cube((end - start, width, top - bottom))
        return DraftSolid(body.translate((start, -0.5 * width, bottom)))

    def cone(self, radius: float, base: float, tip: float, at: Point) -> DraftSolid:
        """Draw a cone about an upright axis through a point, from a disc at one level to its tip at another."""
        body = Manifold.extrude(_section(radius), abs(tip - base), scale_top=(0.0, 0.0))
        upright = body if tip > base else body.mirror((0.0, 0.0, 1.0))
        return DraftSolid(upright.translate((*at, base)))

    def foot(self, radius: float, fillet: float, level: float, at: Point) -> DraftSolid:
        """Draw a cylinder about an upright axis through a point, from a level as high as its fillet there is wide."""
        turns = np.linspace(0.0, 0.5 * pi, max(_corners(fillet, 0.5 * pi), 4) + 1)
        arc = np.stack((radius + fillet * (1.0 - np.sin(turns)), fillet * (1.0 - np.cos(turns))), -1)
        section = CrossSection([np.vstack(([[0.0, 0.0]], arc, [[0.0, fillet]]))])
        return DraftSolid(Manifold.revolve(section, corners_of(radius)).translate((*at, level)))

    def prism(self, outside: Outline, inside: Sequence[Outline], bottom: float, top: float) -> DraftSolid:
        """Draw what lies within an outline, less what lies within others."""
        section = _section(outside)
        for outline in inside:
            section -= _section(outline)
        return _upright(section, bottom, top)

    def tube(self, radius: float, path: Sequence[Arc]) -> DraftSolid:
        """Draw a round wire along arcs that follow each other without a kink."""
        ring = corners_of(radius)
        around = 2.0 * pi * np.arange(ring) / ring
        rings: list[Array] = []
        for start, centre, axis, angle in path:
            out, unit = np.subtract(start, centre), np.asarray(axis) / np.linalg.norm(axis)
            reach = float(np.linalg.norm(out))
            section = np.outer(np.cos(around), out / reach) + np.outer(np.sin(around), unit)
            for turn in np.linspace(0.0, angle, _corners(reach, abs(angle)) + 2)[(1 if rings else 0) :]:
                points = out + radius * section
                across = np.outer(points @ unit, unit)
                turned = across + np.cos(turn) * (points - across) + np.sin(turn) * np.cross(unit, points)
                rings.append(np.asarray(centre) + turned)
        return DraftSolid(_skinned(rings))

    def rounded(self, body: DraftSolid, radius: float) -> DraftSolid:
        """Draw an upright body with every upright edge rounded. Raises GeometryError where that leaves nothing."""
        placed = body.placed
        *_, bottom, _, _, top = placed.bounding_box()
        count = corners_of(radius)
        sharp = placed.slice(0.5 * (bottom + top))
        outer = sharp.offset(-radius, JoinType.Miter).offset(radius, JoinType.Round, 2.0, count)
        section = outer.offset(radius, JoinType.Miter).offset(-radius, JoinType.Round, 2.0, count)
        if section.is_empty():
            raise GeometryError(f"corners of {radius:.4g} mm do not fit; choose a smaller corner_radius")
        return _upright(section, bottom, top)


def _skinned(rings: Sequence[Array]) -> Manifold:
    """Return the body between rings of as many points, closed at both ends; outwards either way round."""
    count, last = len(rings[0]), (len(rings) - 1) * len(rings[0])
    here, after = np.arange(count), (np.arange(count) + 1) % count
    sides = [
        np.concatenate([np.stack((a + here, a + after, b + after), -1), np.stack((a + here, b + after, b + here), -1)])
        for a, b in ((i * count, (i + 1) * count) for i in range(len(rings) - 1))
    ]
    fan = np.arange(1, count - 1)
    ends = [np.stack((0 * fan, fan + 1, fan), -1), last + np.stack((0 * fan, fan, fan + 1), -1)]
    faces = np.concatenate([*sides, *ends]).astype(np.uint32)
    points = np.concatenate(rings).astype(np.float32)
    body = Manifold(ManifoldMesh(points, faces))
    return body if body.volume() > 0.0 else Manifold(ManifoldMesh(points, np.ascontiguousarray(faces[:, ::-1])))


def corners_of(radius: float) -> int:
    """Return the corners of the polygon that stands for a circle."""
    return _corners(radius, 2.0 * pi)


def _corners(radius: float, angle: float) -> int:
    """Return lines that stand for an arc."""
    step = 2.0 * acos(max(1.0 - CHORD / radius, 0.0)) if radius > CHORD else pi
    whole = min(max(4 * ceil(0.5 * pi / step), _FEWEST), _MOST)
    return max(ceil(whole * angle / (2.0 * pi)), 1)


def _upright(section: CrossSection, bottom: float, top: float) -> DraftSolid:
    return DraftSolid(Manifold.extrude(section, top - bottom).translate((0.0, 0.0, bottom)))


def _section(outline: Outline) -> CrossSection:
    if isinstance(outline, float | int):
        angles = 2.0 * pi * np.arange(corners_of(outline)) / corners_of(outline)
        return CrossSection([outline * np.stack((np.cos(angles), np.sin(angles)), -1)])
    return CrossSection([np.array([point for segment in outline for point in _points(segment)])], FillRule.NonZero)


def _points(segment: Segment) -> list[Point]:
    """Return points of a segment but its last, at which the next one begins."""
    if len(segment) == _LINE:
        return [segment[0]]
    start, middle, end = (complex(*point) for point in segment)
    chord, half = end - start, middle - start
    doubled = half.real * chord.imag - half.imag * chord.real
    if abs(doubled) < _FLAT:
        return [segment[0]]
    # The circle's centre, from the start: of equal distance from all three points.
    centre = 1j * (abs(half) ** 2 * chord - abs(chord) ** 2 * half) / (-2.0 * doubled)
    radius, first = abs(centre), -centre
    sweep = _turn(first, half - centre) + _turn(half - centre, chord - centre)
    count = _corners(radius, abs(sweep))
    points = [start + centre + first * complex(np.exp(1j * sweep * k / count)) for k in range(count)]
    return [(point.real, point.imag) for point in points]


def _turn(first: complex, second: complex) -> float:
    """Return angle [rad] from one direction to another, within a half turn."""
    across = first.real * second.imag - first.imag * second.real
    return atan2(across, first.real * second.real + first.imag * second.imag)


SHARP = 30.0  # Angle between two triangles [degrees] from which their common edge is drawn
AROUND = 8  # Points around a spring's wire


@dataclass(frozen=True)
class DraftMesh:
    """One part in its own coordinates [mm]; one row a point, a triangle or an edge."""

    points: Array
    normals: Array
    triangles: NDArray[np.int64]
    edges: Array  # Both ends of each sharp edge: x, y, z, x, y, z


@dataclass(frozen=True)
class Draft:
    """All parts of a module."""

    meshes: Mapping[str, DraftMesh]  # By kind
    places: Mapping[str, Array]  # 4 x 4 matrix of each part, by name
    lifts: Mapping[str, float]  # How far each part is lifted so that the module is seen apart [mm], by name


def draft_module(dims: Dimensions) -> Draft:
    """Draw every part. Raises GeometryError, naming the part, where one cannot be drawn."""
    with drawn_by(DraftKernel()):
        solids = {kind: _drawn(kind, draw, dims) for kind, draw in MODULES[dims.mode].drawn(dims).items()}
        placed = MODULES[dims.mode].stand(dims, solids)
    bodies = {kind_of(name): solid.body for name, solid in placed.items()}
    meshes = {kind: _mesh(body) for kind, body in bodies.items()}
    meshes |= {kind: _tube(mesh) for kind, mesh in spring_meshes(installed_coils(dims), AROUND).items()}
    places = {name: solid.matrix for name, solid in placed.items()}
    places |= {name: placement(location) for name, location in spring_locations(dims).items()}
    seen = {kind: Mesh(mesh.points, mesh.triangles) for kind, mesh in meshes.items()}
    apart = lifts({name: Instance(seen[kind_of(name)], matrix) for name, matrix in places.items()})
    return Draft(meshes, places, apart)


def _drawn(kind: str, draw: object, dims: Dimensions) -> DraftSolid:
    assert callable(draw)
    try:
        solid: DraftSolid = draw(dims)
    except GeometryError as error:
        raise GeometryError(f"{kind}: {error}") from error
    if solid.body.is_empty():
        raise GeometryError(f"{kind}: nothing is left of it")
    return solid


def _mesh(body: Manifold) -> DraftMesh:
    """Return triangles with a normal at each corner, which a sharp edge parts."""
    shaded = body.calculate_normals(0, SHARP).to_mesh()
    table = np.asarray(shaded.vert_properties, dtype=float)
    return DraftMesh(table[:, :3], table[:, 3:6], np.asarray(shaded.tri_verts, dtype=np.int64), _edges(body))


def _edges(body: Manifold) -> Array:
    """Return edges whose two triangles meet at a sharp angle."""
    mesh = body.to_mesh()
    points, corners = np.asarray(mesh.vert_properties, dtype=float)[:, :3], np.asarray(mesh.tri_verts, dtype=np.int64)
    across = np.cross(points[corners[:, 1]] - points[corners[:, 0]], points[corners[:, 2]] - points[corners[:, 0]])
    normals = across / np.maximum(np.linalg.norm(across, axis=1), 1e-30)[:, None]
    ends = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    key = np.sort(ends, axis=1) @ [len(points), 1]
    order = np.argsort(key, kind="stable")
    first, second = order[0::2], order[1::2]  # a closed mesh has each edge twice
    count = len(corners)
    bend = np.einsum("ij,ij->i", normals[first % count], normals[second % count])
    sharp = ends[first[bend < cos(radians(SHARP))]]
    return np.asarray(points[sharp].reshape(-1, 6))


def _tube(mesh: Mesh) -> DraftMesh:
    """Return a spring's wire, shaded round; its edges are not drawn."""
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    normals = np.zeros_like(mesh.vertices)
    for i in range(3):
        np.add.at(normals, mesh.faces[:, i], across)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-30)[:, None]
    return DraftMesh(mesh.vertices, normals, mesh.faces, np.empty((0, 6)))
