"""The tables of a result, one function each; a renderer prints or shows them."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.device import Input, Output, Table
from tvimdesign.report.output.choices_tables import choice_text, shares
from tvimdesign.report.output.numbers import ends_text, in_unit, label, number, percent, range_text
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.tables import NOTHING, margin_text, mark, meaning, value_text
from tvimdesign.report.page.blocks import Grid
from tvimdesign.report.run.blocks.verdict import least_shares, limits_in_doubt
from tvimdesign.report.run.blocks.warnings import requested_torque, unreached_points
from tvimdesign.report.run.reasons import is_active
from tvimdesign.solve.nlp.solution import Choosing
from tvimdesign.solve.result import StudyResult

_MOVES = 0.02  # Share of an output's variance from which an input counts as moving it
_NAMED = 4


def variables_grid(answer: StudyResult) -> Grid:
    """Return the start and the end of each variable, with its range."""
    table, rows = answer.design.table, []
    first = answer.solution.starts[0].begin if answer.solution else {}
    for name, vary in answer.design.study["vary"].items() if answer.solution else ():
        if name not in first and name not in answer.design.choices:
            continue  # a current that follows a profile: a table of its own
        if name not in first:
            rows.append((name, "", answer.design.choices[name], "", ", ".join(str(v) for v in vary["values"])))
            continue
        unit = table.unit(name)
        start, end = (in_unit(value, unit) for value in (first[name], answer.design.values[name]))
        ends = (vary["lower"], vary["upper"]) if "lower" in vary else (min(vary["values"]), max(vary["values"]))
        allowed = ends_text(from_si(ends[0], unit), from_si(ends[1], unit), 4)
        rows.append((name, start, end, pretty(unit), allowed + ("" if "lower" in vary else ", listed")))
    title = "What was varied" if answer.has_design else "Where the solver ended; this is not a design"
    heads = ("variable", "start", "design" if answer.has_design else "end", "unit", "allowed")
    return grid(title, heads, rows, right=(1, 2))


def choices_grid(choosing: Choosing, table: Table) -> Grid:
    """Return the best combinations of what is listed, against the first."""
    best, rows = choosing.best[0], []
    for combination in choosing.best:
        choices = (choice_text(name, value, table) for name, value in combination.choices.items())
        worse = (combination.objective / best.objective - 1.0, *shares(combination, best).values())
        rows.append((*choices, *(f"{share:+.1%}" for share in worse)))
    heads = (*best.choices, "objective", *best.values)
    title = "Best combinations of what is listed, without margins, against the first"
    return grid(title, heads, rows, right=range(len(heads)), code=())


def points_grid(answer: StudyResult) -> Grid:
    """Return the quantities that have a value at each operating point."""
    table, points = answer.design.table, list(answer.design.study["operating_points"])
    shown: list[Input | Output] = [row for row in table.inputs if row.per_point]
    shown += [row for row in table.outputs if row.per_point and row.headline and row.exists(answer.design.choices)]
    at_end = {"temperature": "softened_temperature", "frequency": "frequency@hot"}
    rows = []
    for row in shown:
        named = [f"{row.name}@{point}" for point in points]
        values = [value_text(answer, name) for name in named]
        name = at_end.get(row.name) or getattr(row, "at_end", "")
        end = value_text(answer, name) if name else ""
        rows.append((f"{row.name}{mark(named[0], answer)}", end, *values, pretty(row.unit), row.description))
    unreached = unreached_points(answer.design.values)
    heads = ("", "heating ends", *(f"{point} (PCL stays cooler)" if point in unreached else point for point in points))
    return grid("At the operating points", (*heads, "unit", "meaning"), rows, right=range(1, len(heads)))


def module_grid(answer: StudyResult) -> Grid:
    """Return the headline quantities that have one value; none at the hot point if heating does not get there."""
    table = answer.design.table
    hot_unreached = "hot" in unreached_points(answer.design.values)
    shown = [row for row in table.outputs if row.headline and not row.per_point and row.exists(answer.design.choices)]
    rows = [
        (row.group, f"{row.name}{mark(row.name, answer)}", value_text(answer, row.name), pretty(row.unit),
         meaning(row.name, answer.design))
        for row in shown if not (hot_unreached and row.at_end)
    ]  # fmt: skip
    return grid("What the module is", ("group", "quantity", "value", "unit", "meaning"), rows, right=(2,), code=(1,))


def torque_path_grid(answer: StudyResult) -> Grid:
    """Return the parts on the way of the frozen torque from link to ground, and the torque that each bears [N*m].

    The weakest is first. Feet bear what their safety leaves beside the others. The safety is against the torque the
    study asks for, or against the one that is held.
    """
    table, values, against = answer.design.table, answer.design.values, requested_torque(answer.design)
    parts = [
        name for name in table.output("holding_torque").least_of if table.output(name).exists(answer.design.choices)
    ]
    borne = {name: values[name] for name in parts if name in values}
    if "foot_safety" in values:
        borne["foot_safety"] = values["foot_safety"] * values["holding_torque"]
    strengths = {name: _strengths_behind(table, name) for name in borne}
    wanted = list(dict.fromkeys(strength for names in strengths.values() for strength in names))
    strong = table.evaluate({**answer.design.values, **answer.design.choices}, wanted)
    rows = [
        (name, number(torque), number(torque / against, 3) if against else "",
         " / ".join(dict.fromkeys(number(1e-6 * strong[of], 3) for of in strengths[name])),
         table.output(name).description)
        for name, torque in sorted(borne.items(), key=lambda part: part[1])
    ]  # fmt: skip
    cold = f" at {in_unit(values['temperature@cold'], 'degC')} °C" if "temperature@cold" in values else ""
    safety = f", structure's strengths{cold} divided by {number(values['holding_safety'])}, `holding_safety`"
    title = f"Load path of the frozen torque, weakest part first; safety against {number(against)} N·m{safety}"
    return grid(title, ("part", "bears [N·m]", "safety", "strength [MPa]", "meaning"), rows, right=(1, 2, 3))


def _strengths_behind(table: Table, name: str) -> list[str]:
    """Return the strengths from which a quantity is computed, those that the fewest steps lie between; none of some."""
    met, seen = [name], {name}
    while met and not (strengths := [each for each in met if "strength" in each]):
        met = [need for each in met for need in getattr(table.quantity(each.split("@")[0]), "needs", ())]
        met = [each for each in dict.fromkeys(met) if each not in seen]
        seen.update(met)
    return strengths if met else []


def currents_grid(answer: StudyResult) -> Grid:
    """Return the currents that follow a profile, moment by moment; the current is linear between these moments."""
    rows = [
        (name if i == 0 else "", number(seconds, 3), number(round(current, 4), 3))
        for name, profile in answer.design.current_profiles.items()
        for i, (seconds, current) in enumerate(zip(profile["moments"], profile["currents"], strict=True))
    ]
    return grid("Currents, linear between these moments", ("phase", "s", "A"), rows, right=(1, 2))


def profile_grid(answer: StudyResult) -> Grid:
    """Return what a current profile buys: this module at its default current, and the best constant current's own."""
    table, best = answer.design.table, answer.solution.constant if answer.solution else None
    driven = [table.phase(phase).current_input for phase in answer.design.current_profiles]
    defaults = {name: getattr(table.quantity(name), "default", None) or 0.0 for name in driven}
    rows = []
    for name, default in {**defaults, **answer.constant_current}.items():
        unit = table.unit(name)
        values = [*([best.values[name]] if best else []), default]
        own = "profile" if name in defaults else in_unit(answer.design.value(name), unit)
        texts = (own, *(in_unit(value, unit) for value in values))
        rows.append((name, *texts, pretty(unit), meaning(name, answer.design)))
    heads = ("", "profile", *(["best constant"] if best else []), "default", "unit", "meaning")
    return grid("What letting the current change buys", heads, rows, right=(1, 2, 3) if best else (1, 2))


