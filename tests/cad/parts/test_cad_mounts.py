"""Solids below the feet and around pads: motor, springs, liners, cut-outs, thermistors; the rotor at its stops."""

from math import atan2, hypot, pi, sin, sqrt
from typing import Any

import cadquery as cq
import numpy as np
import pytest
import trimesh
from cad_designs import BLOCKS, CASES, DRIVEN, TILES, VANE_TILES, broken_rules, design_of
from hypothesis import given, settings
from hypothesis import strategies as st
from placed_solids import assert_sound, build, placed_solids
from support import cases_of

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import drawn_part, drawn_parts, place
from tvimdesign.cad.export.mesh import spring_mesh
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.features import tight_box
from tvimdesign.cad.geometry.kinds import KINDS, TURNING, kind_of
from tvimdesign.cad.geometry.solids import turned
from tvimdesign.cad.geometry.spring_solids import Coil, free_coil, installed_coil, spring_solid
from tvimdesign.cad.inspection.inspect import module_checks, part_checks, setting_checks
from tvimdesign.cad.inspection.milling import corner_checks
from tvimdesign.cad.inspection.size_checks import (
    _polar_moment,
    bearing_checks,
    interference_checks,
    size_checks,
    stop_checks,
)
from tvimdesign.cad.parts import jigs
from tvimdesign.study.design import Design


@pytest.mark.parametrize("process", ["print_petg", "machine_6061"])
def test_the_spokes_of_the_motor_s_hub_have_no_sharp_corner(process):
    design = design_of("driven", DRIVEN | {"process": process, "corner_radius": 1e-3})
    dims = dimensions(design)
    hub = drawn_part(dims, "motor_hub")
    assert hub.Volume() * 1e-9 == pytest.approx(design.values["motor_hub_volume"], rel=1e-9)
    checks = corner_checks("motor_hub", hub, dims.corner_radius, dims.corner_depth_ratio)
    assert [check.text for check in checks if check.level != "pass"] == []
    assert dims.motor_corner_radius == pytest.approx({"print_petg": 1.0, "machine_6061": 2.0}[process])  # 6 mm high


@pytest.mark.slow
@pytest.mark.parametrize("case", ["driven", "driven blocks"])
def test_a_motor_goes_together_in_order_and_its_screws_hold(case):
    mode, overrides = CASES[case]
    design = design_of(case, overrides, mode)
    dims = dimensions(design)
    drawn = drawn_parts(dims)
    checks = {check.name: check for check in module_checks(design, dims, drawn)}
    assert [check.text for check in checks.values() if check.level != "pass"] == []
    drivers = [f"mount_screw_{index + 1}: driver" for index in range(int(dims.spring_count))]
    assert {"motor_screw: driver", "motor_screw: thread", "mount_screw: thread", *drivers} <= set(checks)
    for kind in ("motor_hub", "motor_housing", "motor_retainer"):
        failed = [check.text for check in part_checks(design, dims, kind, drawn[kind]) if check.level == "failure"]
        assert failed == [], kind


@pytest.mark.slow
def test_a_rotor_that_does_not_clear_its_stator_is_found():
    design = design_of("driven", DRIVEN)
    wide = design.model_copy(update={"values": design.values | {"motor_rotor_radius": 25.0e-3}})
    failed = [check.name for check in interference_checks(build(wide), "at rest") if not check.ok]
    assert failed == ["motor_rotor | motor_stator at rest"]


@pytest.mark.slow
@pytest.mark.parametrize("case", ["driven", "driven blocks"])
def test_what_the_motor_turns_has_the_inertia_of_its_solids(case):
    mode, overrides = CASES[case]
    design = design_of(case, overrides, mode)
    stands = {*TURNING, "motor_stator", "motor_housing", "encoder_board"}
    driven = {name: solid for name, solid in build(design).items() if kind_of(name) not in stands}
    about_axis = sum(
        design.values[KINDS[kind_of(name)].density] * _polar_moment(solid) * 1e-15 for name, solid in driven.items()
    )
    # Legs of springs reach in from their rings, and half of each bearing stands.
    assert design.values["driven_inertia"] == pytest.approx(about_axis, rel=0.01)


