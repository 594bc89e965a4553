"""FE of strips sheared across the rim of a window below them; solves the rows of windows.csv anew.

    FE/bin/python validation/fe_structure/windows.py

FE/bin/python has netgen-mesher and ngsolve. A strip of the thickness 1 in plane strain: its upper face is moved along
itself, its lower one is held beyond the window. Half of it, displacement of the fourth order with a pressure of the
third, so that one that keeps its volume does not lock; small elements at the rim.
"""

from __future__ import annotations

import csv
from pathlib import Path

from netgen.geom2d import SplineGeometry
from ngsolve import H1, BilinearForm, GridFunction, Integrate, Mesh, dx, grad

TABLE = Path(__file__).with_name("windows.csv")


def meshed(window: float, ledge: float) -> Mesh:
    """Half a strip from the window's middle to the ledge's end, refined at the window's rim."""
    outline = SplineGeometry()
    corners = (0, 0), (window, 0), (window + ledge, 0), (window + ledge, 1), (0, 1)
    points = [outline.AppendPoint(*corner) for corner in corners]
    for here, name in enumerate(("free", "held", "free", "moved", "middle")):
        outline.Append(["line", points[here], points[(here + 1) % 5]], bc=name)
    mesh = Mesh(outline.GenerateMesh(maxh=0.12))
    for _ in range(3):
        for element in mesh.Elements():
            at_rim = [abs(mesh[v].point[0] - window) + abs(mesh[v].point[1]) < 1e-9 for v in element.vertices]
            mesh.SetRefinementFlag(element, any(at_rim))
        mesh.Refine()
    return mesh


def held_length(window: float, ledge: float, poisson: float) -> float:
    """Length beyond the ledge that half a strip of thickness and shear modulus 1 holds as if it were on one."""
    mesh = meshed(window, ledge)
    along, up = (H1(mesh, order=4, dirichlet=f"held|moved{also}") for also in ("", "|middle"))
    space = along * up * H1(mesh, order=3)
    (u, w, p), (v, z, q) = space.TnT()
    sheared = 2 * grad(u)[0] * grad(v)[0] + 2 * grad(w)[1] * grad(z)[1]
    sheared += (grad(u)[1] + grad(w)[0]) * (grad(v)[1] + grad(z)[0])
    pressed = p * (grad(v)[0] + grad(z)[1]) + q * (grad(u)[0] + grad(w)[1]) + (1 - 2 * poisson) / (2 * poisson) * p * q
    form = BilinearForm((sheared - pressed) * dx).Assemble()
    results = GridFunction(space)
    results.components[0].Set(1, definedon=mesh.Boundaries("moved"))
    force = results.vec.CreateVector()
    force.data = -form.mat * results.vec
    results.vec.data += form.mat.Inverse(space.FreeDofs(), "umfpack") * force
    u, w, p = results.components
    shear = grad(u)[1] + grad(w)[0]
    energy = 2 * grad(u)[0] ** 2 + 2 * grad(w)[1] ** 2 + shear**2 - p * (grad(u)[0] + grad(w)[1])
    return float(Integrate(energy, mesh)) - ledge


def main() -> None:
    """Write what is found into the table's last column."""
    with TABLE.open(newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        window, ledge, poisson = (float(row[name]) for name in list(row)[:-1])
        row["held"] = f"{held_length(window, ledge, poisson):.4f}"
        print(*row.values(), flush=True)
    with TABLE.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
