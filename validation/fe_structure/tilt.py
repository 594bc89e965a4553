"""FE of random modules whose bearing's play leaves the core free to lean; writes tilt.csv.

    PYTHONPATH=benchmarks python validation/fe_structure/tilt.py --fe-python FE/bin/python [--work DIR] STUDY:DRAW ...

draws as drawn.py and fresh.py do, from the seed of either, and solves the joint on elements 2.5 times as large as those
of run.py. `--model` puts today's model beside the same FE. The link is the model's on both sides.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections import defaultdict
from pathlib import Path
from typing import NamedTuple

from drawn import SEED
from fresh import modules
from run import alone, solved_by

from tvimdesign.cad.fe.model_comparison import model_values
from tvimdesign.cad.fe.run_solvers import export_parts
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule

RESULTS = Path(__file__).with_name("tilt.csv")
HEADER = ("study", "seed", "draw", "hub by fe", "tilt by fe", "tilt", "upright", "in play")
COARSER = 2.5


class Compared(NamedTuple):
    """Model over FE: give by tilt, and stiffness at the link's end, the core held upright and free to lean."""

    tilt: float
    upright: float
    in_play: float


def compared(module: ResolvedModule, hub: float, tilt: float) -> Compared:
    """Compare a module with FE of its stiffness at the hub [N*m/rad] and its give by tilt [rad/(N*m)]."""
    model = model_values(module)
    upright = 1.0 / model["hub"] + 1.0 / model["link"]
    free = 1.0 / hub + 1.0 / model["link"] + tilt
    return Compared((1.0 / model["link_in_play"] - upright) / tilt, free / upright, free * model["link_in_play"])


def table_rows() -> list[list[str]]:
    """Return the rows of tilt.csv."""
    with RESULTS.open(newline="") as file:
        return list(csv.reader(file))[1:]


def drawn_modules(rows: list[list[str]]) -> dict[tuple[str, str, str], ResolvedModule]:
    """Return the modules of rows by study, seed and draw."""
    numbers: dict[tuple[str, str], set[int]] = defaultdict(set)
    for study, seed, draw, *_ in rows:
        numbers[study, seed].add(int(draw))
    return {
        (study, seed, str(number)): module
        for (study, seed), wanted in numbers.items()
        for number, _, module in modules(study, int(seed), wanted)
    }


def row_of(place: list[str], module: ResolvedModule, hub: float, tilt: float) -> list[str]:
    """Return a row of tilt.csv."""
    return [*place, f"{hub:.4g}", f"{tilt:.4g}", *(f"{ratio:.3f}" for ratio in compared(module, hub, tilt))]


def main() -> None:
    """Solve the modules named, or put today's model beside what there is."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("modules", nargs="*", metavar="STUDY:DRAW")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--fe-python", type=Path, default=Path(sys.executable))
    parser.add_argument("--work", type=Path, default=Path("fe_work"))
    parser.add_argument("--model", action="store_true", help="put today's model beside the same FE, and solve nothing")
    requested = parser.parse_args()
    fresh = []
    for name in () if requested.model else requested.modules:
        study, _, draw = name.partition(":")
        ((_, design, module),) = modules(study, requested.seed, {int(draw)})
        folder = requested.work.resolve() / f"{study}_{requested.seed}_{draw}"
        if not (folder / "inputs.json").exists():
            export_parts(design, folder)
        joint = solved_by("joint", folder, folder / "joint_fe.json", requested.fe_python, "--coarser", COARSER)
        fresh.append(row_of([study, str(requested.seed), draw], module, joint["hub"], joint["tilt"]))
        print(*fresh[-1], flush=True)
    with alone():
        rows = [*table_rows(), *fresh]
        if requested.model:
            today = drawn_modules(rows)
            rows = [row_of(row[:3], today[row[0], row[1], row[2]], float(row[3]), float(row[4])) for row in rows]
        with RESULTS.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([HEADER, *sorted(rows)])


if __name__ == "__main__":
    main()
