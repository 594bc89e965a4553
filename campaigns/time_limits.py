"""Runs every shipped study with short time limits, and measures whether each is kept and what the run says.

    python campaigns/time_limits.py [--limits 5,20,60] [--only WORD] [--out FILE]

A limit holds if the command, with the start of Python, takes at most a tenth and two seconds more by the clock. The
processor time is that of the command with its children. Every shipped study has a design: a run that says anything
else, but for the time limit, is wrong about why. Other work on the machine makes the clock's time longer.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
_CLAIMS = re.compile(r"no design found|cannot hold|can be reached|no design\.")
_LATE = "time limit"


@dataclass(frozen=True)
class Measured:
    """One run of a study."""

    study: str
    limit: float
    clock: float
    processor: float
    code: int
    says: str
    """The end of the run in its own words."""
    right: bool
    """Whether nothing but the time limit is given as a reason."""

    @property
    def in_time(self) -> bool:
        """Return whether the limit was kept by the clock."""
        return self.clock <= allowed(self.limit)


def allowed(limit: float) -> float:
    """Return the seconds that a run with a time limit may take."""
    return 1.1 * limit + 2.0


def measure(study: Path, limit: float, folder: Path) -> Measured:
    """Run a study without parts and plots."""
    command = [sys.executable, "-m", "tvimdesign", "run", str(study), "--no-cad", "--no-plots"]
    command += ["--out", str(folder / study.stem), "--overwrite", "--time-limit", f"{limit:g} s"]
    before, began = _processor(), time.monotonic()
    environment = {**os.environ, "COLUMNS": "1000"}
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, env=environment)
    clock, processor = time.monotonic() - began, _processor() - before
    text = done.stdout + done.stderr
    return Measured(
        study.stem, limit, clock, processor, done.returncode, _in_short(done.stdout, done.stderr), _right(text)
    )


def _processor() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _right(message: str) -> bool:
    """Return whether no line claims that there is no design without naming the time limit."""
    return all(_LATE in line for line in message.splitlines() if _CLAIMS.search(line))


def _in_short(printed: str, errors: str) -> str:
    """Return the status and what was left out; where there is no screen, the error."""
    head = printed.splitlines()[0].split(" · ")[2:3] if printed else []
    left_out = [line.split("done: ")[-1] for line in printed.splitlines() if line.startswith("Left out")]
    last = [line for line in errors.splitlines() if _LATE in line][-1:] or errors.splitlines()[-1:]
    return "; ".join(part for part in (*head, *left_out, *([] if head else last)) if part)


def table(runs: Sequence[Measured]) -> str:
    """Write the runs as a table in Markdown."""
    lines = ["| study | limit | clock | processor | kept | exit | says |", "|---|---|---|---|---|---|---|"]
    for run in runs:
        within = "yes" if run.in_time else f"no, {run.clock - allowed(run.limit):.1f} s over"
        says = run.says if run.right else f"WRONG: {run.says}"
        seconds = f"{run.limit:g} s | {run.clock:.1f} s | {run.processor:.1f} s"
        lines.append(f"| {run.study} | {seconds} | {within} | {run.code} | {says} |")
    return "\n".join(lines)


def main() -> None:
    """Measure, one run after another, and exit with 1 where a limit is not kept or a reason is wrong."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--limits", default="5,20,60", help="seconds, with commas between them")
    parser.add_argument("--only", default="", help="studies whose name has this word")
    parser.add_argument("--out", type=Path, help="file that gets a line of JSON for each run")
    given = parser.parse_args()
    studies = sorted(path for path in (ROOT / "studies").glob("*.yaml") if given.only in path.stem)
    runs: list[Measured] = []
    with tempfile.TemporaryDirectory() as folder:
        for limit in map(float, given.limits.split(",")):
            for study in studies:
                runs.append(measure(study, limit, Path(folder)))
                print(table(runs[-1:]).splitlines()[-1], flush=True)
                if given.out:
                    with given.out.open("a", encoding="utf-8") as file:
                        file.write(json.dumps({**asdict(runs[-1]), "kept": runs[-1].in_time}) + "\n")
    over, wrong = (
        [run for run in runs if test(run)] for test in (lambda run: not run.in_time, lambda run: not run.right)
    )
    print(f"{len(runs)} runs: {len(over)} over their limit, {len(wrong)} with a wrong reason")
    raise SystemExit(bool(over or wrong))


if __name__ == "__main__":
    main()
