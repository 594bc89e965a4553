"""FE of a boss with a dowel pin that a spring's leg pushes: a thick plate, drawn from its sizes, the pin glued in.

python bosses.py prints as YAML the way per force [mm/N] of the bosses that results.yaml names, from their sizes [mm].
"""

from __future__ import annotations

from pathlib import Path

import ngsolve as ng
import yaml
from netgen.occ import Box, Cylinder, Dir, Glue, OCCGeometry, Pnt

AROUND = 5.0
"""Half width of the plate around a boss, in its radii; its walls and its lower face are held."""
BEYOND = 1.0
"""Length of a pin beyond the leg [mm]."""
STEEL = 206e3, 0.3
"""Young's modulus [N/mm2] and Poisson's ratio of a dowel pin."""
LEG = 0.4
"""Half height of the pin that a leg presses on [mm]."""


def way(boss: dict[str, float], plastic: tuple[float, float]) -> float:
    """Return the way of the pin at the leg per force [mm/N]: the work of a unit force."""
    radius, pin = 0.5 * boss["foot"], 0.5 * boss["diameter"]
    wide, plate, end = AROUND * radius, boss["plate"], boss["rise"] - boss["depth"]
    body = Box(Pnt(-wide, -wide, -plate), Pnt(wide, wide, 0))
    body += Cylinder(Pnt(0, 0, -0.01), Dir(0, 0, 1), r=radius, h=boss["rise"] + 0.01)
    dowel = Cylinder(Pnt(0, 0, end), Dir(0, 0, 1), r=pin, h=boss["height"] + BEYOND - end)
    body -= dowel
    body.mat("plastic")
    dowel.mat("steel")
    glued = Glue([body, dowel])
    for face in glued.faces:
        at = face.center
        if at.z < 1e-6 - plate or max(abs(at.x), abs(at.y)) > wide - 1e-6:
            face.name = "held"
    mesh = ng.Mesh(OCCGeometry(glued).GenerateMesh(maxh=min(0.7 * pin, 0.6 * radius), grading=0.35)).Curve(2)
    modulus = mesh.MaterialCF({"plastic": plastic[0], "steel": STEEL[0]})
    poisson = mesh.MaterialCF({"plastic": plastic[1], "steel": STEEL[1]})
    shear, lame = modulus / (2 * (1 + poisson)), modulus * poisson / ((1 + poisson) * (1 - 2 * poisson))
    space = ng.VectorH1(mesh, order=2, dirichlet="held")
    u, v = space.TnT()
    strain, other = ng.Sym(ng.Grad(u)), ng.Sym(ng.Grad(v))
    near = ng.exp(-(((ng.z - boss["height"]) / LEG) ** 4)) * ng.IfPos(ng.x**2 + ng.y**2 - (1.6 * pin) ** 2, 0, 1)
    with ng.TaskManager():
        stress = 2 * shear * strain + lame * ng.Trace(strain) * ng.Id(3)
        form = ng.BilinearForm(ng.InnerProduct(stress, other) * ng.dx, symmetric=True)
        push = near / ng.Integrate(near, mesh, order=8) * ng.CF((1, 0, 0))
        load = ng.LinearForm(ng.InnerProduct(push, v) * ng.dx(bonus_intorder=6)).Assemble()
        form.Assemble()
        moved = ng.GridFunction(space)
        moved.vec.data = form.mat.Inverse(space.FreeDofs(), "sparsecholesky") * load.vec
        return float(ng.InnerProduct(load.vec, moved.vec))


def main() -> None:
    """Print the ways of all bosses."""
    known = yaml.safe_load(Path(__file__).with_name("results.yaml").read_text())
    plastic = known["modulus"], known["poissons_ratio"]
    for name, boss in known["bosses"].items():
        print(f"{name}: {way(boss, plastic):.5g}", flush=True)


if __name__ == "__main__":
    main()
