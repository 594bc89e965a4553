"""The shear module's strip once more by finite elements: an outside judge for `plane.py`.

    FE/bin/python validation/heat_sector/fe.py CASE.json --seconds 150

FE/bin/python has ngsolve; it needs nothing of the package. `outside_judge.py` writes the cases, calls this and reads
what it prints: times at which the mean of the layer is at 45, 60, 80 and 100 degC, and the mean of its far face at 100.
Quadratic elements on rectangles, implicit steps in time, Newton's method.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import ngsolve as ng
import numpy as np
from netgen.meshing import Element1D, Element2D, FaceDescriptor, Mesh, MeshPoint, Pnt

THIN = 5e-5
"""Thickness of the sheets that stand for contacts [m]."""
SIGMA = 5.670374419e-8
KELVIN = 273.15


def graded(start: float, end: float, count: int, ratio: float) -> np.ndarray:
    """Ends of cells between two places; each cell is `ratio` times as wide as the one before."""
    widths = ratio ** np.arange(count)
    return start + (end - start) * np.concatenate([[0.0], np.cumsum(widths)]) / widths.sum()


class Drawing:
    """Rectangles of materials on one grid of lines."""

    def __init__(self, case: dict[str, float]) -> None:
        """Put the layer's face at the pads on y = 0 and the middle of the arc on x = 0."""
        c, w = case, case["half_width"]
        half, inside = 0.5 * c["pad_depth"], max(w - c["ledge"], 0.3 * w)
        self.w, self.inside, self.end = w, inside, w + c["beside"]
        contact = [w + THIN]
        self.x = self._lines(
            [graded(0.0, inside, 8, 0.85), graded(inside, w, 8, 0.8), np.array([w, *contact]),
             graded(w + THIN, self.end, 14, 1.25)]
        )  # fmt: skip
        self.top = c["layer_depth"]
        under = -2.0 * half - 2.0 * THIN
        self.levels = {"cold": (under, under + half), "leak": (under + half, under + half + THIN),
                       "hot": (-THIN - half, -THIN), "near": (-THIN, 0.0), "layer": (0.0, self.top),
                       "far": (self.top, self.top + THIN)}  # fmt: skip
        self.bottom, self.under = -c["floor_depth"], under
        self.plate = (self.top + THIN, self.top + THIN + c["plate_depth"])
        self.y = self._lines(
            [graded(self.bottom, under, 4, 1.0), np.linspace(*self.levels["cold"], 2), np.array(self.levels["leak"]),
             np.linspace(*self.levels["hot"], 3), np.array(self.levels["near"]), np.linspace(0.0, self.top, 13),
             np.array(self.levels["far"]), graded(*self.plate, 6, 1.2)]
        )  # fmt: skip

    @staticmethod
    def _lines(parts: Sequence[np.ndarray]) -> np.ndarray:
        return np.unique(np.round(np.concatenate(parts), 9))

    def material(self, x: float, y: float) -> str | None:
        """What is at a place."""
        if y > self.plate[0]:
            return "plate"
        if x < self.w:
            for name, (low, high) in self.levels.items():
                if low < y < high:
                    return name
            return "ledge" if x > self.inside else None
        if y > 0.0:
            return "air"
        touching = x < self.w + THIN and y > self.under
        return "edge" if touching else "floor"

    def surface(self, inner: str | None, place: tuple[float, float]) -> str:
        """Name of a border between a material and nothing."""
        x, y = place
        if x >= self.end - 1e-9:
            return {"plate": "to_core", "floor": "to_housing"}.get(inner or "", "none")
        if inner == "plate" and y >= self.plate[1] - 1e-9:
            return "above"
        if inner in ("floor", "ledge") and y <= self.bottom + 1e-9:
            return "below"
        return "window" if inner == "cold" and y <= self.under + 1e-9 else "none"


SURFACES = ("none", "to_core", "to_housing", "above", "below", "window")


