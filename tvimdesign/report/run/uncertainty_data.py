"""The uncertainty of a design as plain data: what varies from part to part, and what is unmeasured.

A yield that was asked for, in words: what is reached, what the margins cost, and what stands in its way.
"""

import math
import os
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.units import from_si, pretty
from tvimdesign.report.output.numbers import in_unit, label, number, number_entry, percent, with_unit
from tvimdesign.report.output.terminal import duration
from tvimdesign.solve.nlp.solver_run import BELOW_YIELD
from tvimdesign.solve.result import StudyResult
from tvimdesign.solve.uncertainty.design_uncertainty import DRAWS, uncertainty_at
from tvimdesign.study import Design, Study
from tvimdesign.study.text.values import difference_unit

_SPREAD = "TVIMDESIGN_SPREAD"
"""Variable of the environment: `off` leaves yield and ranges out, where many runs share few processors."""
MODULES = 1 << 12  # Modules drawn for the yield
FIRST_SCREEN = (
    "module_mass", "envelope_diameter", "envelope_height", "envelope_volume", "softening_time", "stiffening_time",
    "softened_stiffness", "softened_damping", "softened_impedance", "softened_temperature",
    "joint_stiffness_at_link@cold", "joint_stiffness_in_play", "creep_stiffness", "frozen_time",
    "lost_motion", "lost_motion_share", "friction_torque", "friction_share", "drag_torque",
    "peak_voltage", "stiffening_peak_voltage", "peak_current", "stiffening_peak_current", "peak_power",
    "switch_energy", "cycle_energy",
)  # fmt: skip
"""Outputs that the first screen shows of every module that has them."""


def uncertainty_data(
    study: Study, design: Design, modules: int = MODULES, deadline: Deadline = NEVER
) -> dict[str, Any]:
    """Return a design's entry for results.json, with what the screen names beside it.

    `modules` is a power of two; without modules there is no yield. Raises TimeOverError at the deadline.
    """
    table = study.table
    shown = [name for name in FIRST_SCREEN if name.partition("@")[0] in table.by_name]
    uncertainty = uncertainty_at(design, study, shown, modules, deadline)
    intervals = {}
    for name, interval in uncertainty.intervals.items():
        unit, before = table.unit(name), uncertainty.before.get(name)
        intervals[name] = {
            **number_entry(interval.nominal, unit, (interval.low, interval.high)),
            "one_at_a_time": number_entry(interval.nominal, unit, interval.one_at_a_time),
            "shares": interval.shares,
            "to_halve": list(interval.to_halve),
            "before": None if before is None else number_entry(interval.nominal, unit, before),
        }
    need = uncertainty.need
    needs = f"{label(need.input)} {need.sense} {with_unit(need.end, table.unit(need.input), 3)}" if need else ""
    return {
        "parts_yield": uncertainty.together and asdict(uncertainty.together),
        "modules": modules,
        "limits": uncertainty.limits,
        "left_out": list(uncertainty.left_out),
        "tolerances": "study" if study.tolerances else "standard",
        "ranges_hold": uncertainty.holds and asdict(uncertainty.holds),
        "draws": DRAWS,
        "held": uncertainty.held,
        "intervals": intervals,
        "unmeasured": [
            {
                "name": moved.name,
                **number_entry(moved.value, table.unit(moved.name), (moved.low, moved.high)),
                "status": moved.status,
            }
            for moved in uncertainty.unmeasured
        ],
        "needs": needs,
    }


def uncertainty_of(answer: StudyResult, study: Study, deadline: Deadline = NEVER) -> dict[str, Any]:
    """Return yield and intervals of an answer; a yield that its study asks for is known from the search.

    Empty without a design, or where they are left out. Raises TimeOverError.
    """
    if os.environ.get(_SPREAD) == "off" or not answer.has_design:
        return {}
    reached = answer.yield_reached
    data = uncertainty_data(study, answer.design, 0 if reached else MODULES, deadline)
    return data | ({"parts_yield": asdict(reached.share), "modules": reached.modules} if reached else {})


