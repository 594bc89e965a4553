"""What a module stands on or is driven by: the solids of a torque sensor's flange."""

from __future__ import annotations

from math import atan2, degrees, hypot

import pytest
from cad_designs import CASES, FLANGE, design_of

from tvimdesign.cad.assembly import drawn_part
from tvimdesign.cad.assembly_note import assembly_note
from tvimdesign.cad.bom import Item
from tvimdesign.cad.dimensions import dimensions
from tvimdesign.cad.features import holes
from tvimdesign.cad.inspection.inspect import part_checks


def test_the_pattern_stands_at_its_azimuth_with_the_pin_midway_between_two_screws() -> None:
    dims = dimensions(design_of("flange", {**FLANGE, "flange_azimuth": 0.3}))
    ground = -dims.floor_thickness - dims.foot_height
    found = [one for one in holes(drawn_part(dims, "housing")) if abs(hypot(one.x, one.y) - 20.0) < 1e-3]
    screws = [one for one in found if one.radius == pytest.approx(2.5)]
    turned = sorted(degrees(atan2(one.y, one.x)) % 360.0 for one in screws)
    assert turned == pytest.approx([degrees(0.3) + 90.0 * index for index in range(4)], abs=1e-3)
    assert [one.bottom for one in screws] == pytest.approx(4 * [ground])
    assert [one.top for one in screws] == pytest.approx(4 * [ground + 11.0])
    (pin,) = [one for one in found if one.radius == pytest.approx(3.0)]
    assert degrees(atan2(pin.y, pin.x)) == pytest.approx(degrees(0.3) + 45.0, abs=1e-3)
    assert (pin.bottom, pin.top) == pytest.approx((ground, ground + 6.0))


@pytest.mark.slow
@pytest.mark.parametrize("case", ["flange", "flange among blocks"])
def test_a_housing_with_a_flange_can_be_made_by_its_process(case: str) -> None:
    mode, overrides = CASES[case]
    design = design_of(case, overrides, mode)
    dims = dimensions(design)
    found = part_checks(design, dims, "housing", drawn_part(dims, "housing"))
    assert [check.text for check in found if check.level == "failure"] == []
    # What any housing is warned of: the floor over its feet when printed, its feet at the skirt when milled.
    assert {check.name for check in found if check.level == "warning"} <= {"housing: overhang", "housing: edge"}


@pytest.mark.parametrize(
    ("flange", "words"), [(True, "Centre the torque sensor"), (False, "Fix the module by the 4 holes")]
)
def test_the_note_says_what_bears_the_module(flange: bool, words: str) -> None:
    design = design_of("flange", FLANGE if flange else {})
    housing = Item("housing", 1, True, "petg", "PETG", 1.0, ())
    note = assembly_note(design, dimensions(design), [housing]).decode()
    (step,) = [line for line in note.splitlines() if line[:1].isdigit()]
    assert words in step
