"""FE of link and core under the link's tightened screws: they touch without friction, and part where nothing presses.

Each screw presses with a newton on the ring under its head, and pulls the core up by the walls of its hole. Finds
`friction_radius` [mm]: the mean radius of the pressure between the two, weighted by it. Friction holds as much torque
as at that radius with all of the screws' force.
"""

import json
from pathlib import Path
from typing import Any

import elastic
import ngsolve as ngs
import numpy as np
from netgen.occ import Cylinder, Dir, Glue, OCCGeometry, Pnt
from ngsolve import BND, CF, Compress, GridFunction, IfPos, InnerProduct, Integrate, VectorH1, ds, dx, sqrt, x, y

DEEP, NEAR = 1.2, 1.6
"""Depth of the core that is drawn, over that of the screws' holes; how much of the link, over the core's radius."""
STIFF = 30.0
"""Stiffness of the touching faces, in moduli over the link's thickness; 10 to 100 moves the radius by 0.1 %."""
SPREADS = 0.25  # How far beyond the head the pressure is taken to reach at first, over the link's thickness
CHANGES, SETTLED = 15, 1e-3  # Most solutions until what touches settles, and the radius' change that ends them
SHARP = 8  # Order of integration on the touching faces, where the pressure ends within elements


def solve(folder: Path, coarser: float = 1.0, field: Path | None = None) -> elastic.Results:
    """Return the radius at which friction acts [mm]. Raises ValueError where the faces that touch do not settle."""
    inputs = json.loads((folder / "inputs.json").read_text())
    mm, values = inputs["mm"], inputs["values"]
    mesh, places = _meshed(folder, mm, coarser)
    modulus, own = values["structure_youngs_modulus"] * 1e-6, values["structure_poissons_ratio"]
    shear = modulus / 2 / (1 + own)
    lame = elastic.lame_of(shear, own)
    link = Compress(VectorH1(mesh, order=2, definedon=mesh.Materials("link")))
    core = Compress(VectorH1(mesh, order=2, definedon=mesh.Materials("core"), dirichlet="ground"))
    space = ngs.FESpace([link, core])
    (u, w), (v, t) = space.TnT()
    displacement = GridFunction(space)
    stiff = STIFF * modulus / mm["link_thickness"]
    on = {"VOL_or_BND": BND, "definedon": mesh.Boundaries("touch"), "order": SHARP}
    away = [sqrt((x - a) ** 2 + (y - b) ** 2) for a, b in places]
    touching = sum(IfPos(0.5 * mm["link_screw_head"] + SPREADS * mm["link_thickness"] - apart, 1, 0) for apart in away)
    radius = 0.0
    with ngs.TaskManager():
        load = _tightened(mesh, space, v, t, places, 0.5 * mm["link_screw_head"])
        for _ in range(CHANGES):
            form = ngs.BilinearForm(space, symmetric=True)
            for a, b, name in ((u, v, "link"), (w, t, "core")):
                tensor = elastic.stress(elastic.strain_of(a), shear, lame)
                form += InnerProduct(tensor, elastic.strain_of(b)) * dx(name)
            # The link is kept from sliding by next to nothing.
            form += stiff * touching * (w[2] - u[2]) * (t[2] - v[2]) * ds("touch", bonus_intorder=SHARP - 4)
            form += 1e-6 * stiff * InnerProduct(u, v) * ds("touch")
            form.Assemble()
            displacement.vec.data = form.mat.Inverse(space.FreeDofs(), "sparsecholesky") * load.vec
            gap = displacement.components[1][2] - displacement.components[0][2]
            pressure = stiff * IfPos(gap, gap, 0.0)
            last = GridFunction(space)
            last.vec.data = displacement.vec
            touching = IfPos(last.components[1][2] - last.components[0][2], 1.0, 0.0)
            force, before = Integrate(pressure, mesh, **on), radius
            radius = Integrate(sqrt(x**2 + y**2) * pressure, mesh, **on) / force
            if abs(before / radius - 1.0) < SETTLED:
                break
        else:
            raise ValueError(f"contact of link and core does not settle in {CHANGES} tries")
    if field:
        moved = mesh.MaterialCF({"link": displacement.components[0], "core": displacement.components[1]})
        strain = elastic.strain_of(displacement.components[0]), elastic.strain_of(displacement.components[1])
        tensors = [elastic.mises(elastic.stress(of_part, shear, lame)) for of_part in strain]
        elastic.write_field(field, mesh, mesh.MaterialCF({"link": tensors[0], "core": tensors[1]}), moved)
    return {"unknowns": space.ndof, "friction_radius": radius}


