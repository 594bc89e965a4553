"""Ways along the pads' cold sides, against a fin that takes heat evenly and gives it where it is held."""

from __future__ import annotations

import pytest

from tvimdesign.device.shear import pad_heat
from tvimdesign.device.table.module import Module
from tvimdesign.physics.heat_flow.peltier import SIDE_SHARE, PeltierModule

THICKNESS, CONDUCTIVITY = 3.9e-3, 25.0  # m, W/m K, a rigid module's sides
AREA, EDGES = 3200e-6, 0.2  # m^2, m: a pad's half width is 16 mm


def slab(up: float) -> pad_heat.ColdSide:
    pads = PeltierModule(seebeck=0.05, resistance=2.0, conductance=up * AREA / THICKNESS)
    return pad_heat.cold_side_slab(
        Module(
            pads=pads, pad_conductivity=CONDUCTIVITY, peltier_thickness=THICKNESS, heated_area=AREA, edge_length=EDGES
        )
    )


def with_cold_area(side: pad_heat.ColdSide, area: float) -> Module:
    return Module(cold_side_slab=side, heated_area=AREA, cold_area=area)


@pytest.mark.parametrize("ledges", [0.2, 0.4, 0.7])
def test_heat_goes_to_the_ledges_as_along_a_fin(ledges: float) -> None:
    """A fin heated evenly that gives its heat evenly over its first share s is warmer in the mean by (1 - s)^2/3 of
    its heat over its conductance along (Carslaw and Jaeger, ch. IV: twice integrated)."""
    side = slab(up=CONDUCTIVITY * 200.0)  # legs that conduct up so well that all of their height conducts along
    found = pad_heat.cold_to_ledges(with_cold_area(side, (1.0 - ledges) * AREA))
    along = CONDUCTIVITY * (1.0 - SIDE_SHARE) * THICKNESS * EDGES / (AREA / EDGES)
    assert found == pytest.approx((1.0 - ledges) ** 2 / 3.0 / along, rel=0.02)


def test_a_sink_over_the_rest_is_the_same_way_from_the_other_end() -> None:
    side = slab(up=1.5)
    to_ledges = pad_heat.cold_to_ledges(with_cold_area(side, 0.7 * AREA))
    assert pad_heat.cold_to_sink(with_cold_area(side, 0.3 * AREA)) == pytest.approx(to_ledges)
    assert pad_heat.cold_to_sink(with_cold_area(side, AREA)) == pytest.approx(0.0, abs=1e-12)


def test_legs_that_conduct_up_poorly_leave_the_way_to_the_side() -> None:
    """With next to nothing up, heat stays in the side: a fin of its thickness alone."""
    found = pad_heat.cold_to_ledges(with_cold_area(slab(up=1e-6), 0.6 * AREA))
    along = CONDUCTIVITY * SIDE_SHARE * THICKNESS * EDGES / (AREA / EDGES)
    assert found == pytest.approx(0.6**2 / 3.0 / along, rel=0.02)
