"""Solids below a module: a torque sensor's flange, and a motor below the feet."""

from math import atan2, degrees, hypot

import pytest
from cad_designs import CASES, DRIVEN, FLANGE, ON_SENSOR, design_of

from tvimdesign.cad.assembly.assembly import build, drawn_part, drawn_parts
from tvimdesign.cad.drawing.drawing_requirements import drawing_requirements
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.features import holes
from tvimdesign.cad.geometry.kinds import KINDS, TURNING, kind_of
from tvimdesign.cad.inspection.inspect import module_checks, part_checks
from tvimdesign.cad.inspection.milling import corner_checks
from tvimdesign.cad.inspection.size_checks import _polar_moment, interference_checks


def test_sensors_have_their_pattern_below_module_and_motor() -> None:
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
    dims = dimensions(design_of("driven", ON_SENSOR))
    bottom = dims.motor_bottom_level
    found = [one for one in holes(drawn_part(dims, "motor_housing")) if one.bottom == pytest.approx(bottom)]
    pattern = [one for one in found if hypot(one.x, one.y) == pytest.approx(25.0)]
    assert sorted(one.radius for one in pattern) == [2.5, 2.5, 2.5, 2.5, 3.0]
    assert {round(one.top - bottom, 6) for one in pattern} == {6.0, 11.0}
    board = drawn_part(dims, "encoder_board").BoundingBox()
    assert board.zmin == pytest.approx(bottom + 6.4)
    asked = drawing_requirements("motor_housing", dims, {"making_method": "milled"})
    assert [one.about for one in asked.threads] == ["sensor's screws"]
    assert {"sensor's spigot", "sensor's pin"} <= {one.about for one in asked.seats}


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


@pytest.mark.parametrize("case", [DRIVEN, ON_SENSOR], ids=["alone", "on a sensor"])
def test_the_motor_s_hub_and_housing_weigh_what_the_table_gives(case: dict[str, float | str]) -> None:
    design = design_of("driven", case)
    dims = dimensions(design)
    for kind in ("motor_hub", "motor_housing", "motor_retainer"):
        solid = drawn_part(dims, kind)
        assert solid.Volume() * 1e-9 == pytest.approx(design.values[f"{kind}_volume"], rel=1e-9), kind


@pytest.mark.parametrize("process", ["print_petg", "machine_6061"])
def test_the_spokes_of_the_motor_s_hub_have_no_sharp_corner(process: str) -> None:
    design = design_of("driven", DRIVEN | {"process": process, "corner_radius": 1e-3})
    dims = dimensions(design)
    hub = drawn_part(dims, "motor_hub")
    assert hub.Volume() * 1e-9 == pytest.approx(design.values["motor_hub_volume"], rel=1e-9)
    checks = corner_checks("motor_hub", hub, dims.corner_radius, dims.corner_depth_ratio)
    assert [check.text for check in checks if check.level != "pass"] == []
    assert dims.motor_corner_radius == pytest.approx({"print_petg": 1.0, "machine_6061": 2.0}[process])  # 6 mm high


@pytest.mark.slow
@pytest.mark.parametrize("case", ["driven", "driven blocks"])
def test_a_motor_goes_together_in_order_and_its_screws_hold(case: str) -> None:
    mode, overrides = CASES[case]
    design = design_of(case, overrides, mode)
    dims = dimensions(design)
    drawn = drawn_parts(dims)
    found = {check.name: check for check in module_checks(design, dims, drawn)}
    assert [check.text for check in found.values() if check.level != "pass"] == []
    drivers = [f"mount_screw_{index + 1}: driver" for index in range(int(dims.spring_count))]
    assert {"motor_screw: driver", "motor_screw: thread", "mount_screw: thread", *drivers} <= set(found)
    for kind in ("motor_hub", "motor_housing", "motor_retainer"):
        failed = [check.text for check in part_checks(design, dims, kind, drawn[kind]) if check.level == "failure"]
        assert failed == [], kind


@pytest.mark.slow
def test_a_rotor_that_does_not_clear_its_stator_is_found() -> None:
    design = design_of("driven", DRIVEN)
    wide = design.model_copy(update={"values": design.values | {"motor_rotor_radius": 25.0e-3}})
    found = [check.name for check in interference_checks(build(wide), "at rest") if not check.ok]
    assert found == ["motor_rotor | motor_stator at rest"]


@pytest.mark.slow
@pytest.mark.parametrize("case", ["driven", "driven blocks"])
def test_what_the_motor_turns_has_the_inertia_of_its_solids(case: str) -> None:
    mode, overrides = CASES[case]
    design = design_of(case, overrides, mode)
    stands = {*TURNING, "motor_stator", "motor_housing", "encoder_board"}
    driven = {name: solid for name, solid in build(design).items() if kind_of(name) not in stands}
    about_axis = sum(
        design.values[KINDS[kind_of(name)].density] * _polar_moment(solid) * 1e-15 for name, solid in driven.items()
    )
    # Legs of springs reach in from their rings, and half of each bearing stands.
    assert design.values["driven_inertia"] == pytest.approx(about_axis, rel=0.01)
