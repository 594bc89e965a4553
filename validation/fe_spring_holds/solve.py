"""FE of what holds a spring: the rotor's pin under the leg, and the hole in the floor that the bonded tang twists.

python solve.py PARTS [...]: each a folder that `tvimdesign.cad.fe.run_solvers` wrote. Prints as YAML the way of the
pin per force and the hole's turn per moment, by FE of the exported rotor and housing and by the closed forms.
"""

from __future__ import annotations

import json
import sys
from math import hypot, pi
from pathlib import Path

import ngsolve as ng
import yaml
from netgen.occ import Box, OCCGeometry, Pnt

AROUND = 5.0
"""Half width of the block that is cut out around pin or hole, in their radii; its walls are held."""


def main(folders: list[str]) -> None:
    """Solve pin and hole of each folder's parts."""
    for folder in map(Path, folders):
        inputs = json.loads((folder / "inputs.json").read_text())
        results = {}
        if not inputs["values"].get("leg_pins_fitted"):  # dowel pins stand in bosses, which bosses.py draws
            results["pin"] = pin(folder, inputs)
        if not inputs["values"]["preload_adjustment"]:  # with adjusters a post holds the tang
            results["hole"] = hole(folder, inputs)
        print(yaml.safe_dump({folder.name: results}), flush=True)


def pin(folder: Path, inputs: dict) -> dict[str, float]:
    """Way of a pin per force of the leg [mm/N], held beyond a block of the plate around it and on the polymer below."""
    mm, coil, values = inputs["mm"], inputs["coil"], inputs["values"]
    radius, top = 0.5 * mm["pin_diameter"], mm["rotor_top_level"]
    shape = OCCGeometry(str(folder / "rotor.step")).shape
    at = next((f.center.x, f.center.y) for f in shape.faces
              if f.center.z > top + 0.2 and abs(hypot(f.center.x, f.center.y) - mm["pin_radius"]) < 0.05)  # fmt: skip
    height = max(coil["end_level"] + mm["coil_pitch"] / (pi * mm["coil_diameter"]) * values["leg_arm"] * 1e3 - top,
                 0.5 * mm["wire_diameter"])  # fmt: skip
    bottom = mm["rotor_bottom_level"]
    # Without the melt rings below, across which Open Cascade cuts nothing: the face that they stand on is held.
    mesh = _mesh(_cut(shape, at, AROUND * radius, bottom), at, AROUND * radius, bottom=bottom, fine=radius / 3)
    near = ng.exp(-((((ng.x - at[0]) ** 2 + (ng.y - at[1]) ** 2) / (1.5 * radius) ** 2) ** 4))
    near *= ng.exp(-(((ng.z - top - height) / (0.5 * mm["wire_diameter"])) ** 4))
    load = near / ng.Integrate(near, mesh, order=8) * ng.CF((1, 0, 0))
    way = _work(mesh, values, lambda v: ng.InnerProduct(load, v) * ng.dx(bonus_intorder=6))
    e, nu = values["structure_youngs_modulus"] * 1e-6, values["structure_poissons_ratio"]
    shear = e / (2 * (1 + nu))
    closed = (height**3 / (3 * e * pi / 4 * radius**4) + height / (0.9 * shear * pi * radius**2)
              + height**2 * 0.75 * (1 - nu**2) / (e * radius**3))  # fmt: skip
    return {"fe": float(way), "closed": closed, "ratio": float(closed / way), "height": height}


def hole(folder: Path, inputs: dict) -> dict[str, float]:
    """Turn of a tang's hole per moment about its axis [1/(N mm)], at the hole's own radius."""
    mm, values = inputs["mm"], inputs["values"]
    radius = 0.5 * mm["wire_diameter"] + mm["tang_clearance"]
    shape = OCCGeometry(str(folder / "housing.step")).shape
    walls = [f for f in shape.faces if _is_hole(f, radius)]
    at = (walls[0].center.x, walls[0].center.y)
    mesh = _mesh(_cut(shape, at, AROUND * radius), at, AROUND * radius, bottom=None, fine=radius / 3, hole=radius)
    around = ng.CF((-(ng.y - at[1]), ng.x - at[0], 0)) / radius
    area = ng.Integrate(1.0, mesh.Boundaries("wall"))
    turn = _work(mesh, values, lambda v: ng.InnerProduct(around, v) / (radius * area) * ng.ds("wall"))
    shear = values["structure_youngs_modulus"] * 1e-6 / (2 * (1 + values["structure_poissons_ratio"]))
    length = area / (2 * pi * radius)
    closed = 1 / (4 * pi * shear * radius**2 * length)
    return {"fe": float(turn), "closed": float(closed), "ratio": float(closed / turn), "length": float(length)}


def _is_hole(face, radius: float) -> bool:
    low, high = face.bounding_box
    return abs(high.x - low.x - 2 * radius) < 1e-3 and abs(high.y - low.y - 2 * radius) < 1e-3 and high.z - low.z > 1


def _cut(shape, at: tuple[float, float], half: float, lowest: float = -100):
    """Cut a square block around a place out of a shape."""
    return shape * Box(Pnt(at[0] - half, at[1] - half, lowest), Pnt(at[0] + half, at[1] + half, 100))


def _mesh(shape, at, half: float, bottom: float | None, fine: float, hole: float | None = None):
    """Mesh with the block's walls named `held`, the polymer's face too, and the hole's `wall`."""
    for face in shape.faces:
        middle = face.center
        edge = max(abs(middle.x - at[0]), abs(middle.y - at[1])) > half - 1e-3
        glued = bottom is not None and abs(middle.z - bottom) < 1e-3
        face.name = "held" if edge or glued else "free"
        if hole is not None and _is_hole(face, hole):
            face.name = "wall"
        near = hypot(middle.x - at[0], middle.y - at[1]) < 0.5 * half
        face.maxh = fine if near else 4 * fine
    return ng.Mesh(OCCGeometry(shape).GenerateMesh(maxh=4 * fine)).Curve(2)


def _work(mesh, values: dict, form_of_load) -> float:
    """Work of a unit load on its own way: the compliance it meets [N, mm]."""
    e, nu = values["structure_youngs_modulus"] * 1e-6, values["structure_poissons_ratio"]
    lame, shear = e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))
    space = ng.VectorH1(mesh, order=2, dirichlet="held")
    u, v = space.TnT()
    strain, other = ng.Sym(ng.Grad(u)), ng.Sym(ng.Grad(v))
    with ng.TaskManager():
        form = ng.BilinearForm(
            ng.InnerProduct(2 * shear * strain + lame * ng.Trace(strain) * ng.Id(3), other) * ng.dx, symmetric=True
        )
        load = ng.LinearForm(form_of_load(v)).Assemble()
        form.Assemble()
        results = ng.GridFunction(space)
        results.vec.data = form.mat.Inverse(space.FreeDofs(), "sparsecholesky") * load.vec
        return ng.InnerProduct(load.vec, results.vec)


if __name__ == "__main__":
    main(sys.argv[1:])
