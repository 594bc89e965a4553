"""FE of random modules that coefficients of the structure are fitted to; adds them to drawn.yaml.

    PYTHONPATH=benchmarks python validation/fe_structure/drawn.py --fe-python FE/bin/python [--work FOLDER] [STUDY ...]

draws as fresh.py does, from another seed, and solves the joint alone. What drawn.yaml has is not solved again; a
module without a mesh is left out.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path
from typing import Any

import yaml
from fresh import COARSER, fresh_modules
from models import case_of
from run import alone, solved_by

from tvimdesign.cad.fe.run_solvers import export_parts
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.study.design import Design

CASES = Path(__file__).with_name("drawn.yaml")
SEED = 7
COUNTS = {
    "wrist_joint_own_pins": 11, "finger_of_stock_springs": 8, "elbow_machined_own_pins": 3, "elbow_of_polycarbonate": 3,
    "driven_joint": 2, "paper_shear": 2, "ankle_own_pins": 3, "machined_compression": 12,
    "wrist_compression_own_pins": 26, "compare_compression": 8,
}  # fmt: skip
"""Modules drawn within the ranges of each study."""


def in_turn(studies: list[str]) -> Iterator[tuple[str, str, Design, ResolvedModule]]:
    """Return name, study, design and module of each draw, one of each study after another."""
    drawn = [
        [(f"{study}_{SEED}_{number}", study, *each) for number, *each in fresh_modules(study, SEED, COUNTS[study])]
        for study in studies
    ]
    return (each for of_studies in zip_longest(*drawn) for each in of_studies if each)


def case(study: str, design: Design, module: ResolvedModule, folder: Path, fe_python: Path) -> dict[str, Any]:
    """Export a module's parts, solve its joint and return its case of drawn.yaml."""
    if not (folder / "inputs.json").exists():
        export_parts(design, folder)
    joint = solved_by("joint", folder, folder / "joint_fe.json", fe_python, "--coarser", COARSER)
    varied = {quantity: module.values[quantity] for quantity in module.study.vary}
    return case_of(study, json.loads((folder / "inputs.json").read_text()), varied, joint)


def main() -> None:
    """Solve the modules of the studies named that drawn.yaml has not."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", nargs="*", metavar="STUDY", default=list(COUNTS))
    parser.add_argument("--fe-python", type=Path, default=Path(sys.executable))
    parser.add_argument("--work", type=Path, default=Path("fe_work"))
    requested = parser.parse_args()
    solved = yaml.safe_load(CASES.read_text())
    for name, study, design, module in in_turn(requested.studies):
        if name in solved:
            continue
        try:
            fresh = case(study, design, module, requested.work.resolve() / name, requested.fe_python)
        except (subprocess.SubprocessError, ValueError) as trouble:
            print(f"{name}: {trouble}", file=sys.stderr, flush=True)
            continue
        with alone():
            cases = yaml.safe_load(CASES.read_text())
            CASES.write_text(yaml.safe_dump({**cases, name: fresh}, width=160, default_flow_style=None))
        print(name, fresh["found"]["hub"], flush=True)


if __name__ == "__main__":
    main()
