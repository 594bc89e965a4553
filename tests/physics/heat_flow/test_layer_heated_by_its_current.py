"""A layer that the heater's current passes: its resistance over a comb, and the heat in each of its cells."""

import numpy as np
import pytest

from tvimdesign.physics.heat_flow import heat, lumps, peltier, shape_factors
from tvimdesign.physics.polymers import polymer

MELTING = polymer.Melting(1850.0, 2100.0, 76.75e3, 323.15, 338.15, 500.0)
CELLS, CURRENT = 6, 2.0


def stack(resistance: float) -> heat.Stack:
    return heat.Stack(
        area=1e-3, thickness=1e-3, density=1145.0, conductivity_solid=0.22, conductivity_melt=0.18, melting=MELTING,
        peltier=peltier.PeltierModule(0.0, 0.5, 0.1), cold_capacity=3.0, hot_capacity=2.0, cold_surface=lumps.NOWHERE,
        hot_contact=1e4, plate_contact=500.0, plate_thickness=3e-3, plate_conductivity=0.2, plate_heat_capacity=1.5e6,
        plate_surface=lumps.Surface(1e-3, 5.0), ambient=295.15, plate_cells=3, layer_resistance=resistance,
    )  # fmt: skip


def test_all_that_the_terminals_give_is_stored_where_nothing_is_lost() -> None:
    one = stack(1.5)._replace(plate_surface=lumps.Surface(1e-3, 1e-9))
    state = heat.initial_state(one, CELLS, 310.0)
    state = state + 0.05 * np.sin(np.arange(len(state)))
    step = 1e-6
    rate = heat.rates(state, one, CURRENT)
    stored = (heat.stored_energy(state + step * rate, one) - heat.stored_energy(state - step * rate, one)) / (
        2.0 * step
    )
    power = heat.electrical_power(heat.profile(state, one), one, CURRENT)
    assert power == pytest.approx(CURRENT**2 * (0.5 + 1.5), rel=1e-12)
    assert stored == pytest.approx(power, rel=1e-6)


def test_each_cell_has_an_even_part_of_the_heat() -> None:
    state = heat.initial_state(stack(0.0), CELLS, 310.0)
    more = heat.rates(state, stack(1.5), CURRENT) - heat.rates(state, stack(0.0), CURRENT)
    each = CURRENT**2 * 1.5 / (1145.0 * 1e-3 * 1e-3) / heat.ENTHALPY_SCALE
    assert more[2 : 2 + CELLS] == pytest.approx(each)
    assert np.all(np.delete(more, range(2, 2 + CELLS)) == 0.0)


def test_the_current_s_sign_does_not_matter() -> None:
    state = heat.initial_state(stack(1.5), CELLS, 310.0)
    assert heat.rates(state, stack(1.5), -CURRENT) == pytest.approx(heat.rates(state, stack(1.5), CURRENT))
    assert heat.voltage(heat.profile(state, stack(1.5)), stack(1.5), -CURRENT) == pytest.approx(-4.0)


def test_a_wide_foot_is_longer_by_its_limit_and_a_narrow_one_by_more() -> None:
    # 2 ln 2/pi = 0.441271 of the depth for a foot much wider than the depth.
    assert shape_factors.electrode_foot(8e-3, 1e-3) == pytest.approx(0.441271e-3, rel=1e-5)
    feet = [shape_factors.electrode_foot(width, 1e-3) for width in (0.1e-3, 0.25e-3, 0.5e-3, 1e-3, 2e-3)]
    assert np.all(np.diff(feet) < 0.0)


def test_a_comb_by_hand() -> None:
    """Wide gaps: 10 mm long, 1 mm deep, 12 mm from finger to finger on 1200 mm2: 100 mm of gaps, 0.1 ohm m."""
    foot = 1e-3 - 2e-3 / np.pi * np.log(np.sinh(0.5 * np.pi))
    by_hand = 0.1 * (10e-3 + 2.0 * foot) / (1e-3 * 0.1)
    assert shape_factors.comb_resistance(0.1, 1e-3, 1200e-6, 10e-3, 2e-3) == pytest.approx(by_hand)
    assert by_hand == pytest.approx(10.94, abs=0.01)
