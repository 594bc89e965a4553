"""The facts of a result, each a label with its parts: size, times and energy first, then what a reader may ask next."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.base.units import from_si, pretty
from tvimdesign.cad.assembly.heater_leads import temperatures_in_order
from tvimdesign.device import Table, table_for
from tvimdesign.device.core.task import ARM
from tvimdesign.report.output.choices_tables import choice_text, own_choices
from tvimdesign.report.output.numbers import (
    at_its_least,
    ends_text,
    in_labels,
    in_unit,
    label,
    number,
    percent,
    range_text,
    with_unit,
)
from tvimdesign.report.output.tables import soft_in_words, stiff_in_words
from tvimdesign.report.output.terminal import DOT
from tvimdesign.report.run.blocks.tables import requested_torque
from tvimdesign.report.run.blocks.verdict import most_in_doubt
from tvimdesign.report.run.reasons import NO_ROOM, active
from tvimdesign.report.run.uncertainty_data import changes, lever, yield_of
from tvimdesign.simulation.working_cycle.curves import Curves
from tvimdesign.solve.duty import LATE, OVERSHOOT, SHARE
from tvimdesign.solve.result import StudyResult
from tvimdesign.solve.uncertainty.design_uncertainty import share_in_doubt
from tvimdesign.study.resolve import unpriced_kinds

_DIGITS = 3
_GOOD = 0.9973  # Yield from which a module is no concern: three standard deviations to either side
DAY = 86400.0  # [s]
STALLS = 3.5
"""Per cent of time for one per cent of the temperature's rise: 1 if a layer warms evenly, 2 as the root of time."""


class Fact(NamedTuple):
    """A label, short texts that a renderer puts beside one another, and a note for which there may be no place.

    The last parts of a `listing` may be counted instead.
    """

    label: str
    parts: Sequence[str]
    note: str = ""
    listing: bool = False

    @property
    def text(self) -> str:
        """Everything in one text."""
        return DOT.join([*self.parts, *([self.note] if self.note else [])])


class _Values:
    """Values of a design for people, in three digits, with their ranges."""

    def __init__(self, answer: StudyResult, uncertainty: Mapping[str, Any]) -> None:
        self.values, self.table = answer.design.values, table_for(answer.design.mode)
        self.intervals = uncertainty.get("intervals", {})

    def __call__(self, name: str) -> str:
        """Return one value with its unit, and its range in brackets."""
        value, unit = self.values[name], self.table.unit(name)
        return f"{with_unit(value, unit, _DIGITS)}{self.ends(name)}"

    def ends(self, name: str) -> str:
        """Return the range of a value in brackets after a space; empty without one."""
        ends = range_text(self.intervals.get(name))
        return f" ({ends})" if ends else ""

    def in_percent(self, name: str, share: float) -> str:
        """Return a share of a whole, with its range, as `31 % (25 to 43)`."""
        entry, text = self.intervals.get(name), f"{100.0 * share:.0f} %"
        if entry is None or None in (entry["low"], entry["high"]):
            return text
        low, high = (100.0 * share * entry[end] / entry["value"] for end in ("low", "high"))
        return f"{text} ({low:.0f} to {high:.0f})"

    def most(self, *names: str) -> str:
        """Return the name of the largest of some that happen."""
        return max(names, key=lambda name: self.values[name] if math.isfinite(self.values[name]) else -1.0)


def main_facts(answer: StudyResult, uncertainty: Mapping[str, Any]) -> list[Fact]:
    """Return what the first screen has a line each for: size and mass, times, energy, constraints, yield, doubts.

    Ranges over unmeasured inputs stand in brackets.
    """
    value = _Values(answer, uncertainty)
    size = f"{value('envelope_diameter')} diameter x {value('envelope_height')} high"
    current = value.most("peak_current", "stiffening_peak_current")
    peaks = f"at most {value('peak_power')}, {value(current)}, {heater_voltage(answer, uncertainty)}"
    facts = [
        Fact("Size and mass", [size, value("module_mass")]),
        Fact("Times", list(_times(value)), _coldest(value)),
        *_impedance(value, min(requested_torque(answer.design), answer.design.values["holding_torque"])),
        *_drag(value),
        *_task(value, answer.design.choices),
        *_duty(answer),
        *_control(answer),
        Fact("Heating", [value("switch_energy"), peaks]),
    ]
    doubts = (*_manufacturing(answer, uncertainty), *_model(uncertainty, answer.design.study))
    return [*facts, _stroke(value), *_active_constraints(answer), *doubts]


