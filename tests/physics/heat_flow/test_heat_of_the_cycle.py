"""Heating and freezing again: first law with a sink and radiation, the handover, and cooling against solved cases."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from tvimdesign.physics.heat_flow import heat, lumps, peltier
from tvimdesign.physics.polymers import polymer, transitions

Array = NDArray[np.float64]
STEFAN_BOLTZMANN = 5.670374419e-8
AMBIENT = 295.15
AREA = 1579.2e-6
PCL = polymer.Melting(1850.0, 2100.0, 76.75e3, 323.15, 338.15, 500.0)
FREEZING = transitions.Kinetics(3.0, 170.0, 313.15, 6.08e4, 347.15, 213.15, 6270.0, 0.5)
PADS = peltier.PeltierModule(0.025, 3.0, 0.12)
SINK = lumps.Lump(5.0, 30.0, lumps.Surface(15e-3, 10.0, 0.85))
STRIP = lumps.Lump(0.4, 12.0, lumps.Surface(4e-3, 6.0, 0.9))
CORE = lumps.Lump(0.05, 40.0, lumps.NOWHERE)
FLOOR = lumps.Body(15.0, lumps.Surface(4e-3, 6.0, 0.9))
HOUSING = lumps.Body(60.0, lumps.Surface(20e-3, 5.0, 0.9))
GAP = lumps.air_gap(4e-3, 1e-3, 0.028, 0.9, ("beside", 0), ("around", 0))
EDGES = tuple(lumps.Link((side, 0), ("around", 0), 0.03) for side in ("hot", "cold"))
LINKS = (
    *EDGES, lumps.Link(("layer", 0), ("around", 0), 0.01), lumps.Link(("plate", 0), ("around", 1), 0.02, 1e-4),
    lumps.Link(("around", 0), ("around", 1), 0.2), GAP,
)  # fmt: skip


def cycle_stack(**changes: Any) -> heat.Stack:
    """Return a full stack: a sink, a strip and a core beside the plate, floor and housing around the pads."""
    stack = heat.Stack(
        area=AREA, thickness=1e-3, density=1145.0, conductivity_solid=0.225, conductivity_melt=0.18, melting=PCL,
        peltier=PADS, cold_capacity=4.0, hot_capacity=2.5, cold_surface=lumps.NOWHERE, hot_contact=1e4,
        plate_contact=1e4, plate_thickness=4e-3, plate_conductivity=0.24, plate_heat_capacity=1270.0 * 1200.0,
        plate_surface=lumps.Surface(AREA, 5.0, 0.9), ambient=AMBIENT, plate_cells=3, beside=(STRIP, CORE), sink=SINK,
        around=(FLOOR, HOUSING), links=LINKS, uneven_conductance=0.1,
    )  # fmt: skip
    return stack._replace(**changes)


def flux(coefficient: float, emissivity: float, kelvin: float) -> float:
    """Newton's law of cooling and the Stefan-Boltzmann law [W/m^2]."""
    return coefficient * (kelvin - AMBIENT) + emissivity * STEFAN_BOLTZMANN * (kelvin**4 - AMBIENT**4)


def lost_from(now: heat.Profile) -> float:
    """Heat the air takes from sink, strip, floor, housing and plate [W], from temperatures alone."""
    face = flux(5.0, 0.9, now.plate[-1]) / (now.plate[-1] - AMBIENT) if now.plate[-1] != AMBIENT else 10.0
    plate = AREA * (now.plate[-1] - AMBIENT) / (0.5 * 4e-3 / 3 / 0.24 + 1.0 / face)
    bodies = 15e-3 * flux(10.0, 0.85, now.sink[0]) + 4e-3 * flux(6.0, 0.9, now.beside[0])
    return plate + bodies + 4e-3 * flux(6.0, 0.9, now.around[0]) + 20e-3 * flux(5.0, 0.9, now.around[1])


def run(stack: heat.Stack, begin: Array, current: float, seconds: float) -> tuple[Array, float, float]:
    """State after some time, electrical energy put in and heat lost [J]."""

    def rates(_: float, y: Array) -> Array:
        now = heat.profile(y[:-2], stack)
        put_in = current * (0.025 * (now.hot - now.cold) + 3.0 * current)
        return np.append(heat.rates(y[:-2], stack, current), [put_in, lost_from(now)])

    end = solve_ivp(rates, (0.0, seconds), np.append(begin, [0.0, 0.0]), method="BDF", rtol=1e-9, atol=1e-11).y[:, -1]
    return end[:-2], float(end[-2]), float(end[-1])


