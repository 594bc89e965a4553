"""What the figure of bounds and margins is drawn from: what varies between its bounds, limits by unit of margin."""

from __future__ import annotations

import math
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Table
from tvimdesign.report.output.axis_labels import name_in_words
from tvimdesign.report.output.tables import NOTHING, margin_of
from tvimdesign.solve.result import ConstraintCheck, StudyResult

_NEAR = 0.25
"""Margin below which a rule of the machine is worth a bar."""
_SHARE = "%"
_ENDLESS = 1e9
"""What stands for a margin that is infinite: a bar ends long before."""


def free_rows(answer: StudyResult, table: Table) -> list[dict[str, Any]]:
    """Every free variable: where it began and where it is, as shares of its range; none where nothing varies."""
    if answer.solution is None:
        return []
    rows = []
    for name, begin in answer.solution.starts[0].begin.items():
        vary, value = answer.design.study["vary"][name], answer.design.value(name)
        lower, upper = (vary["lower"], vary["upper"]) if "lower" in vary else (min(vary["values"]), max(vary["values"]))
        width = (upper - lower) or 1.0
        unit = table.unit(name)
        low, high = (f"{from_si(end, unit):.4g}" for end in (lower, upper))
        text = f"{from_si(value, unit):.4g} {pretty(unit)}".rstrip() + f"  ({low} to {high})"
        share, start = (value - lower) / width, (begin - lower) / width
        rows.append({"name": name_in_words(name), "share": share, "start": start, "text": text})
    return rows


def margin_groups(answer: StudyResult, table: Table) -> list[dict[str, Any]]:
    """The study's limits, the machine's where they are near, and the advice the design does not follow.

    A limit that has a size of its own is drawn in percent of it, one that has none in its quantity's unit.
    """
    near = [check for check in answer.checks if check.origin == "require" or check.margin < _NEAR]
    groups: dict[str, list[dict[str, Any]]] = {}
    for check in (*near, *answer.warnings):
        unit = _unit(check, table)
        groups.setdefault(unit, []).append(_row(check, unit, table, advice=check not in answer.checks))
    return [
        {
            "unit": unit,
            "title": "What must hold" if unit == _SHARE else f"What must hold, where the limit is 0 {unit}".rstrip(),
            "label": "Margin, of the limit (%)" if unit == _SHARE else f"Margin ({unit or '–'})",
            "rows": rows,
        }
        for unit, rows in sorted(groups.items(), key=lambda item: item[0] != _SHARE)
    ]


def _unit(check: ConstraintCheck, table: Table) -> str:
    return pretty(margin_of(check, table)[1]) if check.absolute else _SHARE


def _row(check: ConstraintCheck, unit: str, table: Table, *, advice: bool) -> dict[str, Any]:
    margin = check.margin if abs(check.margin) > NOTHING else 0.0
    own = table.unit(check.output)
    own = "K" if own == "degC" else own
    kind = "advice" if advice else "broken" if not check.kept else "kept" if margin else "binds"
    finite = math.isfinite(margin)
    size = (100.0 if unit == _SHARE else from_si(check.scale, own)) if finite else 0.0
    text = (
        f"{from_si(margin * check.scale, own):+.3g} {pretty(own)}".rstrip()
        if finite
        else "never"
        if margin < 0.0
        else "ample"
    )
    words = check.text.replace(check.output, name_in_words(check.output), 1).replace(">=", "≥").replace("<=", "≤")
    drawn = margin * size if finite else math.copysign(_ENDLESS, margin)
    text = text.replace("-", "−") if margin else f"0 {pretty(own)}"
    return {"name": words, "margin": drawn, "finite": finite, "kind": kind, "text": text}
