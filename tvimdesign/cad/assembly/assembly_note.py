"""The note on putting a module together: its parts, the steps in order with their figures, and the pictures."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import degrees
from typing import Any, NamedTuple

from tvimdesign.base.record import own_data
from tvimdesign.cad import cad_report
from tvimdesign.cad.assembly.bill_of_materials import DIVIDER, MADE_TO_ORDER, WIRED, Item, cost, driver_inputs, greased
from tvimdesign.cad.assembly.heater_leads import set_points_in_words
from tvimdesign.cad.export.print_files import LINE, walls
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import PRODUCTION, is_of_structure, kind_of
from tvimdesign.cad.parts.common_parts import link_screws
from tvimdesign.catalog.offers import between
from tvimdesign.device import Input, Output, table_for
from tvimdesign.study import Design, cost_in_words


def assembly_note(design: Design, dims: Dimensions, items: Sequence[Item], extra: Sequence[Item] = ()) -> bytes:
    """Write the note as Markdown; `extra` is what is bought beside the parts."""
    lines = [
        f"# Putting together: {design.name}",
        "",
        f"![Parts in the order in which they go on]({cad_report.EXPLODED})",
        "",
    ]
    lines += ["## Parts", "", "| | part | quantity | | g each | g |", "|---|---|---|---|---|---|"]
    for number, item in enumerate(items, start=1):
        of = f"{'made of' if item.made else 'bought:'} {item.title}"
        each = f"{item.mass:.2f} | {item.mass * item.quantity:.2f}"
        lines.append(f"| {number} | {_words(item.kind)} | {item.quantity} | {of} | {each} |")
    total = sum(item.mass * item.quantity for item in items)
    lines += ["", f"Together {total:.1f} g. Files and records of the catalogue: `{cad_report.BILL_OF_MATERIALS}`; "
              f"where each part is: `{cad_report.drawing_pdf(cad_report.ASSEMBLY)}`.", ""]  # fmt: skip
    lines += ["| also needed | |", "|---|---|"] if extra else []
    lines += [
        f"| {_words(item.kind)} | {item.title}{f', about {item.mass:.2f} g' if item.mass else ''} |" for item in extra
    ]
    lines += ["", _cost([*items, *extra], design)]
    lines += [""] if extra else []
    lines += [*_making(design, dims, [item for item in items if item.made]), "## Steps", ""]
    steps = written_steps(design, dims, items)
    tools = sorted({tool for step in steps for tool in step.tools})
    hours = sum(step.minutes for step in steps if not step.opens) / 60.0
    lines += [f"About {hours:.2g} h by hand, assumed, twice that the first time; ovens, glue and PCL take their own."]
    lines += [f"Tools: {', '.join(tools)}. Azimuths count from the drawings' x axis, counter-clockwise from above.", ""]
    for number, step in enumerate(steps, start=1):
        if step.opens and not steps[number - 2].opens:
            lines += ["", "## Opening it again", ""]
        picture = f"\n   ![Step {number}]({cad_report.step_picture(number)})"
        needs = f"\n   *{step.needs}*  " if step.needs else ""
        lines.append(f"{number}. {step.text}  {needs}{picture}")
    lines += ["", "## Wiring", "", f"![Supply, driver, heaters, cut-out and thermistors]({cad_report.WIRING})", ""]
    lines += [f"![Cut through the axis]({cad_report.SECTION})", ""]
    return "\n".join(lines).encode()


def _cost(items: Sequence[Item], design: Design) -> str:
    """Return the sum of what has a price, what of it one module uses, and what has none."""
    sums, used = cost(items), ""
    if design.values.get("cost"):
        used = f"Of that, {'; '.join(cost_in_words(table_for(design.mode), design.values, design.choices))}. "
    return (
        f"Of {sums.lines} lines to buy {sums.priced} have a dated price in a public list, some of them a neighbour's: "
        f"{between(sums.low, sums.high)} for whole packs, consumables, supply and electronics. {used}"
        f"Ask suppliers for quotes of the others.{_made_to_order(items, design)}"
    )


def _made_to_order(items: Sequence[Item], design: Design) -> str:
    """Return what is made to order, to be asked for once the test pieces were measured; empty if nothing is."""
    slow = _listed([item for item in items if MADE_TO_ORDER in item.lead_time])
    printed = " Before any order print the test pieces, and run the study again with what they measure; then order"
    order = " Order" if design.choices["making_method"] == "milled" else printed
    words = f"{order} first what is {MADE_TO_ORDER}, and ask how long it takes, which no list says"
    return f"{words}: {slow}." if slow else ""


def _making(design: Design, dims: Dimensions, made: Sequence[Item]) -> list[str]:
    """Return how the made parts are made: the structure by the process, what is of PCL printed or cut either way."""
    kinds = [item.kind for item in made]
    is_milled = design.choices["making_method"] == "milled"
    milled = [kind for kind in kinds if is_milled and is_of_structure(kind)]
    lines = []
    if milled:
        listed = ", ".join(map(_words, milled)).capitalize()
        lines += ["## Machining", "", f"{listed}: from `step/` by the sheets in `drawings/`, which carry the fits.", ""]
    lines += ["## Printing", "", *(_printing(kind, design, dims) for kind in kinds if kind not in milled), ""]
    but = ", those of dowel pins not: they are reamed" if dims.dowels_fitted or dims.leg_pins_fitted else ""
    wider = f", with upright holes {dims.hole_compensation:g} mm wider{but}" if dims.hole_compensation else ""
    solid = "Print them solid (infill 100 %): mass, stiffness and strength count the plastic throughout."
    solid += "" if is_milled else _walls(dims)
    grams = sum(item.mass * item.quantity for item in made if is_of_structure(item.kind))
    solid += "" if is_milled else f" They take {grams:.0f} g of filament or resin; supports and jigs come on top."
    return [*lines, f"The files in `print/` lie so{wider}. {solid}{_weigh(design, kinds, milled)}", ""]


def _walls(dims: Dimensions) -> str:
    """Return the walls to set, and where all parts lie on a bed with these settings."""
    lines, least = walls(dims), f"{dims.minimum_wall:.3g} mm"
    wall = f"{lines * LINE:.3g} mm"
    thin = "" if wall == least else f" The thinnest walls, of {least}, have room for fewer: let the slicer widen these."
    return (
        f" Set at least {lines} walls, with lines of {LINE} mm: a wall of {wall}{'' if thin else ', the thinnest,'} "
        f"and the thread around each screw's hole are then of unbroken lines.{thin} "
        f"`{cad_report.plate_3mf(1)}` has the parts, with jigs, on a bed; a second bed has the next number."
    )


def _weigh(design: Design, kinds: Sequence[str], milled: Sequence[str]) -> str:
    """Return by what a print that is not solid is found out."""
    if "housing" not in kinds or "housing" in milled:
        return ""
    mass = 1e3 * design.value("housing_volume") * design.value("structure_density")
    return f" A housing that weighs less than {0.97 * mass:.3g} g has hollow places."


def _printing(kind: str, design: Design, dims: Dimensions) -> str:
    lying = "as it stands in the module" if PRODUCTION[kind].down == "bottom" else "turned over"
    return f"- {_words(kind)}: {lying}; {PRODUCTION[kind].why.format_map(Figures(design, dims, {}))}."


class PlacedPart(NamedTuple):
    """One part that comes into its place."""

    name: str
    side: str


def coming(place: Sequence[Mapping[str, str]], names: Sequence[str]) -> list[PlacedPart]:
    """Return which of some placed parts come into their places in a step, and from which side."""
    return [
        PlacedPart(name, at.get("from", "")) for at in place for name in names if at["part"] in (name, kind_of(name))
    ]


class WrittenStep(NamedTuple):
    """One step of a module's note."""

    text: str
    kinds: Sequence[str] = ()  # Of the parts it is about
    place: Sequence[Mapping[str, str]] = ()
    """What comes into its place: `part`, a kind or one part of a kind, and the side it comes `from`."""
    needs: str = ""  # Hands, fixture, tools, access, and what is checked at its end
    tools: Sequence[str] = ()
    minutes: float = 0.0  # By hand, assumed
    opens: bool = False  # True where it takes the module apart again
    shows: Sequence[Mapping[str, str]] = ()  # What its picture has, where that is neither `place` nor all of `kinds`

    def shown(self, names: Sequence[str]) -> list[PlacedPart]:
        """Return what its picture shows: parts that come into their places; else those it is about, from no side."""
        return coming(self.shows or self.place or [{"part": kind} for kind in self.kinds], names)


