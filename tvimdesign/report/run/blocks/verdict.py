"""The verdict on a result: the first line, which an engineer acts on. The first rule that applies decides.

1. There is no design: *Infeasible*, with the limits that conflict or that the nearest design violates most.
2. The joint never softens or never stiffens, or an evaluated module violates a limit: *Do not build it*.
3. A material or bought part is beyond its rating, and the study does not accept it: *Above a rating*.
4. The study asks for a yield, and the search did not reach it: *Margins not reached*; of an evaluated module by 6.
5. The study requires something at an operating point, heating stops more than `TEMPERATURE` below it, and the joint
   does not meet that requirement when heating stops: *Not at the temperature you asked for*.
6. Fewer than `TARGET` of the built modules meet every limit: *Nominal optimum: add margins*.
7. A warning is grave, such as a part that may break: *Not yet*.
8. The limit most in doubt is met in less than `DOUBT` of the cases in which unmeasured inputs take any value in their
   ranges: *Measure X first*.
9. A limit is met in less than `share_in_doubt` of the cases: *Build it, one module first: measure X and Y*. If less
   than `DOUBT` of the cases meet all limits together, too, with their number; if less than `SELDOM`: *First measure X*.
10. *Build it*; here and in 9 with a bought part that is not to be had, and the share of cases if the study asks one.
   Without the yield and the ranges of unmeasured inputs: *Optimum found* or *Every limit is met*.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.report.output.numbers import in_labels, label, percent
from tvimdesign.report.output.tables import margin_text
from tvimdesign.report.page.blocks import Tone
from tvimdesign.report.run.blocks.warnings import RunWarning, missed_points
from tvimdesign.solve.nlp.solver_run import BELOW_YIELD, FLAT_GOAL
from tvimdesign.solve.result import StudyResult
from tvimdesign.solve.uncertainty.design_uncertainty import share_in_doubt

TARGET = 0.95  # Yield below which a design without margins is only a nominal one
DOUBT = 0.25  # Share of the plausible cases in which the limit most in doubt must be met
SELDOM = 0.05  # Share of the plausible cases that must meet all limits together

TESTED = ("minimum_wall", "minimum_feature", "slip_clearance", "running_clearance", "bridge_span", "hole_compensation")
"""Inputs that the test pieces show."""
_MOST_NAMED = 2  # Unmeasured inputs that a verdict names, and one more rather than count it


_TONES: dict[str, Tone] = {
    "infeasible": "bad", "unfit": "bad", "rating": "bad", "margins_missed": "bad", "temperature": "warn",
    "add_margins": "warn", "not_yet": "warn", "measure": "warn", "build_one": "warn", "build": "good",
    "unassessed": "good",
}  # fmt: skip


@dataclass(frozen=True)
class Verdict:
    """The advice on a result, with its reason."""

    kind: str  # One of `_TONES`
    text: str

    @property
    def tone(self) -> Tone:
        """Tone in which a page shows it."""
        return _TONES[self.kind]


def verdict(answer: StudyResult, uncertainty: Mapping[str, Any], warnings: Sequence[RunWarning]) -> Verdict:
    """Return the verdict by the first rule that applies; `uncertainty` is empty if it was not computed."""
    if not answer.has_design:
        return Verdict("infeasible", _infeasible(answer))
    return (
        _unfit(answer)
        or _above_rating(answer)
        or _margins_missed(answer)
        or _temperature(answer)
        or _add_margins(answer, uncertainty)
        or _not_yet(warnings)
        or _measure(uncertainty)
        or _fit(answer, uncertainty, warnings)
    )


def refused(reason: str) -> Verdict:
    """Return the verdict on a study that was refused before the search."""
    return Verdict("infeasible", f"Infeasible: {reason.splitlines()[0].rstrip(':')}")


def _infeasible(answer: StudyResult) -> str:
    """Name the limits that conflict; else the one that the nearest point violates most."""
    solution = answer.solution
    if solution is not None and solution.conflict_set:
        sides = [in_labels(side.text) for side in solution.conflict_set.sides]
        both = " and ".join(sides[:2]) + (f" and {len(sides) - 2} more" if len(sides) > 2 else "")
        return f"Infeasible because {both} cannot {'hold' if len(sides) == 1 else 'hold together'}"
    if solution is not None and solution.out_of_time is not None:
        return "No design found in time: raise solver.time_limit"
    if answer.design.status == FLAT_GOAL:
        return "No optimum: nothing under `vary` moves what is minimised"
    worst, _ = _violated(answer)
    return f"No design found: the nearest violates {worst}" if worst else "No design found"


def _unfit(answer: StudyResult) -> Verdict | None:
    if math.isinf(answer.design.value("response_time")):
        return Verdict("unfit", "Do not build it: it never gets soft within `horizon`")
    if math.isinf(answer.design.value("stiffening_time")):
        return Verdict("unfit", "Do not build it: it never gets stiff again within `horizon`")
    worst, count = _violated(answer)
    text = f"Do not build it: {count} of {len(answer.checks)} limits are violated, most {worst}"
    again = "" if answer.solution else "; a study with `vary` seeks a cure"
    return Verdict("unfit", text + again) if worst else None


def _violated(answer: StudyResult) -> tuple[str, int]:
    """Return the limit that is violated most, in words and by how much, and how many are; empty if none is."""
    violated = sorted((check for check in answer.checks if not check.met), key=lambda check: check.worst)
    table = answer.design.table
    texts = [f"{in_labels(check.text)}, by {margin_text(check, table).lstrip('-')}" for check in violated[:1]]
    return "".join(texts), len(violated)


def _above_rating(answer: StudyResult) -> Verdict | None:
    names = ", ".join(map(label, answer.design.above_rating))
    return Verdict("rating", f"Above a rating: {names} below 0") if names else None


def _margins_missed(answer: StudyResult) -> Verdict | None:
    if answer.design.status != BELOW_YIELD:
        return None
    reached = answer.yield_reached
    if reached is None:
        return Verdict("margins_missed", "Margins not reached: the time limit ended the search")
    return Verdict("margins_missed", _missed(reached.together, reached.target))


def _missed(share: float, target: float) -> str:
    return f"Margins not reached: yield {percent(share)} of {percent(target)} asked"


def _temperature(answer: StudyResult) -> Verdict | None:
    """Compare each operating point with where heating stops, if a requirement there is not met then."""
    values, missed = answer.design.values, missed_points(answer)
    if not missed:
        return None
    point = max(missed, key=lambda point: values[f"temperature@{point}"])
    ends = (values["softened_temperature"], values[f"temperature@{point}"])
    reached, wanted = (f"{from_si(end, 'degC'):.0f}" for end in ends)
    what = label(missed[point].partition("@")[0])
    text = f"Not at the temperature you asked for: {reached} of {wanted} {pretty('degC')}, for {what}"
    return Verdict("temperature", text)


def _add_margins(answer: StudyResult, uncertainty: Mapping[str, Any]) -> Verdict | None:
    """Compare the yield with `TARGET`, or with what the study asks for of a module that was not searched for."""
    share, robust = uncertainty.get("parts_yield"), answer.design.study.get("robust") or {}
    target = robust.get("share") or TARGET
    if share is None or share["share"] >= target or (robust and answer.solution is not None):
        return None
    if robust.get("share"):
        return Verdict("margins_missed", _missed(share["share"], target))
    what = "optimum: add margins" if answer.solution is not None else "design without margins"
    return Verdict("add_margins", f"Nominal {what} (yield {percent(share['share'])})")


def _not_yet(warnings: Sequence[RunWarning]) -> Verdict | None:
    grave = next((warning for warning in warnings if warning.level == "grave"), None)
    if grave is None:
        return None
    what = grave.text.partition(": ")[0]
    return Verdict("not_yet", f"Not yet: {f'{grave.but} ({what})' if grave.but else what}")


def _measure(uncertainty: Mapping[str, Any]) -> Verdict | None:
    name, share = most_in_doubt(uncertainty)
    if not name or share >= DOUBT:
        return None
    first = measure_first(name, uncertainty)
    if first:
        return Verdict("measure", f"Measure the {label(first)} first: it decides on the {label(name)}")
    return Verdict("measure", f"Measure first what decides on the {label(name)}")


def most_in_doubt(uncertainty: Mapping[str, Any]) -> tuple[str, float]:
    """Return the output whose limit is met in the fewest cases, and their share; an empty name if there is none."""
    return next(iter(least_shares(uncertainty).items()), ("", 1.0))


def measure_first(output: str, uncertainty: Mapping[str, Any]) -> str:
    """Return the unmeasured input that carries most of an output's range; empty if none stands out."""
    return next(iter(uncertainty.get("intervals", {}).get(output, {}).get("shares", {})), "")