@pytest.mark.parametrize(
    "case", ["wrist", *(pytest.param(case, marks=pytest.mark.gate) for case in ("odd blocks", "bearings among blocks"))]
)
def test_the_rotor_meets_its_stops_at_their_angle(case):
    mode, overrides = CASES[case]
    design = design_of(case, overrides, mode)
    assert not [name for name in broken_rules(design) if name.startswith("stop_")]
    dims = dimensions(design)
    drawn = {kind: drawn_part(dims, kind) for kind in ("housing", "rotor")}
    for kind, solid in drawn.items():
        assert solid.isValid()
        assert solid.Volume() * 1e-9 == pytest.approx(design.values[f"{kind}_volume"], rel=1e-9), kind
    # 1 mrad beyond a stop two teeth are in two posts by the area of their faces times the way.
    assert [check.text for check in stop_checks(dims, drawn) if not check.ok] == []
    for side in (1.0, -1.0):
        before = turned(drawn["rotor"], side * (dims.stop_angle - 1e-4)).intersect(drawn["housing"])
        assert before.Volume() == pytest.approx(0.0, abs=1e-6)
    assert all(check.ok for check in bearing_checks(dims))


@pytest.mark.parametrize("case", ["wrist", pytest.param("odd blocks", marks=pytest.mark.gate)])
def test_a_fork_holds_the_rotor_at_rest(case):
    mode, overrides = CASES[case]
    dims = dimensions(design_of(case, overrides, mode))
    solids = {kind: drawn_part(dims, kind) for kind in ("housing", "rotor")}
    solids[jigs.FORK] = jigs.fork(dims).Solids()[0]
    assert solids[jigs.FORK].isValid()
    assert [check.text for check in setting_checks(dims, solids) if not check.ok] == []


def test_a_leg_lies_on_its_pin_at_either_stop():
    mode, overrides = CASES["wrist"]
    dims = dimensions(design_of("wrist", overrides, mode))
    rotor = drawn_part(dims, "rotor")
    for angle in (dims.stop_angle, -dims.stop_angle):
        spring = spring_solid(installed_coil(dims, angle)).translate(cq.Vector(dims.placement_radius, 0.0, 0.0))
        assert turned(rotor, angle).distance(spring) == pytest.approx(0.0, abs=1e-3), angle


def coil(**changes: float) -> Coil:
    shape = {"wire_diameter": 2.0, "diameter": 20.0, "turns": 3.25, "pitch": 2.1, "leg_length": 20.0,
             "tang_length": 4.0, "bend_radius": 4.0, "leg_azimuth": 0.4}  # fmt: skip
    return Coil(**(shape | changes))


@settings(max_examples=12, deadline=None)
@given(index=st.floats(4.0, 16.0), turns=st.floats(2.0, 12.0), leg_azimuth=st.floats(-pi, pi))
def test_any_coil_is_one_solid_with_the_volume_of_its_wire(index, turns, leg_azimuth):
    shape = coil(diameter=2.0 * index, turns=turns, leg_azimuth=leg_azimuth)
    solid = spring_solid(shape)
    assert solid.isValid()
    assert solid.Volume() == pytest.approx(0.25 * pi * 4.0 * shape.wire_length, rel=1e-4)


def test_free_spring_is_the_wire_of_the_model_and_reaches_its_pin(design):
    shape = free_coil(dimensions(design))
    assert shape.wire_length == pytest.approx(1e3 * design.values["wire_length"], rel=1e-12)
    assert shape.start_level == pytest.approx(1e3 * design.values["coil_start_level"], rel=1e-12)
    assert spring_solid(shape).Volume() == pytest.approx(1e9 * design.values["spring_volume"], rel=1e-4)
    good = design_of("paper", {})
    design = good.model_copy(update={"values": good.values | {"pin_radius": 0.05}})
    with pytest.raises(GeometryError, match="cannot reach"):
        build(design)


def test_winding_keeps_the_wire_and_the_tang(design):
    dims = dimensions(design)
    wire = dims.coil_count * hypot(pi * dims.coil_diameter, dims.coil_pitch)
    installed = installed_coil(dims)
    assert installed.turns == pytest.approx(dims.coil_count + dims.preload_angle / (2.0 * pi), rel=1e-12)
    for angle in np.linspace(-dims.stroke, dims.stroke, 5):
        moved = installed_coil(dims, angle)
        assert moved.turns * hypot(pi * moved.diameter, moved.pitch) == pytest.approx(wire, rel=1e-12)
        assert sin(moved.start_azimuth - installed.start_azimuth) == pytest.approx(0.0, abs=1e-12)
        assert (moved.turns > installed.turns) == (angle < 0.0)
    assert installed.end_level == pytest.approx(1e3 * design.values["coil_end_level"], abs=1e-3)


def test_leg_lies_against_its_pin_on_the_winding_side(design):
    dims = dimensions(design)
    for angle in (-dims.stroke, 0.0, dims.stroke):
        shape = installed_coil(dims, angle)
        pin = np.array([dims.pin_radius * np.cos(angle) - dims.placement_radius, dims.pin_radius * np.sin(angle)])
        along = np.array([np.cos(shape.leg_azimuth), np.sin(shape.leg_azimuth)])
        right = np.array([along[1], -along[0]])
        leg_offset = 0.5 * shape.diameter  # the leg leaves a counter-clockwise coil on its right
        assert pin @ right - leg_offset == pytest.approx(0.5 * (dims.wire_diameter + dims.pin_diameter), rel=1e-9)
        assert pin @ along == pytest.approx(sqrt(pin @ pin - (pin @ right) ** 2), rel=1e-9)


