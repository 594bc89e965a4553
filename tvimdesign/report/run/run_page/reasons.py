"""The sections on why: what holds a design back, and the assumptions it rests on with what each of them moves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tvimdesign.page.blocks import Block, Points, Section, Words
from tvimdesign.report.output.page_sections import grid, grid_of
from tvimdesign.report.output.tables import number
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.first_screen.requirements import may_be
from tvimdesign.report.run.summary_tables import assumptions_table, intervals_table, prices_table
from tvimdesign.report.run.why import sentences, slack_in_words

_MOVES = 0.02
"""Share of an output's variance from which an input is said to move it."""
_NAMED = 4


def reasons_section(answered: AnsweredStudy) -> Section:
    """The active constraints in words, with what easing each would buy."""
    answer = answered.result
    said = sentences(answer)
    if answer.solution is None:
        blocks: list[Block] = [Words(["The study varies nothing, so nothing is traded: its one module was evaluated."])]
    elif not said:
        blocks = [Words(["No limit holds the design back: easing any of them changes nothing."])]
    else:
        blocks = [Points(said), grid_of(prices_table(answer))]
    slack = slack_in_words(answer, answered.study.table)
    return Section("why", "What holds it back", [*blocks, *([Words([slack])] if slack else [])])


def assumptions_section(answered: AnsweredStudy, uncertainty: Mapping[str, Any]) -> Section:
    """Every input that nobody has measured with its range and what it moves; then what each output may be."""
    if not uncertainty:
        words = "How sure the design is was not computed in this run; `tvimdesign tolerate` computes it."
        return Section("assumptions", "Assumptions", [Words([words])])
    intervals = uncertainty["intervals"]
    values = answered.reported["values"]
    moved = {one["name"]: moves(one["name"], intervals) for one in uncertainty["unmeasured"]}
    order = sorted(
        uncertainty["unmeasured"], key=lambda one: -max((share for _, share in moved[one["name"]]), default=0)
    )
    rows = [
        (one["name"], number(one["value"]), may_be(one), one["unit"], one["status"],
         ", ".join(f"{output} {100.0 * share:.0f} %" for output, share in moved[one["name"]][:_NAMED]),
         values[one["name"]]["source"])
        for one in order
    ]  # fmt: skip
    heads = ("input", "value", "range", "unit", "status", "share of what it moves", "source")
    note = (
        "A share is the part of an output's variance that knowing the input would take away, all inputs anywhere in "
        "their ranges."
    )
    inputs = grid("Inputs that nobody has measured", heads, rows, right=(1,), note=note)
    held = _held(uncertainty)
    ends = grid_of(assumptions_table(uncertainty.get("assumptions", {})))
    outputs = grid_of(intervals_table(intervals), code=(0, 6))
    return Section("assumptions", "Assumptions", [inputs, outputs, *([ends] if ends.rows else []), *held])


def moves(name: str, intervals: Mapping[str, Any]) -> list[tuple[str, float]]:
    """The outputs an input moves, with its share of each one's variance, the largest first."""
    found = [(output, one["shares"].get(name, 0.0)) for output, one in intervals.items()]
    return sorted([(output, share) for output, share in found if share >= _MOVES], key=lambda one: -one[1])


def _held(uncertainty: Mapping[str, Any]) -> list[Block]:
    """Limits that do not hold over all ranges."""
    rows = [(limit, f"{100.0 * share:.3g} %") for limit, share in uncertainty["held"].items()]
    title = "Limits that hold in a part of the ranges only"
    return [grid(title, ("limit", "holds in"), rows, right=(1,))] if rows else []
