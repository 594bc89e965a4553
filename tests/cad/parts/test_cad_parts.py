"""The solids against the model's rows and each other; drill points, dowels, bonded tangs and the casting jig."""

from collections.abc import Mapping
from math import atan2, degrees, hypot, pi, radians, sin, tan
from pathlib import Path

import cad_designs
import cadquery as cq
import numpy as np
import pytest
from cad_designs import (
    BEARING_BLOCKS,
    BEARINGS,
    BLOCKS,
    CASES,
    DRIVEN_BLOCKS,
    MM,
    all_checks,
    broken_rules,
    design_of,
    module_of_parts,
)  # fmt: skip
from placed_solids import build
from sample_solids import of
from support import cases_of

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import MODULES, drawn_part, drawn_parts, place
from tvimdesign.cad.assembly.bill_of_materials import beside, bill, bill_csv
from tvimdesign.cad.drawing.drawing_requirements import drawing_requirements
from tvimdesign.cad.drawing.drawing_sheet import figure
from tvimdesign.cad.export.mesh import solid_mesh
from tvimdesign.cad.export.print_files import as_printed, closed, with_wider_holes
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.features import Cylinder, holes, upright_cylinders
from tvimdesign.cad.geometry.kinds import PRODUCTION, kind_of
from tvimdesign.cad.geometry.spring_solids import installed_coil
from tvimdesign.cad.inspection.inspect import casting_checks, casting_gap, part_checks
from tvimdesign.cad.inspection.order import sequence
from tvimdesign.cad.inspection.rays import Triangles, wall_checks
from tvimdesign.cad.inspection.size_checks import _polar_moment, interference_checks, size_checks
from tvimdesign.cad.parts import fasteners, jigs
from tvimdesign.cad.parts.common_parts import link_dowels
from tvimdesign.device import table_for
from tvimdesign.study import read_study_text
from tvimdesign.study.design import Design
from tvimdesign.study.written_studies import result_text


def test_the_cases_keep_the_rules_in_valid_solids(design):
    assert broken_rules(design) == []
    parts = build(design)
    assert {kind_of(name) for name in parts} == set(MODULES[design.mode].kinds(dimensions(design)))
    for solid in parts.values():
        assert isinstance(solid, cq.Solid)
        assert solid.isValid()


SIZED = {
    **{name: CASES[name] for name in ("paper", "blocks", "bearings", "bearings among blocks", "driven")},
    "three arcs": ("shear", module_of_parts("THREE_ARCS")),
    "tall vanes": ("compression", module_of_parts("TALL_VANES")),
}
# Springs to what the kernel sweeps a wire to; the housing's holes and corners count at one radius in its inertia.
WITHIN = {"spring_right_volume": 1e-5, "spring_left_volume": 1e-5, "module_mass": 2e-6, "housing_inertia": 1e-3,
          "motor_hub_inertia": 1e-6}  # fmt: skip


@pytest.mark.gate
@pytest.mark.parametrize("name", SIZED)
def test_volumes_and_inertias_are_those_of_the_kernel(name):
    mode, changes = SIZED[name]
    design = design_of(name, changes, mode)
    for check in size_checks(design, build(design)):
        assert abs(check.value) < WITHIN.get(check.name, 1e-9), check.text


@pytest.mark.parametrize("case", ["on a base", "bearings among blocks", "driven"])
def test_a_base_lets_the_floor_lie_flat_and_is_as_the_model_has_it(case):
    mode, changes = CASES[case]
    hanging = {}
    for word in ("one_piece", "separate"):
        design = design_of(case, {**changes, "housing_base": word}, mode)
        dims = dimensions(design)
        checks = part_checks(design, dims, "housing", housing := drawn_part(dims, "housing"))
        hanging[word] = sum(check.value for check in checks if "overhang" in check.name)
        assert housing.Volume() * 1e-9 == pytest.approx(design.values["housing_volume"], rel=1e-9)
    base = drawn_part(dims, "base")
    assert broken_rules(design) == []
    assert [check.text for check in part_checks(design, dims, "base", base) if check.level != "pass"] == []
    assert housing.BoundingBox().zmin == pytest.approx(base.BoundingBox().zmax) == pytest.approx(-dims.floor_thickness)
    assert hanging["separate"] == 0.0
    assert hanging["one_piece"] > 1e3 or design.choices["making_method"] == "milled"
    moments = table_for(mode).evaluate({**design.values, **design.choices}, ["base_moments"])["base_moments"]
    assert base.Volume() * 1e-9 == pytest.approx(moments.area, rel=1e-9)
    assert _polar_moment(base) * 1e-15 == pytest.approx(moments.polar, rel=1e-3)  # corners count at one radius


