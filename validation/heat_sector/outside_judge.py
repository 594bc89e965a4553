"""`plane.py` against finite elements: whole times of a switch, by temperatures of either, judged alike.

    python validation/heat_sector/outside_judge.py --fe-python FE/bin/python --work FOLDER [CASE ...]

FE/bin/python has ngsolve. FOLDER holds the runs that `compare.py` made. Writes `outside_judge.csv`, the rows of the
named cases or of all.
"""

from __future__ import annotations

import argparse
import csv
import json
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

import compression
import numpy as np
import shear
from compare import TIMES, Judge, Switch, inputs_of, model_of, optimum_of, plane_of, studies

from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions

HERE = Path(__file__).parent
RESULTS = HERE / "outside_judge.csv"
HEADER = ("case", "study", "design", "pads", "time", "plane [s]", "fe [s]", "difference [%]", "warmer by [K]")
PADS = {"usual": (6.0, 150.0), "badly conducting": (2.0, 500.0), "well conducting": (20.0, 50.0)}
"""Conductivity in their plane [W/m K] and contact of their edges [W/m2 K], of the shear module."""
PLANE_STEPS, ELEMENT_STEPS = 250, 80


class Held(NamedTuple):
    """A module that both heat, and for how long."""

    study: str
    design: str
    seconds: float
    pads: str = "usual"

    def model(self, work: Path) -> DeviceFunctions:
        """Return the module."""
        changes = {}
        if self.pads != "usual":
            changes = dict(zip(("pad_conductivity", "pad_edge_contact"), PADS[self.pads], strict=True))
        if self.design == "start":
            return model_of(studies()[self.study], **changes)
        return optimum_of(work / self.study, **changes)


CASES = {
    "paper_shear": Held("paper_shear", "start", 250.0),
    "paper_shear_optimum": Held("paper_shear", "optimum", 130.0),
    "paper_shear_bad_pads": Held("paper_shear", "optimum", 150.0, "badly conducting"),
    "paper_shear_good_pads": Held("paper_shear", "optimum", 130.0, "well conducting"),
    "elbow_machined_optimum": Held("elbow_machined", "optimum", 130.0),
    "paper_compression": Held("paper_compression", "start", 580.0),
    "machined_compression": Held("machined_compression", "start", 3100.0),
    "machined_compression_optimum": Held("machined_compression", "optimum", 1600.0),
}


def polymer_of(values: Mapping[str, Any], melting: Any) -> dict[str, float]:
    """Return the polymer for `fe.py`."""
    names = ("specific_heat_solid", "specific_heat_melt", "latent_heat")
    return {
        "density": values["pcl_density"], "start": melting.start - 273.15, "end": melting.end - 273.15,
        **{f"conductivity_{phase}": values[f"pcl_conductivity_{phase}"] for phase in ("solid", "melt")},
        **{name: getattr(melting, name) for name in names},
    }  # fmt: skip


def ring_of(model: DeviceFunctions, values: Mapping[str, Any]) -> dict[str, float]:
    """Numbers of a compression module's ring, for `fe_drawings.ring`."""
    outputs = model.table.evaluate(values, compression.WANTED)
    core, around, sink = (outputs.pop(name) for name in ("core_and_link", "around_pads", "sink"))
    numbers = {name: value for name, value in {**values, **outputs}.items() if isinstance(value, int | float)}
    bodies = {"core_capacity": core.capacity, "core_conductance": core.conductance,
              "housing_surface": around[-1].surface.area}  # fmt: skip
    sunk = {"sink_contact": 0.0}
    if sink is not None:
        sunk = {"sink_contact": values["sink_contact"], "sink_capacity": sink.capacity,
                "sink_surface": sink.surface.area, "sink_coefficient": sink.surface.coefficient,
                "sink_emissivity": sink.surface.emissivity}  # fmt: skip
    own = {
        "ambient": values["ambient_temperature"] - 273.15, "pad_conductivity": compression.PAD_CONDUCTIVITY,
        "cold_coefficient": values["cold_side_coefficient"], "melting_end": outputs["pcl_melting"].end - 273.15,
    }  # fmt: skip
    return {**numbers, **bodies, **sunk, **own}