_DIGITS = 3
_CARRIED = 0.05  # Share of a limit's variance from which a tolerance is named


def changes(answer: StudyResult, before: Mapping[str, float], after: Mapping[str, float]) -> list[str]:
    """Return what each minimised output is before a change, such as margins, and after it."""
    texts = []
    for name in answer.design.study["minimize"]:
        unit, old, new = answer.design.table.unit(name), before[name], after[name]
        change = f"{label(name)} from {in_unit(old, unit, _DIGITS)} to {with_unit(new, unit, _DIGITS)}".rstrip()
        known = math.isfinite(old) and math.isfinite(new) and old
        texts.append(f"{change} ({100.0 * (new / old - 1.0):+.2g} %)" if known else change)
    return texts


def below_yield(answer: StudyResult) -> str:
    """Report a design that fewer modules satisfy than asked: which limits, by which tolerance; else empty."""
    reached, limit = answer.yield_reached, answer.solution.out_of_time if answer.solution else None
    if answer.design.status != BELOW_YIELD or not answer.has_design:
        return ""
    if limit is not None or reached is None:
        return _not_in_time(answer, limit)
    lines = [
        f"{answer.design.name}: no design found with a yield of {percent(reached.target)}; "
        f"the best has {percent(reached.together)}. Most modules are lost to"
    ]
    lines += [f"  {loss}" for loss in lost_in_words(answer)]
    lines += [f"{way[0].upper()}{way[1:]}." for way in lever(answer)]
    lines.append("Ease these limits, widen a range under `vary`, or tighten these tolerances.")
    return "\n".join(lines)


def lever(answer: StudyResult) -> list[str]:
    """Return the tolerance to tighten and the requirement to ease, each alone, for the yield; nothing if reached."""
    reached, table = answer.yield_reached, answer.design.table
    if reached is None or reached.tightened is None:
        return []
    tolerance, eased, target = reached.tightened, reached.eased, percent(reached.target)
    ways = []
    if eased is not None:
        output, sense, limit = eased.text.split(" ", 2)
        unit = table.unit(output)
        value = from_si(eased.to, unit)
        step = 10.0 ** (math.floor(math.log10(abs(value) or 1.0)) - 2)
        steps = round(value / step, 6)  # then towards what is easier
        to = step * (math.ceil(steps) if sense == "<=" else math.floor(steps))
        words = f"{label(output)} {sense} {number(to, _DIGITS)} {pretty(unit)}".rstrip()
        ways.append(f"other sizes give {target} if {words} ({limit} asked)")
    unit, of = difference_unit(table.unit(tolerance.name)), label(tolerance.name)
    now, within = (with_unit(size, unit, 2) for size in (tolerance.plus_minus, tolerance.to))
    if tolerance.to > 0.0:
        return [*ways, f"at these sizes {of} within about ±{within}, not ±{now}, gives {target}"]
    without = f"{of} without its ±{now} gives {percent(tolerance.share)}"
    return [*ways, f"at these sizes no tolerance alone gives {target}: {without}"]


def _not_in_time(answer: StudyResult, limit: float | None) -> str:
    """Report a design whose margins the time limit cut short."""
    limited = "" if limit is None else f" of {duration(limit)}"
    ended = f"the time limit{limited} ended the search before it had all margins against spread"
    sentence = "how many modules satisfy every limit is not known"
    if reached := answer.yield_reached:
        share, target = percent(reached.together), percent(reached.target)
        sentence = f"{share} of the modules satisfy every limit so far, {target} are asked"
    return f"{answer.design.name}: {ended}; {sentence}. Raise `solver.time_limit` (or --time-limit)."


def lost_in_words(answer: StudyResult) -> list[str]:
    """Return the limits that too many modules violate, each with the tolerances that carry its spread."""
    texts = []
    for lost in answer.yield_reached.lost_to if answer.yield_reached else ():
        named = [f"{name} ({100.0 * share:.0f} %)" for name, share in lost.carriers.items() if share >= _CARRIED]
        texts.append(f"{lost.text}, met by {percent(lost.share)}{', spread by ' if named else ''}{', '.join(named)}")
    return texts
