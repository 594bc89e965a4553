"""The best combination of listed sizes by branch and bound and by solving every one, for several sets of weights.

Both solve the same problem warm, from the same starts, in one process; times are of the processor. The enumeration
takes minutes; `--sizes N` keeps every so many sizes of each list that N are left at most.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.solve.branch import BranchAndBound
from tvimdesign.solve.enumeration import enumerate_all
from tvimdesign.solve.listed import listed_sizes
from tvimdesign.solve.optimizer import Optimizer
from tvimdesign.solve.solution import Work
from tvimdesign.solve.tree import Tree
from tvimdesign.study import Options, Study, read_study

STUDY = Path(__file__).resolve().parents[1] / "studies/standard_parts.yaml"
WEIGHTS = (
    {"envelope_volume": 1.0, "module_mass": 1.0, "response_time": 1.0},
    {"module_mass": 1.0},
    {"envelope_volume": 1.0, "response_time": 4.0},
    {"module_mass": 3.0, "response_time": 1.0},
)
SAME = 1e-6
"""Share within which two objectives are equal."""


def fewer(study: Study, most: int) -> Study:
    """The study with lists of at most so many sizes."""
    vary = {}
    for name, listed in study.vary.items():
        step = -(-len(listed.values) // most) if isinstance(listed, Options) else 1
        vary[name] = Options(values=listed.values[::step]) if isinstance(listed, Options) else listed
    return study.model_copy(update={"vary": vary})


def clocked(tree: Tree, how: str) -> tuple[list[float], Work, float]:
    """The best objectives found, the work that took, and the seconds."""
    tree.work = Work()
    begin = time.process_time()
    if how == "all":
        runs = list(enumerate_all(tree).values())
    else:
        search = BranchAndBound([tree], int(how))
        search.run()
        runs = list(search.found.values())
    seconds = time.process_time() - begin
    return sorted(run.start.objective for run in runs), tree.work, seconds


def compare(study: Study, weights: dict[str, float]) -> str:
    """One set of weights: a line for branch and bound to the best, to the best five, and for the enumeration."""
    asked = study.model_copy(update={"minimize": weights})
    table = table_for(study.mode)
    sizes = listed_sizes(asked, table)
    begin = time.process_time()
    tree = Tree(0, Optimizer(asked, Catalog(), table), {}, sizes, Work())
    tree.starts()
    built = time.process_time() - begin
    results = {how: clocked(tree, how) for how in ("all", "1", "5")}
    every, all_work, all_seconds = results["all"]
    lines = [
        f"minimize {', '.join(f'{name} {weight:g}' for name, weight in weights.items())}: {sizes.count} combinations, "
        f"{len(every)} of them have a design; building and {study.solver.starts} starts took {built:.1f} s"
    ]
    for how, name in (("1", "branch and bound, the best"), ("5", "branch and bound, the best 5"), ("all", "every one")):
        found, work, seconds = results[how]
        runs, iterations = work.warm + work.cold, work.warm_iterations + work.cold_iterations
        count = 1 if how == "all" else int(how)
        equal = all(abs(a / b - 1.0) <= SAME for a, b in zip(found[:count], every[:count], strict=True))
        lines.append(
            f"  {name:30}{runs:7} runs{iterations:8} iterations{iterations / max(runs, 1):6.1f} each{seconds:8.1f} s"
            f"{(all_work.warm + all_work.cold) / max(runs, 1):8.0f} times fewer runs"
            f"{all_seconds / seconds:7.0f} times faster  {'equal' if equal else 'NOT EQUAL'}"
        )
    return "\n".join(lines)


def main() -> None:
    """Print the comparison for every set of weights; with --out write it too."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--study", type=Path, default=STUDY, help="study whose lists are searched")
    parser.add_argument("--sizes", type=int, default=1000, help="sizes of each list that are kept at most")
    parser.add_argument("--weights", type=int, default=len(WEIGHTS), help="sets of weights that are tried")
    parser.add_argument("--out", type=Path, help="text file to write the lines to")
    chosen = parser.parse_args()
    study = fewer(read_study(chosen.study), chosen.sizes)
    told = []
    for weights in WEIGHTS[: chosen.weights]:
        told.append(compare(study, weights))
        print(told[-1], flush=True)
    if chosen.out:
        chosen.out.write_text("\n".join(told) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
