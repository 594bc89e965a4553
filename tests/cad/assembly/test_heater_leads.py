"""Items that a heater takes beside its pads: cut-out, thermistor, wires, and how a foil is ordered."""

import math
from typing import Any

import cadquery as cq
import pytest
from cad_designs import TILES, design_of
from support import cases_of

from tvimdesign.base.units import ZERO_CELSIUS
from tvimdesign.cad.assembly import heater_leads
from tvimdesign.cad.assembly.assembly import MODULES
from tvimdesign.cad.assembly.bill_of_materials import Item, beside, bill, fixtures
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.jobs.main import _titles
from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.study import given, read_study_text
from tvimdesign.study.design import Design

FUSE = Catalog().record("thermal_fuses", "ultimheat_5ma3")


def switched(changes: dict[str, Any], hottest: float = 105.2, mode: str = "shear") -> Design:
    """Return a design that was taken through its cycle: its heater's highest temperature [degC] at 2.1 A."""
    design = design_of("switched", changes, mode)
    design.values.update(peak_heater_temperature=hottest + ZERO_CELSIUS, peak_cold_side_temperature=330.0)
    design.values.update(peak_current=2.1, stiffening_peak_current=0.2, peak_voltage=9.0, stiffening_peak_voltage=1.0)
    return design


def lines(design: Design) -> list[Item]:
    """Return what is beside the parts, and the cut-out where the module has one."""
    titles = _titles(design)
    drawn = "thermal_cutout" in MODULES[design.mode].drawn(dimensions(design))
    placed = {"thermal_cutout": cq.Solid.makeCylinder(2.1, 11.2)} if drawn else {}
    return [*bill(design, titles, placed), *beside(design, titles)]


def listed(design: Design) -> dict[str, str]:
    """Return the titles by kind."""
    return {item.kind: item.title for item in lines(design)}


@pytest.mark.parametrize(("changes", "mode"), [({}, "shear"), (TILES, "shear"), ({}, "compression")])
def test_every_heater_has_a_cut_out_a_thermistor_and_wires(changes, mode):
    items = listed(switched(changes, mode=mode))
    cutout = items["thermal_cutout"]
    assert cutout.startswith("Does not fit: it opens above the 60 °C that the structure bears")
    # No listed type opens below 60 °C, and that which stays closed at 105.2 °C opens at 122 °C.
    assert "choose parts that bear 122 °C. Not to be ordered: Thermal cut-out 5MA3" in cutout
    assert "5MA3SPF121019340: opens from 112 to 122 °C; the heater has 105.2 °C at most" in cutout
    assert "holds 94 °C for a week at its rated current, less than the heater's peak: ask the maker" in cutout
    assert "it opens above the 60 °C that the structure bears; it opens above the 120 °C that the heater" in cutout
    assert items["thermistor"].startswith("Thermistor, for 120 °C")
    assert "for 2.1 A and 120 °C" in items["heater_wire"]


def test_cut_outs_and_beads_say_only_what_they_can():
    bears = {"heater_module": "silicone_9ar_08_24v", "process": "print_pei_1010"}
    cutout = listed(switched(bears, hottest=83.0))["thermal_cutout"]
    assert "5MA3SPF152019340: opens from 147 to 157 °C" in cutout  # of what opens below the heater's 160 the highest
    assert "opens above" not in cutout
    assert cutout.startswith("Thermal cut-out 5MA3")
    low = switched(bears, hottest=83.0)
    low.values["cutout_ground_gap"] = -1e-3
    assert listed(low)["thermal_cutout"].startswith(
        "Does not fit: it has no room; choose one with room that opens only between 88 and"
    )
    assert all(not line.offer for line in lines(low) if line.kind == "thermal_cutout")
    assert "ask the maker" not in cutout
    assert "thermal_cutout" not in listed(switched({"heater_fuse": "none"}))
    assert listed(design_of("never switched", {}))["thermal_cutout"] == "ultimheat_5ma3"
    assert heater_leads.fuse_in_words(FUSE, switched({}, 226.0)).startswith("None fits: ")
    (item,) = (item for item in lines(switched({}, 226.0)) if item.kind == "thermal_cutout")
    assert not item.is_ordered
    # 91.5 °C of 105: 99 °C less 10 and 5 is what the best type that opens in time lets a heater reach.
    warm = listed(switched({"process": "print_pc_bambu"}, 91.5))["thermal_cutout"]
    assert "only between 96.5 and 105 °C or a heater of at most 84 °C or parts that bear 108 °C. Not to" in warm
    design = switched({"thermistor_diameter": 1.8e-3})
    assert "thermistor" not in listed(design)
    (item,) = bill(design, _titles(design), {"thermistor_1": cq.Solid.makeBox(1.0, 1.0, 1.0)})
    assert item.title.startswith(
        "Thermistor, bead of at most 1.8 x 4 mm with insulated wires, for 120 °C; NTC 10 kohm at 25 °C"
    )


