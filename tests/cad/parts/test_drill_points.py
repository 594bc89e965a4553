"""Drill points, dots of scales, dowels and bonded tangs, and the jig around parts that are cast in it."""

from collections.abc import Mapping
from math import atan2, degrees, hypot, radians, sin, tan

import cadquery as cq
import numpy as np
import pytest
from cad_designs import BEARING_BLOCKS, BEARINGS, BLOCKS, DRIVEN_BLOCKS, MM, broken_rules, design_of
from sample_solids import of

from tvimdesign.cad.assembly.assembly import drawn_part, drawn_parts, place
from tvimdesign.cad.assembly.bill_of_materials import beside, bill, bill_csv
from tvimdesign.cad.drawing.drawing_requirements import drawing_requirements
from tvimdesign.cad.drawing.drawing_sheet import figure
from tvimdesign.cad.export.mesh import solid_mesh
from tvimdesign.cad.export.print_files import as_printed, with_wider_holes
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.features import Cylinder, holes
from tvimdesign.cad.geometry.kinds import PRODUCTION
from tvimdesign.cad.geometry.spring_solids import installed_coil
from tvimdesign.cad.inspection.inspect import casting_checks, casting_gap, part_checks
from tvimdesign.cad.inspection.order import sequence
from tvimdesign.cad.inspection.rays import Triangles, wall_checks
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.cad.parts import fasteners, jigs
from tvimdesign.cad.parts.common_parts import link_dowels
from tvimdesign.study.design import Design


def cones(solid: cq.Solid) -> list[cq.Face]:
    return [face for face in solid.Faces() if face.geomType() == "CONE"]


@pytest.mark.parametrize("process", ["print_petg", "machine_6061"])
def test_a_milled_core_has_drill_points_below_its_blind_holes(process: str) -> None:
    dims = dimensions(design_of("points", {"process": process, "corner_radius": 0.5e-3}))
    found = cones(drawn_part(dims, "rotor"))
    if process == "print_petg":
        assert found == []
        return
    # Four screws of the link, the retainer's, and the pins: a cone of 118 degrees is 0.3 diameters high.
    assert len(found) == 5 + dims.count("dowels_fitted")
    highest = max(face.BoundingBox().zmax for face in found)
    tip = dims.core_bottom_level + dims.retainer_screw_depth
    tip += 0.5 * dims.retainer_screw_hole / tan(radians(59.0))
    assert highest == pytest.approx(max(tip, dims.link_bottom_level - dims.link_dowel_depth), abs=1e-6)
    lowest = min(face.BoundingBox().zmin for face in found)
    link_tip = dims.link_bottom_level - dims.link_screw_depth - 0.5 * dims.link_screw_hole / tan(radians(59.0))
    assert lowest == pytest.approx(min(link_tip, dims.core_bottom_level + dims.retainer_screw_depth), abs=1e-6)


@pytest.mark.parametrize("changes", [BEARING_BLOCKS, DRIVEN_BLOCKS], ids=["bearings", "driven"])
def test_volumes_and_inertias_of_milled_parts_count_their_points(changes: dict[str, float | str]) -> None:
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


def test_the_scale_has_dots_every_thirty_degrees_and_a_mark() -> None:
    dims = dimensions(design_of("scale", BEARINGS))
    is_dot = 0.5 * dims.scale_dot_diameter
    dots = [one for one in holes(drawn_part(dims, "adjuster")) if one.radius == pytest.approx(is_dot)]
    tang = atan2(*reversed(installed_coil(dims).tang_position))
    turns = sorted(round((degrees(atan2(one.y, one.x) - tang) % 360.0), 6) for one in dots)
    assert turns == pytest.approx([30.0 * index for index in range(2, 11)])
    assert min(hypot(one.x, one.y) for one in dots) > 0.5 * (dims.coil_diameter + dims.wire_diameter)
    assert all(one.top == pytest.approx(0.0) and one.bottom == pytest.approx(-0.4) for one in dots)
    marks = [one for one in holes(drawn_part(dims, "housing")) if one.radius == pytest.approx(is_dot)]
    assert len(marks) == dims.count("spring_count")
    for azimuth, (x, y) in zip(dims.azimuths("spring_count"), _in_order(marks), strict=True):
        assert (degrees(atan2(y, x) - azimuth) + 180.0) % 360.0 - 180.0 > 0.0


def test_dots_of_a_scale_leave_no_thin_wall() -> None:
    changes = {"preload_adjuster": "rotary", "coil_diameter": 6.1e-3, "wire_diameter": 1.1e-3}
    design = design_of("small scale", changes | {"adjuster_screw": "iso_4762_m2", "adjuster_screw_length": 6e-3})
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
    return sorted(((one.x, one.y) for one in marks), key=lambda at: atan2(at[1], at[0]) % 6.283185307179586)


CASES = {"keyed arc": ("shear", {}), "plain arc": ("shear", {"key_count": 0.0}), "block": ("compression", BLOCKS)}


def jig(name: str) -> tuple[Dimensions, str, dict[str, cq.Solid]]:
    mode, changes = CASES[name]
    dims = dimensions(design_of(name, changes, mode))
    kind = "pcl_arc" if mode == "shear" else "pcl_block"
    part = drawn_part(dims, kind)
    return dims, kind, {kind: part} | {piece: draw(dims, part).Solids()[0] for piece, draw in jigs.DRAWN.items()}


@pytest.mark.parametrize("name", CASES)
def test_the_jig_s_gap_and_room_are_the_part_s(name: str) -> None:
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


def test_lids_and_dams_that_do_not_fit_fail_their_checks() -> None:
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
MODULES: Mapping[str, tuple[str, Mapping[str, float | str]]] = {
    "two": ("shear", TWO),
    "four": ("shear", {}),
    "compression": ("compression", {"core_radius": 8.0 * MM, **TWO}),
}