_TORQUES = re.compile(r"{(\w+_screw_torque)}")


def written_steps(design: Design, dims: Dimensions, items: Sequence[Item]) -> list[WrittenStep]:
    """Return steps for the kinds this module has, and one for each kind that no step takes; those that open it come
    last."""
    counts: dict[str, object] = {f"number_of_{item.kind}": item.quantity for item in items}
    counts |= {f"grams_of_{item.kind}": f"{item.mass:.2f}" for item in items}
    treated = [item for item in items if item.treatment]
    counts |= {"treatment": treated[0].treatment if treated else "", "treated_parts": _listed(treated)}
    known = Figures(design, dims, counts)
    wanted = [
        step for step in steps_of({item.kind for item in items}, dims)
        if step.get("chosen", {}).items() <= design.choices.items()
    ]  # fmt: skip
    steps = [
        WrittenStep(
            _unless_fitting(step["kinds"], items) + str(step["text"]).format_map(known),
            step["kinds"], step.get("place", ()), _needs(step["needs"], tools := _tools(step)).format_map(known),
            [tool for tool in tools.format_map(known).split(", ") if tool != "none"], step["needs"]["minutes"],
            step.get("opens", False),
            step.get("shows", ()),
        )
        for step in wanted
        if all(known[word] for word in step.get("knows", ()))
    ]  # fmt: skip
    placed = {kind_of(part["part"]) for step in wanted for part in step.get("place", ())}
    taken = placed.union(*(step["kinds"] for step in wanted))
    others = [item for item in items if item.kind not in taken]
    left = [WrittenStep(f"Fit the {_words(item.kind)} ({item.quantity}).", [item.kind]) for item in others]
    return [*(step for step in steps if not step.opens), *left, *(step for step in steps if step.opens)]


