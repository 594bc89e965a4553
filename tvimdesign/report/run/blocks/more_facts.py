"""The facts of a result that `--full` and the page add: thresholds, temperatures, creep, cost, choices, yield."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from tvimdesign.base.units import from_si, pretty
from tvimdesign.cad.assembly.heater_leads import temperatures_in_order
from tvimdesign.report.output.choices_tables import choice_text, own_choices
from tvimdesign.report.output.numbers import ends_text, in_unit, label, number, percent, range_text, with_unit
from tvimdesign.report.output.tables import soft_in_words, stiff_in_words
from tvimdesign.report.run.blocks.facts import DIGITS, Fact, Values, tolerances_in_words
from tvimdesign.report.run.blocks.warnings import frozen_turn
from tvimdesign.report.run.uncertainty_data import changes
from tvimdesign.simulation.working_cycle.curves import Curves
from tvimdesign.solve.result import StudyResult
from tvimdesign.study import cost_in_words

_GOOD = 0.9973  # Yield from which a module is no concern: three standard deviations to either side
DAY = 86400.0  # [s]
STALLS = 3.5
"""Per cent of time for one per cent of the temperature's rise: 1 if a layer warms evenly, 2 as the root of time."""


def more_facts(answer: StudyResult, uncertainty: Mapping[str, Any], front: Any) -> list[Fact]:
    """Return what `--full` and the page add: thresholds, cooling, idealizations, choices, yield."""
    value = Values(answer, uncertainty)
    facts = [
        Fact("Soft", _soft(answer)),
        Fact("Stiff", list(_stiff(value, answer))),
        Fact("Temperatures", [" < ".join(f"{words} {from_si(kelvin, 'degC'):.0f} {pretty('degC')}"
                                         for words, kelvin in temperatures_in_order(answer.design).items())]),
        Fact("Frozen", [f"{value(name)} {words}" for name, words in _FROZEN.items() if name in value.values]),
        Fact("Held", list(_creep(value, answer))),
        Fact("Bearing", [_NO_BEARING] if answer.design.choices["bearing"] == "none" else []),
        Fact("Duty", list(_duty_peaks(answer))),
        Fact("Accepts", list(_accepts(answer))),
        Fact("Cost", list(_cost(value, answer.design.choices))),
        *(Fact("Idealized ~", [_idealized(idealization, answer)]) for idealization in answer.idealizations),
        *chosen_fact(answer), *_current(answer), *front_fact(answer, front),
        *_yield(answer, uncertainty),
    ]  # fmt: skip
    return [fact for fact in facts if fact.parts]


_NO_BEARING = "the plain bore bears no load across the axis: your link needs a bearing of its own"
_FROZEN = {
    "joint_stiffness_in_play": "at the link, its core leaning in the bearing's play",
    "joint_stiffness_at_link@cold": "at the link, its core upright",
    "joint_stiffness@cold": "at the hub, without the link",
}
"""The three stiffnesses of the frozen joint at its cold point."""


def _creep(value: Values, answer: StudyResult) -> Iterator[str]:
    """Yield how far the frozen link creeps under a torque that lasts, with its range."""
    torque, *_ = frozen_turn(answer.design)
    entry = value.intervals.get("creep_stiffness") or {}
    low, crept, high = (
        from_si(torque / stiffness, "deg") if (stiffness := of) else None
        for of in (entry.get("high"), value.values["creep_stiffness"], entry.get("low"))
    )
    ends = "" if crept is None else range_text({"low": low, "value": crept, "high": high} if low and high else None)
    if crept is not None:
        further = f"{number(crept, 2)}°{f' ({ends})' if ends else ''}"
        yield f"the frozen link creeps by {further} in an hour under {with_unit(torque, 'N*m', 2)}, structure and PCL"
        yield "adhesives and pins are taken to creep as the structure does"


