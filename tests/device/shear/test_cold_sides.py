"""Cold sides of the pads against a fin held at its end, and the adhesive that holds the pads."""

from typing import Any

import pytest
from cad_designs import TILES, design_of
from device_values import all_of, inputs_of

from tvimdesign.cad.assembly.bill_of_materials import beside
from tvimdesign.device.shear import floor_heat
from tvimdesign.device.table.module import Module
from tvimdesign.physics.heat_flow.peltier import SIDE_SHARE, PeltierModule

THICKNESS, CONDUCTIVITY = 3.9e-3, 25.0  # m, W/m K, a rigid module's sides
AREA, EDGES = 3200e-6, 0.2  # m^2, m: a pad's half width is 16 mm


def slab(up: float) -> floor_heat.ColdSide:
    pads = PeltierModule(seebeck=0.05, resistance=2.0, conductance=up * AREA / THICKNESS)
    return floor_heat.cold_side_slab(
        Module(
            pads=pads, pad_conductivity=CONDUCTIVITY, peltier_thickness=THICKNESS, heated_area=AREA, edge_length=EDGES
        )
    )


def with_cold_area(side: floor_heat.ColdSide, area: float) -> Module:
    return Module(cold_side_slab=side, heated_area=AREA, cold_area=area)


@pytest.mark.parametrize("ledges", [0.2, 0.4, 0.7])
def test_heat_goes_to_the_ledges_as_along_a_fin(ledges: float) -> None:
    """A fin heated evenly that gives its heat evenly over its first share s is warmer in the mean by (1 - s)^2/3 of
    its heat over its conductance along (Carslaw and Jaeger, ch. IV: twice integrated)."""
    side = slab(up=CONDUCTIVITY * 200.0)  # legs that conduct up so well that all of their height conducts along
    found = floor_heat.cold_to_ledges(with_cold_area(side, (1.0 - ledges) * AREA))
    along = CONDUCTIVITY * (1.0 - SIDE_SHARE) * THICKNESS * EDGES / (AREA / EDGES)
    assert found == pytest.approx((1.0 - ledges) ** 2 / 3.0 / along, rel=0.02)


def test_sinks_and_poor_legs_leave_a_fin_s_way() -> None:
    side = slab(up=1.5)
    to_ledges = floor_heat.cold_to_ledges(with_cold_area(side, 0.7 * AREA))
    assert floor_heat.cold_to_sink(with_cold_area(side, 0.3 * AREA)) == pytest.approx(to_ledges)
    assert floor_heat.cold_to_sink(with_cold_area(side, AREA)) == pytest.approx(0.0, abs=1e-12)
    # With next to nothing up, heat stays in the side: a fin of its thickness alone.
    found = floor_heat.cold_to_ledges(with_cold_area(slab(up=1e-6), 0.6 * AREA))
    along = CONDUCTIVITY * SIDE_SHARE * THICKNESS * EDGES / (AREA / EDGES)
    assert found == pytest.approx(0.6**2 / 3.0 / along, rel=0.02)


ROWS = "ledge_tension freezing_traction pcl_area"


def test_the_pull_of_the_layer_comes_to_the_ledges() -> None:
    # Four arcs of 0.3 to ...: the ledge is 2 mm wide around each, its corners left out of the count.
    free = all_of(ROWS, axial_preload="wave_21x25")
    inputs = inputs_of()
    inner, outer, span, ledge = (
        inputs[name] for name in ("pcl_inner_radius", "pcl_outer_radius", "arc_span", "window_ledge")
    )
    whole = 0.5 * span * (outer**2 - inner**2)
    window = 0.5 * (span - 2.0 * ledge / inner) * ((outer - ledge) ** 2 - (inner + ledge) ** 2)
    share = whole / (whole - window)
    pull = min(free["freezing_traction"], free["pcl_bond_strength"])
    assert free["ledge_tension"] == pytest.approx(pull * share, rel=0.01)
    held = all_of(ROWS, pcl_thickness=2e-3)
    assert held["ledge_tension"] <= held["pcl_bond_strength"] * share * 1.01


def test_the_bill_has_adhesive_or_grease_for_pads() -> None:
    def kinds(mode: str, changes: dict[str, Any]) -> list[str]:
        return [item.kind for item in beside(design_of("held", changes, mode), {})]

    assert "heater_adhesive" in kinds("shear", {})
    assert "thermal_grease" not in kinds("shear", {})
    assert {"heat_conducting_adhesive", "thermal_grease", "heater_adhesive"} <= set(kinds("shear", TILES))
    assert "thermal_grease" in kinds("compression", {})
