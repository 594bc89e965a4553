"""FE of every study's parts against the model, by one command; writes results.csv and shipped.yaml.

    python validation/fe_structure/run.py --fe-python FE/bin/python [--work FOLDER] [--check] [STUDY ...]

Run it where the package and CadQuery are; FE/bin/python has netgen-mesher, ngsolve and pyyaml. Each study is run, its
parts are exported as STEP, and FE finds the rate of a spring, the stiffness of the joint and of its parts, and
stresses. Of a study with a front or a comparison, its own optimum. What is in the work folder already is not made
again. Without a name: all studies that ship. A study that fails keeps its rows; the command then ends with 1. With
`--check` the table is only compared with the results.

With `--model` nothing is solved: the model's column is written again, of the designs in the table, and the table
of README.md is printed.

Several of these commands may run at once, on studies of their own: each holds a lock while it reads both files, puts a
study's rows in and writes them again.
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import fcntl
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml
from models import DESIGN, FOLDERS, LEFT_OUT, Row, case_of, design_rows, designed, fe_values, model_values, study_file

from tvimdesign.cad.fe.run_solvers import SOLVERS, export_parts
from tvimdesign.study.design import read_design

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RESULTS, CASES = HERE / "results.csv", HERE / "shipped.yaml"
LONGEST = 1800.0
"""Time [s] after which a step is given up."""
SAME = 0.02
"""Share by which FE's figures scatter as a mesh is made anew, but for highest stresses at a corner."""
HEADER = ("study", "quantity", "unit", "model", "fe", "ratio")


def done(command: list[object], into: Path) -> None:
    """Run a command and keep what it prints; nothing is run where that is there already."""
    if into.exists():
        return
    print(*command, file=sys.stderr, flush=True)
    paths = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    alone = {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONPATH": paths}
    requested = [str(part) for part in command]
    results = subprocess.run(
        requested, check=True, stdout=subprocess.PIPE, text=True, timeout=LONGEST, env=alone
    ).stdout
    into.write_text(results)


def solved(study: str, work: Path, fe_python: Path) -> tuple[dict[str, float], dict[str, Any]]:
    """Run a study, export its parts and return what FE finds, by name, and its case of shipped.yaml."""
    folder, parts = work / study / "run", work / study / "parts"
    folder.parent.mkdir(parents=True, exist_ok=True)
    run = [sys.executable, "-m", "tvimdesign", "run", study_file(study), "--no-cad", "--no-plots", "--out", folder]
    done(run, work / study / "run.txt")  # it ends with 1 where nothing meets the study: then there is no design
    if not (parts / "inputs.json").exists():
        export_parts(read_design(folder / "design.json"), parts)
    joint, spring = (solved_by(name, parts, work / study / f"{name}.json", fe_python) for name in ("joint", "spring"))
    inputs = json.loads((parts / "inputs.json").read_text())
    return fe_values(joint, spring), case_of(study, inputs, varied_of(study, work), joint)


def varied_of(study: str, work: Path) -> dict[str, float | str]:
    """Values and records of what a study varies, of the design that was exported."""
    return {row.quantity: row.model for row in design_of(study, work)}


def design_of(study: str, work: Path) -> list[Row]:
    """Rows of the design that was exported."""
    design = json.loads((work / study / "run/design.json").read_text())
    return design_rows(study, design["values"], design["choices"])


def solved_by(solver: str, parts: Path, results: Path, fe_python: Path, *options: object) -> dict[str, float]:
    """Solve some parts; the mesher reports holes of its mesh on standard output."""
    printed = results.with_suffix(".txt")
    done([fe_python, SOLVERS / f"{solver}.py", parts, results, *options], printed)
    if "NOT ALL FACES" in printed.read_text():
        raise ValueError(f"{printed}: faces without a mesh")
    rows: dict[str, float] = json.loads(results.read_text())
    return rows


def rows_of(study: str, work: Path, fe_python: Path) -> tuple[list[Row], dict[str, Any]]:
    """Return a study's design with values of model and FE, and its case of shipped.yaml."""
    fe, case = solved(study, work, fe_python)
    design = design_of(study, work)
    results = [
        Row(study, name, unit, value, fe[name])
        for name, (unit, value) in model_values(study, varied_of(study, work)).items()
        if name in fe
    ]
    return [*design, *results], case


def main() -> None:
    """Solve what is asked for and put its rows in place of those that stood in results.csv."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", nargs="*", metavar="STUDY")
    parser.add_argument("--fe-python", type=Path, default=Path(sys.executable))
    parser.add_argument("--work", type=Path, default=Path("fe_work"))
    parser.add_argument("--check", action="store_true", help="compare the results with the table, and write nothing")
    parser.add_argument("--model", action="store_true", help="write the model's values again, and solve nothing")
    requested = parser.parse_args()
    if requested.model:
        report_model()
        print(*worst_first(), sep="\n")
        return
    failed = []
    every = {path.stem for folder in FOLDERS for path in folder.glob("*.yaml")} - LEFT_OUT
    for study in requested.studies or sorted(every):
        try:
            rows, case = rows_of(study, requested.work.resolve(), requested.fe_python)
            failed += [f"{study}: {line}" for line in differing(study, rows)] if requested.check else []
            if not requested.check:
                put(study, rows, case)
        except (subprocess.SubprocessError, OSError, ValueError) as trouble:
            failed.append(f"{study}: {trouble}")
    if failed:
        sys.exit("\n".join(failed))


def report_model() -> None:
    """Put what today's model says of the designs in results.csv in place of what it said, beside the same FE."""
    with alone():
        with RESULTS.open(newline="") as file:
            rows = list(csv.DictReader(file))
        stored = {}
        for study in {row["study"] for row in rows}:
            own = [row for row in rows if row["study"] == study and row["unit"] in DESIGN]
            varied = {row["quantity"]: designed(row["model"], row["unit"]) for row in own}
            stored |= {(study, name): value for name, (_, value) in model_values(study, varied).items()}
        fresh = [
            Row(
                row["study"], row["quantity"], row["unit"], stored[row["study"], row["quantity"]], float(row["fe"])
            ).cells()
            if row["fe"]
            else [row[name] for name in HEADER]
            for row in rows
        ]
        write(fresh)


def worst_first() -> list[str]:
    """Rows of the table in README.md: what model over FE is, the quantity that is farthest off first."""
    with RESULTS.open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["ratio"]]
    results = []
    for name in {row["quantity"] for row in rows}:
        ratios = sorted((float(row["ratio"]), row["study"]) for row in rows if row["quantity"] == name)
        off, study = max((abs(ratio - 1.0), study) for ratio, study in ratios)
        words = f"| {name} | {ratios[0][0]:.3f} to {ratios[-1][0]:.3f} | `{study}` | {len(ratios)} |"
        results.append((off, words))
    return [words for _, words in sorted(results, reverse=True)]


