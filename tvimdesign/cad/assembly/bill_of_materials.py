"""The bill of materials: what a module is put together from, how often, of what, and how heavy."""

import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import cadquery as cq

from tvimdesign.base.atomic_files import TABLE_ENCODING
from tvimdesign.cad import cad_report
from tvimdesign.cad.assembly.heater_leads import (
    NOT_TO_BE_ORDERED,
    heater_order,
    largest,
    lead_in_words,
    pad_count,
    rating,
    thermistor_in_words,
    up,
    wire_in_words,
)
from tvimdesign.cad.export.step_file import product
from tvimdesign.cad.geometry.kinds import KINDS, PRODUCTION, SPRINGS, is_of_structure, kind_of
from tvimdesign.cad.parts import jigs
from tvimdesign.catalog.offers import QUOTE, Offer, Total, offer_for, total
from tvimdesign.device.components.tang import BONDED
from tvimdesign.study import Design

_DRY, _DRY_METAL = 0.2, 0.6
"""Friction of plastic, and of milled pins, below which they are greased: sources of `bore_friction`, `pin_friction`."""
_EFFICIENCY = 0.9  # Power out of a step-down driver over power into it, assumed
_GAP_PAD = 6.0  # Conductivity asked of a gap pad [W/(m K)], assumed: the cut-out follows its heater to some kelvin
_ROUNDING = 1e-6
_PEAKS = (("peak_voltage", "stiffening_peak_voltage"), ("peak_current", "stiffening_peak_current"))
"""Rows of the switch that a supply is bought by: volts, amperes."""
WIRED = {
    "series": "all heaters in series",
    "arcs_parallel": "arcs in parallel, the heaters of each in series",
    "vanes_parallel": "vanes in parallel, the heaters of each in series",
    "all_parallel": "all heaters in parallel",
}
"""By the word of `heater_wiring`."""
MADE_TO_ORDER = "made to order"
_RINGS = ("bearing_inner", "bearing_outer")
_SEALED = (*_RINGS, "motor_bearing")
"""Bearings: chips, grease and molten polymer are near, and a sealed one has the size of an open one."""
_SHEETS = ("spreader", "liner")  # Kinds cut from a sheet
DIVIDER = "10 kohm, 1 %"
"""Resistor between 3.3 V and a thermistor: that of the NTC at 25 °C. A smaller one would warm a hot bead."""
_BY_RATING = ("supply", "driver", "controller", "controller_supply", "divider_resistor")
"""Kinds whose type the builder chooses where no offer is known."""
_BY_MASS = {"pcl_arc": "pcl", "pcl_block": "pcl", "liner": "liner"}  # Material that a kind is paid by, by its mass
_PRICED_AS = {"spring_right": "spring", "spring_left": "spring", "bearing_inner": "bearing"}
"""Name that a kind has in the name of its price; of a bearing's two rings one stands for both."""
_HANDS = {"spring_right": "right", "spring_left": "left"}


@dataclass(frozen=True)
class Item:
    """One kind of part."""

    kind: str
    quantity: int
    made: bool
    material: str  # Record of the catalogue
    title: str  # Title in the catalogue, with the maker's number where there is one
    mass: float  # Of one [g]
    papers: tuple[str, ...]  # Files it is made or bought from
    solids: tuple[str, ...] = ()
    """Kinds of solid of the assembly that each of them is; none for what is drawn in no file."""
    fit: str = ""  # Tolerance classes of what it sits in and on
    fixture: bool = False  # True if it is made to make the module, and no part of it
    asks: tuple[float, float] = (0.0, 0.0)  # Volts and amperes that a supply or a driver must bear
    treatment: str = ""  # Treatment of the specimens that gave its material's strength
    cost: float = 0.0  # Of one [USD], as the quantity `cost` counts it; zero for what that leaves out

    @property
    def is_ordered(self) -> bool:
        """True for what one orders: neither made, nor part of what is ordered, nor a part that does not fit."""
        return not self.made and self.kind != "heater_lead" and self.fits

    @property
    def fits(self) -> bool:
        """True unless no listed type of the part fits."""
        return NOT_TO_BE_ORDERED not in self.title

    @property
    def offer(self) -> Offer | None:
        """Its number, pack and price, where a public list gives them."""
        return offer_for(self.kind, self.material, self.title, *self.asks) if self.is_ordered else None

    @property
    def price(self) -> str:
        """Price of a pack in words, or how else one comes by it."""
        if self.is_ordered:
            known = self.offer.in_words if self.offer else QUOTE
            return f"{self.cost:.2f} USD a piece, by the study or its record" if known == QUOTE and self.cost else known
        return "made" if self.made else "with its module" if self.kind == "heater_lead" else NOT_TO_BE_ORDERED.lower()

    @property
    def lead_time(self) -> str:
        """Lead time, unknown as no list has it; empty for what is not ordered."""
        if not self.is_ordered:
            return ""
        return f"{MADE_TO_ORDER}: ask first" if self.offer and self.offer.to_order else "unknown"


