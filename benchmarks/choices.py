"""The best combination of listed sizes by branch and bound, by Bonmin, and by solving each, for several goals.

Of the reference problem with wire, coils, springs and arcs listed, and of `standard_parts`, a larger one.

`--each` solves every combination, `--bonmin` runs Bonmin; `--sizes N` keeps every so many sizes of each list that N are
left at most. All begin from the same starts, in one process; times are of the processor.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from bonmin import best_by_bonmin
from reference_problem import study_of_sizes

from tvimdesign.device import table_for
from tvimdesign.solve.discrete.branch_and_bound import BranchAndBound
from tvimdesign.solve.discrete.combinations import every_combination
from tvimdesign.solve.discrete.discrete_choices import discrete_sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Options, Study, read_study

LARGER = Path(__file__).resolve().parents[1] / "validation/fe_structure/studies/standard_parts.yaml"
WEIGHTS = (
    {"envelope_volume": 1.0, "module_mass": 1.0, "response_time": 1.0},
    {"module_mass": 1.0},
    {"envelope_volume": 1.0, "response_time": 4.0},
    {"module_mass": 3.0, "response_time": 1.0},
    {"envelope_volume": 1.0},
    {"envelope_volume": 2.0, "module_mass": 1.0, "switch_energy": 1.0},
    {"module_mass": 1.0, "response_time": 2.0},
)
SAME = 1e-6
"""Share within which two objectives are equal."""


NAMES = {
    "1": "branch and bound, the best",
    "5": "branch and bound, the best 5",
    "bonmin": "Bonmin, B-BB",
    "each": "each of them solved",
}


def fewer(study: Study, most: int) -> Study:
    """Return the study with lists of at most so many sizes."""
    vary = {}
    for name, listed in study.vary.items():
        step = -(-len(listed.values) // most) if isinstance(listed, Options) else 1
        vary[name] = Options(values=listed.values[::step]) if isinstance(listed, Options) else listed
    return study.model_copy(update={"vary": vary})


@dataclass(frozen=True)
class Clocked:
    """Result of one way, the best objectives first."""

    objectives: list[float]
    work: SolverEffort
    seconds: float


def clocked(relaxation: Relaxation, how: str) -> Clocked:
    """Run one way: so many of the best by branch and bound, the best by Bonmin, or each solved."""
    relaxation.work = SolverEffort()
    begin = time.process_time()
    if how == "each":
        runs, _ = every_combination([relaxation], {})
        objectives = sorted(run.start.objective for run in runs.values())
    elif how == "bonmin":
        chosen = best_by_bonmin(relaxation.optimizer.study, relaxation.optimizer.reference)
        return Clocked([chosen.objective], relaxation.work, chosen.seconds)
    else:
        search = BranchAndBound([relaxation], int(how))
        search.run()
        objectives = sorted(run.start.objective for run in search.runs.values())
    return Clocked(objectives, relaxation.work, time.process_time() - begin)


def compare(study: Study, weights: dict[str, float], ways: Sequence[str]) -> str:
    """Compare ways for one set of weights: a line for each, with the last as the reference."""
    weighted = study.model_copy(update={"minimize": weights})
    table = table_for(study.mode)
    sizes = discrete_sizes(weighted, table)
    begin = time.process_time()
    relaxation = Relaxation(0, Optimizer(weighted), {}, sizes, SolverEffort())
    relaxation.starts()
    built = time.process_time() - begin
    results = {how: clocked(relaxation, how) for how in ways}
    best = results[ways[-1]].objectives
    lines = [
        f"minimize {', '.join(f'{name} {weight:g}' for name, weight in weights.items())}: {sizes.count} combinations; "
        f"building and {study.solver.starts} starts took {built:.1f} s"
    ]
    for how, result in results.items():
        runs, iterations = (
            result.work.warm + result.work.cold,
            result.work.warm_iterations + result.work.cold_iterations,
        )
        count = int(how) if how.isdigit() else 1
        pairs = zip(result.objectives[:count], best[:count], strict=False)
        equal = all(abs(a / b - 1.0) <= SAME for a, b in pairs)
        lines.append(
            f"  {NAMES[how]:30}{runs:7} runs{iterations:8} iterations{iterations / max(runs, 1):6.1f} each"
            f"{result.seconds:8.1f} s  {result.objectives[0]:.7f} {'equal' if equal else 'NOT EQUAL'}"
        )
    return "\n".join(lines)


def main() -> None:
    """Print the comparison for every set of weights; with --out write it too."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--study", type=Path, help="study whose lists are searched, in place of both")
    parser.add_argument("--sizes", type=int, default=1000, help="sizes of each list that are kept at most")
    parser.add_argument("--weights", type=int, default=len(WEIGHTS), help="sets of weights that are tried")
    parser.add_argument("--bonmin", action="store_true", help="run Bonmin as well")
    parser.add_argument("--each", action="store_true", help="solve each combination as well")
    parser.add_argument("--out", type=Path, help="text file to write the lines to")
    chosen = parser.parse_args()
    larger = read_study(chosen.study or LARGER)
    studies = [larger] if chosen.study else [study_of_sizes(), larger]
    reported = []
    ways = ["1", *(["bonmin"] if chosen.bonmin else []), *(["5", "each"] if chosen.each else [])]
    for study in studies:
        reported.append(study.name)
        print(reported[-1], flush=True)
        for weights in WEIGHTS[: chosen.weights]:
            reported.append(compare(fewer(study, chosen.sizes), weights, ways))
            print(reported[-1], flush=True)
    if chosen.out:
        chosen.out.write_text("\n".join(reported) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
