"""Solids of rectangular Peltier modules and their spreader: as large as their rows, apart, each over a window."""

from math import pi
from typing import Any

import cadquery as cq
import pytest
from cad_designs import TILES, broken_rules, design_of
from placed_solids import placed_solids

from tvimdesign.cad.assembly.assembly import drawn_part
from tvimdesign.cad.assembly.bill_of_materials import beside
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.draft_kernel import DraftKernel
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.geometry.solids import drawn_by
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.cad.parts import shear_parts
from tvimdesign.cad.parts.heater_parts import heater_lead
from tvimdesign.study.design import Design

KINDS = ("housing", "heater", "heater_lead", "spreader", "pcl_arc")


@pytest.fixture(scope="module")
def design() -> Design:
    return design_of("tiles", TILES)


@pytest.fixture(scope="module")
def dims(design: Design) -> Dimensions:
    return dimensions(design)


@pytest.fixture(scope="module")
def placed(dims: Dimensions) -> dict[str, cq.Solid]:
    return placed_solids(dims, KINDS)


def test_they_keep_the_rules_are_as_large_as_their_rows_and_cut_nothing(
    design: Design, placed: dict[str, cq.Solid]
) -> None:
    assert broken_rules(design) == []
    counts = {kind: sum(kind_of(name) == kind for name in placed) for kind in KINDS}
    assert counts == {"housing": 1, "heater": 6, "heater_lead": 12, "spreader": 3, "pcl_arc": 3}
    named = [f"{kind}_volume" for kind in KINDS]
    sizes = {check.name: check for check in size_checks(design, placed) if check.name in named}
    assert sorted(sizes) == sorted(named)
    assert all(check.ok for check in sizes.values()), [check.text for check in sizes.values()]
    assert [check.text for check in interference_checks(placed, "here") if not check.ok] == []


def test_tiles_stand_over_windows_with_their_plates_on_ledges(dims: Dimensions, placed: dict[str, cq.Solid]) -> None:
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


def test_bent_leads_go_down_through_their_slots_in_drafts_too(dims: Dimensions, placed: dict[str, cq.Solid]) -> None:
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


def test_tiles_that_overlap_are_found_by_rule_and_solid() -> None:
    crowded = design_of("crowded", TILES | {"arc_span": 1.4})
    assert "tile_side_margin" in broken_rules(crowded)
    dims = dimensions(crowded)
    drawn = {kind: drawn_part(dims, kind) for kind in ("heater", "pcl_arc", "spreader")}
    placed = {name: shape.Solids()[0] for name, shape in shear_parts.stand(dims, drawn, 0.0).items()}
    assert any("heater_1 and heater_2" in c.text for c in interference_checks(placed, "here") if not c.ok)


def test_adhesive_and_a_thermistor_for_each_spreader_are_in_the_list(design: Design) -> None:
    listed = {item.kind: item for item in beside(design, {})}
    assert listed["thermistor"].quantity == 3
    assert "120 °C" in listed["thermistor"].title
    assert "2.7 mm" in listed["thermistor"].title
    assert "heat_conducting_adhesive" in listed
    of_a_pad = {item.kind: item for item in beside(design_of("paper", {}), {})}
    assert (of_a_pad["thermistor"].quantity, "hole" in of_a_pad["thermistor"].title) == (1, False)


@pytest.mark.parametrize(("wiring", "said"), [("series", "in series"), ("arcs_parallel", "arcs in parallel")])
def test_the_supply_is_for_the_pads_as_they_are_wired(wiring: str, said: str) -> None:
    design = design_of("wired", TILES | {"heater_wiring": wiring})
    design.values.update(peak_voltage=9.0, peak_current=2.0)
    assert said in next(item.title for item in beside(design, {}) if item.kind == "supply")
