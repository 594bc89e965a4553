"""The commands that a campaign ends, and what is known of each."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
_STUDY = str(ROOT / "studies/paper_reconstructed.yaml")
SMALL = ROOT / "campaigns/small.yaml"
_FRONT = ["--set", "front={of: [response_time, peak_power], points: 4}", "--no-cad", "--no-plots"]
_LISTED = ["--set", "vary.pcl_thickness={from: 0.6 mm, to: 2 mm, step: 0.04 mm}", "--set", "solver.alternatives=2"]
"""Thirty-six combinations, in three blocks."""
_RUN = "../answered/out"
"""Folder of a run of that study, as seen from the folder of a try."""
_DESIGN = f"{_RUN}/design.json"
_SAMPLES = ROOT / "campaigns/fuzzing/samples"
_OVER = "sweep={over: {pcl_thickness: {from: 0.6 mm, to: 2 mm, count: 12}, wire_diameter: [2 mm, 2.4 mm]}}"
_TWO = "sweep={over: {pcl_thickness: [1 mm, 1.2 mm]}}"
COMMANDS = {
    "run": ["run", _STUDY, "--no-cad"],
    "run_with_parts": ["run", _STUDY],
    "front": ["run", str(SMALL), *_FRONT],
    "prove": ["run", str(SMALL), *_LISTED, "--prove", "--no-cad", "--no-plots"],
    "parts": ["cad", _DESIGN],
    "simulate": ["simulate", _DESIGN, "--test", "sine"],
    "tolerate": ["tolerate", _DESIGN, "--samples", "16384"],
    "robot": ["robot", _DESIGN],
    "fit": ["fit", str(_SAMPLES / "frequency_sweep.csv")],
    "sweep": ["sweep", _STUDY, "--set", _OVER, "--workers", "2", "--no-plots"],
    "compare": ["compare", str(SMALL), str(ROOT / "campaigns/small_compression.yaml"), "--points", "0"],
    "explorer": ["explore", str(SMALL), "--no-open"],
    "verify": ["verify", _RUN],
}
"""What is ended, in a folder of its own; each gets `--out`."""
FIRST = {
    **{
        name: ("answered", ["run", _STUDY, "--no-cad", "--no-plots"])
        for name, words in COMMANDS.items()
        if any(word.startswith(_RUN) for word in words)
    }
}
"""What is done once before a command: the folder beside those of the tries, and a command whose results go there."""
GOES_ON = {"front": "front/progress", "sweep": "shards"}
"""Commands that can be resumed, and the folder of what they go on from."""
NEEDS_FE = "verify"
"""The command that is ended only where a Python with finite elements is named: `--fe-python`."""
COARSER = 6.0
"""How much larger elements are than `verify` makes them: a try asks for files and processes, not for stress."""
SERVES = "explorer"
"""The command that does not end by itself; it is ended within these seconds of the processor."""
SERVED = 12.0

_COARSE = """#!/bin/sh
last= heat=
for word; do
  shift
  case "$word" in */heat.py) heat=yes ;; esac
  [ "$last" != --coarser ] || [ "$heat$word" = yes1.0 ] || word=$(awk "BEGIN {{ print $word * {coarser} }}")
  set -- "$@" "$word"
  last=$word
done
exec '{python}' "$@"
"""


def coarse_python(python: Path, folder: Path) -> Path:
    """Write an interpreter for `verify` that is this one, and has its solvers make larger elements.

    But for the heat's first mesh, which is distinguished from the second by its size.
    """
    path = folder / "coarse_python"
    path.write_text(_COARSE.format(python=python.absolute(), coarser=COARSER))
    path.chmod(0o755)
    return path