def _listed(items: Sequence[Item]) -> str:
    """Return the kinds of some items in words."""
    return ", ".join(_words(item.kind) for item in items)


def _unless_fitting(kinds: Sequence[str], items: Sequence[Item]) -> str:
    """Return what a step says first if no listed type of a part fits; empty if all fit."""
    missing = _listed([item for item in items if item.kind in kinds and not item.fits])
    how = "by the list of parts and the run's warnings"
    return f"No listed {missing} fits: leave this step until one is found, {how}. " if missing else ""


def _tools(step: Mapping[str, Any]) -> str:
    """Return the tools of a step, with a driver for each torque that its text asks for."""
    drivers = (f"torque driver {{{word}}} N·m" for word in dict.fromkeys(_TORQUES.findall(step["text"])))
    return ", ".join([step["needs"]["tools"], *drivers])


def _needs(needs: Mapping[str, Any], tools: str) -> str:
    """Return what a step takes, in a line."""
    people = "one person" if needs["hands"] == 1 else f"{needs['hands']} persons, or a clamp"
    return (
        f"{people}, {needs['minutes']} min · held by: {needs['fixture']} · tools: {tools} · "
        f"access: {needs['access']} · checked: {needs['checked']}"
    )


def steps_of(kinds: set[str], dims: Dimensions) -> list[dict[str, Any]]:
    """Return steps of a module of these kinds of part and dimensions, in order, as the data file has them."""
    return [
        step for step in all_steps()
        if kinds.issuperset(step["kinds"]) and kinds.isdisjoint(step.get("without", ()))
        and all(getattr(dims, row) > 0.0 for row in step.get("where", ()))
        and not any(getattr(dims, row) > 0.0 for row in step.get("unless", ()))
    ]  # fmt: skip


all_steps = partial(own_data, __file__, "assembly_steps.yaml")


def _words(kind: str) -> str:
    return kind.replace("_", " ")


ANGLES = ("rad", "deg")
_MEASURED = 0.01  # Length [mm] to which one measures in a workshop
TORQUE = "N*m"
_CAST = 5e-5  # Thickness [m] by which cast PCL is off, to either side
_GRAMS = 1e3 / 9.80665  # Reading of a balance in grams for one newton, by standard gravity (ISO 80000-3)
_HEATED = ("current", "response_time", "hold_current")