@pytest.mark.slow
def test_every_check_holds_at_rest_and_through_the_stroke(design):
    dims = dimensions(design)
    checks = all_checks(design, drawn_parts(dims))
    assert [check.text for check in checks if not check.ok] == []
    sizes = {check.name: check.value for check in checks}
    drawn = [f"{kind}_volume" for kind in MODULES[design.mode].drawn(dims)]
    for name in (*drawn, "rotor_inertia", "link_inertia", "parts_inertia"):
        assert sizes[name] == pytest.approx(0.0, abs=1e-9)
    # The kernel sweeps a wire to 3e-6 of its volume.
    assert sizes["spring_right_volume"] == pytest.approx(0.0, abs=1e-5)
    assert sizes["spring_left_volume"] == pytest.approx(0.0, abs=1e-5)
    assert sizes["module_mass"] == pytest.approx(0.0, abs=1e-6)
    assert sizes["envelope_diameter"] == pytest.approx(0.0, abs=1e-6)
    assert sizes["envelope_height"] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("row", ["housing_volume", "rotor_inertia", "spring_volume", "structure_density"])
def test_a_wrong_model_is_found(paper, row):
    wrong = paper.model_copy(update={"values": paper.values | {row: 1.0002 * paper.values[row]}})
    assert not all(check.ok for check in size_checks(wrong, build(paper)))


def with_rotor(first: str, other: str) -> bool:
    """Return the pairs with the rotor: booleans of all pairs take three times as long."""
    return "rotor" in (first, other)


@pytest.mark.gate
def test_legs_pins_and_cores_in_the_way_are_found(paper):
    parts = build(paper)
    ahead = build(paper, -0.02)["rotor"]  # the rotor winds the right-hand springs, which stay behind
    checks = [check for check in interference_checks(parts | {"rotor": ahead}, "here", with_rotor) if not check.ok]
    springs = {check.name for check in checks if "spring" in check.name}
    assert springs == {"rotor | spring_right_1 here", "rotor | spring_right_3 here"}
    design = design_of("fat core", {"core_radius": 0.021, "leg_overhang": 0.02})
    assert "leg_core_gap" in broken_rules(design)
    checks = [check for check in interference_checks(build(design), "at rest", with_rotor) if not check.ok]
    assert any(check.name.startswith("rotor | spring") for check in checks)


@cases_of("cad_parts", "not_drawn")
def test_what_cannot_be_drawn_names_the_part(request, of, row, value, words):
    whole_design = request.getfixturevalue(of)
    design = whole_design.model_copy(update={"values": whole_design.values | {row: value}})
    with pytest.raises(GeometryError, match=words):
        build(design)


@pytest.mark.gate
@pytest.mark.parametrize("name", ["SPLIT_AT_THE_LAYER", "SPLIT_AT_THE_EDGE"])
def test_meshes_close_where_rounding_splits_their_vertices(name):
    dims = dimensions(design_of("split", module_of_parts(name)))
    for kind, solid in drawn_parts(dims).items():
        assert closed(kind, solid_mesh(solid)).is_watertight


