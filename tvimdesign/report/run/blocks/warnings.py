"""Warnings of a run, the gravest first, each with a line of the study that may cure it."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.record import own_data, plain_data
from tvimdesign.base.units import format_quantity, from_si
from tvimdesign.cad.assembly.heater_leads import fuse_to_ask_for
from tvimdesign.report.output.numbers import held_by, label, with_unit
from tvimdesign.report.output.terminal import duration
from tvimdesign.report.run.reasons import endings
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE
from tvimdesign.solve.remedies import Remedies, Remedy
from tvimdesign.solve.result import StudyResult
from tvimdesign.study import Design

LOOSE = 0.05  # Share of the first swing without contact from which on small motions say little of the joint
_PLACE = re.compile(r"<(\w+)>")
TURNED = 0.1  # Share of the stroke from which on a turn of the frozen joint is warned of
TEMPERATURE = 0.5  # Kelvin by which heating may stop below the hot point
SHOWN = 3  # Warnings of the first screen; their remedies are tried
_LEVELS = ("grave", "serious", "")
_VARY = "vary the current or a size, and try"
"""What a study that varies nothing is advised, if a requirement is the cure."""
_OTHER_SIZES = "with other sizes, try"  # Advice where a part or material does not cure with the sizes of the design


class RunWarning(NamedTuple):
    """A warning: its text, what cures it, and its level: `grave` (nobody should build it so), `serious` or none."""

    text: str
    cure: str = ""
    """A line of the study behind *write* if it was tried, behind *may help:* if it was not, else in words."""
    level: str = ""
    but: str = ""  # Clause of the verdict on a part that is not to be had, or on a grave warning


def warnings_of(answer: StudyResult, doubts: Sequence[str], deadline: Deadline = NEVER) -> list[RunWarning]:
    """Return the warnings of a result, the gravest first; `doubts` are contradictions within chosen records.

    Remedies of those that the first screen shows are tried until the deadline.
    """
    from_records = [_other("doubt", line=doubt) for doubt in doubts]
    if not answer.has_design:
        return from_records
    remedies = Remedies(answer, deadline)
    own = [*_of_the_module(answer), *_of_frozen_turn(answer, remedies), *_of_advice(answer, remedies),
           *_of_points(answer), *_of_the_search(answer)]  # fmt: skip
    return sorted([*own, *from_records], key=lambda warning: _LEVELS.index(warning.level))


hints = partial(own_data, __file__, "warnings.yaml")  # Texts on each advice and rating, and on what else is warned of


def _hint(name: str, value: float = -math.inf) -> dict[str, Any]:
    """Return the entry of a warning with a value [SI]; empty if it has none."""
    entry = dict((hints()["ratings"] | hints()["advice"] | hints()["others"]).get(name, {}))
    return entry | entry["above"] if "above" in entry and value > entry["above"]["value"] else entry


def filled(text: str, places: Mapping[str, str]) -> str:
    """Return a text with its places filled in."""
    return _PLACE.sub(lambda match: places.get(match[1], match[0]), text)


def _other(kind: str, **places: str) -> RunWarning:
    entry = hints()["others"][kind]
    text, cure = filled(entry["say"], places).rstrip("."), f"may help: {filled(entry['mend'], places)}"
    return RunWarning(text, cure, entry.get("level", ""), entry.get("but", ""))


def _of_the_module(answer: StudyResult) -> Iterator[RunWarning]:
    if answer.design.choices.get("heater_fuse") == "none":
        yield _other("unguarded")
    if math.isinf(answer.design.value("response_time")):
        yield _other("never_soft")
    elif math.isinf(answer.design.value("stiffening_time")):
        yield _other("never_stiff")


def requested_torque(design: Design) -> float:
    """Return the torque [N*m] that the study asks the frozen joint to hold, or the one that is held."""
    requested = [limit["limit"] for limit in design.study["require"]
             if (limit["output"], limit["sense"]) == ("holding_torque", ">=")]  # fmt: skip
    return max(requested, default=0.0) or design.values["holding_torque"]


def frozen_turn(design: Design) -> tuple[float, float, str]:
    """Return the torque [N*m] on the frozen joint, the angle it turns the link, and the stiffness on which that rests.

    The core leans if the torque leaves the bearing some of its play.
    """
    values, torque = design.values, min(requested_torque(design), design.values["holding_torque"])
    upright, leaning = "joint_stiffness_at_link@cold", "joint_stiffness_in_play"
    held, free = torque / values[upright] + values["bearing_play"], torque / values[leaning]
    return (torque, free, leaning) if free < held else (torque, held, upright)


def _of_frozen_turn(answer: StudyResult, remedies: Remedies) -> Iterator[RunWarning]:
    """Compare the angle that the frozen joint turns under its torque with the stroke."""
    (torque, angle, _), stroke = frozen_turn(answer.design), answer.design.values["stroke"]
    share = angle / stroke
    if not share > TURNED:
        return
    hint, stiffness = _hint("frozen_turn", share), f"{torque / (TURNED * stroke):.3g}"
    places = {
        "angle": format_quantity(angle, "deg", 2), "torque": format_quantity(torque, "N*m", 2),
        "share": f"{100.0 * share:.0f} %", "stiffness": stiffness,
    }  # fmt: skip
    remedy = remedies.of("joint_stiffness_in_play", [filled(hint["mend"], places)])
    say, but = (filled(hint.get(key, ""), places) for key in ("say", "but"))
    cure = _cure(answer, remedy) if answer.solution is not None else ""
    if not cure or remedy.bound:  # sizes alone do not cure
        cure = "; ".join(filter(None, [cure, hint["else"]]))
    yield RunWarning(say, cure, hint.get("level", ""), but)


def _cure(answer: StudyResult, remedy: Remedy) -> str:
    """Return a remedy in words, by what trying it showed."""
    if answer.solution is None and remedy.line.startswith("require:"):
        return f"{_VARY} {remedy.line}"
    how = "write" if remedy.tried else _OTHER_SIZES if remedy.failed else "may help:"
    if remedy.bound is None:
        return f"{how} {remedy.line}" if remedy.line else ""
    output, is_most, (value, limits) = remedy.bound
    most = with_unit(value, answer.design.table.unit(output), 3)
    return f"{held_by(limits)} limit the {label(output)} to at {'most' if is_most else 'least'} {most}"


def _of_advice(answer: StudyResult, remedies: Remedies) -> Iterator[RunWarning]:
    """Yield ratings and advice that the design does not follow, the gravest first."""
    table, above = answer.design.table, answer.design.above_rating
    levels = {check.output: "grave" if check.output in above else _hint(check.output, check.value).get("level", "")
              for check in answer.warnings}  # fmt: skip
    harmless = "" if missed_points(answer) else "hot_point_margin"
    levels[harmless] = ""
    for place, check in enumerate(sorted(answer.warnings, key=lambda check: _LEVELS.index(levels[check.output]))):
        lines = [] if check.output == harmless else lines_of(check.output, answer)
        cure = _cure(answer, remedies.of(check.output, lines, cheap=place >= SHOWN))
        cure = cure or filled(_hint(check.output).get("ask", ""), {"fuse": fuse_to_ask_for(answer.design)})
        if check.output in above:
            cure = f"{cure} or accept: [{check.output}]".removeprefix(" or ")
        text = advice_text(check.output, check.value, check.origin, table.unit(check.output))
        yield RunWarning(text, cure, levels[check.output], _hint(check.output, check.value).get("but", ""))


def advice_text(output: str, value: float, origin: str, unit: str) -> str:
    """Return advice or a rating that is not followed, with its value (SI) and its reason, `origin` or a shorter one."""
    hint, shown = _hint(output, value), format_quantity(value, unit, 3)
    if "text" in hint:
        return filled(hint["text"], {"size": shown.lstrip("-"), "share": f"{100.0 * abs(value):.2g} %"})
    return f"{label(output)} is {shown}: {hint.get('say', origin)}"


def lines_of(output: str, answer: StudyResult) -> list[str]:
    """Return the lines that may cure an advice or a rating, but for choices that the design has already."""
    hot = f"{from_si(answer.design.values.get('temperature@hot', 0.0), 'degC'):.4g} degC"
    lines = [filled(line, {"hot": hot}) for line in _hint(output).get("mend", ())]
    choices = answer.design.choices.items()
    return [line for line in lines if not set(plain_data(line).get("module", {"": ""}).items()) <= set(choices)]


def _of_points(answer: StudyResult) -> Iterator[RunWarning]:
    points = answer.design.study["operating_points"]
    melting = [point for point in points if f"solid_fraction@{point}" in answer.intervals]
    for point in melting:
        yield _other("melting_range", point=point)
    for check in answer.undecided:
        yield _other("undecided", limit=check.text, point=next(iter(melting), "hot"))
    for point in points:
        lost = answer.design.values.get(f"contact_lost@{point}", 0.0)
        if lost > LOOSE:
            yield _other("contact_lost", point=point, share=f"{100.0 * lost:.2g} %")


def _of_the_search(answer: StudyResult) -> Iterator[RunWarning]:
    solution = answer.solution
    if solution is None:
        return
    if solution.out_of_time is not None:
        yield _other("out_of_time", seconds=duration(solution.out_of_time))
    distinct = solution.distinct_optima()  # none if only a search from elsewhere ended in an optimum
    best, others = distinct[:1], distinct[1:]
    if others:
        objective, least = (f"{start.objective:.5g}" for start in (others[0], best[0]))
        stage = " before margins" if answer.design.study.get("robust") else ""
        yield _other("another_optimum", objective=objective, best=least, stage=stage)
    for line in endings(solution.free_starts):
        yield _other("not_converged", line=line)


def missed_points(answer: StudyResult) -> dict[str, str]:
    """Return operating points that heating does not reach, each with an output that misses its limit where it stops.

    An output that is not known there counts as missed.
    """
    values = answer.design.values
    return {
        point: limit["output"]
        for point in unreached_points(values)
        for limit in answer.design.study["require"]
        if _misses(limit, point, answer.design)
    }


def unreached_points(values: Mapping[str, float]) -> list[str]:
    """Return the operating points that are warmer than the layer's coldest face ever is."""
    reached = values.get("softened_temperature", math.inf)
    temperatures = {name.partition("@")[2]: value for name, value in values.items() if name.startswith("temperature@")}
    return [point for point, temperature in temperatures.items() if temperature > reached + TEMPERATURE]


def _misses(limit: Mapping[str, Any], point: str, design: Design) -> bool:
    """Return whether a requirement at a point is not met when heating stops; True if that is not known."""
    name, at_end = limit["output"], design.table.output(limit["output"]).at_end
    if (name.partition("@")[2] or (at_end and "hot")) != point:
        return False
    if not at_end or point != "hot":
        return True
    over = design.values[at_end] - limit["limit"]
    return not (-over if limit["sense"] == ">=" else over) <= CYCLE_TOLERANCE * abs(limit["limit"])
