"""The product's times against two dimensions, for every shipped study as it starts and at its optimum.

    python validation/heat_sector/compare.py [--work FOLDER] [STUDY ...]

runs the studies that have an optimum (what is in the work folder is not run again), heats each module in the plane
and writes `results.csv`; with names of studies it writes their rows. The numbers of a plane are read off the device's
table; its heat is that of `plane.py` alone. When the joint is soft is decided by the polymer's own spectrum and the
structure's moduli, from the plane's temperatures and molten shares.
"""

from __future__ import annotations

import argparse
import csv
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import compression
import numpy as np
import shear
from plane import Array, Plane, passed
from warm_joint import WarmJoint

from tvimdesign.device.core.impedance.warm_structure import PartTemperatures
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, resolve_design
from tvimdesign.study import given, read_study
from tvimdesign.study.design import read_design

HERE = Path(__file__).parent
RESULTS = HERE / "results.csv"
ROOT = HERE.parents[1]
TIMES = ("softening_time", "mean_time", "far_face_time")
HEADER = ("study", "design", "time", "product [s]", "plane [s]", "difference [%]", "warmer by [K]", "time over rise")
LONGER = (1.3, 2.6)
"""How long the plane is heated, over the product's longest time; the second where it is not soft by the first."""
EARLY = 0.25
"""Share of the time heated below which a softening time is sought again in shorter steps."""
STEPS = 250


def inputs_of(model: DeviceFunctions) -> dict[str, Any]:
    """Return every input of a module, in SI."""
    numbers: dict[str, Any] = {name: float(model.start[index]) for name, index in model.index.items()}
    return {**numbers, **model.words, "rotor_cells": int(numbers["rotor_cells"])}


def model_of(path: Path, **changes: float) -> DeviceFunctions:
    """Return the module at a study's start, with some inputs changed (SI); its melt has no memory of its crystals."""
    study, changes = read_study(path), {"melt_memory": 1.0, **changes}
    return DeviceFunctions(study.table, {**given(study), **changes}, tuple(study.operating_points), study.solver.cells)


def optimum_of(folder: Path, **changes: float) -> DeviceFunctions:
    """Return the module of a run, with some inputs changed (SI); its melt has no memory of its crystals."""
    module = resolve_design(read_design(folder / "design.json"))
    values = {**module.values, "melt_memory": 1.0, **changes}
    return DeviceFunctions(module.table, values, module.points, module.study.solver.cells)


def plane_of(model: DeviceFunctions, fine: float = 1.0) -> Plane:
    """Draw the module in the plane."""
    values = inputs_of(model)
    if "arc_span" in values:
        return shear.plane(shear.case_of(model.table, values), fine)
    return compression.plane(model.table, values, fine)


class Switch(NamedTuple):
    """A plane while it is heated, at each of its times."""

    times: Array
    stiffness: Array
    """Size of the joint's dynamic stiffness at the hot point's frequency [N m/rad]."""
    mean: Array
    """Temperature of the polymer [degC]."""
    far: Array
    """Of its face away from the pads."""

    def of(self, name: str) -> Array:
        """Return the temperature by which a time is judged [degC]."""
        return self.far if name == "far_face_time" else self.mean


class Compared(NamedTuple):
    """A time by the product and by the plane."""

    product: float
    plane: float
    warmer: float
    """How much warmer the product is at its time than the plane is then [K]: far face or mean of the polymer."""
    over_rise: float
    """Relative change of the plane's time that a relative change of its temperature above ambient makes: 1 where that
    rises evenly, 2 as the square root of time, more where it stalls."""

    @property
    def difference(self) -> float:
        """Of the product's time [%]."""
        return 0.0 if self.product == self.plane else 100.0 * (self.product / self.plane - 1.0)


class Judge:
    """Evaluate the joint at the temperatures of a plane."""

    def __init__(self, model: DeviceFunctions, plane: Plane) -> None:
        """Take what the joint is beside its heat off the table."""
        self.model, self.plane, self.known = model, plane, inputs_of(model)
        self.joint = WarmJoint(model.table, self.known)
        self.sheared = self.joint.sheared
        layers = shear.columns if self.sheared else compression.rows
        self.layers, self.shares = layers(plane, "layer")
        depths = (plane.dy if self.sheared else plane.dx)[self.layers[0]]
        self.slices = depths / np.sum(depths)

    def _mean(self, state: Array, name: str) -> float:
        own = self.plane.cells(name)
        return float(self.plane.volume[own] @ state[own] / np.sum(self.plane.volume[own]))

    def parts(self, state: Array) -> PartTemperatures:
        """Temperatures of the structure's parts [K]."""
        plane, count = self.plane, self.plane.count
        cold, hot, core = self._mean(state, "cold"), self._mean(state, "hot"), float(state[count])
        if self.sheared:
            end = plane.x[plane.i[plane.cells("layer")] + 1].max()
            cells, widths = shear.columns(plane, "plate", high=end)
            slices = widths @ state[cells]
            depths = plane.dy[cells[0]]
            beside = shear.columns(plane, "plate", low=end)[0][0]
            edge = float(plane.dy[beside] @ state[beside] / np.sum(plane.dy[beside]))
        else:
            cells, heights = shear.columns(plane, "vane")
            slices = np.array([plane.dy[column] @ state[column] / np.sum(plane.dy[column]) for column in cells])[::-1]
            depths = heights[::-1]
            edge = self._mean(state, "plate")
        middle = (np.arange(8) + 0.5) / 8
        at = np.interp(middle, (np.cumsum(depths) - 0.5 * depths) / np.sum(depths), slices)
        return self.joint.parts(core, edge, at, hot, cold)

    def stiffness(self, state: Array) -> float:
        """Size of the joint's dynamic stiffness at the hot point's frequency [N m/rad]."""
        return self.joint.stiffness(state[self.layers], self.shares, self.slices, self.parts(state))

    def far_face(self, state: Array) -> float:
        """Mean temperature of the polymer's face away from the pads [degC], from its last two cells."""
        last, before = (-1, -2) if self.sheared else (0, 1)
        way = self.slices[last] / (self.slices[last] + self.slices[before])
        ends, inner = state[self.layers[:, last]], state[self.layers[:, before]]
        return float(self.shares @ (ends + way * (ends - inner)))

    def heated(self, seconds: float, steps: int = STEPS) -> Switch:
        """Heat the plane for a time."""
        times, states = self.plane.heat(seconds, steps)
        own = self.plane.cells("layer")
        return Switch(
            times,
            np.array([self.stiffness(state) for state in states]),
            states[:, own] @ self.plane.volume[own] / np.sum(self.plane.volume[own]),
            np.array([self.far_face(state) for state in states]),
        )

    def time(self, name: str, switch: Switch) -> float:
        """Return a time of the switch [s]: joint soft, mean of the polymer or its far face warm."""
        if name == "softening_time":
            return passed(switch.times, -np.log(switch.stiffness), -np.log(self.joint.soft))
        return passed(switch.times, switch.of(name), self.known["target_temperature"] - 273.15)