@pytest.mark.parametrize(("process", "radius"), [("print_petg", 0.2), ("machine_6061", 1.5)])
def test_pockets_and_windows_have_the_corners_the_process_leaves(process, radius):
    design = design_of("corners", {"process": process})
    housing = build(design)["housing"]
    corners = [face for face in housing.Faces() if face.geomType() == "CYLINDER" and face.Area() < 12.0]
    radii = [face._geomAdaptor().Cylinder().Radius() for face in corners]
    # Four arcs, each with a pocket and a window of four corners.
    assert len([corner for corner in radii if corner == pytest.approx(radius, rel=1e-6)]) == 32
    assert not [check for check in size_checks(design, build(design)) if not check.ok]


def test_parts_that_cut_each_other_are_reported_with_volume_and_place():
    block, other = cq.Solid.makeBox(10, 10, 10), cq.Solid.makeBox(10, 10, 10, cq.Vector(8, 6, -4))
    cut, _ = interference_checks({"housing": block, "rotor": other}, "here")
    assert not cut.ok
    assert (cut.part, cut.unit) == ("housing, rotor", "mm³")
    assert cut.value == pytest.approx(2.0 * 4.0 * 6.0)
    assert cut.place == pytest.approx((9.0, 8.0, 3.0))


def cones(solid: cq.Solid) -> list[cq.Face]:
    return [face for face in solid.Faces() if face.geomType() == "CONE"]


@pytest.mark.parametrize("process", ["print_petg", "machine_6061"])
def test_a_milled_core_has_drill_points_below_its_blind_holes(process):
    dims = dimensions(design_of("points", {"process": process, "corner_radius": 0.5e-3}))
    points = cones(drawn_part(dims, "rotor"))
    if process == "print_petg":
        assert points == []
        return
    # Four screws of the link, the retainer's, and the pins: a cone of 118 degrees is 0.3 diameters high.
    assert len(points) == 5 + dims.count("dowels_fitted")
    highest = max(face.BoundingBox().zmax for face in points)
    tip = dims.core_bottom_level + dims.retainer_screw_depth
    tip += 0.5 * dims.retainer_screw_hole / tan(radians(59.0))
    assert highest == pytest.approx(max(tip, dims.link_bottom_level - dims.link_dowel_depth), abs=1e-6)
    lowest = min(face.BoundingBox().zmin for face in points)
    link_tip = dims.link_bottom_level - dims.link_screw_depth - 0.5 * dims.link_screw_hole / tan(radians(59.0))
    assert lowest == pytest.approx(min(link_tip, dims.core_bottom_level + dims.retainer_screw_depth), abs=1e-6)


@pytest.mark.gate
@pytest.mark.parametrize("changes", [BEARING_BLOCKS, DRIVEN_BLOCKS], ids=["bearings", "driven"])
def test_volumes_and_inertias_of_milled_parts_count_their_points(changes):
    design = design_of("milled", changes, "compression")
    dims = dimensions(design)
    drawn = drawn_parts(dims)
    counted = {"rotor": cones(drawn["rotor"]), "housing": cones(drawn["housing"])}
    assert len(counted["rotor"]) == 5 + dims.count("dowels_fitted")
    # The cover's screws, and the marks beside the adjusters.
    drilled = [bool(dims.cover_height), bool(dims.scale_mark_radius)]
    assert len(counted["housing"]) == sum(drilled) * dims.count("spring_count")
    for kind in ("adjuster", "motor_hub", "motor_housing"):
        assert kind not in drawn or cones(drawn[kind]), kind
    assert [check.text for check in size_checks(design, place(dims, drawn)) if not check.ok] == []


def test_the_scale_has_dots_every_thirty_degrees_and_a_mark():
    dims = dimensions(design_of("scale", BEARINGS))
    is_dot = 0.5 * dims.scale_dot_diameter
    dots = [hole for hole in holes(drawn_part(dims, "adjuster")) if hole.radius == pytest.approx(is_dot)]
    tang = atan2(*reversed(installed_coil(dims).tang_position))
    turns = sorted(round((degrees(atan2(dot.y, dot.x) - tang) % 360.0), 6) for dot in dots)
    assert turns == pytest.approx([30.0 * index for index in range(2, 11)])
    assert min(hypot(dot.x, dot.y) for dot in dots) > 0.5 * (dims.coil_diameter + dims.wire_diameter)
    assert all(dot.top == pytest.approx(0.0) and dot.bottom == pytest.approx(-0.4) for dot in dots)
    marks = [hole for hole in holes(drawn_part(dims, "housing")) if hole.radius == pytest.approx(is_dot)]
    assert len(marks) == dims.count("spring_count")
    for azimuth, (x, y) in zip(dims.azimuths("spring_count"), _in_order(marks), strict=True):
        assert (degrees(atan2(y, x) - azimuth) + 180.0) % 360.0 - 180.0 > 0.0