def _legs_touch_their_pins(design: Design) -> None:
    for angle in (0.0, 0.7 * design.values["stroke"]):
        parts = build(design, angle)
        for name in ("spring_right_1", "spring_left_2"):
            assert parts["rotor"].distance(parts[name]) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.gate
def test_solid_leg_touches_the_pin(paper):
    _legs_touch_their_pins(paper)


@pytest.mark.slow
def test_solid_leg_of_every_case_touches_the_pin(design):
    _legs_touch_their_pins(design)


def test_mesh_is_the_solid():
    shape = coil(turns=4.6)
    mesh = spring_mesh(shape)
    body = trimesh.Trimesh(mesh.vertices, mesh.faces)
    solid = spring_solid(shape)
    assert body.is_watertight
    assert body.volume == pytest.approx(solid.Volume(), rel=2e-3)
    box = solid.BoundingBox()
    limits = [[box.xmin, box.ymin, box.zmin], [box.xmax, box.ymax, box.zmax]]
    assert np.allclose(body.bounds, limits, atol=0.05)


@pytest.mark.parametrize(
    ("changes", "words"),
    [({"diameter": 1.5}, "coil diameter"), ({"pitch": 1.9}, "gap between coils"), ({"leg_length": 0.0}, "leg_length")],
)
def test_a_wire_that_cannot_be_bent_is_an_error(changes, words):
    with pytest.raises(GeometryError, match=words):
        spring_solid(coil(**changes))


SIDES = ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")


def sides(box: Any) -> list[float]:
    return [getattr(box, side) for side in SIDES]


def pin_on_plate(plate: float) -> cq.Solid:
    """Draw a pin of 4 mm with a fillet of 1.5 mm at its foot, on a square plate of a side [mm]."""
    body = cq.Workplane().box(plate, plate, 4.0).faces(">Z").workplane().circle(2.0).extrude(9.0)
    return body.edges(cq.selectors.RadiusNthSelector(0)).edges("<Z").fillet(1.5).solids().val()


@pytest.mark.parametrize("plate", [7.5, 30.0])
@pytest.mark.parametrize("turn", [0.0, 17.0, 211.3])
def test_a_fillet_within_the_rest_is_left_out(plate, turn, monkeypatch):
    solid = pin_on_plate(plate).rotate(cq.Vector(), cq.Vector(0.2, 0.1, 1.0), turn)
    expected = sides(solid.BoundingBox())
    assert "TORUS" in [face.geomType() for face in solid.Faces()]
    monkeypatch.setattr(cq.Shape, "BoundingBox", lambda _self: pytest.fail("the kernel's search"))
    assert sides(tight_box(solid)) == expected


def test_a_tight_box_counts_what_is_outermost():
    foot = cq.Workplane("XZ").moveTo(1.0, 0.0).lineTo(3.0, 0.0).radiusArc((1.5, 1.5), 1.5).lineTo(1.0, 1.5).close()
    solid = foot.revolve(360.0, (0.0, 0.0), (0.0, 1.0)).solids().val()
    assert sides(tight_box(solid)) == sides(solid.BoundingBox())
    for solid in (cq.Solid.makeTorus(9.0, 2.0), cq.Solid.makeBox(1, 2, 3), cq.Solid.makeSphere(3.0)):
        assert sides(tight_box(solid)) == sides(solid.BoundingBox())


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
def test_liners_lie_in_the_rotor_a_film_from_its_recess_and_turn_with_it(mode, changes):
    design = design_of("lined", changes, mode)
    for angle in (0.0, 0.5 * design.values["stroke"]):
        placed = placed_of(design, angle)
        liners = [solid for name, solid in placed.items() if kind_of(name) == "liner"]
        polymer = "pcl_arc" if mode == "shear" else "pcl_block"
        assert len(liners) == sum(kind_of(name) == polymer for name in placed)
        volume = 1e9 * design.values["liner_volume"]
        assert sum(liner.Volume() for liner in liners) == pytest.approx(volume, rel=1e-6)
        polar = sum(_polar(liner) for liner in liners)
        assert polar * design.values["liner_density"] * 1e-15 == pytest.approx(design.values["liner_inertia"], rel=1e-5)
        assert placed["rotor"].Volume() == pytest.approx(1e9 * design.values["rotor_volume"], rel=1e-5)
        for liner in liners:
            assert between(liner, placed["rotor"]) == 0.0
            assert between(liner, placed["housing"]) == 0.0
    bare = design_of("bare", {name: value for name, value in changes.items() if "liner" not in name}, mode)
    recess = 1e9 * (bare.values["rotor_volume"] - design.values["rotor_volume"])
    wider = _wider(design) if mode == "shear" else 1.0
    assert recess == pytest.approx(wider * volume * (0.8 + 0.1) / 0.8, rel=2e-3)


