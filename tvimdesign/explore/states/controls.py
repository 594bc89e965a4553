"""The controls of a page: what a study varies, fixes, requires and weighs, with units, limits and what they mean."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Choice, Input
from tvimdesign.explore.states.state import State, text_of
from tvimdesign.study import Options, Study, given
from tvimdesign.study.resolve import words_of
from tvimdesign.study.text.values import exactly

Shown = dict[str, Any]


def controls_shown(free: Study, fixed: Study, state: State) -> Shown:
    """Return every control; `free` is the study with free variables, `fixed` that of the module as set."""
    values = given(fixed)
    return {
        "variables": [_variable(name, free, state) for name in free.vary],
        "requirements": _requirements(free),
        "weights": [{"name": name, "value": weight, "means": _means(free, name)}
                    for name, weight in free.minimize.items()],
        "choices": [_choice(row, fixed, values[row.name]) for row in free.table.choices if row.name not in free.vary],
        "inputs": _inputs(free, fixed, values),
    }  # fmt: skip


def _variable(name: str, free: Study, state: State) -> Shown:
    row, vary = free.table.quantity(name), free.vary[name]
    shown: Shown = {"name": name, "means": row.description, "text": state.at[name]}
    if isinstance(vary, Options):
        return {**shown, "options": [text_of(free, name, value) for value in vary.values]}
    unit = free.table.unit(name)
    low, high = (from_si(end, unit) for end in (vary.lower, vary.upper))
    return {**shown, "unit": pretty(unit), "low": low, "high": high, "low_text": exactly(vary.lower, unit),
            "high_text": exactly(vary.upper, unit)}  # fmt: skip


def _requirements(free: Study) -> list[Shown]:
    """Return a control for each limit; those of one output know their place in its list."""
    seen: dict[str, int] = {}
    controls = []
    for limit in free.require:
        unit = free.table.unit(limit.output)
        place = seen[limit.output] = seen.get(limit.output, -1) + 1
        controls.append({
            "name": limit.output, "place": place, "sense": limit.sense, "value": from_si(limit.limit, unit),
            "unit": pretty(unit), "text": exactly(limit.limit, unit), "means": _means(free, limit.output),
        })  # fmt: skip
    return controls


def _choice(row: Choice, fixed: Study, value: Any) -> Shown:
    options = list(dict.fromkeys([*words_of(row), *(fixed.catalog.names(row.category) if row.category else [])]))
    return {"name": row.name, "means": row.description, "text": str(getattr(value, "name", value)), "options": options,
            "said": row.name in fixed.module}  # fmt: skip


def _inputs(free: Study, fixed: Study, values: Mapping[str, Any]) -> list[Shown]:
    """Numbers that are not varied; those the study sets first. A temperature of a point is `temperature@hot`."""
    controls = []
    for row in free.table.inputs:
        if row.name in free.vary:
            continue
        names = [f"{row.name}@{point}" for point in free.operating_points] if row.per_point else [row.name]
        controls += [_input(row, name, values[name], fixed) for name in names]
    return sorted(controls, key=lambda control: not control["said"])


def _input(row: Input, name: str, value: float, fixed: Study) -> Shown:
    """Return an input's control; its slider goes from half to twice the value, within the limits of the table."""
    unit = fixed.table.unit(row.name)
    low, high = max(row.lower, min(0.5 * value, 2.0 * value)), min(row.upper, max(0.5 * value, 2.0 * value))
    if unit == "degC":
        low, high = max(row.lower, value - 30.0), min(row.upper, value + 30.0)
    slides = math.isfinite(low) and math.isfinite(high) and low < high and not row.integer
    ends = {"low": from_si(low, unit), "high": from_si(high, unit)} if slides else {}
    return {"name": name, "means": row.description, "group": row.group, "unit": pretty(unit), **ends,
            "text": exactly(value, unit), "said": row.name in fixed.module or "@" in name}  # fmt: skip


def _means(study: Study, name: str) -> str:
    return study.table.output(name.partition("@")[0]).description
