"""Vanes, blocks, pads and Peltier modules as solids: where they stand, how large they are, and that checks bite."""

from collections.abc import Mapping
from functools import cache
from math import pi
from typing import Any, NamedTuple

import cadquery as cq
import numpy as np
import pytest
from cad_designs import TILES, VANE_TILE_ROWS, VANE_TILES, all_checks, broken_rules, design_of, random_blocks
from placed_solids import assert_sound, build, placed_solids
from support import cases_of

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import drawn_parts
from tvimdesign.cad.assembly.bill_of_materials import beside, bill
from tvimdesign.cad.assembly.draft_module import DraftKernel
from tvimdesign.cad.export.mesh import solid_mesh
from tvimdesign.cad.export.print_files import closed
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.geometry.solids import block, drawn_by, rounded, sector, turned
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.cad.parts.heater_parts import heater_lead
from tvimdesign.device.core.clearances import POCKET_WIDTH
from tvimdesign.study.design import Design

MM = 1e-3


@pytest.fixture(scope="module")
def at_rest(blocks: Design) -> dict[str, cq.Solid]:
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


@cases_of("cad_compression", "places")
def test_vanes_blocks_and_pads_stand_where_the_drawing_in_words_says(at_rest, degrees, level, expected):
    assert holders(at_rest, at(18.5, degrees, level)) == ([expected] if expected else [])


def test_blocks_are_squeezed_into_the_room_of_the_quantity(at_rest, blocks):
    housing = at_rest["housing"]
    # Half of 11 mm of width: from 15.75 to 21.25 mm.
    inside = [housing.isInside(at(radius, 30.0, 5.0)) for radius in (13.1, 15.6, 15.9, 21.1, 21.4, 23.9)]
    assert inside == [True, True, False, False, True, True]
    assert sum(name.startswith("pcl_block") for name in at_rest) == 12
    assert sum(kind_of(name) == "heater" for name in at_rest) == 12
    # Springs of 12.02 mm and wire of 2.413 mm at 57 mm reach in to 48.09 mm, and 1 mm is to stay.
    outer = 57.0 - 8.914 - 1.0 - 1e3 * blocks.values["squeezed_block_gap"]
    bulged = sector(13.0, outer, 4.0 / 18.5 - 0.124, 0.4, 12.364)  # up to the stops, 0.02 rad beyond the stroke
    assert bulged.Volume() == pytest.approx(at_rest["pcl_block_1"].Volume(), rel=1e-4)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_vane_squeezes_the_block_ahead_and_leaves_the_one_behind(blocks, at_rest, side):
    angle = side * 0.104
    parts = build(blocks, angle)
    ahead, behind = ("pcl_block_1", "pcl_block_2") if side > 0.0 else ("pcl_block_2", "pcl_block_1")
    whole = at_rest["pcl_block_1"].Volume()
    # 4 mm at 18.5 mm are 0.21622 rad; the vane takes 0.104 of them.
    assert parts[ahead].Volume() == pytest.approx(whole * (1.0 - 0.104 / (4.0 / 18.5)), rel=1e-9)
    assert parts[behind].Volume() == pytest.approx(whole, rel=1e-9)
    assert parts["rotor"].distance(parts[ahead]) == pytest.approx(0.0, abs=1e-6)
    # The vane took its face from 6.19 degrees to 0.23; from there to the block behind is air.
    behind_at = -side * np.array([-0.5, 0.5, 5.9, 6.5, 18.0])
    held = [holders(parts, at(18.5, degrees, 6.0)) for degrees in behind_at]
    assert held == [["rotor"], [], [], [behind], [behind]]
    assert parts["heater_2"].distance(parts["pcl_block_1"]) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.gate
