"""How often a fit's interval of 95 % holds the value the data were made with: every kind, many seeds of noise.

`python benchmarks/fit_coverage.py [SEEDS] [KIND...]` prints, for each parameter of each kind, in how many seeds of 100
(or SEEDS) the interval held the truth. Data are the product's own equations with normal noise: `made_measurements`.
"""

from __future__ import annotations

import sys
import time

import numpy as np
from made_measurements import MADE

from tvimdesign.simulation.measurement.kind_sheet import kind_sheet
from tvimdesign.simulation.measurement.measure_files import measure_of


def held(kind: str, seed: int) -> dict[str, bool]:
    """Whether the interval of each parameter holds what the data of a seed were made with."""
    blocks, given, truth = MADE[kind](np.random.default_rng(seed))
    fit = measure_of(kind_sheet(kind))(blocks, kind_sheet(kind).values(given)).fit
    found = {one.name: one for one in (*fit.parameters, *fit.derived)}
    inside = {}
    for name, value in truth.items():
        low, high = found[name].low, found[name].high
        inside[name] = (low is None or low <= value) and (high is None or value <= high)
    return inside


def main() -> None:
    """Print the table."""
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    for kind in sys.argv[2:] or MADE:
        begin = time.perf_counter()
        counts: dict[str, int] = {}
        for seed in range(seeds):
            for name, inside in held(kind, seed).items():
                counts[name] = counts.get(name, 0) + inside
        told = ", ".join(f"{name} {count}" for name, count in counts.items())
        print(f"{kind} of {seeds}: {told} ({(time.perf_counter() - begin) / seeds:.2f} s a fit)", flush=True)


if __name__ == "__main__":
    main()
