"""Forms of heaters: cut to the PCL or rectangles behind a spreader, and layers heated by their current.

A flexible module is cut to the face of the PCL. A rigid one is a rectangle: as many as have room share a pocket, and a
spreader of the PCL's outline lies on them, flush with the structure, and takes their heat to what they do not cover.
Each mode says how many pockets there are (`pocket_count`), how many modules lie in each (`tiles_per_pocket`), and what
the spreader resists (`spreader_resistance`).

A layer may be heated by the current it conducts itself, between the fingers of two combs on the pads' face. The combs
are etched in a flexible sheet that takes the pads' place: a record of the heaters that says `heat_source: layer`. The
layer's material has a `resistivity`. Heat is made evenly over the layer, and a little in the sheet.

Thermal cut-out in the heater's leads: its type, its body, and the room it takes below the floor.

It opens before anything is too hot. It lies below the floor, across the window of the first arc or the slot of the
first housing vane; a gap pad leads to it from the heater above. A pad's leads pass above it, those in a vane beside it.
"""

import functools
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record
from tvimdesign.base.units import ZERO_CELSIUS
from tvimdesign.device.core.mass_properties import template_mass
from tvimdesign.device.table import Feature, Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics.heat_flow import lumps, peltier, shape_factors

CUT = "flexible"
WITH_TILES = (Feature("heater_form", CUT),)
WITH_PADS = (Feature("heater_form", "rigid"),)
LEADS = 2.0  # Of a heater

kinds = QuantityGroup("Materials")
places = QuantityGroup("Layout", WITH_TILES)
weights = QuantityGroup("Size and weight", WITH_TILES)
flows = QuantityGroup("Switch")

kinds.choices("heater_form")


@places.output("1", default=1.0, requires=())
def heater_count(m: Module) -> Scalar:
    """Heaters of the module: one pad at each arc or block, or all its tiles."""
    if m.heater_form != CUT:
        return m.pocket_count * m.tiles_per_pocket
    if m.heater_module.word("form") != CUT:
        raise InputError(f"heater_form: {CUT} needs a module that can be cut; {m.heater_module.name} is rigid")
    return m.pocket_count


places.formulas("heater_form")


weights.from_template("spreader", "all spreaders together; zero without", template_mass, "g")
lead_weights = QuantityGroup("Size and weight")
lead_weights.from_template("lead", "the heaters' leads as far as they are drawn", template_mass, "g")


@flows.output("mm^2")
def heated_area(m: Module) -> Scalar:
    """Area of all heaters towards the layer."""
    return m.pcl_area if m.heater_form == CUT else m.heater_count * m.heater_area


@flows.output("%")
def heater_coverage(m: Module) -> Scalar:
    """Share of the layer's area that faces heaters."""
    return m.heated_area / m.pcl_area


@flows.helper()
def layer_contact(m: Module) -> Scalar:
    """Conductance of what heats the layer with it [W/m^2 K]: of pads, or of a spreader from the middle of its depth."""
    if m.heater_form == CUT:
        return m.hot_contact
    return 1.0 / (1.0 / m.hot_contact + 0.5 * m.spreader_thickness / m.spreader_conductivity)


@flows.helper()
def spreader(m: Module) -> lumps.Lump | None:
    """All spreaders as a body behind the modules' hot sides; none on pads that are cut."""
    if m.heater_form == CUT:
        return None
    through = 1.0 / (m.heater_coverage * m.spreader_contact) + 0.5 * m.spreader_thickness / m.spreader_conductivity
    conductance = m.pcl_area / (through + m.spreader_resistance)
    return lumps.Lump(conductance, m.spreader_mass * m.spreader_specific_heat, lumps.NOWHERE)


gaps = QuantityGroup("Gaps", WITH_TILES)


gaps.margins("heater_form.gaps")


RATINGS_ALIKE = 0.1
"""Share by which ratings of a Peltier module may differ from what the others make of them: makers round that far."""
_RATED = ("seebeck", "resistance", "conductance", "hot_side_temperature", "max_cooling_power")


