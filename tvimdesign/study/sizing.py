"""A study from a few numbers of a joint: its ranges follow the diameter, its hardware and heater are chosen."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Self

from tvimdesign.base.errors import InputError, UnitError
from tvimdesign.base.record import own_data, own_template
from tvimdesign.base.units import format_quantity, from_si, parse_quantity
from tvimdesign.catalog import Catalog
from tvimdesign.device import Input, table_for
from tvimdesign.study.study import Range, Study
from tvimdesign.study.written_studies import SCHEMA_FILE

SIZED_MODE = "shear"
SMALLEST, LARGEST = 0.02, 0.2  # Diameters [m] that a study is made for
_BAND = 0.2  # Share by which the stiffness may lie to either side of the one that is required
_WIRE = 0.0011 / (2.28 * 0.0894) ** 0.25
"""Wire [m] of the shipped elbow over the fourth root of its springs' stiffness [N m/rad] times its diameter [m]: the
rate of a spring is E d^4 / (64 D n)."""
_WIRE_RANGE = (0.72, 1.4)
_BANDS = (1.1, 2.0)
"""Ends of the factor on the hot impedance within which a joint counts as soft: of a wider one the stiffness that is
asked for is not reached when the switch ends."""
_CAUTIOUS_BAND = 1.3
_EXAMPLES = {
    "torque": "8 N.m", "stiffness": "1 N.m/rad", "diameter": "70 mm", "time": "60 s", "supply": "24 V, 3 A",
    "stroke": "6 deg", "stiff_time": "300 s",
}  # fmt: skip
_sizes = partial(own_data, __file__, "sizes.yaml")
STROKE = "0.104 rad"  # Stroke to either side of rest, unless given
_PRELOAD = (1.15, 0.216, 0.5)
"""Least preload angle over the stroke; its start and its largest value beyond the stroke [rad]."""
_RANGE = re.compile(r"(?P<low>\S+)(?: (?P<unit>\S+))? (?:to|-) (?P<high>.+)")


@dataclass(frozen=True)
class JointTask:
    """Requirements on a joint, in SI."""

    torque: float
    stiffness: tuple[float, float]
    diameter: float
    time: float
    voltage: float
    current: float
    stroke: float
    assumes_stroke: bool
    friction: float = 0.5  # Most friction over the springs' torque at full stroke
    stiff_time: float = math.inf  # Most time from the end of the heating until it is stiff again
    process: str = ""  # Process that makes the parts; empty for the one that suits the diameter
    cautious: bool = False  # True if three of four plausible cases of the assumed values must satisfy each limit

    @classmethod
    def read(
        cls, torque: str, stiffness: str, diameter: str, time: str, supply: str, stroke: str = "", stiff_time: str = "",
        process: str = "",
    ) -> Self:  # fmt: skip
        """Read quantities with their units, as `tvim.size` takes them; an empty stroke is `STROKE`.

        Raises InputError with every one of them that is missing, no such quantity, or out of range, and for a process
        that is not in the catalogue.
        """
        voltage, _, current = supply.partition(",")
        problems: list[str] = []

        def take(name: str, text: str, unit: str) -> float:
            try:
                return _positive(name, text, unit)
            except InputError as error:
                problems.append(str(error))
                return math.nan

        try:
            band = _stiffness(stiffness)
        except InputError as error:
            problems.append(str(error))
            band = math.nan, math.nan
        task = cls(
            take("torque", torque, "N*m"), band, take("diameter", diameter, "mm"), take("time", time, "s"),
            take("supply", voltage.strip(), "V"), take("supply", current.strip(), "A") if current else math.inf,
            take("stroke", stroke or STROKE, "rad"), not stroke,
            stiff_time=take("stiff_time", stiff_time, "s") if stiff_time else math.inf, process=process,
        )  # fmt: skip
        row = _inputs()["stroke"]
        if task.stroke < row.lower or task.stroke > row.upper:
            most = format_quantity(row.upper, "deg", 3)
            problems.append(
                f"stroke: {stroke} to either side of rest is beyond {most}, the most that a module turns; "
                f"write for instance '{_EXAMPLES['stroke']}'"
            )
        if task.torque < (soft := task.stiffness[0] * task.stroke):
            at_stroke = format_quantity(soft, "N*m", 2)
            problems.append(
                f"torque: {torque} is below the {at_stroke} of the soft joint at its stroke: check the units"
            )
        if task.diameter < SMALLEST or task.diameter > LARGEST:
            problems.append(f"diameter: {diameter} is not from 20 mm to 200 mm, which `size` is made for")
        if process and process not in processes():
            problems.append(f"process: no {process[:60]} in the catalogue; it has {', '.join(processes())}")
        if problems:
            raise InputError("\n".join(problems))
        return task

    def options(self) -> dict[str, str]:
        """Return the options of `size` that ask for this."""
        low, high = self.stiffness
        centre = 0.5 * (low + high)
        around = math.isclose(high - low, 2.0 * _BAND * centre, rel_tol=1e-6)
        return {
            "torque": f"{self.torque:.4g} N.m", "diameter": _mm(self.diameter), "time": f"{self.time:.4g} s",
            "stiffness": f"{centre:.4g} N.m/rad" if around else f"{low:.4g} to {high:.4g} N.m/rad",
            "supply": f"{self.voltage:.4g} V" + ("" if math.isinf(self.current) else f", {self.current:.4g} A"),
            "stroke": f"{from_si(self.stroke, 'deg'):.3g} deg", **({"process": self.process} if self.process else {}),
        }  # fmt: skip

    def draft(self, name: str) -> str:
        """Return the study of the joint with the hardware for the nearest diameter, whatever it bears."""
        return study_text(self, hardware_by_fit(self)[0], name)

    def with_stiffness(self, stiffness: float) -> Self:
        """Return the task with another stiffness, 20 % to either side."""
        return replace(self, stiffness=((1.0 - _BAND) * stiffness, (1.0 + _BAND) * stiffness))


_ASKED_AS = {
    "holding_torque": "torque", "joint_stiffness@hot": "stiffness", "envelope_diameter": "diameter",
    "response_time": "time", "stiffening_time": "stiff-time", "peak_voltage": "supply", "peak_current": "supply",
    "stroke": "stroke",
}  # fmt: skip
"""Option of `size` that asks for a limit, by the limit's output."""