def bill(
    design: Design, titles: Mapping[str, str], placed: Mapping[str, cq.Solid], fits: Mapping[str, str] | None = None
) -> list[Item]:
    """Count the placed parts by kind; masses are those of the solids, `fits` are tolerance classes by kind."""
    groups: dict[str, list[cq.Solid]] = {}
    for name, solid in placed.items():
        groups.setdefault(kind_of(name), []).append(solid)
    items = []
    for kind, solids in groups.items():
        what = product(design, kind)
        mass = solids[0].Volume() * what.density * 1e-6
        stock = titles.get("stock_spring") if kind in SPRINGS else None
        title = _titled(design, kind, stock or titles.get(KINDS[kind].material) or what.material)
        treatment = titles.get(cad_report.TREATMENT, "") if is_of_structure(kind) else ""
        made = PRODUCTION[kind].down != "bought"
        fit = (fits or {}).get(kind, "")
        item = Item(
            kind, len(solids), made, what.material, title, mass, _papers(kind), (kind,), fit,
            cost=_cost_of_one(design, kind, mass),
        )  # fmt: skip
        words = title if treatment in title else f"{title}; {treatment}"
        items.append(replace(item, title=words, treatment=treatment))
    return items


def _cost_of_one(design: Design, kind: str, mass: float) -> float:
    """Return what one part costs [USD] by the prices of the table; a motor's parts are not counted."""
    if kind.startswith("motor_"):
        return 0.0
    material = "structure" if is_of_structure(kind) else _BY_MASS.get(kind)
    if material:
        return 1e-3 * mass * design.values.get(f"{material}_price", 0.0)
    return design.values.get(f"{_PRICED_AS.get(kind, kind)}_price", 0.0)


def as_ordered(items: Sequence[Item]) -> list[Item]:
    """Return the items as a shop sells them: a bearing's two rings are one bearing."""
    by_kind = {item.kind: item for item in items}
    inner, outer = (by_kind.get(kind) for kind in _RINGS)
    if not (inner and outer):
        return list(items)
    whole = replace(
        inner, kind="bearing", mass=inner.mass + outer.mass, papers=(*inner.papers, *outer.papers), solids=_RINGS,
        fit="; ".join(filter(None, (outer.fit, inner.fit))),
    )  # fmt: skip
    return [whole if item is inner else item for item in items if item is not outer]


def _titled(design: Design, kind: str, title: str) -> str:
    """Return what a part is ordered by: a spring is no piece of wire, so its sizes go with the wire's name."""
    if kind == "thermistor":
        return thermistor_in_words(design)
    if kind == "heater_lead":
        return f"{lead_in_words(design)}; it comes with its heater, drawn as far as it goes down"
    if kind == "heater" and (order := heater_order(design)):
        return "; ".join([f"{title}, to the outline of its STEP file", *order])
    if kind in _SEALED:
        return f"{title}, sealed on both sides (2RS)"
    if kind in _SHEETS:
        thick = f"{title}, {1e3 * design.value(f'{kind}_thickness'):.3g} mm thick"
        return thick + (", to the outline of its STEP file" if kind == "liner" else "")
    return _spring(design, kind, title) if kind in _HANDS else title


