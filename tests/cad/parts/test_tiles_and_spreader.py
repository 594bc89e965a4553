"""Solids of rectangular Peltier modules and their spreaders: as large as the table says, apart, over ways out."""

from collections.abc import Mapping
from functools import cache
from math import pi
from typing import Any, NamedTuple

import cadquery as cq
import pytest
from cad_designs import TILES, VANE_TILE_ROWS, VANE_TILES, broken_rules, design_of
from placed_solids import assert_sound, placed_solids

from tvimdesign.cad.assembly.bill_of_materials import beside, bill
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.draft_kernel import DraftKernel
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.geometry.solids import drawn_by
from tvimdesign.cad.inspection.size_checks import interference_checks
from tvimdesign.cad.parts.heater_parts import heater_lead
from tvimdesign.study.design import Design

IN_VANES = {"housing": 1, "heater": 8, "spreader": 8, "pcl_block": 8}
TILED: dict[str, tuple[str, Mapping[str, float | str], dict[str, int]]] = {
    "over windows": ("shear", TILES, {"housing": 1, "heater": 6, "heater_lead": 12, "spreader": 3, "pcl_arc": 3}),
    "in vanes": ("compression", VANE_TILES, IN_VANES),
    "two in a vane": ("compression", VANE_TILE_ROWS, {**IN_VANES, "heater": 16}),
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


@pytest.mark.parametrize("name", ["over windows", "in vanes", TWO])
def test_they_keep_the_rules_are_as_large_as_their_rows_and_cut_nothing(name: str) -> None:
    design, _, placed = tiled(name)
    counts = TILED[name][2]
    assert {kind: sum(kind_of(part) == kind for part in placed) for kind in counts} == counts
    assert_sound(design, placed, [f"{kind}_volume" for kind in counts])


def test_tiles_stand_over_windows_with_their_plates_on_ledges() -> None:
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


def test_bent_leads_go_down_through_their_slots_in_drafts_too() -> None:
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
def test_tiles_touch_spreaders_and_seats_over_their_ways_out(name: str) -> None:
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
    found = 0.0
    for face in faces:
        sliver = cq.Solid.extrudeLinear(face.outerWire(), [], face.normalAt() * depth)
        found += sum(part.Volume() for part in sliver.intersect(housing).Solids()) / depth
    return found


@pytest.mark.parametrize(
    ("mode", "changes"),
    [("shear", TILES | {"arc_span": 1.4}), ("compression", VANE_TILE_ROWS | {"pcl_outer_radius": 38e-3})],
)
def test_tiles_that_overlap_are_found_by_rule_and_solid(mode: str, changes: Mapping[str, float | str]) -> None:
    crowded = design_of("crowded", changes, mode)
    assert "tile_side_margin" in broken_rules(crowded)
    polymer = "pcl_arc" if mode == "shear" else "pcl_block"
    placed = placed_solids(dimensions(crowded), ("housing", "heater", "spreader", polymer))
    assert any("heater_1 and heater_2" in c.text for c in interference_checks(placed, "here") if not c.ok)


def test_adhesive_and_a_thermistor_for_each_spreader_are_in_the_list() -> None:
    listed = {item.kind: item for item in beside(tiled("over windows").design, {})}
    assert listed["thermistor"].quantity == 3
    assert "120 °C" in listed["thermistor"].title
    assert "2.7 mm" in listed["thermistor"].title
    assert "heat_conducting_adhesive" in listed
    of_a_pad = {item.kind: item for item in beside(design_of("paper", {}), {})}
    assert (of_a_pad["thermistor"].quantity, "hole" in of_a_pad["thermistor"].title) == (1, False)


@pytest.mark.parametrize(
    ("mode", "wiring", "said"),
    [
        ("shear", "series", "in series"),
        ("shear", "arcs_parallel", "arcs in parallel"),
        ("compression", "vanes_parallel", "vanes in parallel"),
    ],
)
def test_the_supply_is_for_the_pads_as_they_are_wired(mode: str, wiring: str, said: str) -> None:
    design = design_of("wired", {"shear": TILES, "compression": VANE_TILES}[mode] | {"heater_wiring": wiring}, mode)
    design.values.update(peak_voltage=9.0, peak_current=2.0)
    assert said in next(item.title for item in beside(design, {}) if item.kind == "supply")


@in_vanes
def test_modules_spreaders_adhesive_and_wires_are_in_the_list(name: str) -> None:
    design, _, placed = tiled(name)
    counted = {item.kind: item.quantity for item in bill(design, {}, placed)}
    assert counted["heater"] == round(design.values["heater_count"])
    assert counted["spreader"] == 8
    design.values.update(peak_voltage=20.0, peak_current=1.5)
    listed = {item.kind: item for item in beside(design, {})}
    assert "heat_conducting_adhesive" in listed
    assert (listed["thermistor"].quantity, "hole" in listed["thermistor"].title) == (1, False)
    assert f"for the {counted['heater']} heaters" in listed["heater_wire"].title