def _cost(value: Values, choices: Mapping[str, str]) -> Iterator[str]:
    """Yield what the cost of a module counts, what it leaves out, and where the sum of the order is."""
    yield from cost_in_words(value.table, value.values, choices)
    yield "quotes go in the study's module section; whole packs, consumables, supply, electronics: cad/assembly.md"


def _soft(answer: StudyResult) -> list[str]:
    """Say what soft means, and whether the layer stalls on the way."""
    stalling = stalling_in_words(answer.histories.get("softening"), answer.design.values["softening_time"])
    notes = ("dynamic stiffness counts damping, too", "plausible cases have their own value at the hot point",
             "the joint softens as slices of PCL melt, before the coldest has")  # fmt: skip
    return [soft_in_words(answer.design), *notes, *filter(None, [stalling])]


def _stiff(value: Values, answer: StudyResult) -> Iterator[str]:
    """Say what stiff means, when the layer is frozen, and what cooling by current buys."""
    yield stiff_in_words(answer.design)
    yield f"frozen {value('frozen_time')} after heating stops"
    if not answer.cooling.able:
        yield "cooled by the air alone: this heater cannot cool"
    elif not answer.cooling.used:
        yield "cooled by the air alone: no current cools"
    else:
        time = answer.cooling.unpowered.get("frozen_time", math.inf)
        yield f"{'never' if math.isinf(time) else f'{number(time, DIGITS)} s'} if the heaters are switched off"


def time_over_rise(softening: Curves, time: float) -> float:
    """Return the per cent of the softening time [s] that 1 % of the layer's rise takes; infinite without rise."""
    times = np.asarray(softening["time"])
    cells = [column for name, column in softening.items() if name.startswith("cell_")]
    mean = np.mean(np.asarray(cells), axis=0)
    slope = float(np.interp(time, times, np.gradient(mean, times)))
    rise = float(np.interp(time, times, mean)) - mean[0]
    return rise / (time * slope) if slope > 0.0 else math.inf


def stalling_in_words(softening: Curves | None, time: float) -> str:
    """Say that a layer hardly warms any more when it is soft; empty if it does, or always or never is."""
    if not softening or not 0.0 < time < math.inf:
        return ""
    steep = time_over_rise(softening, time)
    if steep < STALLS:
        return ""
    if math.isinf(steep):
        return "it stalls: a little less heat and it is never soft"
    return f"it stalls: 1 % less heat takes {steep:.0f} % longer"


def _accepts(answer: StudyResult) -> Iterator[str]:
    """Name the ratings that the study accepts, those that are exceeded and those that need not be accepted."""
    if answer.design.accepting:
        yield f"beyond the rating, as the study accepts: {', '.join(answer.design.accepting)}"
    if answer.accepted_in_vain:
        yield f"{', '.join(answer.accepted_in_vain)}: not needed, the design is within the rating"


def _idealized(idealization: Any, answer: StudyResult) -> str:
    table = answer.design.table
    required = [limit["output"] for limit in answer.design.study["require"]]
    headlines = ["spring_stiffness", "least_spring_stiffness", *(row.name for row in table.outputs if row.headline)]
    first = dict.fromkeys(name for name in (*required, *headlines) if name in idealization.as_drawn)
    shown = []
    for name in list(first)[:2]:
        unit, drawn = table.unit(name), idealization.as_drawn[name]
        there = "no module" if math.isnan(drawn) else with_unit(drawn, unit)
        shown.append(f"; {name} {in_unit(answer.design.value(name), unit)}, as drawn {there}")
    count = len(idealization.as_drawn)
    rows = f"{count} values, marked in results.csv" if count else "no value here is another for it"
    return f"{idealization.text}: {idealization.leaves_out} ({rows}){''.join(shown)}"


