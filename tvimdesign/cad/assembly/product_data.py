"""What a file says of a part beside its shape, and the placed meshes of the assembly as binary glTF."""

from __future__ import annotations

from collections.abc import Mapping

import cadquery as cq
import numpy as np
import trimesh

from tvimdesign.cad.assembly.assembly import installed_coils
from tvimdesign.cad.export.mesh import Instance, Mesh, part_meshes
from tvimdesign.cad.export.step_file import Product
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import KINDS, kind_of
from tvimdesign.cad.geometry.outlines import placement
from tvimdesign.study.design import Design

_TO_GLTF = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1.0]])
"""glTF measures in metres and its y axis points up."""


def product(design: Design, kind: str) -> Product:
    """Return what a STEP file says of a kind of part."""
    made_of = KINDS[kind]
    material = design.choices.get(made_of.material, made_of.material)
    return Product(name=kind, colour=made_of.colour, material=material, density=design.value(made_of.density))


def instances(
    dims: Dimensions, drawn: Mapping[str, cq.Solid], placed: Mapping[str, cq.Solid],
    known: Mapping[str, Mesh] | None = None, rotor_angle: float = 0.0,
) -> dict[str, Instance]:  # fmt: skip
    """Mesh and place of every part, by name; `placed` are the solids with the rotor at its angle [rad].

    `known` are meshes of drawn parts that are made already.
    """
    meshes = part_meshes(drawn, installed_coils(dims, rotor_angle), known or {})
    return {name: Instance(meshes[kind_of(name)], placement(solid.location())) for name, solid in placed.items()}


def glb_bytes(placed: Mapping[str, Instance]) -> bytes:
    """Return the assembly as binary glTF, named and coloured; copies of a part share its mesh."""
    scene = trimesh.Scene()
    known: set[str] = set()
    for name, instance in placed.items():
        kind = kind_of(name)
        matrix = _TO_GLTF @ instance.matrix
        if kind in known:
            scene.graph.update(frame_to=name, matrix=matrix, geometry=kind)
            continue
        known.add(kind)
        material = trimesh.visual.material.PBRMaterial(
            name=kind, baseColorFactor=[*map(_linear, KINDS[kind].colour), 1.0], metallicFactor=0.1, roughnessFactor=0.6
        )
        body = trimesh.Trimesh(
            instance.mesh.vertices, instance.mesh.faces, process=False,
            visual=trimesh.visual.TextureVisuals(material=material),
        )  # fmt: skip
        scene.add_geometry(body, node_name=name, geom_name=kind, transform=matrix)
    return bytes(scene.export(file_type="glb", include_normals=True))


def _linear(part: float) -> float:
    """One part of a colour of the screen (sRGB, IEC 61966-2-1) in the linear light that glTF asks for."""
    return part / 12.92 if part <= 0.04045 else float(((part + 0.055) / 1.055) ** 2.4)
