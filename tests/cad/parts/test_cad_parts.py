"""The solids against the model's rows, and against each other."""

from math import radians

import cadquery as cq
import pytest
from cad_designs import CASES, all_checks, broken_rules, design_of

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import MODULES, build, drawn_parts
from tvimdesign.cad.export.mesh import solid_mesh
from tvimdesign.cad.export.print_files import closed
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.study.design import Design


def test_the_cases_keep_the_rules_in_valid_solids(design: Design) -> None:
    assert broken_rules(design) == []
    parts = build(design)
    assert {kind_of(name) for name in parts} == set(MODULES[design.mode].kinds(dimensions(design)))
    for solid in parts.values():
        assert isinstance(solid, cq.Solid)
        assert solid.isValid()


SIZED = {
    **{name: CASES[name] for name in ("paper", "blocks", "bearings", "bearings among blocks", "driven")},
    "three arcs": ("shear", {
        "arc_count": 3, "arc_span": 1.3, "spring_pairs": 3, "wire_diameter": 1.8e-3, "coil_diameter": 17e-3,
        "key_count": 5, "key_diameter": 4e-3, "pcl_inner_radius": 24e-3, "pcl_outer_radius": 41e-3,
        "floor_thickness": 5e-3, "core_radius": 8e-3, "link_dowel": "iso_8734_2", "link_thickness": 6e-3,
        "preload_angle": 0.4, "pcl_thickness": 1.6e-3,
    }),
    "tall vanes": ("compression", {
        "vane_count": 4, "block_height": 13e-3, "block_depth": 4e-3, "vane_thickness": 3e-3, "slot_share": 0.6,
        "core_radius": 8e-3, "link_dowel": "iso_8734_2", "pcl_inner_radius": 13e-3, "pcl_outer_radius": 24e-3,
        "rotor_rim": 8e-3, "coil_diameter": 12e-3, "coil_count": 7.5, "running_clearance": 0.6e-3,
        "floor_thickness": 5e-3, "spring_pairs": 3,
    }),
}  # fmt: skip
# Springs to what the kernel sweeps a wire to; the housing's holes and corners count at one radius in its inertia.
WITHIN = {"spring_right_volume": 1e-5, "spring_left_volume": 1e-5, "module_mass": 2e-6, "housing_inertia": 1e-3,
          "motor_hub_inertia": 1e-6}  # fmt: skip


@pytest.mark.parametrize("name", SIZED)
def test_volumes_and_inertias_are_those_of_the_kernel(name: str) -> None:
    mode, changes = SIZED[name]
    design = design_of(name, changes, mode)
    for check in size_checks(design, build(design)):
        assert abs(check.value) < WITHIN.get(check.name, 1e-9), check.text


@pytest.mark.slow
def test_every_check_holds_at_rest_and_through_the_stroke(design: Design) -> None:
    dims = dimensions(design)
    steps: list[str] = []
    checks = all_checks(design, drawn_parts(dims), steps.append)
    assert [check.text for check in checks if not check.ok] == []
    assert len([step for step in steps if step.startswith("interference")]) == 5
    sizes = {check.name: check.value for check in checks}
    drawn = [f"{kind}_volume" for kind in MODULES[design.mode].drawn(dims)]
    for name in (*drawn, "rotor_inertia", "link_inertia", "parts_inertia"):
        assert sizes[name] == pytest.approx(0.0, abs=1e-9)
    # The kernel sweeps a wire to 3e-6 of its volume.
    assert sizes["spring_right_volume"] == pytest.approx(0.0, abs=1e-5)
    assert sizes["spring_left_volume"] == pytest.approx(0.0, abs=1e-5)
    assert sizes["module_mass"] == pytest.approx(0.0, abs=1e-6)
    assert sizes["envelope_diameter"] == pytest.approx(0.0, abs=1e-6)
    assert sizes["envelope_height"] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("row", ["housing_volume", "rotor_inertia", "spring_volume", "structure_density"])
