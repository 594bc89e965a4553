"""The Peltier module against data sheets and its equations; legs that store heat against a slab's series."""

import numpy as np
import pytest
import textbook
from hypothesis import given
from hypothesis import strategies as st
from plane_conduction import conducted
from scipy.optimize import brentq, minimize_scalar

from tvimdesign.physics.heat_flow import heat, lumps, peltier
from tvimdesign.physics.polymers import polymer

SHEETS = {  # I_max [A], V_max [V], dT_max [K], T_h [K] of the data sheets, and the S [mV/K], R [ohm], K [W/K] they give
    "teci_12706": ((6.0, 15.8, 67.0, 300.15), (52.6, 2.05, 0.550)),
    "qc_17": ((2.8, 1.9, 72.0, 298.15), (6.37, 0.515, 0.028)),
    "pc_072": ((15.4, 8.9, 68.0, 298.15), (29.9, 0.446, 0.778)),
}
kelvins = st.floats(250.0, 420.0)
modules = st.builds(
    peltier.PeltierModule,
    seebeck=st.floats(1e-3, 0.1),
    resistance=st.floats(0.1, 10.0),
    conductance=st.floats(0.01, 2.0),
)


@pytest.mark.parametrize("name", SHEETS)
def test_the_module_reaches_its_rated_difference_at_its_rated_current(name):
    # At I_max, dT_max and the sheet's T_h no heat is drawn, and no other current draws any.
    current, voltage, difference, hot = SHEETS[name][0]
    module = textbook.from_data_sheet(current, voltage, difference, hot)
    scale = module.conductance * difference
    assert peltier.cold_side_heat(module, current, hot, hot - difference) == pytest.approx(0.0, abs=1e-9 * scale)
    for other in (0.9 * current, 1.1 * current):
        assert peltier.cold_side_heat(module, other, hot, hot - difference) < 0.0
    assert peltier.voltage(module, current, hot, hot - difference) == pytest.approx(voltage, rel=1e-9)


@pytest.mark.parametrize(("name", "watts", "within"), [("qc_17", 3.2, 0.1), ("pc_072", 85.1, 0.1)])
def test_rated_cooling_follows_from_the_other_ratings(name, watts, within):
    # Q_max of the sheet, at T_c = T_h, which S, R and K do not use.
    sheet = SHEETS[name][0]
    assert peltier.max_cooling_power(textbook.from_data_sheet(*sheet), sheet[3]) == pytest.approx(watts, rel=within)


@given(module=modules, cold=kelvins)
def test_max_cooling_is_the_most_any_current_draws_without_a_difference(module, cold):
    best = minimize_scalar(lambda i: -peltier.cold_side_heat(module, i, cold, cold), bracket=(0.0, 1.0))
    assert peltier.max_cooling_power(module, cold) == pytest.approx(-best.fun, rel=1e-6)


@given(module=modules, current=st.floats(-5.0, 5.0), hot=kelvins, cold=kelvins)
def test_electrical_power_is_the_difference_of_the_heats(module, current, hot, cold):
    heat = peltier.hot_side_heat(module, current, hot, cold) - peltier.cold_side_heat(module, current, hot, cold)
    power = peltier.voltage(module, current, hot, cold) * current
    assert heat == pytest.approx(power, rel=1e-9, abs=1e-9)


@given(module=modules, hot=st.floats(300.0, 400.0), difference=st.floats(1.0, 30.0))
def test_best_coefficient_of_performance_is_the_textbooks(module, hot, difference):
    # Rowe (ed.), CRC Handbook of Thermoelectrics: T_c/(T_h - T_c) (m - T_h/T_c)/(m + 1), m = sqrt(1 + Z T_mean),
    # at the current S dT/(R (m - 1)).
    cold = hot - difference
    figure = module.seebeck**2 / (module.resistance * module.conductance)
    m = np.sqrt(1.0 + figure * 0.5 * (hot + cold))
    current = module.seebeck * difference / (module.resistance * (m - 1.0))
    power = current * peltier.voltage(module, current, hot, cold)
    performance = peltier.cold_side_heat(module, current, hot, cold) / power
    assert performance == pytest.approx(cold / difference * (m - hot / cold) / (m + 1.0), rel=1e-6, abs=1e-6)


def test_heat_goes_with_the_current_and_back_without():
    module = peltier.PeltierModule(0.05, 2.0, 0.5)
    assert peltier.hot_side_heat(module, 1.0, 300.0, 300.0) == pytest.approx(15.0 + 1.0)
    assert peltier.cold_side_heat(module, 1.0, 300.0, 300.0) == pytest.approx(15.0 - 1.0)
    module = peltier.PeltierModule(0.05, 2.0, 0.5)
    assert peltier.hot_side_heat(module, 0.0, 310.0, 300.0) == pytest.approx(-5.0)
    assert peltier.cold_side_heat(module, 0.0, 310.0, 300.0) == pytest.approx(-5.0)
    # Its conductance takes back all it pumps: no layer behind it is ever warmer.
    module, cold = textbook.from_data_sheet(*SHEETS["teci_12706"][0]), 295.15
    stalled = brentq(lambda hot: peltier.hot_side_heat(module, 1.5, hot, cold), cold, 400.0)
    assert stalled - 273.15 == pytest.approx(76.0, abs=1.0)


