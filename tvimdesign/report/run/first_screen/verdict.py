"""The first lines: name, mode, status, starts that agree, seconds; and what the module weighs, measures and needs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from tvimdesign.base.units import format_quantity, from_si, pretty
from tvimdesign.device import Table
from tvimdesign.report.output.tables import number
from tvimdesign.report.output.thresholds import soft_in_words, stiff_in_words
from tvimdesign.report.run.first_screen.layout import block, joined
from tvimdesign.report.run.first_screen.requirements import may_be
from tvimdesign.report.run.first_screen.stalling import stalling_in_words
from tvimdesign.report.run.yield_words import gain_without_margins, percent, yield_of
from tvimdesign.solve.optimizer.statuses import BELOW_YIELD
from tvimdesign.solve.result import StudyResult

_DIGITS = 3


def header(answer: StudyResult, seconds: float | None, width: int) -> list[str]:
    """One line, or two where the name is long."""
    parts = [answer.design.name, answer.design.mode, status(answer), *starts(answer)]
    parts += [] if seconds is None else [f"{seconds:.{1 if seconds < 10.0 else 0}f} s"]
    return joined("", parts, width)


def left_out_lines(left_out: str, width: int) -> list[str]:
    """List the steps that the time limit left out."""
    return block("Left out", left_out, width) if left_out else []


def status(answer: StudyResult) -> str:
    """What a study came to, in capitals."""
    if not answer.found:
        late = answer.solution is not None and answer.solution.out_of_time is not None
        return "NO DESIGN FOUND IN TIME" if late else "NO DESIGN FOUND"
    return _of_evaluation(answer) if answer.solution is None else _of_optimum(answer)


def _of_evaluation(answer: StudyResult) -> str:
    """Never soft, limits broken, limits that history decides, ratings exceeded: the first of these."""
    broken = sum(not check.kept for check in answer.checks)
    if math.isinf(answer.design.value("response_time")):
        return "EVALUATED, NEVER SOFT"
    if broken:
        return f"EVALUATED, {broken} OF {len(answer.checks)} LIMITS BROKEN"
    if answer.undecided:
        return f"EVALUATED, HISTORY DECIDES {len(answer.undecided)} LIMITS"
    return f"EVALUATED, {_of_ratings(answer) or 'ALL LIMITS KEPT'}"


def _of_optimum(answer: StudyResult) -> str:
    """Optimal within the ratings, or beyond those that the study accepts; else the ratings that it does not, or that
    fewer modules than asked keep its limits.
    """
    said = _of_ratings(answer)
    reached = yield_of(answer)
    if reached is None and answer.design.status == BELOW_YIELD:
        return f"WITHIN ITS LIMITS, MARGINS NOT FINISHED IN TIME{said and ', '}{said}"
    if reached is not None and answer.design.status == BELOW_YIELD:
        return f"YIELD {percent(reached.together)}, {percent(reached.asked)} ASKED{said and ', '}{said}"
    return said if answer.design.above_rating else f"OPTIMAL{said and ', '}{said}"


def _of_ratings(answer: StudyResult) -> str:
    """The ratings that are exceeded and not accepted, else those that are accepted; empty where none is exceeded."""
    if answer.design.above_rating:
        return f"ABOVE RATING, NOT ACCEPTED: {', '.join(answer.design.above_rating)}"
    return f"ACCEPTING: {', '.join(answer.design.accepting)}" if answer.design.accepting else ""


def starts(answer: StudyResult) -> Iterator[str]:
    """How many of the solver's starts ended at the optimum."""
    if answer.solution is None:
        return
    free, optima = answer.solution.free_starts, answer.solution.distinct_optima()
    if not answer.found or not optima:
        yield f"{sum(start.converged for start in free)} of {len(free)} starts converged"
        return
    agree = answer.solution.reached(optima[0])
    if len(free) == 1:
        yield "one start: others may be better"
    else:
        yield f"found by 1 of {len(free)} starts" if agree == 1 else f"{agree} of {len(free)} starts agree"


def module_lines(answer: StudyResult, table: Table, intervals: Mapping[str, Any], width: int) -> list[str]:
    """What it weighs and measures, when it is soft and stiff, and what it draws from the supply.

    In brackets what each may be, given what nobody has measured.
    """
    said = _Values(answer, table, intervals)
    peaks = (said.most("peak_voltage", "stiffening_peak_voltage"), said.most("peak_current", "stiffening_peak_current"))
    measures = f"{said('envelope_diameter')} diameter x {said('envelope_height')} high"
    energy = f"{said('switch_energy')} to soften, {said('cycle_energy')} a cycle"
    return [
        *joined("Weighs", [said("module_mass"), measures, said("envelope_volume")], width),
        *joined("Soft after", _soft(answer, said), width),
        *joined("Stiff again", _stiff(answer, said), width),
        *joined("Needs", [f"{', '.join(peaks)}, {said('peak_power')} at most", energy], width),
    ]