def heater_voltage(answer: StudyResult, uncertainty: Mapping[str, Any]) -> str:
    """Return the heater's largest voltage with its range, and the supply's if a driver must step it down."""
    value, supplied = _Values(answer, uncertainty), answer.design.supply_voltage
    if supplied:
        return f"{value('peak_voltage')} of the supply's {with_unit(supplied, 'V', _DIGITS)}"
    return value(value.most("peak_voltage", "stiffening_peak_voltage"))


def _times(value: _Values) -> Iterator[str]:
    """Yield when the joint is soft, and, from the end of heating, when it is stiff and when it may be loaded fully."""
    names = ("response_time", "softening_time", "stiffening_time", "far_face_cooling_time")
    heated, soft, stiff, cold = (value.values[name] for name in names)
    by_criterion = "" if soft == heated else f"{value('response_time')}, by impedance "
    yield "never soft" if math.isinf(soft) else f"softening time {by_criterion}{value('softening_time')}"
    if math.isfinite(stiff):
        loaded = f", full load after {with_unit(cold, 's', _DIGITS)}" if stiff < cold < math.inf else ""
        yield f"stiff {value('stiffening_time')} later{loaded}"
    elif math.isfinite(soft):
        yield "never stiff again"


def _coldest(value: _Values) -> str:
    """Return the temperature that all PCL exceeds as heating stops, in whole degrees; empty if it never stops."""
    reached = from_si(value.values["softened_temperature"], "degC")
    if not math.isfinite(reached):
        return ""
    entry = value.intervals.get("softened_temperature")
    known = entry is not None and None not in (entry["low"], entry["high"])
    ends = range_text({end: round(entry[end]) for end in ("low", "value", "high")}) if known else ""
    return f"PCL above {reached:.0f} {pretty('degC')}{f' ({ends})' if ends else ''}"


def _stroke(value: _Values) -> Fact:
    """Return the stroke, what of it is lost to play, and friction over spring torque; the note names what adds most.

    A lock has no spring torque.
    """
    names = [name for name in _LOSES if name in value.values]
    lost, *others = (value.in_percent(name, value.values[name]) for name in names)
    stroke, play = (f"±{from_si(value.values[name], 'deg'):.3g}°" for name in ("stroke", "lost_motion"))
    most = [label(max(_LOSES[name], key=lambda source: value.values[source])) for name in names]
    note = f"most by {' and '.join(dict.fromkeys(most))}"
    return Fact(
        "Stroke",
        [f"{stroke}, less {play} of play, {lost}", *(f"friction {share} of spring torque" for share in others)],
        note,
    )


_LOSES = {
    "lost_motion_share": ("friction_play", "link_play", "bearing_play"),
    "friction_share": ("pin_friction_torque", "bearing_friction_torque", "preload_friction_torque"),
}


def _impedance(value: _Values, torque: float) -> list[Fact]:
    """Return the link's stiffness frozen, with its angle under a torque, as heating stops, and with its damping.

    Frozen, the core leans if the torque leaves the bearing some of its play. None if heating never stops.
    """
    if math.isinf(value.values["softened_stiffness"]):
        return []
    unit = value.table.unit("softened_stiffness")
    upright, leaning = "joint_stiffness_at_link@cold", "joint_stiffness_in_play"
    held, free = torque / value.values[upright] + value.values["bearing_play"], torque / value.values[leaning]
    frozen, soft = (
        f"{in_unit(value.values[name], unit, _DIGITS)}{value.ends(name)}"
        for name in (leaning if free < held else upright, "softened_stiffness")
    )
    ends = f"{from_si(value.values['softened_temperature'], 'degC'):.0f} {pretty('degC')}"
    play = "" if free < held or not value.values["bearing_play"] else " with the bearing's play"
    turned = f"turns {from_si(min(free, held), 'deg'):.2g}°{play} at {with_unit(torque, 'N*m', 2)}"
    damped = f"with damping {in_unit(value.values['softened_impedance'], unit, _DIGITS)}"
    return [Fact(f"Link, {pretty(unit)}", [f"frozen {frozen}: {turned}", f"soft at {ends} {soft}"], damped)]


