"""A process gives the structure its material and its clearances, and keeps the design to what it can make."""

from __future__ import annotations

from typing import Any

import pytest

from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.study import given, read_study_text

MODES = ("shear", "compression")
MM = 1e-3


def of_process(mode: str, process: str, **module: str) -> dict[str, Any]:
    """Inputs of a module that is the default one but for its process and what is said."""
    lines = "".join(f"\n  {name}: {value}" for name, value in module.items())
    study = read_study_text(f"mode: {mode}\nmodule:\n  process: {process}{lines}\n", "a test")
    return given(study, Catalog(), table_for(mode))


@pytest.mark.parametrize("mode", MODES)
def test_a_process_brings_its_material_and_its_clearance(mode: str) -> None:
    printed, milled = of_process(mode, "print_petg"), of_process(mode, "machine_7075")
    assert printed["structure_material"].name == "petg"
    assert milled["structure_material"].name == "aluminum_7075_t6"
    assert printed["structure_density"] == pytest.approx(1270.0)
    assert milled["structure_density"] == pytest.approx(2810.0)
    assert printed["running_clearance"] == pytest.approx(0.4 * MM)
    assert milled["running_clearance"] == pytest.approx(0.1 * MM)


def test_what_a_study_says_goes_before_what_the_process_brings() -> None:
    own = of_process(
        "shear", "machine_6061", structure_material="petg", running_clearance="0.3 mm", minimum_wall="2 mm"
    )
    assert own["structure_material"].name == "petg"
    assert own["running_clearance"] == pytest.approx(0.3 * MM)
    assert own["minimum_wall"] == pytest.approx(2.0 * MM)


def test_a_material_that_bears_the_heat_of_the_layer_is_among_the_printed_ones() -> None:
    assert of_process("shear", "print_pc")["structure_service_temperature"] > 373.15


# Of each row that a process limits: what to set so that it is 0.1 mm beyond what printed PETG allows.
BEYOND = {
    "housing_wall_reserve": ("shear", {"wall_thickness": 1.1 * MM}),
    "hub_wall_reserve": ("shear", {"hub_wall": 1.1 * MM}),
    "rotor_plate_reserve": ("shear", {"rotor_thickness": 1.1 * MM}),
    "link_reserve": ("shear", {"link_thickness": 1.1 * MM}),
    "pin_reserve": ("shear", {"pin_diameter": 1.9 * MM}),
    "running_fit_reserve": ("shear", {"running_clearance": 0.2 * MM}),
    "tang_fit_reserve": ("shear", {"tang_clearance": 0.1 * MM}),
    "floor_web_reserve": ("shear", {"floor_thickness": 2.6 * MM, "peltier_thickness": 1.5 * MM}),
    # A core of 10 mm with its screws at 0.65 of that: 3.5 mm less half a hole of 4.8 mm.
    "link_screw_wall_reserve": ("shear", {"core_radius": 10 * MM, "link_screw_pilot": 4.8 * MM}),
    # Blocks 10 mm wide, 0.78 of it slot.
    "slot_web_reserve": (
        "compression",
        {"pcl_inner_radius": 20 * MM, "pcl_outer_radius": 30 * MM, "slot_share": 0.78},
    ),
    # A vane of 1.5 mm at the mean radius 33 of 24.2 and 41.8 mm has 1.1 mm at its inner end.
    "vane_root_reserve": (
        "compression",
        {"pcl_inner_radius": 24.2 * MM, "pcl_outer_radius": 41.8 * MM, "vane_thickness": 1.5 * MM},
    ),
}


@pytest.mark.parametrize("row", BEYOND)
def test_what_the_process_cannot_make_breaks_a_rule(row: str) -> None:
    mode, beyond = BEYOND[row]
    table = table_for(mode)
    inputs = of_process(mode, "print_petg")
    (rule,) = table.output(row).rules
    assert rule.sense == ">="
    assert rule.value == 0.0
    assert table.evaluate(inputs, [row])[row] >= 0.0
    assert table.evaluate({**inputs, **beyond}, [row])[row] == pytest.approx(-0.1 * MM, abs=1e-9)


def test_a_milled_pocket_is_no_deeper_than_its_corners_and_its_width_allow() -> None:
    inputs = of_process("shear", "machine_6061")
    rows = ["pad_pocket_reserve", "window_corner_reserve", "window_width_reserve", "window_pocket_reserve"]
    values = table_for("shear").evaluate(inputs, rows)
    # Corners of 1.5 mm are cut three radii deep; the pad is 1.5 mm thick, the floor 4 mm, the windows 10 mm wide.
    assert values["pad_pocket_reserve"] == pytest.approx(3.0 * MM)
    assert values["window_corner_reserve"] == pytest.approx(2.0 * MM)
    assert values["window_pocket_reserve"] == pytest.approx(37.5 * MM)
    assert values["window_width_reserve"] == pytest.approx((0.854548 * 26 - 4 - 2.1 * 1.5) * MM, rel=1e-4)


def test_pockets_are_wider_than_the_cutter_of_their_corners() -> None:
    shear = table_for("shear").evaluate(of_process("shear", "machine_6061"), ["window_depth_reserve"])
    # Arcs from 26 to 40 mm, ledges of 2 mm on both sides, corners of 1.5 mm.
    assert shear["window_depth_reserve"] == pytest.approx((14 - 4 - 3.15) * MM)
    blocks = of_process("compression", "machine_6061", pcl_inner_radius="20 mm", pcl_outer_radius="30 mm")
    compression = table_for("compression").evaluate({**blocks, "slot_share": 0.6}, ["slot_width_reserve"])
    assert compression["slot_width_reserve"] == pytest.approx((6 - 3.15) * MM)


def test_a_cutter_comes_down_between_the_posts_and_the_wall() -> None:
    rows = ["post_pocket_reserve", "housing_inner_radius", "placement_radius", "post_radius", "post_height"]
    table = table_for("shear")
    milled = table.evaluate(of_process("shear", "machine_6061"), rows)
    gap = milled["housing_inner_radius"] - milled["placement_radius"] - milled["post_radius"]
    assert milled["post_pocket_reserve"] == pytest.approx(4 * gap - milled["post_height"])  # four times its width
    # Posts that turn are parts of their own: nothing is milled between them and the wall.
    turning = table.evaluate({**of_process("shear", "machine_6061"), "preload_adjuster": "rotary"}, rows)
    assert turning["post_pocket_reserve"] == pytest.approx(4 * gap)
    tall = {**of_process("shear", "machine_6061"), "coil_count": 9.25}
    assert table.evaluate(tall, rows)["post_pocket_reserve"] < 0.0


def test_a_milled_slot_between_pads_is_no_deeper_than_its_corners_and_its_width_allow() -> None:
    inputs = of_process("compression", "machine_6061", floor_thickness="4 mm", block_height="3.5 mm")
    table = table_for("compression")
    values = table.evaluate(inputs, ["slot_pocket_reserve", "slot_corner_reserve", "slot_opening", "pad_seat"])
    depth = 4 + 3.5 + 0.1 - 2  # floor and vane, less the ledge
    assert values["slot_corner_reserve"] == pytest.approx((3 * 1.5 - depth) * MM)
    assert values["slot_pocket_reserve"] == pytest.approx(4 * values["slot_opening"] - depth * MM)
    # Corners of 1.5 mm are as wide as the pads: these would stand on nothing beside the slots.
    assert values["pad_seat"] == pytest.approx(0.0, abs=1e-12)
