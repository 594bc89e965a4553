"""Reads every file of measured data below the folders that are given, and says what came of each.

`python benchmarks/read_public.py FOLDER...`, with clones of public repositories. Tried so on github.com/
jorge-ramirez-upm/RepTate (.tts and .osc of data/), bsaintmichel/read-rheol (Anton Paar, TRIOS, Malvern), 3mcloud/
hermes-rheo (LIMS exports of TRIOS) and imewei/rheojax (its fixtures: TRIOS in JSON and Excel).
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.reading.data_file import read_data_file

ENDINGS = (".tts", ".osc", ".gt", ".csv", ".txt", ".xlsx", ".json")


def outcome(path: Path) -> str:
    """`read`, `read but for some columns`, or `refused`, with the reason."""
    try:
        blocks = read_data_file(path).blocks
    except InputError as error:
        return f"refused: {str(error).removeprefix(str(path))}"
    whole = all(not block.problems for block in blocks)
    named = any(block.columns for block in blocks)
    return "no column of a known name" if not named else "read" if whole else "read but for some columns"


def main() -> None:
    """Print what came of each file, then how many of each."""
    counts: Counter[tuple[str, str]] = Counter()
    for folder in map(Path, sys.argv[1:]):
        for path in sorted(
            path for path in folder.rglob("*") if path.suffix.lower() in ENDINGS and path.stat().st_size
        ):
            text = outcome(path)
            counts[path.suffix.lower(), text.partition(":")[0]] += 1
            print(f"{path}: {text}")
    for (ending, text), count in sorted(counts.items()):
        print(f"{ending}: {count} {text}")


if __name__ == "__main__":
    main()
