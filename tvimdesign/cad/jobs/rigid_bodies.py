"""The module as two rigid bodies: mass properties and a coarse mesh of each, made by a child process."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.cad.jobs import main as build_main
from tvimdesign.study import Design, read_design

if TYPE_CHECKING:
    import cadquery as cq

    from tvimdesign.cad.export.mesh import Mesh
    from tvimdesign.cad.geometry.dimensions import Dimensions

BODIES = "bodies.json"  # Mass properties of both bodies, in SI
MESHES = "meshes"
BASE, MOVING = "base", "moving"  # Bodies that stand with the housing, and turn with the rotor


def run(design_path: Path, out: Path, send: Callable[..., None]) -> None:
    """Write mass properties and meshes of both bodies; `send` gets each step, then what the checks found."""
    started = time.perf_counter()
    design = read_design(design_path)
    send(progress="loading the CAD kernel")
    from tvimdesign.cad.assembly.assembly import drawn_parts, place
    from tvimdesign.cad.geometry.dimensions import dimensions
    from tvimdesign.cad.inspection.size_checks import size_checks

    dims = dimensions(design)
    send(progress="parts")
    drawn = drawn_parts(dims)
    placed = place(dims, drawn)
    checks = [asdict(check) for check in size_checks(design, placed)]
    send(progress="meshes")
    meshes, bodies = coarse_meshes(dims, drawn), names_of_bodies(placed)
    (out / MESHES).mkdir(exist_ok=True)
    for body, names in bodies.items():
        atomic_write(out / MESHES / f"{body}.stl", body_stl(meshes, placed, names))
    atomic_write(out / BODIES, (json.dumps(_weighed(design, placed, bodies), indent=2) + "\n").encode())
    files = [BODIES, *(f"{MESHES}/{body}.stl" for body in bodies)]
    send(checks=checks, files=files, notes=[], reused=[], seconds=time.perf_counter() - started)


def names_of_bodies(placed: Mapping[str, Any]) -> dict[str, list[str]]:
    """Return the names of the placed parts of each body: springs, pads and PCL stand with the housing."""
    from tvimdesign.cad.geometry.kinds import TURNING, kind_of

    turning = [name for name in placed if kind_of(name) in TURNING]
    return {BASE: [name for name in placed if name not in turning], MOVING: turning}


def _weighed(design: Design, placed: Mapping[str, Any], bodies: Mapping[str, list[str]]) -> dict[str, Any]:
    """Return mass properties of each body as plain data."""
    from tvimdesign.cad.geometry.kinds import KINDS, kind_of

    return {
        body: together(of_solid(placed[name], design.value(KINDS[kind_of(name)].density)) for name in names).plain()
        for body, names in bodies.items()
    }


Array = NDArray[np.float64]
_MM, _MM3, _MM5 = 1e-3, 1e-9, 1e-15


@dataclass(frozen=True)
class MassProperties:
    """Mass properties of a rigid body in the module's coordinates."""

    mass: float  # [kg]
    centre: Array  # Centre of mass [m]
    inertia: Array
    """Tensor of inertia about the centre of mass [kg*m^2], 3 x 3; off the diagonal it is -integral of x y dm."""

    def plain(self) -> dict[str, object]:
        """Return all of it, for a JSON file."""
        return {"mass": self.mass, "centre": self.centre.tolist(), "inertia": self.inertia.tolist()}


def of_solid(solid: cq.Solid, density: float) -> MassProperties:
    """Return mass properties of a solid drawn in mm, of a density [kg/m^3]; the kernel integrates over its faces."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(solid.wrapped, properties)
    centre, tensor = properties.CentreOfMass(), properties.MatrixOfInertia()
    inertia = np.array([[tensor.Value(row, column) for column in (1, 2, 3)] for row in (1, 2, 3)])
    return MassProperties(
        mass=properties.Mass() * _MM3 * density,
        centre=np.array([centre.X(), centre.Y(), centre.Z()]) * _MM,
        inertia=inertia * _MM5 * density,
    )


def together(bodies: Iterable[MassProperties]) -> MassProperties:
    """Return several bodies as one: I = sum of I_i + m_i (r^2 1 - r r^T), r from the common centre (parallel axes)."""
    parts = list(bodies)
    mass = sum(part.mass for part in parts)
    centre = np.asarray(sum(part.mass * part.centre for part in parts)) / mass
    inertia = np.zeros((3, 3))
    for part in parts:
        off = part.centre - centre
        inertia += part.inertia + part.mass * (off @ off * np.eye(3) - np.outer(off, off))
    return MassProperties(mass, centre, inertia)


CHORD = 0.2  # Largest distance of a mesh from its part [mm]
TURN = 0.5  # Largest angle between neighbouring triangles of a curved face [rad]
AROUND = 6  # Points around a spring's wire


def coarse_meshes(dims: Dimensions, drawn: Mapping[str, cq.Solid]) -> dict[str, Mesh]:
    """Return a coarse mesh of each kind of part, in its own coordinates [mm]."""
    from tvimdesign.cad.assembly.assembly import installed_coils
    from tvimdesign.cad.export.mesh import solid_mesh, spring_meshes

    coils = installed_coils(dims)
    meshes = {kind: solid_mesh(solid, CHORD, TURN) for kind, solid in drawn.items()}
    return meshes | spring_meshes(coils, AROUND)


def body_stl(meshes: Mapping[str, Mesh], placed: Mapping[str, cq.Solid], names: Sequence[str]) -> bytes:
    """Return the named parts where they stand as one binary STL in metres."""
    import trimesh

    from tvimdesign.cad.export.mesh import Instance
    from tvimdesign.cad.export.print_files import stl_bytes
    from tvimdesign.cad.geometry.exact_kernel import placement
    from tvimdesign.cad.geometry.kinds import kind_of

    parts = [Instance(meshes[kind_of(name)], placement(placed[name].location())) for name in names]
    first = np.cumsum([0] + [len(part.mesh.vertices) for part in parts])
    faces = np.concatenate([part.mesh.faces + start for part, start in zip(parts, first, strict=False)])
    points = np.concatenate([part.points() for part in parts]) * _MM
    return stl_bytes(trimesh.Trimesh(points, faces, process=False))


if __name__ == "__main__":
    sys.exit(build_main.main(sys.argv[1:], run))
