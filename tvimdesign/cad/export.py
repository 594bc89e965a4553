"""Writes STEP and STL of each part, STEP and GLB of the assembly; each file appears whole or not at all."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import cadquery as cq
import numpy as np
import trimesh

from tvimdesign.cad.assembly import free_springs, installed_coils, place
from tvimdesign.cad.dimensions import Dimensions
from tvimdesign.cad.kinds import KINDS, kind_of
from tvimdesign.cad.mesh import Array, Instance, Mesh, part_meshes
from tvimdesign.cad.outcome import Check
from tvimdesign.cad.springs import free_coil
from tvimdesign.cad.step import Product, write_assembly, write_part
from tvimdesign.errors import GeometryError
from tvimdesign.files import write_whole
from tvimdesign.study.design import Design

_TO_GLTF = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1.0]])
"""glTF measures in metres and its y axis points up."""


_DIGITS = (6, 5, 7)
"""Decimals of a millimetre to which a mesh's vertices are merged. A coordinate can lie where one rounding splits it
from its neighbour of the next face; not where three do."""


def export(
    design: Design, dims: Dimensions, drawn: Mapping[str, cq.Solid], out: Path, progress: Callable[[str], None]
) -> tuple[list[str], list[Check]]:
    """Write every file into `out`; returns their paths relative to it, and a check of each mesh.

    A mesh that does not close is a check that fails, and its file is left out; the others are written. Raises
    GeometryError where a STEP file does not read back as what was written.
    """
    folder = out / "parts"
    folder.mkdir(parents=True, exist_ok=True)
    files: list[str] = []
    checks: list[Check] = []
    free = free_springs(dims, progress)
    coil = free_coil(dims)
    meshes = part_meshes(drawn, {"spring_right": coil, "spring_left": coil})
    for kind, solid in {**drawn, **free}.items():
        progress(f"writing {kind}")
        write_part(folder / f"{kind}.step", solid, product(design, kind))
        _read_back(folder / f"{kind}.step", kind, solid.Volume())
        files.append(f"parts/{kind}.step")
        try:
            write_whole(folder / f"{kind}.stl", stl_bytes(kind, meshes[kind]))
            files.append(f"parts/{kind}.stl")
            checks.append(Check(f"{kind}.stl", 0.0, 0.0, True, f"{kind}: its mesh is watertight"))
        except GeometryError as error:
            checks.append(Check(f"{kind}.stl", 1.0, 0.0, False, str(error)))
    progress("writing assembly")
    placed = place(dims, drawn)
    products = {name: product(design, kind_of(name)) for name in placed}
    write_assembly(out / "assembly.step", design.name, placed, products)
    write_whole(out / "assembly.glb", glb_bytes(instances(dims, drawn, placed)))
    return [*files, "assembly.step", "assembly.glb"], checks


def _read_back(path: Path, kind: str, volume: float) -> None:
    """Raise GeometryError where a written part does not come back from its STEP file as the same one solid."""
    read = cq.importers.importStep(str(path)).vals()
    if len(read) != 1 or not isinstance(read[0], cq.Solid) or abs(read[0].Volume() / volume - 1.0) > 1e-4:
        raise GeometryError(f"{kind}: {path.name} does not read back as the one solid that was written")


def product(design: Design, kind: str) -> Product:
    """Return what a STEP file says of a kind of part."""
    made_of = KINDS[kind]
    material = design.choices.get(made_of.material, made_of.material)
    return Product(name=kind, colour=made_of.colour, material=material, density=design.value(made_of.density))


def instances(dims: Dimensions, drawn: Mapping[str, cq.Solid], placed: Mapping[str, cq.Solid]) -> dict[str, Instance]:
    """Mesh and place of every part at rest, by name."""
    meshes = part_meshes(drawn, installed_coils(dims))
    return {name: Instance(meshes[kind_of(name)], _matrix(solid.location())) for name, solid in placed.items()}


def stl_bytes(name: str, mesh: Mesh) -> bytes:
    """Return a mesh as binary STL in millimetres; raises GeometryError where it does not enclose a body."""
    for digits in _DIGITS:
        body = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
        body.merge_vertices(digits_vertex=digits, merge_norm=True, merge_tex=True)
        if body.is_watertight and body.volume > 0.0:
            return bytes(body.export(file_type="stl"))
    raise GeometryError(f"{name}: its triangle mesh is not watertight; the STEP file is sound, print from that")


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
            name=kind, baseColorFactor=[*KINDS[kind].colour, 1.0], metallicFactor=0.1, roughnessFactor=0.6
        )
        body = trimesh.Trimesh(
            instance.mesh.vertices, instance.mesh.faces, process=False,
            visual=trimesh.visual.TextureVisuals(material=material),
        )  # fmt: skip
        scene.add_geometry(body, node_name=name, geom_name=kind, transform=matrix)
    return bytes(scene.export(file_type="glb", include_normals=True))


def _matrix(location: cq.Location) -> Array:
    """4 x 4 matrix of a location."""
    place_of = location.wrapped.Transformation()
    rows = [[place_of.Value(row, column) for column in range(1, 5)] for row in range(1, 4)]
    return np.array([*rows, [0.0, 0.0, 0.0, 1.0]])
