"""FE of the output link [N*m/rad]: clamped on the core's face below it, pushed sideways in its tool hole."""

import json
from pathlib import Path

import elastic
from netgen.occ import Cylinder, Dir, Glue, OCCGeometry, Pnt
from ngsolve import CF, BilinearForm, GridFunction, InnerProduct, Integrate, LinearForm, TaskManager, VectorH1, ds, dx


def solve(folder: Path, coarser: float = 1.0, field: Path | None = None) -> elastic.Results:
    """Return the stiffness at the tool hole [N*m/rad]."""
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
    mesh = elastic.meshed(OCCGeometry(shape), 2, maxh=0.6 * coarser * mm["link_thickness"])
    shear = values["structure_youngs_modulus"] * 1e-6 / 2 / (1 + values["structure_poissons_ratio"])
    lame = elastic.lame_of(shear, values["structure_poissons_ratio"])
    interface = mesh.Materials("link").Boundaries() * mesh.Materials("core").Boundaries()
    space = VectorH1(mesh, order=2, definedon=mesh.Materials("link"), dirichlet=interface)
    u, v = space.TnT()
    with TaskManager():
        worked = InnerProduct(elastic.stress(elastic.strain_of(u), shear, lame), elastic.strain_of(v))
        form = BilinearForm(worked * dx("link"), symmetric=True).Assemble()
        tool = mesh.Boundaries("tool")
        area = Integrate(CF(1), mesh, definedon=tool)
        load = LinearForm(v[1] / area * ds("tool")).Assemble()
        displacement = GridFunction(space)
        displacement.vec.data = form.mat.Inverse(space.FreeDofs(), "sparsecholesky") * load.vec
    moved = InnerProduct(load.vec, displacement.vec)
    if field:
        tensor = elastic.stress(elastic.strain_of(displacement), shear, lame)
        elastic.write_field(field, mesh, elastic.mises(tensor), displacement)
    return {"unknowns": space.ndof, "link": mm["link_length"] ** 2 / moved * 1e-3}


if __name__ == "__main__":
    elastic.main(solve, __doc__)