def test_a_wrong_model_is_found(paper: Design, row: str) -> None:
    wrong = paper.model_copy(update={"values": paper.values | {row: 1.0002 * paper.values[row]}})
    assert not all(check.ok for check in size_checks(wrong, build(paper)))


def with_rotor(one: str, other: str) -> bool:
    """Return the pairs with the rotor: booleans of all pairs take three times as long."""
    return "rotor" in (one, other)


def test_legs_pins_and_cores_in_the_way_are_found(paper: Design) -> None:
    parts = build(paper)
    ahead = build(paper, -0.02)["rotor"]  # the rotor winds the right-hand springs, which stay behind
    found = [check for check in interference_checks(parts | {"rotor": ahead}, "here", with_rotor) if not check.ok]
    springs = {check.name for check in found if "spring" in check.name}
    assert springs == {"rotor | spring_right_1 here", "rotor | spring_right_3 here"}
    design = design_of("fat core", {"core_radius": 0.021, "leg_overhang": 0.02})
    assert "leg_core_gap" in broken_rules(design)
    found = [check for check in interference_checks(build(design), "at rest", with_rotor) if not check.ok]
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


@pytest.mark.parametrize(
    "overrides",
    [
        # Vertices that rounding to a millionth of a millimetre splits: 24.409863 mm sin 30 deg, and 19.1828805 + 2 mm.
        {"wire_diameter": 1.63299783e-3, "coil_diameter": 14.4195471e-3, "coil_count": 6.98764356,
         "placement_radius": 46.8342295e-3, "core_radius": 15.4269817e-3, "link_thickness": 3.34797794e-3,
         "pcl_inner_radius": 21.1112372e-3, "pcl_outer_radius": 26.409863e-3, "arc_span": radians(42.5021918),
         "pcl_thickness": 1.31773805e-3, "preload_angle": 0.323144964, "spring_pairs": 3, "arc_count": 4},
        {"wire_diameter": 1.65787036e-3, "coil_diameter": 31.2027823e-3, "coil_count": 5.13113728,
         "placement_radius": 55.0633984e-3, "core_radius": 13.6670048e-3, "link_thickness": 3.48622919e-3,
         "pcl_inner_radius": 19.1828805e-3, "pcl_outer_radius": 33.6000928e-3, "arc_span": radians(77.4763998),
         "pcl_thickness": 1.74894889e-3, "preload_angle": 0.18294328, "spring_pairs": 1, "arc_count": 3},
    ],
)  # fmt: skip
def test_meshes_close_where_rounding_splits_their_vertices(overrides: dict[str, float]) -> None:
    dims = dimensions(design_of("split", overrides))
    for name, solid in drawn_parts(dims).items():
        assert closed(name, solid_mesh(solid)).is_watertight


@pytest.mark.parametrize(("process", "radius"), [("print_petg", 0.2), ("machine_6061", 1.5)])
def test_pockets_and_windows_have_the_corners_the_process_leaves(process: str, radius: float) -> None:
    design = design_of("corners", {"process": process})
    housing = build(design)["housing"]
    corners = [face for face in housing.Faces() if face.geomType() == "CYLINDER" and face.Area() < 12.0]
    radii = [face._geomAdaptor().Cylinder().Radius() for face in corners]
    # Four arcs, each with a pocket and a window of four corners.
    assert len([found for found in radii if found == pytest.approx(radius, rel=1e-6)]) == 32
    assert not [check for check in size_checks(design, build(design)) if not check.ok]


def test_parts_that_cut_each_other_are_told_with_volume_and_place() -> None:
    block, other = cq.Solid.makeBox(10, 10, 10), cq.Solid.makeBox(10, 10, 10, cq.Vector(8, 6, -4))
    cut, _ = interference_checks({"housing": block, "rotor": other}, "here")
    assert not cut.ok
    assert (cut.part, cut.unit) == ("housing, rotor", "mm³")
    assert cut.value == pytest.approx(2.0 * 4.0 * 6.0)
    assert cut.place == pytest.approx((9.0, 8.0, 3.0))