@pytest.fixture(scope="module")
def heated() -> tuple[Array, float, float]:
    """Return the stack after two minutes of heating at 1.5 A: molten but for the far cells; energy put in and lost."""
    stack = cycle_stack()
    return run(stack, heat.initial_state(stack, 8, AMBIENT), 1.5, 120.0)


@pytest.mark.gate
def test_heat_is_kept_to_a_millionth_from_heating_to_freezing(heated):
    melting, freezing = cycle_stack(), cycle_stack(freezing=FREEZING)
    state, supplied, lost = heated
    molten = heat.profile(state, melting).fractions
    end, reversed_supplied, later_lost = run(freezing, heat.with_history(state, freezing), -0.8, 600.0)
    frozen = heat.profile(end, freezing).fractions
    assert np.min(molten) < 0.01  # it has been molten and has frozen again
    assert np.min(frozen) > 0.5
    begin = heat.stored_energy(heat.initial_state(melting, 8, AMBIENT), melting)
    stored = heat.stored_energy(end, freezing) - begin
    assert stored + lost + later_lost == pytest.approx(supplied + reversed_supplied, abs=1e-6 * (lost + later_lost))


@pytest.mark.gate
def test_no_heat_is_lost_where_freezing_takes_over(heated):
    melting, freezing = cycle_stack(), cycle_stack(freezing=FREEZING)
    state = heated[0]
    taken_over = heat.with_history(state, freezing)
    assert np.array_equal(taken_over[: len(state)], state)
    assert heat.stored_energy(taken_over, freezing) == heat.stored_energy(state, melting)
    before, after = heat.profile(state, melting), heat.profile(taken_over, freezing)
    assert after.fractions == pytest.approx(before.fractions, abs=2e-3)
    # Within the window the melting curve is drawn straight, the mixture's temperature is not: half a kelvin at most.
    assert after.cells == pytest.approx(before.cells, abs=0.5)
    assert (after.hot, after.cold) == (before.hot, before.cold)


def test_surfaces_and_gaps_radiate_and_conduct():
    # 0.01 m^2 of emissivity 0.9 at 80 degC: 5.670374e-8 * 0.009 * (353.15^4 - 295.15^4) = 4.0648 W, by hand.
    assert lumps.surface_heat(lumps.Surface(0.01, 0.0, 0.9), 353.15, AMBIENT) == pytest.approx(4.0648, rel=2e-5)
    assert lumps.surface_heat(lumps.Surface(0.01, 10.0, 0.9), 353.15, AMBIENT) == pytest.approx(4.0648 + 5.8, rel=2e-5)
    assert lumps.surface_heat(lumps.Surface(0.01, 10.0, 0.9), AMBIENT, AMBIENT) == 0.0
    # 0.01 m^2, 1 mm of air of 0.028 W/m K, 80 to 22 degC: 0.28 W/K * 58 K; between plates of 0.9 radiate, by hand,
    # 5.670374e-8 * 0.01 * (353.15^4 - 295.15^4)/(1/0.9 + 1/0.9 - 1) = 3.6953 W (Incropera, ch. 13).
    gap = lumps.air_gap(0.01, 1e-3, 0.028, 0.9, ("beside", 0), ("around", 0))
    assert lumps.link_heat(gap, 353.15, AMBIENT) == pytest.approx(0.28 * 58.0 + 3.6953, rel=2e-5)
    assert lumps.link_heat(gap, AMBIENT, 353.15) == -lumps.link_heat(gap, 353.15, AMBIENT)
    # 0.28 W/K of air and 0.0640 W/K of radiation near 22 degC (4 e s A T^3/(2 - e)) behind 0.5 W/K: 0.2038 W/K.
    gap = lumps.air_gap(0.01, 1e-3, 0.028, 0.9, ("beside", 0), ("around", 0))
    radiated = 4.0 * STEFAN_BOLTZMANN * 0.01 / (2.0 / 0.9 - 1.0) * AMBIENT**3
    behind = lumps.link_conductance(lumps.behind(gap, 0.5, AMBIENT), AMBIENT, AMBIENT)
    assert behind == pytest.approx(1.0 / (1.0 / (0.28 + radiated) + 1.0 / 0.5), rel=1e-12)


def test_links_heat_what_they_touch(bare_stack):
    # All at ambient but pads at 60, layer at 40 and strip at 80 degC: what the floor gets, by hand.
    floor = lumps.Body(15.0, lumps.NOWHERE)
    links = (*EDGES, lumps.Link(("layer", 0), ("around", 0), 0.01), GAP)
    stack = bare_stack(beside=(STRIP,), around=(floor,), links=links)
    state = heat.initial_state(stack, 4, 273.15 + 40.0)
    state[:2], state[-2], state[-1] = 0.6, 0.8, 0.2
    gained = 2 * 0.03 * 40.0 + 0.01 * 20.0 + lumps.link_heat(GAP, 353.15, 293.15)
    assert heat.rates(state, stack, 0.0)[-1] == pytest.approx(gained / 15.0 / 100.0, rel=1e-6)