def _drag(value: _Values) -> list[Fact]:
    """Return what the frozen joint holds, and what turns the molten joint; none of a joint with springs."""
    if "drag_torque" not in value.values:
        return []
    turned = f"drags {value('drag_torque')} molten at {value('turn_speed')}"
    return [Fact("Lock", [f"holds {value('holding_torque')} frozen", turned])]


def _task(value: _Values, choices: Mapping[str, str]) -> list[Fact]:
    """Return the load that the frozen joint holds with its safety, and its sag; none without a task."""
    if choices.get("task") != ARM:
        return []
    torque, safety = value("task_torque@cold"), number(value.values["load_safety"], _DIGITS)
    load = f"{value('payload')} at {value('arm_length')}"
    return [Fact("Task", [f"holds {load}: {torque} x safety {safety}", f"sags {value('sag@cold')} frozen"])]


def _duty(answer: StudyResult) -> list[Fact]:
    """Return what repeated switching makes of times and temperatures, and the most that keeps the ratings."""
    duty, rate = answer.duty, answer.design.study.get("duty", {}).get("switches_per_hour")
    if duty is None:
        return []
    limit = "time" if duty.limited_by == "time" else label(duty.limited_by)
    most = f"at most {number(duty.most, _DIGITS)} (limit: {limit})"
    if not duty.values:
        return [Fact("Duty", [f"{number(rate, _DIGITS)} switches an hour leave too little time", most])]
    pads = with_unit(duty.values["peak_heater_temperature"], "degC", _DIGITS)
    above = [f"exceeds {', '.join(map(label, duty.exceeded))}"] if duty.exceeded else []
    times = " and back ".join(with_unit(duty.values[name], "s", _DIGITS) for name in ("response_time", "return_time"))
    energy = f"{with_unit(duty.energy_a_day, 'kJ', _DIGITS)} a day"
    note = f"periodic after {with_unit(duty.settling, 'min', _DIGITS)}"
    parts = [f"{number(rate, _DIGITS)} switches an hour", f"switch {times}", f"heater {pads}", energy, *above, most]
    return [Fact("Duty", parts, note)]


def _control(answer: StudyResult) -> list[Fact]:
    """Return what the heater's controller does on drawn modules."""
    control = answer.control
    if control is None:
        return []
    times = [f"{number(time, _DIGITS)}" for time in (control.settling, control.settling_of_nominal)]
    parts = [
        f"overshoot {number(control.overshoot, _DIGITS)} K",
        f"softening time {times[0]} of the module's own, {times[1]} of the nominal one",
        f"pads {with_unit(control.hottest_pads, 'degC', _DIGITS)}",
        f"{percent(control.controlled.share)} below {number(OVERSHOOT)} K and {number(LATE)}",
    ]
    return [Fact("Control", parts, f"at most, of {percent(SHARE)} of the modules drawn")]


def _duty_peaks(answer: StudyResult) -> Iterator[str]:
    """Say what parts bear in the periodic cycle, and its mean power."""
    duty = answer.duty
    if duty is None or not duty.values:
        return
    for name in filter(lambda name: name.startswith("peak_"), duty.values):
        yield f"{label(name)} {with_unit(duty.values[name], 'degC', _DIGITS)}"
    yield f"mean power {with_unit(duty.energy_a_day / DAY, 'W', _DIGITS)}"


def _active_constraints(answer: StudyResult) -> list[Fact]:
    """Return the active constraints in words, the costliest first, with what a step of the first is worth."""
    held = active(answer)
    if not held:
        return []
    outputs = list(answer.design.study["minimize"])
    of = label(outputs[0]) if len(outputs) == 1 else "objective"
    worth = f"{held[0].step} of the first is worth {held[0].shadow_price:.2g} % of the {of}"
    note = worth if held[0].shadow_price <= NO_ROOM else f"no room for {held[0].step} of the first"
    title = "Active constraints with margins" if answer.design.study.get("robust") else "Active constraints"
    return [Fact(title, [at_its_least(constraint.text) for constraint in held], note, listing=True)]


