"""Parts in pockets go in: gaps measured on the solids, and pockets of the pad's own outline are found."""

from collections.abc import Mapping
from typing import Any

import cadquery as cq
import pytest
from cad_designs import BLOCKS, TILES, VANE_TILES, broken_rules, design_of
from placed_solids import placed_solids

from tvimdesign.cad.assembly.assembly import MODULES, drawn_part
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.solids import turned
from tvimdesign.cad.inspection.inspect import bought_checks, fit_checks
from tvimdesign.cad.parts import shear_parts
from tvimdesign.study.design import Design

LINED = {"liner_material": "peek", "key_count": 0}
CASES: dict[str, tuple[str, Mapping[str, Any], list[str]]] = {
    "pads": ("shear", {}, ["heater"]), "milled": ("shear", {"process": "machine_6061"}, ["heater"]),
    "tiles": ("shear", TILES, ["heater", "spreader"]), "lined": ("shear", LINED, ["heater", "liner"]),
    "vanes": ("compression", BLOCKS, ["heater"]),
    "tiles in vanes": ("compression", VANE_TILES, ["heater", "spreader"]),
}  # fmt: skip


def placed(design: Design, dims: Dimensions) -> dict[str, cq.Solid]:
    kinds = [kind for kind in ("heater", "spreader", "liner") if kind in MODULES[design.mode].drawn(dims)]
    block = "pcl_arc" if design.mode == "shear" else "pcl_block"
    drawn = {kind: drawn_part(dims, kind) for kind in ("housing", "rotor", block, *kinds)}
    standing = MODULES[design.mode].stand_heaters(dims, drawn, 0.0)
    return {name: shape.Solids()[0] for name, shape in standing.items()} | {
        kind: drawn[kind] for kind in ("housing", "rotor")
    }


@pytest.mark.parametrize("case", CASES)
def test_parts_in_pockets_have_the_process_s_clearance_all_round(case: str) -> None:
    mode, changes, kinds = CASES[case]
    design = design_of(case, changes, mode)
    dims = dimensions(design)
    checks = list(fit_checks(dims, placed(design, dims)))
    assert [check.part for check in checks] == kinds
    assert all(check.ok for check in checks), [check.text for check in checks]
    if case in ("pads", "milled"):
        assert checks[0].value == pytest.approx(dims.slip_clearance, abs=1e-6)


def test_pads_that_are_wide_or_aside_do_not_go_in(monkeypatch: pytest.MonkeyPatch) -> None:
    design = design_of("aside", {})
    dims = dimensions(design)
    there = placed(design, dims)
    there["heater_1"] = turned(there["heater_1"], 0.125 / dims.pcl_inner_radius)
    (check,) = fit_checks(dims, there)
    assert not check.ok
    assert check.value == pytest.approx(dims.slip_clearance - 0.125, abs=0.01)
    # A pocket just as wide as the pad.
    monkeypatch.setattr(shear_parts, "_pocket", shear_parts._pad)
    (check,) = fit_checks(dims, placed(design, dims))
    assert not check.ok
    assert check.value == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(
    ("rule", "changes"),
    [("pocket_web_margin", {"arc_span": 1.48, "minimum_wall": 3e-3}), ("pad_ledge", {"slip_clearance": 2e-3})],
)
def test_pockets_that_leave_too_little_floor_break_a_rule(rule: str, changes: dict[str, float]) -> None:
    assert rule in broken_rules(design_of("near", changes))


def test_bought_parts_have_room_and_a_lead_in_the_floor_is_reported() -> None:
    dims = dimensions(design_of("tiles", TILES))
    kinds = ("housing", "heater", "heater_lead", "spreader", "pcl_arc", "thermal_cutout")
    solids = placed_solids(dims, kinds)
    checks = {check.part: check for check in bought_checks(solids)}
    assert set(checks) == {"heater_lead", "thermal_cutout"}
    assert all(check.ok for check in checks.values()), [check.text for check in checks.values()]
    aside = solids["heater_lead_1"].moved(cq.Location(cq.Vector(0.0, 0.0, 2.0)))
    moved = {check.part: check for check in bought_checks({**solids, "heater_lead_1": aside})}
    assert not moved["heater_lead"].ok
