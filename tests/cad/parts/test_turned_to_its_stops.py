"""The drawn rotor turned to its stops: it meets them there, not before, and no leg has left its pin."""

import cadquery as cq
import pytest
from cad_designs import CASES, broken_rules, design_of

from tvimdesign.cad.assembly.assembly import drawn_part
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.solids import turned
from tvimdesign.cad.geometry.spring_solids import installed_coil, spring_solid
from tvimdesign.cad.inspection.inspect import setting_checks
from tvimdesign.cad.inspection.size_checks import bearing_checks, stop_checks
from tvimdesign.cad.parts import jigs


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