@given(kelvins, kelvins, st.floats(0.0, 5.0), st.floats(0.1, 100.0), st.floats(0.01, 2.0))
def test_a_foil_heats_whichever_way_its_current_flows(hot, cold, current, resistance, conductance):
    foil = peltier.PeltierModule(0.0, resistance, conductance)
    both = [peltier.hot_side_heat(foil, sign * current, hot, cold) for sign in (1.0, -1.0)]
    assert both[0] == both[1]
    given_off = both[0] - peltier.cold_side_heat(foil, current, hot, cold)
    assert given_off == pytest.approx(current**2 * resistance, rel=1e-9, abs=1e-9)


def test_an_insulated_foil_is_hotter_by_half_its_way():
    # A wire in the middle of 1.6 mm of silicone, 8 kW/m2 all to one side: q t/(2 k) = 91 K over the half it passes.
    flux, thickness, conductivity, area = 8e3, 1.6e-3, 0.07, 1.6e-3
    foil = peltier.PeltierModule(0.0, 45.0, conductivity * area / thickness)
    current = np.sqrt(flux * area / 45.0)
    outer = brentq(lambda cold: peltier.cold_side_heat(foil, current, 350.0, cold), 350.0, 900.0)
    assert outer - 350.0 == pytest.approx(0.5 * flux * thickness / conductivity, rel=1e-9)


