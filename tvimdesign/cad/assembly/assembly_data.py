"""The assembly for programs that show it: placed meshes, binary glTF, and of each part what it is and how it moves."""

import json
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import cadquery as cq
import numpy as np
import trimesh

from tvimdesign.cad.assembly.assembly import installed_coils, lifts
from tvimdesign.cad.assembly.assembly_note import WrittenStep, coming, written_steps
from tvimdesign.cad.assembly.bill_of_materials import Item
from tvimdesign.cad.export.mesh import RING, Instance, Mesh, coil_points, part_meshes, wire_centre
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.exact_kernel import placement
from tvimdesign.cad.geometry.kinds import KINDS, TURNING, kind_of
from tvimdesign.study import Design

_TO_GLTF = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1.0]])
"""glTF measures in metres and its y axis points up."""


def instances(
    dims: Dimensions, drawn: Mapping[str, cq.Solid], placed: Mapping[str, cq.Solid],
    known: Mapping[str, Mesh] | None = None, rotor_angle: float = 0.0,
) -> dict[str, Instance]:  # fmt: skip
    """Return mesh and place of every part, by name; `placed` are the solids with the rotor at its angle [rad].

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
    """Return one part of a colour of the screen (sRGB, IEC 61966-2-1) in the linear light that glTF asks for."""
    return part / 12.92 if part <= 0.04045 else float(((part + 0.055) / 1.055) ** 2.4)


SHARES = (-1.0, -0.5, 0.5, 1.0)
"""Of the stroke, at which the springs' wires are given; at rest they are as the meshes have them."""
_DIGITS = 3  # of millimetres


def assembly_data(design: Design, dims: Dimensions, items: Sequence[Item], placed: Mapping[str, Instance]) -> bytes:
    """Return the data as JSON. Lengths in mm, masses in g, angles in rad; names are those of the parts in the GLB."""
    by_kind = {item.kind: item for item in items}
    apart, coils = lifts(placed), installed_coils(dims)
    data = {
        "mode": design.mode,
        "stroke": dims.stroke,
        "parts": [
            {"name": name, **_part(by_kind[kind_of(name)]), "lift": round(apart[name], _DIGITS)} for name in placed
        ],
        "steps": [brought(step, placed) for step in written_steps(design, dims, items)],
        "wires": {"ring": RING, "shares": SHARES, "moved": {kind: _moved(dims, kind) for kind in coils}},
    }
    return (json.dumps(data, separators=(",", ":")) + "\n").encode()


def _part(item: Item) -> dict[str, Any]:
    """Return what there is to say of a part of one kind."""
    return {
        "kind": item.kind, "title": item.title, "made": item.made, "mass": round(item.mass, _DIGITS),
        "turns": item.kind in TURNING, "files": list(item.papers),
    }  # fmt: skip


def brought(step: WrittenStep, names: Collection[str]) -> dict[str, Any]:
    """Return a step's text, the parts among `names` that it brings into their place, and the side the first comes
    from."""
    parts = coming(step.place, list(names))
    return {"text": step.text, "parts": [part.name for part in parts], "from": parts[0].side if parts else ""}


def _moved(dims: Dimensions, kind: str) -> list[list[float]]:
    """Return how far each ring of a spring's mesh has moved from rest [mm]: x, y, z in turn, for each share of the
    stroke."""
    coil_at_rest = installed_coils(dims)[kind]
    points = coil_points(coil_at_rest)
    at_rest = wire_centre(coil_at_rest)[0]
    mirror = np.array([1.0, 1.0 if kind == "spring_right" else -1.0, 1.0])
    offsets = []
    for share in SHARES:
        coil = installed_coils(dims, share * dims.stroke)[kind]
        moved = (wire_centre(coil, points)[0] - at_rest) * mirror
        offsets.append([round(float(each), _DIGITS) for each in moved.ravel()])
    return offsets
