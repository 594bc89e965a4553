"""The thermistor by an arc or a vane: touching what it measures, clear of all else, over a hole for its wires."""

from collections.abc import Mapping

import cadquery as cq
import pytest
from cad_designs import BLOCKS, TILES, VANE_TILES, broken_rules, design_of

from tvimdesign.cad.assembly.assembly import MODULES, drawn_part
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.cad.parts import shear_parts
from tvimdesign.study.design import Design

BEAD = {"thermistor_diameter": 1.1e-3}


def standing(design: Design) -> dict[str, cq.Solid]:
    dims = dimensions(design)
    kinds = ["housing", "heater", "pcl_arc", "thermistor", *(["spreader"] if dims.spreader_depth else [])]
    drawn = {kind: drawn_part(dims, kind) for kind in kinds}
    placed = {name: shape.Solids()[0] for name, shape in shear_parts.stand(dims, drawn, 0.0).items()}
    return {"housing": drawn["housing"], **placed}


@pytest.mark.parametrize(("changes", "touched", "count"), [(BEAD, "heater_1", 1), (TILES | BEAD, "spreader_1", 3)])
def test_it_touches_what_it_measures_and_cuts_nothing(changes: dict[str, float], touched: str, count: int) -> None:
    design = design_of("seat", changes)
    placed = standing(design)
    assert broken_rules(design) == []
    assert sum(name.startswith("thermistor") for name in placed) == count
    assert placed["thermistor_1"].distance(placed[touched]) == pytest.approx(0.0, abs=1e-6)
    assert placed["thermistor_1"].distance(placed["housing"]) > 0.1
    assert [check.text for check in interference_checks(placed, "here") if not check.ok] == []
    named = {"housing_volume", "housing_inertia", "thermistor_volume"}
    sizes = [check for check in size_checks(design, placed) if check.name in named]
    assert len(sizes) == 3
    assert all(check.ok for check in sizes), [check.text for check in sizes]


@pytest.mark.parametrize("changes", [BEAD, TILES | BEAD])
def test_its_wires_go_straight_down_through_the_floor(changes: dict[str, float]) -> None:
    design = design_of("wires", changes)
    placed, dims = standing(design), dimensions(design)
    box = placed["thermistor_1"].BoundingBox()
    assert box.zmax == pytest.approx(-dims.spreader_depth)
    below = cq.Solid.makeCylinder(
        0.4 * dims.thermistor_diameter, 20.0, cq.Vector(*placed["thermistor_1"].Center().toTuple()[:2], box.zmin - 20.0)
    )
    assert below.intersect(placed["housing"]).Volume() == pytest.approx(0.0, abs=1e-6)


def test_a_seat_that_breaks_into_the_window_is_found_by_rule_and_by_volume() -> None:
    design = design_of("large", {"thermistor_diameter": 3e-3})
    assert broken_rules(design) == ["thermistor_window_gap"]
    checks = {check.name: check.ok for check in size_checks(design, standing(design))}
    assert not checks["housing_volume"]


BEAD_BY_BLOCK = {"thermistor_diameter": 0.8e-3, "thermistor_length": 2.5e-3}


def standing_in_vane(design: Design) -> dict[str, cq.Solid]:
    dims = dimensions(design)
    kinds = ["housing", "heater", "pcl_block", "thermistor", *(["spreader"] if dims.spreader_depth else [])]
    drawn = {kind: drawn_part(dims, kind) for kind in kinds}
    placed = {name: one.Solids()[0] for name, one in MODULES["compression"].stand_heaters(dims, drawn, 0.0).items()}
    return {"housing": drawn["housing"], **placed}


@pytest.mark.parametrize(("changes", "touched"), [(BLOCKS, "heater_1"), (VANE_TILES, "spreader_1")])
def test_it_touches_what_heats_the_block_and_cuts_nothing(changes: Mapping[str, float | str], touched: str) -> None:
    design = design_of("bead", {**changes, **BEAD_BY_BLOCK}, "compression")
    placed, dims = standing_in_vane(design), dimensions(design)
    assert broken_rules(design) == []
    bead = placed["thermistor_1"]
    assert bead.distance(placed[touched]) == pytest.approx(0.0, abs=1e-6)
    assert min(bead.distance(one) for name, one in placed.items() if name.startswith("pcl_block")) < 0.5
    assert [check.text for check in interference_checks(placed, "here") if not check.ok] == []
    named = {"housing_volume", "housing_inertia", "thermistor_volume"}
    sizes = [check for check in size_checks(design, placed) if check.name in named]
    assert len(sizes) == 3
    assert all(check.ok for check in sizes), [check.text for check in sizes]
    below = cq.Solid.makeCylinder(0.5 * dims.thermistor_diameter, 20.0, bead.Center() - cq.Vector(0, 0, 21.3))
    assert below.intersect(placed["housing"]).Volume() == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(
    ("rule", "changes"),
    [
        ("thermistor_rim_gap", {"rotor_rim": 0.5e-3}),
        ("thermistor_height_gap", {"thermistor_length": 14e-3}),
        ("thermistor_end_gap", {"peltier_thickness": 0.3e-3}),
        ("thermistor_hole_gap", {"placement_radius": 31e-3, "vane_count": 3}),
    ],
)
def test_a_bead_without_room_breaks_a_rule(rule: str, changes: dict[str, float]) -> None:
    assert rule in broken_rules(design_of("tight", {**BLOCKS, **BEAD_BY_BLOCK, **changes}, "compression"))
    bare = {name: value for name, value in changes.items() if "thermistor" not in name}
    assert rule not in broken_rules(design_of("none", {**BLOCKS, **bare}, "compression"))
