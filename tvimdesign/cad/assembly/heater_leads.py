"""Orders for what a heater takes beside its pads: thermal cut-out, thermistor, wires."""

import math
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from typing import NamedTuple

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record, own_data
from tvimdesign.base.units import ZERO_CELSIUS, parse_quantity
from tvimdesign.device.core.heater_form import HeaterFuse, heater_fuse
from tvimdesign.study import Design, catalog_of

_HOTTEST = ("peak_heater_temperature", "peak_cold_side_temperature")
_STRONGEST = ("peak_current", "stiffening_peak_current")
_LINER = "liner_service_temperature"
_BEARS = {
    "the heater": "heater_max_temperature",
    "the PCL": "pcl_decomposition_temperature",
    "the structure": "structure_service_temperature",
    "the liner": _LINER,
}
"""What stands beside the heater, and the quantity that says what it bears."""
_ROOM = ("cutout_ground_gap", "cutout_retainer_gap")
"""Quantities that say whether a cut-out has room; negative where it has none."""
NOT_TO_BE_ORDERED = "Not to be ordered"  # In the title of a part if no listed type fits; its place is kept
HOLDING = "for a week at its rated current"  # Meaning of a holding temperature, by IEC 60691
_SMALL_FOIL = 2e-4  # Area [m^2] below which the note asks whether a foil has room for its leads, assumed
NOMINAL = 10e3  # Resistance [ohm] of a thermistor at 25 degC, and of the resistor it divides a voltage with
_DIVIDED = 3.3  # Voltage [V] over both
_ACCURACY = 1.0  # Error [K] of a thermistor read by its B value, assumed
_ROUNDING = 1e-6


def up(value: float) -> str:
    """Return a figure that a rating must reach, to a tenth upwards."""
    return f"{math.ceil(10.0 * value - _ROUNDING) / 10.0:g}"


def rating(design: Design, name: str = "heater_max_temperature") -> str:
    """Return a temperature that a bought part must bear, by default the heater's rating, in words."""
    return f"{up(design.value(name) - ZERO_CELSIUS)} °C"


def largest(design: Design, names: tuple[str, ...]) -> float | None:
    """Return the largest of some values that happen; None where the design was not taken through its cycle."""
    magnitudes = [abs(design.values[name]) for name in names if math.isfinite(design.values.get(name, math.nan))]
    return max(magnitudes, default=None)


def fuse_in_words(record: Record, design: Design) -> str:
    """Return the cut-out that a design's heater takes; why there is none; empty where nothing is known of its cycle."""
    hottest, current = largest(design, _HOTTEST), largest(design, _STRONGEST)
    if hottest is None or current is None:
        return ""
    bears = _ratings(design)
    try:
        fuse = heater_fuse(record, hottest, current, bears)
    except InputError as error:
        return f"None fits: {error}. {NOT_TO_BE_ORDERED}"
    size = " x ".join(f"{1e3 * record.value(name):.3g}" for name in ("body_diameter", "body_length"))
    works, holds = up(hottest - ZERO_CELSIUS), f"{fuse.holds - ZERO_CELSIUS:.3g} °C {HOLDING}"
    longer = f", less than the heater's peak: ask the maker how long it lasts there, or for {fuse_to_ask_for(design)}"
    details = [
        f"opens from {fuse.opens_from - ZERO_CELSIUS:.3g} to {fuse.opens_at - ZERO_CELSIUS:.3g} °C",
        f"the heater has {works} °C at most",
        f"it holds {holds}{longer if fuse.holds < hottest else ''}",
        f"body {size} mm",
        "ask for its rating in direct current",
    ]
    return f"{_misfit(record, design, fuse, hottest, bears)}{record.title}, {fuse.designation}: {'; '.join(details)}"


def fuse_to_ask_for(design: Design) -> str:
    """Return the ratings of a fuse that would fit, to ask makers for; empty where nothing is known of the cycle."""
    hottest, current = largest(design, _HOTTEST), largest(design, _STRONGEST)
    if hottest is None or current is None:
        return ""
    opens, volts = min(_ratings(design).values()), design.supply_voltage or largest(design, ("peak_voltage",))
    ends = f"opens by {opens - ZERO_CELSIUS:.3g} °C and holds {up(hottest - ZERO_CELSIUS)} °C"
    return f"one that {ends} ({current:.2g} A{f', {volts:.3g} V' if volts else ''} d.c.)"


