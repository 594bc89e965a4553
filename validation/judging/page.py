"""docs/validation.md: all cases in one table, the worst first; then each case with its source, numbers and figure."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from judging.case import KINDS
from judging.outcome import INSIDE, KNOWN, OPEN, OUTSIDE, Compared, Outcome, Row

_MOST_ROWS = 9
"""Longer curves show so many rows, evenly spread, and the worst one."""
_HEAD = (
    "# Validation",
    "",
    "`make validation` wrote this page: it compares the product with what others say, one folder a case in "
    "`validation/cases/`. Each case names its source, its inputs, what is expected within which band, and the function "
    "that asks the product. It fails where a value is outside its band. A known difference is outside its band for the "
    "reason that stands with it. An open case has a source and lacks something that a comparison needs.",
    "",
    "*Of the band* is the distance from the expected value over half the band: 1 is the edge.",
)


def outside_of(text: str) -> set[str]:
    """Names of the cases that a page tells to be outside their bands."""
    return set(re.findall(rf"^\| \[.*\]\(#(\w+)\) \|.*\| {OUTSIDE} \|$", text, re.MULTILINE))


def page(outcomes: Sequence[Outcome]) -> str:
    """The page as Markdown; outcomes stand in the order of the first table."""
    lines = [*_HEAD, "", _counts(outcomes), "", *_table(outcomes), ""]
    for kind, heading in KINDS.items():
        here = [one for one in outcomes if one.case.kind == kind]
        if here:
            lines += [f"## {heading}", ""]
            for one in sorted(here, key=lambda one: (one.verdict == OPEN, one.case.name)):
                lines += [*_section(one), ""]
    return "\n".join(lines).rstrip() + "\n"


def _counts(outcomes: Sequence[Outcome]) -> str:
    counts = {verdict: sum(one.verdict == verdict for one in outcomes) for verdict in (INSIDE, KNOWN, OUTSIDE, OPEN)}
    values = sum(len(one.rows) for found in outcomes for one in found.quantities)
    said = {INSIDE: "inside their bands", KNOWN: "known differences", OUTSIDE: "outside", OPEN: "open"}
    parts = ", ".join(f"{counts[verdict]} {words}" for verdict, words in said.items())
    return f"{len(outcomes)} cases with {values} values: {parts}."


def _table(outcomes: Sequence[Outcome]) -> Iterator[str]:
    yield "| case | kind | worst value | expected | found | of the band | verdict |"
    yield "|---|---|---|---|---|---|---|"
    for one in outcomes:
        begin = f"| [{one.case.title}](#{one.case.name}) | {KINDS[one.case.kind]} "
        if not one.quantities:
            yield f"{begin}| | | | | open |"
            continue
        quantity, row = one.worst
        unit = _unit(quantity.quantity.unit)
        yield (
            f"{begin}| {_told(quantity, row)} | {_number(row.expected)}{unit} | {_number(row.found)}{unit} "
            f"| {row.of_band:+.2f} | {one.verdict} |"
        )


def _section(one: Outcome) -> Iterator[str]:
    case = one.case
    yield f"### {case.title} {{#{case.name}}}"
    yield ""
    yield f"Source: {case.source}."
    if case.open:
        yield ""
        yield f"**Open:** {case.open}"
        return
    judge = f", `references/{case.reference.replace(':', '.py:')}`" if case.reference else ""
    yield f"Compared by `comparisons/{case.compare.replace(':', '.py:')}`{judge}."
    if case.note:
        yield ""
        yield case.note
    for quantity in one.quantities:
        if quantity.quantity.known:
            yield ""
            yield f"**Known difference**, {quantity.quantity.name}: {quantity.quantity.known}"
    yield ""
    yield "| quantity | expected | band | found | of the band |"
    yield "|---|---|---|---|---|"
    for quantity in one.quantities:
        for row in _shown(quantity.rows):
            unit = _unit(quantity.quantity.unit)
            yield (
                f"| {_told(quantity, row)} | {_number(row.expected)}{unit} | ± {_number(row.half_band)} "
                f"| {_number(row.found)} | {row.of_band:+.2f} |"
            )
    yield ""
    yield f"![{case.title}](pictures/validation/{case.name}.svg)"


def _shown(rows: Sequence[Row]) -> list[Row]:
    """All rows, or of many some, with the worst among them."""
    if len(rows) <= _MOST_ROWS:
        return list(rows)
    worst = max(range(len(rows)), key=lambda i: abs(rows[i].of_band))
    step = (len(rows) - 1) / (_MOST_ROWS - 2)
    return [rows[i] for i in sorted({worst, *(round(i * step) for i in range(_MOST_ROWS - 1))})]


def _told(compared: Compared, row: Row) -> str:
    return f"{compared.quantity.name} {row.label}".strip().replace("_", " ")


def _number(value: float) -> str:
    return f"{value:.4g}"


def _unit(unit: str) -> str:
    return "" if unit == "1" else f" {unit}"
