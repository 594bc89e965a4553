"""One optimum by tvimdesign and by what people would write instead, side by side in one run.

Every contender gets the study `reference.yaml`: eight variables, its requirements and the machine's limits, the sum of
envelope volume, mass and response time, each over its value at the start. All are given the same compiled equations
and the same starts, and stop where they think they are done; a row counts as right where its objective, with its time
simulated at 1e-9, is within 1e-4 of tvimdesign's and no limit is violated by more than 1e-4. Those that solve symbols
(tvimdesign, AeroSandbox) pay for building them; those that call numbers get theirs compiled, for nothing. The ways
themselves are in `contenders.py`. Random starts are modules: points at which there is none, or whose switch never ends,
are passed over for all alike.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import time
import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median

import numpy as np
from contenders import CONTENDERS, Contender, End, lsoda
from numpy.typing import NDArray
from reference_problem import Reference, study

Array = NDArray[np.float64]
TOLERANCE = 1e-4
"""Share by which an objective may be off, and of its scale by which a limit may be violated, in a row that is right."""
QUICK, AGAIN = 2.0, 5
"""Seconds under which a row is timed so many times more, for the median."""


@dataclass
class Row:
    """Result of a contender."""

    name: str
    seconds: float
    """Processor time from the study's own start."""
    evaluations: int
    apart: float
    """Objective over tvimdesign's, less one."""
    broken: float
    """Worst residual."""
    right: int
    """Random starts from which it came to an optimum as good."""
    starts: int


def exact(reference: Reference, design: Array) -> tuple[float, float]:
    """Objective and worst residual of a design, its switch simulated at 1e-9."""
    rows = reference.rows(design, lsoda(1e-9)(reference, design))
    return float(rows[0]), float(np.max(rows[1:]))


def timed(reference: Reference, contender: Contender) -> tuple[End, float]:
    """Return a contender's result from the study's own start, and its processor time [s]."""
    begin = time.process_time()
    end = contender.solve(reference, reference.begin)
    return end, time.process_time() - begin


def judged(reference: Reference, contender: Contender, best: float | None) -> tuple[Row, float]:
    """Run a contender from the study's start, timed, then from random ones."""
    contender.prepare(reference)
    end, seconds = timed(reference, contender)
    if seconds < QUICK:
        seconds = median(timed(reference, contender)[1] for _ in range(AGAIN))
    objective, broken = exact(reference, end.design)
    best = objective if best is None else best
    right = 0
    for start in reference.random_starts(contender.starts):
        with contextlib.suppress(Exception):  # a contender that gives up has not found it
            value, worst = exact(reference, contender.solve(reference, start).design)
            right += abs(value / best - 1.0) <= TOLERANCE and worst <= TOLERANCE
    return Row(contender.name, seconds, end.evaluations, objective / best - 1.0, broken, right, contender.starts), best


def table(rows: list[Row]) -> str:
    """Return the rows as Markdown."""
    lines = [
        "| contender | times tvimdesign | evaluations | objective off by | worst limit | random starts right |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        lines.append(
            f"| {row.name} | {row.seconds / rows[0].seconds:.3g} | {row.evaluations} | {row.apart:.1e} | "
            f"{max(row.broken, 0.0):.0e} | {row.right} of {row.starts} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Print the comparison; with --out write it too."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--starts", type=int, help="random starts of every contender, in place of its own count")
    parser.add_argument("--only", nargs="+", default=[""], help="words of the rows wanted besides tvimdesign's own")
    parser.add_argument("--out", type=Path, help="Markdown file to write the table to")
    chosen = parser.parse_args()
    warnings.simplefilter("ignore")  # what rivals say of their finite differences
    reference = Reference(study())
    rows: list[Row] = []
    best: float | None = None
    for contender in CONTENDERS:
        if rows and not any(word in contender.name for word in chosen.only):
            continue
        counted = contender if chosen.starts is None else replace(contender, starts=chosen.starts)
        with contextlib.redirect_stdout(io.StringIO()):
            row, best = judged(reference, counted, best)
        rows.append(row)
        print(f"{row.name}: {row.seconds:.3f} s of processor, {row.right} of {row.starts} starts", flush=True)
    text = table(rows)
    print(f"\nobjective {best:.6f}, tvimdesign {rows[0].seconds:.3f} s\n\n{text}")
    if chosen.out:
        chosen.out.write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