def _misfit(record: Record, design: Design, fuse: HeaterFuse, hottest: float, bears: Mapping[str, float]) -> str:
    """Return why a cut-out must not be ordered for this module, and what to choose instead; empty for one that fits."""
    why = [f"it opens above the {bears[what] - ZERO_CELSIUS:.3g} °C that {what} bears" for what in fuse.above]
    if any(design.values.get(name, 0.0) < 0.0 for name in _ROOM):
        why.append("it has no room")
    if not why:
        return ""
    margin, band, least = record.value("working_margin"), record.value("opening_band"), min(bears.values())
    low = hottest + margin
    cooler = [
        kind["functioning_temperature"] - band - margin
        for kind in record.table("types")
        if kind["functioning_temperature"] <= least
    ]
    choose = []
    if low < least:
        opens = f"{up(low - ZERO_CELSIUS)} and {least - ZERO_CELSIUS:.3g} °C"
        choose.append(f"one with room that opens only between {opens}")
    if fuse.above:
        choose += [f"a heater of at most {max(cooler) - ZERO_CELSIUS:.3g} °C"] if cooler else []
        choose.append(f"parts that bear {up(fuse.opens_at - ZERO_CELSIUS)} °C")
    return f"Does not fit: {'; '.join(why)}; choose {' or '.join(choose)}. {NOT_TO_BE_ORDERED}: "


def _ratings(design: Design) -> dict[str, float]:
    """Return what must not become too hot, in words, with what it bears [K]; only what the design has."""
    return {
        words: design.values[name]
        for words, name in _BEARS.items()
        if math.isfinite(design.values.get(name, math.nan)) and (name != _LINER or design.values.get("liner_depth"))
    }


_ORDERED = {
    "air": "ambient_temperature",
    "PCL starts to melt": "pcl_melting_start",
    "coldest PCL as heating stops": "softened_temperature",
    "all PCL molten": "pcl_melting_end",
    "thermistor as heating stops": "sensed_temperature",
}
"""Temperatures of a switch, and the quantity of each."""


def temperatures_in_order(design: Design) -> dict[str, float]:
    """Return the temperatures [K] of a switch, where the cut-out may open and what parts bear, the lowest first."""
    switch = {words: design.values.get(name, math.nan) for words, name in _ORDERED.items()}
    switch["heater's peak"] = largest(design, _HOTTEST) or math.nan
    points = {f"{point} point": design.values[f"temperature@{point}"] for point in design.study["operating_points"]}
    limits = {f"limit of {what}": bears for what, bears in _ratings(design).items()} | _opening(design)
    ordered = sorted((switch | points | limits).items(), key=lambda entry: entry[1])
    return {words: kelvin for words, kelvin in ordered if math.isfinite(kelvin)}


def thermistor_in_words(design: Design) -> str:
    """Return a thermistor for the temperature the heater is rated for: its number, and the bead that is drawn where
    one is."""
    bears, bead, fits = f"for {rating(design)}", _bead(design), _thermistor(design)
    wanted = f"{bears}, with insulated wires"
    if bead:
        wanted = f"bead of at most {bead.in_words()} with insulated wires, {bears}"
    which = f": {fits.in_words()}; another one" if fits else ", of a maker whose bead fits: it"
    return f"Thermistor, {wanted}; NTC 10 kohm at 25 °C{which} needs its own table in the controller"


def set_points_in_words(design: Design) -> str:
    """Return what the thermistor reads as the joint is soft, and where the controller stops before a cut-out opens."""
    peaks = _HOTTEST[:1] if design.values.get("heater_seebeck") else _HOTTEST  # a Peltier cools its outer side
    soft, hottest = (largest(design, names) for names in (("sensed_temperature",), peaks))
    if soft is None or hottest is None:
        return "Take the controller's set-points from a run of the study: it was not switched"
    sensor = _thermistor(design)
    by = f"with {sensor.number}, by its B value" if sensor else "by the thermistor's own table"
    points = f"Set-points of the controller {by}: heating ends at {_reads(sensor, soft)}, as in the simulation,"
    ends = {f"that {what} bears": bears for what, bears in _ratings(design).items()} | _opening(design)
    what = min(ends, key=lambda words: ends[words])
    stop, end = soft + 0.5 * (ends[what] - hottest), f"{ends[what] - ZERO_CELSIUS:.3g} °C {what}"
    if stop - soft < _ACCURACY:
        return f"{points} and no emergency stop fits between that and the {end}: limit the time of heating"
    return f"{points} and an emergency stop at {_reads(sensor, stop)}, below the {end}{_resolution(sensor, soft, stop)}"


