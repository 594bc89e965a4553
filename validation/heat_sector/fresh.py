"""The product's times against two dimensions for random designs, which no figure of the product was calibrated with.

    PYTHONPATH=benchmarks python validation/heat_sector/fresh.py [STUDY ...]

draws designs that keep all rules within the ranges of studies, seeded, heats those that soften within the simulation's
horizon by the product and in the plane, and writes `fresh.csv`, with the interval that the product states of each time.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Collection, Iterator
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from compare import HEADER, STEPS, TIMES, model_of, product_times, rows_of, studies
from random_designs import FRESH, FRESH_SEED, Draws, Tally

from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule
from tvimdesign.solve.uncertainty.design_uncertainty import UncertaintyModel
from tvimdesign.study import given, read_study

RESULTS = Path(__file__).with_name("fresh.csv")
PAST = Path(__file__).parents[1] / "fe_structure/studies"
STATED = ("least [s]", "greatest [s]")
MOST = 40
"""Draws that keep the rules; the first of them that soften are taken."""


class Fresh(NamedTuple):
    """A random design that softens, by its place among those that satisfy the rules."""

    name: str
    model: DeviceFunctions
    module: dict[str, float]
    """What was drawn."""


def path_of(study: str) -> Path:
    """Return the file of a study: shipped, of the tests, or past."""
    return studies().get(study, PAST / f"{study}.yaml")


def designs(study: str, numbers: Collection[int]) -> Iterator[Fresh]:
    """Return the random designs of these numbers that soften; of no numbers, of all that keep today's rules."""
    path = path_of(study)
    read = read_study(path)
    draws = Draws(read, FRESH_SEED)
    for design in (design for _, design in draws.numbered(numbers)) if numbers else draws.keeping_rules(MOST, Tally()):
        drawn = {name: design.values[name] for name in read.vary if name in design.values}
        model = model_of(path, **drawn)
        if "softening_time" in product_times(model):
            yield Fresh(design.name.rpartition(", ")[2], model, drawn)


def intervals(study: str, module: dict[str, float]) -> dict[str, tuple[float, float]]:
    """Return between what the product says that the times of a design lie, over the ranges of assumed values [s]."""
    read = read_study(path_of(study))
    resolved = ResolvedModule(read, {**given(read), **module})
    ranges = UncertaintyModel(resolved, TIMES).at(resolved, 0).intervals
    return {name: (ranges[name].low, ranges[name].high) for name in TIMES}


def fresh_rows(study: str) -> Iterator[list[str]]:
    """Return the rows of a study's random designs; a plane whose steps do not settle takes four times as many."""
    for fresh in islice(designs(study, ()), FRESH[study]):
        stated = intervals(study, fresh.module)
        try:
            rows = list(rows_of(study, fresh.name, fresh.model))
        except RuntimeError as trouble:  # the plane's own steps
            print(f"{study}, {fresh.name}: {trouble}", file=sys.stderr, flush=True)
            rows = list(rows_of(study, fresh.name, fresh.model, 4 * STEPS))
        for row in rows:
            yield [*row, *(f"{end:.2f}" for end in stated[row[2]])]


def main(studies_named: list[str]) -> None:
    """Compare the designs of the studies named, or of all, and put their rows in place of those that stood."""
    for study in studies_named or FRESH:
        fresh = []
        for row in fresh_rows(study):
            print(*row, flush=True)
            fresh.append(row)
        with RESULTS.open(newline="") as file:
            others = [row for row in list(csv.reader(file))[1:] if row[0] != study]
        with RESULTS.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([[*HEADER, *STATED], *others, *fresh])


if __name__ == "__main__":
    main(sys.argv[1:])