class Figures(dict[str, Any]):
    """Words and rows by name as they are written in a text: lengths in mm, angles in degrees, counts as they are."""

    def __init__(self, design: Design, dims: Dimensions, counts: Mapping[str, object]) -> None:
        """`counts` are there beside the rows: of parts, and the grams of one."""
        super().__init__(counts)
        self._design, self._dims = design, dims
        rows: list[Input | Output] = [*table_for(design.mode).inputs, *table_for(design.mode).outputs]
        self._units = {row.name: row.unit for row in rows}

    def __missing__(self, name: str) -> str:
        """Return the words a text has in place of a name, or the value of a quantity."""
        if name in _WORDS:
            return _WORDS[name](self._design, self._dims)
        unit = self._units.get(name)
        if unit == TORQUE:
            return f"{self._design.value(name):.2g}"
        value: float = getattr(self._dims, name)
        if unit == "mm" and value >= _MEASURED:
            value = round(value, 2)
        return f"{degrees(value) if unit in ANGLES else value:.3g}"


def preload_tolerance(design: Design) -> float | None:
    """Return what the study counts a spring's preload off by, to either side [rad]; None where it says nothing.

    What is adjusted is no further off than what adjusting leaves, as where the yield is counted.
    """
    stated = (design.study.get("tolerances") or {}).get("preload_angle")
    if not stated:
        return None
    if stated.get("row"):
        size = design.value(stated["row"])
    elif stated.get("share") is not None:
        size = stated["share"] * abs(design.value("preload_angle"))
    else:
        size = stated.get("plus_minus") or 0.0
    return float(min(size, stated.get("adjusted_to") or 0.0) if stated.get("adjustable") else size)


def _preload_force(design: Design, _: Dimensions) -> str:
    """Return the force that takes a leg off its pin at rest, `pin_force`, and within what the study's tolerance leaves
    of it.

    The preload and this force are in proportion, as the spring is straight: torque over the arm of the leg.
    """
    force = design.values.get("pin_force", math.nan)
    if not math.isfinite(force):
        return "the force of the study's `pin_force`"
    grams = float(f"{_GRAMS * force:.3g}")
    text = f"{force:.3g} N ({grams:g} g)"
    off = preload_tolerance(design)
    if not off:
        return text
    share = off / design.value("preload_angle")
    ends = f"{force * max(1.0 - share, 0.0):.3g} to {force * (1.0 + share):.3g} N"
    return f"{text}; the study counts on {ends}"


def _sorting(design: Design, dims: Dimensions) -> str:
    """Return which springs are good enough, by what the study counts on; else how the rotor is brought to its place."""
    off = preload_tolerance(design)
    if not dims.adjuster_radius:
        share, sorting = 100.0 * design.value("sorted_share"), degrees(design.value("free_angle_sorting"))
        return (
            f"measure each before it goes in, and keep out those further off than ±{sorting:.3g}°: {share:.0f} % of "
            "what is bought are good enough"
        )
    if off is None or off >= design.value("free_angle_tolerance"):
        return "choose pairs that agree, or bend the legs until the rotor rests with its pins in line with the posts"
    return f"the study counts on a preload that is set within ±{degrees(off):.3g}°"


def _most_current(design: Design, _: Dimensions) -> str:
    """Return the largest current of both phases; of heating alone where the heater does not cool."""
    currents = (design.values.get(name, math.nan) for name in ("peak_current", "stiffening_peak_current"))
    return f"{max((value for value in currents if math.isfinite(value)), default=design.value('current')):.3g} A"


def _bonding_heat(design: Design, _: Dimensions) -> str:
    """Return how the PCL is melted through, by the study's own currents and times.

    By hand where it was not switched.
    """
    current, time, hold = (design.values.get(name, math.nan) for name in _HEATED)
    if not all(math.isfinite(value) and value > 0.0 for value in (current, time, hold)):
        return "heat the PCL until the rotor turns by hand, and hold that for two minutes"
    by = "the study's current profile" if "softening" in design.current_profiles else f"{current:.3g} A"
    return f"heat with {by} for {time:.3g} s, then hold {hold:.3g} A for two minutes"


def _ledge_pull(design: Design, _: Dimensions) -> str:
    """Return how strongly the freezing layer pulls at what lies on the ledges.

    Nothing where the design does not say.
    """
    tension = design.values.get("ledge_tension", math.nan)
    return f", by {1e-6 * tension:.2g} MPa there at most" if math.isfinite(tension) else ""


