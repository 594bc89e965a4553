"""The facts of a result that the first screen has, each a label with its parts: size, times, energy, yield, doubts."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device.core.task import ARM
from tvimdesign.report.output.numbers import (
    at_its_minimum,
    in_labels,
    in_unit,
    label,
    number,
    percent,
    range_text,
    with_unit,
)
from tvimdesign.report.output.terminal import DOT
from tvimdesign.report.run.blocks.verdict import meet_every_limit, most_in_doubt
from tvimdesign.report.run.blocks.warnings import frozen_turn
from tvimdesign.report.run.reasons import NO_ROOM, active
from tvimdesign.report.run.uncertainty_data import lever
from tvimdesign.solve.duty import LATE, OVERSHOOT, SHARE
from tvimdesign.solve.result import StudyResult
from tvimdesign.solve.uncertainty.design_uncertainty import share_in_doubt

DIGITS = 3


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


class Values:
    """Values of a design for people, in three digits, with their ranges."""

    def __init__(self, answer: StudyResult, uncertainty: Mapping[str, Any]) -> None:
        self.values, self.table = answer.design.values, answer.design.table
        self.intervals = uncertainty.get("intervals", {})

    def __call__(self, name: str) -> str:
        """Return one value with its unit, and its range in brackets."""
        value, unit = self.values[name], self.table.unit(name)
        return f"{with_unit(value, unit, DIGITS)}{self.ends(name)}"

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
    value = Values(answer, uncertainty)
    size = f"{value('envelope_diameter')} diameter x {value('envelope_height')} high"
    current = value.most("peak_current", "stiffening_peak_current")
    peaks = f"at most {value('peak_power')}, {value(current)}, {heater_voltage(answer, uncertainty)}"
    facts = [
        Fact("Size and mass", [size, value("module_mass")]),
        Fact("Times", list(_times(value)), _coldest(value)),
        *_impedance(value, *frozen_turn(answer.design)),
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
    value, supplied = Values(answer, uncertainty), answer.design.supply_voltage
    if supplied:
        return f"{value('peak_voltage')} of the supply's {with_unit(supplied, 'V', DIGITS)}"
    return value(value.most("peak_voltage", "stiffening_peak_voltage"))


def _times(value: Values) -> Iterator[str]:
    """Yield when the joint is soft, and, from the end of heating, when it is stiff and when it may be loaded fully."""
    names = ("response_time", "softening_time", "stiffening_time", "far_face_cooling_time")
    heated, soft, stiff, cold = (value.values[name] for name in names)
    by_criterion = "" if soft == heated else f"{value('response_time')}, by stiffness "
    yield "never soft" if math.isinf(soft) else f"softening time {by_criterion}{value('softening_time')}"
    if math.isfinite(stiff):
        loaded = f", full load in {with_unit(cold, 's', DIGITS)}" if stiff < cold < math.inf else ""
        yield f"then stiff in {value('stiffening_time')}{loaded}"
    elif math.isfinite(soft):
        yield "never stiff again"


def _coldest(value: Values) -> str:
    """Return the temperature that all PCL exceeds as heating stops, in whole degrees; empty if it never stops."""
    reached = from_si(value.values["softened_temperature"], "degC")
    if not math.isfinite(reached):
        return ""
    entry = value.intervals.get("softened_temperature")
    known = entry is not None and None not in (entry["low"], entry["high"])
    ends = range_text({end: round(entry[end]) for end in ("low", "value", "high")}) if known else ""
    return f"PCL heated above {reached:.0f} {pretty('degC')}{f' ({ends})' if ends else ''}"


def _stroke(value: Values) -> Fact:
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
        [f"{stroke}, less {play} lost, {lost}", *(f"friction {share} of spring torque" for share in others)],
        note,
    )


_LOSES = {
    "lost_motion_share": ("friction_play", "link_play", "bearing_play"),
    "friction_share": ("pin_friction_torque", "bearing_friction_torque", "preload_friction_torque"),
}


def _impedance(value: Values, torque: float, angle: float, stiffness: str) -> list[Fact]:
    """Return the link's stiffness frozen, with its angle under a torque, as heating stops, and with its damping.

    None if heating never stops.
    """
    if math.isinf(value.values["softened_stiffness"]):
        return []
    unit = value.table.unit("softened_stiffness")
    frozen, soft = (
        f"{in_unit(value.values[name], unit, DIGITS)}{value.ends(name)}" for name in (stiffness, "softened_stiffness")
    )
    ends = f"{from_si(value.values['softened_temperature'], 'degC'):.0f} {pretty('degC')}"
    upright = stiffness == "joint_stiffness_at_link@cold" and value.values["bearing_play"]
    play = " with the bearing's play" if upright else ""
    turned = f"turns {from_si(angle, 'deg'):.2g}°{play} at {with_unit(torque, 'N*m', 2)}"
    damped = f"with damping {in_unit(value.values['softened_impedance'], unit, DIGITS)}"
    return [Fact(f"Link, {pretty(unit)}", [f"frozen {frozen}: {turned}", f"soft at {ends} {soft}"], damped)]


def _drag(value: Values) -> list[Fact]:
    """Return what the frozen joint holds, and what turns the molten joint; none of a joint with springs."""
    if "drag_torque" not in value.values:
        return []
    turned = f"drags {value('drag_torque')} molten at {value('turn_speed')}"
    return [Fact("Lock", [f"holds {value('holding_torque')} frozen", turned])]


def _task(value: Values, choices: Mapping[str, str]) -> list[Fact]:
    """Return the load that the frozen joint holds with its safety, and its sag; none without a task."""
    if choices.get("task") != ARM:
        return []
    torque, safety = value("task_torque@cold"), number(value.values["load_safety"], DIGITS)
    load = f"{value('payload')} at {value('arm_length')}"
    return [Fact("Task", [f"holds {load}: {torque} x safety {safety}", f"sags {value('sag@cold')} frozen"])]


def _duty(answer: StudyResult) -> list[Fact]:
    """Return what repeated switching makes of times and temperatures, and the most that keeps the ratings."""
    duty, rate = answer.duty, answer.design.study.get("duty", {}).get("switches_per_hour")
    if duty is None:
        return []
    limit = "time" if duty.limited_by == "time" else label(duty.limited_by)
    most = f"at most {number(duty.most, DIGITS)} (limit: {limit})"
    if not duty.values:
        return [Fact("Duty", [f"{number(rate, DIGITS)} switches an hour leave too little time", most])]
    pads = with_unit(duty.values["peak_heater_temperature"], "degC", DIGITS)
    above = [f"exceeds {', '.join(map(label, duty.exceeded))}"] if duty.exceeded else []
    times = " and back ".join(with_unit(duty.values[name], "s", DIGITS) for name in ("response_time", "return_time"))
    energy = f"{with_unit(duty.energy_a_day, 'kJ', DIGITS)} a day"
    note = f"periodic after {with_unit(duty.settling, 'min', DIGITS)}"
    parts = [f"{number(rate, DIGITS)} switches an hour", f"switch {times}", f"heater {pads}", energy, *above, most]
    return [Fact("Duty", parts, note)]


def _control(answer: StudyResult) -> list[Fact]:
    """Return what the heater's controller does on drawn modules."""
    control = answer.control
    if control is None:
        return []
    times = [f"{number(time, DIGITS)}" for time in (control.settling, control.settling_of_nominal)]
    parts = [
        f"overshoot {number(control.overshoot, DIGITS)} K",
        f"softening time {times[0]} of the module's own, {times[1]} of the nominal one",
        f"pads {with_unit(control.hottest_pads, 'degC', DIGITS)}",
        f"{percent(control.controlled.share)} below {number(OVERSHOOT)} K and {number(LATE)}",
    ]
    return [Fact("Control", parts, f"at most, of {percent(SHARE)} of the modules drawn")]


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
    return [Fact(title, [at_its_minimum(constraint.text) for constraint in held], note, listing=True)]