def product_times(model: DeviceFunctions) -> dict[str, float]:
    """Times of the switch by the product [s]; those that come within the simulation's horizon."""
    values = Simulator(model).run(model.start, phases=["softening"]).values
    return {name: values[name] for name in TIMES if np.isfinite(values[name])}


def never(judge: Judge, steps: int) -> Compared:
    """Compare a joint that the product never softens: no difference if the plane does not either."""
    plane = judge.time("softening_time", judge.heated(judge.known["horizon"], steps))
    return Compared(np.inf, plane, np.nan, np.inf)


def compared(model: DeviceFunctions, fine: float = 1.0, steps: int = STEPS) -> dict[str, Compared]:
    """Return each time by the product and by the plane."""
    ours = product_times(model)
    judge = Judge(model, plane_of(model, fine))
    if not ours:
        return {"softening_time": never(judge, steps)}
    longest = max(ours.values())
    switch = judge.heated(LONGER[0] * longest, steps)
    if not np.isfinite(judge.time("softening_time", switch)):
        switch = judge.heated(LONGER[1] * longest, steps)
    soft = judge.time("softening_time", switch)
    # A time early in these steps once more in steps of its own.
    early = judge.heated(1.3 * max(soft, ours["softening_time"]), steps) if soft < EARLY * switch.times[-1] else switch
    times = {}
    for name, time in ours.items():
        seen = early if name == "softening_time" else switch
        plane = judge.time(name, seen)
        warm = seen.of(name)
        at_product, at_plane = np.interp([time, plane], seen.times, warm)
        slope = float(np.interp(plane, seen.times, np.gradient(warm, seen.times)))
        over_rise = float(at_plane - warm[0]) / (plane * slope) if np.isfinite(plane) else np.inf
        times[name] = Compared(time, plane, float(at_plane - at_product), over_rise)
    return times


def studies() -> dict[str, Path]:
    """Return the files of all studies by name: the shipped ones, and those of the tests."""
    files = (path for folder in ("studies", "tests/studies") for path in (ROOT / folder).glob("*.yaml"))
    return {path.stem: path for path in sorted(files, key=lambda path: path.stem)}


def designs(path: Path, work: Path | None) -> Iterator[tuple[str, DeviceFunctions]]:
    """Yield a study's start and, if it varies something, its optimum, run unless it is in the work folder."""
    yield "start", model_of(path)
    if work is None or not read_study(path).vary:
        return
    folder = work / path.stem
    if not (folder / "design.json").exists():
        run = [
            sys.executable,
            "-m",
            "tvimdesign",
            "run",
            path,
            "--no-cad",
            "--no-plots",
            "--overwrite",
            "--out",
            folder,
        ]
        subprocess.run([str(part) for part in run], check=False, stdout=subprocess.DEVNULL)
    yield "optimum", optimum_of(folder)


def rows_of(study: str, design: str, model: DeviceFunctions, steps: int = STEPS) -> Iterator[list[str]]:
    """Return a module's rows of the table."""
    for name, pair in compared(model, steps=steps).items():
        yield [
            study, design, name, f"{pair.product:.2f}", f"{pair.plane:.2f}", f"{pair.difference:+.2f}",
            f"{pair.warmer:+.2f}", f"{pair.over_rise:.2f}",
        ]  # fmt: skip


def main() -> None:
    """Compare the named studies, or all, and put their rows in `results.csv`."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", nargs="*", metavar="STUDY")
    parser.add_argument("--work", type=Path, default=Path("heat_work"))
    options = parser.parse_args()
    for path in (studies()[name] for name in options.studies or studies()):
        rows = []
        for design, model in designs(path, options.work):
            for row in rows_of(path.stem, design, model):
                print(*row, flush=True)
                rows.append(row)
        _put(path.stem, rows)


def _put(study: str, rows: list[list[str]]) -> None:
    """Write a study's rows in place of those it had; those of studies that are no more go."""
    before = list(csv.reader(RESULTS.open()))[1:] if RESULTS.exists() else []
    before = [row for row in before if row[0] in studies()]
    with RESULTS.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        writer.writerows(sorted([row for row in before if row[0] != study] + rows, key=lambda row: row[0]))


if __name__ == "__main__":
    main()
