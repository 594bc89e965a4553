"""Data of a module for a page: limits with their state, variables at their ends, and every value."""

import math
from collections.abc import Collection, Mapping
from typing import Any

from tvimdesign.base.units import from_si
from tvimdesign.device import Table
from tvimdesign.report.output.numbers import in_labels, label, with_unit
from tvimdesign.report.output.tables import NOTHING, margin_text
from tvimdesign.solve.nlp.constraints import Constraint, constraints_of, in_words
from tvimdesign.solve.optimizer.verify_optimum import exceeded, kept
from tvimdesign.solve.result import ConstraintCheck
from tvimdesign.study import Study

_ROUNDING = 1e-6
"""Margin that is what a solver leaves of zero."""
Shown = dict[str, Any]
"""Plain data, as JSON has it."""


def shown_design(
    study: Study, free: Study, known: Mapping[str, Any], values: Mapping[str, float], active: Collection[str] = (),
    ends: Mapping[str, str] | None = None,
) -> Shown:  # fmt: skip
    """Return a module's values (SI, by full name) for the page; `free` is the study with its variables.

    `known` is what the study gives, `active` are the active limits, `ends` variables at an end of their range.
    """
    table = study.table
    return {
        "values": [_finite(from_si(values[name], table.unit(name))) for name in value_names(free)],
        "limits": limits_shown(study, known, values, active),
        "warnings": ratings_shown(study, values),
        "variables": {
            name: {"value": _finite(from_si(values[name], table.unit(name))), "end": (ends or {}).get(name, "")}
            for name in free.vary if name in values
        },
    }  # fmt: skip


def value_names(study: Study) -> list[str]:
    """Return the outputs whose values are shown, in the table's order."""
    seen = {row.name for row in study.table.first_oscillations}
    return [name for name in study.table.names(study.operating_points) if name.partition("@")[0] not in seen]


def limits_shown(
    study: Study, known: Mapping[str, Any], values: Mapping[str, float], active: Collection[str]
) -> list[Shown]:
    """Return every requirement and the active or violated rules, violated ones first.

    Of the limits that one requirement puts on several outputs, and that are met, the closest is shown.
    """
    stand = [
        (limit, _stands(limit, values[limit.output], study.table, limit.name in active))
        for limit in constraints_of(study, study.table, known)
    ]
    order = ("violated", "active", "met")
    stand.sort(key=lambda pair: (order.index(pair[1]), -float(pair[0].residual(values[pair[0].output]))))
    limits = [
        _limit(limit, values[limit.output], study.table, stands) for limit, stands in stand
        if limit.origin == "require" or stands != "met"
    ]  # fmt: skip
    first = {(row["of"], row["sense"]): row for row in reversed(limits)}
    return [row for row in limits if row["stands"] != "met" or first[row["of"], row["sense"]] is row]


def _stands(limit: Constraint, value: float, table: Table, presses: bool) -> str:
    if not kept(limit, value, table):
        return "violated"
    return "active" if presses or -float(limit.residual(value)) <= NOTHING else "met"


def _limit(limit: Constraint, value: float, table: Table, stands: str) -> Shown:
    margin = -float(limit.residual(value))
    check = ConstraintCheck(
        text=in_words(limit, table), output=limit.output, value=value, margin=margin, scale=limit.scale,
        absolute=limit.absolute, kept=stands != "violated", worst=margin, origin=limit.origin, part_of=limit.part_of,
    )  # fmt: skip
    unit = table.unit(limit.output)
    got = value if abs(margin) > _ROUNDING else limit.limit
    return {"name": limit.name, "label": label(limit.part_of or limit.output), "of": limit.part_of or limit.output,
            "sense": limit.sense, "text": in_labels(check.text),
            "got": with_unit(got, unit),
            "margin": margin_text(check, table), "stands": stands, "origin": limit.origin}  # fmt: skip


def ratings_shown(study: Study, values: Mapping[str, float]) -> list[Shown]:
    """Ratings that the module is beyond."""
    texts = [(in_labels(in_words(limit, study.table)), limit.output) for limit in exceeded(values, study.table)]
    return [{"text": text, "label": label(name), "accepted": name in study.accept} for text, name in texts]


def _finite(value: float) -> float | None:
    """Return a number for JSON; None for infinity, the time of what never happens."""
    return float(f"{value:.7g}") if math.isfinite(value) else None