def in_options(text: str, label: Callable[[str], str]) -> str:
    """Return a text on limits with the options of `size` in place of the outputs that they limit, or their labels."""
    named = {name: option for output, option in _ASKED_AS.items() for name in (output, label(output))}
    names = "|".join(map(re.escape, sorted(named, key=len, reverse=True)))
    before = r"(?<![\w@])(?:(?<=\bif )|(?<=\bthat )|(?<=\band )|(?<![a-z] ))"  # no end of a longer label
    return re.sub(rf"{before}({names})(?= [<>]=)", lambda match: f"--{named[match[1]]}", text)


def processes() -> list[str]:
    """Return the processes of the catalogue: printing and milling."""
    return list(Catalog().names("processes"))


def _over(task: JointTask) -> dict[str, str]:
    """Return what goes over a set of hardware if the parts are milled; empty if they are printed."""
    milled = task.process and Catalog().record("processes", task.process).word("method") == "milled"
    return dict(_sizes()["milled"]) if milled else {}


def _positive(name: str, text: str, unit: str) -> float:
    """Return the SI value of an option. Raises InputError if it is none, or not above zero."""
    if not text:
        usual = "; an eighth of the torque a radian is usual" if name == "stiffness" else ""
        raise InputError(f"{name}: missing; write for instance '{_EXAMPLES[name]}'{usual}")
    try:
        value = parse_quantity(text, unit)
    except UnitError as error:
        raise InputError(f"{name}: {error}; write for instance '{_EXAMPLES[name]}'") from error
    if value <= 0.0:
        raise InputError(f"{name}: {text} is not above zero; write for instance '{_EXAMPLES[name]}'")
    return value


def _stiffness(text: str) -> tuple[float, float]:
    between = _RANGE.fullmatch(text.strip())
    if between is None:
        value = _positive("stiffness", text, "N*m/rad")
        return (1.0 - _BAND) * value, (1.0 + _BAND) * value
    unit = between["unit"] or between["high"].partition(" ")[2]
    low, high = (_positive("stiffness", end, "N*m/rad") for end in (f"{between['low']} {unit}", between["high"]))
    if low >= high:
        raise InputError(f"stiffness: {text} is upside down; write for instance '1 to 1.5 N.m/rad'")
    return low, high


def diameters() -> dict[str, float]:
    """Return the diameter [m] that each set of hardware suits."""
    return {name: parse_quantity(entry["diameter"], "mm") for name, entry in _sizes()["sets"].items()}


def hardware_by_fit(task: JointTask) -> list[str]:
    """Return the names of the sets of hardware, the one for the nearest diameter first."""
    sizes = diameters()
    return sorted(sizes, key=lambda name: abs(math.log(task.diameter / sizes[name])))


def records_of(hardware: str) -> set[str]:
    """Return the names that a set of hardware gives values, without those that all sets share."""
    entry, shared = _sizes()["sets"][hardware], _sizes()["shared"]
    return set(re.findall(_NAMES, f"{shared[entry['springs']]}{entry['module']}"))


def study_text(
    task: JointTask, hardware: str, name: str = "Joint", record: tuple[str, str] | None = None, widen: float = 1.0
) -> str:
    """Return a commented study of a joint with one set of hardware; a record may replace the set's own of a choice.

    A factor to `widen` ranges takes wire of any diameter in place of what one buys.
    """
    entry, shared, over = _sizes()["sets"][hardware], _sizes()["shared"], _over(task)
    low, high = task.stiffness
    caution = shared["cautious"] if task.cautious and entry["springs"] == "adjusted" and not over else ""
    template = own_template(__file__, "sized.yaml.jinja", last_of_each=_last_of_each, mm=_mm, digits=_digits)
    text: str = template.render(
        task=task, name=name, mode=SIZED_MODE, schema=SCHEMA_FILE, entry=entry, shared=shared, over=over,
        caution=caution, named=[*re.findall(_NAMES, caution), "softening_band", "plausible"], heater=_heater(task),
        limitless=math.inf,
        band=min(max(high / low, _BANDS[0]), _CAUTIOUS_BAND if task.cautious else _BANDS[1]),
        roomy=task.diameter > _ROOMY * diameters()[hardware], ranges=_vary(task, widen, entry),
        tolerances=_last_of_each(f"{_sizes()['tolerances'][entry['springs']]}\n{over.get('tolerances', '')}"),
    )  # fmt: skip
    if record:
        choice, other = record
        text = re.sub(rf"(?m)^  {choice}: (\S+).*$", rf"  {choice}: {other}   # in place of \1: limits conflict", text)
    return f"{text}\n"


