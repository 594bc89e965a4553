"""How often a fit's interval of 95 % holds the value the data were made with: every kind, many seeds of noise.

    python benchmarks/fit_coverage.py [KIND ...] [--seeds 100] [--workers 2] [--kept FILE]

fits each kind with noise of every seed and writes, for each parameter, in how many of how many seeds the interval held
the truth. Data are the product's own equations with normal noise: `made_measurements`. A seed that the file has is not
fitted again, so that a count goes on where it was left. Prints the table of `docs/measurements.md`.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from made_measurements import MADE

from tvimdesign.simulation.measurement.kind_sheet import kind_sheet
from tvimdesign.simulation.measurement.measure_files import measure_of

KEPT = Path("results/fit_coverage.jsonl")
Held = dict[str, bool]


def held(kind: str, seed: int) -> Held:
    """Whether the interval of each parameter holds what the data of a seed were made with."""
    blocks, given, truth = MADE[kind](np.random.default_rng(seed))
    fit = measure_of(kind_sheet(kind))(blocks, kind_sheet(kind).values(given)).fit
    found = {one.name: one for one in (*fit.parameters, *fit.derived)}
    inside = {}
    for name, value in truth.items():
        low, high = found[name].low, found[name].high
        inside[name] = bool((low is None or low <= value) and (high is None or value <= high))
    return inside


def kept_in(path: Path) -> dict[tuple[str, int], Held]:
    """What a file has, by kind and seed; a line that was cut short is left out."""
    found = {}
    for line in path.read_text().splitlines() if path.exists() else []:
        if line.endswith("}}"):
            one = json.loads(line)
            found[one["kind"], one["seed"]] = one["held"]
    return found


def counted(kinds: list[str], seeds: int, workers: int, path: Path) -> dict[tuple[str, int], Held]:
    """Fit what the file has not, a seed of every kind after the other, and keep each as it comes."""
    found = kept_in(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    lacking = [(kind, seed) for seed in range(seeds) for kind in kinds if (kind, seed) not in found]
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as hands, path.open("a") as file:
        asked = {hands.submit(held, *one): one for one in lacking}
        for done in as_completed(asked):
            kind, seed = asked[done]
            found[kind, seed] = done.result()
            file.write(json.dumps({"kind": kind, "seed": seed, "held": found[kind, seed]}) + "\n")
            file.flush()
    return found


def table(found: dict[tuple[str, int], Held]) -> Iterator[str]:
    """Rows in Markdown: a kind, how many seeds, and the count for each parameter."""
    yield from ("| kind | seeds | held the truth |", "|---|---|---|")
    for kind in MADE:
        seeds = [one for (name, _), one in found.items() if name == kind]
        if seeds:
            told = ", ".join(f"{name} {sum(one[name] for one in seeds)}" for name in seeds[0])
            yield f"| `{kind}` | {len(seeds)} | {told} |"


def main() -> None:
    """Count, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", choices=[[], *MADE], default=[], metavar="KIND")
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--kept", type=Path, default=KEPT)
    asked = parser.parse_args()
    print("\n".join(table(counted(asked.kinds or list(MADE), asked.seeds, asked.workers, asked.kept))))


if __name__ == "__main__":
    main()
