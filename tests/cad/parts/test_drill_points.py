"""Blind holes of milled parts end in the point of a drill; those of prints end flat."""

from __future__ import annotations

from math import radians, tan

import cadquery as cq
import pytest
from cad_designs import BEARING_BLOCKS, DRIVEN_BLOCKS, design_of

from tvimdesign.cad.assembly.assembly import drawn_part, drawn_parts, place
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.inspection.size_checks import size_checks


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