class _Values:
    """Values of a design for people, in three digits."""

    def __init__(self, answer: StudyResult, table: Table, intervals: Mapping[str, Any]) -> None:
        self.values, self.table, self.intervals = answer.design.values, table, intervals

    def __call__(self, name: str) -> str:
        """One value with its unit, and what it may be."""
        value, unit = self.values[name], self.table.unit(name)
        said = "never" if math.isinf(value) else f"{number(from_si(value, unit), _DIGITS)} {pretty(unit)}".rstrip()
        ends = may_be(self.intervals.get(name))
        return f"{said} ({ends})" if ends else said

    def first(self, name: str) -> str:
        """What to measure first for a narrower interval, and what it carries; empty where nothing stands out."""
        shares = self.intervals.get(name, {}).get("shares", {})
        return next((f"measure first: {one}, {100.0 * share:.0f} %" for one, share in shares.items()), "")

    def most(self, *names: str) -> str:
        """The largest of some that happen."""
        return self(max(names, key=lambda name: self.values[name] if math.isfinite(self.values[name]) else -1.0))


def _soft(answer: StudyResult, said: _Values) -> Iterator[str]:
    """When the joint is soft, whether it stalls on the way, what soft means, and what to measure first."""
    yield said("softening_time")
    yield from filter(None, [stalling_in_words(answer.histories.get("softening"), said.values["softening_time"])])
    yield soft_in_words(answer.design, said.table)
    yield from filter(None, [said.first("softening_time")])


def _stiff(answer: StudyResult, said: _Values) -> Iterator[str]:
    if math.isinf(said.values["softening_time"]) and math.isinf(said.values["stiffening_time"]):
        yield "never"
        return
    yield f"{said('stiffening_time')} from the end of the switch"
    yield stiff_in_words(answer.design, said.table)
    yield f"frozen {said('frozen_time')}"
    yield left_to_the_air(answer)


def left_to_the_air(answer: StudyResult) -> str:
    """What cooling by current buys: when the same module is frozen with its pads unpowered, or why they are."""
    if not answer.cooling.able:
        return "by the air alone: this heater cannot cool"
    if not answer.cooling.used:
        return "by the air alone: no current cools"
    time = answer.cooling.unpowered.get("frozen_time", math.inf)
    return f"with the pads unpowered {'never' if math.isinf(time) else f'{number(time, _DIGITS)} s'}"


def trade_lines(front: Any, table: Table, width: int) -> list[str]:
    """The front, where the study asks for one."""
    if front is None or not front.points:
        return []
    spans = []
    for name in front.outputs:
        values, unit = [point.values[name] for point in front.points], table.unit(name)
        low, high = (number(from_si(end, unit), _DIGITS) for end in (min(values), max(values)))
        spans.append(f"{name} {low} to {high} {pretty(unit)}".rstrip())
    knee = [] if front.knee is None else [f"knee: point {front.knee + 1}"]
    return joined("Front", [f"{len(front.points)} designs", *spans, *knee], width)


def chosen_lines(answer: StudyResult, table: Table, width: int) -> list[str]:
    """What was chosen of what is listed, and by how much the next two are worse, with what they have instead.

    Combinations are ranked without margins. Where a study asks for margins, the design's own choice can be another
    one than the best of the ranking: the line names the design's, and says how the ranking was made.
    """
    choosing = answer.solution.choosing if answer.solution else None
    if choosing is None or not choosing.best:
        return []
    best = choosing.best[0]
    own = {name: _choice(name, _of_design(answer, name, word), table) for name, word in best.choices.items()}
    words = [f"{name} {word}" for name, word in own.items()]
    count = f"of {choosing.combinations} combinations"
    first = _instead(best.choices, own, table)
    if not answer.design.study.get("robust"):
        others = [f"best {count}"]
    elif first:
        others = [f"with margins, {count}", f"ranked without margins, the best is {', '.join(first)}"]
    else:
        others = [f"best {count}, ranked without margins"]
    for place, one in zip(("next", "third"), choosing.best[1:], strict=False):
        worse = 100.0 * (one.objective / best.objective - 1.0)
        instead = _instead(one.choices, own, table) or ["the one chosen"]
        others.append(f"the {place} is {worse:.2g} % worse: {', '.join(instead)}")
    return joined("Chosen", [*words, *others], width)


def _of_design(answer: StudyResult, name: str, listed: str | float) -> str | float:
    """The design's own choice of a record or a size, which is `listed` in the ranking."""
    own = answer.design.choices.get(name) if isinstance(listed, str) else answer.design.values.get(name)
    return listed if own is None else own


def _instead(choices: Mapping[str, str | float], own: Mapping[str, str], table: Table) -> list[str]:
    """What a combination has that the design has not, in words."""
    shown = {name: _choice(name, word, table) for name, word in choices.items()}
    return [f"{name} {word}" for name, word in shown.items() if word != own[name]]


def _choice(name: str, word: str | float, table: Table) -> str:
    """A record's name as it is, a listed size in its unit."""
    return word if isinstance(word, str) else format_quantity(word, table.unit(name))


def current_lines(answer: StudyResult, table: Table, width: int) -> list[str]:
    """What currents that follow a profile buy against the best constant ones, which have no margins for a yield."""
    best = answer.solution.constant if answer.solution else None
    if best is None or not answer.found or answer.solution is None:
        return []
    said = f"follows a profile while {' and '.join(answer.design.current_profiles)}"
    reached = yield_of(answer)
    if reached is None:
        worse = 100.0 * (best.objective / answer.solution.objective - 1.0)
        return block("Current", f"{said}; the best constant current is {worse:.2g} % worse", width)
    gain = ", ".join(gain_without_margins(answer, best.values, reached, table))
    return block("Current", f"{said}; without margins, from the best constant current to it: {gain}", width)