def mesh_of(drawing: Drawing) -> ng.Mesh:
    """Mesh of rectangles with named materials and borders."""
    xs, ys = drawing.x, drawing.y
    materials = [[drawing.material(0.5 * (a + b), 0.5 * (c + d)) for c, d in pairwise(ys)]
                 for a, b in pairwise(xs)]  # fmt: skip
    names = sorted({name for column in materials for name in column if name})
    mesh = Mesh(dim=2)
    for number, name in enumerate(names, 1):
        mesh.Add(FaceDescriptor(surfnr=number, domin=number, bc=number))
        mesh.SetMaterial(number, name)
    points: dict[tuple[int, int], Any] = {}

    def point(i: int, j: int) -> Any:
        if (i, j) not in points:
            points[i, j] = mesh.Add(MeshPoint(Pnt(float(xs[i]), float(ys[j]), 0.0)))
        return points[i, j]

    def border(ends: tuple[tuple[int, int], tuple[int, int]], inner: str | None) -> None:
        (i, j), (k, m) = ends
        place = 0.5 * float(xs[i] + xs[k]), 0.5 * float(ys[j] + ys[m])
        number = 1 + SURFACES.index(drawing.surface(inner, place))
        mesh.Add(Element1D([point(*ends[0]), point(*ends[1])], index=number))

    for i, column in enumerate(materials):
        for j, name in enumerate(column):
            if name is None:
                continue
            corners = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]
            mesh.Add(Element2D(names.index(name) + 1, corners))
            beyond = {
                ((i, j), (i + 1, j)): column[j - 1] if j else None,
                ((i + 1, j), (i + 1, j + 1)): materials[i + 1][j] if i + 1 < len(materials) else None,
                ((i + 1, j + 1), (i, j + 1)): column[j + 1] if j + 1 < len(column) else None,
                ((i, j + 1), (i, j)): materials[i - 1][j] if i else None,
            }
            for ends, other in beyond.items():
                if other is None:
                    border(ends, name)
    for number, name in enumerate(SURFACES):
        mesh.SetBCName(number, name)
    return ng.Mesh(mesh)


def clipped(t: Any, low: float, high: float) -> Any:
    """`t` between two limits."""
    return ng.IfPos(t - low, ng.IfPos(t - high, high, t), low)


