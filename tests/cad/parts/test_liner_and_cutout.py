"""Liners, cut-outs and thermistors as solids: in their recesses, as large as the model says, in no one's way."""

from collections.abc import Mapping
from math import atan2

import cadquery as cq
import pytest
from cad_designs import BLOCKS, CASES, TILES, VANE_TILES, broken_rules, design_of
from placed_solids import assert_sound, placed_solids

from tvimdesign.cad.assembly.assembly import drawn_parts, place
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.inspection.size_checks import size_checks
from tvimdesign.study.design import Design

LINER = {"liner_material": "peek", "liner_thickness": 0.8e-3}
LINED = [
    pytest.param("shear", {**LINER, "key_count": 0.0}, id="arcs"),
    pytest.param("shear", {**LINER, "key_count": 0.0, "corner_radius": 1e-3}, id="arcs with a mill's corners"),
    pytest.param("shear", {**LINER, "key_count": 0.0, "melt_lip": "rings"}, id="arcs between lips"),
    pytest.param("compression", {**LINER, "vane_thickness": 9e-3}, id="vanes", marks=pytest.mark.slow),
]


def placed_of(design: Design, angle: float = 0.0) -> dict[str, cq.Solid]:
    dims = dimensions(design)
    return place(dims, drawn_parts(dims), angle)


def between(first: cq.Solid, second: cq.Solid) -> float:
    """Return the volume that two solids share [mm^3]."""
    return sum(solid.Volume() for solid in first.intersect(second).Solids())


def _wider(design: Design) -> float:
    """Return the area of a recess over that of its liner: a slip clearance more on every side."""
    inner, outer, span, slip = (
        design.values[name] for name in ("pcl_inner_radius", "pcl_outer_radius", "arc_span", "slip_clearance")
    )
    shorter = 1.0 - 2.0 * slip / inner / span
    return (outer**2 - inner**2) / ((outer - slip) ** 2 - (inner + slip) ** 2) / shorter


@pytest.mark.parametrize(("mode", "changes"), LINED)
def test_liners_lie_in_the_rotor_a_film_from_its_recess_and_turn_with_it(
    mode: str, changes: dict[str, float | str]
) -> None:
    design = design_of("lined", changes, mode)
    for angle in (0.0, 0.5 * design.values["stroke"]):
        placed = placed_of(design, angle)
        liners = [solid for name, solid in placed.items() if kind_of(name) == "liner"]
        polymer = "pcl_arc" if mode == "shear" else "pcl_block"
        assert len(liners) == sum(kind_of(name) == polymer for name in placed)
        volume = 1e9 * design.values["liner_volume"]
        assert sum(one.Volume() for one in liners) == pytest.approx(volume, rel=1e-6)
        polar = sum(_polar(one) for one in liners)
        assert polar * design.values["liner_density"] * 1e-15 == pytest.approx(design.values["liner_inertia"], rel=1e-5)
        assert placed["rotor"].Volume() == pytest.approx(1e9 * design.values["rotor_volume"], rel=1e-5)
        for one in liners:
            assert between(one, placed["rotor"]) == 0.0
            assert between(one, placed["housing"]) == 0.0
    bare = design_of("bare", {name: value for name, value in changes.items() if "liner" not in name}, mode)
    recess = 1e9 * (bare.values["rotor_volume"] - design.values["rotor_volume"])
    wider = _wider(design) if mode == "shear" else 1.0
    assert recess == pytest.approx(wider * volume * (0.8 + 0.1) / 0.8, rel=2e-3)


def _polar(solid: cq.Solid) -> float:
    """Return the moment of the volume about the module's axis [mm^5]."""
    middle = solid.Center()
    return cq.Shape.matrixOfInertia(solid)[2][2] + solid.Volume() * (middle.x**2 + middle.y**2)


@pytest.mark.parametrize(
    ("mode", "changes", "level", "diameter"),
    [
        pytest.param("shear", {}, "", 4.2, id="in the window, its wires below the floor"),
        pytest.param("shear", {"heater_fuse": "microtemp_g4a"}, "", 4.0, id="another maker's"),
        pytest.param(
            "shear", CASES["paper"][1] | {"arc_count": 8, "arc_span": 0.3}, "floor_thickness", 4.2, id="below"
        ),
        pytest.param("shear", TILES, "", 4.2, id="below a tile", marks=pytest.mark.slow),
        pytest.param("compression", {}, "floor_thickness", 4.2, id="below a slot", marks=pytest.mark.slow),
    ],
)
def test_the_cut_out_lies_across_the_first_heater_in_no_part_s_way(
    mode: str, changes: dict[str, float | str], level: str, diameter: float
) -> None:
    design = design_of("guarded", changes, mode)
    placed = placed_of(design)
    body = placed["thermal_cutout"]
    box = body.BoundingBox()
    under_floor = -1e3 * design.values["floor_thickness"] - 0.5 - 1e3 * design.values["running_clearance"]
    upper = -1e3 * design.values[level] if level else under_floor + 0.5 * diameter
    assert box.zmax == pytest.approx(upper, abs=1e-6)
    assert box.zmax - box.zmin == pytest.approx(diameter, abs=1e-6)
    assert body.Volume() == pytest.approx(1e9 * design.values["cutout_volume"], rel=1e-9)
    middle = body.Center()
    first = placed["heater_1"].Center()
    apart = abs(atan2(middle.y, middle.x) - atan2(first.y, first.x))
    assert apart < design.values.get("arc_span", 1.0)
    for name, other in placed.items():
        if name != "thermal_cutout":
            assert between(body, other) == pytest.approx(0.0, abs=1e-6), name


BEAD = {"thermistor_diameter": 1.1e-3}


def standing(design: Design) -> dict[str, cq.Solid]:
    dims = dimensions(design)
    kinds = ["housing", "heater", "thermistor", *(["spreader"] if dims.spreader_depth else [])]
    return placed_solids(dims, [*kinds, "pcl_arc" if dims.mode == "shear" else "pcl_block"])


@pytest.mark.parametrize(("changes", "touched", "count"), [(BEAD, "heater_1", 1), (TILES | BEAD, "spreader_1", 3)])
def test_it_touches_what_it_measures_and_cuts_nothing(changes: dict[str, float], touched: str, count: int) -> None:
    design = design_of("seat", changes)
    placed = standing(design)
    assert sum(name.startswith("thermistor") for name in placed) == count
    assert placed["thermistor_1"].distance(placed[touched]) == pytest.approx(0.0, abs=1e-6)
    assert placed["thermistor_1"].distance(placed["housing"]) > 0.1
    assert_sound(design, placed, ("housing_volume", "housing_inertia", "thermistor_volume"))


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


@pytest.mark.parametrize(("changes", "touched"), [(BLOCKS, "heater_1"), (VANE_TILES, "spreader_1")])
def test_it_touches_what_heats_the_block_and_cuts_nothing(changes: Mapping[str, float | str], touched: str) -> None:
    design = design_of("bead", {**changes, **BEAD_BY_BLOCK}, "compression")
    placed, dims = standing(design), dimensions(design)
    bead = placed["thermistor_1"]
    assert bead.distance(placed[touched]) == pytest.approx(0.0, abs=1e-6)
    assert min(bead.distance(one) for name, one in placed.items() if name.startswith("pcl_block")) < 0.5
    assert_sound(design, placed, ("housing_volume", "housing_inertia", "thermistor_volume"))
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
