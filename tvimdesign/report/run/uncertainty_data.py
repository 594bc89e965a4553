"""The uncertainty of a design as plain data: what varies from part to part, and what is unmeasured.

A yield that was asked for, in words: what is reached, what the margins cost, and what stands in its way.
"""

import math
import os
from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Table, table_for
from tvimdesign.report.output.numbers import in_unit, label, number, number_entry, percent, with_unit
from tvimdesign.report.output.terminal import duration
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_design, resolve_study
from tvimdesign.solve.nlp import spread
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE
from tvimdesign.solve.nlp.solution import LostTo, TightenedTolerance, YieldReached
from tvimdesign.solve.nlp.solver_run import BELOW_YIELD
from tvimdesign.solve.nlp.spread import Yield
from tvimdesign.solve.result import StudyResult
from tvimdesign.solve.uncertainty.design_uncertainty import DRAWS, DesignUncertainty, UncertaintyModel
from tvimdesign.solve.uncertainty.uncertain_inputs import Interval
from tvimdesign.study import Study, standard_tolerances
from tvimdesign.study.design import Design
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


class Uncertainty:
    """The yield of a study's designs and the intervals of their outputs, as plain data.

    The tolerances are the study's, else the standard ones.
    """

    def __init__(self, study: Study) -> None:
        """Compile the module the study starts from, whose numbers under `vary` may change."""
        self.study, self.table = study, study.table
        self.own = bool(study.tolerances)
        required = [
            name
            for requirement in study.require
            for name in (requirement.output, *study.limited_with(requirement.output))
        ]
        shown = [name for name in FIRST_SCREEN if name.partition("@")[0] in self.table.by_name]
        self.requested = list(dict.fromkeys([*required, *study.minimize, *shown]))
        self._start = self._tolerant(resolve_study(study))
        self.model = UncertaintyModel(self._start, self.requested, list(study.vary))

    def _tolerant(self, resolved: ResolvedModule) -> ResolvedModule:
        """Return a module with the tolerances that count."""
        tolerances = resolved.study.tolerances if self.own else standard_tolerances(self.table)
        return replace(resolved, study=resolved.study.model_copy(update={"tolerances": tolerances}))

    def data(self, design: Design, modules: int = MODULES, deadline: Deadline = NEVER) -> dict[str, Any]:
        """Return a design's entry for results.json, with what the screen names beside it.

        `modules` is a power of two; without modules there is no yield. Raises TimeOverError at the deadline.
        """
        resolved = self._tolerant(resolve_design(design))
        if not self.model.fits(resolved):  # another record was chosen
            self.model = UncertaintyModel(resolved, self.requested)
        uncertainty = self.model.at(resolved, modules, DRAWS, deadline=deadline)
        return {**self._entry(uncertainty, modules), "needs": self._needs(uncertainty)}

    def _needs(self, uncertainty: DesignUncertainty) -> str:
        """Return the values of the main unmeasured input that the limit most in doubt is met with, alone; or nothing.

        In words, linear between the ends of its range and the value as drawn.
        """
        limit = next((limit for limit in self.model.limits if limit.name in list(uncertainty.held)[:1]), None)
        interval = uncertainty.intervals.get(limit.output) if limit else None
        main = next(iter(interval.shares), "") if interval else ""
        swing = next((swing for swing in interval.swings if swing.moved.name == main), None) if interval else None
        if limit is None or interval is None or swing is None:
            return ""
        at = np.array([swing.moved.low, swing.moved.value, swing.moved.high])
        residuals = limit.residual(np.array([swing.at_low, interval.nominal, swing.at_high])) - ALGEBRAIC_TOLERANCE
        rising = residuals[0] < residuals[2]
        if not np.all(np.isfinite(residuals)) or np.min(residuals) > 0.0 or np.max(residuals) <= 0.0:
            return ""
        order = slice(None) if rising else slice(None, None, -1)
        end = float(np.interp(0.0, residuals[order], at[order]))
        return f"{label(main)} {'<=' if rising else '>='} {with_unit(end, self.table.unit(main), 3)}"

    def _entry(self, uncertainty: DesignUncertainty, modules: int) -> dict[str, Any]:
        return {
            "parts_yield": share_entry(uncertainty.together),
            "modules": modules,
            "limits": uncertainty.limits,
            "left_out": list(uncertainty.left_out),
            "tolerances": "study" if self.own else "standard",
            "ranges_hold": share_entry(uncertainty.holds),
            "draws": DRAWS,
            "held": uncertainty.held,
            "intervals": {
                name: interval_entry(name, interval, self.table, uncertainty.before.get(name))
                for name, interval in uncertainty.intervals.items()
            },
            "unmeasured": [
                {
                    "name": unmeasured.name,
                    **number_entry(
                        unmeasured.value, self.table.unit(unmeasured.name), (unmeasured.low, unmeasured.high)
                    ),
                    "status": unmeasured.status,
                }
                for unmeasured in uncertainty.unmeasured
            ],
        }


def uncertainty_of(answer: StudyResult, study: Study, deadline: Deadline = NEVER) -> dict[str, Any]:
    """Return yield and intervals of an answer; a yield that its study asks for is known from the search.

    Empty without a design, or where they are left out. Raises TimeOverError.
    """
    if os.environ.get(_SPREAD) == "off" or not answer.has_design:
        return {}
    reached = yield_of(answer)
    data = Uncertainty(study).data(answer.design, 0 if reached else MODULES, deadline=deadline)
    if reached:
        data |= {"parts_yield": asdict(spread.yield_of(reached.together, reached.modules)), "modules": reached.modules}
    return data


