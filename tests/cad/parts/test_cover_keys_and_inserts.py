"""Solids of keys, cover, inserts, wave springs and lips: they fit where the quantities say, and mistakes are found."""

from collections.abc import Mapping
from math import cos, hypot, pi, sin
from typing import NamedTuple

import cadquery as cq
import pytest
from cad_designs import CASES, all_checks, broken_rules, design_of

from tvimdesign.cad.assembly.assembly import drawn_part, drawn_parts, place
from tvimdesign.cad.export.print_files import with_wider_holes
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.features import holes
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.geometry.solids import turned
from tvimdesign.cad.inspection.inspect import thread_checks
from tvimdesign.cad.inspection.milling import corner_checks, round_corners
from tvimdesign.cad.inspection.order import sequence
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.cad.parts import fasteners, fittings, shear_parts
from tvimdesign.study.design import Design

MM = 1e-3


@pytest.fixture(scope="module")
def design() -> Design:
    """Return printed, with keys, a cover and inserts everywhere but in posts."""
    return design_of(
        "covered",
        {"cover": "plate", "thread_insert": "heat_set", "retainer_screw_length": 12.0 * MM, "core_radius": 10.5 * MM},
    )


@pytest.fixture(scope="module")
def dims(design: Design) -> Dimensions:
    return dimensions(design)


@pytest.fixture(scope="module")
def drawn(dims: Dimensions) -> dict[str, cq.Solid]:
    kinds = ("housing", "rotor", "pcl_arc", "heater", "cover", "cover_screw", "cover_insert", "link_insert",
             "retainer_insert", "link_screw", "retainer_screw")  # fmt: skip
    return {kind: drawn_part(dims, kind) for kind in kinds}


def test_the_cover_keeps_the_least_wall_between_its_widened_holes():
    dims = dimensions(design_of("screwed", {"cover": "plate", "thread_insert": "none"}))
    printed = with_wider_holes(drawn_part(dims, "cover"), dims.hole_compensation)
    ahead = [hole for hole in holes(printed) if hole.x > 1.0 and abs(hole.x - hole.y) < 1.0]
    foot, screw = sorted(ahead, key=lambda hole: hole.x)
    assert dims.hole_compensation > 0.0
    wall = hypot(screw.x - foot.x, screw.y - foot.y) - foot.radius - screw.radius
    assert wall == pytest.approx(dims.minimum_wall + dims.cover_mount_gap)


def shared(placed: Mapping[str, cq.Shape], *kinds: str) -> dict[str, float]:
    """Return common volume of the pairs of parts of some kinds that share one [mm^3]."""
    solids = {name: shape.Solids()[0] for name, shape in placed.items()}

    def wanted(first: str, other: str) -> bool:
        return kind_of(first) in kinds or kind_of(other) in kinds

    return {check.name: check.value for check in interference_checks(solids, "here", wanted) if not check.ok}


def test_cover_and_inserts_are_as_large_as_their_rows_and_cut_nothing(design, dims, drawn):
    assert broken_rules(design) == []
    placed = {**fittings.stand(dims, drawn, 0.0), **fasteners.stand(dims, drawn, 0.0)}
    assert sum(name.startswith("cover_insert") for name in placed) == 4
    whole = {**placed, "housing": drawn["housing"], "rotor": drawn["rotor"]}
    assert shared(whole, "cover", "cover_screw", "cover_insert", "link_insert", "retainer_insert") == {}
    solids = {name: shape.Solids()[0] for name, shape in placed.items()}
    sizes = {check.name: check for check in size_checks(design, solids) if check.name.endswith("_volume")}
    assert set(sizes) == {f"{kind_of(name)}_volume" for name in placed}
    assert max(abs(check.value) for check in sizes.values()) < 1e-9


