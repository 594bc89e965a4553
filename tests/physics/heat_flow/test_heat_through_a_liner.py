"""A liner and the plate behind it, against series resistances, three sheets and a steady balance of many cells."""

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
import pytest
from scipy.linalg import solve_banded
from scipy.optimize import fsolve

from tvimdesign.physics.heat_flow import heat, lumps
from tvimdesign.physics.heat_flow.held_plate import BehindPolymer, held_plate
from tvimdesign.physics.heat_flow.lumps import Lump, Surface
from tvimdesign.physics.heat_flow.stack import Liner

COLD = 295.15
AREA = 1e-3
Make = Callable[..., heat.Stack]
Run = Callable[..., Any]
POLYMER = (1e-3, 0.2, 1145.0 * 1900.0)
"""Thickness [m], conductivity [W/m K], heat capacity per volume [J/m^3 K], as of the bare stack."""


def lined(make: Make, sheet: tuple[float, float, float], **kwargs: Any) -> heat.Stack:
    """Return the bare stack with a sheet of a thickness, conductivity and capacity, and a bond of 0.1 mm of epoxy."""
    thickness, conductivity, capacity = sheet
    liner = Liner(thickness / conductivity / AREA, 1e-4 / 0.2 / AREA, thickness * capacity * AREA)
    return make(liner=liner, **kwargs)


@pytest.mark.parametrize("thickness", [0.5e-3, 1e-3, 2e-3])
def test_heating_through_a_liner_follows_a_wall_of_three_sheets(bare_stack, integrate, thickness):
    sheet, plate = (thickness, 0.29, 1300.0 * 1200.0), (3e-3, 167.0, 2700.0 * 896.0)
    stack = lined(
        bare_stack, sheet, hot_contact=1e7, plate_contact=1e7, plate_conductivity=plate[1],
        plate_heat_capacity=plate[2], plate_thickness=plate[0], plate_cells=6,
    )  # fmt: skip
    times = [10.0, 20.0, 40.0, 80.0]
    history = integrate(stack, heat.initial_state(stack, 28, COLD), times, current=2.0).profiles()
    far, behind = wall(times, [POLYMER, sheet, plate], bond=1e-4 / 0.2, flux=2000.0)
    rise = far[-1]
    assert [seen.far - COLD for seen in history] == pytest.approx(far, abs=0.02 * rise)
    assert [seen.plate_face - COLD for seen in history] == pytest.approx(behind, abs=0.02 * rise)


def wall(
    times: list[float], sheets: list[tuple[float, float, float]], bond: float, flux: float
) -> tuple[list[float], list[float]]:
    """Rise [K] of the first sheet's back and of the last one's front, heated evenly in front, insulated behind.

    Backward Euler on 120 cells a sheet, in steps of 5 ms: nothing of the product's.
    """
    cells = 120
    width = np.repeat([sheet[0] / cells for sheet in sheets], cells)
    half = np.repeat([0.5 * sheet[0] / cells / sheet[1] for sheet in sheets], cells)
    capacity = np.repeat([sheet[2] for sheet in sheets], cells) * width
    way = half[:-1] + half[1:]
    way[2 * cells - 1] += bond
    step, across = 5e-3, 1.0 / way
    onward, back = np.append(across, 0.0), np.append(0.0, across)
    matrix = np.array([np.append(0.0, -across), capacity / step + onward + back, np.append(-across, 0.0)])
    rise, drops = np.zeros(3 * cells), []
    for count in range(1, round(times[-1] / step) + 1):
        into = capacity / step * rise
        into[0] += flux
        rise = solve_banded((1, 1), matrix, into)
        if any(abs(count * step - time) < 0.5 * step for time in times):
            drop = (rise[cells - 1] - rise[cells]) / way[cells - 1]
            onto = (rise[2 * cells - 1] - rise[2 * cells]) / way[2 * cells - 1]
            drops.append((rise[cells - 1] - drop * half[cells - 1], rise[2 * cells] + onto * half[2 * cells]))
    far, behind = zip(*drops, strict=True)
    return list(far), list(behind)


