"""Compare every case of validation/cases with the product, and write the page of the results.

`python validation/run.py` compares all cases and writes docs/validation.md, docs/validation.csv and the figures. It
ends with 1 if a case is outside its limit or cannot be compared; the latter leaves the page as it was. With names of
cases it compares those and writes nothing.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from judging.case import CASES, read_cases
from judging.figures import write_figures
from judging.outcome import INSIDE, KNOWN, OPEN, OUTSIDE, Outcome, outcome, worst_first
from judging.page import outside_of, page, values_csv

DOCS = Path(__file__).resolve().parents[1] / "docs"


def main(arguments: list[str] | None = None) -> int:
    """Compare, print and write; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", help="names of cases (default: all)")
    parser.add_argument("--folder", type=Path, default=CASES, help="folder of the cases")
    parser.add_argument("--docs", type=Path, default=DOCS, help="folder for the page and its pictures")
    parser.add_argument("--known", type=Path, help="earlier page; cases that it lists as outside do not fail")
    given = parser.parse_args(arguments)
    begin = time.perf_counter()
    cases = read_cases(given.folder)
    unknown = set(given.cases) - {case.name for case in cases}
    if unknown:
        parser.error(f"no case is named {', '.join(sorted(unknown))}; the cases are in {given.folder}")
    outcomes, failed = [], []
    for case in (case for case in cases if not given.cases or case.name in given.cases):
        try:
            outcomes.append(outcome(case))
        except Exception as error:
            failed.append(f"cannot be compared: {case.name}: {type(error).__name__}: {error}")
    outcomes = worst_first(outcomes)
    for line in (*failed, *map(_line, outcomes)):
        print(line)
    if not given.cases and not failed:
        write_figures(outcomes, given.docs / "pictures/validation")
        (given.docs / "validation.md").write_text(page(outcomes), encoding="utf-8")
        (given.docs / "validation.csv").write_text(values_csv(outcomes), encoding="utf-8")
    counts = {verdict: sum(each.verdict == verdict for each in outcomes) for verdict in (INSIDE, KNOWN, OUTSIDE, OPEN)}
    print(", ".join(f"{count} {verdict}" for verdict, count in counts.items()), end="")
    print(f"; {time.perf_counter() - begin:.0f} s")
    accepted = outside_of(given.known.read_text(encoding="utf-8")) if given.known else set()
    outside = {each.case.name for each in outcomes if each.verdict == OUTSIDE}
    return 1 if failed or outside - accepted else 0


def _line(each: Outcome) -> str:
    if not each.quantities:
        return f"{each.verdict:<17}{each.case.name}"
    compared, row = each.worst
    label = f"{compared.quantity.name} {row.label}".strip()
    return (
        f"{each.verdict:<17}{each.case.name:<36}{row.of_limit:+7.2f} of limit: {label}, "
        f"{row.computed:.5g} for {row.expected:.5g} {compared.quantity.unit} ({each.seconds:.1f} s)"
    )


if __name__ == "__main__":
    sys.exit(main())