def interval_entry(
    name: str, interval: Interval, table: Table, before: tuple[float, float] | None = None
) -> dict[str, Any]:
    """Return an interval in the unit people read, and in SI, with the one before measurements, if there were any."""
    unit = table.unit(name)
    return {
        **number_entry(interval.nominal, unit, (interval.low, interval.high)),
        "one_at_a_time": number_entry(interval.nominal, unit, interval.one_at_a_time),
        "shares": interval.shares,
        "to_halve": list(interval.to_halve),
        "before": None if before is None else number_entry(interval.nominal, unit, before),
    }


def share_entry(share: Yield | None) -> dict[str, Any] | None:
    """Return a share with its confidence interval as plain data."""
    return None if share is None else {"share": share.share, "low": share.low, "high": share.high}


_DIGITS = 3
_CARRIED = 0.05  # Share of a limit's variance from which a tolerance is named


def yield_of(answer: StudyResult) -> YieldReached | None:
    """Return the account of a yield that the study asks for; None without a design or without one asked for."""
    return answer.solution.yield_reached if answer.solution and answer.has_design else None


def changes(answer: StudyResult, before: Mapping[str, float], after: Mapping[str, float], table: Table) -> list[str]:
    """Return what each minimised output is before a change, such as margins, and after it."""
    return [_change(name, before[name], after[name], table) for name in answer.design.study["minimize"]]


def below_yield(answer: StudyResult) -> str:
    """Report a design that fewer modules satisfy than asked: which limits, by which tolerance; else empty."""
    reached, limit = yield_of(answer), answer.solution.out_of_time if answer.solution else None
    if answer.design.status != BELOW_YIELD or not answer.has_design:
        return ""
    if limit is not None or reached is None:
        return _not_in_time(answer, reached, limit)
    lines = [
        f"{answer.design.name}: no design found with a yield of {percent(reached.target)}; "
        f"the best has {percent(reached.together)}. Most modules are lost to"
    ]
    lines += [f"  {lost_in_words(loss)}" for loss in reached.lost_to]
    ways = lever(reached, table_for(answer.design.mode))
    lines += [f"{way[0].upper()}{way[1:]}." for way in ways]
    lines.append("Ease these limits, widen a range under `vary`, or tighten these tolerances.")
    return "\n".join(lines)


def lever(reached: YieldReached, table: Table) -> list[str]:
    """Return the tolerance to tighten and the requirement to ease, each alone, for the yield; nothing if reached."""
    tolerance, target = reached.tightened, percent(reached.target)
    if tolerance is None:
        return []
    return [*_eased(reached, table), _tightened(tolerance, target, table)]


def _eased(reached: YieldReached, table: Table) -> list[str]:
    if reached.eased is None:
        return []
    output, sense, limit = reached.eased.text.split(" ", 2)
    unit = table.unit(output)
    value = from_si(reached.eased.to, unit)
    step = 10.0 ** (math.floor(math.log10(abs(value) or 1.0)) - 2)
    steps = round(value / step, 6)  # then towards what is easier
    to = step * (math.ceil(steps) if sense == "<=" else math.floor(steps))
    eased = f"{label(output)} {sense} {number(to, _DIGITS)} {pretty(unit)}".rstrip()
    return [f"other sizes give {percent(reached.target)} if {eased} ({limit} asked)"]


def _tightened(tolerance: TightenedTolerance, target: str, table: Table) -> str:
    unit, of = difference_unit(table.unit(tolerance.name)), label(tolerance.name)
    now, to = (with_unit(size, unit, 2) for size in (tolerance.plus_minus, tolerance.to))
    if tolerance.to > 0.0:
        return f"at these sizes {of} within about ±{to}, not ±{now}, gives {target}"
    return f"at these sizes no tolerance alone gives {target}: {of} without its ±{now} gives {percent(tolerance.share)}"


def _not_in_time(answer: StudyResult, reached: YieldReached | None, limit: float | None) -> str:
    """Report a design whose margins the time limit cut short."""
    limited = "" if limit is None else f" of {duration(limit)}"
    ended = f"the time limit{limited} ended the search before it had all margins against spread"
    sentence = "how many modules satisfy every limit is not known"
    if reached is not None:
        share, target = percent(reached.together), percent(reached.target)
        sentence = f"{share} of the modules satisfy every limit so far, {target} are asked"
    return f"{answer.design.name}: {ended}; {sentence}. Raise `solver.time_limit` (or --time-limit)."


def lost_in_words(lost: LostTo) -> str:
    """Return a limit that too many modules violate, and the tolerances that carry its spread."""
    named = [f"{name} ({100.0 * share:.0f} %)" for name, share in lost.carriers.items() if share >= _CARRIED]
    return f"{lost.text}, met by {percent(lost.share)}{', spread by ' if named else ''}{', '.join(named)}"


def _change(name: str, before: float, after: float, table: Table) -> str:
    unit = table.unit(name)
    change = f"{label(name)} from {in_unit(before, unit, _DIGITS)} to {with_unit(after, unit, _DIGITS)}"
    if not (math.isfinite(before) and math.isfinite(after) and before):
        return change.rstrip()
    return f"{change.rstrip()} ({100.0 * (after / before - 1.0):+.2g} %)"
