"""FE of random modules, which nobody optimized and no figure of the product was fitted to; writes fresh.csv.

    PYTHONPATH=benchmarks python validation/fe_structure/fresh.py --fe-python FE/bin/python [--work FOLDER] [STUDY ...]

draws designs that keep all rules within the ranges of studies, seeded, exports their parts, and solves joint and link
on elements 1.6 times as large as those of run.py. What fresh.csv has is not solved again. Studies of another
command may run at once.
"""

from __future__ import annotations

import argparse
import csv
import subprocess
import sys
from collections.abc import Collection, Iterator
from itertools import islice
from pathlib import Path

from models import study_file
from random_designs import FRESH_BY_FE, FRESH_SEED, Draws, Tally
from run import alone, solved_by

from tvimdesign.cad.fe import model_comparison as comparison
from tvimdesign.cad.fe.run_solvers import export_parts
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.study import given, read_study
from tvimdesign.study.design import Design

RESULTS = Path(__file__).with_name("fresh.csv")
HEADER = ("study", "draw", "quantity", "model", "fe", "ratio")
COARSER = 1.6
AT_POINTS = ("storage_modulus@cold", "pcl_stiffness@cold", "spring_stiffness", "moving_inertia", "rotor_inertia")
"""Quantities that FE needs beside the quantities that follow from the inputs alone."""
NAMES = ("hub", "link", "core", "plate", "floor", "rotor_vanes_and_plate", "housing_vanes_and_floor", "core_stress",
         "plate_stress", "edge_traction", "seat_traction")  # fmt: skip


def modules(study: str, seed: int, numbers: Collection[int]) -> Iterator[tuple[int, Design, ResolvedModule]]:
    """Return random designs of a study by their numbers, with what FE needs, each as a module too."""
    read = read_study(study_file(study))
    for number, design in Draws(read, seed).numbered(numbers):
        varied = {name: design.values[name] for name in read.vary if name in design.values}
        module = ResolvedModule(read, {**given(read), **varied})
        at_points = module.table.evaluate(module.values, AT_POINTS)
        design.values.update({name: float(value) for name, value in at_points.items()})
        yield number, design, module


def fresh_modules(study: str, seed: int, count: int) -> Iterator[tuple[int, Design, ResolvedModule]]:
    """Return the first random designs of a study that keep today's rules."""
    first = Draws(read_study(study_file(study)), seed).keeping_rules(count, Tally())
    return modules(study, seed, {int(design.name.rpartition(" ")[2]) for design in first})


def rows_of(study: str, work: Path, fe_python: Path, solved: set[str]) -> Iterator[list[str]]:
    """Solve random designs until there are `FRESH_BY_FE`; a design without a mesh gives a row without values."""
    every = fresh_modules(study, FRESH_SEED, FRESH_BY_FE[study])
    unsolved = (each for each in every if str(each[0]) not in solved)
    for place, design, module in islice(unsolved, max(FRESH_BY_FE[study] - len(solved), 0)):
        folder = work / f"{study}_{place}"
        if not (folder / "inputs.json").exists():
            export_parts(design, folder)
        try:
            joint, link = (
                solved_by(name, folder, folder / f"{name}_fe.json", fe_python, "--coarser", COARSER)
                for name in ("joint", "link")
            )
        except (subprocess.SubprocessError, ValueError) as trouble:
            print(f"{study} {place}: {trouble}", file=sys.stderr, flush=True)
            yield [study, str(place), "no mesh", "", "", ""]
            continue
        model, fe = comparison.model_values(module), {**comparison.joint_rows(joint), "link": link["link"]}
        for name in NAMES:
            if name in fe and name in model:
                yield [study, str(place), name, *compared(model[name], fe[name])]


def compared(model: float, fe: float) -> tuple[str, str, str]:
    """Return cells of the model's value, that of FE, and their ratio."""
    return f"{model:.4g}", f"{fe:.4g}", f"{model / fe:.3f}"


def with_model(study: str, rows: list[list[str]]) -> list[list[str]]:
    """Return rows of a study with today's model beside the same FE."""
    numbers = {int(row[1]) for row in rows}
    models = {str(place): comparison.model_values(module) for place, _, module in modules(study, FRESH_SEED, numbers)}
    return [
        [study, place, name, *compared(models[place][name], float(fe))]
        if fe
        else [study, place, name, model, fe, ratio]
        for _, place, name, model, fe, ratio in rows
    ]


def main() -> None:
    """Solve the designs of the studies named that fresh.csv has not."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", nargs="*", metavar="STUDY", default=list(FRESH_BY_FE))
    parser.add_argument("--fe-python", type=Path, default=Path(sys.executable))
    parser.add_argument("--work", type=Path, default=Path("fe_work"))
    parser.add_argument("--model", action="store_true", help="put today's model beside the same FE, and solve nothing")
    requested = parser.parse_args()
    for study in requested.studies:
        solved = {row[1] for row in table_rows() if row[0] == study}
        fresh = []
        for row in () if requested.model else rows_of(study, requested.work.resolve(), requested.fe_python, solved):
            print(*row, flush=True)
            fresh.append(row)
        with alone():
            rows = [*table_rows(), *fresh]
            if requested.model:
                today = with_model(study, [row for row in rows if row[0] == study])
                rows = [*(row for row in rows if row[0] != study), *today]
            with RESULTS.open("w", newline="") as file:
                csv.writer(file, lineterminator="\n").writerows([HEADER, *sorted(rows)])


def table_rows() -> list[list[str]]:
    """Return the rows of fresh.csv."""
    with RESULTS.open(newline="") as file:
        return list(csv.reader(file))[1:]


if __name__ == "__main__":
    main()
