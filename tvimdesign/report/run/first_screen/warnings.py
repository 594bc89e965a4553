"""What a run warns of, each with the line of the study that mends it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from tvimdesign.base.units import format_quantity
from tvimdesign.device import Table
from tvimdesign.report.output.remaining_time import duration
from tvimdesign.report.run.first_screen.layout import LABEL, block
from tvimdesign.report.run.first_screen.mending import VARY, filled, hint, hints, mending
from tvimdesign.report.run.infeasible_report import endings
from tvimdesign.solve.result import StudyResult

LOOSE = 0.05
"""Share of the first swing without contact from which on small motions say little of the joint."""

Warned = tuple[str, str]
"""What is wrong, and what to write in the study."""


def warnings_of(answer: StudyResult, table: Table, doubts: Sequence[str]) -> list[Warned]:
    """What to tell of a design, what matters most first; `doubts` are what chosen records say against themselves."""
    if not answer.found:
        return [_other("doubt", line=doubt) for doubt in doubts]
    return [
        *_of_the_switch(answer),
        *_of_advice(answer, table),
        *_of_points(answer),
        *_of_the_search(answer),
        *(_other("doubt", line=doubt) for doubt in doubts),
    ]


def _other(kind: str, **places: str) -> Warned:
    entry = hints()["others"][kind]
    return filled(entry["say"], places).rstrip("."), filled(entry["mend"], places)


def _of_advice(answer: StudyResult, table: Table) -> Iterator[Warned]:
    for check in answer.warnings:
        value = format_quantity(check.value, table.unit(check.output))
        text = f"{check.output} is {value}: {hint(check.output).get('say', check.origin)}"
        mend = mending(check, answer, table)
        if check.output in answer.design.above_rating:
            accept = f"accept: [{check.output}]"
            mend = f"{mend} or {accept}" if mend else accept
        yield text, mend


def _of_the_switch(answer: StudyResult) -> Iterator[Warned]:
    if math.isinf(answer.design.value("response_time")):
        yield _other("never_soft")
    elif math.isinf(answer.design.value("stiffening_time")):
        yield _other("never_stiff")


def _of_points(answer: StudyResult) -> Iterator[Warned]:
    melting = [
        point for point in answer.design.study["operating_points"] if f"solid_fraction@{point}" in answer.intervals
    ]
    for point in melting:
        yield _other("melting_range", point=point)
    for check in answer.undecided:
        yield _other("undecided", limit=check.text, point=next(iter(melting), "hot"))
    for point in answer.design.study["operating_points"]:
        lost = answer.design.values.get(f"contact_lost@{point}", 0.0)
        if lost > LOOSE:
            yield _other("contact_lost", point=point, share=f"{100.0 * lost:.2g} %")


def _of_the_search(answer: StudyResult) -> Iterator[Warned]:
    solution = answer.solution
    if solution is None:
        return
    if solution.out_of_time is not None:
        yield _other("out_of_time", seconds=duration(solution.out_of_time))
    distinct = solution.distinct_optima()  # none where only a search from elsewhere ended in an optimum
    best, others = distinct[:1], distinct[1:]
    if others:
        count = sum(solution.reached(start) for start in others)
        yield _other(
            "another_optimum", count=str(count), all=str(len(solution.free_starts)),
            objective=f"{others[0].objective:.5g}", best=f"{best[0].objective:.5g}",
        )  # fmt: skip
    for line in endings(solution.free_starts):
        yield _other("not_converged", line=line)


def warning_lines(found: Sequence[Warned], width: int, most: int) -> list[str]:
    """As many warnings as `most` lines hold, and how many more there are."""
    lines: list[str] = []
    for i, (text, mend) in enumerate(found):
        more, left = _warning(text, mend, width), len(found) - i
        if len(lines) + len(more) + (left > 1) > most:
            label = "" if lines else "Warning"
            return [*lines, f"{label:{LABEL}}{left}{' more' if lines else ''}: --full, summary.txt"]
        lines += more
    return lines


def _warning(text: str, mend: str, width: int) -> list[str]:
    """What is wrong, and what mends it on the same line where it fits: what is to be copied stays in one piece."""
    lines = block("Warning", f"{text};" if mend else text, width)
    if not mend:
        return lines
    mend = mend if mend.startswith(VARY) else f"write {mend}"
    if len(lines[-1]) + len(mend) + 1 <= width:
        return [*lines[:-1], f"{lines[-1]} {mend}"]
    return [*lines, *([f"{'':{LABEL}}{mend}"] if LABEL + len(mend) <= width else block("", mend, width))]