def checks_grid(answer: StudyResult) -> Grid:
    """Return every requirement, and the machine's own rules that are active or violated; a note counts the others."""
    table = answer.design.table
    shown = [check for check in answer.checks
             if check.origin == "require" or check.worst <= NOTHING or is_active(check, answer)]  # fmt: skip
    hidden = len(answer.checks) - len(shown)
    note = f"{hidden} built-in limits that are met and not active are not shown." if hidden else ""
    rows = []
    for check in shown:
        stands = "violated" if not check.met else "active" if is_active(check, answer) else "ok"
        stands = "open" if check in answer.undecided else stands
        because = "the study" if check.origin == "require" else check.origin
        margin = margin_text(replace(check, margin=check.worst), table)  # with the history that leaves the least
        value, unit = value_text(answer, check.output, rounded=True), pretty(table.unit(check.output))
        rows.append((stands, check.text, value, unit, margin, because))
    heads = ("", "limit", "value", "unit", "margin", "asked by, or what a violation means")
    return grid("Limits", heads, rows, right=(2, 4), code=(), toned=(0,), note=note)


_FAINT = 1e-6  # Share of a range below which a value in it is zero


def intervals_grid(intervals: Mapping[str, Mapping[str, Any]]) -> Grid:
    """Return the range of each headline and requirement over unmeasured inputs, and what to measure first."""
    measured = any(interval.get("before") for interval in intervals.values())
    heads: tuple[str, ...] = ("", "value", "low", "high", "one at a time", "unit", "measure first", "share", "to halve")
    rows = []
    for output, interval in intervals.items():
        if interval["low"] == interval["high"]:
            continue
        ends = [interval[end] for end in ("value", "low", "high")]
        faint = 0.0 if None in ends else _FAINT * (ends[2] - ends[1])
        texts = (number(0.0 if end is not None and abs(end) <= faint else end) for end in ends)
        alone, first = interval["one_at_a_time"], next(iter(interval["shares"]), "")
        share = f"{100.0 * interval['shares'][first]:.0f} %" if first else ""
        half = f"{len(interval['to_halve'])}" if interval["to_halve"] else "many"
        before = interval.get("before") or {}
        earlier = [ends_text(before["low"], before["high"]) if before else ""] if measured else []
        rows.append((output, *texts, ends_text(alone["low"], alone["high"], 4), interval["unit"], first, share, half,
                     *earlier))  # fmt: skip
    title = "Ranges of outputs over unmeasured inputs (95 %, all together)"
    note = (
        "From `low` to `high` lie 95 % of plausible cases, which have each input anywhere in its range. `one at a "
        "time` has one input at the end of its range and the others as assumed: it may reach further. To know `measure "
        "first` takes away its `share` of the variance; `to halve` is the number of inputs that halve the range."
    )
    heads += ("before measuring",) if measured else ()
    return grid(title, heads, rows, right=(1, 2, 3, 7), code=(0, 6), note=note)