def write(rows: list[list[str]]) -> None:
    """Put rows into results.csv, sorted."""
    with RESULTS.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([HEADER, *sorted(rows)])


def differing(study: str, fresh: list[Row]) -> list[str]:
    """Return results of FE on today's parts that differ from the table by more than `SAME`."""
    with RESULTS.open(newline="") as file:
        selected = {row["quantity"]: row["fe"] for row in csv.DictReader(file) if row["study"] == study and row["fe"]}
    results = {row.quantity: row.fe for row in fresh if row.fe is not None}
    return [
        f"{name} is {results.get(name)}, in the table {value}"
        for name, value in selected.items()
        if name not in results or abs(results[name] / float(value) - 1.0) > SAME
    ]


def put(study: str, fresh: list[Row], case: dict[str, Any]) -> None:
    """Put a study's rows and case in place of those that stood in results.csv and shipped.yaml."""
    with alone():
        cases = yaml.safe_load(CASES.read_text()) if CASES.exists() else {}
        CASES.write_text(yaml.safe_dump({**cases, study: case}, width=160, default_flow_style=None))
        with RESULTS.open(newline="") as file:
            selected = [row for row in list(csv.reader(file))[1:] if row[0] != study]
        write([*selected, *(row.cells() for row in fresh)])


@contextlib.contextmanager
def alone() -> Iterator[None]:
    """No other process that asks for this goes on meanwhile: the folder is locked."""
    folder = os.open(HERE, os.O_RDONLY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX)
        yield
    finally:
        os.close(folder)


if __name__ == "__main__":
    main()