def _fit(answer: StudyResult, uncertainty: Mapping[str, Any], warnings: Sequence[RunWarning]) -> Verdict:
    what_else = " and ".join(warning.but for warning in warnings if warning.but)
    but = f", but {what_else}" if what_else else ""
    plausible = (answer.design.study.get("robust") or {}).get("plausible")
    made_for = f"; {percent(plausible)} of plausible cases are asked of each limit alone" if plausible else ""
    if not uncertainty:
        return Verdict("unassessed", f"{'Every limit is met' if answer.solution is None else 'Optimum found'}{but}")
    together = (uncertainty.get("ranges_hold") or {}).get("share", 1.0)
    few = f"{meet_every_limit(uncertainty)}; " if together < DOUBT else ""
    decided = limits_in_doubt(uncertainty, share_in_doubt(plausible)) or limits_in_doubt(uncertainty, 1.0 if few else 0)
    if not decided:
        return Verdict("build", f"Build it{but}{made_for}")
    first = [name for name in decided if name]
    what = _to_measure(first, answer) if first else f"check the {label(most_in_doubt(uncertainty)[0])}"
    more = f"{f'; {what_else}' if what_else else ''}{'' if few else made_for}"
    if together < SELDOM:
        return Verdict("measure", f"First {what}: {meet_every_limit(uncertainty)}{more}")
    return Verdict("build_one", f"Build it, one module first: {few}{what}{more}")


