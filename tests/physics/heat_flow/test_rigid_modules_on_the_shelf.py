"""Rigid modules on the shelf, and the energy that heat keeps."""

from functools import cache
from typing import Any

import numpy as np
import pytest
import textbook
from every import of_every
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar
from support import STUDIES, cases_of

from tvimdesign.base.record import Record
from tvimdesign.catalog import Catalog
from tvimdesign.physics.heat_flow import heat, lumps, peltier
from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.study import read_study

CATALOG = Catalog()
RIGID = [name for name in CATALOG.names("heaters") if CATALOG.record("heaters", name).word("form") == "rigid"]
READ = ("max_current", "max_voltage", "max_temperature_difference", "hot_side_temperature", "resistance", "thickness",
        "area")  # fmt: skip
"""What a maker's sheet says of each of its heaters; of a seller's table the temperature of the hot side is assumed."""
RATINGS = ("max_current", "max_voltage", "max_temperature_difference", "hot_side_temperature")


def module_of(record: Record) -> peltier.PeltierModule:
    return peltier.PeltierModule(*(record.value(field) for field in ("seebeck", "resistance", "conductance")))


def largest_difference(module: peltier.PeltierModule, hot: float) -> float:
    """Temperature difference [K] at which no current draws heat any more, by search rather than by a formula."""

    def coldest(current: float) -> float:  # S I T_c - I^2 R/2 - K (T_h - T_c) = 0
        joule = 0.5 * current**2 * module.resistance
        return (joule + module.conductance * hot) / (module.seebeck * current + module.conductance)

    optimum = minimize_scalar(coldest, bounds=(1e-3, module.seebeck * hot / module.resistance), method="bounded")
    return float(hot - optimum.fun)


def test_a_fifth_of_the_values_of_sheets_are_assumed():
    assert len(RIGID) >= 32
    without_sheet = ("qc_17", "flexible_1600", "polyimide_foil", "comb_electrodes")
    with_sheet = [CATALOG.record("heaters", n) for n in CATALOG.names("heaters") if not n.startswith(without_sheet)]
    of_makers = [
        sheet
        for sheet in with_sheet
        if all(sheet.entries[name].status != "assumed" for name in READ if name in sheet.entries)
    ]
    assert len(of_makers) >= 30
    statuses = [[entry.status for entry in record.entries.values()] for record in with_sheet]
    assert sum(of.count("assumed") for of in statuses) <= 0.2 * sum(len(of) for of in statuses)
    for record, of in zip(with_sheet, statuses, strict=True):
        assert of.count("assumed") <= 0.32 * len(of), record.name


def test_of_what_a_shipped_study_takes_at_most_a_fifth_is_assumed():
    names = {str(read_study(path).module.get("heater_module")) for path in STUDIES} & set(RIGID)
    assert "ma10_063_05_1" in names
    for name in names:
        statuses = [entry.status for entry in CATALOG.record("heaters", name).entries.values()]
        assert statuses.count("assumed") <= 0.2 * len(statuses), name


def test_constants_follow_from_the_ratings():
    def check(name: str) -> None:
        record = CATALOG.record("heaters", name)
        expected = textbook.from_data_sheet(*(record.value(field) for field in RATINGS))
        assert tuple(module_of(record)) == pytest.approx(tuple(expected), rel=2e-3)

    of_every(RIGID, check)


def test_resistance_is_that_of_the_bridge_within_a_tenth():
    def check(name: str) -> None:
        record = CATALOG.record("heaters", name)
        assert record.value("resistance") == pytest.approx(record.value("ac_resistance"), rel=0.1)

    measured = [name for name in RIGID if "ac_resistance" in CATALOG.record("heaters", name).entries]
    assert len(measured) >= 22
    of_every(measured, check)


