"""Fits, distances, rays and samples on solids."""

from collections.abc import Mapping
from typing import Any

import cadquery as cq
import numpy as np
import pytest
from cad_designs import BLOCKS, TILES, VANE_TILES, broken_rules, design_of
from placed_solids import placed_solids
from sample_solids import box, one_solid

from tvimdesign.cad.assembly.assembly import MODULES, drawn_part
from tvimdesign.cad.assembly.bill_of_materials import beside
from tvimdesign.cad.export.mesh import Array, Instance, solid_mesh
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.geometry.solids import turned
from tvimdesign.cad.inspection.inspect import bought_checks, fit_checks
from tvimdesign.cad.inspection.rays import Triangles, samples
from tvimdesign.cad.inspection.size_checks import ROOM, PlacedBodies, interference_checks
from tvimdesign.cad.parts import shear_parts
from tvimdesign.study.design import Design

LINED = {"liner_material": "peek", "key_count": 0}
CASES: dict[str, tuple[str, Mapping[str, Any], list[str]]] = {
    "pads": ("shear", {}, ["heater"]), "milled": ("shear", {"process": "machine_6061"}, ["heater"]),
    "tiles": ("shear", TILES, ["heater", "spreader"]), "lined": ("shear", LINED, ["heater", "liner"]),
    "vanes": ("compression", BLOCKS, ["heater"]),
    "tiles in vanes": ("compression", VANE_TILES, ["heater", "spreader"]),
}  # fmt: skip


def placed(design: Design, dims: Dimensions) -> dict[str, cq.Solid]:
    kinds = [kind for kind in ("heater", "spreader", "liner") if kind in MODULES[design.mode].drawn(dims)]
    block = "pcl_arc" if design.mode == "shear" else "pcl_block"
    drawn = {kind: drawn_part(dims, kind) for kind in ("housing", "rotor", block, *kinds)}
    standing = MODULES[design.mode].stand_heaters(dims, drawn, 0.0)
    return {name: shape.Solids()[0] for name, shape in standing.items()} | {
        kind: drawn[kind] for kind in ("housing", "rotor")
    }


@pytest.mark.parametrize("case", CASES)
def test_parts_in_pockets_have_the_process_s_clearance_all_round(case):
    mode, changes, kinds = CASES[case]
    design = design_of(case, changes, mode)
    dims = dimensions(design)
    checks = list(fit_checks(dims, placed(design, dims)))
    assert [check.part for check in checks] == kinds
    assert all(check.ok for check in checks), [check.text for check in checks]
    if case in ("pads", "milled"):
        assert checks[0].value == pytest.approx(dims.slip_clearance, abs=1e-6)


def test_pads_that_are_wide_or_aside_do_not_go_in(monkeypatch):
    design = design_of("aside", {})
    dims = dimensions(design)
    there = placed(design, dims)
    there["heater_1"] = turned(there["heater_1"], 0.125 / dims.pcl_inner_radius)
    (check,) = fit_checks(dims, there)
    assert not check.ok
    assert check.value == pytest.approx(dims.slip_clearance - 0.125, abs=0.01)
    # A pocket just as wide as the pad.
    monkeypatch.setattr(shear_parts, "_pocket", shear_parts._pad)
    (check,) = fit_checks(dims, placed(design, dims))
    assert not check.ok
    assert check.value == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(
    ("rule", "changes"),
    [("pocket_web_margin", {"arc_span": 1.48, "minimum_wall": 3e-3}), ("pad_ledge", {"slip_clearance": 2e-3})],
)
def test_pockets_that_leave_too_little_floor_break_a_rule(rule, changes):
    assert rule in broken_rules(design_of("near", changes))


@pytest.mark.gate
def test_bought_parts_have_room_and_a_lead_in_the_floor_is_reported():
    dims = dimensions(design_of("tiles", TILES))
    kinds = ("housing", "heater", "heater_lead", "spreader", "pcl_arc", "thermal_cutout")
    solids = placed_solids(dims, kinds)
    checks = {check.part: check for check in bought_checks(dims, solids)}
    assert set(checks) == {"heater_lead", "thermal_cutout"}
    assert all(check.ok for check in checks.values()), [check.text for check in checks.values()]
    aside = solids["heater_lead_1"].moved(cq.Location(cq.Vector(0.0, 0.0, 2.0)))
    moved = {check.part: check for check in bought_checks(dims, {**solids, "heater_lead_1": aside})}
    assert not moved["heater_lead"].ok


