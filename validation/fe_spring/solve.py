"""FE of one torsion spring as drawn: tang clamped in the floor, force of the rotor's pin on the leg.

python solve.py PARTS [...]: each a folder written by export_parts.py. Prints rate and peak stress as YAML.
"""

from __future__ import annotations

import json
import sys
from math import cos, hypot, pi, sin, sqrt
from pathlib import Path

import numpy as np
import yaml
from netgen.occ import OCCGeometry
from ngsolve import (
    CF,
    TET,
    VOL,
    BilinearForm,
    Grad,
    GridFunction,
    Id,
    InnerProduct,
    Integrate,
    IntegrationRule,
    LinearForm,
    Mesh,
    Sym,
    TaskManager,
    Trace,
    VectorH1,
    dx,
    exp,
    x,
    y,
    z,
)  # fmt: skip

POISSON = 0.3
ORDERS = (2,)  # 3 on the same mesh moves rates by 0.2 %, stresses by 2 %


def solve(folder: Path, size: float, order: int) -> dict[str, float]:
    """Rate [N*m/rad] and stresses at one newton metre [MPa]; element size in wire diameters."""
    inputs = json.loads((folder / "inputs.json").read_text())
    mm, coil = inputs["mm"], inputs["coil"]
    modulus = inputs["values"]["spring_youngs_modulus"] * 1e-6  # N/mm^2
    wire, radius = mm["wire_diameter"], 0.5 * coil["diameter"]
    shape = OCCGeometry(str(folder / "spring.step")).shape
    for face in shape.faces:
        face.name = "held" if face.center.z < -1e-3 else "free"
    mesh = Mesh(OCCGeometry(shape).GenerateMesh(maxh=size * wire)).Curve(order)
    offset = 0.5 * (coil["diameter"] + wire + mm["pin_diameter"])
    arm = sqrt((mm["placement_radius"] - mm["pin_radius"]) ** 2 - offset**2)
    azimuth = coil["leg_azimuth"]
    out = CF((sin(azimuth), -cos(azimuth), 0))
    start = (sin(azimuth) * radius, -cos(azimuth) * radius)
    way = (x - start[0]) * cos(azimuth) + (y - start[1]) * sin(azimuth)
    rise = mm["coil_pitch"] / (pi * coil["diameter"])
    level = coil["end_level"] + rise * arm
    near = exp(-(((way - arm) / (0.7 * wire)) ** 2)) * exp(-(((z - level) / wire) ** 4))
    beside = (x - start[0]) * sin(azimuth) - (y - start[1]) * cos(azimuth)
    near *= exp(-((beside / wire) ** 4))
    near /= Integrate(near, mesh, order=8)
    space = VectorH1(mesh, order=order, dirichlet="held")
    u, v = space.TnT()
    lame, shear = modulus * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), modulus / (2 * (1 + POISSON))

    def stress(strain):
        return 2 * shear * strain + lame * Trace(strain) * Id(3)

    with TaskManager():
        form = BilinearForm(InnerProduct(stress(Sym(Grad(u))), Sym(Grad(v))) * dx, symmetric=True)
        load = LinearForm(near * InnerProduct(out, v) * dx(bonus_intorder=6)).Assemble()
        form.Assemble()
        found = GridFunction(space)
        found.vec.data = form.mat.Inverse(space.FreeDofs(), "sparsecholesky") * load.vec
        moved = InnerProduct(load.vec, found.vec)
    rate = arm**2 / moved * 1e-3
    tensor = stress(Sym(Grad(found)))
    samples = _fibre(mesh, tensor, inputs, radius, wire, arm)
    return {"elements": mesh.ne, "unknowns": space.ndof, "rate": rate, "arm_mm": arm, **samples}


def _fibre(mesh, tensor, inputs, radius, wire, arm) -> dict[str, float]:
    """Largest fibre and von Mises stress [MPa per N*m] at the coil's inner fibre, and the fibre's mean over the coil.

    Largest of smooth curves through 400 samples: single elements scatter by some per cent.
    """
    coil, pitch = inputs["coil"], inputs["mm"]["coil_pitch"]
    deviator = tensor - Trace(tensor) / 3 * Id(3)
    mises = (1.5 * InnerProduct(deviator, deviator)) ** 0.5
    end = coil["leg_azimuth"] - 0.5 * pi
    fibre, von = [], []
    backs = np.linspace(0.15 * pi, 2 * pi * coil["turns"] - 0.25 * pi, 400)
    for back in backs:
        at = end - back
        level = coil["end_level"] - pitch * back / (2 * pi)
        inner = radius - 0.49 * wire
        point = mesh(inner * cos(at), inner * sin(at), level)
        full = np.array(tensor(point)).reshape(3, 3)
        slope = pitch / (2 * pi * radius)
        tangent = np.array([-sin(at), cos(at), slope]) / hypot(1, slope)
        fibre.append(abs(tangent @ full @ tangent))
        von.append(mises(point))
    bend = _peak(mesh, mises, 0.35 * wire, coil["start_level"])
    whole = _peak(mesh, mises, coil["start_level"] + 0.5 * wire, coil["end_level"] - 0.5 * wire)
    scale = 1e3 / arm  # a force of 1 N to a torque of 1 N*m
    shapes = np.stack([wave * backs**power for power in (0, 1) for wave in _waves(backs)], axis=1)

    def smooth(values: list[float]) -> float:
        return float((shapes @ np.linalg.lstsq(shapes, np.array(values), rcond=None)[0]).max()) * scale

    return {"bend_mises": bend * scale, "coil_mises": whole * scale, "fibre_max": smooth(fibre),
            "mises_max": smooth(von), "fibre_mean": float(np.mean(fibre)) * scale}  # fmt: skip


def _waves(angles):
    return np.ones_like(angles), np.sin(angles), np.cos(angles), np.sin(2 * angles), np.cos(2 * angles)


def _peak(mesh, field, bottom: float, top: float) -> float:
    """Largest value [MPa] of a field between two levels, at the points of integration."""
    rule = IntegrationRule(TET, 3)
    points = mesh.MapToAllElements(rule, VOL)
    levels = np.asarray(z(points)).ravel()
    return float(np.asarray(field(points)).ravel()[(levels > bottom) & (levels < top)].max())


def main(folders: list[str]) -> None:
    """Solve each on two meshes and print what was found."""
    for name in folders:
        runs = [solve(Path(name), 0.9, order) for order in ORDERS]
        rows = [{k: float(f"{v:.5g}") for k, v in run.items()} for run in runs]
        print(yaml.safe_dump({Path(name).name: rows}), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
