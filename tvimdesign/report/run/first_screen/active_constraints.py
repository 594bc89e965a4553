"""What holds a design back: the active constraints with the largest shadow prices; the yield, and what it cost."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tvimdesign.device import Table
from tvimdesign.report.run.first_screen.layout import LABEL, block, columns
from tvimdesign.report.run.why import binding
from tvimdesign.report.run.yield_words import cost_of_margins, reached_in_words, yield_of
from tvimdesign.solve.result import StudyResult

_NAMED = 3


def active_constraint_lines(answer: StudyResult, width: int) -> list[str]:
    """Three lines at most; what a share is of stands where there is place for it."""
    held = binding(answer)[:_NAMED]
    if not held:
        return []
    outputs = list(answer.design.study["minimize"])
    of = outputs[0] if len(outputs) == 1 else "the objective"
    for words in (f" of {of}", ""):
        rows = [(one.text, f"shadow price {one.shadow_price:.2g} %{words} per {one.step}") for one in held]
        lines = columns(rows)
        if LABEL + max(map(len, lines)) <= width:
            break
    else:
        lines = [f"{one.text}: {one.shadow_price:.2g} % per {one.step}" for one in held]
    return [f"{('Held back by' if i == 0 else ''):{LABEL}}{line}" for i, line in enumerate(lines)]


def yield_lines(answer: StudyResult, data: Mapping[str, Any], width: int, *, timed: bool) -> list[str]:
    """How many modules keep the limits, with what that covers and what raises it."""
    if not answer.found:
        return []
    if not data:
        return block("Yield", "not computed: `tvimdesign tolerate` says why", width)
    tolerances = "the study's tolerances" if data["tolerances"] == "study" else "the usual tolerances"
    share = data["parts_yield"]
    if share is None:
        none = block("Yield", f"no limit depends on what spreads under {tolerances}", width)
        return [*none, *_over_ranges(data, width)]
    low, high = (f"{100.0 * share[end]:.3g}" for end in ("low", "high"))
    said = f"{100.0 * share['share']:.3g} % ({low} to {high}) of modules keep the {data['limits']} limits"
    said = f"{said} that {tolerances} can move"
    if data["left_out"]:
        said += f"; {len(data['left_out'])} that never come in or follow a profile are not counted"
    if timed:
        said += f"; {data['modules']} drawn in {data['seconds']:.1f} s"
    lines = block("Yield", said, width)
    hint = _to_raise(answer, data)
    raised = block("", hint, width) if hint and share["share"] < _GOOD else []
    return [*lines, *raised, *_over_ranges(data, width)]


def _over_ranges(data: Mapping[str, Any], width: int) -> list[str]:
    """Apart from the yield: in how much of the ranges of what nobody has measured the limits are kept."""
    holds = data["ranges_hold"]
    if holds is None:
        return []
    count = len(data["unmeasured"])
    said = f"the limits hold in {100.0 * holds['share']:.3g} % of the ranges of {count} values nobody has measured"
    if data["held"]:
        limit, share = next(iter(data["held"].items()))
        said += f", least {limit.split()[0]} in {100.0 * share:.3g} %"
    return block("Not known", said, width)


_GOOD = 0.9973
"""Yield from which a module is no concern: three standard deviations to either side."""


def _to_raise(answer: StudyResult, data: Mapping[str, Any]) -> str:
    """What to write in the study for a higher yield; nothing where one is asked for, which `margin_lines` tell of."""
    robust = answer.design.study.get("robust")
    if answer.solution is None:
        return "which limit loses most: `tvimdesign tolerate`"
    if robust and robust.get("share") is not None:
        return ""
    tolerances = "" if data["tolerances"] == "study" else "`tolerances: standard` and "
    return f"to raise it: {tolerances}`robust: {{yield: 95 %}}`"


def margin_lines(answer: StudyResult, table: Table, width: int) -> list[str]:
    """Where a yield is asked for: whether it is reached, and what the margins cost in what is minimised."""
    reached = yield_of(answer)
    if reached is None:
        return []
    cost = ", ".join(cost_of_margins(answer, reached, table))
    return block("Margins", f"{reached_in_words(reached)}; the margins cost {cost}", width)