class Heated:
    """Equations of the strip for one implicit step."""

    def __init__(self, case: dict[str, float], drawing: Drawing) -> None:
        """Write the residual of a step with its length and the bodies at the ends as parameters."""
        self.case, self.mesh = case, mesh_of(drawing)
        c, mesh = case, self.mesh
        self.space = ng.H1(mesh, order=2)
        self.now, self.before = ng.GridFunction(self.space), ng.GridFunction(self.space)
        self.step = ng.Parameter(0.1)
        self.core, self.housing = ng.Parameter(c["ambient"]), ng.Parameter(c["ambient"])
        t, v = self.space.TnT()
        old = self.before
        form = ng.BilinearForm(self.space)
        form += (self.heat(t) - self.heat(old)) / self.step * v * ng.dx
        across, up = self.conductivities(t, old)
        form += (across * ng.grad(t)[0] * ng.grad(v)[0] + up * ng.grad(t)[1] * ng.grad(v)[1]) * ng.dx
        self._pads(form, t, v)
        self._outside(form, t, v, drawing)
        self.form = form

    def heat(self, t: Any) -> Any:
        """Heat content of a volume [J/m3]; of PCL with sharp ends of its melting range."""
        c = self.case
        start, end = c["melting_start"], c["melting_end"]
        within = clipped(t, start, end) - start
        mean = 0.5 * (c["specific_heat_solid"] + c["specific_heat_melt"])
        melting = (c["latent_heat"] / (end - start) + mean) * within
        pcl = c["specific_heat_solid"] * clipped(t, -1e3, start) + melting
        pcl += c["specific_heat_melt"] * (clipped(t, end, 1e3) - end)
        pad = c["pad_heat_capacity"] / c["pad_depth"]
        bodies = {"layer": c["density"] * pcl, "hot": pad * t, "cold": pad * t}
        bodies |= dict.fromkeys(("plate", "floor", "ledge"), c["structure_heat_capacity"] * t)
        return self.mesh.MaterialCF(bodies, default=0.0)

    def conductivities(self, t: Any, old: Any) -> tuple[Any, Any]:
        """Conductivity along the strip and up through it [W/m K]."""
        c = self.case
        start, end = c["melting_start"], c["melting_end"]
        molten = (clipped(t, start, end) - start) / (end - start)
        pcl = c["conductivity_solid"] + molten * (c["conductivity_melt"] - c["conductivity_solid"])
        k = c["structure_conductivity"]
        factor = c["emissivity"] / (2.0 - c["emissivity"])
        radiated = 4.0 * SIGMA * factor * (old + KELVIN) ** 3 * c["gap"]
        along = {"layer": pcl, "hot": c["pad_conductivity"], "cold": c["pad_conductivity"]}
        along |= {"air": c["air_conductivity"], "edge": c["pad_edge_contact"] * THIN}
        up = {"layer": pcl, "hot": 100.0, "cold": 100.0, "air": c["air_conductivity"] + radiated}
        up |= {"near": c["hot_contact"] * THIN, "far": c["rotor_contact"] * THIN, "leak": c["conductance"] * THIN}
        for name in ("edge", "near", "far", "leak"):
            along.setdefault(name, 1e-6)
            up.setdefault(name, 1e-6)
        for name in ("plate", "floor", "ledge"):
            along[name] = up[name] = k
        return self.mesh.MaterialCF(along), self.mesh.MaterialCF(up)

    def _pads(self, form: Any, t: Any, v: Any) -> None:
        c, half = self.case, 0.5 * self.case["pad_depth"]
        joule = 0.5 * c["current"] ** 2 * c["resistance"]
        pumped = c["seebeck"] * c["current"] * (t + KELVIN)
        form += -(pumped + joule) / half * v * ng.dx("hot")
        form += (pumped - joule) / half * v * ng.dx("cold")

    def _outside(self, form: Any, t: Any, v: Any, drawing: Drawing) -> None:
        c = self.case
        open_share = c["window_share"] * drawing.w / drawing.inside

        def lost(coefficient: float, share: float = 1.0) -> Any:
            radiated = c["emissivity"] * SIGMA * ((t + KELVIN) ** 4 - (c["ambient"] + KELVIN) ** 4)
            return share * (coefficient * (t - c["ambient"]) + radiated) * v

        form += lost(c["rotor_coefficient"]) * ng.ds("above")
        form += lost(c["floor_coefficient"]) * ng.ds("below")
        form += lost(c["cold_coefficient"], open_share) * ng.ds("window")
        form += c["core_conductance"] / c["plate_depth"] * (t - self.core) * v * ng.ds("to_core")
        form += c["housing_conductance"] / c["floor_depth"] * (t - self.housing) * v * ng.ds("to_housing")

    def advance(self, seconds: float) -> None:
        """One implicit step, then the bodies at the ends."""
        c = self.case
        self.step.Set(seconds)
        self.before.vec.data = self.now.vec
        ng.solvers.Newton(self.form, self.now, printing=False, maxit=20, maxerr=1e-7, inverse="umfpack")
        plate = ng.Integrate(self.now, self.mesh, ng.BND, definedon=self.mesh.Boundaries("to_core")) / c["plate_depth"]
        floor = ng.Integrate(self.now, self.mesh, ng.BND, definedon=self.mesh.Boundaries("to_housing"))
        floor /= c["floor_depth"]
        core, housing = self.core.Get(), self.housing.Get()
        self.core.Set(core + seconds * c["core_conductance"] * (plate - core) / c["core_capacity"])
        radiated = c["emissivity"] * SIGMA * ((housing + KELVIN) ** 4 - (c["ambient"] + KELVIN) ** 4)
        outside = c["housing_surface"] * (c["floor_coefficient"] * (housing - c["ambient"]) + radiated)
        inside = c["housing_conductance"] * (floor - housing)
        self.housing.Set(housing + seconds * (inside - outside) / c["housing_capacity"])


def solved(case: dict[str, float], seconds: float, step: float) -> tuple[list[float], list[float], list[float]]:
    """Heat from ambient; times, mean temperatures of the layer and of its far face [degC]."""
    drawing = Drawing(case)
    heated = Heated(case, drawing)
    heated.now.Set(case["ambient"])
    layer = heated.mesh.Materials("layer")
    area = ng.Integrate(1.0, heated.mesh, definedon=layer)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    far = [heated.mesh(float(0.5 * drawing.w * (1.0 + at)), drawing.top - 1e-9) for at in nodes]
    times, means, faces = [0.0], [case["ambient"]], [case["ambient"]]
    while times[-1] < seconds - 1e-9:
        heated.advance(step)
        times.append(times[-1] + step)
        means.append(ng.Integrate(heated.now, heated.mesh, definedon=layer) / area)
        faces.append(0.5 * float(weights @ [heated.now(place) for place in far]))
    return times, means, faces


def main() -> None:
    """Solve the case of a file and print the times it takes."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case")
    parser.add_argument("--seconds", type=float, required=True)
    parser.add_argument("--step", type=float, default=0.5)
    asked = parser.parse_args()
    case = json.loads(Path(asked.case).read_text(encoding="utf-8"))
    times, means, faces = solved(case, asked.seconds, asked.step)
    found = {f"mean_{limit:.0f}": float(np.interp(limit, means, times)) for limit in (45.0, 60.0, 80.0, 100.0)}
    print(json.dumps({**found, "far_100": float(np.interp(100.0, faces, times))}))


if __name__ == "__main__":
    main()