def _meshed(folder: Path, mm: dict[str, float], coarser: float) -> tuple[Any, list[tuple[float, float]]]:
    """Return mesh of the link on the upper part of the core, and where the screws stand [mm]."""
    bottom, circle = mm["link_bottom_level"], mm["link_bolt_circle_radius"]
    deep = DEEP * mm["link_screw_depth"]
    whole = OCCGeometry(str(folder / "link.step")).shape
    near = Cylinder(Pnt(0, 0, bottom), Dir(0, 0, 1), r=NEAR * mm["core_radius"], h=mm["link_thickness"])
    part = whole * near
    places: list[tuple[float, float]] = []
    for face in part.faces:
        centre, upright = face.center, face.bounding_box[1].z - face.bounding_box[0].z > 0.5 * mm["link_thickness"]
        wide = face.bounding_box[1].x - face.bounding_box[0].x
        hole = abs(np.hypot(centre.x, centre.y) - circle) < 0.05 and abs(wide - mm["link_screw_clearance"]) < 0.3
        if upright and hole and all(np.hypot(centre.x - a, centre.y - b) > 0.5 for a, b in places):
            places.append((centre.x, centre.y))
    if not places:
        raise ValueError("the link has no holes on its bolt circle")
    core = Cylinder(Pnt(0, 0, bottom - deep), Dir(0, 0, 1), r=mm["core_radius"], h=deep)
    for a, b in places:
        start = Pnt(a, b, bottom - mm["link_screw_depth"])
        core -= Cylinder(start, Dir(0, 0, 1), r=0.5 * mm["link_screw_pilot"], h=mm["link_screw_depth"] + 1.0)
    shape = Glue([part, core])
    for solid in shape.solids:
        solid.name = "link" if solid.center.z > bottom else "core"
        solid.maxh = coarser * (0.6 * mm["link_thickness"] if solid.name == "link" else 0.4 * mm["core_radius"])
    for face in shape.faces:
        low, high, centre = face.bounding_box[0].z, face.bounding_box[1].z, face.center
        flat, within = high - low < 1e-4, np.hypot(centre.x, centre.y) < mm["core_radius"]
        hole = any(np.hypot(centre.x - a, centre.y - b) < 0.3 for a, b in places)
        if flat and abs(low - bottom) < 1e-3 and within:
            face.name, face.maxh = "touch", 0.16 * coarser * mm["core_radius"]
        elif flat and abs(low - bottom + deep) < 1e-3:
            face.name = "ground"
        elif flat and abs(high - bottom - mm["link_thickness"]) < 1e-3:
            face.name = "upper"
        else:
            face.name = "thread" if hole and high <= bottom + 1e-3 and not flat else "free"
    named = {face.name for face in shape.faces}
    if not named >= {"touch", "ground", "upper", "thread"}:
        raise ValueError(f"of link and core only the faces {sorted(named)} were found")
    sizes = {"curvaturesafety": 0.8, "segmentsperedge": 0.5, "grading": 0.6}
    return elastic.meshed(OCCGeometry(shape), 2, maxh=coarser * mm["link_thickness"], **sizes), places


def _tightened(mesh: Any, space: Any, v: Any, t: Any, places: Any, head: float) -> Any:
    """Return a newton of every screw: on the link under its head, and up on the walls of its hole in the core."""
    load = ngs.LinearForm(space)
    for a, b in places:
        away = sqrt((x - a) ** 2 + (y - b) ** 2)
        for name, test, reach, way in (("upper", v, head, -1.0), ("thread", t, head, 1.0)):
            near = IfPos(reach - away, 1.0, 0.0)
            area = Integrate(CF(near), mesh, BND, definedon=mesh.Boundaries(name))
            load += way * near / area * test[2] * ds(name)
    return load.Assemble()


if __name__ == "__main__":
    elastic.main(solve, __doc__)