def _proof_torque(design: Design, _: Dimensions) -> str:
    """Return the torque that the frozen joint holds, by its name where the study was not evaluated."""
    torque = design.values.get("holding_torque", math.nan)
    return f"{torque:.3g} N·m" if math.isfinite(torque) else "the study's `holding_torque`"


def _gap_spread(design: Design, _: Dimensions) -> str:
    """Return what the study counts the gap for the PCL off by, where that is more than the cast PCL is off by."""
    size = ((design.study.get("tolerances") or {}).get("pcl_thickness") or {}).get("plus_minus") or 0.0
    if size <= _CAST:
        return ""
    return f". The study's ±{1e3 * size:.2g} mm is not for the PCL but for the gap between the parts that it fills"


def _play(design: Design, _: Dimensions) -> str:
    """Return the angle that the link moves without notice, from end to end; empty where the study was not evaluated."""
    play = 2.0 * design.values.get("lost_motion", math.nan)
    return f", {math.degrees(play):.2g}° from end to end" if math.isfinite(play) else ""


def _greased(place: str, design: Design, _: Dimensions) -> str:
    """Return a place, if it is greased."""
    return place if place in greased(design) else ""


def _housing_on_bed(_: Design, dims: Dimensions) -> str:
    """Return what of the housing lies on the bed, and what hangs."""
    hang = ["the floor"] * (not dims.base_height) + ["the lip between the bearings"] * (dims.bearing_width > 0.0)
    support = f"support only below {' and '.join(hang)}, in the open" if hang else "no support"
    lies = "floor" if dims.base_height else "feet and skirt"
    return f"{lies} on the bed: posts, hub and seats grow upwards and come out round; {support}"


def _pins_on_bed(_: Design, dims: Dimensions) -> str:
    """Return what else of a rotor hangs over the bed: its pins, or the bosses of bought ones."""
    if dims.leg_pins_fitted:
        return ", under the bosses of the dowel pins, too, which are trimmed flat before their holes are reamed"
    sides = "the legs bear on their sides, which no support touches, so that only ends and fillets are trimmed"
    free = f", under the pins, too, whose ends hang free whichever way the rotor lies; {sides}"
    return free if dims.spring_count else ""


_AND_BASE = ", screws through floor and base both, tightened again after the first heating"
_TO_REAM = 0.2  # What a drill leaves to a reamer up to 5 mm [mm]; workshop tables have 0.1 to 0.2
_WORDS: Mapping[str, Callable[[Design, Dimensions], str]] = {
    "preload_force": _preload_force,
    "rest_mark": lambda _, dims: "the first spring" if dims.spring_count else "a notch of the skirt",
    "sorting": _sorting,
    "bonding_heat": _bonding_heat,
    "most_current": _most_current,
    "driver_inputs": lambda design, _: driver_inputs(design),
    "divider": lambda *_: DIVIDER,
    "proof_torque": _proof_torque,
    "gap_spread": _gap_spread,
    "link_width": lambda _, dims: f"{2.0 * dims.link_half_width:.3g}",
    "play": _play,
    "link_screws": lambda _, dims: (
        "link's screw" if dims.spigot_depth else f"{len(link_screws(dims))} link screws crosswise"
    ),
    "widest_gap": lambda _, dims: f"{2.0 * dims.spigot_room:.2g}",
    "link_dowel_drill": lambda _, dims: f"{dims.link_dowel_diameter - _TO_REAM:.3g}",
    "leg_pin_height": lambda _, dims: f"{dims.leg_pin_length - dims.leg_pin_depth:.3g}",
    "set_points": lambda design, _: set_points_in_words(design),
    "and_base": lambda _, dims: _AND_BASE if dims.base_height else "",
    "housing_on_bed": _housing_on_bed,
    "pins_on_bed": _pins_on_bed,
    "heaters_wired": lambda design, _: WIRED[design.choices.get("heater_wiring", "series")],
    "cutout_place": lambda _, dims: f"through the {'slot of its vane' if dims.mode == 'compression' else 'window'}",
    "heated_parts": lambda _, dims: "spreaders" if dims.spreader_depth else "heaters",
    "hot_side": lambda design, _: ", hot side to the PCL" if design.values.get("heater_seebeck") else "",
    "ledge_pull": _ledge_pull,
    "greased_bore": partial(_greased, "bore"),
    "greased_pins": partial(_greased, "pins"),
}
"""By the name a text has in braces."""