def _spring(design: Design, kind: str, title: str) -> str:
    """Return what a spring is ordered by, of a wire by its title, or the title of a stock spring."""
    if design.choices.get("stock_spring", "none") != "none":
        return f"{title}, wound {_HANDS[kind]}; one leg cut, the other one bent down, by the spring's sheet"
    wire, coil = 1e3 * design.value("wire_diameter"), 1e3 * design.value("coil_diameter")
    turns = design.value("coil_count")
    size = f"wire {wire:.4g} mm, mean coil {round(coil, 2):g} mm, {turns:.4g} coils, wound {_HANDS[kind]}"
    return f"Torsion spring of {title}: {size}, by the spring's sheet"


def beside(design: Design, titles: Mapping[str, str]) -> list[Item]:
    """Return what is bought beside the parts and drawn in no file: the tangs' adhesive, grease, and what feeds the
    pads."""
    items = [
        *_filament(design, titles),
        _polymer(design, titles),
        *_under_pads(design, titles),
        *_heat_conducting_adhesive(design),
    ]
    items += [*_of_the_heater(design), *_supply(design), *_motor_driver(design, titles), *_glues(design)]
    items += _beside_the_module(design, titles)
    if (inlay := design.values.get("liner_depth", 0.0)) > 0.0:
        record = str(design.choices["liner_adhesive"])
        film = inlay - design.value("liner_thickness")
        words = f"{titles.get('liner_adhesive', record)}, a film of {1e3 * film:.2g} mm under each liner"
        items.append(Item("liner_adhesive", 1, False, record, words, _liner_adhesive_mass(design, film), ()))
    if design.choices.get("tang_hold") == BONDED:
        mass = 1e3 * design.value("tang_adhesive_mass")
        record = str(design.choices["tang_adhesive"])
        items.append(Item("tang_adhesive", 1, False, record, titles.get("tang_adhesive", record), mass, ()))
    return items


def _liner_adhesive_mass(design: Design, film: float) -> float:
    """Return mass [g] of the film [m] under all liners, whose area is their volume over their thickness; zero where
    the table
    has no density of it: it has that of the tangs' adhesive, which may be the same."""
    if design.choices["liner_adhesive"] != design.choices.get("tang_adhesive"):
        return 0.0
    area = design.value("liner_volume") / design.value("liner_thickness")
    return 1e3 * area * film * design.value("adhesive_density")


def fixtures(design: Design, titles: Mapping[str, str]) -> list[Item]:
    """Return what the PCL is cast with, and what holds the rotor while springs are set: jigs, and mould release.

    No part of it, and not in its mass.
    """
    record = str(design.choices["structure_material"])
    title = titles.get("structure_material", record)
    bears = f"of {title} where that bears {jigs.CAST_AT:g} °C, else of aluminium, PC or ABS"
    jig = [Item(kind, 1, True, record, f"Fixture, {bears}", 0.0, _papers(kind), fixture=True) for kind in jigs.DRAWN]
    if design.value("spring_count"):
        holds = "Fixture: holds the rotor at rest while its springs are set"
        files = _papers(jigs.FORK)
        jig.append(Item(jigs.FORK, jigs.FORK_COUNT, True, record, holds, 0.0, files, fixture=True))
    if design.choices["making_method"] == "printed":
        tries = "Fixture, printed first, its holes as drawn: shows what the printer makes, by docs/how-to/my-printer.md"
        files = _papers(jigs.TRIAL)
        jig.append(Item(jigs.TRIAL, jigs.TRIAL_COUNT, True, record, tries, 0.0, files, fixture=True))
    release = f"Mould release for thermoplastics at {jigs.CAST_AT:g} °C, wiped thinly on mould and lid"
    return [*jig, Item("mould_release", 1, False, "", release, 0.0, ())]


def _filament(design: Design, titles: Mapping[str, str]) -> list[Item]:
    """Return the spools that the module's parts are printed of at home, with as much again for jigs and supports."""
    if cad_report.PRINT_TEMPERATURES[0] not in titles:
        return []
    kinds = ("housing", "rotor", "link", "retainer", "cover", "base")
    made = [design.values.get(f"{kind}_mass", 0.0) for kind in kinds]
    adjusters = design.values.get("adjuster_volume", 0.0) * design.value("structure_density")
    grams, record = 1e3 * (sum(made) + adjusters), str(design.choices["structure_material"])
    material = titles.get("structure_material", record)
    words = f"Filament of 1.75 mm, {material}: {grams:.3g} g for the parts, as much for the rest"
    return [Item("filament", math.ceil(2.0 * grams / 1000.0), False, record, words, 0.0, ())]


