"""Time of the engine for a study: recording, an evaluation with its gradient, a solve, and steps.

Processor time, in one process; the interpreter is compiled before (once for an installation). Listed numbers are free
between their ends, and nothing is sought beside the one start.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tvimdesign.base.errors import TvimError
from tvimdesign.simulation.working_cycle.device_functions import STRUCTURES
from tvimdesign.solve.nlp.problem_parts import Objective
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import read_study

STUDIES = Path(__file__).resolve().parents[1] / "studies"
USUAL = ("elbow_printed", "wrist_joint", "fast_switch", "wrist_compression")


class Taken(NamedTuple):
    """Seconds of the processor, and what they were for."""

    recorded: float
    """The table's equations written and recorded, up to the first evaluation."""
    evaluated: float
    """Median of some evaluations with all derivatives."""
    solved: float
    iterations: int
    status: str
    unknowns: int
    steps: dict[str, int]


def clocked(do: Callable[[], object]) -> float:
    """Processor time of a call [s]."""
    began = time.process_time()
    do()
    return time.process_time() - began


def measure(name: str, repeats: int) -> Taken:
    """Measure one study."""
    study = read_study(STUDIES / f"{name}.yaml")
    began = time.process_time()
    STRUCTURES.forget()
    optimizer = Optimizer(study)
    problem, parameters = optimizer.problem, optimizer.parameters(Objective(study.minimize))
    x = optimizer.guess(optimizer.model.start)

    def evaluate() -> None:
        problem.forget()
        problem.at(x, parameters)

    problem.place_grids(x, parameters)
    evaluate()
    recorded = time.process_time() - began
    evaluated = float(np.median([clocked(evaluate) for _ in range(repeats)]))
    steps = {phase: len(grid.shares) for phase, grid in problem.grids.items()}
    optimizer.solve()  # builds IPOPT
    began = time.process_time()
    run = optimizer.solve()
    solved = time.process_time() - began
    return Taken(
        recorded, evaluated, solved, run.start.iterations, run.start.status,
        problem.unknown_count, steps,
    )  # fmt: skip


def main() -> None:
    """Print a line for each study."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("studies", nargs="*", default=USUAL, help="names of shipped studies, or `all`")
    parser.add_argument("--repeats", type=int, default=9, help="evaluations, for their median")
    options = parser.parse_args()
    names = sorted(path.stem for path in STUDIES.glob("*.yaml")) if options.studies == ["all"] else options.studies
    print(f"{'study':28}{'unknowns':>9}{'recorded s':>11}{'evaluation ms':>15}{'solve s':>9}  steps")
    measure("wrist_joint", 1)  # loads what is compiled
    for name in names:
        try:
            measured = measure(name, options.repeats)
        except TvimError as error:
            print(f"{name:28}{error}")
            continue
        steps = ", ".join(f"{phase} {count}" for phase, count in measured.steps.items())
        print(
            f"{name:28}{measured.unknowns:>9}{measured.recorded:>11.2f}{1e3 * measured.evaluated:>15.2f}"
            f"{measured.solved:>9.3f}  {steps}; {measured.iterations} iterations, {measured.status}",
            flush=True,
        )


if __name__ == "__main__":
    main()
