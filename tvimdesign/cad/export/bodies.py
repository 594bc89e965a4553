"""Meshes as closed bodies of manifold3d: what is cut from them, and how far they are apart, in milliseconds."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from manifold3d import Error, Manifold, Mesh64

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.export.mesh import Mesh
from tvimdesign.cad.export.print_files import closed


@lru_cache(maxsize=64)
def body_of(name: str, mesh: Mesh) -> Manifold:
    """The body that a mesh encloses. Raises GeometryError where it encloses none."""
    merged = closed(name, mesh)
    body = Manifold(Mesh64(np.array(merged.vertices, dtype=np.float64), np.array(merged.faces, dtype=np.uint64)))
    if body.status() != Error.NoError:
        raise GeometryError(f"{name}: its triangle mesh is no body: {body.status()}")
    return body


def mesh_of(body: Manifold) -> Mesh:
    """The triangles of a body."""
    found = body.to_mesh64()
    return Mesh(np.array(found.vert_properties[:, :3]), np.array(found.tri_verts, dtype=np.int64))
