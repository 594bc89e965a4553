"""Vanes, blocks and pads as solids: where they stand, what the stroke makes of them, and that the checks bite."""

from math import pi

import cadquery as cq
import numpy as np
import pytest
from cad_designs import all_checks, design_of, random_blocks

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import build, drawn_parts
from tvimdesign.cad.export.mesh import solid_mesh
from tvimdesign.cad.export.print_files import closed
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.geometry.solids import block, rounded, sector, turned
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.device.core.clearances import POCKET_WIDTH
from tvimdesign.study.design import Design

MM = 1e-3


@pytest.fixture(scope="module")
def rest(blocks: Design) -> dict[str, cq.Solid]:
    """Return the parts at rest; tests replace parts in copies of it."""
    return build(blocks)


def at(radius: float, degrees: float, level: float) -> cq.Vector:
    return cq.Vector(radius * np.cos(np.radians(degrees)), radius * np.sin(np.radians(degrees)), level)


def holders(parts: dict[str, cq.Solid], point: cq.Vector) -> list[str]:
    return [name for name, solid in parts.items() if solid.isInside(point, 1e-6)]


def failed(parts: dict[str, cq.Solid], among: str) -> set[str]:
    """Return the interferences that are found among the parts whose names begin with one of some words."""
    looked_at = {name: solid for name, solid in parts.items() if name.startswith(tuple(among.split()))}
    return {check.name for check in interference_checks(looked_at, "here") if not check.ok}


@pytest.mark.parametrize(
    ("degrees", "level", "expected"),
    [
        # At the mean radius of 18.5 mm a degree is 0.323 mm: vanes of 4 mm end at 6.19 degrees, blocks of 4 mm at
        # 18.58, pads of 1 mm at 21.68; the housing's vane has its middle at 30.
        (0.0, 6.0, "rotor"), (6.0, 6.0, "rotor"), (6.4, 6.0, "pcl_block_1"), (-6.4, 6.0, "pcl_block_2"),
        (18.4, 6.0, "pcl_block_1"), (18.8, 6.0, "heater_2"), (41.2, 6.0, "heater_1"),
        (21.5, 6.0, "heater_2"), (30.0, 11.9, "housing"), (60.0, 6.0, "rotor"),
        # Levels: 0.4 mm of air, 11.964 mm of block and pad, 0.4 mm of air, 4 mm of plate; floor below zero.
        (0.0, 0.3, None), (0.0, 0.5, "rotor"), (12.0, 0.3, None), (12.0, 0.5, "pcl_block_1"),
        (12.0, 12.3, "pcl_block_1"), (12.0, 12.5, None), (30.0, 12.5, None), (30.0, 12.9, "rotor"),
        (20.0, 0.2, "housing"), (20.0, 0.5, "heater_2"),
        # The slot reaches through the floor, and up to 2 mm below the vane's top at 12.364 mm.
        (30.0, 6.0, None), (30.0, -2.0, None), (30.0, 10.3, None), (30.0, 10.5, "housing"), (12.0, -2.0, "housing"),
    ],
)  # fmt: skip
def test_vanes_blocks_and_pads_stand_where_the_drawing_in_words_says(
    rest: dict[str, cq.Solid], degrees: float, level: float, expected: str | None
) -> None:
    assert holders(rest, at(18.5, degrees, level)) == ([expected] if expected else [])


def test_blocks_are_squeezed_into_the_room_of_the_quantity(rest: dict[str, cq.Solid], blocks: Design) -> None:
    housing = rest["housing"]
    # Half of 11 mm of width: from 15.75 to 21.25 mm.
    inside = [housing.isInside(at(radius, 30.0, 5.0)) for radius in (13.1, 15.6, 15.9, 21.1, 21.4, 23.9)]
    assert inside == [True, True, False, False, True, True]
    assert sum(name.startswith("pcl_block") for name in rest) == 12
    assert sum(kind_of(name) == "heater" for name in rest) == 12
    # Springs of 12.02 mm and wire of 2.413 mm at 57 mm reach in to 48.09 mm, and 1 mm is to stay.
    outer = 57.0 - 8.914 - 1.0 - 1e3 * blocks.values["squeezed_block_gap"]
    bulged = sector(13.0, outer, 4.0 / 18.5 - 0.124, 0.4, 12.364)  # up to the stops, 0.02 rad beyond the stroke
    assert bulged.Volume() == pytest.approx(rest["pcl_block_1"].Volume(), rel=1e-4)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_vane_squeezes_the_block_ahead_and_leaves_the_one_behind(
    blocks: Design, rest: dict[str, cq.Solid], side: float
) -> None:
    angle = side * 0.104
    parts = build(blocks, angle)
    ahead, behind = ("pcl_block_1", "pcl_block_2") if side > 0.0 else ("pcl_block_2", "pcl_block_1")
    whole = rest["pcl_block_1"].Volume()
    # 4 mm at 18.5 mm are 0.21622 rad; the vane takes 0.104 of them.
    assert parts[ahead].Volume() == pytest.approx(whole * (1.0 - 0.104 / (4.0 / 18.5)), rel=1e-9)
    assert parts[behind].Volume() == pytest.approx(whole, rel=1e-9)
    assert parts["rotor"].distance(parts[ahead]) == pytest.approx(0.0, abs=1e-6)
    # The vane took its face from 6.19 degrees to 0.23; from there to the block behind is air.
    behind_at = -side * np.array([-0.5, 0.5, 5.9, 6.5, 18.0])
    held = [holders(parts, at(18.5, degrees, 6.0)) for degrees in behind_at]
    assert held == [["rotor"], [], [], [behind], [behind]]
    assert parts["heater_2"].distance(parts["pcl_block_1"]) == pytest.approx(0.0, abs=1e-6)