def _polymer(design: Design, titles: Mapping[str, str]) -> Item:
    """Return the polymer that arcs or blocks are cut or cast from."""
    record = str(design.choices["pcl_grade"])
    grams = 1e3 * design.value("pcl_volume") * design.value("pcl_density")
    title = f"{titles.get('pcl_grade', record)}, sheet or granulate: {grams:.2f} g for all of it, order twice as much"
    return Item("polymer", 1, False, record, title, 0.0, ())


def _least_rating(design: Design) -> str:
    """Return the rating that no part exceeds: the heater's, or that of the structure around it if it is lower."""
    return min("heater_max_temperature", "structure_service_temperature", key=design.value)


def _glues(design: Design) -> list[Item]:
    """Return what else holds: the locking of screws in metal and inserts, and the motor's bonded parts."""
    items, bears = [], rating(design, _least_rating(design))
    if design.choices["making_method"] == "milled":
        text = f"Thread-locking compound of medium strength for {bears}, for all screws in tapped metal"
        items.append(Item("thread_locker", 1, False, "", text, 0.0, ()))
    elif design.choices["thread_insert"] != "none":
        text = f"Nylon patch for {bears} on the threads of all screws in inserts: compounds would crack plastics"
        text += "; for one module order the screws with a patch on"
        items.append(Item("thread_patch", 1, False, "", text, 0.0, ()))
    if design.values.get("drive_height", 0.0) > 0.0:
        text = f"Structural adhesive for {bears}, for the motor's rotor, stator and magnet"
        items.append(Item("motor_adhesive", 1, False, "", text, 0.0, ()))
    return items


def _beside_the_module(design: Design, titles: Mapping[str, str]) -> list[Item]:
    """Return the screws that fix the module, and grease where parts rub."""
    places = greased(design)
    grease = f"Grease for plastics and metals, for {rating(design, _least_rating(design))}: "
    items = [Item("grease", 1, False, "", grease + ", ".join(places), 0.0, ())] if places else []
    if design.values.get("drive_height", 0.0) > 0.0:
        return items
    record, count = str(design.choices["mount_screw"]), round(design.value("foot_count"))
    longer = f"longer than {1e3 * (design.value('floor_thickness') + design.value('foot_height')):.3g} mm"
    title = f"{titles.get('mount_screw', record)}, {longer} by what bears the module"
    return [*items, Item("mount_screw", count, False, record, title, 0.0, ())]


def greased(design: Design) -> list[str]:
    """Return what is greased: the reamer, a wave spring, and where the study counts on less friction than dry."""
    pins = design.values.get("leg_pins_fitted", 0.0) > 0.0
    places = ["reamer"] if pins or design.values.get("dowels_fitted") else []
    plain = design.choices.get("bearing", "none") == "none"
    if plain and design.choices.get("axial_preload", "none") != "none":
        places += ["wave spring", "retainer"]
    if plain and design.value("bore_friction") < _DRY:
        places.append("bore")
    dry = _DRY_METAL if design.choices["making_method"] == "milled" else _DRY
    if pins or design.values.get("pin_friction", _DRY) < dry:
        places.append("pins")
    return places


def _under_pads(design: Design, titles: Mapping[str, str]) -> list[Item]:
    """Return what lies between heaters and housing: adhesive that carries the torque, and grease where they slide.

    Pads and spreaders in vanes are glued at their ends, and the block presses them in.
    """
    if design.mode == "compression" or design.choices.get("heater_form", "flexible") != "flexible":
        grease = f"Thermal grease for {rating(design)}, a film behind each heater"
        items = [Item("thermal_grease", 1, False, "", grease, 0.0, ())]
        if design.mode != "compression":
            gap, deep = 1e3 * design.value("spreader_gap"), 1e3 * design.value("spreader_depth")
            where = f"along both rims of each spreader, {gap:.2g} mm wide and {deep:.2g} mm deep"
            items.append(_adhesive(design, titles, where))
            tape = f"PTFE sealing tape for {rating(design)}, twisted into cords below the spreaders' rims"
            items.append(Item("sealing_tape", 1, False, "", tape, 0.0, ()))
        elif design.choices.get("heater_form", "flexible") != "flexible":
            items.append(_adhesive(design, titles, "below the lower edge of each spreader"))
        return items
    tension = design.values.get("ledge_tension", math.nan)
    bears = f", which bears {1e-6 * tension:.2g} MPa in tension" if math.isfinite(tension) else ""
    return [_adhesive(design, titles, f"a thin film on the heaters' ledges{bears}")]