def test_evenly_heated_legs_follow_the_heat_equation():
    # k A T'' = -I^2 R/L between two ends, solved by finite differences; 2 A through 3 ohm, 0.5 W/K from end to end.
    hot, cold, count = 390.0, 310.0, 400
    step = 1.0 / count
    inside = np.diag(np.full(count - 1, 2.0)) - np.diag(np.ones(count - 2), 1) - np.diag(np.ones(count - 2), -1)
    heated = np.full(count - 1, 2.0**2 * 3.0 / 0.5 * step**2)
    heated[0] += hot
    heated[-1] += cold
    profile = np.concatenate([[hot], np.linalg.solve(inside, heated), [cold]])
    mean = step * (np.sum(profile) - 0.5 * (hot + cold))
    module = peltier.PeltierModule(seebeck=0.05, resistance=3.0, conductance=0.5)
    middle = peltier.settled_middle(module, 2.0, hot, cold)
    assert middle == pytest.approx(profile[count // 2], abs=1e-3)
    assert peltier.legs_temperature(hot, middle, cold) == pytest.approx(mean, abs=1e-3)


@pytest.mark.parametrize("conductance", [20.0, 200.0])
def test_spreading_is_what_a_fins_efficiency_leaves_out(conductance):
    # Half of a plate is fed, half is a fin of 2 mm that gives heat to a layer: tanh(m w)/(m w) (Incropera, ch. 3).
    k, thickness, width = 167.0, 1e-3, 2e-3
    mw = width * np.sqrt(conductance / (k * thickness))
    exact = 1.0 / (conductance * (0.5 + 0.5 * np.tanh(mw) / mw)) - 1.0 / conductance
    resistance = peltier.spreading_resistance(2.0 * width, width, 1.0, k, thickness)  # per metre along the edge
    around_the_corner = 0.5 * width / k * peltier.AROUND_CORNER
    assert resistance - around_the_corner == pytest.approx(exact, rel=0.02)


def in_two_dimensions(fed: float, beside: float, thickness: float, k: float, across: int = 20) -> float:
    """Mean temperature of a plate's upper face that an even flux of 1 W/m^2 leaves, below its fed lower face [K].

    Half a module and half a gap, finite volumes; no heat passes the ends or the lower face beside the module.
    """
    step = thickness / across
    columns, fed_columns = round((fed + beside) / step), round(fed / step)
    inside = np.ones((columns, across + 1), dtype=bool)
    inside[:, 0] = False
    held, into = np.full(inside.shape, np.nan), np.zeros(inside.shape)
    held[:fed_columns, 0], into[:, -1] = 0.0, step / k
    return float(np.mean(conducted(inside, held, into)[:, -1]) + 0.5 * step / k)


@pytest.mark.parametrize("beside", [8e-3, 4e-3, 2e-3])
def test_a_plate_in_two_dimensions_falls_as_far(beside):
    # What the plate adds across its thickness, t/k, is counted apart (`contact_resistance`).
    fed, thickness, k = 4e-3, 0.8e-3, 167.0
    resistance = peltier.spreading_resistance(fed + beside, fed, 1.0, k, thickness)
    through = thickness / k
    assert resistance + through == pytest.approx(in_two_dimensions(fed, beside, thickness, k), rel=0.05)


@pytest.mark.parametrize("offset", [0.0, 1e-3, 2e-3])
def test_a_row_off_the_middle_falls_as_two_plates_with_fins_of_their_own(offset):
    length, depth, beside, thickness, k = 0.02, 8e-3, 4e-3, 0.8e-3, 167.0
    width = depth + 2.0 * beside
    sizes = length * width, width, 1, (length, depth), 2, k, thickness
    halves = [(0.5 * depth + fin) * in_two_dimensions(0.5 * depth, fin, thickness, k)
              for fin in (beside + offset, beside - offset)]  # fmt: skip
    resistance = peltier.row_spreading_resistance(*sizes, offset) + thickness / k
    assert resistance == pytest.approx(sum(halves) / width, rel=0.05)


def test_a_plate_that_is_fed_evenly_spreads_nothing():
    assert peltier.spreading_resistance(1e-3, 1e-3, 0.1, 167.0, 1e-3) == 0.0
    assert peltier.row_spreading_resistance(1e-4, 1e-2, 1, (1e-2, 1e-2), 1, 167.0, 1e-3) == 0.0


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


def stored_energy(stack: heat.Stack, seconds: float, steps: int = 800) -> float:
    """Heat [J] that the legs keep after some time; by the trapezium rule in so many steps."""
    state = begin = heat.initial_state(stack, 2, BEGIN)
    for _ in range(steps):
        step = seconds / steps
        ahead = state + step * heat.rates(state, stack, CURRENT)
        state = 0.5 * (state + ahead + step * heat.rates(ahead, stack, CURRENT))
    now, before = heat.profile(state, stack), heat.profile(begin, stack)
    warmer = [peltier.legs_temperature(BEGIN, profile_of.legs[0], BEGIN) for profile_of in (now, before)]
    return CAPACITY * float(warmer[0] - warmer[1])


@pytest.mark.parametrize(("over", "within"), [(0.1, 0.09), (0.3, 0.04), (1.0, 1e-3)])
def test_legs_keep_the_heat_of_a_slab_that_is_heated_evenly(over, within):
    seconds = over * CAPACITY / SLAB.conductance
    whole = CAPACITY * POWER / (12.0 * SLAB.conductance)
    assert stored_energy(between(), seconds) == pytest.approx(CAPACITY * mean_above(seconds), abs=within * whole)


def state_of(cold: float, hot: float, middle: float) -> np.ndarray:
    state = heat.initial_state(between(), 2, BEGIN)
    state[[0, 1, -1]] = (np.array([cold, hot, middle]) - 273.15) / 100.0
    return state


def test_settled_legs_give_half_of_the_current_s_heat_to_either_side():
    middle = peltier.settled_middle(SLAB, CURRENT, 350.0, 310.0)
    state, joined = state_of(310.0, 350.0, middle), between(1e6)
    rates = 100.0 * heat.rates(state, joined, CURRENT)
    assert rates[-1] == pytest.approx(0.0, abs=1e-12)
    through = SLAB.conductance * 40.0
    sides = 1e6 + CAPACITY / 6.0
    assert rates[:2] * sides == pytest.approx([0.5 * POWER + through, 0.5 * POWER - through], rel=1e-9)


def test_legs_between_sides_that_warm_up_take_what_the_heat_equation_says():
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


def test_what_the_legs_lose_evenly_comes_from_either_end_and_the_middle():
    link = lumps.Link(("legs", 0), ("around", 0), 0.3)
    body = lumps.Body(FIXED, lumps.NOWHERE)
    lossy, tight = (between(50.0)._replace(around=(body,), links=links) for links in ((link,), ()))
    state = heat.initial_state(tight, 2, BEGIN)
    state[[0, 1, -1]] = (np.array([320.0, 380.0, 360.0]) - 273.15) / 100.0
    less = 100.0 * (heat.rates(state, tight, 0.0) - heat.rates(state, lossy, 0.0))
    lost = 0.3 * ((320.0 + 4.0 * 360.0 + 380.0) / 6.0 - BEGIN)
    sides = 50.0 + CAPACITY / 6.0
    assert less[[0, 1, -1]] == pytest.approx([lost / 6.0 / sides, lost / 6.0 / sides, lost / CAPACITY], rel=1e-9)


def test_heat_that_the_current_makes_is_stored():
    stack = between(5.0)
    state = state_of(320.0, 380.0, 360.0)
    rates, step = heat.rates(state, stack, CURRENT), 1e-3
    ends = [heat.stored_energy(state + sign * step * rates, stack) for sign in (-1.0, 1.0)]
    assert (ends[1] - ends[0]) / (2.0 * step) == pytest.approx(POWER, rel=1e-6)


def test_halves_of_the_legs_are_as_warm_as_their_parabola():
    hot, middle, cold = 380.0, 352.0, 300.0
    way = (np.arange(4000) + 0.5) / 4000
    parabola = hot + way * (4.0 * middle - 3.0 * hot - cold) + way**2 * (2.0 * hot + 2.0 * cold - 4.0 * middle)
    expected = np.mean(parabola), np.mean(parabola[:2000]), np.mean(parabola[2000:])
    assert peltier.legs_temperatures(hot, middle, cold) == pytest.approx(expected, rel=1e-6)