def contradiction(record: Record) -> str:
    """Return the contradiction of a Peltier module's cooling power with its other ratings; empty if there is none."""
    if not set(_RATED) <= record.entries.keys():
        return ""
    *parameters, hot, stated = (record.value(name) for name in _RATED)
    computed = float(peltier.max_cooling_power(peltier.PeltierModule(*parameters), hot))
    if abs(computed / stated - 1.0) <= RATINGS_ALIKE:
        return ""
    return (
        f"{record.title}: Seebeck coefficient and resistance make a largest cooling power of {computed:.3g} W, the "
        f"sheet says {stated:.3g} W; its cooling may be off by as much. Measure one, or take the lower."
    )


PADS = "pads"
LAYER_HEATED = (Feature("heat_source", PADS),)

layer_kinds = QuantityGroup("Materials")
layer_flows = QuantityGroup("Switch")

layer_kinds.choices("layer_heater")


@layer_flows.output("ohm", requires=LAYER_HEATED)
def layer_resistance(m: Module) -> Scalar:
    """Resistance of the whole layer between its combs, wired as the heaters are."""
    if m.heater_form != CUT:
        raise InputError(f"heat_source: layer needs a heater that lies on the layer; {m.heater_module.name} is rigid")
    whole = shape_factors.comb_resistance(
        m.pcl_resistivity, m.pcl_depth, m.pcl_area, m.electrode_gap, m.electrode_width
    )
    return whole * (m.heater_count / m.heater_strings) ** 2


layer_flows.margins("heater_form.layer_flows")


@layer_flows.helper(instant=True)
def hottest_pcl(m: Module) -> Scalar:
    """Highest temperature [K] in the layer: at its face to the pads that heat it, anywhere in one that heats itself."""
    if m.heat_source == PADS:
        return m.stack_profile.near
    cells = [m.stack_profile.cells[i] for i in range(len(m.stack_profile.cells))]
    return functools.reduce(np.fmax, [m.stack_profile.near, *cells])


WITH_CUTOUT = (Feature("heater_fuse", "none"),)

heat = QuantityGroup("Switch", WITH_CUTOUT)
cutout_places = QuantityGroup("Layout", WITH_CUTOUT)
cutout_weights = QuantityGroup("Size and weight", WITH_CUTOUT)
cutout_rules = QuantityGroup("Gaps", WITH_CUTOUT)


for _name, _field, _about in (
    ("cutout_diameter", "body_diameter", "Diameter of the thermal cut-out's body"),
    ("cutout_length", "body_length", "Length of the thermal cut-out's body"),
    ("cutout_leg_diameter", "leg_diameter", "Diameter of the thermal cut-out's wires"),
    ("cutout_leg_straight", "leg_straight", "Length of those wires that must stay straight beside the body"),
):
    cutout_places.field(_name, "heater_fuse", _field, f"{_about}; zero without one", "mm")


@cutout_weights.output("mm^3")
def cutout_volume(m: Module) -> Scalar:
    """Volume of the thermal cut-out's body and the straight part of its wires; zero without one."""
    legs = 2.0 * m.cutout_leg_diameter**2 * m.cutout_leg_straight
    return 0.25 * np.pi * (m.cutout_diameter**2 * m.cutout_length + legs)


cutout_weights.from_template("cutout", "the thermal cut-out; zero without one", template_mass, "g")


cutout_rules.margins("heater_form.cutout_rules")


_LATE = "the thermal cut-out opens above what it saves: a cooler heater, another heater_fuse, or a better structure"
_WEAK = "the thermal cut-out takes more than its rated current: another heater_fuse, or heaters in series"
_CYCLE_ERROR = 0.2  # Of the cycle's temperatures [K]; reports do not warn within it
_SHORT = "the thermal cut-out holds less than the heater's peak for a week at its rated current: ask its maker"


@heat.output("K", advice=(at_least(0.0, _LATE),))
def cutout_margin(m: Module) -> Scalar:
    """Room of the best type of thermal cut-out: it opens below what the parts bear, and above the peak.

    The parts are heater, PCL, structure and liner. The heater's peak stays below the least temperature at which the
    type opens, by the record's working margin.
    """
    below = m.heater_fuse.value("opening_band") + m.heater_fuse.value("working_margin")
    return _best_room(m.heater_fuse, "functioning_temperature", _borne(m), _peak(m) + below)


