"""Offers for bought parts, with real records and whole packs, and the wiring diagram of what is bought."""

from __future__ import annotations

import itertools
import re
from itertools import combinations, pairwise
from xml.etree import ElementTree

import pytest
from cad_designs import DRIVEN, TILES, design_of
from support import cases_of

from tvimdesign.cad.assembly.bill_of_materials import Item, beside, driver_inputs
from tvimdesign.cad.assembly.heater_leads import NOT_TO_BE_ORDERED
from tvimdesign.cad.assembly.wiring import strings, wiring_svg
from tvimdesign.catalog import Catalog
from tvimdesign.catalog.category import CATEGORIES
from tvimdesign.catalog.offers import QUOTE, offer_for, offers, total

KINDS = {"thread_locker", "thread_patch", "supply", "driver", "controller", "thermistor", "heat_conducting_adhesive"}
KINDS |= {"preload_spring", "heater", "thermal_cutout", "controller_supply", "divider_resistor", "heater_wire"}
KINDS |= {"crimp_splice", "wire_sleeve", "polyimide_film", "gap_pad", "sealing_tape", "thermal_grease", "grease"}
KINDS |= {"filament", "mould_release", "spreader", "liner", "motor_driver"}
DATE, UNDATED = re.compile(r"20\d\d-\d\d(-\d\d)?"), "not stated"
BRIDGE, DOWN = "H-bridge, current controlled", "Step-down driver, current controlled"


def test_each_offer_is_of_a_record_or_a_known_line_and_names_its_source():
    catalog = Catalog()
    known = {name for category in CATEGORIES for name in catalog.names(category)}
    for offer in offers():
        assert offer.record or offer.kind or offer.size, offer
        assert offer.record in ("", *known), offer
        assert offer.kind in ("", *KINDS), offer
        assert offer.source
        assert bool(offer.number) != bool(offer.pattern), offer
        assert offer.price is None or offer.date == UNDATED or DATE.fullmatch(offer.date), offer
        assert offer.high is None or offer.high >= (offer.price or 0.0)


def test_a_screw_is_ordered_by_its_length():
    ten = offer_for("link_screw", "iso_7380_m3", "Button head screw ISO 7380-1 - M3 x 10 - A2-70")
    assert ten is not None
    assert (ten.number, ten.pack, ten.in_words) == ("92095A182", 100, "7.19 to 7.91 USD a pack of 100 (2025-06)")
    spring = offer_for("spring_left", "music_wire", "Torsion spring T10160, wire 0.42 mm, wound left")
    assert spring is not None
    assert spring.number == "T10160"
    eleven = offer_for("link_screw", "iso_7380_m3", "Button head screw ISO 7380-1 - M3 x 11 - A2-70")
    assert eleven is not None
    assert (eleven.supplier, eleven.number) == ("any fastener shop", "ISO 7380-1 - M3 x 11 - A2-70")


def test_what_must_bear_a_temperature_is_ordered_where_it_does():
    ordered = {
        degrees: offer_for("heat_conducting_adhesive", "", f"Adhesive for {degrees} °C") for degrees in (105, 160)
    }
    assert ordered[105] is not None
    assert ordered[105].number == "8329TCM-6ML (MG Chemicals)"
    assert ordered[160] is None
    # In the holes of a floor of PETG, which bears 60 °C, below a foil that bears more.
    design = design_of("foil", {"heater_module": "polyimide_foil_24v", "thermistor_diameter": 2e-3})
    (title,) = (item.title for item in beside(design, {}) if item.kind == "heat_conducting_adhesive")
    assert title.startswith("Heat-conducting adhesive for 60 °C")