def test_what_heats_the_stack_is_stored_in_it(bare_stack):
    stack = lined(bare_stack, (1e-3, 0.29, 1.56e6), hot_contact=4000.0, plate_contact=500.0,
                  hot_capacity=50.0, cold_capacity=50.0)  # fmt: skip
    state = heat.initial_state(stack, 5, COLD) + np.linspace(0.5, 0.0, 2 + 5 + stack.plate_cells + 3)
    rate = heat.rates(state, stack, 0.0)
    change = heat.stored_energy(state + 1e-3 * rate, stack) - heat.stored_energy(state - 1e-3 * rate, stack)
    given = heat.profile(state, stack).through_plate[-1]
    assert change / 2e-3 == pytest.approx(-given, abs=1e-6 * abs(heat.profile(state, stack).through_layer[0]))


def test_what_a_liner_gives_sideways_leaves_its_cells_as_each_is_warm(bare_stack):
    side = lumps.Link(("liner", 0), ("ambient", 0), 0.3)
    stack = lined(bare_stack, (1e-3, 0.29, 1.56e6))
    state = heat.initial_state(stack, 5, COLD)
    state[-3:] += [0.3, 0.2, 0.1]
    seen, given = heat.profile(state, stack), heat.rates(state, stack, 0.0)
    less = given - heat.rates(state, stack._replace(links=(side,)), 0.0)
    each = stack.liner.capacity / 3.0 * 100.0 * less[-3:]
    assert each == pytest.approx(0.1 * (seen.liner - COLD), rel=1e-9)
    assert less[:-3] == pytest.approx(0.0, abs=1e-12)


def test_a_spreader_stores_what_comes_from_the_pads_less_what_it_gives_on(bare_stack):
    away, body = lumps.Link(("spreader", 0), ("ambient", 0), 0.5), lumps.Lump(50.0, 8.0, lumps.NOWHERE)
    stack = bare_stack(hot_contact=1.0 / (0.02 * AREA), spreader=body, links=(away,))
    state = heat.initial_state(stack, 5, COLD)
    state[1] += 0.4
    state[-1] += 0.3
    seen, given = heat.profile(state, stack), heat.rates(state, stack, 0.0)
    assert (seen.hot - COLD, seen.spreader - COLD) == pytest.approx((40.0, 30.0))
    stored = 50.0 * 10.0 - 0.5 * 30.0 - seen.through_layer[0]
    assert 8.0 * 100.0 * given[-1] == pytest.approx(stored, rel=1e-9)
    more = heat.stored_energy(state, stack) - heat.stored_energy(
        state, stack._replace(spreader=body._replace(capacity=7.0))
    )
    assert more == pytest.approx(seen.spreader - 273.15, rel=1e-9)


AIR, PLATE_POLYMER = 295.15, 373.15
CELLS = 60


def behind(conductivity: float) -> BehindPolymer:
    """Return a plate of 4 mm on 1500 mm^2, a rim that loses heat, and a core with a link beyond it."""
    lumps = (
        Lump(1000.0 * conductivity / 7000.0, 1.0, Surface(9e-3, 5.0, 0.9)),
        Lump(0.024 * conductivity, 1.0, Surface(2.4e-3, 5.0, 0.9)),
    )
    return BehindPolymer(1.5e-3, 4e-3, conductivity, Surface(1.5e-3, 5.0, 0.9), AIR, lumps)


def lost(surface: Surface, temperature: float) -> float:
    grey = surface.emissivity * 5.670374419e-8 * (temperature**4 - AIR**4)
    return float(surface.area * (surface.coefficient * (temperature - AIR) + grey))


