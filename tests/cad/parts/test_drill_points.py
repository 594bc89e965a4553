"""Drill points of blind holes and dots of scales, and the closed jig around the parts that are cast in it."""

from math import atan2, degrees, hypot, radians, sin, tan

import cadquery as cq
import pytest
from cad_designs import BEARING_BLOCKS, BEARINGS, BLOCKS, DRIVEN_BLOCKS, design_of
from sample_solids import of

from tvimdesign.cad.assembly.assembly import drawn_part, drawn_parts, place
from tvimdesign.cad.export.mesh import solid_mesh
from tvimdesign.cad.export.print_files import with_wider_holes
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.features import Cylinder, holes
from tvimdesign.cad.geometry.spring_solids import installed_coil
from tvimdesign.cad.inspection.inspect import casting_checks, casting_gap, part_checks
from tvimdesign.cad.inspection.rays import Triangles, wall_checks
from tvimdesign.cad.inspection.size_checks import size_checks
from tvimdesign.cad.parts import jigs


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
