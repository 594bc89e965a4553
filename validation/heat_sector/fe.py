"""A module's drawing heated by finite elements: an outside judge for `plane.py`.

    FE/bin/python validation/heat_sector/fe.py CASE.json --out STATES.npz --seconds 150

FE/bin/python has ngsolve; it needs nothing of the package. `outside_judge.py` writes the cases, calls this and reads
the temperatures it writes: at the places that the case asks for, and of the bodies, at each step.

Quadratic elements on rectangles; the enthalpy by steps of two implicit stages (SDIRK2 of Alexander, 1977, second order
and L-stable) that widen with time; Newton's method; the bodies solved with the rest.
"""

from __future__ import annotations

import argparse
import json
from itertools import pairwise
from math import sqrt
from pathlib import Path
from typing import Any

import netgen.meshing as nm
import ngsolve as ng
import numpy as np
from fe_drawings import DRAWINGS, KELVIN, SIGMA, Drawing

IMPLICIT = 1.0 - sqrt(0.5)
"""Share of a step that a stage of Alexander's method takes implicitly."""
WIDENING = 1.5
"""Power of the steps' numbers that their ends in time go with."""
SETTLED = 1e-5
"""Largest change of Newton's last step [K]."""


def mesh_of(drawing: Drawing) -> ng.Mesh:
    """Mesh of rectangles with named materials; lines between two of them named after both."""
    xs, ys = drawing.x, drawing.y
    names = [[drawing.what(0.5 * (a + b), 0.5 * (c + d)) for c, d in pairwise(ys)] for a, b in pairwise(xs)]
    numbers = {name: k for k, name in enumerate(sorted({n for column in names for n in column if n}), 1)}
    mesh = nm.Mesh(dim=2)
    for name, number in numbers.items():
        mesh.Add(nm.FaceDescriptor(surfnr=number, domin=number, bc=number))
        mesh.SetMaterial(number, name)
    points: dict[tuple[int, int], Any] = {}
    lines: dict[str, int] = {}

    def point(i: int, j: int) -> Any:
        if (i, j) not in points:
            points[i, j] = mesh.Add(nm.MeshPoint(nm.Pnt(float(xs[i]), float(ys[j]), 0.0)))
        return points[i, j]

    def at(i: int, j: int) -> str | None:
        return names[i][j] if 0 <= i < len(names) and 0 <= j < len(names[0]) else None

    def line(way: str, before: str | None, after: str | None, ends: tuple[tuple[int, int], tuple[int, int]]) -> None:
        if before != after:
            name = f"{way}:{before or ''}>{after or ''}"
            mesh.Add(nm.Element1D([point(*end) for end in ends], index=lines.setdefault(name, len(lines) + 1)))

    for i in range(len(xs)):
        for j in range(len(ys)):
            if name := at(i, j):
                corners = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]
                mesh.Add(nm.Element2D(numbers[name], corners))
            line("x", at(i - 1, j), name, ((i, j), (i, j + 1)))
            line("y", at(i, j - 1), name, ((i, j), (i + 1, j)))
    for name, number in lines.items():
        mesh.SetBCName(number - 1, name)
    return ng.Mesh(mesh)


def clipped(t: Any, low: float, high: float) -> Any:
    """`t` between two limits."""
    return ng.IfPos(t - low, ng.IfPos(t - high, high, t), low)


