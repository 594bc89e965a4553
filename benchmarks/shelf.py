"""A whole shelf searched: the best three of some 50,000 combinations of heater, process, steel, wire and counts.

In both modes, from the study files beside this one, or from others. `--prove` solves every combination as well, which
takes hours here; tests compare shorter lists with enumeration.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from tvimdesign.report.output.choices_tables import tally_in_words
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, read_study

HERE = Path(__file__).resolve().parent
SHELVES = (HERE / "shelf.yaml", HERE / "shelf_compression.yaml")


def searched(study: Study) -> str:
    """Report a study: its status, the time, the best combinations, and the counts of the others."""
    began, busy = time.perf_counter(), time.process_time()
    solution = optimize(study)
    seconds, of_processor = time.perf_counter() - began, time.process_time() - busy
    choosing = solution.choosing
    assert choosing is not None
    lines = [f"{study.name}: {solution.status}, {seconds:.1f} s, {of_processor:.1f} s of the processor"]
    lines += [
        f"  {candidate.objective:.6f}  {', '.join(map(_shown, candidate.choices.values()))}"
        for candidate in choosing.best
    ]
    return "\n".join([*lines, f"  {tally_in_words(choosing)}"])


def _shown(choice: str | float) -> str:
    return choice if isinstance(choice, str) else f"{choice:.5g}"


def main() -> None:
    """Print a few lines for each shelf; with --out write them too."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("studies", type=Path, nargs="*", default=SHELVES, help="studies in place of the two shelves")
    parser.add_argument("--prove", action="store_true", help="solve every combination as well")
    parser.add_argument("--out", type=Path, help="text file to write the lines to")
    options = parser.parse_args()
    reported = []
    for path in options.studies:
        study = read_study(path)
        solver = study.solver.model_copy(update={"prove": options.prove})
        reported.append(searched(study.model_copy(update={"solver": solver})))
        print(reported[-1], flush=True)
    if options.out:
        options.out.write_text("\n".join(reported) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