def test_blocks_that_do_not_fit_are_found_and_named(at_rest, blocks):
    moved = at_rest | {"rotor": turned(at_rest["rotor"], 0.01)}
    assert {f"rotor | pcl_block_{index} here" for index in range(1, 12, 2)} <= failed(moved, "rotor pcl_block")
    moved = build(blocks, 0.05)
    stiff = moved | {name: solid for name, solid in at_rest.items() if name.startswith("pcl_block")}
    assert {f"rotor | pcl_block_{index} here" for index in range(1, 12, 2)} == failed(stiff, "rotor pcl_block")
    dims = dimensions(blocks)
    wide = sector(dims.pcl_inner_radius, dims.placement_radius, 0.1, dims.running_clearance, dims.vane_height)
    assert any(
        name.startswith("pcl_block_1 | spring")
        for name in failed(at_rest | {"pcl_block_1": wide}, "pcl_block_1 spring")
    )
    with pytest.raises(GeometryError, match=r"pcl_block: of 0\.2162 rad, the rotor's vane takes 0\.3 rad"):
        build(blocks, 0.3)


@pytest.mark.slow
def test_a_housing_vane_in_a_pad_is_found(at_rest):
    moved = at_rest | {"housing": turned(at_rest["housing"], 0.01)}
    assert {f"housing | heater_{index} here" for index in range(1, 12, 2)} <= failed(moved, "housing heater")


def test_corners_of_slots_and_pockets_have_room_for_cutters_and_pads(at_rest):
    width = POCKET_WIDTH * 1.5
    pocket = rounded(block((0.0, 10.0), width, 0.0, 4.0), 1.5)
    assert pocket.isValid()
    assert pocket.Volume() == pytest.approx(4.0 * (10.0 * width - (4.0 - pi) * 1.5**2))
    with pytest.raises(GeometryError, match="choose a smaller corner_radius"):
        rounded(block((0.0, 10.0), 3.0, 0.0, 4.0), 1.5)
    # It ended where the corner of the slot above stands, half a micrometre beside it: no mesh was found of that.
    assert min(edge.Length() for edge in at_rest["housing"].Edges()) > 0.04
    design = design_of("deep corners", {"corner_radius": 1.0 * MM, "slot_corner_offset": -0.5 * MM}, "compression")
    drawn = drawn_parts(dimensions(design))
    volume = next(check for check in size_checks(design, drawn) if check.name == "housing_volume")
    assert abs(volume.value) < 1e-7
    # Without what stays of the corners of six slots the table would be wrong by more than that.
    assert design.values["pad_seat"] > 0.5 * MM


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_a_random_module_that_keeps_the_rules_passes_every_check(seed):
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


IN_VANES = {"housing": 1, "heater": 8, "heater_lead": 16, "spreader": 8, "pcl_block": 8}
TILED: dict[str, tuple[str, Mapping[str, float | str], dict[str, int]]] = {
    "over windows": ("shear", TILES, {"housing": 1, "heater": 6, "heater_lead": 12, "spreader": 3, "pcl_arc": 3}),
    "in vanes": ("compression", VANE_TILES, IN_VANES),
    "two in a vane": ("compression", VANE_TILE_ROWS, {**IN_VANES, "heater": 16, "heater_lead": 32}),
}
"""Mode, changes and how many solids of each kind there are."""
TWO = pytest.param("two in a vane", marks=pytest.mark.slow)
in_vanes = pytest.mark.parametrize("name", ["in vanes", TWO])


class Tiled(NamedTuple):
    """A module with its solids in place."""

    design: Design
    dims: Dimensions
    placed: dict[str, cq.Solid]


@cache
def tiled(name: str) -> Tiled:
    mode, changes, counts = TILED[name]
    design = design_of("tiles", changes, mode)
    dims = dimensions(design)
    return Tiled(design, dims, placed_solids(dims, counts))