def test_dots_of_a_scale_leave_no_thin_wall():
    changes = {"preload_adjuster": "rotary", "coil_diameter": 6.1e-3, "wire_diameter": 1.1e-3}
    changes |= {"adjuster_screw": "iso_4762_m2", "adjuster_screw_length": 6e-3, "thread_insert": "none"}
    design = design_of("small scale", changes)
    dims = dimensions(design)
    adjuster = drawn_part(dims, "adjuster")
    apart = 2.0 * dims.scale_circle_radius * sin(radians(15.0)) - dims.scale_dot_diameter - dims.hole_compensation
    assert apart < dims.minimum_wall
    printed = Triangles(solid_mesh(with_wider_holes(adjuster, dims.hole_compensation)))
    assert wall_checks("adjuster", printed, dims.minimum_wall, 0.8)[0].value == pytest.approx(apart, abs=0.02)
    wall = of(part_checks(design, dims, "adjuster", adjuster))["wall"]
    assert wall.value >= dims.minimum_wall - 0.02
    assert "beside its scale" in wall.text


def _in_order(marks: list[Cylinder]) -> list[tuple[float, float]]:
    """Return their places, counted around the axis."""
    return sorted(((mark.x, mark.y) for mark in marks), key=lambda at: atan2(at[1], at[0]) % 6.283185307179586)


CAST = {"keyed arc": ("shear", {}), "plain arc": ("shear", {"key_count": 0.0}), "block": ("compression", BLOCKS)}


def jig(name: str) -> tuple[Dimensions, str, dict[str, cq.Solid]]:
    mode, changes = CAST[name]
    dims = dimensions(design_of(name, changes, mode))
    kind = "pcl_arc" if mode == "shear" else "pcl_block"
    part = drawn_part(dims, kind)
    return dims, kind, {kind: part} | {piece: draw(dims, part).Solids()[0] for piece, draw in jigs.DRAWN.items()}


@pytest.mark.parametrize("name", CAST)
def test_the_jig_s_gap_and_room_are_the_part_s(name):
    dims, kind, solids = jig(name)
    checks = {check.name: check for check in casting_checks(dims, kind, solids)}
    assert [check.text for check in checks.values() if not check.ok] == []
    assert all(solids[piece].isValid() for piece in jigs.DRAWN)
    # 1 mm of the default layer; 3.5 mm of the default block above a clearance of 0.4.
    wanted = dims.pcl_thickness if kind == "pcl_arc" else dims.vane_height - dims.running_clearance
    assert casting_gap(dims, solids["casting_mould"], solids["casting_lid"]) == pytest.approx(wanted, abs=1e-9)
    _, kind, solids = jig(name)
    pieces = [solids[piece] for piece in jigs.DRAWN]
    around = cq.Compound.makeCompound(pieces).BoundingBox()
    block = cq.Solid.makeBox(around.xlen, around.ylen, around.zlen, cq.Vector(around.xmin, around.ymin, around.zmin))
    rooms = [room.Volume() for room in block.cut(*pieces).Solids()]
    assert any(room == pytest.approx(solids[kind].Volume(), rel=1e-6) for room in rooms), rooms


