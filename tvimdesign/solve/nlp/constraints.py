"""The limits a design must keep: the study's requirements and the machine's own rules, in one list."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import format_quantity, from_si, pretty, to_si
from tvimdesign.device import Choice, Input, Output, Table
from tvimdesign.device.table.quantity import Feature, Rule
from tvimdesign.study import Range, Study, brought_along_by, given, missing_geometry

ALGEBRAIC_TOLERANCE = 1e-6
"""Share of its scale by which a limit without simulation may be violated: the solver's tolerance with a margin."""


@dataclass(frozen=True)
class Constraint:
    """One named limit on one output, SI."""

    output: str
    sense: Literal["<=", ">="]
    limit: float
    scale: float  # Size of a residual of one: the limit itself, or a hundred steps where it has no size
    origin: str  # `require` for the study's own, otherwise the reason the machine has it
    step: str = "1 %"  # A hundredth of the scale, in words
    absolute: bool = False  # True if the limit has no size of its own, so that distances from it are in its unit
    part_of: str = ""
    """The output a requirement names that is put on several at once, which move together: `spring_stiffness`, which is
    limited over the stroke, or `holding_torque`, the least of several."""

    @property
    def name(self) -> str:
        """Output and sense, unique in a study."""
        return f"{self.output} {self.sense}"

    def residual(self, value: Any) -> Any:
        """Return the violation of a limit as a share of its scale, satisfied if <= 0. Accept floats and symbols."""
        beyond = value - self.limit if self.sense == "<=" else self.limit - value
        return beyond / self.scale

    def keeps(self, value: Any) -> Any:
        """Return whether values satisfy the limit; an active one has the solver's tolerance."""
        return self.residual(value) <= ALGEBRAIC_TOLERANCE


def constraints_of(study: Study, table: Table, chosen: Mapping[str, Any]) -> list[Constraint]:
    """Return the study's requirements, then the table's rules the study has not replaced by its own in that sense.

    `chosen` are records and options by name, so that rules of what the module lacks are left out.
    """
    known = [row for row in table.choices if row.name in chosen or row.name not in study.vary]
    options = {row.name: chosen.get(row.name, row.default) for row in known}
    stated = {(r.output, r.sense) for r in study.require}
    required = [
        replace(
            make_constraint(table, output, r.sense, r.limit, "require"),
            part_of=r.output if study.limited_with(r.output) or study.table.output(r.output).least_of else "",
        )
        for r in study.require
        for output in _rows_of(study, r.output, r.sense, options)
        if output != table.output(r.output).at_end or (output, r.sense) not in stated
    ]
    own = list(dict.fromkeys(required))
    taken = {(limit.output, limit.sense) for limit in own}
    for row in table.outputs:
        for rule in row.rules if row.rules and row.exists(options) else ():
            if (row.name, rule.sense) not in taken:
                own.append(make_constraint(table, row.name, rule.sense, rule.value, rule.reason))
    return own