@cases_of("heater_leads", "margins_of_a_cut_out")
def test_the_list_of_parts_says_of_a_cut_out_what_its_margins_say(parts, hottest, margin, holding):
    changes = {"heater_module": "silicone_9ar_08_24v", **parts}
    module = ", ".join(f"{name}: {word}" for name, word in changes.items())
    study = read_study_text(f"mode: shear\nmodule: {{{module}}}\n")
    peaks = {"peak_heater_temperature": hottest + ZERO_CELSIUS, "peak_cold_side_temperature": 330.0}
    margins = table_for("shear").evaluate(given(study) | peaks, ["cutout_margin", "cutout_holding_margin"])
    assert margins == pytest.approx({"cutout_margin": margin, "cutout_holding_margin": holding})
    cutout = listed(switched(changes, hottest))["thermal_cutout"]
    assert ("Not to be ordered" in cutout) == (margin < 0.0)
    rated = f"or for one that opens by 105 °C and holds {hottest:g} °C ("
    assert margin < 0.0 or (rated in cutout) == (holding < 0.0)


def test_a_cut_out_above_its_rated_current_fails_by_list_and_margin():
    design = switched({"heater_module": "silicone_9ar_08_24v", "process": "print_pei_1010"}, 83.0)
    for current, rated in ((15.9, True), (16.1, False)):
        design.values["peak_current"] = current
        peaks = {name: design.values[name] for name in ("peak_current", "stiffening_peak_current")}
        study = read_study_text("mode: shear\nmodule: {heater_module: silicone_9ar_08_24v}\n")
        margins = table_for("shear").evaluate(given(study) | peaks, ["cutout_current_margin"])
        assert margins["cutout_current_margin"] == pytest.approx(16.0 - current)
        assert ("None fits" in heater_leads.fuse_in_words(FUSE, design)) != rated


def test_an_emergency_stop_is_between_a_soft_joint_and_the_cut_out():
    # By hand: 10 kohm exp(3988 K (1/373.15 K - 1/298.15 K)) is 680 ohm, and 3.3 V x 680 / 10680 is 0.21 V.
    foil = {"heater_module": "polyimide_foil_24v", "process": "print_pc_bambu", "heater_fuse": "microtemp_g4a"}
    design = switched({"process": "print_pei_1010"}, hottest=101.0)
    assert "was not switched" in heater_leads.set_points_in_words(design)
    design.values["sensed_temperature"] = 100.0 + ZERO_CELSIUS
    message = heater_leads.set_points_in_words(design)
    assert "B57862S0103F040" in message
    assert "heating ends at 100 °C (0.68 kohm, 0.21 V at the divider), as in the simulation, and" in message
    # What stays closed at 101 °C opens from 112 °C: half the 11 K that the heater has, above the bead.
    assert "emergency stop at 106 °C (" in message
    # By hand: 598 ohm at 104.5 °C, 582 at 105.5, 4.8 mV between them; 3.3 V over half of that are 2^10.4 steps.
    assert "below the 112 °C where the cut-out may open. The two are 29 mV apart: read them " in message
    assert message.endswith("to 1 K, 4.8 mV, which wants an ADC of 11 bits or more over 3.3 V, calibrated")
    design = switched(foil, hottest=85.6)  # opens from 94 °C
    design.values["sensed_temperature"] = 84.2 + ZERO_CELSIUS
    assert "emergency stop at 88.4 °C (" in heater_leads.set_points_in_words(design)
    bare = switched(foil | {"heater_fuse": "none"}, hottest=85.6)
    bare.values["sensed_temperature"] = 84.2 + ZERO_CELSIUS
    assert "below the 105 °C that the structure bears. The two" in heater_leads.set_points_in_words(bare)
    bare.values["peak_heater_temperature"] = 103.4 + ZERO_CELSIUS
    assert "no emergency stop fits between that and the 105 °C that the structure" in heater_leads.set_points_in_words(
        bare
    )
    none = switched({"thermistor_diameter": 0.7e-3, "thermistor_length": 4e-3})
    none.values["sensed_temperature"] = 84.2 + ZERO_CELSIUS
    assert "thermistor's own table: heating ends at 84.2 °C, as" in heater_leads.set_points_in_words(none)


@cases_of("heater_leads", "thermistors")
def test_a_thermistor_that_fits_and_bears_the_heat_is_ordered(bead, heater, number):
    sizes = {"thermistor_diameter": 1e-3 * bead[0], "thermistor_length": 1e-3 * bead[1]}
    text = heater_leads.thermistor_in_words(switched({"heater_module": heater, **sizes}))
    named = [thermistor.number for thermistor in heater_leads.thermistors() if thermistor.number in text]
    assert named == ([number] if number else [])
    assert "needs its own table in the controller" in text