@pytest.mark.gate
@pytest.mark.parametrize("name", ["over windows", "in vanes", TWO])
def test_they_keep_the_rules_are_as_large_as_their_rows_and_cut_nothing(name):
    design, _, placed = tiled(name)
    counts = TILED[name][2]
    assert {kind: sum(kind_of(part) == kind for part in placed) for kind in counts} == counts
    assert_sound(design, placed, [f"{kind}_volume" for kind in counts])


def test_tiles_stand_over_windows_with_their_plates_on_ledges():
    _, dims, placed = tiled("over windows")
    for name in (name for name in placed if kind_of(name) == "heater"):
        tile, box = placed[name], placed[name].BoundingBox()
        assert (box.zmin, box.zmax) == pytest.approx((-dims.pad_depth, -dims.spreader_depth))
        assert min(tile.distance(placed[f"spreader_{i}"]) for i in (1, 2, 3)) == pytest.approx(0.0, abs=1e-9)
        assert tile.distance(placed["housing"]) == pytest.approx(0.0, abs=1e-9)
        middle = tile.Center()
        below = cq.Vector(middle.x, middle.y, -dims.floor_thickness + 0.01)
        assert not placed["housing"].isInside(below), f"{name} has no window"
    across = 0.25 * pi * dims.lead_hole_diameter**2
    level = -0.5 * (dims.floor_thickness + dims.pad_depth)
    plane = cq.Face.makePlane(200.0, 200.0, cq.Vector(0, 0, level), cq.Vector(0, 0, 1))
    section = plane.intersect(placed["housing"])
    inner = [wire for face in section.Faces() for wire in face.innerWires()]
    holes = [wire for wire in inner if abs(cq.Face.makeFromWires(wire).Area() - across) < 1e-3 * across]
    radii = [cq.Face.makeFromWires(wire).Center().toTuple()[:2] for wire in holes]
    at = [hole for hole in radii if abs((hole[0] ** 2 + hole[1] ** 2) ** 0.5 - dims.tile_radius) < 1e-6]
    assert len(at) == 3
    tile = placed["heater_1"]
    faces = sorted(tile.Faces(), key=lambda face: face.Center().z)
    assert faces[-1].Area() == pytest.approx(200.0)
    assert faces[0].Area() == pytest.approx(180.0)
    seat = tile.moved(cq.Location(cq.Vector(0, 0, -0.1))).intersect(placed["housing"]).Volume() / 0.1
    assert seat == pytest.approx(180.0 - (18.0 - 4.0) * 6.0 + (4.0 - pi) * dims.corner_radius**2, rel=1e-6)


@pytest.mark.gate
def test_bent_leads_go_down_through_their_slots_in_drafts_too():
    _, dims, placed = tiled("over windows")
    leads = [solid for name, solid in placed.items() if kind_of(name) == "heater_lead"]
    assert len(leads) == 12
    # A bend of 2.4 mm wire, 4.8 mm inside: a torus by Pappus.
    box, way = leads[0].BoundingBox(), 2.0 * 6.0 * dims.lead_bend_angle
    assert leads[0].Volume() == pytest.approx(0.25 * pi * 2.4**2 * way, rel=1e-6)
    assert box.zmin == pytest.approx(-dims.floor_thickness - dims.foot_height, abs=1e-6)
    for lead in leads:
        assert lead.distance(placed["housing"]) > 0.1
        tiles = [placed[f"heater_{index}"] for index in range(1, 7)]
        assert min(lead.distance(tile) for tile in tiles) == pytest.approx(0.0, abs=1e-6)  # it begins there
    with drawn_by(DraftKernel()):
        draft: Any = heater_lead(dims)
    assert draft.body.volume() == pytest.approx(placed["heater_lead_1"].Volume(), rel=0.12)


