"""FE of one torsion spring as drawn: its rate [N*m/rad], and its stresses [MPa] at one newton metre."""

import json
from math import cos, hypot, pi, sin, sqrt
from pathlib import Path
from typing import Any

import elastic
import ngsolve as ngs
import numpy as np
from netgen.occ import OCCGeometry
from ngsolve import CF, TET, VOL, BilinearForm, GridFunction, InnerProduct, Integrate, LinearForm, dx, exp, x, y, z

POISSON = 0.3
ORDER = 2  # 3 on the same mesh moves rates by 0.2 %, stresses by 2 %
SIZE = 0.9  # Elements, in wire diameters


def solve(folder: Path, coarser: float = 1.0, field: Path | None = None) -> elastic.Results:
    """Return rate [N*m/rad] and stresses at one newton metre [MPa]."""
    inputs = json.loads((folder / "inputs.json").read_text())
    mm, coil = inputs["mm"], inputs["coil"]
    shear = inputs["values"]["spring_youngs_modulus"] * 1e-6 / (2 * (1 + POISSON))  # N/mm^2
    lame = elastic.lame_of(shear, POISSON)
    wire, radius = mm["wire_diameter"], 0.5 * coil["diameter"]
    shape = OCCGeometry(str(folder / "spring.step")).shape
    for face in shape.faces:
        face.name = "held" if face.center.z < -1e-3 else "free"
    mesh = elastic.meshed(OCCGeometry(shape), ORDER, maxh=SIZE * coarser * wire)
    offset = 0.5 * (coil["diameter"] + wire + mm["pin_diameter"])
    arm = sqrt((mm["placement_radius"] - mm["pin_radius"]) ** 2 - offset**2)
    near, out = _push(mesh, inputs, arm)
    space = ngs.VectorH1(mesh, order=ORDER, dirichlet="held")
    u, v = space.TnT()
    with ngs.TaskManager():
        worked = InnerProduct(elastic.stress(elastic.strain_of(u), shear, lame), elastic.strain_of(v))
        form = BilinearForm(worked * dx, symmetric=True)
        load = LinearForm(near * InnerProduct(out, v) * dx(bonus_intorder=6)).Assemble()
        form.Assemble()
        displacement = GridFunction(space)
        displacement.vec.data = form.mat.Inverse(space.FreeDofs(), "sparsecholesky") * load.vec
        moved = InnerProduct(load.vec, displacement.vec)
    tensor = elastic.stress(elastic.strain_of(displacement), shear, lame)
    if field:
        elastic.write_field(field, mesh, elastic.mises(tensor) * 1e3 / arm, displacement)
    samples = _stresses(mesh, tensor, inputs, radius, arm)
    return {"elements": mesh.ne, "unknowns": space.ndof, "rate": arm**2 / moved * 1e-3, "arm_mm": arm, **samples}


def _push(mesh: Any, inputs: dict[str, Any], arm: float) -> tuple[Any, Any]:
    """Return a force of one newton on the leg where the pin meets it: its density and its direction."""
    mm, coil = inputs["mm"], inputs["coil"]
    wire, azimuth, radius = mm["wire_diameter"], coil["leg_azimuth"], 0.5 * coil["diameter"]
    out = CF((sin(azimuth), -cos(azimuth), 0))
    start = (sin(azimuth) * radius, -cos(azimuth) * radius)
    way = (x - start[0]) * cos(azimuth) + (y - start[1]) * sin(azimuth)
    level = coil["end_level"] + mm["coil_pitch"] / (pi * coil["diameter"]) * arm
    near = exp(-(((way - arm) / (0.7 * wire)) ** 2)) * exp(-(((z - level) / wire) ** 4))
    beside = (x - start[0]) * sin(azimuth) - (y - start[1]) * cos(azimuth)
    near *= exp(-((beside / wire) ** 4))
    return near / Integrate(near, mesh, order=8), out


def _stresses(mesh: Any, tensor: Any, inputs: dict[str, Any], radius: float, arm: float) -> elastic.Results:
    """Return largest fibre and von Mises stress [MPa per N*m] at the coil's inner fibre, and the fibre's mean over the
    coil.

    Largest of smooth curves through 400 samples: single elements scatter by some per cent.
    """
    coil, pitch, wire = inputs["coil"], inputs["mm"]["coil_pitch"], inputs["mm"]["wire_diameter"]
    mises = elastic.mises(tensor)
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


def _waves(angles: Any) -> tuple[Any, ...]:
    return np.ones_like(angles), np.sin(angles), np.cos(angles), np.sin(2 * angles), np.cos(2 * angles)


def _peak(mesh: Any, field: Any, bottom: float, top: float) -> float:
    """Return largest value [MPa] of a field between two levels, at the points of integration."""
    points = mesh.MapToAllElements(ngs.IntegrationRule(TET, 3), VOL)
    levels = np.asarray(z(points)).ravel()
    return float(np.asarray(field(points)).ravel()[(levels > bottom) & (levels < top)].max())


if __name__ == "__main__":
    elastic.main(solve, __doc__)