def test_the_test_pieces_try_sizes_about_what_the_process_assumes():
    mode, changes = CAST["keyed arc"]
    dims = dimensions(design_of("trial", changes, mode))
    (solid,) = jigs.trial(dims).Solids()
    assert solid.isValid()
    assert jigs.tried(dims, "walls") == [0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 2.0]
    # Slip fits have 0.2 mm, from 0.15 to 0.3; parts that turn 0.4 mm, from 0.3 to 0.5.
    assert jigs.tried(dims, "gaps") == [0.0, *(round(0.05 * step, 2) for step in range(2, 13))]
    for slip, running, gaps in ((0.1, 0.2, [0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3]), (0.3, 0.3, [0.0, 0.2, 0.25, 0.3])):
        other = dimensions(
            design_of("trial", {**changes, "slip_clearance": slip * MM, "running_clearance": running * MM})
        )
        assert jigs.tried(other, "gaps")[: len(gaps)] == gaps
    rounds = [(face.concave, round(2.0 * face.radius, 6)) for face in upright_cylinders(solid)]
    holes = [(True, 6.0 + 2.0 * gap) for gap in jigs.tried(dims, "gaps")]
    pins = [(False, size) for size in (*jigs.tried(dims, "pins"), 6.0)]
    assert sorted(rounds) == sorted(holes + pins)
    # Cut halfway up: walls 10 mm long, round pins, and five posts of 2 mm beside windows of 5, 10, 15 and 20 mm.
    half = solid.intersect(cq.Solid.makeBox(200.0, 200.0, 0.1, cq.Vector(0.0, 0.0, 5.0))).Volume() / 0.1
    assert jigs.tried(dims, "bridges") == [5.0, 10.0, 15.0, 20.0]
    rods = sum(0.25 * pi * size**2 for _, size in pins)
    assert half == pytest.approx(10.0 * sum(jigs.tried(dims, "walls")) + rods + 5.0 * 2.0**2, rel=1e-6)


@pytest.mark.gate
@pytest.mark.parametrize("name", ["elbow_printed", "paper_compression"])
def test_built_parts_stay_as_drawn_beside_what_is_measured(name):
    first = cad_designs.shipped_design(name)
    again = read_study_text(result_text(first, "a test", Path(), built=True), "built")
    assert {"minimum_wall", "slip_clearance", "running_clearance"} <= again.as_drawn.keys()
    drawn = {**again.as_drawn, "tang_clearance": first.value("tang_clearance")}
    wider = {name: 1.2 * first.value(name) for name in (*drawn, "minimum_feature")}

    modules = []
    for measured, as_drawn in (({}, {}), (wider, drawn), (wider, {})):
        study = again.model_copy(update={"module": {**again.module, **measured}, "as_drawn": as_drawn})
        module = cad_designs.whole(cad_designs.as_it_starts(study), study)
        solids = drawn_parts(dimensions(module))
        assert all(check.ok for check in size_checks(module, place(dimensions(module), solids)))
        modules.append(
            (module.values, {kind: [part.Volume(), *part.Center().toTuple()] for kind, part in solids.items()})
        )
    (before, parts), (built, same), (_, redrawn) = modules
    assert same == {kind: pytest.approx(sizes, rel=1e-9, abs=1e-9) for kind, sizes in parts.items()}
    assert redrawn["housing"] != pytest.approx(parts["housing"], rel=1e-3)
    moved = {name for name, value in built.items() if value != pytest.approx(before[name], rel=1e-9)}
    assert {"pin_margin", "post_margin", "tang_fit_margin", "running_fit_margin", "housing_wall_margin"} <= moved
    assert not moved & {
        "module_mass",
        "housing_volume",
        "envelope_diameter",
        "rotor_bottom_level",
        "adjuster_thickness",
    }


def test_lids_and_dams_that_do_not_fit_fail_their_checks():
    dims, kind, solids = jig("keyed arc")
    solids["casting_lid"] = solids["casting_lid"].translate(cq.Vector(0, 0, 0.05)).Solids()[0]
    failed = [check.name for check in casting_checks(dims, kind, solids) if not check.ok]
    assert failed == ["casting_jig: gap"]
    dims, kind, solids = jig("plain arc")
    box = solids[kind].BoundingBox()
    slot = cq.Solid.makeBox(20.0, 1.0, 2.0, cq.Vector(box.xmax - 1.0, -0.5, 0.0))
    solids["casting_mould"] = solids["casting_mould"].cut(slot).Solids()[0]
    failed = [check.name for check in casting_checks(dims, kind, solids) if not check.ok]
    assert failed == ["casting_jig: melt"]