def _manufacturing(answer: StudyResult, uncertainty: Mapping[str, Any]) -> list[Fact]:
    """Return the yield; below the one asked for, what it is lost to and what raises it; none if it was not computed."""
    if not uncertainty:
        return []
    share = uncertainty["parts_yield"]
    if share is None:
        return [Fact("Manufacturing", [f"no limit depends on {_tolerances(uncertainty)}"])]
    whole = math.floor(100.0 * share["share"] + 1e-9)
    count = "fewer than 1" if whole == 0 and share["share"] > 0.0 else f"{whole}"
    reached = yield_of(answer)
    if reached and reached.tightened and reached.lost_to:
        worst = reached.lost_to[0]
        lost = f"{count} of 100 modules meet every limit, {percent(worst.share)} meet {in_labels(worst.text)}"
        return [Fact("Manufacturing", [lost, *lever(reached, table_for(answer.design.mode))])]
    text = f"{count} of 100 modules meet every limit if assumed values hold"
    return [Fact("Manufacturing", [text], f"by {_tolerances(uncertainty)}")]


def _model(uncertainty: Mapping[str, Any], study: Mapping[str, Any]) -> list[Fact]:
    """Return the share of cases that meet every limit, and the limit that the fewest meet; none without ranges."""
    if not uncertainty or uncertainty["ranges_hold"] is None:
        return []
    name, share = most_in_doubt(uncertainty)
    if not name:
        return [Fact("Model", ["every limit is met whatever the unmeasured inputs are in their ranges"])]
    least, draws = share_in_doubt((study.get("robust") or {}).get("plausible")), uncertainty["draws"]
    every = f"{round(draws * uncertainty['ranges_hold']['share'])} of {draws} plausible cases meet every limit"
    needs = f"it needs {uncertainty['needs']}" if uncertainty.get("needs") else ""
    count = sum(met < least for met in uncertainty["held"].values())
    more = f"{count} limits in under {percent(least)}" if count else ""
    text = f"{every}; {label(name)} met in {percent(share, 2)}"
    return [Fact("Model", [text], DOT.join(filter(None, [needs, more])))]


def study_fact(answer: StudyResult) -> list[Fact]:
    """Return what the study says of itself, if anything."""
    text = " ".join(answer.design.study.get("description", "").split())
    return [Fact("Study", [text])] if text else []


def more_facts(answer: StudyResult, uncertainty: Mapping[str, Any], front: Any) -> list[Fact]:
    """Return what `--full` and the page add: thresholds, cooling, idealizations, choices, yield."""
    table, value = table_for(answer.design.mode), _Values(answer, uncertainty)
    facts = [
        Fact("Soft", _soft(answer)),
        Fact("Stiff", list(_stiff(value, answer))),
        Fact("Temperatures", [" < ".join(f"{words} {from_si(kelvin, 'degC'):.0f} {pretty('degC')}"
                                         for words, kelvin in temperatures_in_order(answer.design).items())]),
        Fact("Frozen", [f"{value(name)} {words}" for name, words in _FROZEN.items() if name in value.values]),
        Fact("Held", list(_creep(value, answer))),
        Fact("Duty", list(_duty_peaks(answer))),
        Fact("Accepts", list(_accepts(answer))),
        Fact("Cost", list(_cost(value, answer.design.choices))),
        *(Fact("Idealized ~", [_idealized(idealization, answer, table)]) for idealization in answer.idealizations),
        *chosen_fact(answer), *_current(answer, table), *front_fact(front, table),
        *_yield(answer, uncertainty, table),
    ]  # fmt: skip
    return [fact for fact in facts if fact.parts]


_FROZEN = {
    "joint_stiffness_in_play": "at the link, its core leaning in the bearing's play",
    "joint_stiffness_at_link@cold": "at the link, its core upright",
    "joint_stiffness@cold": "at the hub, without the link",
}
"""The three stiffnesses of the frozen joint at its cold point."""


def _creep(value: _Values, answer: StudyResult) -> Iterator[str]:
    """Yield how far the frozen link creeps under a torque that lasts, with its range."""
    torque = min(requested_torque(answer.design), value.values["holding_torque"])
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


def _cost(value: _Values, choices: Mapping[str, str]) -> Iterator[str]:
    """Yield what one module uses, as far as it has a price, and what has none; whole packs are counted by the bill."""
    yield f"{value('cost')} of priced material and shares of packs in one module, without work"
    if missing := unpriced_kinds(value.table, value.values, choices):
        yield f"without a price, so not in it: {', '.join(missing)}; enter quotes in the study's module section"
    yield "whole packs, supply and electronics to buy: cad/assembly.md"


