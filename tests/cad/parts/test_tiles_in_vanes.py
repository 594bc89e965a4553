"""Solids of rectangular Peltier modules in vanes: as large as their rows, apart, each over a slot for its leads."""

from collections.abc import Iterator

import cadquery as cq
import pytest
from cad_designs import VANE_TILE_ROWS, VANE_TILES, broken_rules, design_of
from placed_solids import placed_solids

from tvimdesign.cad.assembly.assembly import drawn_part
from tvimdesign.cad.assembly.bill_of_materials import beside, bill
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.cad.parts import compression_parts
from tvimdesign.study.design import Design

KINDS = ("housing", "heater", "spreader", "pcl_block")


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(VANE_TILES, id="one a block"),
        pytest.param(VANE_TILE_ROWS, id="two a block", marks=pytest.mark.slow),
    ],
)
def design(request: pytest.FixtureRequest) -> Design:
    return design_of("tiles", request.param, "compression")


@pytest.fixture(scope="module")
def dims(design: Design) -> Dimensions:
    return dimensions(design)


@pytest.fixture(scope="module")
def placed(dims: Dimensions) -> dict[str, cq.Solid]:
    return placed_solids(dims, KINDS)


def tiles(placed: dict[str, cq.Solid]) -> Iterator[tuple[str, cq.Solid]]:
    return ((name, solid) for name, solid in placed.items() if kind_of(name) == "heater")


def test_they_keep_the_rules_are_as_large_as_their_rows_and_cut_nothing(
    design: Design, dims: Dimensions, placed: dict[str, cq.Solid]
) -> None:
    assert broken_rules(design) == []
    counts = {kind: sum(kind_of(name) == kind for name in placed) for kind in KINDS}
    row = round(dims.tiles_per_block)
    assert counts == {"housing": 1, "heater": 8 * row, "spreader": 8, "pcl_block": 8}
    named = [f"{kind}_volume" for kind in ("housing", "heater", "spreader", "pcl_block")]
    sizes = {check.name: check for check in size_checks(design, placed) if check.name in named}
    assert sorted(sizes) == sorted(named)
    assert all(check.ok for check in sizes.values()), [check.text for check in sizes.values()]
    assert [check.text for check in interference_checks(placed, "here") if not check.ok] == []


def test_tiles_touch_spreaders_and_seats_over_their_ways_out(
    placed: dict[str, cq.Solid], design: Design, dims: Dimensions
) -> None:
    def touching(solid: cq.Solid, kind: str) -> int:
        others = [other for name, other in placed.items() if kind_of(name) == kind]
        return sum(solid.distance(other) < 1e-7 for other in others)

    # The vanes are alike: those of the first two faces.
    for name, tile in list(tiles(placed))[:2]:
        assert (touching(tile, "spreader"), touching(tile, "housing")) == (1, 1), name
    assert [touching(placed[f"spreader_{index}"], "pcl_block") for index in (1, 2)] == [1, 1]
    for name, tile in list(tiles(placed))[:4]:
        assert behind(tile, placed["housing"]) == pytest.approx(1e6 * design.values["tile_seat_area"], rel=2e-3), name
    for name, tile in tiles(placed):
        middle = tile.Center()
        for level in (dims.running_clearance - 0.01, -0.5 * dims.floor_thickness, -dims.floor_thickness + 0.01):
            assert not placed["housing"].isInside(cq.Vector(middle.x, middle.y, level)), f"{name} at {level:.2f} mm"


def behind(tile: cq.Solid, housing: cq.Solid, depth: float = 0.01) -> float:
    """Return area [mm^2] of a tile's two large faces that the housing lies behind, to a sliver's depth."""
    faces = sorted(tile.Faces(), key=lambda face: face.Area())[-2:]
    found = 0.0
    for face in faces:
        sliver = cq.Solid.extrudeLinear(face.outerWire(), [], face.normalAt() * depth)
        found += sum(part.Volume() for part in sliver.intersect(housing).Solids()) / depth
    return found


def test_the_supply_is_for_vanes_as_they_are_wired() -> None:
    wired = design_of("wired", VANE_TILES | {"heater_wiring": "vanes_parallel"}, "compression")
    wired.values.update(peak_voltage=9.0, peak_current=2.0)
    assert "vanes in parallel" in next(item.title for item in beside(wired, {}) if item.kind == "supply")


def test_modules_spreaders_adhesive_and_wires_are_in_the_list(design: Design, placed: dict[str, cq.Solid]) -> None:
    counted = {item.kind: item.quantity for item in bill(design, {}, placed)}
    assert counted["heater"] == round(design.values["heater_count"])
    assert counted["spreader"] == 8
    design.values.update(peak_voltage=20.0, peak_current=1.5)
    listed = {item.kind: item for item in beside(design, {})}
    assert "heat_conducting_adhesive" in listed
    assert (listed["thermistor"].quantity, "hole" in listed["thermistor"].title) == (1, False)
    assert f"for the {counted['heater']} heaters" in listed["heater_wire"].title


def test_tiles_that_overlap_are_found_by_rule_and_solid() -> None:
    crowded = design_of("crowded", VANE_TILE_ROWS | {"pcl_outer_radius": 38e-3}, "compression")
    assert "tile_side_margin" in broken_rules(crowded)
    dims = dimensions(crowded)
    drawn = {kind: drawn_part(dims, kind) for kind in ("heater", "pcl_block", "spreader")}
    placed = {name: shape.Solids()[0] for name, shape in compression_parts.stand(dims, drawn, 0.0).items()}
    assert any("heater_1 and heater_2" in c.text for c in interference_checks(placed, "here") if not c.ok)
