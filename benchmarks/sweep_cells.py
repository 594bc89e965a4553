"""Cost of a sweep beside its cells: processor time of every process of it, scaling, a resume, bytes a cell.

    python benchmarks/sweep_cells.py [--cells 2000] [--workers 2] [--task evaluate|optimize|cold] [--set NAME=VALUE]

Times of the processor mean something on a busy machine, times by the clock only on a quiet one: both are printed.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MOST_ACROSS = 50
_INERTIA = "{{from: <= 90 kg.mm^2, to: <= 100 kg.mm^2, count: {}}}"
"""A limit, whose cells are searched from every start."""


def study_of(task: str, cells: int) -> str:
    """Return a study with a grid of so many cells, or a few more."""
    text = (ROOT / "tests/studies/paper_shear.yaml").read_text()
    if task == "cold":
        return f"{text}\nsweep: {{over: {{require.parts_inertia: {_INERTIA.format(cells)}}}}}\n"
    across = min(MOST_ACROSS, cells)
    up = -(-cells // across)
    hot = "operating_points.hot.temperature"
    other = f", {hot}: {{from: 98 degC, to: 102 degC, count: {up}}}" if up > 1 else ""
    over = f"pcl_thickness: {{from: 0.6 mm, to: 1.2 mm, count: {across}}}{other}"
    return f"{text}\nsweep: {{task: {task}, over: {{{over}}}}}\n"


def processor() -> float:
    """Seconds of the processor of this process's children that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def sweep(study: Path, out: Path, *words: str) -> tuple[dict[str, float], float, float]:
    """Run the command; what it says of the work, seconds by the clock and of the processor in all its processes."""
    before, began = processor(), time.perf_counter()
    command = [sys.executable, "-m", "tvimdesign", "sweep", str(study), "--out", str(out), "--json", *words]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    run: dict[str, float] = json.loads(done.stdout)["run"]
    return run, time.perf_counter() - began, processor() - before


def report_sweep(cells: int, workers: int, task: str, more: list[str], folder: Path) -> None:
    """Run the sweep and resume it, and print every row."""
    study, out = folder / "study.yaml", folder / "out"
    study.write_text(study_of(task, cells))
    print(f"load of the machine before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
    run, clock, cpu = sweep(study, out, "--workers", str(workers), "--no-plots", *more)
    count = int(run["computed"])
    own = run["cells_s"]
    shards = sorted((out / "shards").iterdir())
    each = [sum(json.loads(line)[-1] for line in path.read_text().splitlines()[1:]) for path in shards]
    size = sum(path.stat().st_size for path in shards)
    print(f"{count} cells ({task}), {workers} workers: {clock:.1f} s by the clock, {run['warm']} warm")
    print(f"  in the cells themselves          {own:9.2f} s of the processor, {1e3 * own / count:.1f} ms a cell")
    print(f"  chunks beside that, shards        {run['cpu_s'] - own:9.2f} s, {100 * (run['cpu_s'] / own - 1):.2f} %")
    print(f"  all processes, starts included   {cpu:9.2f} s, {100 * (cpu / own - 1):.2f} % over the cells' own")
    serial = cpu - run["cpu_s"]
    print(f"  scaling by processor time        {own / (max(each) + serial / max(len(each), 1)):9.2f} "
          f"on {len(each)} workers (the longest: {max(each):.1f} s)")  # fmt: skip
    print(f"  scaling by the clock             {own / clock:9.2f} (of a quiet machine only)")
    tables = {name: (out / name).stat().st_size / count for name in ("cells.csv", "cells.sqlite")}
    print(f"  bytes a cell                     {size / count:9.0f} in shards, "
          + ", ".join(f"{value:.0f} in {name}" for name, value in tables.items()))  # fmt: skip
    for what in ("its figure drawn", "figure and page kept"):
        _, clock, cpu = sweep(study, out, "--resume", *more)
        print(f"resumed, {what}: {clock:.2f} s by the clock, {cpu:.2f} s of the processor")
    _, clock, cpu = sweep(study, out, "--resume", "--no-plots", *more)
    print(f"resumed without it: {clock:.2f} s by the clock, {cpu:.2f} s of the processor")


def main() -> None:
    """Read what is asked and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=2000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--task", choices=("evaluate", "optimize", "cold"), default="evaluate")
    parser.add_argument("--set", action="append", default=[], help="of the study, as for the command")
    options = parser.parse_args()
    more = [word for setting in options.set for word in ("--set", setting)]
    with tempfile.TemporaryDirectory(prefix="sweep-cells-") as folder:
        report_sweep(options.cells, options.workers, options.task, more, Path(folder))


if __name__ == "__main__":
    main()
