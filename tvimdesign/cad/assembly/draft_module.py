"""A module drafted: every part as triangles with normals and sharp edges, from the same drawing as the exact one."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, radians

import numpy as np
from manifold3d import Manifold
from numpy.typing import NDArray

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import MODULES, installed_coils, lifts, spring_locations
from tvimdesign.cad.export.mesh import Instance, Mesh, spring_meshes
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.draft_kernel import DraftKernel, DraftSolid
from tvimdesign.cad.geometry.exact_kernel import placement
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.geometry.solids import drawn_by

Array = NDArray[np.float64]
SHARP = 30.0
"""Angle between two triangles [degrees] from which their common edge is drawn."""
AROUND = 8
"""Points around a spring's wire."""


@dataclass(frozen=True)
class DraftMesh:
    """One part in its own coordinates [mm]; one row a point, a triangle or an edge."""

    points: Array
    normals: Array
    triangles: NDArray[np.int64]
    edges: Array
    """Both ends of each sharp edge: x, y, z, x, y, z."""


@dataclass(frozen=True)
class Draft:
    """All parts of a module."""

    meshes: Mapping[str, DraftMesh]
    """By kind."""
    places: Mapping[str, Array]
    """4 x 4 matrix of each part, by name."""
    lifts: Mapping[str, float]
    """How far each part is lifted so that the module is seen apart [mm], by name."""


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