def _adhesive(design: Design, titles: Mapping[str, str], where: str) -> Item:
    """Return the heaters' adhesive, which carries the torque of the joint."""
    record = str(design.choices["heater_adhesive"])
    return Item("heater_adhesive", 1, False, record, f"{titles.get('heater_adhesive', record)}, {where}", 0.0, ())


def _heat_conducting_adhesive(design: Design) -> list[Item]:
    """Return what joins rigid heaters and their spreaders, or fills the holes of thermistors."""
    if design.choices.get("heater_form", "flexible") == "flexible":
        if design.values.get("thermistor_diameter", 0.0) <= 0.0:
            return []
        words = f"Heat-conducting adhesive for {rating(design, _least_rating(design))}, to fill the thermistors' holes"
        return [Item("heat_conducting_adhesive", 1, False, "", words, 0.0, ())]
    area = 1e6 * design.value("heater_area") * design.value("heater_count")
    words = f"Adhesive of modules and spreaders, for {rating(design)}, a thin film over {area:.4g} mm² in all"
    return [Item("heat_conducting_adhesive", 1, False, "", words, 0.0, ())]


def _of_the_heater(design: Design) -> list[Item]:
    """Return wires, what joins and covers them, and a thermistor where none is drawn, below a spreader in a hole."""
    items = []
    covers = 2 * round(design.values.get("thermistor_count", 1.0))
    if design.values.get("thermistor_diameter", 0.0) <= 0.0:
        below_arcs = design.mode != "compression" and design.values.get("spreader_depth", 0.0) > 0.0
        hole = design.values.get("lead_hole_diameter", 0.0) if below_arcs else 0.0
        through = f", through a hole of {1e3 * hole:.3g} mm" if hole else ""
        count = round(design.value("arc_count")) if hole else 1
        items.append(Item("thermistor", count, False, "", thermistor_in_words(design) + through, 0.0, ()))
    if design.values.get("cutout_diameter", 0.0) > 0.0:
        film = f"Polyimide film with adhesive for {rating(design)}, to wrap the thermal cut-out and to hold it"
        length, width = (1e3 * design.value(name) for name in ("cutout_length", "cutout_diameter"))
        thick = 0.5 * math.ceil(2e3 * design.value("cutout_gap") - _ROUNDING)
        size = f"{thick:g} mm thick, {width:.3g} x {length:.3g} mm, at least {_GAP_PAD:g} W/(m·K)"
        bridge = f"Gap pad of silicone for {rating(design)}, {size}, from the heater to the thermal cut-out"
        items += [Item(kind, 1, False, "", of, 0.0, ()) for kind, of in (("polyimide_film", film), ("gap_pad", bridge))]
        covers += 2
    sleeves = f"Sleeve of PTFE or glass fibre for {rating(design)}, over each bare wire of thermistors and cut-out"
    items.append(Item("wire_sleeve", covers, False, "", sleeves, 0.0, ()))
    if not (wire := wire_in_words(design, pad_count(design))):
        return items
    items.append(Item("heater_wire", 1, False, "", wire, 0.0, ()))
    joints = 2 * pad_count(design) + (2 if design.values.get("cutout_diameter", 0.0) > 0.0 else 0)
    words = f"Uninsulated crimp splice for the wires it joins, for {rating(design)}, with a shrink sleeve over it"
    return [*items, Item("crimp_splice", joints, False, "", words, 0.0, ())]


