"""Reasons for a design, or for none: active limits and their costs, what conflicts, and how each start ended."""

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

from tvimdesign.base.units import pretty
from tvimdesign.report.output.choices_tables import choice_text
from tvimdesign.report.output.numbers import at_its_minimum, csv_text, finite, label, listed
from tvimdesign.report.output.tables import NOTHING, margin_of, margin_text
from tvimdesign.solve.infeasibility.conflict_set import MARGIN_WORDS, conflict_in_words
from tvimdesign.solve.nlp.solution import ActiveConstraint, ConflictSet, Side, Start
from tvimdesign.solve.nlp.solver_run import FEASIBLE, FLAT_GOAL, meaning
from tvimdesign.solve.result import ConstraintCheck, StudyResult

PRICE_SHOWN = 1e-3  # Percent of the objective below which a step of a limit is not worth a line
_SAVING_SHOWN = 5e-3
NO_ROOM = 100.0  # Percent of the objective above which the slope at the optimum says nothing of a whole step


def active(answer: StudyResult) -> list[ActiveConstraint]:
    """Return the active limits, the costliest first."""
    held = answer.solution.held if answer.solution and answer.has_design else ()
    return sorted((limit for limit in held if limit.shadow_price > PRICE_SHOWN), key=lambda limit: -limit.shadow_price)


def is_active(check: ConstraintCheck, answer: StudyResult) -> bool:
    """Return whether a limit is active: the design is at it, or at its margin for tolerances."""
    return abs(check.margin) <= NOTHING or any(check.text == limit.text for limit in active(answer))


def sentences(answer: StudyResult) -> list[str]:
    """Return what each active limit costs, in words."""
    return [_sentence(held) for held in active(answer)]


def _sentence(held: ActiveConstraint) -> str:
    """Return `1 % more spring_stiffness (now >= 5.2 N·m/rad) costs 0.11 % module_mass and saves ...`."""
    more = "more" if ">=" in held.name else "less"
    subject = f"{held.step} {more} {held.output} (now{at_its_minimum(held.text).removeprefix(label(held.output))})"
    if held.shadow_price > NO_ROOM:
        return f"{subject}: no room."
    if not held.sensitivity:
        share = f"{held.shadow_price:.2g} % of the objective"
        return f"{subject} costs {share}. Its share of each output cannot be computed: {_WHY_NOT}."
    costs = [f"{saving:.2g} % {name}" for name, saving in held.sensitivity.items() if saving >= _SAVING_SHOWN]
    saves = [f"{-saving:.2g} % {name}" for name, saving in held.sensitivity.items() if saving <= -_SAVING_SHOWN]
    clauses = [f"{verb} {listed(parts)}" for verb, parts in (("costs", costs), ("saves", saves)) if parts]
    return f"{subject} {' and '.join(clauses)}." if clauses else f"{subject} costs next to nothing."


_WHY_NOT = "it belongs to the supply, or stands in the same way as another limit"


def why_rows(answer: StudyResult) -> list[dict[str, Any]]:
    """Return every limit and end of a range at the optimum: how it stands, its margin, and what a step of it costs."""
    rows: list[dict[str, Any]] = []
    for limit in sorted(answer.solution.held if answer.solution and answer.has_design else (), key=_place):
        margin, unit = margin_of(limit, answer.design.table)
        rows.append({
            "limit": limit.text, "stands": _stands(limit), "origin": limit.origin,
            "margin": finite(margin), "margin_unit": pretty(unit),
            "step": limit.step, "shadow_price": limit.shadow_price, "sensitivity": dict(limit.sensitivity),
        })  # fmt: skip
    return rows


def _stands(limit: ActiveConstraint) -> str:
    """Return `slack` of a limit that could be somewhat tighter and change nothing."""
    if limit.shadow_price > PRICE_SHOWN:
        return "active"
    return "slack" if limit.margin > NOTHING else "touches"


def _place(limit: ActiveConstraint) -> tuple[int, float]:
    """Return the order of a limit's row: active ones, the costliest first; slack ones last, by their margins."""
    return {"active": (0, -limit.shadow_price), "touches": (1, 0.0), "slack": (2, limit.margin)}[_stands(limit)]


def why(answer: StudyResult) -> dict[str, Any]:
    """Return everything this page says, as plain data; costs are percent of each output for a step of the limit."""
    return {"limits": why_rows(answer), "sentences": sentences(answer)}


def why_csv(answer: StudyResult) -> str:
    """Return the rows as CSV, one column for each minimised output."""
    outputs = list(answer.design.study["minimize"])
    places = ("limit", "stands", "origin", "margin", "margin_unit", "step")
    rows = [
        {**row, "shadow_price [%]": row["shadow_price"],
         **{f"sensitivity of {name} [%]": row["sensitivity"].get(name) for name in outputs}}
        for row in why_rows(answer)
    ]  # fmt: skip
    return csv_text(rows, [*places, "shadow_price [%]", *(f"sensitivity of {name} [%]" for name in outputs)], 6)