def test_what_is_printed_at_home_lists_its_filament():
    design = design_of("plain", {})
    made = sum(1e3 * design.value(f"{kind}_mass") for kind in ("housing", "rotor", "link", "retainer"))
    titles = {"structure_material": "Polycarbonate (Bambu Lab PC), printed", "nozzle_temperature": "270"}
    (item,) = (item for item in beside(design, titles) if item.kind == "filament")
    assert f"{made:.3g} g for the parts" in item.title
    assert item.quantity == 1 + int(2.0 * made // 1000.0)
    assert item.offer is not None
    assert item.price == "47.27 to 228.80 USD a pack of 1 (2016-04, of polycarbonate, 1 kg)"
    assert not [item for item in beside(design, {}) if item.kind == "filament"]  # a shop brings its own


def test_the_driver_of_a_motor_is_ordered_by_its_record():
    design = design_of("driven", DRIVEN | {"motor_driver": "moteus_r4", "motor_supply_voltage": 36.0})
    (item,) = (item for item in beside(design, {}) if item.kind == "motor_driver")
    assert item.title == "moteus_r4, fed with 36 V"
    assert item.mass == pytest.approx(14.2)
    assert item.offer is not None
    assert (item.offer.number, item.offer.price) == ("moteus-r4.11", 79.0)
    assert not [item for item in beside(design_of("driven", DRIVEN), {}) if item.kind == "motor_driver"]


def test_a_price_of_a_neighbour_is_an_interval_and_says_whose_it_is():
    pin = offer_for("link_dowel", "iso_8734_2", "Dowel pin ISO 8734 - 2 m6 x 8 - A, hardened steel")
    assert pin is not None
    assert (pin.price, pin.high) == pytest.approx((12.70 / 2.2, 12.70 * 2.2))
    assert pin.in_words == "5.77 to 27.94 USD a pack of 50 (2026-09-30, of 91595A018)"
    twenty = offer_for("link_screw", "iso_7380_m3", "Button head screw ISO 7380-1 - M3 x 20 - A2-70")
    assert twenty is not None
    assert (twenty.price, twenty.high) == pytest.approx((7.19 / 2 / 2.2, 7.91 / 2 * 2.2))


def test_the_spread_holds_all_prices_of_one_screw_whatever_its_length():
    screws = [offer for offer in offers() if offer.record.startswith("iso_") and not offer.like]
    spans = [(screw.record, screw.price, screw.high or screw.price, screw.pack) for screw in screws if screw.price]
    assert len(spans) >= 8
    for (first, low, _, many), (second, _, high, few) in itertools.permutations(spans, 2):
        assert first != second or (high / few) / (low / many) <= 2.2, first


@cases_of("offers", "numbers")
def test_the_number_is_a_standards_a_makers_or_that_of_a_drawing(kind, record, title, supplier, number):
    offer = offer_for(kind, record, title)
    assert offer is not None
    assert (offer.supplier, offer.number) == (supplier, number)


@cases_of("offers", "first_taken")
def test_the_first_that_bears_volts_and_amperes_is_taken(kind, title, asks, number):
    offer = offer_for(kind, "", title, *asks)
    assert (offer.number if offer else None) == number


def test_the_sum_is_of_whole_packs_and_counts_what_has_no_price():
    screws = offer_for("", "iso_7380_m3", "M3 x 10 ")
    inserts = offer_for("", "heat_set_m3", "")
    polymer = offer_for("polymer", "pcl_50k", "")
    assert polymer is not None
    assert polymer.in_words == QUOTE
    # Two lines of one number come out of the same packs.
    sums = total([(screws, 99), (inserts, 8), (polymer, 1), (None, 3), (screws, 2)])
    assert (sums.low, sums.high) == pytest.approx((2 * 7.19 + 10.90, 2 * 7.91 + 10.90))
    assert (sums.priced, sums.lines) == (3, 5)


SVG = "{http://www.w3.org/2000/svg}"


@cases_of("offers", "strings")
def test_heaters_are_in_strings_as_they_are_wired(wiring, expected):
    assert strings(design_of("wired", TILES | {"heater_wiring": wiring})) == expected


def drawn(changes: dict[str, object]) -> ElementTree.Element:
    """Return the diagram of a module that was switched."""
    design = design_of("wired", changes)
    design.values.update(peak_voltage=9.0, peak_current=2.6)
    return ElementTree.fromstring(wiring_svg(design, beside(design, {})))


def words(picture: ElementTree.Element) -> set[str]:
    """Return the texts of a diagram."""
    return {text.text or "" for text in picture.iter(f"{SVG}text")}


def test_the_diagram_names_what_is_bought():
    bought = {"IRM-90-12ST (MEAN WELL)", "2992 (G2 24v13)", "thermal cut-out", "heater 6", "3 thermistors"}
    bought |= {"3 resistors", "10 kohm, 1 %", "step-down converter", "Seeed XIAO ESP32C6"}
    bought |= {"PWM, DIR", "3 ADC inputs, a divider each"}
    assert bought <= words(drawn(TILES))
    design = design_of("wired", TILES)
    misfit = Item("thermal_cutout", 1, False, "", f"Does not fit. {NOT_TO_BE_ORDERED}: 5MA3", 0.6, ())
    assert "to be chosen" in words(ElementTree.fromstring(wiring_svg(design, [misfit])))


@pytest.mark.parametrize(
    ("volts", "supply", "inputs"),
    [(9.0, None, "PWM, DIR: at most 100 kHz to PWM"), (9.0, 24.0, "MeCom: its maker's protocol"),
     (60.0, None, "PWM, direction: outputs at the driver's logic level to its PWM and direction inputs")],
)  # fmt: skip
def test_the_inputs_of_the_driver_are_those_of_its_sheet_or_of_any(volts, supply, inputs):
    design = design_of("wired", TILES)
    design.values.update(peak_voltage=volts, peak_current=2.6)
    design.study["require"] = [{"output": "peak_voltage", "sense": "<=", "limit": supply}] if supply else []
    assert driver_inputs(design).startswith(inputs)


def test_only_peltiers_come_with_a_note_on_cooling():
    assert "cools" in " ".join(words(drawn(TILES)))
    assert "cools" not in " ".join(words(drawn({"heater_module": "polyimide_foil_24v"})))


@pytest.mark.parametrize("wiring", ["series", "arcs_parallel", "all_parallel"])
def test_no_lines_cross_and_none_runs_through_a_box(wiring):
    picture = drawn(TILES | {"heater_wiring": wiring})
    pieces = []
    for line in picture.iter(f"{SVG}polyline"):
        points = [tuple(map(float, point.split(","))) for point in line.attrib["points"].split()]
        pieces += [spanned(*ends) for ends in pairwise(points)]
    assert not [pair for pair in combinations(pieces, 2) if overlap(*pair)]
    for box in picture.iter(f"{SVG}rect"):
        if "x" in box.attrib:
            x, y, wide, high = (float(box.attrib[name]) for name in ("x", "y", "width", "height"))
            assert not [piece for piece in pieces if overlap(piece, spanned((x, y), (x + wide, y + high)))]


Span = tuple[tuple[float, float], tuple[float, float]]


def spanned(start: tuple[float, ...], stop: tuple[float, ...]) -> Span:
    """Return from where to where two corners reach, across and down."""
    across, down = (sorted(both) for both in zip(start, stop, strict=True))
    return (across[0], across[1]), (down[0], down[1])


def overlap(first: Span, second: Span) -> bool:
    """Return whether two have a place in common; that one only touches the other with its end is none."""
    return all(max(a[0], b[0]) < min(a[1], b[1]) or (a[0] == a[1] and b[0] < a[0] < b[1])
               or (b[0] == b[1] and a[0] < b[0] < a[1]) for a, b in zip(first, second, strict=True))  # fmt: skip