def balanced(stack: BehindPolymer) -> Any:
    """Temperatures of all cells and of both lumps where the heat of each sums to zero."""
    through = stack.plate_conductivity * stack.area / (stack.plate_thickness / CELLS)
    first, second = stack.beside

    def left(all_of_them: Any) -> Any:
        plate, (rim, core) = all_of_them[:CELLS], all_of_them[CELLS:]
        top = fsolve(lambda t: 2.0 * through * (plate[-1] - t[0]) - lost(stack.plate_surface, t[0]), plate[-1])[0]
        before = 0.0 if stack.liner is None else stack.liner.resistance + stack.liner.bond
        into = (PLATE_POLYMER - plate[0]) / (before + 0.5 / through)
        flows = np.concatenate([[into], -through * np.diff(plate), [2.0 * through * (plate[-1] - top)]])
        mean = np.mean(plate)
        uneven = first.conductance if stack.uneven_conductance is None else stack.uneven_conductance
        sideways = (first.conductance * (mean - rim) + uneven * (plate - mean)) / CELLS
        onward = second.conductance * (rim - core)
        balances = [np.sum(sideways) - onward - lost(first.surface, rim), onward - lost(second.surface, core)]
        return np.concatenate([-np.diff(flows) - sideways, balances])

    solution = fsolve(left, np.full(CELLS + 2, 340.0))
    return solution[:CELLS], solution[CELLS:]


@pytest.mark.parametrize("uneven", [None, 0.3])
@pytest.mark.parametrize("conductivity", [0.24, 167.0])
def test_plate_rim_and_core_have_the_temperatures_of_a_steady_balance(conductivity, uneven):
    stack = behind(conductivity)
    if uneven is not None:
        stack = stack._replace(uneven_conductance=uneven * stack.beside[0].conductance)
    held = held_plate(stack, PLATE_POLYMER)
    plate, lumps = balanced(stack)
    slices = plate.reshape(4, CELLS // 4).mean(axis=1)
    assert np.array(held.plate) == pytest.approx(slices, abs=0.15)
    assert np.array(held.beside) == pytest.approx(lumps, abs=0.15)


@pytest.mark.parametrize("conductivity", [0.24, 167.0])
def test_a_liner_keeps_all_behind_it_cooler_as_a_steady_balance_says(conductivity):
    stack = behind(conductivity)._replace(liner=Liner(1e-3 / 0.29 / 1.5e-3, 1e-4 / 0.2 / 1.5e-3, 2.3))
    held = held_plate(stack, PLATE_POLYMER)
    plate, lumps = balanced(stack)
    assert np.array(held.plate) == pytest.approx(plate.reshape(4, CELLS // 4).mean(axis=1), abs=0.15)
    assert np.array(held.beside) == pytest.approx(lumps, abs=0.15)
    assert held.plate[0] < held_plate(behind(conductivity), PLATE_POLYMER).plate[0] - 2.0


def test_plastic_cools_down_on_the_way_and_nothing_does_at_ambient():
    plastic, metal = held_plate(behind(0.24), PLATE_POLYMER), held_plate(behind(167.0), PLATE_POLYMER)
    assert plastic.plate[0] - plastic.plate[-1] > 10.0
    assert metal.plate[0] - metal.beside[1] < 15.0
    assert plastic.beside[1] < AIR + 15.0
    held = held_plate(behind(0.24), AIR)
    assert [*held.plate, *held.beside] == pytest.approx([AIR] * 6, abs=1e-9)


def test_a_plate_that_conducts_hardly_any_heat_has_slopes():
    conductivity = ca.SX.sym("conductivity")
    held = held_plate(behind(0.24)._replace(plate_conductivity=conductivity), PLATE_POLYMER)
    values = ca.vertcat(*held.plate, *held.beside)
    slopes = ca.Function("slopes", [conductivity], [values, ca.jacobian(values, conductivity)])
    warm, by = (part.full().ravel() for part in slopes(1e-8))
    assert np.all(np.isfinite(by))
    assert warm[1:4] == pytest.approx(warm[4], abs=0.01)  # all of it is as warm as the lump beside, but for its skin
