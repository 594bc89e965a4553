"""FE of heat in half an arc or half a vane of the module as drawn, heated from ambient with the design's current.

Finds the times [s] at which the polymer's mean and the mean of its face away from the pads are as warm as asked, and
writes the course of all temperatures as PARTS/heat_fine.npz or heat_coarse.npz: from these follows when the joint is
soft. `drawn_layer` and `drawn_pads` are volumes of the cells over those of the parts as designed.
"""

import json
from pathlib import Path
from typing import Any

import elastic
import heat_equation
import heat_grid
import heat_lines
import heat_samples
import ngsolve as ng
import numpy as np
from heat_equation import KELVIN, Heated, Meshed

STEPS = 60
SPARSE = 1.2
"""How much wider cells are than the counts of `heat_lines` say: as wide as two minutes bear."""
LONGER = 1.3
"""How long it is heated, over the longest of the times the model has."""
GROWS = 1.03
"""Ratio of a step to the one before."""
NEWTON, NEAR = 12, 1e-2
"""Most iterations of a step, and the change [K] that ends them."""
ALIKE = 0.06
"""Share by which the cells' volume of polymer and pads may differ from what is designed: corners are rounded, and
rectangular modules lie across the cells."""
TIMES = ("softening_time", "mean_time", "far_face_time")


def solve(folder: Path, coarser: float = 1.0, field: Path | None = None) -> elastic.Found:
    """Return times [s]; those that do not come are left out."""
    inputs = json.loads((folder / "inputs.json").read_text())
    values, mm = inputs["values"], inputs["mm"]
    slot = 1e3 * values["air_conductivity"] / heat_equation.edge_contact(values)
    grid = heat_lines.grid_of(mm, SPARSE * coarser, slot)
    with np.load(folder / "surfaces.npz") as surfaces:
        names = heat_grid.materials_of(grid, dict(surfaces))
    points = grid.points()
    found = heat_equation.meshed(points, names, heat_grid.enclosed(grid, names))
    course = Course(inputs, found, Heated(values, found, grid, inputs["choices"].get("cold_side") == "sink"))
    layer = heat_samples.Layer(grid, found, points)
    drawn = {"drawn_layer": layer.volume / _designed(values, mm, "layer"),
             "drawn_pads": layer.pads / _designed(values, mm, "pads")}  # fmt: skip
    if max(abs(share - 1.0) for share in drawn.values()) > ALIKE or (mm["spreader_depth"] and "spreader" not in names):
        raise ValueError(f"cells do not have what is drawn: {drawn}, {', '.join(sorted(set(names.ravel())))}")
    longest = max(value for name in TIMES if np.isfinite(value := float(values[name])))
    with ng.TaskManager():
        times, states = course.heated(LONGER * longest, round(STEPS / coarser))
    columns, means, faces = layer.course(states)
    parts = heat_samples.parts(found, grid, states, points)
    mesh = "fine" if coarser == 1.0 else "coarse"
    np.savez_compressed(folder / f"heat_{mesh}.npz", times=times, columns=columns, shares=layer.shares,
                        slices=layer.slices, **parts)  # fmt: skip
    target = values["target_temperature"] - KELVIN
    if field:
        heat_samples.write_field(field, found, states[int(np.argmin(np.abs(means - target)))])
    whole = np.array([_passed(times, course, target) for course in (means, faces)])
    told = {"unknowns": course.heated_by.space.ndof, **drawn}
    return told | {name: one for name, one in zip(TIMES[1:], whole, strict=True) if np.isfinite(one)}


def _designed(values: dict[str, float], mm: dict[str, float], what: str) -> float:
    """Return the volume of layer or pads in this part of the ring, as designed [m3]."""
    count = 2.0 * mm.get("vane_count", 0.0) or 2.0 * mm["arc_count"]
    if what == "pads":
        thick = mm["pad_depth"] - (0.0 if mm.get("vane_count") else mm["spreader_depth"])
        return values["heated_area"] * thick * 1e-3 / count
    depth = mm["block_depth"] if mm.get("vane_count") else mm["pcl_thickness"]
    return values["pcl_area"] * depth * 1e-3 / count


def _passed(times: Any, course: Any, limit: float) -> float:
    """Return when a rising course passes a limit; infinite where it does not."""
    above = np.flatnonzero(course >= limit)
    if not len(above) or above[0] == 0:
        return float("inf")
    k = above[0]
    return float(np.interp(limit, course[k - 1 : k + 1], times[k - 1 : k + 1]))