def test_a_cover_has_its_holes_and_is_found_where_it_is_too_tight(dims, drawn):
    numbers = {"count": 3.0, "radius": 0.0, "circle_radius": 30.0, "azimuth": 0.1}
    listed = {f"cover_hole_circles.2.{name}": value for name, value in numbers.items()}
    with_none = Dimensions("shear", {**dims.by_name, **listed, "cover_hole_circles.length": 3.0})
    assert len(with_none.holes("cover_hole_circles")) == 2
    vents = Dimensions("shear", {**with_none.by_name, "cover_hole_circles.2.radius": 1.0})
    plain, vented = (drawn_part(sizes, "cover") for sizes in (dims, vents))
    assert plain.Volume() - vented.Volume() == pytest.approx(3 * pi * dims.cover_height, rel=1e-9)
    first = cq.Vector(30.0 * cos(0.1), 30.0 * sin(0.1), dims.rim_level + 0.5 * dims.cover_height)
    assert plain.isInside(first)
    assert not vented.isInside(first)
    for row, value in (("cover_hole_radius", dims.core_radius - 0.5), ("rim_level", dims.pin_top_level - 0.5)):
        wrong = Dimensions("shear", {**dims.by_name, row: value})
        plate = {"cover": fittings.cover(wrong), "rotor": drawn["rotor"]}
        assert list(shared(plate, "cover")) == ["cover | rotor here"]


def test_keys_turn_with_the_rotor_and_would_be_cut_if_they_stood(dims, drawn):
    angle = dims.stroke
    rotor = turned(drawn["rotor"], angle)
    placed = {**shear_parts.stand(dims, drawn, angle), "rotor": rotor}
    assert shared(placed, "rotor") == {}
    standing = {"pcl_arc_1": turned(drawn["pcl_arc"], 0.25 * pi), "rotor": rotor}
    (cut,) = shared(standing, "rotor").values()
    # Three keys of 2.5 mm, moved by 33 mm x 0.104: further than they are thick, so all of each is in the plate.
    assert cut == pytest.approx(3 * 0.25 * pi * 2.5**2 * 2.8, rel=1e-3)


def test_a_screw_that_is_too_short_for_its_insert_is_found(dims, drawn):
    assert {check.part: check.level for check in thread_checks(dims, drawn)} == {
        "link_screw": "pass", "retainer_screw": "pass", "cover_screw": "pass",
    }  # fmt: skip
    short = Dimensions("shear", {**dims.by_name, "cover_screw_length": 4.0})
    screw = drawn_part(short, "cover_screw")
    bite = {check.part: check for check in thread_checks(dims, {**drawn, "cover_screw": screw})}["cover_screw"]
    assert (bite.level, bite.value) == ("warning", pytest.approx(2.5 / 2.0))  # 4 mm less a cover of 1.5 mm
    assert bite.limit == pytest.approx(2.0)


def test_a_cutter_comes_into_every_corner_of_a_milled_housing_with_a_cover():
    design = design_of("milled", {"cover": "plate", "process": "machine_6061", "corner_radius": 1.0 * MM})
    dims = dimensions(design)
    assert broken_rules(design) == []
    housing = drawn_part(dims, "housing")
    assert housing.Volume() * 1e-9 == pytest.approx(design.values["housing_volume"], rel=1e-8)
    checks = corner_checks("housing", housing, dims.corner_radius, dims.corner_depth_ratio)
    assert [check.text for check in checks if check.level != "pass"] == []
    beside = [corner for corner in round_corners(housing) if corner.radius == pytest.approx(dims.cover_corner_radius)]
    assert len(beside) == 8  # two beside each of four bosses
    assert {round(item.depth, 6) for item in beside} == {round(dims.rim_level, 6)}


SPRUNG = ("sprung", "sprung bearings", "sprung blocks")


class Sprung(NamedTuple):
    """A case with its solids in place, at rest."""

    case: str
    design: Design
    dims: Dimensions
    drawn: dict[str, cq.Solid]
    parts: dict[str, cq.Solid]