def with_free_stroke(study: Study) -> Study:
    """Return the study of a joint with its stroke among what varies, and a preload that may follow it."""
    row, preload = _inputs()["stroke"], study.vary["preload_angle"]
    assert isinstance(preload, Range)
    vary = {
        **study.vary, "stroke": Range(lower=row.lower, upper=row.upper, start=parse_quantity(STROKE, "rad")),
        "preload_angle": preload.model_copy(update={"lower": row.lower, "upper": row.upper + preload.upper}),
    }  # fmt: skip
    module = {name: value for name, value in study.module.items() if name != "stroke"}
    return study.model_copy(update={"vary": vary, "module": module})


_ROOMY = 0.93
"""Share of the diameter that hardware suits from which the longer cut-out, of a fitting temperature, has room."""
_NAMES = r"(?m)^(\w+):"  # Names that lines of a study's section give values


def _inputs() -> dict[str, Input]:
    return {row.name: row for row in table_for(SIZED_MODE).inputs}


def _last_of_each(lines: str, without: str = "") -> str:
    """Return indented lines without one, and those that a later one of the same name replaces."""
    named = {line.partition(":")[0]: line for line in lines.splitlines() if line}
    named.pop(without, None)
    return "".join(f"  {line}\n" for line in named.values())


def _vary(task: JointTask, widen: float, entry: dict[str, str]) -> str:
    """Return the variables with ranges for a diameter and a stiffness, wire and preload as a set of hardware asks."""
    wire = _WIRE * (math.sqrt(task.stiffness[0] * task.stiffness[1]) * task.diameter) ** 0.25
    rows = _inputs()
    thinnest = rows["wire_diameter"].lower
    reach = (widen**-0.5, 1.0, widen)
    thin, thick = (
        _mm(max(beyond * factor * wire, thinnest)) for factor, beyond in zip(_WIRE_RANGE, reach[::2], strict=True)
    )
    bought = f"catalog: {entry.get('wires', 'metric')}, " if widen == 1.0 else ""
    lines = [f"wire_diameter: {{{bought}from: {thin}, to: {thick}}}"]
    for name, factors in _sizes()["scaled"].items():
        least, start, most = (
            _mm(min(max(wider * factor * task.diameter, beyond * rows[name].lower), rows[name].upper))
            for factor, beyond, wider in zip(factors, (1.0, 1.1, 1.2), reach, strict=True)
        )
        lines.append(f"{name}: {{from: {least}, to: {most}, start: {start}}}")
    share, start_beyond, most_beyond = _PRELOAD
    most_beyond = parse_quantity(entry["preload"], "rad") if "preload" in entry else most_beyond
    # A current [A] that the heater bears in three of four plausible cases.
    rating = Catalog().record("heaters", _heater(task)).entry("max_current")
    low, high = rating.low or rating.value, rating.high or rating.value
    strongest = min(task.current, low + 0.25 * (high - low))
    weakest = max(0.02 * strongest, rows["current"].lower)
    lines += [
        "coil_count: [3, 10]", "arc_span: {from: 20 deg, to: 75 deg, start: 65 deg}",
        f"pcl_thickness: [{entry.get('layer', '0.5 mm')}, 2 mm]",
        f"current: {{from: {weakest:.3g} A, to: {strongest:.4g} A, start: {0.75 * strongest:.3g} A}}",
        f"preload_angle: {{from: {share * task.stroke:.3g} rad, to: {task.stroke + most_beyond:.3g} rad, "
        f"start: {task.stroke + start_beyond:.3g} rad}}",
        "pin_radius_ratio: {from: 0.3, to: 0.8, start: 0.65}",
        "link_dowel_ratio: {from: 0.5, to: 0.85, start: 0.7}",
    ]  # fmt: skip
    over = _over(task)
    return _last_of_each("\n".join([*lines, over.get("vary", "")]), without=over.get("fixed", ""))


_THIN_LEADS = 0.03  # Diameter [m] below which pads have room for thin leads alone


def _heater(task: JointTask) -> str:
    if over := _over(task):
        return over["heater"]
    if task.diameter < _THIN_LEADS:
        return "polyimide_foil_48v"
    return "polyimide_foil_24v" if task.voltage >= 23.9 else "polyimide_foil_12v"


def _mm(length: float) -> str:
    return f"{from_si(length, 'mm'):.3g} mm"


def _digits(value: float, digits: int = 4) -> str:
    return f"{value:.{digits}g}"
