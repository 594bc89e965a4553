"""The steps say what two hands need: forces, currents, places, the order, and how a module is opened again."""

from collections.abc import Sequence
from math import degrees, radians
from typing import Any

import pytest
from cad_designs import DRIVEN, TILES, design_of

from tvimdesign.cad.assembly.assembly import MODULES
from tvimdesign.cad.assembly.assembly_note import all_steps, assembly_note, preload_tolerance, written_steps
from tvimdesign.cad.assembly.bill_of_materials import Item
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.parts.heater_parts import fits_in_window
from tvimdesign.study.design import Design

ADJUSTED = {"preload_adjuster": "rotary"}
COVERED = {"cover": "plate", "core_radius": 10.5e-3}
SWITCHED = {"current": 2.5, "response_time": 37.6, "hold_current": 0.75, "pin_force": 4.0}


def steps(design: Design) -> list[str]:
    """Return the steps of a design with all its parts."""
    dims = dimensions(design)
    items = [Item(kind, 4, False, "", "", 1.0, ()) for kind in MODULES[design.mode].kinds(dims)]
    return [step.text for step in written_steps(design, dims, items)]


def made(changes: dict[str, Any], mode: str = "shear", tolerance: dict[str, Any] | None = None) -> Design:
    """Return a design that was taken through its cycle, and whose study says how far its preload is off."""
    design = design_of("made", changes, mode)
    study = {"tolerances": {"preload_angle": tolerance}} if tolerance else {}
    return design.model_copy(update={"values": design.values | SWITCHED, "study": study})


def where(texts: Sequence[str], words: str) -> int:
    """Return the one step with these words."""
    (found,) = [index for index, text in enumerate(texts) if words in text]
    return found


LOOSE: dict[str, Any] = {"tang_hold": "hole"}
LAST = ("retainer's screw", "bonded to both")
OPENED: list[tuple[dict[str, Any], str, tuple[str, ...]]] = [
    (COVERED | ADJUSTED | LOOSE, "shear", ("link screws", "levers", "the cover", "adjusters from below", *LAST)),
    ({}, "shear", ("link screws", "levers", "tangs are bonded in the floor", *LAST)),
    (LOOSE | {"link_fit": "clearance"}, "shear", ("link screws", "Lift the link off", "lift the spring off", *LAST)),
    (LOOSE, "compression", ("link screws", "levers", "lift the spring off", LAST[0], "before new blocks")),
    (DRIVEN, "shear", ("open the motor", "link screws", "motor's hub from above", "the rotor held, turn out")),
]
"""A design's changes and mode, and what its steps say in order on how it is opened."""


@pytest.mark.parametrize(("changes", "mode", "words"), OPENED)
def test_every_module_says_how_it_is_opened_in_order(
    changes: dict[str, Any], mode: str, words: tuple[str, ...]
) -> None:
    texts = steps(made(changes, mode))
    opening = texts[min(i for i, text in enumerate(texts) if text.startswith("To open")) :]
    places = [where(opening, one) for one in words]
    assert places == sorted(places), opening
    assert ("levers" in " ".join(opening)) == (
        "link_dowel" in MODULES[mode].kinds(dimensions(design_of("made", changes, mode)))
    )


def test_steps_that_open_a_module_bring_no_part_into_its_place() -> None:
    opening = [
        step
        for step in all_steps()
        if step["text"].startswith(("To open", "Turn out", "Loosen", "Lift the link", "Wear"))
    ]
    assert len(opening) >= 7
    assert not any("place" in step for step in opening)


@pytest.mark.parametrize("changes", [{}, ADJUSTED])
def test_preload_is_set_by_the_force_that_takes_a_leg_off_its_pin(changes: dict[str, Any]) -> None:
    design = made(changes, tolerance={"plus_minus": radians(2.0)})
    preload = degrees(design.values["preload_angle"])
    (text,) = [one for one in steps(design) if "spring balance" in one]
    assert "4 N (408 g)" in text
    low, high = (4.0 * (1.0 + sign * 2.0 / preload) for sign in (-1, 1))
    assert f"the study counts on {low:.3g} to {high:.3g} N" in text


def test_springs_are_sorted_or_set_by_what_the_study_counts_on() -> None:
    texts = " ".join(steps(made({"free_angle_sorting": radians(5.0)})))
    assert "keep out those further off than ±5°: 58 % of what is bought are good enough" in texts
    adjusted = made(
        ADJUSTED, tolerance={"row": "free_angle_tolerance", "adjustable": True, "adjusted_to": radians(1.0)}
    )
    assert preload_tolerance(adjusted) == pytest.approx(radians(1.0))
    assert "a preload that is set within ±1°" in " ".join(steps(adjusted))


def test_the_layer_is_bonded_by_current_and_time_before_the_cover_hides_it() -> None:
    texts = steps(made(COVERED))
    bond = where(texts, "Bond the layer")
    assert "heat the pads with 2.5 A for 37.6 s, then hold 0.75 A for two minutes" in texts[bond]
    assert where(texts, "ight-hand springs") < bond < where(texts, "Lay the cover")
    profiled = made({}).model_copy(update={"current_profiles": {"softening": {}}})
    assert "with the study's current profile for 37.6 s" in " ".join(steps(profiled))
    assert "until the rotor turns by hand" in " ".join(steps(design_of("never switched", {})))


@pytest.mark.parametrize(("changes", "heated"), [({}, "pads"), (TILES, "spreaders")])
def test_faces_and_the_cut_out_s_place_are_those_of_this_module(changes: dict[str, Any], heated: str) -> None:
    design = made(changes)
    texts = " ".join(steps(design))
    assert f"Degrease the upper faces of the {heated}" in texts
    inside = fits_in_window(dimensions(design))
    assert ("across the first arc, in the window" in texts, "across the first arc, below" in texts) == (
        inside,
        not inside,
    )


def test_steps_state_walls_reamed_holes_and_the_compound_of_screws() -> None:
    texts = steps(made({}))
    assert (
        where(texts, "ream link and core") < where(texts, "set the rotor on them") < where(texts, "Press the 4 dowel")
    )
    milled, printed = (" ".join(steps(made(changes))) for changes in ({"process": "machine_6061"}, {}))
    assert "thread-locking compound" in milled
    assert "thread-locking compound" not in printed
    for changes, said in (({}, True), ({"process": "machine_6061"}, False)):
        design = made(changes)
        note = assembly_note(design, dimensions(design), [Item("housing", 1, True, "", "", 1.0, ())]).decode()
        assert ("walls, with lines of 0.4 mm" in note) == said


def test_screws_of_the_motor_have_their_size_and_key() -> None:
    design = made(DRIVEN)
    texts = " ".join(steps(design))
    size, key, mount = (
        1e3 * design.values[name] for name in ("motor_screw_length", "motor_screw_key", "mount_screw_key")
    )
    torque = design.values["motor_screw_torque"]
    assert f"x {size:.3g}, key {key:.3g}, {torque:.2g} N·m): the hub" in texts
    assert f"key {mount:.3g}, {design.values['mount_screw_torque']:.2g} N·m each." in texts


def test_each_step_says_who_holds_what_with_which_tool() -> None:
    for step in all_steps():
        needs = step["needs"]
        assert needs["hands"] in (1, 2), step["text"]
        assert all(needs[name] for name in ("fixture", "tools", "access", "checked")), step["text"]
        # Whoever holds a part with a screwdriver while another tool turns its screw is not alone.
        if "to hold the adjuster" in step["text"]:
            assert needs["hands"] == 2