def _polar(solid: cq.Solid) -> float:
    """Return the moment of the volume about the module's axis [mm^5]."""
    middle = solid.Center()
    return cq.Shape.matrixOfInertia(solid)[2][2] + solid.Volume() * (middle.x**2 + middle.y**2)


@pytest.mark.parametrize(
    ("mode", "changes", "diameter"),
    [
        pytest.param("shear", {}, 4.2, id="below a window"),
        pytest.param("shear", {"heater_fuse": "microtemp_g4a"}, 4.0, id="another maker's"),
        pytest.param("shear", TILES, 4.2, id="below a tile", marks=pytest.mark.slow),
        pytest.param("compression", {}, 4.2, id="below a slot", marks=pytest.mark.slow),
    ],
)
def test_the_cut_out_lies_across_the_first_heater_in_no_part_s_way(mode, changes, diameter):
    design = design_of("guarded", changes, mode)
    placed = placed_of(design)
    body = placed["thermal_cutout"]
    box = body.BoundingBox()
    below = 0.0 if mode == "compression" or changes is TILES else 1.6  # Leads of 1.4 mm pass above it
    assert box.zmax == pytest.approx(-1e3 * design.values["floor_thickness"] - below, abs=1e-6)
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
def test_it_touches_what_it_measures_and_cuts_nothing(changes, touched, count):
    design = design_of("seat", changes)
    placed = standing(design)
    assert sum(name.startswith("thermistor") for name in placed) == count
    assert placed["thermistor_1"].distance(placed[touched]) == pytest.approx(0.0, abs=1e-6)
    assert placed["thermistor_1"].distance(placed["housing"]) > 0.1
    assert_sound(design, placed, ("housing_volume", "housing_inertia", "thermistor_volume"))


@pytest.mark.parametrize("changes", [BEAD, TILES | BEAD])
def test_its_wires_go_straight_down_through_the_floor(changes):
    design = design_of("wires", changes)
    placed, dims = standing(design), dimensions(design)
    box = placed["thermistor_1"].BoundingBox()
    assert box.zmax == pytest.approx(-dims.spreader_depth)
    below = cq.Solid.makeCylinder(
        0.4 * dims.thermistor_diameter, 20.0, cq.Vector(*placed["thermistor_1"].Center().toTuple()[:2], box.zmin - 20.0)
    )
    assert below.intersect(placed["housing"]).Volume() == pytest.approx(0.0, abs=1e-6)


def test_a_seat_that_breaks_into_the_window_is_found_by_rule_and_by_volume():
    design = design_of("large", {"thermistor_diameter": 3e-3})
    assert broken_rules(design) == ["thermistor_window_gap"]
    checks = {check.name: check.ok for check in size_checks(design, standing(design))}
    assert not checks["housing_volume"]


BEAD_BY_BLOCK = {"thermistor_diameter": 0.8e-3, "thermistor_length": 2.5e-3}


@pytest.mark.parametrize(("changes", "touched"), [(BLOCKS, "heater_1"), (VANE_TILES, "spreader_1")])
def test_it_touches_what_heats_the_block_and_cuts_nothing(changes, touched):
    design = design_of("bead", {**changes, **BEAD_BY_BLOCK}, "compression")
    placed, dims = standing(design), dimensions(design)
    bead = placed["thermistor_1"]
    assert bead.distance(placed[touched]) == pytest.approx(0.0, abs=1e-6)
    assert min(bead.distance(part) for name, part in placed.items() if name.startswith("pcl_block")) < 0.5
    assert_sound(design, placed, ("housing_volume", "housing_inertia", "thermistor_volume"))
    below = cq.Solid.makeCylinder(0.5 * dims.thermistor_diameter, 20.0, bead.Center() - cq.Vector(0, 0, 21.3))
    assert below.intersect(placed["housing"]).Volume() == pytest.approx(0.0, abs=1e-6)


@cases_of("cad_mounts", "beads")
def test_a_bead_without_room_breaks_a_rule(rule, changes):
    assert rule in broken_rules(design_of("tight", {**BLOCKS, **BEAD_BY_BLOCK, **changes}, "compression"))
    bare = {name: value for name, value in changes.items() if "thermistor" not in name}
    assert rule not in broken_rules(design_of("none", {**BLOCKS, **bare}, "compression"))
