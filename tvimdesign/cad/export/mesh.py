"""Triangle meshes of the parts: OCC's for the drawn parts, a tube along the wire's centre for the springs."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil, pi, sqrt
from pathlib import Path

import cadquery as cq
import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.TopAbs import TopAbs_Orientation
from OCP.TopLoc import TopLoc_Location

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.geometry.spring_solids import Coil

CHORD = 0.05  # Largest distance of a mesh from its part [mm]
TURN = 0.15  # Largest angle between neighbouring triangles of a curved face [rad]
_FINER = (1.0, 2.0, 4.0)
"""Divisors of the chord: the kernel leaves a face out at one chord, seldom, and takes it at a finer one."""
RING = 24  # Points around the wire, as far out as gives their polygon the area of the wire's section
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles of one part; vertices on a sharp edge are there once for each face, so that shading stays crisp.

    One is the same as itself alone, so that what was made of it can be found again.
    """

    vertices: Array  # Points [mm], one a row
    faces: NDArray[np.int64]  # Three vertices a triangle, counter-clockwise seen from outside

    def mirrored(self) -> "Mesh":
        """Return the mirror image in the plane y = 0."""
        return Mesh(self.vertices * [1.0, -1.0, 1.0], self.faces[:, ::-1])


@dataclass(frozen=True)
class Instance:
    """One placed part: its mesh and where it stands."""

    mesh: Mesh
    matrix: Array  # 4 x 4, from the part's coordinates to the module's

    def points(self) -> Array:
        """Return its vertices where they stand in the module [mm], one a row."""
        return np.asarray(self.mesh.vertices @ self.matrix[:3, :3].T + self.matrix[:3, 3])


def write_mesh(path: Path, mesh: Mesh) -> None:
    """Keep a mesh as it is, to the last digit."""
    np.savez(path, vertices=mesh.vertices, faces=mesh.faces)


def read_mesh(path: Path) -> Mesh:
    """Return a mesh that `write_mesh` has kept."""
    with np.load(path) as arrays:
        return Mesh(arrays["vertices"], arrays["faces"])


def solid_mesh(solid: cq.Solid, chord: float = CHORD, turn: float = TURN) -> Mesh:
    """Triangulate a solid in its own coordinates, to a distance [mm] and an angle between triangles [rad]."""
    patches = [mesh for _, mesh in face_meshes(solid, chord, turn)]
    first = np.cumsum([0] + [len(mesh.vertices) for mesh in patches])
    faces = [mesh.faces + start for mesh, start in zip(patches, first, strict=False)]
    return Mesh(np.concatenate([mesh.vertices for mesh in patches]), np.concatenate(faces))


def face_meshes(solid: cq.Solid, chord: float = CHORD, turn: float = TURN) -> list[tuple[cq.Face, Mesh]]:
    """Triangulate a solid, face by face; neighbours have the same points on the edge between them."""
    for finer in _FINER:
        # A fresh copy: the kernel keeps triangles with a shape, and gives those of an earlier setting.
        fresh = solid.located(cq.Location()).copy()
        BRepMesh_IncrementalMesh(fresh.wrapped, chord / finer, False, turn, False)
        patches = [(face, _patch(face)) for face in fresh.Faces()]
        whole = [(face, patch) for face, patch in patches if patch is not None]
        if len(whole) == len(patches):
            return whole
    raise GeometryError("a face has no triangles; the part cannot be meshed")


def _patch(face: cq.Face) -> Mesh | None:
    """Return the kernel's triangles of one face, where it made any."""
    location = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face.wrapped, location)
    if mesh is None:
        return None
    points = [mesh.Node(index) for index in range(1, mesh.NbNodes() + 1)]
    if not location.IsIdentity():
        move = location.Transformation()
        points = [point.Transformed(move) for point in points]
    corners = np.array([mesh.Triangle(index).Get() for index in range(1, mesh.NbTriangles() + 1)], dtype=np.int64) - 1
    inside_out = face.wrapped.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
    vertices = np.array([(point.X(), point.Y(), point.Z()) for point in points])
    return Mesh(vertices, corners[:, ::-1] if inside_out else corners)


