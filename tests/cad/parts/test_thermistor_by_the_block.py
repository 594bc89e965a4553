"""The thermistor at the outer end of a pad or spreader in a vane: touching it, over its hole, counted, with rules."""

from __future__ import annotations

from collections.abc import Mapping

import cadquery as cq
import pytest
from cad_designs import BLOCKS, VANE_TILES, broken_rules, design_of

from tvimdesign.cad.assembly.assembly import drawn_part
from tvimdesign.cad.assembly.assembly_note import steps_of
from tvimdesign.cad.assembly.module_parts import MODULES
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.study.design import Design

BEAD = {"thermistor_diameter": 0.8e-3, "thermistor_length": 2.5e-3}


def standing(design: Design) -> dict[str, cq.Solid]:
    dims = dimensions(design)
    kinds = ["housing", "peltier_pad", "pcl_block", "thermistor", *(["spreader"] if dims.spreader_depth else [])]
    drawn = {kind: drawn_part(dims, kind) for kind in kinds}
    placed = {name: one.Solids()[0] for name, one in MODULES["compression"].stand_heaters(dims, drawn, 0.0).items()}
    return {"housing": drawn["housing"], **placed}


@pytest.mark.parametrize(("changes", "touched"), [(BLOCKS, "peltier_pad_1"), (VANE_TILES, "spreader_1")])
def test_it_touches_what_heats_the_block_and_cuts_nothing(changes: Mapping[str, float | str], touched: str) -> None:
    design = design_of("bead", {**changes, **BEAD}, "compression")
    placed, dims = standing(design), dimensions(design)
    assert broken_rules(design) == []
    bead = placed["thermistor_1"]
    assert bead.distance(placed[touched]) == pytest.approx(0.0, abs=1e-6)
    assert min(bead.distance(one) for name, one in placed.items() if name.startswith("pcl_block")) < 0.5
    assert [check.text for check in interference_checks(placed, "here") if not check.ok] == []
    named = {"housing_volume", "housing_inertia", "thermistor_volume"}
    sizes = [check for check in size_checks(design, placed) if check.name in named]
    assert len(sizes) == 3
    assert all(check.ok for check in sizes), [check.text for check in sizes]
    below = cq.Solid.makeCylinder(0.5 * dims.thermistor_diameter, 20.0, bead.Center() - cq.Vector(0, 0, 21.3))
    assert below.intersect(placed["housing"]).Volume() == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(
    ("rule", "changes"),
    [
        ("thermistor_rim_gap", {"rotor_rim": 0.5e-3}),
        ("thermistor_height_gap", {"thermistor_length": 14e-3}),
        ("thermistor_end_gap", {"peltier_thickness": 0.3e-3}),
        ("thermistor_hole_gap", {"placement_radius": 31e-3, "vane_count": 3}),
    ],
)
def test_a_bead_without_room_breaks_a_rule(rule: str, changes: dict[str, float]) -> None:
    assert rule in broken_rules(design_of("tight", {**BLOCKS, **BEAD, **changes}, "compression"))
    bare = {name: value for name, value in changes.items() if "thermistor" not in name}
    assert rule not in broken_rules(design_of("none", {**BLOCKS, **bare}, "compression"))


def test_the_note_places_it_and_glues_nothing_into_the_slot() -> None:
    texts = [step["text"] for step in steps_of({"housing", "peltier_pad", "pcl_block", "thermistor"})]
    assert sum("outer end of the first vane" in text for text in texts) == 1
    assert not any("thermistor of the bill" in text for text in texts)
