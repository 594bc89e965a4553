"""What a run says where there is no design, and of starts that found none: the quarrel, and every ending in words."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from typing import Any

from tvimdesign.device import Table
from tvimdesign.report.output.tables import NOTHING, margin_text
from tvimdesign.solve.nlp.solution import Quarrel, Side, Start
from tvimdesign.solve.optimizer.statuses import meaning
from tvimdesign.solve.result import Answer


def complaint(answer: Answer, table: Table) -> str:
    """What to say where no design was found: what cannot hold together, what is broken least, and what to do."""
    solution = answer.solution
    quarrel = solution.quarrel if solution else None
    lines = [f"{answer.design.name}: no design found that keeps every limit ({answer.design.status})."]
    if quarrel:
        lines += _quarrel_in_words(quarrel)
    broken = sorted((check for check in answer.checks if not check.kept), key=lambda check: check.margin)
    if broken:
        lines.append(
            "The design that comes closest breaks these:" if quarrel else "Where the solver ended, these are broken:"
        )
        lines += [f"  {check.text}, by {margin_text(check, table).lstrip('-+')}" for check in broken]
    if not quarrel:
        held = [h.text for h in solution.held if abs(h.residual) <= NOTHING] if solution else []
        lines += ["These stand in the way there, at their limits:", *(f"  {text}" for text in held)] if held else []
    if math.isinf(answer.design.value("response_time")):
        lines.append("The switch does not end there within `horizon`.")
    if answer.design.study.get("robust"):
        lines.append("Limits are to be kept by so many standard deviations (`robust`): ask for fewer, or spread less.")
    if quarrel:
        lines.append(
            "Ease a limit, or widen a range under `vary`. The design.json written is the one that comes closest."
        )
    else:
        lines += endings(solution.starts if solution else ())
        lines.append("Relax one of them, widen a range under `vary`, or try more `solver.starts`.")
    return "\n".join(lines)


def _quarrel_in_words(quarrel: Quarrel) -> list[str]:
    how = "bounds prove it" if quarrel.proved else "as far as the solver sees from its starts"
    alone = len(quarrel.sides) == 1
    lines = [f"This cannot hold within the ranges, {how}:" if alone else f"These cannot hold together, {how}:"]
    for side in quarrel.sides:
        lines.append(f"  {_named(side)}: {_place(side)}")
    if quarrel.ends:
        lines.append(f"Ends of ranges that keep {'it' if alone else 'them'} from it: {', '.join(quarrel.ends)}.")
    return lines


def _place(side: Side) -> str:
    if side.move_words:
        return f"alone it would have to move to {side.move_words}"
    if side.beside:
        return f"moving it alone is not enough, for then {' and '.join(side.beside)} cannot hold either"
    return "how far it must move is not known"


def _named(side: Side) -> str:
    return side.text if side.origin == "require" else f"{side.text} ({side.origin})"


def endings(starts: Sequence[Start]) -> list[str]:
    """The starts that did not converge, by how they ended, with what to do."""
    failed = Counter(start.status for start in starts if not start.converged)
    lines = []
    for status, count in failed.most_common():
        words, step = meaning(status)
        who = f"{count} of {len(starts)} starts" if len(starts) > 1 else "The start"
        lines.append(f"{who} {words}" + (f": {step}." if step else "."))
    return lines


def optima(answer: Answer) -> list[dict[str, Any]]:
    """Every distinct optimum: its objective, the first start that found it, how many did, and its free numbers (SI)."""
    solution = answer.solution
    if solution is None:
        return []
    return [
        {"objective": one.objective, "start": one.number, "reached_by": solution.reached(one), "at": one.end}
        for one in solution.distinct_optima()
    ]


def starts_told(answer: Answer) -> dict[str, Any]:
    """Share of the free starts that converged, every optimum, and what became of the others."""
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


def quarrel_told(quarrel: Quarrel | None) -> dict[str, Any] | None:
    """The quarrel as plain data, SI; None where there is none."""
    if quarrel is None:
        return None
    return {
        "cannot_hold_together": [_plain(side) for side in quarrel.sides],
        "least_violation": [_plain(side) for side in quarrel.broken],
        "ends_of_ranges": list(quarrel.ends),
        "proved_by_bounds": quarrel.proved,
    }


def _plain(side: Side) -> dict[str, Any]:
    return {
        "limit": side.text, "origin": side.origin, "broken_by": side.by, "move_to": side.move_words or None,
        "not_enough_for": list(side.beside),
    }  # fmt: skip