def spring_mesh(coil: Coil, points: int = RING) -> Mesh:
    """Return the tube around the wire's centre, of so many points around it.

    OCC takes seconds for a swept helix, and the file is ten times as large.
    """
    centre, normal, tangent = wire_centre(coil)
    binormal = np.cross(tangent, normal)
    angle = np.arange(points) * 2.0 * pi / points
    ring = np.cos(angle)[:, None] * normal[:, None, :] + np.sin(angle)[:, None] * binormal[:, None, :]
    radius = 0.5 * coil.wire_diameter * np.sqrt((2.0 * pi / points) / np.sin(2.0 * pi / points))
    tube = (centre[:, None, :] + radius * ring).reshape(-1, 3)
    here = np.arange(points)
    following = (here + 1) % points
    first = np.arange(len(centre) - 1)[:, None] * points
    a, b = first + here, first + following
    sides = [np.stack((a, b, b + points), -1), np.stack((a, b + points, a + points), -1)]
    start_cap, end_cap = len(tube) + here, len(tube) + points + here
    fan = np.arange(1, points - 1)
    caps = [
        np.stack((np.full_like(fan, start_cap[0]), start_cap[fan + 1], start_cap[fan]), -1),
        np.stack((np.full_like(fan, end_cap[0]), end_cap[fan], end_cap[fan + 1]), -1),
    ]
    vertices = np.concatenate((tube, tube[:points], tube[-points:]))
    return Mesh(vertices, np.concatenate([part.reshape(-1, 3) for part in (*sides, *caps)]))


def wire_centre(coil: Coil, points: int = 0) -> tuple[Array, Array, Array]:
    """Return points along the wire's centre from tang to leg; the unit vectors there away from the coil's axis, and
    along.

    The coils have so many `points`, or as many as keep within the chord.
    """
    rise, up = coil.rise, np.array([0.0, 0.0, 1.0])
    azimuth = coil.start_azimuth + np.linspace(0.0, 2.0 * pi * coil.turns, points or coil_points(coil))
    radial = np.stack((np.cos(azimuth), np.sin(azimuth), 0.0 * azimuth), -1)
    around = np.cross(up, radial)
    level = coil.start_level + coil.pitch * (azimuth - azimuth[0]) / (2.0 * pi)
    helix = 0.5 * coil.diameter * radial + level[:, None] * up
    climb = np.cos(rise) * around + np.sin(rise) * up
    slope = np.linspace(0.5 * pi, rise, 12)[:-1, None]
    outward = np.sin(slope) * around[0] - np.cos(slope) * up
    bend = helix[0] + coil.bend_radius * (np.sin(rise) * around[0] - np.cos(rise) * up - outward)
    bending = np.cos(slope) * around[0] + np.sin(slope) * up
    tang_end = bend[0] - coil.tang_length * up
    leg_end = helix[-1] + coil.leg_length / np.cos(rise) * climb[-1]
    centre = np.vstack((tang_end, bend, helix, leg_end))
    outwards = np.vstack((np.repeat(radial[:1], 1 + len(bend), axis=0), radial, radial[-1:]))
    return centre, outwards, np.vstack((up, bending, climb, climb[-1:]))


def coil_points(coil: Coil) -> int:
    """Return points along the coils whose chords are nowhere further than `CHORD` from the wire's centre."""
    step = min(0.25, 2.0 * sqrt(CHORD / coil.diameter))
    return ceil(2.0 * pi * coil.turns / step) + 1


def part_meshes(drawn: Mapping[str, cq.Solid], coils: Mapping[str, Coil], known: Mapping[str, Mesh]) -> dict[str, Mesh]:
    """Return mesh of each kind of part in its own coordinates; `coils` says which shape the springs have.

    `known` are those that are made already.
    """
    meshes = {kind: known[kind] if kind in known else solid_mesh(solid) for kind, solid in drawn.items()}
    return meshes | spring_meshes(coils)


def spring_meshes(coils: Mapping[str, Coil], points: int = RING) -> dict[str, Mesh]:
    """Return meshes of the springs by kind."""
    right = {kind: spring_mesh(coil, points) for kind, coil in coils.items()}
    return {kind: mesh if kind == "spring_right" else mesh.mirrored() for kind, mesh in right.items()}
