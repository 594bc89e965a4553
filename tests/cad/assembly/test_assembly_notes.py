"""Notes on putting modules together, as in notes/ (UPDATE_NOTES=1 rewrites them), and what every step must have."""

import csv
import io
import os
from math import radians
from pathlib import Path
from typing import Any

import cadquery as cq
import pytest
from cad_designs import BLOCKS, CASES, TILES, VANE_TILES, design_of

from tvimdesign.base.yaml_data import plain_data
from tvimdesign.cad.assembly.assembly import MODULES
from tvimdesign.cad.assembly.assembly_note import (
    WrittenStep,
    all_steps,
    assembly_note,
    preload_tolerance,
    steps_of,
    written_steps,
)
from tvimdesign.cad.assembly.bill_of_materials import Item, beside, bill, bill_csv, greased
from tvimdesign.cad.assembly.heater_leads import NOT_TO_BE_ORDERED
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.kinds import is_of_structure
from tvimdesign.cad.jobs.main import _titles
from tvimdesign.report.run.blocks.warnings import hints
from tvimdesign.study.design import Design

NOTES = Path(__file__).with_name("notes")
SWITCHED = {"current": 2.5, "response_time": 37.6, "hold_current": 0.75, "pin_force": 4.0,
            "sensed_temperature": 325.15, "peak_peltier_temperature": 326.15}  # fmt: skip
TOLERANCE = {"plus_minus": radians(2.0)}
ADJUSTED = {"row": "free_angle_tolerance", "adjustable": True, "adjusted_to": radians(1.0)}
LOOSE: dict[str, Any] = {"tang_hold": "hole", "link_fit": "clearance"}
COVERED = {"cover": "plate", "core_radius": 10.5e-3, "preload_adjuster": "rotary", "process": "machine_6061"}
BEAD = {"thermistor_diameter": 1.1e-3}
BEAD_BY_BLOCK = {"thermistor_diameter": 0.8e-3, "thermistor_length": 2.5e-3}
MADE: dict[str, tuple[str, dict[str, Any], dict[str, Any]]] = {
    "printed": ("shear", {"free_angle_sorting": radians(5.0)}, TOLERANCE),
    "milled": ("shear", COVERED | {"tang_hold": "hole"}, ADJUSTED),
    "blocks": ("compression", dict(BLOCKS), {}),
    "tiles": ("shear", TILES | BEAD, {}),
    "tiles in vanes": ("compression", VANE_TILES | BEAD_BY_BLOCK, {}),
    "sprung": ("shear", dict(CASES["sprung"][1]), {}),
    "sprung bearings": ("shear", dict(CASES["sprung bearings"][1]), {}),
}
"""Modes, changes and the tolerance of the preload, of modules that were taken through their cycle."""
BY_HAND = {
    # A leg leaves its pin at 4 N, 408 g, at 8.59 +- 2 degrees of preload; DIN 2194: 18.7 deg, erf(3 x 5/18.7/2^0.5).
    "printed": ("4 N (408 g)", "3.07 to 4.93 N", "±5°: 58 % of what is bought", "lines of 0.4 mm", "wound up by 8.59"),
    "milled": ("a preload that is set within ±1°", "thread-locking compound", "Machining"),
    # (1145/1070 - 1) times PCL of 0.95 or 1 mm.
    "sprung": ("0.0666",), "sprung bearings": ("0.0701",),
}  # fmt: skip


def made(name: str) -> Design:
    mode, changes, tolerance = MADE[name]
    design = design_of(name, changes, mode)
    study = {"tolerances": {"preload_angle": tolerance}} if tolerance else {}
    return design.model_copy(update={"values": design.values | SWITCHED, "study": study})


def note_of(design: Design) -> str:
    """Return how parts are made, and the steps without pictures and without what they need."""
    dims = dimensions(design)
    kinds = MODULES[design.mode].kinds(dims)
    items = [Item(kind, 4, is_of_structure(kind) or kind.startswith("pcl"), "", "", 1.0, ()) for kind in kinds]
    lines = assembly_note(design, dims, items).decode().splitlines()
    making = next(i for i, line in enumerate(lines) if line in ("## Printing", "## Machining"))
    return "\n".join(line.rstrip() for line in lines[making:] if not line.lstrip().startswith(("![", "|", "*"))) + "\n"


@pytest.mark.parametrize("name", MADE)
def test_a_note_is_that_of_the_snapshot(name: str) -> None:
    path, text = NOTES / f"{name}.txt", note_of(made(name))
    assert [words for words in BY_HAND.get(name, ()) if words not in text] == []
    if os.environ.get("UPDATE_NOTES"):
        path.write_text(text, encoding="utf-8")
    assert text == path.read_text(encoding="utf-8")


def test_steps_that_open_bring_no_part_and_each_says_who_holds_what() -> None:
    opening = [
        step
        for step in all_steps()
        if step["text"].startswith(("To open", "Turn out", "Loosen", "Lift the link", "Wear"))
    ]
    assert len(opening) >= 7
    assert not any("place" in step for step in opening)
    for step in all_steps():
        needs = step["needs"]
        assert needs["hands"] in (1, 2), step["text"]
        assert all(needs[name] for name in ("fixture", "tools", "access", "checked")), step["text"]
        # Whoever holds a part with a screwdriver while another tool turns its screw is not alone.
        if "to hold the adjuster" in step["text"]:
            assert needs["hands"] == 2
    # The cut-out and the thermistor have one step in each kind of module.
    for kinds in ({"heater", "pcl_arc"}, {"heater", "pcl_block"}, {"heater", "pcl_arc", "spreader"}):
        texts = [step["text"] for step in steps_of({*kinds, "thermal_cutout"})]
        assert sum("thermal cut-out" in text for text in texts) == 1, kinds
    assert preload_tolerance(made("milled")) == pytest.approx(radians(1.0))