CONTRADICT = {
    "cp10_127_06", "cp30138", "cp30238", "cp60133", "cp60140", "cp60233", "cp60240", "cp60301540", "cp60333", "cp60340",
    "cp60440", "pc_288_10_08", "ro6_0_51_4", "tec1_3105t", "teci_12706", "tm_127_14_40", "tm_31_14_85",
}  # fmt: skip
"""Modules whose sheets say less cooling than their other ratings make: their records say so."""


def test_cooling_power_is_that_of_the_sheet_within_a_tenth():
    def check(name: str) -> None:
        record = CATALOG.record("heaters", name)
        power = peltier.max_cooling_power(module_of(record), record.value("hot_side_temperature"))
        sheet = record.entry("max_cooling_power")
        if name in CONTRADICT:
            assert power > 1.1 * sheet.value
            assert f"S and R give {power:.0f} W" in sheet.source
        else:
            assert power == pytest.approx(sheet.value, rel=0.1)

    of_every(RIGID, check)


@cases_of("rigid_modules_on_the_shelf", "warmer_hot_side")
def test_a_warmer_hot_side_raises_the_difference_as_the_sheet_says(name, hot, difference):
    module = module_of(CATALOG.record("heaters", name))
    assert largest_difference(module, hot) == pytest.approx(difference, abs=4.0)


def test_the_second_rating_agrees_with_the_first():
    def check(name: str) -> None:
        value = CATALOG.record("heaters", name).value
        module, warm = module_of(CATALOG.record("heaters", name)), value("warm_side_temperature")
        assert largest_difference(module, warm) == pytest.approx(value("warm_temperature_difference"), rel=0.1)
        grown = peltier.max_cooling_power(module, warm) / peltier.max_cooling_power(
            module, value("hot_side_temperature")
        )
        assert grown == pytest.approx(value("warm_cooling_power") / value("max_cooling_power"), rel=0.1)

    twice = [name for name in RIGID if "warm_cooling_power" in CATALOG.record("heaters", name).entries]
    assert len(twice) >= 14
    of_every(twice, check)


def test_a_plate_is_as_large_as_its_sides_say():
    def check(name: str) -> None:
        value, entries = CATALOG.record("heaters", name).value, CATALOG.record("heaters", name).entries
        # A hot side with a porch for the wires is longer than the cold side; one record has its hot side's area.
        shorter = value("porch") if "porch" in entries and name != "ma10_063_05_1" else 0.0
        assert value("area") == pytest.approx((value("length") - shorter) * value("width"), rel=1e-9)
        assert 3300.0 < value("mass") / (value("area") * value("thickness")) < 3900.0

    of_every([name for name in RIGID if name not in {"qc_17", "pc_072"}], check)


AREA = 1579.2e-6  # m^2, Exley et al., table I
AMBIENT, TARGET = 295.15, 373.15
PCL = polymer.Melting(1850.0, 2100.0, 76.75e3, 323.15, 338.15, 500.0)
FLEXIBLE = peltier.PeltierModule(0.025, 3.0, 0.12)
ALUMINIUM = {"plate_conductivity": 167.0, "plate_heat_capacity": 2700.0 * 896.0, "plate_thickness": 2e-3}
# A plate that takes 3 W/m^2 K from the layer and stores next to nothing.
LOSS_ONLY = {"plate_conductivity": 1e3, "plate_heat_capacity": 1e3, "plate_surface": lumps.Surface(AREA, 3.0)}
INSULATED = {"plate_surface": lumps.Surface(AREA, 1e-9)}


def stack_of(module: peltier.PeltierModule, side_capacity: float, **changes: Any) -> heat.Stack:
    """Return the shear module's stack, the cold side in free air."""
    stack = heat.Stack(
        area=AREA, thickness=1e-3, density=1145.0, conductivity_solid=0.225, conductivity_melt=0.18, melting=PCL,
        peltier=module, cold_capacity=side_capacity, hot_capacity=side_capacity,
        cold_surface=lumps.Surface(AREA, 15.0), hot_contact=1e4, plate_contact=1e4, plate_thickness=4e-3,
        plate_conductivity=0.24, plate_heat_capacity=1270.0 * 1200.0, plate_surface=lumps.Surface(AREA, 10.0),
        ambient=AMBIENT, plate_cells=3,
    )  # fmt: skip
    return stack._replace(**changes)


