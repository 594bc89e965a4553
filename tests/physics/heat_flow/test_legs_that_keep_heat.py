"""Legs of the pads that keep heat: a slab that the current heats evenly, between sides of known temperature."""

from __future__ import annotations

import numpy as np
import pytest

from tvimdesign.physics.heat_flow import heat, lumps, peltier
from tvimdesign.physics.polymers import polymer

CAPACITY, CURRENT, BEGIN = 4.0, 2.0, 300.0  # J/K, A, K
SLAB = peltier.PeltierModule(0.0, 3.0, 0.2)
POWER = CURRENT**2 * 3.0
NEVER_MELTS = polymer.Melting(1000.0, 1000.0, 1.0, 900.0, 901.0, 1.0)
FIXED = 1e12
"""Heat capacity of a side that keeps its temperature [J/K]."""


def between(side: float = FIXED, **changes: float) -> heat.Stack:
    """Pads between sides that lose nothing but to each other; layer and plate have next to no contact."""
    stack = heat.Stack(
        area=1e-3, thickness=1e-3, density=1000.0, conductivity_solid=1.0, conductivity_melt=1.0, melting=NEVER_MELTS,
        peltier=SLAB, cold_capacity=side, hot_capacity=side, cold_surface=lumps.NOWHERE, hot_contact=1e-12,
        plate_contact=1e-12, plate_thickness=1e-3, plate_conductivity=1.0, plate_heat_capacity=1e6,
        plate_surface=lumps.Surface(1e-3, 1e-12), ambient=BEGIN, plate_cells=1, legs_capacity=CAPACITY,
    )  # fmt: skip
    return stack._replace(**changes)


def mean_above(seconds: float) -> float:
    """Mean of the slab above its sides, by the series (Carslaw and Jaeger, Conduction of Heat in Solids, ch. III)."""
    n = np.arange(1, 400, 2)
    dying = 96.0 / (np.pi * n) ** 4 * np.exp(-((np.pi * n) ** 2) * SLAB.conductance * seconds / CAPACITY)
    return float(POWER / (12.0 * SLAB.conductance) * (1.0 - np.sum(dying)))


def kept(stack: heat.Stack, seconds: float, steps: int = 4000) -> float:
    """Heat [J] that the legs keep after some time; by the trapezium rule in so many steps."""
    state = begin = heat.initial_state(stack, 2, BEGIN)
    for _ in range(steps):
        step = seconds / steps
        ahead = state + step * heat.rates(state, stack, CURRENT)
        state = 0.5 * (state + ahead + step * heat.rates(ahead, stack, CURRENT))
    now, before = heat.profile(state, stack), heat.profile(begin, stack)
    warmer = [peltier.legs_temperature(BEGIN, one.legs[0], BEGIN) for one in (now, before)]
    return CAPACITY * float(warmer[0] - warmer[1])


@pytest.mark.parametrize(("over", "within"), [(0.1, 0.09), (0.3, 0.04), (1.0, 1e-3)])
def test_legs_keep_the_heat_of_a_slab_that_is_heated_evenly(over: float, within: float) -> None:
    seconds = over * CAPACITY / SLAB.conductance
    whole = CAPACITY * POWER / (12.0 * SLAB.conductance)
    assert kept(between(), seconds) == pytest.approx(CAPACITY * mean_above(seconds), abs=within * whole)


def state_of(cold: float, hot: float, middle: float) -> np.ndarray:
    state = heat.initial_state(between(), 2, BEGIN)
    state[[0, 1, -1]] = (np.array([cold, hot, middle]) - 273.15) / 100.0
    return state


def test_settled_legs_give_half_of_the_current_s_heat_to_either_side() -> None:
    middle = peltier.settled_middle(SLAB, CURRENT, 350.0, 310.0)
    state, one = state_of(310.0, 350.0, middle), between(1e6)
    rates = 100.0 * heat.rates(state, one, CURRENT)
    assert rates[-1] == pytest.approx(0.0, abs=1e-12)
    through = SLAB.conductance * 40.0
    sides = 1e6 + CAPACITY / 6.0
    assert rates[:2] * sides == pytest.approx([0.5 * POWER + through, 0.5 * POWER - through], rel=1e-9)


def test_legs_between_sides_that_warm_up_take_what_the_heat_equation_says() -> None:
    # T = a t x/L + a C/(6 K) (x^3/L^3 - x/L): the warm side gives K a t + C a/3 to the slab, the other takes
    # K a t - C a/6 from it.
    rate, seconds = 0.5, 100.0
    warm, lag = rate * seconds, rate * CAPACITY / SLAB.conductance
    middle = BEGIN + 0.5 * warm + lag / 6.0 * (0.125 - 0.5)
    legs = peltier.legs_heat(SLAB, 0.0, BEGIN + warm, middle, BEGIN)
    sides = np.array([-legs.hot, legs.cold]) + rate * CAPACITY / 6.0 * np.array([1.0, 0.0])
    through = SLAB.conductance * warm
    assert legs.middle / (2.0 / 3.0 * CAPACITY) == pytest.approx(0.5 * rate, rel=1e-9)
    assert sides == pytest.approx([through + CAPACITY * rate / 3.0, through - CAPACITY * rate / 6.0], rel=1e-9)


def test_what_the_legs_lose_evenly_comes_from_either_end_and_the_middle() -> None:
    link = lumps.Link(("legs", 0), ("around", 0), 0.3)
    body = lumps.Body(FIXED, lumps.NOWHERE)
    lossy, tight = (between(50.0)._replace(around=(body,), links=links) for links in ((link,), ()))
    state = heat.initial_state(tight, 2, BEGIN)
    state[[0, 1, -1]] = (np.array([320.0, 380.0, 360.0]) - 273.15) / 100.0
    less = 100.0 * (heat.rates(state, tight, 0.0) - heat.rates(state, lossy, 0.0))
    lost = 0.3 * ((320.0 + 4.0 * 360.0 + 380.0) / 6.0 - BEGIN)
    sides = 50.0 + CAPACITY / 6.0
    assert less[[0, 1, -1]] == pytest.approx([lost / 6.0 / sides, lost / 6.0 / sides, lost / CAPACITY], rel=1e-9)


def test_heat_that_the_current_makes_is_stored() -> None:
    stack = between(5.0)
    state = state_of(320.0, 380.0, 360.0)
    rates, step = heat.rates(state, stack, CURRENT), 1e-3
    ends = [heat.stored_energy(state + sign * step * rates, stack) for sign in (-1.0, 1.0)]
    assert (ends[1] - ends[0]) / (2.0 * step) == pytest.approx(POWER, rel=1e-6)


def test_halves_of_the_legs_are_as_warm_as_their_parabola() -> None:
    hot, middle, cold = 380.0, 352.0, 300.0
    way = (np.arange(4000) + 0.5) / 4000
    parabola = hot + way * (4.0 * middle - 3.0 * hot - cold) + way**2 * (2.0 * hot + 2.0 * cold - 4.0 * middle)
    expected = np.mean(parabola), np.mean(parabola[:2000]), np.mean(parabola[2000:])
    assert peltier.legs_temperatures(hot, middle, cold) == pytest.approx(expected, rel=1e-6)
