"""Writer of the tables and counts in docs/theory/heat.md from the results of validation/heat_sector.

    python docs/make/heat_tables.py

reads results.csv and fresh.csv, which `compare.py` and `fresh.py` there write, and replaces tables and counts in the
page.
"""

from __future__ import annotations

import csv
import functools
import math
import re
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "theory" / "heat.md"
TIMES = ("softening_time", "mean_time", "far_face_time")
MODES = ("shear", "compression")
MOST = 3.0
"""Difference of a time above which the page lists it [%]."""

Row = dict[str, str]


def rows(name: str) -> list[Row]:
    """Read the rows of a table of validation/heat_sector."""
    with (ROOT / "validation" / "heat_sector" / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def mode_of(row: Row) -> str:
    """Return the mode of a row's study."""
    return _mode(row["study"])


@functools.cache
def _mode(study: str) -> str:
    files = (ROOT / folder / f"{study}.yaml" for folder in ("studies", "tests/studies"))
    return str(yaml.safe_load(next(filter(Path.exists, files)).read_text(encoding="utf-8"))["mode"])


def difference(row: Row) -> float:
    """Return the difference of the product's time [%]."""
    return float(row["difference [%]"])


def signed(number: float) -> str:
    """Format a number with its sign and one decimal."""
    return f"{number:+.1f}".replace("-", "−")


def ranges(table: list[Row]) -> str:
    """Return the table of the least and largest difference of each time in each mode."""
    lines = ["| time, mode | difference of the product [%], least and largest |", "|---|---|"]
    for mode in MODES:
        for time in TIMES:
            own = [difference(row) for row in table if row["time"] == time and mode_of(row) == mode]
            reached = [value for value in own if math.isfinite(value)]
            lines.append(f"| `{time}`, {mode} | {signed(min(reached))} to {signed(max(reached))} |")
    return "\n".join(lines)


def counts(table: list[Row]) -> str:
    """Return the sentence that counts times within the limit; a joint that neither softens is no time."""
    within = []
    for mode in MODES:
        own = [abs(difference(row)) for row in table if mode_of(row) == mode and row["product [s]"] != "inf"]
        within.append((sum(value <= MOST for value in own), len(own)))
    (shear, of_shear), (compression, of_compression) = within
    return f"{shear} of {of_shear} times in shear and {compression} of {of_compression} in compression are within 3 %."


def beyond(table: list[Row]) -> str:
    """Return the table of times beyond the limit, with their sensitivity and the product's error in kelvins."""
    lines = ["| study, design | time | difference [%] | time over rise | warmer by [K] |", "|---|---|---|---|---|"]
    for row in table:
        if abs(difference(row)) > MOST:
            cells = (f"`{row['study']}`, {row['design']}", f"`{row['time']}`", signed(difference(row)),
                     f"{float(row['time over rise']):.1f}", signed(float(row["warmer by [K]"])))  # fmt: skip
            lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def fresh(table: list[Row]) -> str:
    """Return the words that count times of random designs within the limit."""
    within = sum(abs(difference(row)) <= MOST for row in table)
    return f"{within} of its {len(table)} times are within 3 %"


def written(page: str, results: list[Row], drawn: list[Row]) -> str:
    """Return the page with the tables and counts of these results; raise ValueError if a place is missing."""
    table = r"\| {} \|[^\n]*\n\|---[^\n]*(\n\|[^\n]*)*"
    places = (
        (table.format("time, mode"), ranges(results)),
        (r"\d+ of \d+ times in shear and \d+ of \d+ in compression are within 3 %\.", counts(results)),
        (table.format("study, design"), beyond(results)),
        (r"\d+ of its \d+ times are within 3 %", fresh(drawn)),
    )
    for pattern, text in places:
        page, replaced = re.subn(pattern, lambda _, text=text: text, page)
        if replaced != 1:
            raise ValueError(f"{PAGE.name}: {replaced} places for {text.splitlines()[0]!r} where one is wanted")
    return page


if __name__ == "__main__":
    page = written(PAGE.read_text(encoding="utf-8"), rows("results"), rows("fresh"))
    PAGE.write_text(page, encoding="utf-8")