def face_times(stack: heat.Stack, current: float = 1.5, cells: int = 12) -> tuple[float, float]:
    """Times at which the near and the far face of the layer reach 100 degC, by default at the paper's 1.5 A."""

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
    solved = solve_ivp(
        lambda _, y: np.asarray(rates(y)).ravel(), (0.0, 2000.0), begin,
        method="LSODA", lband=1, uband=1, rtol=1e-6, atol=1e-8, events=(near, far),
    )  # fmt: skip
    return float(solved.t_events[0][0]), float(solved.t_events[1][0])


def test_stored_energy_is_mass_times_specific_heat_times_warming():
    stack = stack_of(FLEXIBLE, 2.5, cold_capacity=4.0)
    layer = 1145.0 * AREA * 1e-3 * (231.65e3)  # 22 to 100 degC: 51.8 + 106.375 + 73.5 kJ/kg
    others = (4.0 + 2.5 + 1270.0 * 1200.0 * AREA * 4e-3) * 78.0
    warm, cold = (heat.stored_energy(heat.initial_state(stack, 12, t), stack) for t in (TARGET, AMBIENT))
    assert warm - cold == pytest.approx(layer + others, rel=1e-3)


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
def test_response_times_come_near_an_independent_calculation(module, side_capacity, changes, near, far):
    # Another model of these stacks, cold side in free air (15 W/m^2 K), PETG behind the layer. It is met where the PETG
    # stores no heat and takes 3 W/m^2 K, and a side of the pads holds 2.9 J/K, which that model left out. The
    # 3.9 and 8.6 J/K are 930 and 820 J/kg K in half of the rigid modules' 8.4 and 21 g, near alumina's 880.
    times = face_times(stack_of(module, side_capacity, **changes))
    assert times == pytest.approx((near, far), rel=0.02)


BEHIND = {"insulated": {"plate_heat_capacity": 1.0, **INSULATED}, "aluminium": ALUMINIUM}


def far_time(power: float, thickness: float, behind: str = "insulated") -> float:
    """Time in which a constant heat into the near face of the layer brings its far one to 100 degC."""
    pads = peltier.PeltierModule(0.0, 2.0 * power, 0.0)
    stack = stack_of(pads, 1e-3, cold_capacity=1e9, thickness=thickness, **BEHIND[behind])
    return face_times(stack, current=1.0)[1]


@cache
def power_for_70_seconds(thickness: float, behind: str) -> float:
    return float(brentq(lambda power: far_time(power, thickness, behind) - 70.0, 5.0, 18.0, xtol=1e-2))


@pytest.mark.gate
@pytest.mark.parametrize(
    ("thickness", "behind", "watts"), [(1e-3, "insulated", 5.9), (2e-3, "insulated", 13.0), (1e-3, "aluminium", 15.9)]
)
def test_power_for_70_seconds_is_about_that_of_an_independent_calculation(thickness, behind, watts):
    # The properties of that calculation are within the published ranges but assumed: its heat is 5 % less than that
    # of the middle of the ranges. Its aluminium is 2 mm thick.
    assert power_for_70_seconds(thickness, behind) == pytest.approx(watts, rel=0.07)


@pytest.mark.parametrize(("thickness", "thicker"), [(1e-3, 1.95e-3), (2e-3, 3.63e-3)])
def test_twice_the_time_takes_nearly_twice_the_layer(thickness, thicker):
    # The paper's 140 s against 70 s, by the same independent calculation: a question of depth alone.
    assert far_time(power_for_70_seconds(thickness, "insulated"), thicker) == pytest.approx(140.0, rel=0.02)