def test_modules_never_switched_or_with_a_profile_say_how_to_bond() -> None:
    profiled = made("blocks").model_copy(update={"current_profiles": {"softening": {}}})
    assert "with the study's current profile for 37.6 s" in note_of(profiled)
    assert "until the rotor turns by hand" in note_of(design_of("never switched", {}))


def steps_with(design: Design, *items: Item) -> list[WrittenStep]:
    """Return the steps of a design, some of its kinds of part being given."""
    dims, given = dimensions(design), {item.kind: item for item in items}
    kinds = dict.fromkeys([*MODULES[design.mode].kinds(dims), *given])
    return written_steps(design, dims, [given.get(kind, Item(kind, 1, False, "", "", 1.0, ())) for kind in kinds])


@pytest.mark.parametrize("name", MADE)
def test_every_part_comes_into_its_place_before_the_steps_that_open(name: str) -> None:
    steps = steps_with(made(name), Item("unheard_of", 1, False, "", "", 1.0, ()))
    fallen_through = [step.text for step in steps if step.text.startswith("Fit the ") and not step.needs]
    assert fallen_through == ["Fit the unheard of (1)."]
    opening = [step.opens for step in steps]
    assert opening == sorted(opening)
    assert any(opening)
    texts = [step.text for step in steps]
    power = next(i for i, text in enumerate(texts) if "wiring diagram" in text)
    assert all(i > power for i, text in enumerate(texts) if "two minutes" in text)


@pytest.mark.parametrize("friction", [0.15, 0.25, 0.7])
@pytest.mark.parametrize("name", MADE)
def test_steps_grease_what_the_list_of_parts_has_grease_for(name: str, friction: float) -> None:
    design = made(name)
    design.values.update(bore_friction=friction, pin_friction=friction)
    texts = [step.text for step in steps_with(design)]
    wanted = {"reamer": "grease its flutes", "wave spring": "Grease the wave spring", "retainer": "Grease the retainer",
              "bore": "Grease the hub's bore", "pins": "Grease the rotor's pins"}  # fmt: skip
    greasing = [place for place, words in wanted.items() if any(words in text for text in texts)]
    listed = [item.title for item in beside(design, {}) if item.kind == "grease"]
    assert [title.partition("°C: ")[2].split(", ") for title in listed] == ([greasing] if greasing else [])
    plastic, plain = design.choices["making_method"] != "milled", design.choices.get("bearing", "none") == "none"
    assert ("pins" in greasing) == (friction < (0.2 if plastic else 0.6))
    assert ("bore" in greasing) == (plain and friction < 0.2)


def test_what_cures_wear_greases_the_pins() -> None:
    cure = plain_data(hints()["advice"]["pin_wear"]["mend"][0])["module"]
    design = design_of("worn", {})
    assert "pins" not in greased(design)
    design.values.update(pin_friction=cure["pin_friction"])
    assert "pins" in greased(design)


def test_parts_are_treated_as_the_specimens_before_all_else() -> None:
    design = design_of("annealed", {"process": "print_pc_bambu"})
    titles = _titles(design)
    (housing,) = bill(design, titles, {"housing": cq.Solid.makeBox(1.0, 1.0, 1.0)})
    assert housing.title.endswith("at 270 degC; dried and annealed at 80 °C")
    first = steps_with(design, housing)[0].text
    assert "these parts by the maker's sheet of the material: housing." in first
    assert "were dried and annealed at 80 °C" in first
    assert not any("specimens" in step.text for step in steps_with(design_of("petg", {})))


def test_a_part_that_does_not_fit_is_not_fitted() -> None:
    design = design_of("misfit", {})
    misfit = Item("thermal_cutout", 1, False, "", f"Does not fit. {NOT_TO_BE_ORDERED}: 5MA3", 0.6, ())
    (step,) = (step.text for step in steps_with(design, misfit) if "Crimp the thermal cut-out" in step.text)
    assert step.startswith("No listed thermal cutout fits: leave this step until one is found")
    assert not any("No listed" in step.text for step in steps_with(design))


def test_what_is_made_to_order_is_asked_for_first() -> None:
    design = design_of("ordered", {})
    spring = Item("spring_left", 4, False, "music_wire", "Torsion spring of Music wire", 1.0, ())
    screw = Item("link_screw", 4, False, "iso_7380_m3", "Button head screw ISO 7380-1 - M3 x 10 - A2-70", 1.0, ())
    housing = Item("housing", 1, True, "petg", "PETG", 1.0, ())
    rows = csv.DictReader(io.StringIO(bill_csv([spring, screw, housing]).decode("utf-8-sig")))
    assert [row["lead_time"] for row in rows] == ["made to order: ask first", "unknown", ""]
    assert "which no list says: spring left." in assembly_note(design, dimensions(design), [spring, screw]).decode()