class Course:
    """The module heated step by step."""

    def __init__(self, inputs: dict[str, Any], found: Meshed, heated: Heated) -> None:
        self.values, self.found, self.heated_by = inputs["values"], found, heated
        self.profile = inputs["current_profiles"].get("softening")
        self.sunk = inputs["choices"].get("cold_side") == "sink"

    def heated(self, seconds: float, steps: int) -> tuple[Any, Any]:
        """Return times [s] and temperatures of all corners [degC] then, shape (times, corners). Raises ValueError.

        Second order in time (BDF2 with growing steps), the first step of first order.
        """
        by, lengths = self.heated_by, GROWS ** np.arange(steps)
        lengths = seconds * lengths / lengths.sum()
        by.now.Set(self.values["ambient_temperature"] - KELVIN)
        for one in (by.before, by.last, by.guess):
            one.vec.data = by.now.vec
        states, time = [by.now.vec.FV().NumPy().copy()], 0.0
        for number, length in enumerate(lengths):
            ratio = length / lengths[number - 1] if number else 0.0
            weights = ((1.0 + 2.0 * ratio) / (1.0 + ratio), 1.0 + ratio, ratio**2 / (1.0 + ratio))
            for parameter, weight in zip(by.weights, weights, strict=True):
                parameter.Set(float(weight))
            time += length
            by.step.Set(float(length))
            by.current.Set(self._current(time))
            by.last.vec.data, by.before.vec.data = by.before.vec, by.now.vec
            by.now.vec.data += float(ratio) * (by.before.vec - by.last.vec)
            by.guess.vec.data = by.now.vec
            self._settle(time)
            self._warm_sink(float(length))
            self._warm_chamber()
            states.append(by.now.vec.FV().NumPy().copy())
        return np.concatenate([[0.0], np.cumsum(lengths)]), np.array(states)

    def _settle(self, time: float) -> None:
        by = self.heated_by
        residual, change = by.now.vec.CreateVector(), by.now.vec.CreateVector()
        for _ in range(NEWTON):
            by.form.Apply(by.now.vec, residual)
            by.form.AssembleLinearization(by.now.vec)
            change.data = by.form.mat.Inverse(by.space.FreeDofs(), "sparsecholesky") * residual
            by.now.vec.data -= change
            if np.max(np.abs(change.FV().NumPy())) < NEAR:
                return
        raise ValueError(f"the step to {time:.3g} s does not settle")

    def _current(self, time: float) -> float:
        """[A]"""
        if not self.profile:
            return float(self.values["current"])
        currents = self.profile["currents"]
        return float(np.interp(time, np.linspace(0.0, self.profile["duration"], len(currents)), currents))

    def _warm_chamber(self) -> None:
        """Warm the enclosed air by what it takes: it is as warm as the mean of the faces around it."""
        by, faces = self.heated_by, self.heated_by.mesh.Boundaries("chamber")
        area = ng.Integrate(1.0, by.mesh, ng.BND, definedon=faces)
        if area > 0.0:
            by.chamber.Set(ng.Integrate(by.now, by.mesh, ng.BND, definedon=faces) / area)

    def _warm_sink(self, length: float) -> None:
        """Warm the sink at the cold sides by their heat; it gives its own to the air."""
        if not self.sunk:
            return
        by, v = self.heated_by, self.values
        count = 2.0 * by.grid.mm["vane_count" if by.grid.upright else "arc_count"]
        cold, sink = by.mesh.Boundaries("cold"), by.sink.Get()
        area = ng.Integrate(1.0, by.mesh, ng.BND, definedon=cold)
        taken = v["sink_contact"] * (ng.Integrate(by.now, by.mesh, ng.BND, definedon=cold) - area * sink)
        air = v["ambient_temperature"]
        shone = v["surface_emissivity"] * heat_equation.STEFAN_BOLTZMANN * ((sink + KELVIN) ** 4 - air**4)
        lost = v["sink_area"] / count * (v["sink_coefficient"] * (sink + KELVIN - air) + shone)
        by.sink.Set(sink + length * (taken - lost) / (v["sink_capacity"] / count))


if __name__ == "__main__":
    elastic.main(solve, __doc__)