def meet_every_limit(uncertainty: Mapping[str, Any]) -> str:
    """Say how many of the cases meet every limit."""
    draws = uncertainty["draws"]
    return f"{round(draws * uncertainty['ranges_hold']['share'])} of {draws} plausible cases meet every limit"


def limits_in_doubt(uncertainty: Mapping[str, Any], least: float) -> dict[str, dict[str, float]]:
    """Return outputs whose limits fewer cases than `least` meet, with their shares, by the input that decides on them.

    The worst is first; outputs that no input stands out for are under "".
    """
    decided: dict[str, dict[str, float]] = {}
    for output, share in least_shares(uncertainty).items():
        if share < least:
            decided.setdefault(measure_first(output, uncertainty), {})[output] = share
    return decided


def least_shares(uncertainty: Mapping[str, Any]) -> dict[str, float]:
    """Return the least share of cases that meet a limit on an output, by output, the least first."""
    worst_last = sorted(uncertainty.get("held", {}).items(), key=lambda entry: -entry[1])
    shares = {limit.partition(" ")[0]: share for limit, share in worst_last}
    return dict(sorted(shares.items(), key=lambda entry: entry[1]))


def _to_measure(names: Sequence[str], answer: StudyResult) -> str:
    """Say what to measure: all inputs, or the first and how many more there are; a printer's by its test pieces."""
    inputs = [f"the {label(name)}" for name in names]
    if names[0] in TESTED and answer.design.choices["making_method"] != "milled":
        others = f", and measure {len(inputs) - 1} others (summary.txt)" if len(inputs) > 2 else ""
        return f"print the test pieces for {inputs[0]}{others or ', and measure '.join(['', *inputs[1:]])}"
    if len(inputs) <= _MOST_NAMED + 1:
        return f"measure {' and '.join(filter(None, [', '.join(inputs[:-1]), inputs[-1]]))}"
    return f"measure {', '.join(inputs[:_MOST_NAMED])} and {len(inputs) - _MOST_NAMED} others (summary.txt)"


def starts_in_words(answer: StudyResult) -> list[str]:
    """Say how many of the solver's starts ended at the optimum, or what found it instead; empty for an evaluation."""
    if answer.solution is None:
        return []
    free, optima = answer.solution.free_starts, answer.solution.distinct_optima()
    started = answer.solution.start_count()
    count = "1 start" if started == 1 else f"{started} starts"
    if not answer.has_design:
        return [f"{sum(start.converged for start in free)} of {count} converged" if optima else f"{count}, no design"]
    if not optima:
        return ["no start converged, a later search did"]
    if started == 1:
        return ["1 start tried"]
    agree = answer.solution.reached(optima[0])
    return [f"found by 1 of {started} starts" if agree == 1 else f"{agree} of {started} starts agree"]
