"""Compare every case of validation/cases with what the product says, and write the page of the results.

`python validation/run.py` compares all cases, writes docs/validation.md with its figures, and ends with 1 where one is
outside its band or cannot be compared, which leaves the page as it was. With names of cases it compares those and
writes nothing.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from judging.case import CASES, read_cases
from judging.figures import write_figures
from judging.outcome import INSIDE, KNOWN, OPEN, OUTSIDE, Outcome, outcome, worst_first
from judging.page import outside_of, page

DOCS = Path(__file__).resolve().parents[1] / "docs"


def main(arguments: list[str] | None = None) -> int:
    """Compare, print, write; the number the process ends with."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", help="names of cases; all of them where none is given")
    parser.add_argument("--folder", type=Path, default=CASES, help="where the cases are")
    parser.add_argument("--docs", type=Path, default=DOCS, help="where the page and its pictures go")
    parser.add_argument("--known", type=Path, help="a page of these cases: one that it tells to be outside may be so")
    given = parser.parse_args(arguments)
    begin = time.perf_counter()
    cases = read_cases(given.folder)
    unknown = set(given.cases) - {case.name for case in cases}
    if unknown:
        parser.error(f"no case is named {', '.join(sorted(unknown))}; the cases are in {given.folder}")
    outcomes, broken = [], []
    for case in (case for case in cases if not given.cases or case.name in given.cases):
        try:
            outcomes.append(outcome(case))
        except Exception as error:
            broken.append(f"cannot be compared: {case.name}: {type(error).__name__}: {error}")
    outcomes = worst_first(outcomes)
    for line in (*broken, *map(_line, outcomes)):
        print(line)
    if not given.cases and not broken:
        write_figures(outcomes, given.docs / "pictures/validation")
        (given.docs / "validation.md").write_text(page(outcomes), encoding="utf-8")
    counts = {verdict: sum(one.verdict == verdict for one in outcomes) for verdict in (INSIDE, KNOWN, OUTSIDE, OPEN)}
    print(", ".join(f"{count} {verdict}" for verdict, count in counts.items()), end="")
    print(f"; {time.perf_counter() - begin:.0f} s")
    told = outside_of(given.known.read_text(encoding="utf-8")) if given.known else set()
    return 1 if broken or {one.case.name for one in outcomes if one.verdict == OUTSIDE} - told else 0


def _line(one: Outcome) -> str:
    if not one.quantities:
        return f"{one.verdict:<17}{one.case.name}"
    quantity, row = one.worst
    told = f"{quantity.quantity.name} {row.label}".strip()
    return (
        f"{one.verdict:<17}{one.case.name:<36}{row.of_band:+7.2f} of the band: {told}, "
        f"{row.found:.5g} for {row.expected:.5g} {quantity.quantity.unit} ({one.seconds:.1f} s)"
    )


if __name__ == "__main__":
    sys.exit(main())