def _supply(design: Design) -> list[Item]:
    """Return supply, driver and controller by what the switch asks; none where the design was not taken through it."""
    volts, amperes = (largest(design, names) for names in _PEAKS)
    if not volts or not amperes:
        return []
    ways = "both ways round" if design.values.get("cooling_current", 0.0) > 0.0 else "one way round"
    wired = WIRED[design.choices.get("heater_wiring", "series")]
    asks = bears = (volts, amperes)
    least = f"at least {up(volts)} V and {up(amperes)} A over {wired}"
    ways += f", its limit set to {amperes:.3g} A"
    driver, supply = f"H-bridge, current controlled {ways}, {least}", f"DC supply, {least}"
    if (given := design.supply_voltage) is not None:
        bears = given, volts * amperes / given / _EFFICIENCY  # power is what stays
        supply = f"DC supply of {given:.4g} V, at least {up(bears[1])} A"
        driver = f"Step-down driver, current controlled {ways}, from {given:.4g} V, {least}"
    sensors, given = round(design.values.get("thermistor_count", 1.0)), given or float(up(volts))
    controller = (
        f"Controller with an output that sets the driver's current, and 3.3 V inputs for thermistors: {sensors}"
    )
    return [
        Item("supply", 1, False, "", supply, 0.0, (), asks=bears),
        Item("driver", 1, False, "", driver, 0.0, (), asks=asks),
        Item("controller", 1, False, "", controller, 0.0, ()),
        Item("controller_supply", 1, False, "", f"Step-down converter for the controller, from {given:.4g} V", 0.0, ()),
        Item("divider_resistor", sensors, False, "", f"Resistor, {DIVIDER}, from 3.3 V to a thermistor", 0.0, ()),
    ]


def driver_inputs(design: Design) -> str:
    """Return by which inputs the controller sets the driver: by its maker's sheet if a listed one is enough."""
    chosen = next((item.offer for item in _supply(design) if item.kind == "driver"), None)
    ways = (
        ("PWM, direction", " and direction inputs")
        if design.values.get("cooling_current", 0.0) > 0.0
        else ("PWM", " input")
    )
    return (chosen and chosen.inputs) or f"{ways[0]}: outputs at the driver's logic level to its PWM{ways[1]}"


def _motor_driver(design: Design, titles: Mapping[str, str]) -> list[Item]:
    """Return the driver of the motor, with the voltage that feeds it; none where the study names none."""
    record = str(design.choices.get("motor_driver", "none"))
    if record == "none":
        return []
    title = f"{titles.get('motor_driver', record)}, fed with {design.value('motor_supply_voltage'):.4g} V"
    return [Item("motor_driver", 1, False, record, title, 1e3 * design.value("motor_driver_mass"), ())]


def _papers(kind: str) -> tuple[str, ...]:
    """Return files a part is made from, or ordered by."""
    if kind in SPRINGS:
        return (cad_report.SPRING_SHEET, cad_report.SPRING_TABLE)
    making = jigs.MAKING.get(kind) or PRODUCTION[kind]
    drawing = (cad_report.drawing_pdf(kind),) if making.drawn else ()
    if making.down == "bought":
        return (cad_report.step(kind), *drawing)
    return (cad_report.step(kind), *drawing, cad_report.print_3mf(kind))


def _source(item: Item) -> str:
    if item.fixture:
        return "fixture"
    return "made" if item.made else "bought"


def cost(items: Sequence[Item]) -> Total:
    """Return what the bought lines cost that have a price, in whole packs."""
    return total((item.offer, item.quantity) for item in as_ordered(items) if item.is_ordered)


def bill_csv(items: Sequence[Item]) -> bytes:
    """Return the bill as CSV, a row for each thing made or bought; `solids` names what it is in the assembly."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["item", "part", "quantity", "made_or_bought", "catalogue_record", "title", "fit",
                     "mass_each_g", "mass_all_g", "supplier", "number", "pack", "price", "cost_all_usd",
                     "lead_time", "link", "solids", "files"])  # fmt: skip
    for number, item in enumerate(as_ordered(items), start=1):
        offer = item.offer
        chosen = "to be chosen" if item.kind in _BY_RATING or not item.fits else ""
        noted = ", ".join(filter(None, (offer.number, offer.note))) if offer else chosen
        ordered = (offer.supplier, noted, offer.pack) if offer else ("", noted, "")
        writer.writerow([
            number, item.kind, item.quantity, _source(item), item.material, item.title,
            item.fit, f"{item.mass:.3f}", f"{item.mass * item.quantity:.3f}", *ordered, item.price,
            f"{item.cost * item.quantity:.4f}" if item.cost else "", item.lead_time, offer.link if offer else "",
            " ".join(item.solids), " ".join(item.papers),
        ])  # fmt: skip
    return stream.getvalue().encode(TABLE_ENCODING)