def _manufacturing(answer: StudyResult, uncertainty: Mapping[str, Any]) -> list[Fact]:
    """Return the yield; below the one asked for, what it is lost to and what raises it; none if it was not computed."""
    if not uncertainty:
        return []
    share = uncertainty["parts_yield"]
    if share is None:
        return [Fact("Manufacturing", [f"no limit depends on {tolerances_in_words(uncertainty)}"])]
    whole = math.floor(100.0 * share["share"] + 1e-9)
    count = "fewer than 1" if whole == 0 and share["share"] > 0.0 else f"{whole}"
    reached = answer.yield_reached
    if reached and reached.tightened and reached.lost_to:
        worst = reached.lost_to[0]
        lost = f"{count} of 100 modules meet every limit, {percent(worst.share)} meet {in_labels(worst.text)}"
        return [Fact("Manufacturing", [lost, *lever(answer)])]
    text = f"{count} of 100 modules meet every limit if assumed values hold"
    return [Fact("Manufacturing", [text], f"by {tolerances_in_words(uncertainty)}")]


def tolerances_in_words(uncertainty: Mapping[str, Any]) -> str:
    """Say whose tolerances a yield is by."""
    return "the study's tolerances" if uncertainty["tolerances"] == "study" else "the usual tolerances"


def _model(uncertainty: Mapping[str, Any], study: Mapping[str, Any]) -> list[Fact]:
    """Return the share of cases that meet every limit, and the limit that the fewest meet; none without ranges."""
    if not uncertainty or uncertainty["ranges_hold"] is None:
        return []
    name, share = most_in_doubt(uncertainty)
    if not name:
        return [Fact("Model", ["every limit is met whatever the unmeasured inputs are in their ranges"])]
    missed = [1.0 - met for met in uncertainty["held"].values()]
    each = sum(missed) / (1.0 - uncertainty["ranges_hold"]["share"])  # of the cases that violate any
    others = f"the others violate {each:.2g} limits on average"
    needs = f"needs {uncertainty['needs']}" if uncertainty.get("needs") else ""
    least = share_in_doubt((study.get("robust") or {}).get("plausible"))
    count = sum(1.0 - share < least for share in missed)
    more = f"{count} limits are each met in under {percent(least)} of these cases" if count else ""
    worst = f"{label(name)} met in {percent(share, 2)}"
    return [Fact("Model", [meet_every_limit(uncertainty)], DOT.join(filter(None, [needs, others, worst, more])))]


def study_fact(answer: StudyResult) -> list[Fact]:
    """Return what the study says of itself, if anything."""
    text = " ".join(answer.design.study.get("description", "").split())
    return [Fact("Study", [text])] if text else []