@pytest.mark.parametrize(("mode", "away"), [("shear", (1.0, 0.0)), ("compression", (2.0, 0.0))])
def test_leads_of_pads_begin_on_them_and_leave_below(mode, away):
    design = design_of("pads", {"heater_module": "polyimide_foil_24v"} if mode == "shear" else {}, mode)
    dims = dimensions(design)
    polymer = "pcl_arc" if mode == "shear" else "pcl_block"
    solids = placed_solids(dims, ("housing", "heater", "heater_lead", "thermal_cutout", polymer))
    leads = {name: solid for name, solid in solids.items() if kind_of(name) == "heater_lead"}
    assert len(leads) == 2 * design.values["heater_count"]
    assert sum(lead.Volume() for lead in leads.values()) == pytest.approx(1e9 * design.values["lead_volume"], rel=1e-6)
    for lead in leads.values():
        pads = [solid for name, solid in solids.items() if kind_of(name) == "heater"]
        assert min(lead.distance(pad) for pad in pads) == pytest.approx(0.0, abs=1e-6)
        assert lead.BoundingBox().zmin < -dims.floor_thickness + 1e-6
    checks = {check.part: check for check in bought_checks(dims, solids)}
    assert all(check.ok for check in checks.values()), [check.text for check in checks.values()]
    moved = leads["heater_lead_1"].moved(cq.Location(cq.Vector(*away, 0.0)))
    (check,) = (
        check for check in bought_checks(dims, {**solids, "heater_lead_1": moved}) if check.part == "heater_lead"
    )
    assert not check.ok


def test_a_lead_too_thick_for_its_window_breaks_a_rule():
    narrow = design_of("narrow", {"window_ledge": 5.7e-3, "lead_diameter": 2.4e-3})
    assert narrow.values["lead_window_margin"] < 0.0
    dims = dimensions(narrow)
    solids = placed_solids(dims, ("housing", "heater", "heater_lead", "pcl_arc"))
    (check,) = bought_checks(dims, solids)
    assert check.value < 0.1


@pytest.mark.parametrize(("changes", "mode"), [({}, "shear"), (TILES, "shear"), ({}, "compression")])
def test_the_gap_pad_of_the_bill_reaches_from_the_heater_to_the_cut_out(changes, mode):
    design = design_of("fused", changes, mode)
    filled = ["pcl_block"] if mode == "compression" else ["pcl_arc", *(["spreader"] if changes else [])]
    solids = placed_solids(dimensions(design), ("housing", "heater", "thermal_cutout", *filled))
    cutout = solids["thermal_cutout"].BoundingBox()
    # A strip as wide as the body, from there up to the first heater above it.
    strip = cq.Workplane("XY").box(cutout.xlen, cutout.ylen, 20.0, centered=(True, True, False)).val()
    strip = strip.moved(cq.Location(cq.Vector(*cutout.center.toTuple()[:2], cutout.zmax)))
    above = [
        met.BoundingBox().zmin
        for name, solid in solids.items()
        if name.startswith("heater_") and (met := strip.intersect(solid)).Volume() > 0.0
    ]
    (title,) = (item.title for item in beside(design, {}) if item.kind == "gap_pad")
    thickness = float(title.split(" mm thick")[0].split()[-1])
    assert 0.0 <= thickness - (min(above) - cutout.zmax) < 0.5


def cylinder(radius: float, height: float = 10.0) -> cq.Solid:
    return cq.Solid.makeCylinder(radius, height)


def at(solid: cq.Solid, x: float) -> Instance:
    matrix = np.eye(4)
    matrix[0, 3] = x
    return Instance(solid_mesh(solid), matrix)


@pytest.mark.parametrize(
    ("gap", "apart"), [(-1.0, False), (0.0, False), (0.5 * ROOM, False), (1.5 * ROOM, True), (5.0, True)]
)
def test_parts_are_apart_if_their_meshes_are_further_than_their_error(gap, apart):
    placed = {"rotor": at(cylinder(5.0), 0.0), "cover": at(cylinder(5.0), 10.0 + gap)}
    assert PlacedBodies(placed).apart("rotor", "cover") == apart


def test_parts_are_apart_by_bores_copies_and_closed_meshes():
    placed = {"housing": at(cylinder(20.0, 30.0), 0.0), "link_dowel_1": at(cylinder(2.0).translate((0, 0, 10.0)), 0.0)}
    assert not PlacedBodies(placed).apart("housing", "link_dowel_1")
    bored = cylinder(20.0, 30.0).cut(cylinder(3.0, 30.0)).Solids()[0]
    placed = {"housing": at(bored, 0.0), "link_screw_1": at(cylinder(2.0, 30.0), 0.0)}
    assert PlacedBodies(placed).apart("housing", "link_screw_1")
    broken = at(cylinder(5.0), 50.0)
    open_mesh = Instance(type(broken.mesh)(broken.mesh.vertices, broken.mesh.faces[1:]), broken.matrix)
    assert not PlacedBodies({"housing": at(cylinder(5.0), 0.0), "cover": open_mesh}).apart("housing", "cover")
    places = {"housing": 0.0, "pcl_arc_1": 10.0, "pcl_arc_2": 50.0}
    bodies = PlacedBodies({name: at(cylinder(5.0), place) for name, place in places.items()})
    assert not bodies.apart("housing", "pcl_arc_1")
    assert not bodies.apart("housing", "pcl_arc_2")