def front_fact(answer: StudyResult, front: Any) -> list[Fact]:
    """Return the spans of the front, if the study asks for one."""
    if front is None or not front.points:
        return []
    spans = []
    for name in front.outputs:
        unit = answer.design.table.unit(name)
        values = [from_si(point.values[name], unit) for point in front.points]
        spans.append(f"{label(name)} {ends_text(min(values), max(values))} {pretty(unit)}".rstrip())
    knee = [] if front.knee is None else [f"knee: point {front.knee + 1}"]
    return [Fact("Front", [f"{len(front.points)} designs", *spans, *knee], listing=True)]


def chosen_fact(answer: StudyResult) -> list[Fact]:
    """Return what was chosen of what is listed; with margins, what is best of the ranking, which has none."""
    choosing = answer.solution.choosing if answer.solution else None
    if choosing is None or not choosing.best:
        return []
    table, ranked = answer.design.table, choosing.best[0].choices
    own, shown = (
        {name: choice_text(name, word, table) for name, word in choices.items()}
        for choices in (own_choices(answer), ranked)
    )
    first = [f"{label(name)} {word}" for name, word in shown.items() if word != own[name]]
    count = f"of {choosing.combinations} combinations"
    if not answer.design.study.get("robust"):
        how = [f"best {count}"]
    elif first:
        how = [f"best with margins {count}", f"without margins the best is {', '.join(first)}"]
    else:
        how = [f"best {count}, ranked without margins"]
    return [Fact("Chosen", [*(f"{label(name)} {word}" for name, word in own.items()), *how], listing=True)]


def _current(answer: StudyResult) -> list[Fact]:
    """Return what currents that follow a profile buy against the best constant ones, which have no margins."""
    best = answer.solution.constant if answer.solution else None
    if best is None or not answer.has_design or answer.solution is None:
        return []
    text = f"follows a profile while {' and '.join(answer.design.current_profiles)}"
    reached = answer.yield_reached
    if reached is None:
        worse = 100.0 * (best.objective / answer.solution.objective - 1.0)
        return [Fact("Current", [f"{text}; the best constant current is {worse:.2g} % worse"])]
    gain = ", ".join(changes(answer, best.values, reached.nominal))
    return [Fact("Current", [f"{text}; without margins, from the best constant current to it: {gain}"])]


def _yield(answer: StudyResult, uncertainty: Mapping[str, Any]) -> list[Fact]:
    """Return the yield: what it covers, what margins cost if it was asked for, and what raises it."""
    share, reached, parts = uncertainty.get("parts_yield"), answer.yield_reached, []
    robust = answer.design.study.get("robust") or {}
    if share is not None:
        low, high = (f"{100.0 * share[end]:.3g}" for end in ("low", "high"))
        text = f"{percent(share['share'])} ({low} to {high}) of {uncertainty['modules']} modules meet all"
        parts.append(f"{text} {uncertainty['limits']} limits that depend on {tolerances_in_words(uncertainty)}")
        if uncertainty["left_out"]:
            parts.append(f"{len(uncertainty['left_out'])} that never happen or follow a profile are not counted")
    if reached is not None:
        cost = ", ".join(changes(answer, reached.nominal, answer.design.values))
        parts.append(f"target {percent(reached.target)}, without margins {percent(reached.nominal_together)}")
        parts.append(f"the margins take {cost}")
    elif share is not None and share["share"] < _GOOD and robust.get("share") is None:
        standard = "" if uncertainty["tolerances"] == "study" else "`tolerances: standard` and "
        raise_it = f"to raise it: {standard}`robust: {{yield: 95 %}}`"
        parts.append(raise_it if answer.solution else "which limit loses most: `tvimdesign tolerate`")
    return [Fact("Yield", parts)]


def _duty_peaks(answer: StudyResult) -> Iterator[str]:
    """Say what parts bear in the periodic cycle, and its mean power."""
    duty = answer.duty
    if duty is None or not duty.values:
        return
    for name in filter(lambda name: name.startswith("peak_"), duty.values):
        yield f"{label(name)} {with_unit(duty.values[name], 'degC', DIGITS)}"
    yield f"mean power {with_unit(duty.energy_a_day / DAY, 'W', DIGITS)}"