def complaint(answer: StudyResult) -> str:
    """Report that no design was found: the conflict, the least violations, and what to do."""
    solution = answer.solution
    if solution is not None and answer.design.status == FLAT_GOAL:
        goals = " and ".join(answer.design.study.get("minimize") or {})
        return (
            f"{answer.design.name}: {FLAT_GOAL}, {goals}: every design within the limits is as good as this "
            "one. Vary what it depends on, or minimise something else."
        )
    conflict_set = solution.conflict_set if solution else None
    is_feasible = solution is not None and solution.feasible and meaning(FEASIBLE).words in answer.design.status
    missed = "no design known to be the best one" if is_feasible else "no feasible design found"
    late = solution is not None and solution.out_of_time is not None and not conflict_set
    missed += " before the time limit ended the search" if late else ""
    lines = [f"{answer.design.name}: {missed} ({answer.design.status})."]
    if conflict_set:
        lines += conflict_in_words(conflict_set)
        robust = (answer.design.study.get("robust") or {}).get("share") is not None
        if robust and not any(MARGIN_WORDS in side.move_words for side in conflict_set.sides):
            lines.append("The values are nominal: the margins for a yield ask for more.")
    between = solution.choosing.between if solution and solution.choosing and not solution.choosing.best else None
    if between:
        choices = between.choices.items()
        values = ", ".join(f"{name} {choice_text(name, value, answer.design.table)}" for name, value in choices)
        lines.append(f"With {values} there is a design: list values nearer to these, or give a number a range.")
    broken = _worst_of_each(check for check in answer.checks if not check.met)
    if broken:
        lines.append(
            "The design that comes closest violates these:"
            if conflict_set
            else "Where the solver ended, these are violated:"
        )
        lines += [f"  {check.text}, by {margin_text(check, answer.design.table).lstrip('-')}" for check in broken]
    if not conflict_set:
        held = [h.text for h in solution.held if abs(h.residual) <= NOTHING] if solution else []
        lines += ["These stand in the way there, at their limits:", *(f"  {text}" for text in held)] if held else []
    if any(check.output.endswith("@duty") for check in broken):
        lines.append("Fewer `duty.switches_per_hour`, or a shorter `duty.soft`, may do.")
    if math.isinf(answer.design.value("response_time")):
        lines.append("The switch does not end there within `horizon`.")
    if (answer.design.study.get("robust") or {}).get("sigma") is not None:
        lines.append("Limits must be met by so many standard deviations (`robust`): ask for fewer, or spread less.")
    if conflict_set:
        lines.append(
            "Ease a limit, or widen a range under `vary`. The design.json written is the one that comes closest."
        )
    elif late:
        lines.append("The search could not decide whether there is one: raise `solver.time_limit` (or --time-limit).")
    elif between is None:
        lines += endings(solution.starts if solution else ())
        lines.append("Relax one of them, widen a range under `vary`, or try more `solver.starts`.")
    return "\n".join(lines)


def _worst_of_each(checks: Iterable[ConstraintCheck]) -> list[ConstraintCheck]:
    """Return the checks with the least margin first; of those that one requirement puts on several outputs, one."""
    ordered = sorted(checks, key=lambda check: check.margin)
    return list({check.part_of or check.text: check for check in reversed(ordered)}.values())[::-1]


def above_rating(answer: StudyResult) -> str:
    """Report an optimum beyond ratings that the study does not accept; empty if it is beyond none."""
    table, names = answer.design.table, answer.design.above_rating
    if answer.solution is None or not names:
        return ""
    checks = [check for check in answer.warnings if check.output in names]
    lines = [f"{answer.design.name}: the optimum is beyond what its materials or bought parts are rated for:"]
    lines += [f"  {check.text}, by {margin_text(check, table).lstrip('-')}: {check.origin}" for check in checks]
    accepted = ", ".join([*answer.design.accepting, *names])
    require = ", ".join(f'{name}: ">= 0 {table.unit(name)}"' for name in names)
    lines.append(f"Accept that in the study, `accept: [{accepted}]`, or exclude it: `require: {{{require}}}`.")
    return "\n".join(lines)


def endings(starts: Sequence[Start]) -> list[str]:
    """Return the starts that did not converge, by how they ended, with what to do."""
    failed = Counter(start.status for start in starts if not start.converged)
    lines = []
    for status, count in failed.most_common():
        words, step = meaning(status)
        who = f"{count} of {len(starts)} starts" if len(starts) > 1 else "The start"
        lines.append(f"{who} {words}" + (f": {step}." if step else "."))
    return lines


def optima(answer: StudyResult) -> list[dict[str, Any]]:
    """Return every distinct optimum: objective, first start that found it, how many did, free numbers (SI)."""
    solution = answer.solution
    if solution is None:
        return []
    return [
        {
            "objective": optimum.objective,
            "start": optimum.number,
            "reached_by": solution.reached(optimum),
            "at": optimum.end,
        }
        for optimum in solution.distinct_optima()
    ]


def starts_reported(answer: StudyResult) -> dict[str, Any]:
    """Return share of the free starts that converged, every optimum, and what became of the others."""
    starts = answer.solution.free_starts if answer.solution else ()
    failed = [start for start in starts if not start.converged]
    return {
        "count": len(starts),
        "converged": len(starts) - len(failed),
        "optima": optima(answer),
        "passed_over": answer.solution.passed_over if answer.solution else {},
        "not_converged": [
            {"start": start.number, **meaning(start.status)._asdict(), "status": start.status} for start in failed
        ],
    }


def conflicts_reported(conflict_set: ConflictSet | None) -> dict[str, Any] | None:
    """Return the conflict as plain data, SI; None where there is none."""
    if conflict_set is None:
        return None
    return {
        "cannot_hold_together": [_plain(side) for side in conflict_set.sides],
        "least_violation": [_plain(side) for side in conflict_set.broken],
        "ends_of_ranges": list(conflict_set.ends),
    }


def _plain(side: Side) -> dict[str, Any]:
    return {
        "limit": side.text, "origin": side.origin, "broken_by": side.by, "move_to": side.move_words or None,
        "not_enough_for": list(side.beside),
    }  # fmt: skip
