"""FE of single rubber pads, pressed between a stiff face and one with a slot; solves the rows of pads.csv anew.

    FE/bin/python validation/fe_structure/pads.py

FE/bin/python has netgen-mesher and ngsolve. The pads' sizes stand in the table; what is found is written into its last
column. Half of each pad, cubic elements, half as large at the slot's edges.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

from netgen.occ import Box, Glue, OCCGeometry, Pnt
from ngsolve import CF, BilinearForm, Grad, GridFunction, InnerProduct, Mesh, Sym, Trace, VectorH1, dx

TABLE = Path(__file__).with_name("pads.csv")


def parts(width: float, height: float, thick: float, slot: tuple[float, float]) -> Any:
    """Half a pad, its middle at x = 0, its held face at y = 0 with the slot from z = 0 up, faces named."""
    across, up = slot[0] / 2 or width / 4, slot[1] or height / 2
    whole = Glue([Box(Pnt(x0, 0, z0), Pnt(x1, thick, z1))
                  for x0, x1 in ((0, across), (across, width / 2)) for z0, z1 in ((0, up), (up, height))])  # fmt: skip
    for face in whole.faces:
        at = face.center
        over = slot[0] > 0 and at.x < across and at.z < up
        sides = {"front": abs(at.y - thick) < 1e-6, "back": abs(at.y) < 1e-6 and not over, "middle": abs(at.x) < 1e-6}
        face.name = next((name for name, on in sides.items() if on), "free")
    for edge in whole.edges:
        if abs(edge.center.y) < 1e-6:
            edge.maxh = thick / 6
    return whole


def over_three_g(width: float, height: float, thick: float, slot: tuple[float, float], poisson: float) -> float:
    """Force over the way of the front face, over 3 G A/t."""
    mesh = Mesh(OCCGeometry(parts(width, height, thick, slot)).GenerateMesh(maxh=thick / 2.5))
    space = VectorH1(mesh, order=3, dirichlet="front|back", dirichletx="front|back|middle")
    u, v = space.TnT()
    lame = 2 * poisson / (1 - 2 * poisson)
    worked = 2 * InnerProduct(Sym(Grad(u)), Sym(Grad(v))) + lame * Trace(Grad(u)) * Trace(Grad(v))
    form = BilinearForm(worked * dx, symmetric=True).Assemble()
    results = GridFunction(space)
    results.Set(CF((0, -1, 0)), definedon=mesh.Boundaries("front"))
    change = results.vec.CreateVector()
    change.data = form.mat * results.vec
    results.vec.data -= form.mat.Inverse(space.FreeDofs(), "sparsecholesky") * change
    change.data = form.mat * results.vec
    return float(2 * InnerProduct(change, results.vec) / (3 * width * height / thick))


def main() -> None:
    """Write what is found into the table's last column."""
    with TABLE.open(newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        width, height, thick, across, up, poisson = (float(row[name]) for name in list(row)[:-1])
        results = over_three_g(width, height, thick, (across, up), poisson)
        print(f"{row['width']} x {row['height']}: {row['over_three_g']} -> {results:.3f}", flush=True)
        row["over_three_g"] = f"{results:.3f}"
    with TABLE.open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