def test_blocks_that_do_not_fit_are_found_and_named(rest: dict[str, cq.Solid], blocks: Design) -> None:
    moved = rest | {"rotor": turned(rest["rotor"], 0.01)}
    assert {f"rotor | pcl_block_{index} here" for index in range(1, 12, 2)} <= failed(moved, "rotor pcl_block")
    moved = build(blocks, 0.05)
    stiff = moved | {name: solid for name, solid in rest.items() if name.startswith("pcl_block")}
    assert {f"rotor | pcl_block_{index} here" for index in range(1, 12, 2)} == failed(stiff, "rotor pcl_block")
    dims = dimensions(blocks)
    wide = sector(dims.pcl_inner_radius, dims.placement_radius, 0.1, dims.running_clearance, dims.vane_height)
    assert any(
        name.startswith("pcl_block_1 | spring") for name in failed(rest | {"pcl_block_1": wide}, "pcl_block_1 spring")
    )
    with pytest.raises(GeometryError, match=r"pcl_block: of 0\.2162 rad, the rotor's vane takes 0\.3 rad"):
        build(blocks, 0.3)


@pytest.mark.slow
def test_a_housing_vane_in_a_pad_is_found(rest: dict[str, cq.Solid]) -> None:
    moved = rest | {"housing": turned(rest["housing"], 0.01)}
    assert {f"housing | heater_{index} here" for index in range(1, 12, 2)} <= failed(moved, "housing heater")


@pytest.mark.parametrize(
    ("row", "value", "words"),
    [
        ("vane_count", 2.5, "whole number"),
        ("housing_vane_angle", -0.1, "housing: span"),
        ("rotor_vane_angle", 0.0, "rotor: span"),
        ("block_angle", float("nan"), "pcl_block: block_angle is nan"),
    ],
)
def test_what_cannot_be_drawn_names_the_part(blocks: Design, row: str, value: float, words: str) -> None:
    design = blocks.model_copy(update={"values": blocks.values | {row: value}})
    with pytest.raises(GeometryError, match=words):
        build(design)


def test_corners_of_slots_and_pockets_have_room_for_cutters_and_pads(rest: dict[str, cq.Solid]) -> None:
    width = POCKET_WIDTH * 1.5
    pocket = rounded(block((0.0, 10.0), width, 0.0, 4.0), 1.5)
    assert pocket.isValid()
    assert pocket.Volume() == pytest.approx(4.0 * (10.0 * width - (4.0 - pi) * 1.5**2))
    with pytest.raises(GeometryError, match="choose a smaller corner_radius"):
        rounded(block((0.0, 10.0), 3.0, 0.0, 4.0), 1.5)
    # It ended where the corner of the slot above stands, half a micrometre beside it: no mesh was found of that.
    assert min(edge.Length() for edge in rest["housing"].Edges()) > 0.04
    design = design_of("deep corners", {"corner_radius": 1.0 * MM, "slot_corner_offset": -0.5 * MM}, "compression")
    drawn = drawn_parts(dimensions(design))
    volume = next(check for check in size_checks(design, drawn) if check.name == "housing_volume")
    assert abs(volume.value) < 1e-7
    # Without what stays of the corners of six slots the table would be wrong by more than that.
    assert design.values["pad_seat"] > 0.5 * MM


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_a_random_module_that_keeps_the_rules_passes_every_check(seed: int) -> None:
    design = random_blocks(seed)
    dims = dimensions(design)
    drawn = drawn_parts(dims)
    checks = all_checks(design, drawn)
    assert [check.text for check in checks if not check.ok] == []
    # The housing's inertia, which only a motor feels, takes holes and corners at one radius.
    exact = [check for check in checks if check.name.endswith(("_volume", "_inertia", "_mass"))]
    assert max(abs(check.value) for check in exact if check.name != "housing_inertia") < 1e-5
    for name, solid in drawn.items():
        assert closed(name, solid_mesh(solid)).is_watertight
