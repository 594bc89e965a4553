"""Stored energy by hand, and the response times others found for such a stack."""

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tvimdesign.physics.heat_flow import heat, lumps, peltier
from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.working_cycle.casadi_setup import ca

AREA = 1579.2e-6  # m^2, Exley et al., table I
AMBIENT, TARGET = 295.15, 373.15
PCL = polymer.Melting(1850.0, 2100.0, 76.75e3, 323.15, 338.15, 500.0)
FLEXIBLE = peltier.PeltierModule(0.025, 3.0, 0.12)
ALUMINIUM = {"plate_conductivity": 167.0, "plate_heat_capacity": 2700.0 * 896.0, "plate_thickness": 2e-3}
# A plate that takes 3 W/m^2 K from the layer and stores next to nothing.
LOSS_ONLY = {"plate_conductivity": 1e3, "plate_heat_capacity": 1e3, "plate_surface": lumps.Surface(AREA, 3.0)}
INSULATED = {"plate_surface": lumps.Surface(AREA, 1e-9)}


def stack_of(module: peltier.PeltierModule, side_capacity: float, **changes: Any) -> heat.Stack:
    """The shear module's stack, the cold side in free air."""
    stack = heat.Stack(
        area=AREA, thickness=1e-3, density=1145.0, conductivity_solid=0.225, conductivity_melt=0.18, melting=PCL,
        peltier=module, cold_capacity=side_capacity, hot_capacity=side_capacity,
        cold_surface=lumps.Surface(AREA, 15.0), hot_contact=1e4, plate_contact=1e4, plate_thickness=4e-3,
        plate_conductivity=0.24, plate_heat_capacity=1270.0 * 1200.0, plate_surface=lumps.Surface(AREA, 10.0),
        ambient=AMBIENT, plate_cells=3,
    )  # fmt: skip
    return stack._replace(**changes)


def face_times(stack: heat.Stack, current: float = 1.5, cells: int = 12) -> tuple[float, float]:
    """Times at which the near and the far face of the layer reach 100 degC, at the paper's 1.5 A unless said."""

    begin = heat.initial_state(stack, cells, AMBIENT)
    # Compiled: a stack has some thousand steps, and numpy takes ten times as long for each.
    symbols = ca.SX.sym("state", len(begin))
    state = np.reshape(symbols, (len(begin),))
    faces = heat.profile(state, stack)
    rates, gaps = (
        ca.Function("of_state", [symbols], [ca.vertcat(*entries)])
        for entries in (heat.rates(state, stack, current), (faces.near - TARGET, faces.far - TARGET))
    )

    def near(_: float, y: np.ndarray) -> float:
        return float(gaps(y)[0])

    def far(_: float, y: np.ndarray) -> float:
        return float(gaps(y)[1])

    far.terminal = True
    found = solve_ivp(
        lambda _, y: np.asarray(rates(y)).ravel(), (0.0, 2000.0), begin,
        method="LSODA", lband=1, uband=1, rtol=1e-6, atol=1e-8, events=(near, far),
    )  # fmt: skip
    return float(found.t_events[0][0]), float(found.t_events[1][0])


def test_stored_energy_is_mass_times_specific_heat_times_warming() -> None:
    stack = stack_of(FLEXIBLE, 2.5, cold_capacity=4.0)
    layer = 1145.0 * AREA * 1e-3 * (231.65e3)  # 22 to 100 degC: 51.8 + 106.375 + 73.5 kJ/kg
    rest = (4.0 + 2.5 + 1270.0 * 1200.0 * AREA * 4e-3) * 78.0
    warm, cold = (heat.stored_energy(heat.initial_state(stack, 12, t), stack) for t in (TARGET, AMBIENT))
    assert warm - cold == pytest.approx(layer + rest, rel=1e-3)


@pytest.mark.parametrize(
    ("module", "side_capacity", "changes", "near", "far"),
    [
        (FLEXIBLE, 2.9, LOSS_ONLY, 69.0, 77.0),
        (FLEXIBLE, 2.9, {"thickness": 2e-3, **LOSS_ONLY}, 104.0, 134.0),
        (FLEXIBLE, 2.9, ALUMINIUM, 120.0, 158.0),
        (peltier.PeltierModule(4 * 6.37e-3, 4 * 0.515, 4 * 0.028), 3.9, LOSS_ONLY, 90.0, 98.0),  # four QC-17
        (peltier.PeltierModule(52.6e-3, 2.05, 0.550), 8.6, LOSS_ONLY, 175.0, 187.0),  # 12706
    ],
    ids=["1 mm", "2 mm", "1 mm under 2 mm of aluminium", "four QC-17", "12706"],
)
def test_response_times_come_near_an_independent_calculation(
    module: peltier.PeltierModule, side_capacity: float, changes: dict[str, Any], near: float, far: float
) -> None:
    # Another model of these stacks, cold side in free air (15 W/m^2 K), PETG behind the layer. It is met where the PETG
    # stores no heat and takes 3 W/m^2 K, and a side of the pads holds 2.9 J/K, of which that model said nothing. The
    # 3.9 and 8.6 J/K are 930 and 820 J/kg K in half of the rigid modules' 8.4 and 21 g, near alumina's 880.
    found = face_times(stack_of(module, side_capacity, **changes))
    assert found == pytest.approx((near, far), rel=0.02)


BEHIND = {"insulated": {"plate_heat_capacity": 1.0, **INSULATED}, "aluminium": ALUMINIUM}


def far_time(power: float, thickness: float, behind: str = "insulated") -> float:
    """Time in which a constant heat into the near face of the layer brings its far one to 100 degC."""
    pads = peltier.PeltierModule(0.0, 2.0 * power, 0.0)
    stack = stack_of(pads, 1e-3, cold_capacity=1e9, thickness=thickness, **BEHIND[behind])
    return face_times(stack, current=1.0)[1]


@cache
def power_for_70_seconds(thickness: float, behind: str) -> float:
    return float(brentq(lambda power: far_time(power, thickness, behind) - 70.0, 5.0, 18.0, xtol=1e-2))


@pytest.mark.parametrize(
    ("thickness", "behind", "watts"), [(1e-3, "insulated", 5.9), (2e-3, "insulated", 13.0), (1e-3, "aluminium", 15.9)]
)
def test_power_for_70_seconds_is_about_that_of_an_independent_calculation(
    thickness: float, behind: str, watts: float
) -> None:
    # The properties of that calculation are within the published ranges but not known: its heat is 5 % less than that
    # of the middle of the ranges. Its aluminium is 2 mm thick.
    assert power_for_70_seconds(thickness, behind) == pytest.approx(watts, rel=0.07)


@pytest.mark.parametrize(("thickness", "thicker"), [(1e-3, 1.95e-3), (2e-3, 3.63e-3)])
def test_twice_the_time_takes_nearly_twice_the_layer(thickness: float, thicker: float) -> None:
    # The paper's 140 s against 70 s, by the same independent calculation: a question of depth alone.
    assert far_time(power_for_70_seconds(thickness, "insulated"), thicker) == pytest.approx(140.0, rel=0.02)
