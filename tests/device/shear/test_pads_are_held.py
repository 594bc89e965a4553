"""Load of the adhesive under the pads while the layer freezes, and its place in assembly and bill."""

from __future__ import annotations

from typing import Any

import pytest
from cad_designs import TILES, design_of

from tvimdesign.cad.assembly.bill_of_materials import beside
from tvimdesign.device import table_for
from tvimdesign.study import given, read_study_text

ROWS = ["ledge_tension", "freezing_traction", "pcl_area", "pcl_bond_strength"]


def found(**module: Any) -> dict[str, float]:
    inputs = given(read_study_text("mode: shear\n", "a test").model_copy(update={"module": module}))
    values = table_for("shear").evaluate(inputs, ROWS)
    return {name: float(value) for name, value in values.items()} | {"bond": inputs["pcl_bond_strength"]}


def test_the_pull_of_the_layer_comes_to_the_ledges() -> None:
    # Four arcs of 0.3 to ...: the ledge is 2 mm wide around each, its corners left out of the count.
    free = found(axial_preload="wave_21x25")
    inputs = given(read_study_text("mode: shear\n", "a test"))
    inner, outer, span, ledge = (
        inputs[name] for name in ("pcl_inner_radius", "pcl_outer_radius", "arc_span", "window_ledge")
    )
    whole = 0.5 * span * (outer**2 - inner**2)
    window = 0.5 * (span - 2.0 * ledge / inner) * ((outer - ledge) ** 2 - (inner + ledge) ** 2)
    share = whole / (whole - window)
    pull = min(free["freezing_traction"], free["bond"])
    assert free["ledge_tension"] == pytest.approx(pull * share, rel=0.01)
    held = found(pcl_thickness=2e-3)
    assert held["ledge_tension"] <= held["bond"] * share * 1.01


def test_the_bill_has_adhesive_or_grease_for_pads() -> None:
    def kinds(mode: str, changes: dict[str, Any]) -> list[str]:
        return [one.kind for one in beside(design_of("held", changes, mode), {})]

    assert "heat_conducting_adhesive" in kinds("shear", {})
    assert kinds("shear", TILES).count("heat_conducting_adhesive") == 1
    assert "thermal_grease" not in kinds("shear", {})
    assert "thermal_grease" in kinds("compression", {})
