"""`plane.py` against finite elements, in the optimum of a study with pads that conduct as usual, badly and well.

    python validation/heat_sector/outside_judge.py --fe-python FE/bin/python --work FOLDER [--study paper_shear]

FE/bin/python has ngsolve. FOLDER holds the runs that `compare.py` made. Writes `outside_judge.csv`.
"""

from __future__ import annotations

import argparse
import csv
import json
import subprocess
from dataclasses import asdict
from pathlib import Path

import numpy as np
import shear
from compare import inputs_of, optimum_of
from plane import passed

HERE = Path(__file__).parent
RESULTS = HERE / "outside_judge.csv"
HEADER = ("study", "pads", "time", "plane [s]", "fe [s]", "difference [%]")
LIMITS = (45.0, 60.0, 80.0, 100.0)
PADS = {"usual": (6.0, 150.0), "badly conducting": (2.0, 500.0), "well conducting": (20.0, 50.0)}
"""Conductivity in their plane [W/m K] and contact of their edges [W/m2 K]."""
STEPS_A_SECOND = 2


def by_plane(case: shear.Case, seconds: float, fine: float = 1.0) -> dict[str, float]:
    """Times at which mean and far face of the layer get to temperatures, by the plane."""
    found = shear.plane(case, fine)
    times, states = found.heat(seconds, round(STEPS_A_SECOND * seconds))
    columns, shares = shear.columns(found, "layer")
    depths = found.dy[columns[0]]
    means = states[:, columns] @ (depths / np.sum(depths)) @ shares
    way = depths[-1] / (depths[-1] + depths[-2])
    ends, before = states[:, columns[:, -1]], states[:, columns[:, -2]]
    faces = (ends + way * (ends - before)) @ shares
    at = {f"mean_{limit:.0f}": passed(times, means, limit) for limit in LIMITS}
    return {**at, "far_100": passed(times, faces, 100.0)}


def by_elements(case: shear.Case, seconds: float, fe_python: Path, at: Path) -> dict[str, float]:
    """The same by finite elements, in an interpreter of their own; one step and half of it, extrapolated."""
    at.write_text(json.dumps({name: float(value) for name, value in asdict(case).items()}))
    found = []
    for step in ("2.0", "1.0"):
        command = [str(fe_python), str(HERE / "fe.py"), str(at), "--seconds", f"{seconds}", "--step", step]
        found.append(json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout))
    coarse, fine = found
    return {name: 2.0 * fine[name] - coarse[name] for name in fine}


def main() -> None:
    """Solve each case both ways and write the results."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fe-python", type=Path, required=True)
    parser.add_argument("--work", type=Path, default=Path("heat_work"))
    parser.add_argument("--study", default="paper_shear")
    asked = parser.parse_args()
    rows = []
    for pads, (conductivity, contact) in PADS.items():
        model = optimum_of(asked.work / asked.study, pad_conductivity=conductivity, pad_edge_contact=contact)
        case = shear.case_of(model.table, inputs_of(model))
        seconds = 1.1 * by_plane(case, 300.0, 0.5)["far_100"]
        plane = by_plane(case, seconds)
        elements = by_elements(case, float(np.ceil(seconds)), asked.fe_python, asked.work / "case.json")
        for name, ours in plane.items():
            fe = elements[name]
            rows.append([asked.study, pads, name, f"{ours:.2f}", f"{fe:.2f}", f"{100.0 * (ours / fe - 1.0):+.2f}"])
            print(*rows[-1], flush=True)
    with RESULTS.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([HEADER, *rows])


if __name__ == "__main__":
    main()