TWO = {"link_dowel_count": 2, "link_dowel": "iso_8734_2"}
DRILLED: Mapping[str, tuple[str, Mapping[str, float | str]]] = {
    "two": ("shear", TWO),
    "four": ("shear", {}),
    "compression": ("compression", {"core_radius": 8.0 * MM, "link_screw": "iso_4762_m2", **TWO}),
}


@pytest.fixture(scope="module", params=[pytest.param("two", marks=pytest.mark.slow), "four", "compression"])
def design(request: pytest.FixtureRequest) -> Design:
    mode, overrides = DRILLED[request.param]
    return design_of(request.param, overrides, mode)


@pytest.fixture(scope="module")
def dims(design: Design) -> Dimensions:
    return dimensions(design)


@pytest.fixture(scope="module")
def placed(dims: Dimensions) -> dict[str, cq.Solid]:
    return place(dims, drawn_parts(dims))


def test_pins_fill_their_holes_have_their_size_and_go_in_last(design, placed, dims):
    checks = {check.name: check for check in size_checks(design, placed)}
    wanted = ("link_dowel_volume", "rotor_volume", "link_volume", "rotor_inertia", "parts_inertia", "module_mass")
    assert {name: checks[name].ok for name in wanted} == dict.fromkeys(wanted, True)
    assert max(abs(checks[name].value) for name in wanted[:4]) < 1e-9
    names = [name for name in placed if name.startswith("link_dowel")]
    assert len(names) == dims.count("dowels_fitted")
    pinned = {name: placed[name] for name in placed if name in names or name.startswith(("rotor", "link"))}
    assert [check.name for check in interference_checks(pinned, "here") if not check.ok] == []
    top = dims.link_bottom_level + dims.link_thickness
    for name in names:
        box = placed[name].BoundingBox()
        assert (box.zmax, box.zmin) == pytest.approx((top, top - dims.link_dowel_length))
        # Half a millimetre of room is left below each, in the core.
        below = cq.Vector(*placed[name].Center().toTuple()[:2], box.zmin - 0.25)
        assert not placed["rotor"].isInside(below)
        assert placed["rotor"].isInside(below - cq.Vector(0, 0, 0.5))
    order = [part.name for part in sequence(list(placed), dims)]
    assert sorted(order) == sorted(placed)
    assert order.index("link") < order.index("link_screw_1") < order.index("link_dowel_1")


@pytest.mark.parametrize("process", ["print_petg", "machine_6061"])
def test_dowel_pins_of_legs_fill_their_holes_above_the_plate_s_face(process):
    overrides = {"leg_pin": "iso_8734_3", "leg_pin_length": 12.0 * MM, "process": process}
    design = design_of("pinned", overrides)
    dims = dimensions(design)
    placed = place(dims, drawn_parts(dims))
    names = [name for name in placed if name.startswith("leg_pin")]
    assert len(names) == dims.count("spring_count")
    for name in names:
        box = placed[name].BoundingBox()
        assert (box.zmax, box.zmin) == pytest.approx((dims.pin_top_level, dims.pin_top_level - dims.leg_pin_length))
        end = cq.Vector(*placed[name].Center().toTuple()[:2], box.zmin)
        point = dims.drill_point_ratio * dims.pin_diameter
        assert placed["rotor"].isInside(end - cq.Vector(0, 0, point + 0.1))
        assert placed["rotor"].isInside(end + cq.Vector(0.5 * dims.pin_diameter + dims.minimum_wall, 0, 1.0))
        left = 1e3 * design.value("leg_pin_floor_margin") + dims.minimum_wall
        assert box.zmin - point - dims.rotor_bottom_level == pytest.approx(left)
    checks = {check.name: check for check in size_checks(design, placed)}
    assert max(abs(checks[name].value) for name in ("leg_pin_volume", "rotor_volume", "rotor_inertia")) < 1e-9
    pinned = {name: solid for name, solid in placed.items() if name.startswith(("leg_pin", "rotor", "spring_"))}
    assert [check.name for check in interference_checks(pinned, "here") if not check.ok] == []


