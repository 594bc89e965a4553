"""The solids against the model's rows, and against each other."""

from __future__ import annotations

import cadquery as cq
import pytest
from cad_designs import broken_rules, design_of

from tvimdesign.cad.assembly import build, drawn_parts
from tvimdesign.cad.checks import all_checks, interference_checks, size_checks
from tvimdesign.cad.dimensions import dimensions
from tvimdesign.cad.kinds import KINDS, kind_of
from tvimdesign.errors import GeometryError
from tvimdesign.study.design import Design


def test_the_cases_keep_the_rules(design: Design) -> None:
    assert broken_rules(design) == []


def test_every_part_is_one_valid_solid(design: Design) -> None:
    parts = build(design)
    assert {kind_of(name) for name in parts} == set(KINDS)
    for solid in parts.values():
        assert isinstance(solid, cq.Solid)
        assert solid.isValid()


def test_every_check_holds_at_rest_and_through_the_stroke(design: Design) -> None:
    dims = dimensions(design)
    steps: list[str] = []
    checks = all_checks(design, dims, drawn_parts(dims), steps.append)
    assert [check.text for check in checks if not check.ok] == []
    assert len([step for step in steps if step.startswith("interference")]) == 5
    sizes = {check.name: check.value for check in checks}
    for name in ("housing_volume", "rotor_volume", "link_volume", "retainer_volume", "pcl_arc_volume",
                 "peltier_pad_volume", "rotor_inertia", "link_inertia", "parts_inertia"):  # fmt: skip
        assert sizes[name] == pytest.approx(0.0, abs=1e-9)
    assert sizes["spring_right_volume"] == pytest.approx(0.0, abs=1e-3)
    assert sizes["module_mass"] == pytest.approx(0.0, abs=1e-3)
    assert sizes["envelope_diameter"] == pytest.approx(0.0, abs=1e-6)
    assert sizes["envelope_height"] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("row", ["housing_volume", "rotor_inertia", "spring_volume", "structure_density"])
def test_a_wrong_model_is_found(paper: Design, row: str) -> None:
    wrong = paper.model_copy(update={"values": paper.values | {row: 1.006 * paper.values[row]}})
    assert not all(check.ok for check in size_checks(wrong, build(paper)))


def test_a_leg_in_its_pin_is_found(paper: Design) -> None:
    parts = build(paper)
    ahead = build(paper, -0.02)["rotor"]  # the rotor winds the right-hand springs, which stay behind
    found = [check for check in interference_checks(parts | {"rotor": ahead}, "here") if not check.ok]
    assert {check.name for check in found} == {"rotor | spring_right_1 here", "rotor | spring_right_3 here"}


def test_a_core_in_the_way_of_the_legs_is_found() -> None:
    design = design_of("fat core", {"core_radius": 0.021, "leg_overhang": 0.02})
    assert "leg_core_gap" in broken_rules(design)
    found = [check for check in interference_checks(build(design), "at rest") if not check.ok]
    assert any(check.name.startswith("rotor | spring") for check in found)


@pytest.mark.parametrize(
    ("row", "value", "words"),
    [
        ("spring_count", 5.0, "even"),
        ("arc_count", 2.5, "whole number"),
        ("arc_span", 0.01, "housing: span"),
        ("rotor_radius", float("nan"), "rotor: rotor_radius is nan"),
    ],
)
def test_what_cannot_be_drawn_names_the_part(paper: Design, row: str, value: float, words: str) -> None:
    design = paper.model_copy(update={"values": paper.values | {row: value}})
    with pytest.raises(GeometryError, match=words):
        build(design)