def _rows_of(study: Study, name: str, sense: str, options: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the rows of a limit: the named one, those limited with it, or those whose least it is."""
    table, row = study.table, study.table.output(name)
    parts = tuple(part for part in row.least_of if table.output(part).exists(options))
    rows = parts if parts and sense == ">=" else (name, *study.limited_with(name))
    apart = row.parts_differ_with
    alike = apart is not None and options.get(apart.choice) == apart.without
    return rows[:1] if alike else rows


def on_cycle(table: Table, output: str) -> bool:
    """Return whether an output depends on how a switch runs."""
    return output.partition("@")[0] in table.behind_supplied


def unchangeable(limit: Constraint, table: Table, value: float, study: Study) -> str:
    """Say of a limit that is violated by a value and stands on nothing free what could be freed.

    A change is named if with it the limit is met, and all others that depend on no cycle and are met at the start.
    """
    is_now = format_quantity(value, table.output(limit.output).unit)
    behind = [row for row in table.inputs if row.name in table.ancestors(limit.output)]
    brought = brought_along_by(study)
    variable = [row for row in behind if row.variable and row.name not in brought and not row.per_point]
    start = given(study)

    def satisfied(values: Mapping[str, Any], limits: Sequence[Constraint]) -> list[bool]:
        outputs = table.evaluate(values, list(dict.fromkeys(each.output for each in limits)))
        return [bool(each.residual(float(outputs[each.output])) <= ALGEBRAIC_TOLERANCE) for each in limits]

    def satisfies(values: Mapping[str, Any]) -> bool:
        return all(satisfied(values, [limit])) and all(satisfied(values, met))

    with np.errstate(invalid="ignore", divide="ignore"):
        arithmetic = [each for each in constraints_of(study, table, start) if not on_cycle(table, each.output)]
        met = [each for each, holds in zip(arithmetic, satisfied(start, arithmetic), strict=True) if holds]
        cures = _cures(study, start, variable, satisfies)
    enough = f"one of these is enough: {', '.join(cures)}" if cures else ""
    if bought := sorted({brought[row.name] for row in behind if row.name in brought}):
        ways = " or ".join(filter(None, [f"choose another `{'`, `'.join(bought)}`", enough]))
    elif variable:
        names = ", ".join(row.name for row in variable[:_INPUTS_NAMED])
        ways = enough or f"no single input cures it: change several of {names}"
    else:
        fixed = [row.name for row in behind if row.record is None] or [row.name for row in behind]
        ways = f"change under `module`: {', '.join(fixed[:_INPUTS_NAMED])}"
    is_now += "" if limit.origin == "require" else f"; {limit.origin}"
    return f"{in_words(limit, table)} does not hold (it is {is_now}), and nothing under `vary` can change it; {ways}"


def refuse_impossible(study: Study) -> None:
    """Raise InputError, naming what is wrong, where a study's start is no geometry and nothing can be said of it."""
    table, start = study.table, given(study)
    bad = [row.name for row in missing_geometry(start, table)]
    if bad:
        with np.errstate(invalid="ignore", divide="ignore"):
            reasons = impossible({**dict.fromkeys(table.by_name, math.inf), **table.evaluate(start, bad)}, table)
        behind = _behind(study, bad)
        cures = _cures(study, start, behind, lambda values: not missing_geometry(values, table))
        ways = f"One of these is enough: {', '.join(cures)}." if cures else "No single input cures it: change several."
        listed = "".join(f"\n  {reason}" for reason in reasons)
        raise InputError(f"there is no such module:{listed}\n{_clashing(study, start, behind)}{ways}")
    refuse_contradictory(study, start)


def _behind(study: Study, outputs: Sequence[str]) -> list[Input]:
    """Return the lengths, angles and counts behind some outputs, those that the study sets first."""
    names = set().union(*(study.table.ancestors(name) for name in outputs))
    inputs = [row for row in study.table.inputs if row.name in names and row.variable and not row.per_point]
    return sorted(inputs, key=lambda row: not (row.name in study.module or row.name in study.vary))


def _clashing(study: Study, start: Mapping[str, Any], behind: Sequence[Input]) -> str:
    shown = [
        f"{row.name} {format_quantity(start[row.name], row.unit)}"
        + ("" if row.name in study.module or row.name in study.vary else " (default)")
        for row in behind[:_CLASHING]
    ]
    return f"It follows from {', '.join(shown)}.\n" if shown else ""


def _cures(
    study: Study, start: Mapping[str, Any], behind: Sequence[Input], satisfied: Callable[[Mapping[str, Any]], bool]
) -> list[str]:
    """Return changes of one input each after which values are as they must be; each was tried."""
    cures = []
    for row in behind:
        value = float(start[row.name])
        allowed = study.vary.get(row.name)
        low, high = (allowed.lower, allowed.upper) if isinstance(allowed, Range) else (row.lower, row.upper)
        tries = [factor * (value or _SMALL * row.upper) for factor in _FACTORS]
        tries = [tried for tried in tries if row.lower <= tried <= row.upper]
        for tried in sorted(tries, key=lambda number: (not low <= number <= high, abs(number - value))):
            if satisfied({**start, row.name: tried}):
                beyond = "" if low <= tried <= high else " (beyond its range)"
                now = format_quantity(value, row.unit)
                cures.append(f"{row.name} {format_quantity(tried, row.unit, 3)} in place of {now}{beyond}")
                break
    return cures[:_CLASHING]


def refuse_contradictory(study: Study, start: Mapping[str, Any]) -> None:
    """Raise InputError for what a study sets to no effect, and for targets beyond what the joint can have."""
    _refuse_idle(study, study.table, start)
    _refuse_unreached(study)
    if not study.vary:
        _refuse_unreachable(start, study.table)


def _refuse_idle(study: Study, table: Table, start: Mapping[str, Any]) -> None:
    """Raise InputError for what the study sets to no effect, as the module lacks what it is of."""
    stated: list[Choice | Input] = [*table.choices, *table.inputs]
    stated = [row for row in stated if row.name in study.module or row.name in study.vary]
    for choice in table.choices:
        lacking = Feature(choice.name, start[choice.name])
        idle = [row.name for row in stated if lacking in row.requires]
        source = choice.record[0] if choice.record else choice.name
        if not idle or {choice.name, source} & study.vary.keys():
            continue
        without = {feature.without for row in stated if row.name in idle for feature in row.requires}
        others = [word for word in choice.options if word not in without]
        way = "name one of its records" if choice.category else f"add `{choice.name}: {others[0]}`"
        raise InputError(f"{', '.join(idle)}: no effect, as {choice.name} is {lacking.without}; {way} under `module`")


def _refuse_unreached(study: Study) -> None:
    """Raise InputError for limits at a molten point that the layer may never reach."""
    table, points = study.table, study.operating_points
    for name in dict.fromkeys(limit.output for limit in study.require):
        base, _, point = name.partition("@")
        if not point or study.reaches(point) or "temperature" not in table.ancestors(base):
            continue
        molten = points[point]["temperature"] >= points["hot"]["temperature"]
        if molten and not (table.output(base).at_end and point == "hot"):
            others = " or ".join(f"{row.name}@hot" for row in table.outputs if row.per_point and row.at_end)
            kelvin = format_quantity(points[point]["temperature"], "degC")
            raise InputError(
                f"require.{name}: heating may end before the layer is at {point!r}, {kelvin}; write `module: "
                f"{{response_criterion: far_face, target_temperature: {kelvin}}}`, or limit {others}, which count "
                "where heating ends, too"
            )


def _refuse_unreachable(start: Mapping[str, Any], table: Table) -> None:
    """Raise InputError where a stated target impedance lies outside what the joint can have."""
    if start.get("impedance_targets") != "stated":
        return
    ends = table.evaluate(start, ["joint_impedance@hot", "joint_impedance@cold", "soft_reach", "stiff_reach"])
    soft, stiff = (format_quantity(ends[f"joint_impedance@{point}"], "N*m/rad") for point in ("hot", "cold"))
    bad = [name for name in ("soft", "stiff") if ends[f"{name}_reach"] < 0.0]
    if bad:
        named = ", ".join(f"{name}_impedance {format_quantity(start[f'{name}_impedance'], 'N*m/rad')}" for name in bad)
        raise InputError(
            f"{named} cannot be reached: this joint goes from {soft} hot to {stiff} cold; a target may be the band "
            f"(softening_band, stiffening_band) beyond that, no more"
        )


def impossible(values: Mapping[str, float], table: Table) -> list[str]:
    """Say where the numbers of a design are no geometry at all: `arc_width is -7 mm, it must be above 0`."""
    reasons = []
    for row in table.outputs:
        for rule in row.rules:
            if rule.exists_above is not None and not values[row.name] > rule.exists_above:
                shown = (round(float(values[row.name]), 12) + 0.0, rule.exists_above)  # without what is rounding
                value, least = (format_quantity(number, row.unit) for number in shown)
                above = sorted(table.ancestors(row.name))
                inputs = [name for name in above if isinstance(table.quantity(name), Input)][:_INPUTS_NAMED]
                reasons.append(
                    f"{row.name} is {value}, it must be above {least}: {row.description}; it follows from "
                    + ", ".join(inputs)
                )
    return reasons


def advice_of(table: Table) -> list[Constraint]:
    """Return the limits that are reported where they are broken."""
    return _reported(table, lambda row: row.advice)


def ratings_of(table: Table) -> list[Constraint]:
    """Return what materials and bought parts are rated for: no optimum is beyond one that the study does not accept."""
    return _reported(table, lambda row: row.ratings)


def _reported(table: Table, rules: Callable[[Output], tuple[Rule, ...]]) -> list[Constraint]:
    return [
        make_constraint(table, row.name, rule.sense, rule.value, rule.reason)
        for row in table.outputs
        for rule in rules(row)
    ]


_INPUTS_NAMED = 6
_CLASHING = 8  # Inputs that are named where a module is no geometry
_FACTORS = (0.9, 1.1, 0.75, 1.35, 0.5, 2.0, 0.3, 3.0)  # Factors on an input that are tried as a cure
_SMALL = 0.05  # Share of its largest value that those factors apply to where an input is zero
_STEPS = {"mm": 0.1, "K": 1.0, "degC": 1.0, "s": 1.0}
"""What people relax a limit by that has no size of its own, in its unit; a hundredth of the unit elsewhere."""


def make_constraint(table: Table, name: str, sense: Literal["<=", ">="], limit: float, origin: str) -> Constraint:
    """Return a limit with its scale: its own size, or a hundred steps where it is zero or a temperature."""
    unit = table.unit(name)
    if limit != 0.0 and unit != "degC":
        return Constraint(name, sense, limit, abs(limit), origin)
    step = _STEPS.get(unit, 0.01)
    of_difference = "K" if unit == "degC" else unit
    scale = 100.0 * to_si(step, of_difference)
    return Constraint(name, sense, limit, scale, origin, f"{step:g} {pretty(of_difference)}".rstrip(), absolute=True)


def in_words(limit: Constraint, table: Table) -> str:
    """Write the limit as a reader would: `joint_stiffness@hot >= 5 N·m/rad`."""
    unit = table.unit(limit.output)
    return f"{limit.output} {limit.sense} {from_si(limit.limit, unit):.6g} {pretty(unit)}".rstrip()