class Heated:
    """Equations of a drawing for one stage of a step."""

    def __init__(self, drawing: Drawing, polymer: dict[str, float]) -> None:
        """Write a stage's residual, with its length and what it starts from as parameters."""
        self.drawing, self.polymer, self.mesh = drawing, polymer, mesh_of(drawing)
        bodies = [ng.NumberSpace(self.mesh) for _ in drawing.bodies]
        self.space = ng.FESpace([ng.H1(self.mesh, order=2), *bodies])
        self.now, self.start, self.first = (ng.GridFunction(self.space) for _ in range(3))
        self.length, self.weight = ng.Parameter(1.0), ng.Parameter(0.0)
        trial, test = self.space.TnT()
        self.form = ng.BilinearForm(self.space)
        self._within(trial[0], test[0])
        self._bodies(trial[1:], test[1:])
        drawn = set(self.mesh.GetMaterials())
        for exchange in drawing.exchanges:
            if exchange.of_volume and exchange.where not in drawn:
                continue
            where = ng.dx(exchange.where) if exchange.of_volume else ng.ds(exchange.where)
            if exchange.body is None:
                self.form += self.lost(trial[0], exchange.coefficient, exchange.emissivity) * test[0] * where
            else:
                apart = trial[0] - trial[1 + exchange.body], test[0] - test[1 + exchange.body]
                self.form += exchange.coefficient * apart[0] * apart[1] * where
        every = [drawing.ambient] * (1 + len(bodies))
        for part, value in zip(self.now.components, every, strict=True):
            part.Set(value)

    def content(self, t: Any) -> Any:
        """Heat content of a volume [J/m3]; of the polymer with sharp ends of its melting range."""
        p = self.polymer
        start, end = p["start"], p["end"]
        mean = 0.5 * (p["specific_heat_solid"] + p["specific_heat_melt"])
        melting = p["latent_heat"] / (end - start) + mean
        heat = p["specific_heat_solid"] * clipped(t, -1e3, start) + melting * (clipped(t, start, end) - start)
        heat += p["specific_heat_melt"] * (clipped(t, end, 1e4) - end)
        contents = {name: material.heat_capacity * t for name, material in self.drawing.materials.items()}
        return self.mesh.MaterialCF({**contents, "layer": p["density"] * heat})

    def conductivities(self, t: Any) -> tuple[Any, Any]:
        """Conductivity along the drawing and up [W/m K]."""
        p = self.polymer
        molten = (clipped(t, p["start"], p["end"]) - p["start"]) / (p["end"] - p["start"])
        layer = p["conductivity_solid"] + molten * (p["conductivity_melt"] - p["conductivity_solid"])
        shine = 4.0 * SIGMA * (t + KELVIN) ** 3
        materials = self.drawing.materials.items()
        along = {name: ng.CF(material.along) for name, material in materials}
        up = {name: material.up + material.shines * shine for name, material in materials}
        return self.mesh.MaterialCF({**along, "layer": layer}), self.mesh.MaterialCF({**up, "layer": layer})

    def lost(self, t: Any, coefficient: float, emissivity: float) -> Any:
        """Heat that a surface gives to the air [W/m2]."""
        ambient = self.drawing.ambient
        return coefficient * (t - ambient) + emissivity * SIGMA * ((t + KELVIN) ** 4 - (ambient + KELVIN) ** 4)

    def _grown(self, of: Any, now: Any, start: Any, first: Any) -> Any:
        """Return the rate of a stage's content."""
        return (of(now) - of(start) - self.weight * (of(first) - of(start))) / self.length

    def _within(self, t: Any, v: Any) -> None:
        d = self.drawing
        along, up = self.conductivities(t)
        start, first = self.start.components[0], self.first.components[0]
        self.form += self._grown(self.content, t, start, first) * v * ng.dx
        self.form += (along * ng.grad(t)[0] * ng.grad(v)[0] + up * ng.grad(t)[1] * ng.grad(v)[1]) * ng.dx
        self.form += -d.joule / d.legs * v * ng.dx("legs")
        self.form += -d.pumped * (t + KELVIN) / d.film * v * ng.dx("hot")
        self.form += d.pumped * (t + KELVIN) / d.film * v * ng.dx("cold")

    def _bodies(self, bodies: Any, tests: Any) -> None:
        area = ng.Integrate(1.0, self.mesh, definedon=self.mesh.Materials("plate"))
        for k, (body, t, v) in enumerate(zip(self.drawing.bodies, bodies, tests, strict=True), 1):
            grown = self._grown(lambda identity: identity, t, self.start.components[k], self.first.components[k])
            outside = body.surface * self.lost(t, body.coefficient, body.emissivity)
            self.form += (body.capacity * grown + outside) / area * v * ng.dx("plate")

    def _solve(self) -> None:
        residual, change = self.now.vec.CreateVector(), self.now.vec.CreateVector()
        for count in range(60):
            self.form.Apply(self.now.vec, residual)
            self.form.AssembleLinearization(self.now.vec)
            change.data = self.form.mat.Inverse(self.space.FreeDofs(), inverse="umfpack") * residual
            # An element that jumps to and fro over an end of the melting range settles with half of the change.
            self.now.vec.data -= (1.0 if count < 12 or count % 2 else 0.5) * change
            if np.max(np.abs(change.FV().NumPy())) < SETTLED:
                return
        raise RuntimeError("a stage did not settle")

    def advance(self, seconds: float) -> None:
        """Take one step of two stages."""
        self.length.Set(IMPLICIT * seconds)
        self.start.vec.data = self.now.vec
        self.first.vec.data = self.now.vec
        self.weight.Set(0.0)
        self._solve()
        self.first.vec.data = self.now.vec
        self.weight.Set((1.0 - IMPLICIT) / IMPLICIT)
        self._solve()


def main() -> None:
    """Heat the case of a file from ambient and write times and temperatures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--seconds", type=float, required=True)
    parser.add_argument("--steps", type=int, default=80)
    parser.add_argument("--fine", type=float, default=1.0)
    options = parser.parse_args()
    case = json.loads(options.case.read_text(encoding="utf-8"))
    drawing = DRAWINGS[case["drawing"]](case["numbers"], options.fine)
    heated = Heated(drawing, case["polymer"])
    print(f"{len(drawing.x)} x {len(drawing.y)} lines, {heated.space.ndof} unknowns", flush=True)
    places = heated.mesh(*(np.array(place) for place in case["places"]))
    times = options.seconds * np.linspace(0.0, 1.0, options.steps + 1) ** WIDENING
    states = []
    for seconds in [0.0, *np.diff(times)]:
        if seconds:
            heated.advance(float(seconds))
        layer, *bodies = heated.now.components
        states.append(np.concatenate([layer(places).ravel(), [body.vec[0] for body in bodies]]))
    np.savez(options.out, times=times, states=np.array(states))


if __name__ == "__main__":
    main()