@pytest.fixture(scope="module", params=[pytest.param("two", marks=pytest.mark.slow), "four", "compression"])
def design(request: pytest.FixtureRequest) -> Design:
    mode, overrides = MODULES[request.param]
    return design_of(request.param, overrides, mode)


@pytest.fixture(scope="module")
def dims(design: Design) -> Dimensions:
    return dimensions(design)


@pytest.fixture(scope="module")
def placed(dims: Dimensions) -> dict[str, cq.Solid]:
    return place(dims, drawn_parts(dims))


def test_pins_fill_their_holes_have_their_size_and_go_in_last(
    design: Design, placed: dict[str, cq.Solid], dims: Dimensions
) -> None:
    found = {check.name: check for check in size_checks(design, placed)}
    wanted = ("link_dowel_volume", "rotor_volume", "link_volume", "rotor_inertia", "parts_inertia", "module_mass")
    assert {name: found[name].ok for name in wanted} == dict.fromkeys(wanted, True)
    assert max(abs(found[name].value) for name in wanted[:4]) < 1e-9
    names = [name for name in placed if name.startswith("link_dowel")]
    assert len(names) == dims.count("dowels_fitted")
    kept = {name: placed[name] for name in placed if name in names or name.startswith(("rotor", "link"))}
    assert [check.name for check in interference_checks(kept, "here") if not check.ok] == []
    top = dims.link_bottom_level + dims.link_thickness
    for name in names:
        box = placed[name].BoundingBox()
        assert (box.zmax, box.zmin) == pytest.approx((top, top - dims.link_dowel_length))
        # Half a millimetre of room is left below each, in the core.
        below = cq.Vector(*placed[name].Center().toTuple()[:2], box.zmin - 0.25)
        assert not placed["rotor"].isInside(below)
        assert placed["rotor"].isInside(below - cq.Vector(0, 0, 0.5))
    order = [one.name for one in sequence(list(placed))]
    assert sorted(order) == sorted(placed)
    assert order.index("link") < order.index("link_screw_1") < order.index("link_dowel_1")


def test_pins_stand_between_the_screws_and_turn_with_the_link(dims: Dimensions) -> None:
    dowels = {"link_dowel": drawn_parts(dims)["link_dowel"]}
    still, turned = (fasteners.stand(dims, dowels, angle) for angle in (0.0, 0.1))
    for name, shape in still.items():
        a, b = shape.Center(), turned[name].Center()
        assert hypot(a.x, a.y) == pytest.approx(0.7 * dims.core_radius)
        azimuth = np.degrees(np.arctan2(a.y, a.x)) % 90.0
        assert min(azimuth, 90.0 - azimuth) == pytest.approx(0.0, abs=1e-6)
        assert (np.arctan2(b.y, b.x) - np.arctan2(a.y, a.x)) % (2.0 * np.pi) == pytest.approx(0.1)


def test_prints_and_drawings_leave_holes_to_be_reamed(
    dims: Dimensions, placed: dict[str, cq.Solid], design: Design
) -> None:
    for kind in ("rotor", "link"):
        reamed = link_dowels(dims)
        lying = as_printed(placed[kind], PRODUCTION[kind], 0.3, reamed)
        sign = -1.0 if PRODUCTION[kind].down == "top" else 1.0
        at = {(round(x, 6), round(sign * y, 6)) for x, y in reamed}
        kept = [one for one in holes(lying) if any(hypot(one.x - x, one.y - y) < 1e-4 for x, y in at)]
        assert [one.radius for one in kept] == pytest.approx([0.5 * dims.link_dowel_diameter] * len(reamed))
        screws = [one.radius for one in holes(lying) if one not in kept]
        assert all(abs(radius - 0.5 * dims.link_dowel_diameter) > 0.05 for radius in screws)
    for kind in ("rotor", "link"):
        seat = drawing_requirements(kind, dims, design.choices).seats[-1]
        assert (seat.fit, seat.size, seat.letter) == ("H7", pytest.approx(dims.link_dowel_diameter), "")
    hole = f"⌀{figure(dims.wire_diameter + 0.5)}: for bonding"  # rounded as everywhere on the drawing
    assert any(hole in note for note in drawing_requirements("housing", dims, design.choices).notes)
    loose = {**design.choices, "tang_hold": "hole"}
    assert not any("bonding" in note for note in drawing_requirements("housing", dims, loose).notes)


def test_the_bill_has_the_pins_and_the_adhesive(design: Design, dims: Dimensions, placed: dict[str, cq.Solid]) -> None:
    items = bill(design, {"tang_adhesive": "An epoxy"}, placed)
    extra = beside(design, {"tang_adhesive": "An epoxy"})
    pins = next(one for one in items if one.kind == "link_dowel")
    assert (pins.quantity, pins.made) == (dims.count("dowels_fitted"), False)
    (adhesive,) = (one for one in extra if one.kind == "tang_adhesive")
    assert adhesive.title == "An epoxy"
    assert adhesive.mass == pytest.approx(1e3 * design.value("tang_adhesive_mass"))
    assert b"tang_adhesive" in bill_csv([*items, *extra])


def test_screws_alone_and_loose_tangs_have_none_of_it() -> None:
    design = design_of("loose", {"link_fit": "clearance", "tang_hold": "hole"})
    dims = dimensions(design)
    assert "link_dowel" not in drawn_parts(dims)
    assert [one.kind for one in beside(design, {})] == [
        "polymer",
        "heater_adhesive",
        "thermistor",
        "polyimide_film",
        "wire_sleeve",
        "mount_screw",
    ]
    assert drawing_requirements("link", dims, design.choices).seats == []
    assert broken_rules(design_of("fitted", {})) == []
