"""FE of a round bar turned on a plate, with a fillet around its foot; solves the rows of fillets.csv anew.

    FE/bin/python validation/fe_structure/fillets.py

FE/bin/python has netgen-mesher and ngsolve. The plate is four times as wide as the bar and held at its rim; the bar's
end turns by one. The twist w(r, z) of a body of revolution is found from div(r^3 grad w) = 0 (Timoshenko and Goodier,
torsion of shafts of varying diameter), with a shear modulus of 1 and displacements of the fourth order. Energy above
the plate's face and within it, over the torque squared, is the compliance of bar and plate; each less that of a bar
with a sharp foot, in lengths of the bar and over the fillet's radius, is what the table tells. `foot` is the stress at
the foot over that at a sharp one, both read as `joint_samples.at_foot` reads the drawn parts: a mean over a millimetre
along the surface, the highest of all from the fillet's middle on.
"""

from __future__ import annotations

import contextlib
import csv
import sys
from itertools import product
from math import pi
from pathlib import Path
from typing import NamedTuple

from netgen.geom2d import SplineGeometry
from netgen.libngpy._meshing import NgException
from ngsolve import H1, BilinearForm, GridFunction, IfPos, Integrate, Mesh, dx, grad, sqrt, x

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tvimdesign/cad/fe/solvers"))
import foot_surface

TABLE = Path(__file__).with_name("fillets.csv")
RADII, PLATES = (6.0, 7.5, 9.0, 12.0), (1.5, 2.0, 3.0, 4.0, 5.0)
FILLETS = (0.25, 0.5, 0.75, 1.0, 1.5, 2.0)
LONG, WIDE = 1.5, 4.0
"""Length of the bar and radius of the plate, over the bar's radius."""
MESHES = 0.6, 0.5, 0.4, 0.3, 0.25
"""Largest element [mm]; of some outlines a mesh is found with the next only."""


class Foot(NamedTuple):
    """Evaluate one solution."""

    bar: float
    """Compliance above the plate's face, in lengths of the bar."""
    plate: float
    """Compliance of the plate from the bar's radius on, likewise."""
    stress: float
    """Mean over a millimetre at the foot, over that of the plain bar."""


def meshed(radius: float, plate: float, fillet: float) -> Mesh:
    """Half section: the plate below z = 0, the bar and its fillet above, fine at the foot."""
    outline, end, rim = SplineGeometry(), LONG * radius, WIDE * radius
    below, corner, outer = (outline.AppendPoint(*at) for at in ((0, -plate), (rim, -plate), (rim, 0)))
    foot = outline.AppendPoint(radius + fillet, 0, maxh=min(fillet / 12, 0.05) if fillet else 0.005)
    middle = outline.AppendPoint(0, 0)
    top, centre = outline.AppendPoint(radius, end), outline.AppendPoint(0, end)
    for ends, name in (((below, corner), "free"), ((corner, outer), "rim"), ((outer, foot), "free")):
        outline.Append(["line", *ends], bc=name, leftdomain=1)
    above = foot
    if fillet:
        above = outline.AppendPoint(radius, fillet)
        curve = ["spline3", foot, outline.AppendPoint(radius, 0), above]
        outline.Append(curve, bc="free", leftdomain=2, maxh=fillet / 12)
    for ends, name in (((above, top), "free"), ((top, centre), "turned"), ((centre, middle), "axis")):
        outline.Append(["line", *ends], bc=name, leftdomain=2)
    outline.Append(["line", middle, below], bc="axis", leftdomain=1)
    outline.Append(["line", middle, foot], bc="face", leftdomain=2, rightdomain=1, maxh=radius / 25)
    for largest in MESHES:
        with contextlib.suppress(NgException):
            mesh = Mesh(outline.GenerateMesh(maxh=largest, grading=0.2))
            mesh.Curve(4)
            return mesh
    raise ValueError(f"no mesh is found of a bar of {radius} mm on {plate} mm with {fillet} mm")


def solved(radius: float, plate: float, fillet: float) -> Foot:
    """Bar and plate under a torque."""
    mesh = meshed(radius, plate, fillet)
    space = H1(mesh, order=4, dirichlet="turned|rim")
    twist, test = space.TnT()
    form = BilinearForm(2 * pi * x**3 * grad(twist) * grad(test) * dx).Assemble()
    results = GridFunction(space)
    results.Set(1.0, definedon=mesh.Boundaries("turned"))
    results.vec.data -= form.mat.Inverse(space.FreeDofs(), "sparsecholesky") * (form.mat * results.vec).Evaluate()
    density, inside = 2 * pi * x**3 * grad(results) * grad(results), IfPos(radius + 1e-6 - x, 1, 0)
    bar, ring = (Integrate(share * density, mesh, order=12) for share in (inside, 1 - inside))
    torque, polar = bar + ring, 0.5 * pi * radius**4
    shear = x * sqrt(grad(results) * grad(results)) * polar / (torque * radius)
    along = [shear(mesh(*place)) for place in zip(*foot_surface.places(radius, fillet), strict=True)]
    return Foot(bar * polar / torque**2, ring * polar / torque**2, float(foot_surface.highest_mean(along)))


def main() -> None:
    """Solve all rows and write the table."""
    rows = []
    for radius, plate in product(RADII, PLATES):
        sharp = solved(radius, plate, 0.0)
        for fillet in FILLETS:
            now = solved(radius, plate, fillet)
            lengths = (sharp.bar - now.bar) / fillet, (now.plate - sharp.plate) / fillet
            rows.append((radius, plate, fillet, *(f"{each:.3f}" for each in (*lengths, now.stress / sharp.stress))))
    with TABLE.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(
            [("radius", "plate", "fillet", "bar_shorter", "plate_longer", "foot"), *rows]
        )


if __name__ == "__main__":
    main()
