"""One coarse mesh for each rigid body, in metres: for pictures in a simulator, not for print and not for contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import cadquery as cq
import numpy as np
import trimesh

from tvimdesign.cad.assembly.assembly import installed_coils
from tvimdesign.cad.export.mesh import Instance, Mesh, solid_mesh, spring_mesh
from tvimdesign.cad.export.print_files import stl_bytes
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.geometry.placement import placement

CHORD = 0.2
"""Largest distance of a mesh from its part [mm]."""
TURN = 0.5
"""Largest angle between neighbouring triangles of a curved face [rad]."""
AROUND = 6
"""Points around a spring's wire."""
_MM = 1e-3


def coarse_meshes(dims: Dimensions, drawn: Mapping[str, cq.Solid]) -> dict[str, Mesh]:
    """A coarse mesh of each kind of part, in its own coordinates [mm]."""
    coils = installed_coils(dims)
    meshes = {kind: solid_mesh(solid, CHORD, TURN) for kind, solid in drawn.items()}
    meshes["spring_right"] = spring_mesh(coils["spring_right"], AROUND)
    meshes["spring_left"] = spring_mesh(coils["spring_left"], AROUND).mirrored()
    return meshes


def body_stl(meshes: Mapping[str, Mesh], placed: Mapping[str, cq.Solid], names: Sequence[str]) -> bytes:
    """The named parts where they stand as one binary STL in metres."""
    parts = [Instance(meshes[kind_of(name)], placement(placed[name].location())) for name in names]
    first = np.cumsum([0] + [len(part.mesh.vertices) for part in parts])
    faces = np.concatenate([part.mesh.faces + start for part, start in zip(parts, first, strict=False)])
    points = np.concatenate([part.points() for part in parts]) * _MM
    return stl_bytes(trimesh.Trimesh(points, faces, process=False))
