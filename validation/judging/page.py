"""docs/validation.md, a table a kind and a figure a case, and docs/validation.csv with every value."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Sequence

from judging.case import KINDS
from judging.outcome import INSIDE, KNOWN, OPEN, OUTSIDE, Compared, Outcome, Row

_HEAD = (
    "# Validation",
    "",
    "`make validation` compares the product with outside values and writes this page. A table has the value of each "
    "case (a folder in `validation/cases/`) that is nearest its limit or furthest beyond; "
    "[validation.csv](validation.csv) has all. *Of limit* is the deviation over the limit. A *known difference* is "
    "beyond it for a stated reason. An *open* case lacks what a comparison needs. "
    "[References](theory/references.md) has short names of books in full.",
)


def outside_of(text: str) -> set[str]:
    """Return the names of cases that a page lists as outside their limits."""
    return set(re.findall(rf"^\| \[.*\]\(#(\w+)\) \|.*, {OUTSIDE} \|$", text, re.MULTILINE))


def page(outcomes: Sequence[Outcome]) -> str:
    """Return the page as Markdown: a section a kind, and in it the outcomes in the given order."""
    lines = [*_HEAD, "", _counts(outcomes), ""]
    cited: dict[str, str] = {}
    for kind, heading in KINDS.items():
        here = [each for each in outcomes if each.case.kind == kind]
        if here:
            lines += [f"## {heading}", "", *_table(here), ""]
            for each in here:
                lines += [*_section(each, cited), ""]
    return "\n".join(lines).rstrip() + "\n"


def values_csv(outcomes: Sequence[Outcome]) -> str:
    """Return every compared value as CSV: expected, limit and found, in the quantity's unit."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(("case", "quantity", "at", "unit", "expected", "limit", "found", "of_limit"))
    for each in sorted(outcomes, key=lambda each: each.case.name):
        for compared in each.quantities:
            for row in compared.rows:
                numbers = (_number(value) for value in (row.expected, row.limit, row.computed))
                quantity = compared.quantity
                label = (each.case.name, quantity.name, row.label, quantity.unit)
                rows.writerow((*label, *numbers, f"{row.of_limit:+.2f}"))
    return text.getvalue()


def _counts(outcomes: Sequence[Outcome]) -> str:
    counts = {verdict: sum(each.verdict == verdict for each in outcomes) for verdict in (INSIDE, KNOWN, OUTSIDE, OPEN)}
    values = sum(len(compared.rows) for each in outcomes for compared in each.quantities)
    words = {INSIDE: "inside their limits", KNOWN: "known differences", OUTSIDE: "outside", OPEN: "open"}
    parts = ", ".join(f"{counts[verdict]} {text}" for verdict, text in words.items())
    return f"{len(outcomes)} cases with {values} values: {parts}."


def _table(outcomes: Sequence[Outcome]) -> Iterator[str]:
    yield "| case | value | expected | limit | found | of limit |"
    yield "|---|---|---|---|---|---|"
    for each in outcomes:
        name = each.case.name
        if not each.quantities:
            continue
        compared, row = each.worst
        verdict = "" if each.verdict == INSIDE else f", {each.verdict}"
        unit = "" if compared.quantity.unit == "1" else f" {compared.quantity.unit}"
        yield (
            f"| [{name}](#{name}) | {_label(compared, row)} | {_number(row.expected)}{unit} | {_number(row.limit)} "
            f"| {_number(row.computed)} | {row.of_limit:+.2f}{verdict} |"
        )


def _section(each: Outcome, cited: dict[str, str]) -> Iterator[str]:
    """Yield title, source, notes and figure; a source that another case cites in full is a link to that case."""
    case = each.case
    yield f"### {case.title} {{#{case.name}}}"
    yield ""
    first = cited.setdefault(case.source, case.name)
    source = f"{case.source}." if first == case.name else f"As [{first}](#{first})."
    yield " ".join(filter(None, (source[0].upper() + source[1:], case.note, case.open and f"**Open:** {case.open}")))
    for compared in each.quantities:
        if compared.quantity.known:
            yield ""
            yield f"**Known difference**, {compared.quantity.name}: {compared.quantity.known}"
    if each.quantities:
        yield ""
        yield f"![](pictures/validation/{case.name}.svg)"


def _label(compared: Compared, row: Row) -> str:
    return f"{compared.quantity.name} {row.label}".strip().replace("_", " ")


def _number(value: float) -> str:
    return f"{value:.4g}"