def test_foils_films_and_spreaders_are_ordered_by_their_measures():
    design = switched({"heater_module": "silicone_9ar_08_24v"})
    (item,) = bill(design, _titles(design), {"heater_1": cq.Solid.makeBox(1.0, 1.0, 1.0)})
    each = 45.0 * design.values["heater_volume"] / (1.6e-3 * 1600e-6) / 4.0  # 45 ohm of 1600 mm2, four pads
    amperes, area = 2.1, 1e4 * design.values["heater_volume"] / 1.6e-3 / 4.0  # in series; cm2
    works = f"{each * amperes:.3g} V and 2.1 A, {each * amperes**2 / area:.2g} W/cm²"
    power = f"rated for at least {each * amperes**2:.3g} W each, at {works}"
    # 2.1 A want AWG 22; the leads leave within the window, behind ledges of 2 mm.
    for words in (
        f"{each:.3g} ohm each, ± 10 %",
        power,
        "two leads of AWG 22 or thicker, 1 mm thick at most, insulated for 160 °C",
        "2 mm or more",
    ):
        assert words in item.title
    assert heater_leads.heater_order(switched({})) == []  # a Peltier module is bought by its number
    assert len(heater_leads.heater_order(design_of("never switched", {"heater_module": "polyimide_foil_24v"}))) == 3
    assert "polyimide_film" in listed(switched({}))
    assert "polyimide_film" not in listed(switched({"heater_fuse": "none"}))
    design = switched({})
    (release,) = (bought for bought in fixtures(design, {}) if not bought.fixture)
    assert (release.kind, release.made) == ("mould_release", False)
    design = switched(TILES)
    (item,) = bill(design, _titles(design), {"spreader_1": cq.Solid.makeBox(1.0, 1.0, 1.0)})
    assert item.title.endswith(f", {1e3 * design.values['spreader_thickness']:.3g} mm thick")
    area = 1e6 * design.values["heater_count"] * design.values["heater_area"]
    assert f"over {area:.4g} mm² in all" in listed(design)["heat_conducting_adhesive"]
    design = design_of("lined", {"liner_material": "peek", "adhesive_density": 1040.0})
    (item,) = (bought for bought in beside(design, {}) if bought.kind == "liner_adhesive")
    area, film = design.values["pcl_area"], 0.1e-3  # `liner_film`; a liner covers its arc
    assert item.mass == pytest.approx(1e3 * 1040.0 * area * film, rel=0.05)
    other = design.model_copy(update={"choices": design.choices | {"tang_adhesive": "another"}})
    (item,) = (bought for bought in beside(other, {}) if bought.kind == "liner_adhesive")
    assert item.mass == 0.0


def test_a_small_foil_on_a_strong_supply_is_ordered_by_its_working_voltage():
    design = switched({"heater_module": "polyimide_foil_24v"})
    large = "; ".join(heater_leads.heater_order(design))
    assert "which the driver" not in large
    assert "flat tail" not in large
    middle = 500.0 * (design.values["pcl_inner_radius"] + design.values["pcl_outer_radius"])
    assert f"off one face, 2 mm or more inside the outline, on R{middle:.3g}, " in large
    assert " mm to either side of the middle, towards the ends" in large
    design.study["require"] = [{"output": "peak_voltage", "limit": 24.0}]
    for name in ("heater_volume", "heater_area"):
        design.values[name] *= 0.2
    small = "; ".join(heater_leads.heater_order(design))
    assert " V and 2.1 A, which the driver makes from 24 V, " in small
    each = 1e4 * design.values["heater_volume"] / design.values["heater_thickness"] / 4.0  # cm2
    assert f"only {each:.2g} cm² each: ask whether such leads have room, or for a flat tail" in small


def test_a_wire_is_ordered_by_the_thinnest_section_that_bears_the_current():
    assert "copper of 0.326 mm² (AWG 22; PTFE" in listed(switched({}))["heater_wire"]  # 2.1 A; AWG 24 bears 2 A
    strong = switched({})
    strong.values.update(peak_current=40.0)
    assert "copper" not in listed(strong)["heater_wire"]
    sections = [wire.section for wire in heater_leads.wires()]
    assert sections == sorted(sections)
    for wire in heater_leads.wires():  # ASTM B258: 0.127 mm is gauge 36, and 39 gauges are a ratio of 92
        diameter = 0.127e-3 * 92 ** ((36 - int(wire.gauge.split()[1])) / 39)
        assert wire.section == pytest.approx(math.pi / 4 * diameter**2, rel=0.01)