@in_vanes
def test_tiles_touch_spreaders_and_seats_over_their_ways_out(name):
    design, dims, placed = tiled(name)
    tiles = [(part, solid) for part, solid in placed.items() if kind_of(part) == "heater"]

    def touching(solid: cq.Solid, kind: str) -> int:
        others = [other for part, other in placed.items() if kind_of(part) == kind]
        return sum(solid.distance(other) < 1e-7 for other in others)

    # The vanes are alike: those of the first two faces.
    for part, tile in tiles[:2]:
        assert (touching(tile, "spreader"), touching(tile, "housing")) == (1, 1), part
    assert [touching(placed[f"spreader_{index}"], "pcl_block") for index in (1, 2)] == [1, 1]
    for part, tile in tiles[:4]:
        assert behind(tile, placed["housing"]) == pytest.approx(1e6 * design.values["tile_seat_area"], rel=2e-3), part
    for part, tile in tiles:
        middle = tile.Center()
        for level in (dims.running_clearance - 0.01, -0.5 * dims.floor_thickness, -dims.floor_thickness + 0.01):
            assert not placed["housing"].isInside(cq.Vector(middle.x, middle.y, level)), f"{part} at {level:.2f} mm"


def behind(tile: cq.Solid, housing: cq.Solid, depth: float = 0.01) -> float:
    """Return area [mm^2] of a tile's two large faces that the housing lies behind, to a sliver's depth."""
    faces = sorted(tile.Faces(), key=lambda face: face.Area())[-2:]
    volume = 0.0
    for face in faces:
        sliver = cq.Solid.extrudeLinear(face.outerWire(), [], face.normalAt() * depth)
        volume += sum(part.Volume() for part in sliver.intersect(housing).Solids()) / depth
    return volume


@pytest.mark.gate
@pytest.mark.parametrize(
    ("mode", "changes"),
    [("shear", TILES | {"arc_span": 1.4}), ("compression", VANE_TILE_ROWS | {"pcl_outer_radius": 38e-3})],
)
def test_tiles_that_overlap_are_found_by_rule_and_solid(mode, changes):
    crowded = design_of("crowded", changes, mode)
    assert "tile_side_margin" in broken_rules(crowded)
    polymer = "pcl_arc" if mode == "shear" else "pcl_block"
    placed = placed_solids(dimensions(crowded), ("housing", "heater", "spreader", polymer))
    assert any("heater_1 and heater_2" in c.text for c in interference_checks(placed, "here") if not c.ok)


def test_adhesive_and_a_thermistor_for_each_spreader_are_in_the_list():
    listed = {item.kind: item for item in beside(tiled("over windows").design, {})}
    assert listed["thermistor"].quantity == 3
    assert "120 °C" in listed["thermistor"].title
    assert "2.7 mm" in listed["thermistor"].title
    assert "heat_conducting_adhesive" in listed
    of_a_pad = {item.kind: item for item in beside(design_of("paper", {}), {})}
    assert (of_a_pad["thermistor"].quantity, "hole" in of_a_pad["thermistor"].title) == (1, False)


@cases_of("cad_compression", "supplies")
def test_the_supply_is_for_the_pads_as_they_are_wired(mode, wiring, message):
    design = design_of("wired", {"shear": TILES, "compression": VANE_TILES}[mode] | {"heater_wiring": wiring}, mode)
    design.values.update(peak_voltage=9.0, peak_current=2.0)
    assert message in next(item.title for item in beside(design, {}) if item.kind == "supply")


@in_vanes
def test_modules_spreaders_adhesive_and_wires_are_in_the_list(name):
    design, _, placed = tiled(name)
    counted = {item.kind: item.quantity for item in bill(design, {}, placed)}
    assert counted["heater"] == round(design.values["heater_count"])
    assert counted["spreader"] == 8
    design.values.update(peak_voltage=20.0, peak_current=1.5)
    listed = {item.kind: item for item in beside(design, {})}
    assert "heat_conducting_adhesive" in listed
    assert (listed["thermistor"].quantity, "hole" in listed["thermistor"].title) == (1, False)
    assert f"for the {counted['heater']} heaters" in listed["heater_wire"].title
