"""A yield that was asked for, in words: what is reached, what the margins cost, and what stands in its way."""

from __future__ import annotations

import math
from collections.abc import Mapping

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Table
from tvimdesign.report.output.progress import duration
from tvimdesign.report.output.tables import number, percent
from tvimdesign.solve.nlp.solution import LostTo, YieldReached
from tvimdesign.solve.nlp.solver_run import BELOW_YIELD
from tvimdesign.solve.result import StudyResult

_DIGITS = 3
_CARRIED = 0.05
"""Share of a limit's variance from which a tolerance is named."""


def yield_of(answer: StudyResult) -> YieldReached | None:
    """Return the account of a yield that the study asks for; None without a design or without one asked for."""
    return answer.solution.yield_reached if answer.solution and answer.found else None


def reached_in_words(reached: YieldReached) -> str:
    """Return the yield of modules, its target, and its value without margins."""
    return (
        f"yield {percent(reached.together)} of {reached.modules} random modules (target {percent(reached.asked)}); "
        f"without margins {percent(reached.nominal_together)}"
    )


def cost_of_margins(answer: StudyResult, reached: YieldReached, table: Table) -> list[str]:
    """Return what each minimised output is without the margins, and with them."""
    return _changes(answer, reached.nominal, answer.design.values, table)


def gain_without_margins(
    answer: StudyResult, constant: Mapping[str, float], reached: YieldReached, table: Table
) -> list[str]:
    """Return what each minimised output is with the best constant currents, and with those that follow a profile."""
    return _changes(answer, constant, reached.nominal, table)


def _changes(answer: StudyResult, before: Mapping[str, float], after: Mapping[str, float], table: Table) -> list[str]:
    return [_change(name, before[name], after[name], table) for name in answer.design.study["minimize"]]


def below_yield(answer: StudyResult) -> str:
    """Report a design that fewer modules satisfy than asked: which limits, by which tolerance; else empty."""
    reached, limit = yield_of(answer), answer.solution.out_of_time if answer.solution else None
    if answer.design.status != BELOW_YIELD or not answer.found:
        return ""
    if limit is not None or reached is None:
        return _not_in_time(answer, reached, limit)
    lines = [
        f"{answer.design.name}: no design found that {percent(reached.asked)} of the modules keep; "
        f"of the best {percent(reached.together)} do. Most is lost to"
    ]
    lines += [f"  {lost_in_words(loss)}" for loss in reached.lost_to]
    lines.append("Ease these limits, widen a range under `vary`, tighten these tolerances, or ask `robust` for less.")
    return "\n".join(lines)


def _not_in_time(answer: StudyResult, reached: YieldReached | None, limit: float | None) -> str:
    """Report a design whose margins the time limit cut short."""
    limited = "" if limit is None else f" of {duration(limit)}"
    ended = f"the time limit{limited} ended the search before it had all margins against spread"
    sentence = "how many modules satisfy every limit is not known"
    if reached is not None:
        sentence = (
            f"{percent(reached.together)} of the modules satisfy every limit so far, {percent(reached.asked)} are asked"
        )
    return f"{answer.design.name}: {ended}; {sentence}. Raise `solver.time_limit` (or --time-limit)."


def lost_in_words(lost: LostTo) -> str:
    """Return a limit that too many modules break, and the tolerances that carry its spread."""
    named = [f"{name} {percent(share, 2)}" for name, share in lost.carriers.items() if share >= _CARRIED]
    return f"{lost.text}, which {percent(lost.share)} keep{'; its spread is of ' if named else ''}{', '.join(named)}"


def _change(name: str, before: float, after: float, table: Table) -> str:
    unit = table.unit(name)
    change = (
        f"{name} {number(from_si(before, unit), _DIGITS)} to {number(from_si(after, unit), _DIGITS)} {pretty(unit)}"
    )
    if not (math.isfinite(before) and math.isfinite(after) and before):
        return change.rstrip()
    return f"{change.rstrip()} ({100.0 * (after / before - 1.0):+.2g} %)"