def case_of(model: DeviceFunctions, places: tuple[Any, Any]) -> dict[str, Any]:
    """Return a module as `fe.py` reads it: its numbers, and places whose temperatures it reports."""
    values = inputs_of(model)
    melting = model.table.evaluate(values, ["pcl_melting"])["pcl_melting"]
    sheared = "arc_span" in values
    numbers = asdict(shear.case_of(model.table, values)) if sheared else ring_of(model, values)
    return {
        "drawing": "strip" if sheared else "ring", "polymer": polymer_of(values, melting), "numbers": numbers,
        "places": [list(map(float, place)) for place in places],
    }  # fmt: skip


def by_elements(case: dict[str, Any], held: Held, python: Path, folder: Path, fine: float, steps: int) -> Any:
    """Times and temperatures by finite elements."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "case.json").write_text(json.dumps(case), encoding="utf-8")
    out = folder / f"states_{fine:g}_{steps}.npz"
    if not out.exists():
        run = [python, HERE / "fe.py", folder / "case.json", "--out", out, "--seconds", held.seconds,
               "--fine", fine, "--steps", steps]  # fmt: skip
        subprocess.run([str(part) for part in run], check=True)
    arrays = np.load(out)
    return arrays["times"], arrays["states"]


def switch_of(judge: Judge, times: Any, states: Any) -> Switch:
    """Evaluate the joint at temperatures of the plane's cells."""
    own = judge.plane.cells("layer")
    volume = judge.plane.volume[own]
    return Switch(
        times,
        np.array([judge.stiffness(state) for state in states]),
        states[:, own] @ volume / np.sum(volume),
        np.array([judge.far_face(state) for state in states]),
    )


def compared(held: Held, model: DeviceFunctions, elements: Any) -> Iterator[tuple[str, float, float, float]]:
    """Return each time that both plane and elements reach, and how much warmer the plane is at the elements' time."""
    judge = Judge(model, plane_of(model))
    plane = judge.heated(held.seconds, PLANE_STEPS)
    theirs = switch_of(judge, *elements)
    for name in TIMES:
        ours, other = judge.time(name, plane), judge.time(name, theirs)
        if np.isfinite(ours) and np.isfinite(other):
            warm = [float(np.interp(other, history.times, history.of(name))) for history in (plane, theirs)]
            yield name, ours, other, warm[0] - warm[1]


def main() -> None:
    """Solve each case both ways and write the results."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE")
    parser.add_argument("--fe-python", type=Path, required=True)
    parser.add_argument("--work", type=Path, default=Path("heat_work"))
    parser.add_argument("--fine", type=float, default=1.0)
    parser.add_argument("--steps", type=int, default=ELEMENT_STEPS)
    parser.add_argument("--tell", action="store_true", help="print the rows only")
    options = parser.parse_args()
    for name in options.cases or CASES:
        held = CASES[name]
        model = held.model(options.work)
        drawing = plane_of(model)
        folder = options.work / "elements" / name
        by_fe = by_elements(
            case_of(model, drawing.middle), held, options.fe_python, folder, options.fine, options.steps
        )
        rows = [[name, held.study, held.design, held.pads, time, f"{ours:.2f}", f"{fe:.2f}",
                 f"{100.0 * (ours / fe - 1.0):+.2f}", f"{warmer:+.2f}"]
                for time, ours, fe, warmer in compared(held, model, by_fe)]  # fmt: skip
        for row in rows:
            print(*row, flush=True)
        if not options.tell:
            _put(name, rows)


def _put(case: str, rows: list[list[str]]) -> None:
    """Write a case's rows in place of those it had."""
    rows_before = list(csv.reader(RESULTS.open()))[1:] if RESULTS.exists() else []
    rows_before = [row for row in rows_before if row[0] in CASES and row[0] != case] + rows
    with RESULTS.open("w", newline="") as file:
        order = list(CASES)
        csv.writer(file, lineterminator="\n").writerows(
            [HEADER, *sorted(rows_before, key=lambda row: order.index(row[0]))]
        )


if __name__ == "__main__":
    main()
