"""The product's times against two dimensions for random designs, which no figure of the product was calibrated with.

    PYTHONPATH=benchmarks python validation/heat_sector/fresh.py [STUDY ...]

draws designs that keep all rules within the ranges of studies, seeded, heats those that soften within the simulation's
horizon by the product and in the plane, and writes `fresh.csv`.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator
from pathlib import Path

from compare import HEADER, model_of, product_times, rows_of, studies
from random_designs import FRESH, FRESH_SEED, Draws, Tally

from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import read_study

RESULTS = Path(__file__).with_name("fresh.csv")
MOST = 40
"""Draws that keep the rules, of which the first that soften are taken."""


def designs(study: str, count: int) -> Iterator[tuple[str, DeviceFunctions]]:
    """Return the first random designs that soften, by their place among those that satisfy the rules."""
    path = studies()[study]
    read, found = read_study(path), 0
    for place, design in enumerate(Draws(read, FRESH_SEED).keeping_rules(MOST, Tally())):
        model = model_of(path, **{name: design.values[name] for name in read.vary if name in design.values})
        if "softening_time" in product_times(model):
            yield f"draw {place}", model
            found += 1
        if found == count:
            return


def main(studies_named: list[str]) -> None:
    """Compare the designs of the studies named, or of all, and put their rows in place of those that stood."""
    for study in studies_named or FRESH:
        fresh = []
        for name, model in designs(study, FRESH[study]):
            try:
                for row in rows_of(study, name, model):
                    print(*row, flush=True)
                    fresh.append(row)
            except RuntimeError as trouble:  # the plane's own steps
                print(f"{study}, {name}: {trouble}", file=sys.stderr, flush=True)
        with RESULTS.open(newline="") as file:
            others = [row for row in list(csv.reader(file))[1:] if row[0] != study]
        with RESULTS.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([HEADER, *others, *fresh])


if __name__ == "__main__":
    main(sys.argv[1:])
