"""Solids of a motor below the feet, and the drawn rotor turned to its stops."""

import cadquery as cq
import pytest
from cad_designs import CASES, DRIVEN, broken_rules, design_of

from tvimdesign.cad.assembly.assembly import build, drawn_part, drawn_parts
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.kinds import KINDS, TURNING, kind_of
from tvimdesign.cad.geometry.solids import turned
from tvimdesign.cad.geometry.spring_solids import installed_coil, spring_solid
from tvimdesign.cad.inspection.inspect import module_checks, part_checks, setting_checks
from tvimdesign.cad.inspection.milling import corner_checks
from tvimdesign.cad.inspection.size_checks import _polar_moment, bearing_checks, interference_checks, stop_checks
from tvimdesign.cad.parts import jigs


def test_the_motor_s_hub_and_housing_weigh_what_the_table_gives() -> None:
    design = design_of("driven", DRIVEN)
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


@pytest.mark.parametrize(
    "case", ["wrist", *(pytest.param(case, marks=pytest.mark.gate) for case in ("odd blocks", "bearings among blocks"))]
)
def test_the_rotor_meets_its_stops_at_their_angle(case: str) -> None:
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
def test_a_fork_holds_the_rotor_at_rest(case: str) -> None:
    mode, overrides = CASES[case]
    dims = dimensions(design_of(case, overrides, mode))
    solids = {kind: drawn_part(dims, kind) for kind in ("housing", "rotor")}
    solids[jigs.FORK] = jigs.fork(dims).Solids()[0]
    assert solids[jigs.FORK].isValid()
    assert [check.text for check in setting_checks(dims, solids) if not check.ok] == []


def test_a_leg_lies_on_its_pin_at_either_stop() -> None:
    mode, overrides = CASES["wrist"]
    dims = dimensions(design_of("wrist", overrides, mode))
    rotor = drawn_part(dims, "rotor")
    for angle in (dims.stop_angle, -dims.stop_angle):
        spring = spring_solid(installed_coil(dims, angle)).translate(cq.Vector(dims.placement_radius, 0.0, 0.0))
        assert turned(rotor, angle).distance(spring) == pytest.approx(0.0, abs=1e-3), angle