def test_pins_stand_between_the_screws_and_turn_with_the_link(dims):
    dowels = {"link_dowel": drawn_parts(dims)["link_dowel"]}
    still, turned = (fasteners.stand(dims, dowels, angle) for angle in (0.0, 0.1))
    for name, shape in still.items():
        a, b = shape.Center(), turned[name].Center()
        assert hypot(a.x, a.y) == pytest.approx(0.7 * dims.core_radius)
        azimuth = np.degrees(np.arctan2(a.y, a.x)) % 90.0
        assert min(azimuth, 90.0 - azimuth) == pytest.approx(0.0, abs=1e-6)
        assert (np.arctan2(b.y, b.x) - np.arctan2(a.y, a.x)) % (2.0 * np.pi) == pytest.approx(0.1)


def test_prints_and_drawings_leave_holes_to_be_reamed(dims, placed, design):
    for kind in ("rotor", "link"):
        reamed = link_dowels(dims)
        lying = as_printed(placed[kind], PRODUCTION[kind], 0.3, reamed)
        sign = -1.0 if PRODUCTION[kind].down == "top" else 1.0
        at = {(round(x, 6), round(sign * y, 6)) for x, y in reamed}
        pin_holes = [hole for hole in holes(lying) if any(hypot(hole.x - x, hole.y - y) < 1e-4 for x, y in at)]
        assert [pin.radius for pin in pin_holes] == pytest.approx([0.5 * dims.link_dowel_diameter] * len(reamed))
        screws = [hole.radius for hole in holes(lying) if hole not in pin_holes]
        assert all(abs(radius - 0.5 * dims.link_dowel_diameter) > 0.05 for radius in screws)
    for kind in ("rotor", "link"):
        seat = drawing_requirements(kind, dims, design.choices).seats[-1]
        assert (seat.fit, seat.size, seat.letter) == ("H7", pytest.approx(dims.link_dowel_diameter), "")
    hole = f"⌀{figure(dims.wire_diameter + 0.5)}: for bonding"  # rounded as everywhere on the drawing
    assert any(hole in note for note in drawing_requirements("housing", dims, design.choices).notes)
    loose = {**design.choices, "tang_hold": "hole"}
    assert not any("bonding" in note for note in drawing_requirements("housing", dims, loose).notes)


def test_the_bill_has_the_pins_and_the_adhesive(design, dims, placed):
    items = bill(design, {"tang_adhesive": "An epoxy"}, placed)
    extra = beside(design, {"tang_adhesive": "An epoxy"})
    pins = next(item for item in items if item.kind == "link_dowel")
    assert (pins.quantity, pins.made) == (dims.count("dowels_fitted"), False)
    (adhesive,) = (line for line in extra if line.kind == "tang_adhesive")
    assert adhesive.title == "An epoxy"
    assert adhesive.mass == pytest.approx(1e3 * design.value("tang_adhesive_mass"))
    assert b"tang_adhesive" in bill_csv([*items, *extra])


def test_screws_alone_and_loose_tangs_have_none_of_it():
    design = design_of("loose", {"link_fit": "clearance", "tang_hold": "hole"})
    dims = dimensions(design)
    assert "link_dowel" not in drawn_parts(dims)
    kinds = ["polymer", "heater_adhesive", "thermistor", "polyimide_film", "gap_pad"]
    kinds += ["wire_sleeve", "thread_patch", "mount_screw"]
    assert [item.kind for item in beside(design, {})] == kinds
    assert drawing_requirements("link", dims, design.choices).seats == []
    assert broken_rules(design_of("fitted", {})) == []