@pytest.fixture(scope="module", params=SPRUNG)
def sprung(request: pytest.FixtureRequest) -> Sprung:
    mode, overrides = CASES[request.param]
    design = design_of(request.param, overrides, mode)
    dims = dimensions(design)
    drawn = drawn_parts(dims)
    return Sprung(request.param, design, dims, drawn, place(dims, drawn))


def test_parts_around_a_wave_spring_fit_their_quantities(sprung):
    case, design, dims, drawn, parts = sprung
    assert broken_rules(design) == []
    for kind in ("housing", "rotor", "preload_spring"):
        assert drawn[kind].isValid()
        assert drawn[kind].Volume() * 1e-9 == pytest.approx(design.values[f"{kind}_volume"], rel=1e-9), kind
    assert all(check.ok for check in size_checks(design, parts))

    def near(first: str, other: str) -> bool:
        return "preload_spring" in {first, other}

    assert [check.text for check in interference_checks(parts, "at rest", near) if not check.ok] == []
    box = parts["preload_spring"].BoundingBox()
    # On the hub, or on the lip between the bearings, and below what it lifts.
    if case == "sprung bearings":
        assert box.zmax == pytest.approx(parts["bearing_outer_1"].BoundingBox().zmin, abs=1e-6)
        assert box.zmin == pytest.approx(dims.hub_top_level - dims.upper_seat_depth, abs=1e-6)
    else:
        assert box.zmax == pytest.approx(dims.rotor_bottom_level, abs=1e-6)
        assert box.zmin == pytest.approx(dims.hub_top_level, abs=1e-6)


@pytest.mark.slow
def test_every_check_holds_through_the_stroke(sprung):
    assert [check.text for check in all_checks(sprung.design, sprung.drawn) if not check.ok] == []


def test_parts_stand_frozen_with_room_to_rise_and_come_in_once(sprung):
    case, design, dims, _, parts = sprung
    growth = (1145.0 / 1070.0 - 1.0) * dims.pcl_thickness if design.mode == "shear" else 0.0
    if case == "sprung bearings":
        stop = dims.hub_bottom_level + dims.lower_seat_depth  # lower face of the lip
        assert stop - parts["bearing_outer_2"].BoundingBox().zmax == pytest.approx(growth, abs=1e-6)
        assert parts["rotor"].BoundingBox().zmin == pytest.approx(parts["retainer"].BoundingBox().zmax, abs=1e-6)
    else:
        assert dims.hub_bottom_level - parts["retainer"].BoundingBox().zmax == pytest.approx(growth, abs=1e-6)
    names = list(sprung.parts)
    order = [part.name for part in sequence(names, sprung.dims)]
    assert sorted(order) == sorted(names)
    seat, above = ("bearing_outer_1", "bearing_inner_1") if sprung.case == "sprung bearings" else ("rotor", "retainer")
    assert order.index("preload_spring") < order.index(seat) < order.index(above)


def test_lips_end_above_the_floor_and_wrong_springs_are_refused():
    dims, bare = (dimensions(design_of("lips", {"melt_lip": word})) for word in ("rings", "none"))
    lips = drawn_part(dims, "rotor").Volume() - drawn_part(bare, "rotor").Volume()
    inner = dims.pcl_inner_radius**2 - (dims.pcl_inner_radius - dims.rotor_rim) ** 2
    outer = (dims.pcl_outer_radius + dims.rotor_rim) ** 2 - dims.pcl_outer_radius**2
    assert lips == pytest.approx(pi * (inner + outer) * (1.0 - 0.4), rel=1e-6)
    sprung = CASES["sprung"][1]
    assert "preload_bore_gap" in broken_rules(design_of("small", {**sprung, "axial_preload": "wave_19x23"}))
    wide = broken_rules(design_of("wide", {**sprung, "axial_preload": "wave_25x29"}))
    assert {"preload_rim_gap", "preload_guide_margin"} <= set(wide)
