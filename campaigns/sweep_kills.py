"""Ends jobs of an array, workers and scheduler of a cluster, at random moments of a sweep: the bytes must be the same.

    python campaigns/sweep_kills.py [--tries 20] [--seed 1] [--on shards cluster]

A try on shards runs the parts of a sweep side by side, kills one by SIGKILL and starts it again until it ends. A try on
the cluster kills a worker, or the scheduler with its workers, and starts them again. The tables are held against those
of one process.
"""

from __future__ import annotations

import argparse
import os
import random
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from tvimdesign.base.processes import end_process_tree

ROOT = Path(__file__).resolve().parents[1]
SWEEP = [
    "sweep", str(ROOT / "studies/paper_reconstructed.yaml"), "--no-plots", "--set",
    "sweep={over: {pcl_thickness: {from: 0.6 mm, to: 2 mm, count: 12}, wire_diameter: [2 mm, 2.4 mm]}}",
]  # fmt: skip
TABLES = ("cells.csv", "cells.sqlite")
PARTS = 3
WORKERS = 2


def start(*words: str) -> subprocess.Popen[bytes]:
    """Start a module of Python in the background, with its own session."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    return subprocess.Popen(
        [sys.executable, "-m", *words], env=environment, stdout=subprocess.DEVNULL, start_new_session=True,
        stderr=subprocess.PIPE if words[0] == "tvimdesign" else subprocess.DEVNULL,
    )  # fmt: skip


def end(process: subprocess.Popen[bytes]) -> None:
    """End a process with its children, at once."""
    if process.poll() is None:
        end_process_tree(process.pid)
    process.wait()


def swept(out: Path, *words: str) -> subprocess.Popen[bytes]:
    """Start the sweep into a folder."""
    return start("tvimdesign", *SWEEP, "--out", str(out), *words)


def through(process: subprocess.Popen[bytes]) -> None:
    """Wait for a sweep; one that fails ends the campaign with what it said."""
    _, said = process.communicate(timeout=600.0)
    if process.returncode:
        sys.exit(f"exit code {process.returncode}: {said.decode(errors='replace')}")


def on_shards(out: Path, after: float, dice: random.Random) -> None:
    """Run the parts side by side; one is killed `after` some seconds [s] and started again."""
    parts = [swept(out, "--shard", f"{number}/{PARTS}") for number in range(1, PARTS + 1)]
    time.sleep(after)
    lost = dice.randrange(PARTS)
    end(parts[lost])
    parts[lost] = swept(out, "--shard", f"{lost + 1}/{PARTS}")
    for part in parts:
        through(part)


def on_cluster(out: Path, after: float, dice: random.Random) -> None:
    """Sweep on a scheduler; a worker, or all of the cluster, is killed `after` some seconds [s] and started again."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    address = f"tcp://127.0.0.1:{port}"
    own = tempfile.mkdtemp(dir=out.parent)

    def scheduler() -> subprocess.Popen[bytes]:
        return start("dask", "scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard")

    def worker() -> subprocess.Popen[bytes]:
        return start("dask", "worker", address, "--nthreads", "1", "--no-dashboard", "--local-directory", own)

    cluster = [scheduler(), *(worker() for _ in range(WORKERS))]
    sweep = swept(out, "--scheduler", address)
    try:
        time.sleep(after)
        whole = dice.random() < 0.5
        for place in range(len(cluster)) if whole else [dice.randrange(1, len(cluster))]:
            end(cluster[place])
            cluster[place] = worker() if place else scheduler()
        through(sweep)
    finally:
        for process in [sweep, *cluster]:
            end(process)


PLACES: dict[str, Callable[[Path, float, random.Random], None]] = {"shards": on_shards, "cluster": on_cluster}


def main() -> None:
    """Run the campaign; exit code 1 where a table differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tries", type=int, default=20, help="on each place")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--on", nargs="+", choices=PLACES, default=list(PLACES))
    asked = parser.parse_args()
    dice = random.Random(asked.seed)
    wrong = 0
    with tempfile.TemporaryDirectory(prefix="sweep-kills-") as name:
        folder = Path(name)
        for place in asked.on:
            # Without a kill: how long it takes, and what comes of it.
            began = time.monotonic()
            through(swept(folder / f"{place}-whole", "--workers", "1"))
            seconds = time.monotonic() - began
            expected = [(folder / f"{place}-whole" / table).read_bytes() for table in TABLES]
            for number in range(asked.tries):
                out, after = folder / f"{place}-{number}", dice.uniform(0.2, 1.0) * seconds
                PLACES[place](out, after, dice)
                same = [(out / table).read_bytes() for table in TABLES] == expected
                wrong += not same
                bytes_are = "same" if same else "OTHER"
                print(f"{place} {number + 1}: killed after {after:.1f} s, {bytes_are} bytes", flush=True)
    print(f"{wrong} tables differ")
    sys.exit(min(wrong, 1))


if __name__ == "__main__":
    main()
