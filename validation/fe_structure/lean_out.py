"""FE of the force between a block and its rotor's vane: how far it leans out of what stands across the vane.

    FE/bin/python validation/fe_structure/lean_out.py WORK/STUDY/parts

The parts are those that run.py exports of a compression study. Prints the force's parts across the vane and along it,
over torque by vanes and mean radius, the moment about the vane's height over the same [mm], and the angle.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tvimdesign/cad/fe/solvers"))
import elastic
import joint
import joint_solids
from netgen.occ import Glue, OCCGeometry
from ngsolve import CF, L2, GridFunction, InnerProduct, Integrate, TaskManager, Trace, x, y

PRESSED = 0.4
COARSER = 1.3


def name_between(whole: Any, mm: dict[str, float]) -> float:
    """Name the face between one block and its rotor's vane `between`; returns that vane's azimuth [rad]."""
    pitch = 2.0 * np.pi / mm["vane_count"]
    owners: dict[Any, set[str]] = {}
    for solid in whole.solids:
        for face in solid.faces:
            owners.setdefault(_place(face), set()).add(solid.name)
    face = next(face for face in whole.faces if owners.get(_place(face)) == {"pcl", "rotor"})
    face.name = "between"
    return float(pitch * round(np.arctan2(face.center.y, face.center.x) / pitch))


def _place(face: Any) -> tuple[float, ...]:
    return round(face.center.x, 3), round(face.center.y, 3), round(face.center.z, 3), round(face.mass, 3)


def results(folder: Path) -> dict[str, float]:
    """Return the force on one vane, and its angle [deg]."""
    inputs = json.loads((folder / "inputs.json").read_text())
    mm, values = inputs["mm"], inputs["values"]
    whole = Glue(joint_solids.parts(folder, mm, COARSER, PRESSED / COARSER))
    joint_solids.refine(whole, mm, COARSER)
    joint_solids.name_faces(whole, mm)
    azimuth, radius = name_between(whole, mm), 0.5 * (mm["pcl_inner_radius"] + mm["pcl_outer_radius"])
    sizes = {"maxh": 12.0 * COARSER, "grading": 0.6, "curvaturesafety": 1.0, "segmentsperedge": 0.5}
    mesh = elastic.meshed(OCCGeometry(whole), 2, **sizes)
    shear, lame = joint._moduli(mesh, values)
    with TaskManager():
        held = joint.Held(mesh, shear, lame)
        strain = elastic.strain_of(held.turned())
        even = GridFunction(L2(mesh, order=0))
        even.Set(Trace(strain))
        tensor = elastic.stress(strain, shear, lame, mesh.MaterialCF({"pad": even}, default=Trace(strain)))
        torque = Integrate(InnerProduct(tensor, strain), mesh)
        out, across = (np.array([np.cos(azimuth + turn), np.sin(azimuth + turn)]) for turn in (0.0, 0.5 * np.pi))
        beside = x - radius * out[0], y - radius * out[1]
        ways = {"along": (*out, 0), "across": (*across, 0), "moment": (-beside[1], beside[0], 0)}
        each, parts = GridFunction(held.space), {}
        for name, way in ways.items():
            each.vec[:] = 0.0
            each.Set(CF(way), definedon=mesh.Boundaries("between"))
            work = InnerProduct(tensor, elastic.strain_of(each))
            parts[name] = abs(Integrate(work, mesh, definedon=mesh.Materials("pcl")))
    even_force = torque / mm["vane_count"] / radius
    parts = {name: float(value / even_force) for name, value in parts.items()}
    return parts | {"angle": float(np.degrees(np.arctan2(parts["along"], parts["across"])))}


if __name__ == "__main__":
    print({name: round(value, 3) for name, value in results(Path(sys.argv[1])).items()})
