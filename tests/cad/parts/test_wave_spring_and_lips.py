"""Solids of a module whose rotor follows the freezing layer: as large as their rows, in place, and put together in
order."""

from math import pi
from typing import NamedTuple

import cadquery as cq
import pytest
from cad_designs import CASES, all_checks, broken_rules, design_of

from tvimdesign.cad.assembly.assembly import drawn_part, drawn_parts, place
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.inspection.order import sequence
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.study.design import Design

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


def test_parts_around_a_wave_spring_fit_their_quantities(sprung: Sprung) -> None:
    case, design, dims, drawn, parts = sprung
    assert broken_rules(design) == []
    for kind in ("housing", "rotor", "preload_spring"):
        assert drawn[kind].isValid()
        assert drawn[kind].Volume() * 1e-9 == pytest.approx(design.values[f"{kind}_volume"], rel=1e-9), kind
    assert all(check.ok for check in size_checks(design, parts))

    def near(one: str, other: str) -> bool:
        return "preload_spring" in {one, other}

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
def test_every_check_holds_through_the_stroke(sprung: Sprung) -> None:
    assert [check.text for check in all_checks(sprung.design, sprung.drawn) if not check.ok] == []


def test_parts_stand_frozen_with_room_to_rise_and_come_in_once(sprung: Sprung) -> None:
    case, design, dims, _, parts = sprung
    growth = (1145.0 / 1070.0 - 1.0) * dims.pcl_thickness if design.mode == "shear" else 0.0
    if case == "sprung bearings":
        stop = dims.hub_bottom_level + dims.lower_seat_depth  # lower face of the lip
        assert stop - parts["bearing_outer_2"].BoundingBox().zmax == pytest.approx(growth, abs=1e-6)
        assert parts["rotor"].BoundingBox().zmin == pytest.approx(parts["retainer"].BoundingBox().zmax, abs=1e-6)
    else:
        assert dims.hub_bottom_level - parts["retainer"].BoundingBox().zmax == pytest.approx(growth, abs=1e-6)
    names = list(sprung.parts)
    order = [one.name for one in sequence(names)]
    assert sorted(order) == sorted(names)
    seat, above = ("bearing_outer_1", "bearing_inner_1") if sprung.case == "sprung bearings" else ("rotor", "retainer")
    assert order.index("preload_spring") < order.index(seat) < order.index(above)


def test_lips_end_above_the_floor_and_wrong_springs_are_refused() -> None:
    dims, bare = (dimensions(design_of("lips", {"melt_lip": word})) for word in ("rings", "none"))
    lips = drawn_part(dims, "rotor").Volume() - drawn_part(bare, "rotor").Volume()
    inner = dims.pcl_inner_radius**2 - (dims.pcl_inner_radius - dims.rotor_rim) ** 2
    outer = (dims.pcl_outer_radius + dims.rotor_rim) ** 2 - dims.pcl_outer_radius**2
    assert lips == pytest.approx(pi * (inner + outer) * (1.0 - 0.4), rel=1e-6)
    sprung = CASES["sprung"][1]
    assert "preload_bore_gap" in broken_rules(design_of("small", {**sprung, "axial_preload": "wave_19x23"}))
    wide = broken_rules(design_of("wide", {**sprung, "axial_preload": "wave_25x29"}))
    assert {"preload_rim_gap", "preload_guide_margin"} <= set(wide)