@heat.output("K", advice=(at_least(0.0, _SHORT),))
def cutout_holding_margin(m: Module) -> Scalar:
    """Room of the best type of thermal cut-out that opens in time and holds the heater's peak at its rated current.

    IEC 60691 asks that it holds for a week; the heater's current may be far below the rated one. Zero if no type fits,
    which `cutout_margin` shows.
    """
    room = _best_room(m.heater_fuse, "holding_temperature", _borne(m), _peak(m))
    return np.where(m.cutout_margin >= -_CYCLE_ERROR, room, 0.0)


@heat.output("A", advice=(at_least(0.0, _WEAK),))
def cutout_current_margin(m: Module) -> Scalar:
    """Rated current of the thermal cut-out's strongest type less the highest of the whole heater."""
    return _strongest(m.heater_fuse) - np.fmax(m.peak_current, m.stiffening_peak_current)


def _strongest(record: Record) -> float:
    """Return the rated current [A] of a record's strongest type."""
    return record.value("high_rated_current" if record.has("high_rated_current") else "rated_current")


def _borne(m: Module) -> Scalar:
    """Return the temperature that heater, PCL, structure and liner bear."""
    lined = np.where(m.liner_depth > 0.0, m.liner_service_temperature, m.structure_service_temperature)
    structure = np.fmin(m.structure_service_temperature, lined)
    return np.fmin(np.fmin(m.heater_max_temperature, m.pcl_decomposition_temperature), structure)


def _peak(m: Module) -> Scalar:
    """Return the highest temperature of the heater."""
    return np.fmax(m.peak_heater_temperature, m.peak_cold_side_temperature)


def _best_room(record: Record, stays: str, borne: Scalar, peak: Scalar) -> Scalar:
    """Return the room of the best type: of its opening below what is borne, of the peak below what the column `stays`
    has."""
    rooms = [np.fmin(borne - kind["functioning_temperature"], kind[stays] - peak) for kind in record.table("types")]
    return functools.reduce(np.fmax, rooms)


class HeaterFuse(NamedTuple):
    """One cut-out: how it is ordered, between which temperatures [K] it opens, and what it holds for good."""

    designation: str
    opens_from: float
    opens_at: float
    holds: float
    above: tuple[str, ...]
    """Names of the ratings below its opening temperature, the least first; empty if it saves everything."""


def heater_fuse(record: Record, hottest: float, current: float, ratings: Mapping[str, float]) -> HeaterFuse:
    """Return the type of a record for a heater whose highest temperature [K] and current [A] are known.

    A type does not open in work where the least temperature at which it may open is a margin above the heater's
    highest. Of these the highest type that opens at or below the least of the `ratings` [K]; where all open above it,
    the lowest. Raises InputError where no type opens so high, or bears the current.
    """
    margin, band = record.value("working_margin"), record.value("opening_band")
    lowest = hottest + margin + band - _CYCLE_ERROR
    stays = [kind for kind in record.table("types") if kind["functioning_temperature"] >= lowest]
    if not stays:
        most = max(kind["functioning_temperature"] for kind in record.table("types")) - band - margin
        held, hot = (f"{kelvin - ZERO_CELSIUS:.4g} degC" for kelvin in (most, hottest))
        raise InputError(f"{record.title}: no type stays closed at the heater's {hot}, the highest at {held}")
    if current > (bears := _strongest(record)):
        raise InputError(f"{record.title}: no type bears the heater's {current:.3g} A, the strongest {bears:.3g} A")
    least = min(ratings.values())
    saving = [kind for kind in stays if kind["functioning_temperature"] <= least]
    kind = (max if saving else min)(saving or stays, key=lambda row: row["functioning_temperature"])
    high = "H" if current > record.value("rated_current") else "0"
    opens = kind["functioning_temperature"]
    name = record.words["designation"].format(**{"model": f"{round(kind['model']):03d}", "class": high})
    above = tuple(sorted((what for what in ratings if ratings[what] < opens), key=lambda what: ratings[what]))
    return HeaterFuse(name, opens - band, opens, kind["holding_temperature"], above)