def _resolution(sensor: "Thermistor | None", soft: float, stop: float) -> str:
    """Return how far apart two temperatures [K] are at the divider, and the ADC whose steps are half of 1 K there."""
    if sensor is None:
        return ""
    apart, kelvin = (sensor.divided(low) - sensor.divided(stop) for low in (soft, stop - _ACCURACY))
    bits = math.ceil(math.log2(_DIVIDED / (0.5 * kelvin)))
    return (
        f". The two are {1e3 * apart:.2g} mV apart: read them to {_ACCURACY:g} K, {1e3 * kelvin:.2g} mV, which wants "
        f"an ADC of {bits} bits or more over {_DIVIDED:g} V, calibrated"
    )


def _reads(sensor: "Thermistor | None", kelvin: float) -> str:
    """Return a temperature, and a thermistor's resistance and voltage there."""
    text = f"{kelvin - ZERO_CELSIUS:.3g} °C"
    if sensor is None:
        return text
    return f"{text} ({1e-3 * sensor.resistance(kelvin):.3g} kohm, {sensor.divided(kelvin):.3g} V at the divider)"


def _opening(design: Design) -> dict[str, float]:
    """Return the least temperature [K] at which a design's cut-out may open; nothing without one that can be found."""
    with suppress(InputError):
        record = catalog_of(design).record("thermal_fuses", design.choices["heater_fuse"])
        hottest, current = largest(design, _HOTTEST), largest(design, _STRONGEST)
        if hottest is not None and current is not None:
            return {"where the cut-out may open": heater_fuse(record, hottest, current, _ratings(design)).opens_from}
    return {}


def _bead(design: Design) -> "Bead | None":
    """Return the bead that is drawn; None where none is."""
    if design.values.get("thermistor_diameter", 0.0) <= 0.0:
        return None
    return Bead(design.value("thermistor_diameter"), design.value("thermistor_length"))


def _thermistor(design: Design) -> "Thermistor | None":
    """Return the first thermistor that fits; None where none does."""
    bead, rated = _bead(design), design.value("heater_max_temperature")
    return next((thermistor for thermistor in thermistors() if thermistor.fits(bead, rated)), None)


class Bead(NamedTuple):
    """Size of the bead of a thermistor, or the largest it may have [m]."""

    diameter: float
    length: float

    def in_words(self) -> str:
        """Return both sizes."""
        return f"{1e3 * self.diameter:.3g} x {1e3 * self.length:.3g} mm"


class Thermistor(NamedTuple):
    """A thermistor as it is ordered."""

    number: str
    maker: str
    curve: str  # Temperatures [degC] between which its material has the constant `beta`, in words
    beta: float  # Constant of its material [K]
    wires: str
    temperature: float  # The highest that it measures [K]
    bead: Bead | None  # The most that its bead measures; None where that is not known

    def resistance(self, kelvin: float) -> float:
        """Return resistance [ohm] by the law R = R25 exp(B (1/T - 1/T25))."""
        return NOMINAL * math.exp(self.beta * (1.0 / kelvin - 1.0 / (ZERO_CELSIUS + 25.0)))

    def divided(self, kelvin: float) -> float:
        """Return the voltage [V] over it where a resistor as large as its nominal one divides the supply's with it."""
        ohms = self.resistance(kelvin)
        return _DIVIDED * ohms / (ohms + NOMINAL)

    def fits(self, bead: Bead | None, rated: float) -> bool:
        """Return whether it bears a temperature [K] and goes where a bead of that size is drawn.

        None where none is drawn.
        """
        if self.temperature < rated:
            return False
        if bead is None or self.bead is None:
            return bead is None
        return self.bead.diameter <= bead.diameter and self.bead.length <= bead.length

    def in_words(self) -> str:
        """Return what to order, and what to know of it."""
        size = f", bead of at most {self.bead.in_words()}" if self.bead else ""
        most = f"to {self.temperature - ZERO_CELSIUS:.3g} °C"
        return f"{self.number} of {self.maker} ({self.curve} {self.beta:.4g} K, {most}{size}, {self.wires})"


@cache
def thermistors() -> tuple[Thermistor, ...]:
    """Return the thermistors of the data file, the first choice first."""
    listed = []
    for entry in own_data(__file__, "thermistors.yaml")["thermistors"]:
        sizes = [parse_quantity(entry[name], "m") for name in ("diameter", "length") if name in entry]
        most, beta = parse_quantity(entry["temperature"], "degC"), parse_quantity(entry["beta"], "K")
        bead = Bead(*sizes) if sizes else None
        listed.append(Thermistor(entry["number"], entry["maker"], entry["curve"], beta, entry["wires"], most, bead))
    return tuple(listed)


