"""Reasons for a design: what binds and costs how much of each output, what is slack and by how much."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence

from tvimdesign.base.units import pretty
from tvimdesign.device import Table
from tvimdesign.report.output.results_format import LimitEntry, Stands, Why
from tvimdesign.report.output.tables import NOTHING, margin_of, margin_text
from tvimdesign.solve.nlp.solution import ActiveConstraint
from tvimdesign.solve.result import StudyResult

PRICE_SHOWN = 1e-3
"""Percent of the objective below which a step of a limit is not worth a line."""
_SAVING_SHOWN = 5e-3
_RULES_SHOWN = 5


def binding(answer: StudyResult) -> list[ActiveConstraint]:
    """Return the limits that hold the design, the costliest first."""
    held = answer.solution.held if answer.solution and answer.found else ()
    return sorted((limit for limit in held if limit.shadow_price > PRICE_SHOWN), key=lambda limit: -limit.shadow_price)


def slack(answer: StudyResult) -> list[ActiveConstraint]:
    """Return the limits that could be somewhat tighter and change nothing, those with the least margin first."""
    held = answer.solution.held if answer.solution and answer.found else ()
    slack_limits = [limit for limit in held if limit.shadow_price <= PRICE_SHOWN and limit.margin > NOTHING]
    return sorted(slack_limits, key=lambda limit: limit.margin)


def sentences(answer: StudyResult) -> list[str]:
    """Return what each binding limit costs, in words."""
    return [_sentence(held) for held in binding(answer)]


def _sentence(held: ActiveConstraint) -> str:
    """Return `1 % more spring_stiffness (now >= 5.2 N·m/rad) costs 0.11 % module_mass and saves ...`."""
    more = "more" if ">=" in held.name else "less"
    subject = f"{held.step} {more} {held.output} (now{held.text.removeprefix(held.output)})"
    if not held.sensitivity:
        share = f"{held.shadow_price:.2g} % of the objective"
        return f"{subject} costs {share}. Its share of each output cannot be computed: {_WHY_NOT}."
    costs = [f"{saving:.2g} % {name}" for name, saving in held.sensitivity.items() if saving >= _SAVING_SHOWN]
    saves = [f"{-saving:.2g} % {name}" for name, saving in held.sensitivity.items() if saving <= -_SAVING_SHOWN]
    clauses = [f"{verb} {_listed(parts)}" for verb, parts in (("costs", costs), ("saves", saves)) if parts]
    return f"{subject} {' and '.join(clauses)}." if clauses else f"{subject} costs next to nothing."


_WHY_NOT = "it belongs to the supply, or stands in the same way as another limit"


def _listed(parts: Sequence[str]) -> str:
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)


def slack_in_words(answer: StudyResult, table: Table) -> str:
    """Return the study's slack requirements with their margin, and the machine's rules that have the least."""
    slack_limits = slack(answer)
    own = [limit for limit in slack_limits if limit.origin == "require"]
    rules = [limit for limit in slack_limits if limit.origin not in ("require", "vary")]
    shown = [f"{limit.text} (margin {margin_text(limit, table)})" for limit in (*own, *rules[:_RULES_SHOWN])]
    left = len(slack_limits) - len(shown)
    more = f"; {left} other rules and ends of ranges have more, or are in why.csv" if left else ""
    return f"Slack: {'; '.join(shown)}{more}." if shown else ""


def why_rows(answer: StudyResult, table: Table) -> list[LimitEntry]:
    """Return every limit and end of a range at the optimum: how it stands, its margin, and what a step of it costs."""
    rows: list[LimitEntry] = []
    tight, loose = binding(answer), slack(answer)
    held = answer.solution.held if answer.solution and answer.found else ()
    others = [limit for limit in held if limit not in tight and limit not in loose]
    groups: tuple[tuple[Stands, list[ActiveConstraint]], ...] = (
        ("binds", tight), ("touches", others), ("slack", loose)
    )  # fmt: skip
    for stands, group in groups:
        for limit in group:
            margin, unit = margin_of(limit, table)
            rows.append({
                "limit": limit.text, "stands": stands, "origin": limit.origin,
                "margin": margin if math.isfinite(margin) else None, "margin_unit": pretty(unit),
                "step": limit.step, "shadow_price": limit.shadow_price, "sensitivity": dict(limit.sensitivity),
            })  # fmt: skip
    return rows


def why(answer: StudyResult, table: Table) -> Why:
    """Return everything this page says, as plain data; costs are percent of each output for a step of the limit."""
    return {"limits": why_rows(answer, table), "sentences": sentences(answer)}


def why_csv(answer: StudyResult, table: Table) -> str:
    """Return the rows as CSV, one column for each minimised output."""
    outputs = list(answer.design.study["minimize"])
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    costs = ["shadow_price [%]", *(f"sensitivity of {name} [%]" for name in outputs)]
    writer.writerow(["limit", "stands", "origin", "margin", "margin_unit", "step", *costs])
    for row in why_rows(answer, table):
        each = [f"{row['sensitivity'][name]:.6g}" if name in row["sensitivity"] else "" for name in outputs]
        margin = "" if row["margin"] is None else f"{row['margin']:.6g}"
        places = [row["limit"], row["stands"], row["origin"], margin, row["margin_unit"], row["step"]]
        writer.writerow([*places, f"{row['shadow_price']:.6g}", *each])
    return stream.getvalue()