def test_only_parts_that_may_meet_are_compared_with_the_same_result():
    ring = cylinder(20.0, 30.0).cut(cylinder(3.0, 30.0)).Solids()[0]
    solids = {"housing": ring, "link_screw_1": cylinder(2.0, 30.0), "rotor": cylinder(3.5, 30.0)}
    bodies = PlacedBodies({name: at(solid, 0.0) for name, solid in solids.items()})
    compared: list[tuple[str, str]] = []

    def apart(first: str, second: str) -> bool:
        compared.append((first, second))
        return bodies.apart(first, second)

    plain, quick = (list(interference_checks(solids, "at rest", **more)) for more in ({}, {"apart": apart}))
    assert plain == quick
    assert [check.ok for check in quick] == [True, False, False, True]
    assert len(compared) == 3


@pytest.mark.parametrize("cut", [None, 1, 2, 3])
def test_the_copy_that_cuts_a_part_is_found_among_all(cut):
    solids = {"housing": cylinder(20.0)}
    for number in (1, 2, 3):
        x, y = 25.0 * np.cos(2.0 * number), 25.0 * np.sin(2.0 * number)
        nearer = 0.9 if number == cut else 1.0  # the others touch it along a line
        solids[f"pcl_arc_{number}"] = cylinder(5.0).translate((float(nearer * x), float(nearer * y), 0.0))
    checks = {check.name: check for check in interference_checks(solids, "at rest")}
    for number in (1, 2, 3):
        check = checks[f"housing | pcl_arc_{number} at rest"]
        assert check.ok == (number != cut)
        alone = solids["housing"].intersect(solids[f"pcl_arc_{number}"]).Volume()
        assert check.value == pytest.approx(alone, rel=1e-9)


def test_rays_meet_a_box_where_its_faces_are():
    half = np.array([7.0, 4.0, 2.5])
    triangles = Triangles(solid_mesh(one_solid(cq.Workplane().box(*(2.0 * half)))))
    draw = np.random.default_rng(1)
    origins = draw.uniform(-0.99, 0.99, (500, 3)) * half
    directions = draw.normal(size=(500, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    hits = triangles.first_hits(origins, directions)
    expected = np.min((np.sign(directions) * half - origins) / directions, axis=1)
    assert hits.distance == pytest.approx(expected, abs=1e-9)
    outside = triangles.first_hits(origins + np.array([30.0, 0.0, 0.0]), np.tile([1.0, 0.0, 0.0], (500, 1)))
    assert outside.missed.all()


@pytest.mark.gate
def test_rays_meet_what_every_triangle_held_against_every_ray_says():
    work = box(23.0, 11.0, 5.0).faces(">Z").workplane().hole(6.0).edges("|Z").fillet(2.0)
    triangles = Triangles(solid_mesh(one_solid(work)))
    draw = np.random.default_rng(7)
    origins = draw.uniform(-1.2, 1.2, (400, 3)) * [11.5, 5.5, 2.5]
    directions = draw.normal(size=(400, 3))
    directions[:120] = np.sign(directions[:120]) * np.eye(3)[draw.integers(0, 3, 120)]
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    hits = triangles.first_hits(origins, directions, beyond=0.5)
    expected = np.array([
        min((far for corners in triangles.corners if (far := _along(origin, way, corners)) > 0.5), default=np.inf)
        for origin, way in zip(origins, directions, strict=True)
    ])  # fmt: skip
    assert np.isfinite(expected).sum() > 150
    assert np.isinf(expected).sum() > 50
    assert hits.distance == pytest.approx(expected, abs=1e-9)
    assert np.all((hits.triangle == -1) == hits.missed)
    met = ~hits.missed
    again = [
        _along(origin, way, triangles.corners[index])
        for origin, way, index in zip(origins[met], directions[met], hits.triangle[met], strict=True)
    ]
    assert again == pytest.approx(expected[met], abs=1e-9)


def _along(origin: Array, way: Array, corners: Array) -> float:
    """Return the distance to a triangle, by Cramer's rule."""
    sides = np.stack((-way, corners[1] - corners[0], corners[2] - corners[0]), axis=1)
    if abs(np.linalg.det(sides)) < 1e-12:
        return np.inf
    far, u, v = np.linalg.solve(sides, origin - corners[0])
    return float(far) if u >= -1e-7 and v >= -1e-7 and u + v <= 1.0 + 1e-7 else np.inf


def test_no_point_of_the_surface_is_further_from_a_sample_than_the_spacing():
    triangles = Triangles(solid_mesh(one_solid(box(23.0, 11.0, 5.0))))
    points = samples(triangles, 1.5)
    assert points.area.sum() == pytest.approx(2.0 * (23.0 * 11.0 + 23.0 * 5.0 + 11.0 * 5.0))
    places = np.random.default_rng(2).uniform(-0.5, 0.5, (300, 2)) * [23.0, 11.0]
    top = points.point[points.normal[:, 2] > 0.9][:, :2]
    away = np.linalg.norm(places[:, None, :] - top[None, :, :], axis=2).min(axis=1)
    assert away.max() < 1.5
