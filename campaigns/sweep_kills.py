"""Ends jobs of an array at random moments of a sweep: the bytes must be the same.

    python campaigns/sweep_kills.py [--tries 20] [--seed 1]

A try on shards runs the parts of a sweep side by side, kills one by SIGKILL and starts it again until it ends. The
tables are compared with those of one process.
"""

from __future__ import annotations

import argparse
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tvimdesign.base.processes import end_process_tree

ROOT = Path(__file__).resolve().parents[1]
SWEEP = [
    "sweep", str(ROOT / "studies/paper_reconstructed.yaml"), "--no-plots", "--set",
    "sweep={over: {pcl_thickness: {from: 0.6 mm, to: 2 mm, count: 12}, wire_diameter: [2 mm, 2.4 mm]}}",
]  # fmt: skip
TABLES = ("cells.csv", "cells.sqlite")
PARTS = 3


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
    _, errors = process.communicate(timeout=600.0)
    if process.returncode:
        sys.exit(f"exit code {process.returncode}: {errors.decode(errors='replace')}")


def on_shards(out: Path, after: float, dice: random.Random) -> None:
    """Run the parts side by side; one is killed `after` some seconds [s] and started again."""
    parts = [swept(out, "--shard", f"{number}/{PARTS}") for number in range(1, PARTS + 1)]
    time.sleep(after)
    lost = dice.randrange(PARTS)
    end(parts[lost])
    parts[lost] = swept(out, "--shard", f"{lost + 1}/{PARTS}")
    for part in parts:
        through(part)


def main() -> None:
    """Run the campaign; exit code 1 where a table differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tries", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    dice = random.Random(options.seed)
    wrong = 0
    with tempfile.TemporaryDirectory(prefix="sweep-kills-") as name:
        folder = Path(name)
        # Without a kill: how long it takes, and what comes of it.
        began = time.monotonic()
        through(swept(folder / "whole", "--workers", "1"))
        seconds = time.monotonic() - began
        expected = [(folder / "whole" / table).read_bytes() for table in TABLES]
        for number in range(options.tries):
            out, after = folder / f"try-{number}", dice.uniform(0.2, 1.0) * seconds
            on_shards(out, after, dice)
            same = [(out / table).read_bytes() for table in TABLES] == expected
            wrong += not same
            bytes_are = "same" if same else "OTHER"
            print(f"{number + 1}: killed after {after:.1f} s, {bytes_are} bytes", flush=True)
    print(f"{wrong} tables differ")
    sys.exit(min(wrong, 1))


if __name__ == "__main__":
    main()