def _soft(answer: StudyResult) -> list[str]:
    """Say what soft means, and whether the layer stalls on the way."""
    stalling = stalling_in_words(answer.histories.get("softening"), answer.design.values["softening_time"])
    notes = ("a plausible case is measured by its own hot", "|Z| has stiffness and damping",
             "molten slices soften the PCL before its coldest melts")  # fmt: skip
    return [soft_in_words(answer.design, table_for(answer.design.mode)), *notes, *filter(None, [stalling])]


def _stiff(value: _Values, answer: StudyResult) -> Iterator[str]:
    """Say what stiff means, when the layer is frozen, and what cooling by current buys."""
    yield stiff_in_words(answer.design, table_for(answer.design.mode))
    yield f"frozen {value('frozen_time')} after heating stops"
    if not answer.cooling.able:
        yield "cooled by the air alone: this heater cannot cool"
    elif not answer.cooling.used:
        yield "cooled by the air alone: no current cools"
    else:
        time = answer.cooling.unpowered.get("frozen_time", math.inf)
        yield f"{'never' if math.isinf(time) else f'{number(time, _DIGITS)} s'} if the heaters are switched off"


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


def _idealized(idealization: Any, answer: StudyResult, table: Table) -> str:
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


def front_fact(front: Any, table: Table) -> list[Fact]:
    """Return the spans of the front, if the study asks for one."""
    if front is None or not front.points:
        return []
    spans = []
    for name in front.outputs:
        values, unit = [from_si(point.values[name], table.unit(name)) for point in front.points], table.unit(name)
        spans.append(f"{label(name)} {ends_text(min(values), max(values))} {pretty(unit)}".rstrip())
    knee = [] if front.knee is None else [f"knee: point {front.knee + 1}"]
    return [Fact("Front", [f"{len(front.points)} designs", *spans, *knee], listing=True)]


def chosen_fact(answer: StudyResult) -> list[Fact]:
    """Return what was chosen of what is listed; with margins, what is best of the ranking, which has none."""
    choosing = answer.solution.choosing if answer.solution else None
    if choosing is None or not choosing.best:
        return []
    table, ranked = table_for(answer.design.mode), choosing.best[0].choices
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


def _current(answer: StudyResult, table: Table) -> list[Fact]:
    """Return what currents that follow a profile buy against the best constant ones, which have no margins."""
    best = answer.solution.constant if answer.solution else None
    if best is None or not answer.has_design or answer.solution is None:
        return []
    text = f"follows a profile while {' and '.join(answer.design.current_profiles)}"
    reached = yield_of(answer)
    if reached is None:
        worse = 100.0 * (best.objective / answer.solution.objective - 1.0)
        return [Fact("Current", [f"{text}; the best constant current is {worse:.2g} % worse"])]
    gain = ", ".join(changes(answer, best.values, reached.nominal, table))
    return [Fact("Current", [f"{text}; without margins, from the best constant current to it: {gain}"])]


def _yield(answer: StudyResult, uncertainty: Mapping[str, Any], table: Table) -> list[Fact]:
    """Return the yield: what it covers, what margins cost if it was asked for, and what raises it."""
    share, reached, parts = uncertainty.get("parts_yield"), yield_of(answer), []
    robust = answer.design.study.get("robust") or {}
    if share is not None:
        low, high = (f"{100.0 * share[end]:.3g}" for end in ("low", "high"))
        text = f"{percent(share['share'])} ({low} to {high}) of {uncertainty['modules']} modules meet all"
        parts.append(f"{text} {uncertainty['limits']} limits that depend on {_tolerances(uncertainty)}")
        if uncertainty["left_out"]:
            parts.append(f"{len(uncertainty['left_out'])} that never happen or follow a profile are not counted")
    if reached is not None:
        cost = ", ".join(changes(answer, reached.nominal, answer.design.values, table))
        parts.append(f"target {percent(reached.target)}, without margins {percent(reached.nominal_together)}")
        parts.append(f"the margins cost {cost}")
    elif share is not None and share["share"] < _GOOD and robust.get("share") is None:
        standard = "" if uncertainty["tolerances"] == "study" else "`tolerances: standard` and "
        raise_it = f"to raise it: {standard}`robust: {{yield: 95 %}}`"
        parts.append(raise_it if answer.solution else "which limit loses most: `tvimdesign tolerate`")
    return [Fact("Yield", parts)]


def _tolerances(uncertainty: Mapping[str, Any]) -> str:
    return "the study's tolerances" if uncertainty["tolerances"] == "study" else "the usual tolerances"
