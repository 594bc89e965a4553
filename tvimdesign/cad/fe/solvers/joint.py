"""FE of the frozen joint as drawn: housing on its feet, pads, PCL, rotor, all tied; the core's top turns as one.

Finds the joint's stiffness and each part's share of the compliance as 1/C_i with C_i = 2 U_i/T^2 [N*m/rad], U_i its
strain energy: the C_i add up to the whole. Stresses [MPa] are at one newton metre. `swung` is the inertia about the
axis [kg*mm^2] that swings with the core's top as the joint is deformed: of the plate less than all of its own.
"""

import json
from pathlib import Path
from typing import Any

import elastic
import joint_samples
import joint_solids
from netgen.occ import Glue, OCCGeometry
from ngsolve import (
    CF,
    BilinearForm,
    CGSolver,
    GridFunction,
    IfPos,
    InnerProduct,
    Integrate,
    Preconditioner,
    TaskManager,
    VectorH1,
    dx,
    sqrt,
    x,
    y,
    z,
)  # fmt: skip

RUBBERLIKE = 0.45  # Poisson's ratio of pads


def solve(folder: Path, coarser: float = 1.0, field: Path | None = None) -> elastic.Found:
    """Stiffness of the joint at the core's top and of each part [N*m/rad]; stresses at 1 N*m [MPa]."""
    inputs = json.loads((folder / "inputs.json").read_text())
    mm, values = inputs["mm"], inputs["values"]
    whole = Glue(joint_solids.parts(folder, mm, coarser))
    joint_solids.refine(whole, mm, coarser)
    joint_solids.name_faces(whole, mm)
    sizes = {"maxh": 12.0 * coarser, "grading": 0.6, "curvaturesafety": 1.0, "segmentsperedge": 0.5}
    mesh = elastic.meshed(OCCGeometry(whole), 2, **sizes)
    shear, lame = _moduli(mesh, values)
    with TaskManager():
        found = _turned(mesh, shear, lame)
        strain = elastic.strain_of(found)
        tensor = elastic.stress(strain, shear, lame)
        shares, torque = _energies(mesh, InnerProduct(tensor, strain), mm)
        density = mesh.MaterialCF({"rotor": values["structure_density"] * 1e-9}, default=0.0)  # kg/mm^3
        swung = Integrate(density * InnerProduct(found, found), mesh)
    result = {"elements": mesh.ne, "unknowns": found.space.ndof, "hub": torque * 1e-3, "swung": swung}
    result |= {name: torque**2 / share * 1e-3 for name, share in shares.items()}
    result |= joint_samples.in_bodies(mesh, tensor, mm, torque) | joint_samples.at_foot(mesh, tensor, mm, torque)
    if not mm.get("vane_count"):
        result |= joint_samples.at_edges(mesh, tensor, mm, torque)
    if field:
        elastic.write_field(field, mesh, elastic.mises(tensor) * 1e3 / torque, found)
    return result


def _moduli(mesh: Any, values: dict[str, float]) -> tuple[Any, Any]:
    """Shear modulus and Lame's first constant of each material [N/mm^2]."""
    own = values["structure_poissons_ratio"]
    structure = values["structure_youngs_modulus"] * 1e-6 / 2 / (1 + own)
    shear = {"pcl": values["storage_modulus@cold"] * 1e-6, "pad": values["peltier_shear_modulus"] * 1e-6}
    poisson = {"pcl": values["pcl_poissons_ratio"], "pad": RUBBERLIKE, "rotor": own, "housing": own}
    if "spreader_shear_modulus" in values:
        shear["spreader"] = values["spreader_shear_modulus"] * 1e-6
        poisson["spreader"] = values["spreader_youngs_modulus"] * 0.5e-6 / shear["spreader"] - 1.0
    mu = mesh.MaterialCF({**shear, "rotor": structure, "housing": structure})
    return mu, elastic.lame_of(mu, mesh.MaterialCF(poisson))


def _turned(mesh: Any, shear: Any, lame: Any) -> Any:
    """Displacement where the core's top is turned by one radian."""
    space = VectorH1(mesh, order=2, dirichlet="turned|fixed")
    u, v = space.TnT()
    worked = InnerProduct(elastic.stress(elastic.strain_of(u), shear, lame), elastic.strain_of(v))
    form = BilinearForm(worked * dx, symmetric=True, condense=True)
    pre = Preconditioner(form, "bddc")
    form.Assemble()
    found = GridFunction(space)
    found.Set(CF((-y, x, 0)), definedon=mesh.Boundaries("turned"))
    right = found.vec.CreateVector()
    right.data = -form.mat * found.vec
    inverse = CGSolver(form.mat, pre.mat, tol=1e-7, maxiter=600)
    change = found.vec.CreateVector()
    right.data += form.harmonic_extension_trans * right
    change.data = inverse * right
    found.vec.data += change
    found.vec.data += form.harmonic_extension * found.vec
    found.vec.data += form.inner_solve * right
    return found


def _energies(mesh: Any, density: Any, mm: elastic.Found) -> tuple[elastic.Found, float]:
    """Twice the strain energy of each part, and of all, which is the torque at one radian [N*mm]."""
    core = IfPos(mm["core_radius"] + 0.01 - sqrt(x * x + y * y), 1, 0)
    solids = {"pcl": "pcl", "pad": "pad|spreader", "housing": "housing"}
    shares = {name: Integrate(density, mesh, definedon=mesh.Materials(of)) for name, of in solids.items()}
    rotor = mesh.Materials("rotor")
    if mm.get("vane_count"):
        shares["housing_vanes"] = Integrate(IfPos(z, 1, 0) * density, mesh, definedon=mesh.Materials("housing"))
        shares["housing"] -= shares["housing_vanes"]
        shares["rotor_vanes"] = Integrate(IfPos(mm["rotor_bottom_level"] - z, 1, 0) * density, mesh, definedon=rotor)
    shares["core"] = Integrate(core * density, mesh, definedon=rotor)
    shares["plate"] = Integrate((1 - core) * density, mesh, definedon=rotor) - shares.get("rotor_vanes", 0.0)
    return shares, Integrate(density, mesh)


if __name__ == "__main__":
    elastic.main(solve, __doc__)
