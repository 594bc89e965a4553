"""FE of the output link: clamped on the core's face below it, pushed sideways in its tool hole.

python solve.py PARTS [...]. Prints force times length over deflection at the hole over length [N*m/rad].
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import yaml
from netgen.occ import Cylinder, Dir, Glue, OCCGeometry, Pnt
from ngsolve import (
    CF,
    BilinearForm,
    Grad,
    GridFunction,
    Id,
    InnerProduct,
    Integrate,
    LinearForm,
    Mesh,
    Sym,
    TaskManager,
    Trace,
    VectorH1,
    ds,
    dx,
)  # fmt: skip


def solve(folder: Path, size: float) -> dict[str, float]:
    """Stiffness at the tool hole [N*m/rad]."""
    inputs = json.loads((folder / "inputs.json").read_text())
    mm, values = inputs["mm"], inputs["values"]
    core = Cylinder(Pnt(0, 0, mm["link_bottom_level"] - 1.0), Dir(0, 0, 1), r=mm["core_radius"], h=1.0)
    shape = Glue([OCCGeometry(str(folder / "link.step")).shape, core])
    shape.solids[0].name, shape.solids[1].name = "link", "core"
    for face in shape.faces:
        centre = face.center
        upright = face.bounding_box[1].z - face.bounding_box[0].z > 0.5 * mm["link_thickness"]
        near = ((centre.x - mm["link_length"]) ** 2 + centre.y**2) ** 0.5 < 0.1
        face.name = "tool" if upright and near else "free"
    mesh = Mesh(OCCGeometry(shape).GenerateMesh(maxh=size * mm["link_thickness"])).Curve(2)
    youngs, poisson = values["structure_youngs_modulus"] * 1e-6, values["structure_poissons_ratio"]
    lame, shear = youngs * poisson / (1 + poisson) / (1 - 2 * poisson), youngs / 2 / (1 + poisson)
    interface = mesh.Materials("link").Boundaries() * mesh.Materials("core").Boundaries()
    space = VectorH1(mesh, order=2, definedon=mesh.Materials("link"), dirichlet=interface)
    u, v = space.TnT()

    def stress(strain):
        return 2 * shear * strain + lame * Trace(strain) * Id(3)

    with TaskManager():
        form = BilinearForm(InnerProduct(stress(Sym(Grad(u))), Sym(Grad(v))) * dx("link"), symmetric=True).Assemble()
        tool = mesh.Boundaries("tool")
        area = Integrate(CF(1), mesh, definedon=tool)
        load = LinearForm(v[1] / area * ds("tool")).Assemble()
        found = GridFunction(space)
        found.vec.data = form.mat.Inverse(space.FreeDofs(), "sparsecholesky") * load.vec
    moved = InnerProduct(load.vec, found.vec)
    return {"unknowns": space.ndof, "link": mm["link_length"] ** 2 / moved * 1e-3}


if __name__ == "__main__":
    for name in sys.argv[1:]:
        runs = [solve(Path(name), size) for size in (1.0, 0.6)]
        rows = [{k: float(f"{v:.4g}") for k, v in run.items()} for run in runs]
        print(yaml.safe_dump({Path(name).name: rows}), flush=True)