def test_uneven_plates_give_by_their_own_conductance():
    # Cells at 50, 40 and 30 degC beside a strip at 40 degC: the mean gives nothing, 0.1 W/K/3 times 10 K leave the
    # first cell and come into the last.
    even = cycle_stack(uneven_conductance=0.0, links=())
    uneven = even._replace(uneven_conductance=0.1)
    state = heat.initial_state(even, 4, 313.15)
    state[6:9] = 0.5, 0.4, 0.3
    capacity = 1270.0 * 1200.0 * AREA * 4e-3 / 3.0
    change = heat.rates(state, uneven, 0.0) - heat.rates(state, even, 0.0)
    expected = np.array([-1.0, 0.0, 1.0]) * 0.1 * 10.0 / 3.0 / capacity / 100.0
    assert change[6:9] == pytest.approx(expected, rel=1e-9)
    assert np.delete(change, [6, 7, 8]) == pytest.approx(0.0, abs=1e-15)


def test_a_radiating_plate_cools_as_its_face_at_the_surface_does():
    # The model radiates at the temperature of the outermost cell; the face's own, from its balance, is what is right.
    stack = cycle_stack(plate_cells=8)
    state = heat.initial_state(stack, 4, 273.15 + 45.0)
    half = 0.5 * 4e-3 / 8 / 0.24
    face = 318.15
    for _ in range(50):
        face = 318.15 - half * flux(5.0, 0.9, face)
    assert heat.profile(state, stack).through_plate[-1] == pytest.approx(AREA * flux(5.0, 0.9, face), rel=2e-3)


def test_cold_side_and_sink_warm_as_two_lumps_do(bare_stack, integrate):
    # At 2 A half of I^2 R = 4 W warms the cold side: C1 T1' = 2 - G (T1 - T2), C2 T2' = G (T1 - T2) - h A (T2 - Ta).
    sink = lumps.Lump(0.5, 30.0, lumps.Surface(15e-3, 10.0))
    stack = bare_stack(cold_capacity=4.0, cold_surface=lumps.Surface(1.0, 1e3), hot_capacity=1e9, sink=sink)
    times = [5.0, 60.0, 300.0, 3000.0]
    history = integrate(stack, heat.initial_state(stack, 3, AMBIENT), times, current=2.0)
    matrix = np.array([[-0.5 / 4.0, 0.5 / 4.0], [0.5 / 30.0, -(0.5 + 0.15) / 30.0]])
    steady = np.array([2.0 / 0.5 + 2.0 / 0.15, 2.0 / 0.15])
    for time, now in zip(times, history.profiles(), strict=True):
        expected = steady - expm(matrix * time) @ steady
        assert [now.cold - AMBIENT, now.sink[0] - AMBIENT] == pytest.approx(list(expected), rel=1e-5)


@pytest.mark.parametrize("current", [0.3, 0.8, 1.6])
def test_reversed_current_cools_to_the_balance_of_the_peltier_equations(bare_stack, integrate, current):
    # Layer and hot side are insulated, Q_h = 0; the cold side gives -Q_c = h A (T_c - T_a): two linear equations.
    seebeck, ohms, leak, loss = 0.025, 3.0, 0.12, 0.3
    stack = bare_stack(
        peltier=peltier.PeltierModule(seebeck, ohms, leak), cold_capacity=4.0, hot_capacity=2.5, hot_contact=1e4,
        cold_surface=lumps.Surface(0.03, 10.0),
    )  # fmt: skip
    joule = 0.5 * current**2 * ohms
    matrix = np.array([[-seebeck * current - leak, leak], [leak, seebeck * current - leak - loss]])
    hot, cold = np.linalg.solve(matrix, [-joule, -joule - loss * AMBIENT])
    (now,) = integrate(stack, heat.initial_state(stack, 3, AMBIENT), [2e4], current=-current).profiles()
    assert (now.hot, now.cold) == pytest.approx((hot, cold), rel=1e-7)
    assert now.cells == pytest.approx([hot] * 3, rel=1e-7)
    power = -current * (seebeck * (hot - cold) - current * ohms)
    assert heat.electrical_power(now, stack, -current) == pytest.approx(power, rel=1e-6)
    # All that is put in leaves through the cold side.
    assert loss * (cold - AMBIENT) == pytest.approx(power, rel=1e-9)