def pad_count(design: Design) -> int:
    """Return the heaters of a design: those of the arcs or vanes, or all their tiles."""
    return round(design.value("heater_count"))


def wire_in_words(design: Design, pads: int) -> str:
    """Return the wires of the pads, by the current of the whole heater; empty where that is not known."""
    current = largest(design, _STRONGEST)
    if current is None:
        return ""
    text = f"Insulated wire for the {pads} heaters, two from each, for {up(current)} A and {rating(design)}"
    wire = _wire(current)
    source = own_data(__file__, "wire_ratings.yaml")["source"]
    text = f"{text}: copper of {1e6 * wire.section:.3g} mm² ({wire.gauge}; {source}) or thicker" if wire else text
    return f"{text}, spliced to the heaters' own leads{_own_leads(design)}"


def _wire(current: float) -> "Wire | None":
    """Return the thinnest wire that bears a current [A]."""
    return next((wire for wire in wires() if wire.current >= current), None)


def heater_order(design: Design) -> list[str]:
    """Return what a heater that only heats is ordered by: resistance, the rating that the design needs, and leads.

    Nothing for Peltier modules, which are bought by their number.
    """
    if design.values.get("heater_seebeck") != 0.0:
        return []
    count = pad_count(design)
    area = design.value("heater_volume") / design.value("heater_thickness")
    ohms = design.value("heater_resistance") * area / design.value("heater_area") / count
    order, leads = [f"resistance {ohms:.3g} ohm each, ± 10 % (assumed)"], "two leads"
    if (current := largest(design, _STRONGEST)) and design.choices.get("heat_source") != "layer":
        amperes = current / design.values.get("heater_strings", 1.0)
        watts = amperes**2 * ohms
        dense = 1e-4 * watts * count / area
        works = f"{amperes * ohms:.3g} V and {amperes:.3g} A"
        works += f", which the driver makes from {design.supply_voltage:.4g} V" if design.supply_voltage else ""
        order += [
            f"rated for at least {watts:.3g} W each, at {works}, {dense:.2g} W/cm²",
            "only behind the driver, which limits the current",
        ]
        leads += f" of {wire.gauge} or thicker" if (wire := _wire(amperes)) else f" for {up(amperes)} A"
    leads += f", {1e3 * design.value('lead_diameter'):.3g} mm thick at most"
    long, ledge = (1e3 * design.value(name) for name in ("envelope_diameter", "window_ledge"))
    exits = f"at least {long:.0f} mm long, off one face, {ledge:.3g} mm or more inside the outline"
    if design.mode == "compression":
        exits += f", side by side from R{1e3 * design.value('slot_inner_radius'):.3g} outwards"
    else:  # in the window of the floor, where there is no ledge
        radius = 5e2 * (design.value("pcl_inner_radius") + design.value("pcl_outer_radius"))
        start = 1e3 * design.value("lead_start")
        exits += f", on R{radius:.3g}, {start:.2g} mm to either side of the middle, towards the ends"
    small = f"only {1e4 * area / count:.2g} cm² each: ask whether such leads have room, or for a flat tail"
    order += [f"{leads}, insulated for {rating(design)}", f"leads {exits}"]
    return [*order, small] if area < _SMALL_FOIL * count else order


def _own_leads(design: Design) -> str:
    """Return gauge, diameter and length of the leads that heaters come with, as far as their record says."""
    gauge, length = (design.values.get(f"lead_{name}", 0.0) for name in ("gauge", "length"))
    known = [f"AWG {gauge:.0f}"] if gauge else []
    known += [f"{1e3 * length:.3g} mm long"] if length else []
    return f" ({', '.join(known)})" if known else ""


def lead_in_words(design: Design) -> str:
    """Return a lead of a rectangular heater: its outer diameter, and what else its record says."""
    return f"Lead of {1e3 * design.value('lead_diameter'):.3g} mm{_own_leads(design)}"


class Wire(NamedTuple):
    """A size of stranded copper wire."""

    gauge: str
    section: float  # Of its copper [m2]
    current: float  # Current that it bears in a bundle [A]


@cache
def wires() -> tuple[Wire, ...]:
    """Return the sizes of the data file, the thinnest first."""
    listed = own_data(__file__, "wire_ratings.yaml")["wires"]
    return tuple(
        Wire(row["gauge"], parse_quantity(row["section"], "m^2"), parse_quantity(row["current"], "A")) for row in listed
    )