def unmeasured_grid(uncertainty: Mapping[str, Any], values: Mapping[str, Any]) -> Grid:
    """Return every unmeasured input with its range, its source and the outputs that it moves, the weightiest first."""
    intervals = uncertainty["intervals"]
    moved = {entry["name"]: moves(entry["name"], intervals) for entry in uncertainty["unmeasured"]}
    order = sorted(
        uncertainty["unmeasured"], key=lambda entry: -max((share for _, share in moved[entry["name"]]), default=0)
    )
    rows = [
        (entry["name"], number(entry["value"]), range_text(entry), entry["unit"], entry["status"],
         ", ".join(f"{output} {100.0 * share:.0f} %" for output, share in moved[entry["name"]][:_NAMED]),
         values[entry["name"]]["source"])
        for entry in order
    ]  # fmt: skip
    heads = ("input", "value", "range", "unit", "status", "share of what it moves", "source")
    note = (
        "A share is the part of an output's variance that knowing the input would take away, all inputs anywhere in "
        "their ranges."
    )
    return grid("Unmeasured inputs", heads, rows, right=(1,), note=note)


def moves(name: str, intervals: Mapping[str, Any]) -> list[tuple[str, float]]:
    """Return the outputs an input moves, with its share of each one's variance, the largest first."""
    shares = [(output, interval["shares"].get(name, 0.0)) for output, interval in intervals.items()]
    return sorted([(output, share) for output, share in shares if share >= _MOVES], key=lambda pair: -pair[1])


def held_grid(uncertainty: Mapping[str, Any], values: Mapping[str, Any], least: float) -> Grid:
    """Return what to measure, and how, with the limits in doubt that it decides on and their shares of cases."""
    limits = limits_in_doubt(uncertainty, least)
    assumed = {
        entry["name"]: f"{number(entry['value'])} ({range_text(entry)}) {entry['unit']}"
        for entry in uncertainty["unmeasured"]
    }
    rows = []
    for first in sorted(limits, key=lambda name: not name):
        decided, more = [f"{name} {100.0 * share:.3g} %" for name, share in limits[first].items()], len(limits[first])
        met = ", ".join([*decided[:_NAMED], *([f"{more - _NAMED} more"] if more > _NAMED else [])])
        source = values[first]["source"] if first else ""
        test = source.partition("test: ")[2] or ("its maker's sheet, or the built part" if source else "the built part")
        name = first if label(first) == first.replace("_", " ") else f"{first}: {label(first)}"
        rows.append((name or "no single input", assumed.get(first, ""), met, test))
    heads = ("measure first", "assumed (range)", "limits, met in a share of the cases", "test")
    note = (
        "Before any order: print cad/print/test_pieces.3mf twice and measure it by docs/how-to/my-printer.md; set what "
        "was measured in the study of `tvimdesign new measured.yaml --from FOLDER`, which keeps all chosen sizes, and "
        "run it: a wall or gap redraws what follows from it. Then order springs and heaters, and print the parts. The "
        "others: on the first module, or by the maker's sheet; with `--built` its parts stay as drawn."
    )
    title = f"Measure first: for limits met in under {percent(least)} of {uncertainty['draws']} plausible cases"
    return grid(title, heads, rows, code=(), note=note)


def doubts_grid(uncertainty: Mapping[str, Any], table: Table) -> Grid:
    """Return what each limit in doubt is about, such as between which two parts a gap is, the least met first."""
    rows = [
        (name, f"{100.0 * share:.3g} %", table.output(name).description)
        for name, share in least_shares(uncertainty).items()
    ]
    note = "Parts and gaps: cad/views/section.png, a cut through the axis; the module in report.html, which opens."
    title = f"Limits not met in all {uncertainty['draws']} plausible cases"
    return grid(title, ("limit on", "met in", "meaning"), rows, right=(1,), note=note)
