"""The rigid modules of the catalogue: their constants against ratings of their sheets that the constants do not use."""

import pytest
import textbook
from every import of_every
from scipy.optimize import minimize_scalar
from support import STUDIES

from tvimdesign.base.record import Record
from tvimdesign.catalog import Catalog
from tvimdesign.physics.heat_flow import peltier
from tvimdesign.study import read_study

CATALOG = Catalog()
RIGID = [name for name in CATALOG.names("peltiers") if CATALOG.record("peltiers", name).word("form") == "rigid"]
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

    found = minimize_scalar(coldest, bounds=(1e-3, module.seebeck * hot / module.resistance), method="bounded")
    return float(hot - found.fun)


def test_a_fifth_of_the_values_of_sheets_are_assumed() -> None:
    assert len(RIGID) >= 32
    without_sheet = {"qc_17", "flexible_1600", "polyimide_foil_12v", "polyimide_foil_24v", "comb_electrodes"}
    with_sheet = [CATALOG.record("peltiers", n) for n in CATALOG.names("peltiers") if n not in without_sheet]
    of_makers = [
        one for one in with_sheet if all(one.entries[name].status != "assumed" for name in READ if name in one.entries)
    ]
    assert len(of_makers) >= 30
    statuses = [[entry.status for entry in record.entries.values()] for record in with_sheet]
    assert sum(of.count("assumed") for of in statuses) <= 0.2 * sum(len(of) for of in statuses)
    for record, of in zip(with_sheet, statuses, strict=True):
        assert of.count("assumed") <= 0.32 * len(of), record.name


def test_of_what_a_shipped_study_takes_at_most_a_fifth_is_assumed() -> None:
    names = {str(read_study(path).module.get("peltier_module")) for path in STUDIES} & set(RIGID)
    assert "ma10_063_05_1" in names
    for name in names:
        statuses = [entry.status for entry in CATALOG.record("peltiers", name).entries.values()]
        assert statuses.count("assumed") <= 0.2 * len(statuses), name


def test_constants_follow_from_the_ratings() -> None:
    def check(name: str) -> None:
        record = CATALOG.record("peltiers", name)
        expected = textbook.from_data_sheet(*(record.value(field) for field in RATINGS))
        assert tuple(module_of(record)) == pytest.approx(tuple(expected), rel=2e-3)

    of_every(RIGID, check)


def test_resistance_is_that_of_the_bridge_within_a_tenth() -> None:
    def check(name: str) -> None:
        record = CATALOG.record("peltiers", name)
        assert record.value("resistance") == pytest.approx(record.value("ac_resistance"), rel=0.1)

    measured = [name for name in RIGID if "ac_resistance" in CATALOG.record("peltiers", name).entries]
    assert len(measured) >= 22
    of_every(measured, check)


CONTRADICT = {
    "cp10_127_06", "cp30138", "cp30238", "cp60133", "cp60140", "cp60233", "cp60240", "cp60301540", "cp60333", "cp60340",
    "cp60440", "pc_288_10_08", "ro6_0_51_4", "tec1_3105t", "teci_12706", "tm_127_14_40", "tm_31_14_85",
}  # fmt: skip
"""Modules whose sheets say less cooling than their other ratings make: their records say so."""


def test_cooling_power_is_that_of_the_sheet_within_a_tenth() -> None:
    def check(name: str) -> None:
        record = CATALOG.record("peltiers", name)
        found = peltier.max_cooling_power(module_of(record), record.value("hot_side_temperature"))
        sheet = record.entry("max_cooling_power")
        if name in CONTRADICT:
            assert found > 1.1 * sheet.value
            assert f"S and R give {found:.0f} W" in sheet.source
        else:
            assert found == pytest.approx(sheet.value, rel=0.1)

    of_every(RIGID, check)


@pytest.mark.parametrize(
    ("name", "hot", "difference"),
    [
        ("ma10_063_05_1", 323.0, 75.0),  # the sheet's own table for an ambient of 50 degC, in dry nitrogen
        ("ma10_063_03", 323.0, 72.0),
        ("pc_128_10_05", 323.15, 78.0),  # the drawing: 10 K more at a hot side of 50 degC
        ("pc_288_10_08", 323.15, 81.0),
        ("cp30138", 323.15, 72.0),  # the second rating of the sheet
        ("cp30238", 323.15, 72.0),
        ("cp30338", 323.15, 72.0),
        ("cp60333", 323.15, 72.0),
        ("cp60440", 323.15, 75.0),
        ("tec1_12715", 323.15, 79.0),
    ],
)
def test_a_warmer_hot_side_raises_the_difference_as_the_sheet_says(name: str, hot: float, difference: float) -> None:
    module = module_of(CATALOG.record("peltiers", name))
    assert largest_difference(module, hot) == pytest.approx(difference, abs=4.0)


def test_the_second_rating_agrees_with_the_first() -> None:
    def check(name: str) -> None:
        value = CATALOG.record("peltiers", name).value
        module, warm = module_of(CATALOG.record("peltiers", name)), value("warm_side_temperature")
        assert largest_difference(module, warm) == pytest.approx(value("warm_temperature_difference"), rel=0.1)
        grown = peltier.max_cooling_power(module, warm) / peltier.max_cooling_power(
            module, value("hot_side_temperature")
        )
        assert grown == pytest.approx(value("warm_cooling_power") / value("max_cooling_power"), rel=0.1)

    twice = [name for name in RIGID if "warm_cooling_power" in CATALOG.record("peltiers", name).entries]
    assert len(twice) >= 14
    of_every(twice, check)


def test_a_plate_is_as_large_as_its_sides_say() -> None:
    def check(name: str) -> None:
        value, entries = CATALOG.record("peltiers", name).value, CATALOG.record("peltiers", name).entries
        # A hot side with a porch for the wires is longer than the cold side; one record has its hot side's area.
        shorter = value("porch") if "porch" in entries and name != "ma10_063_05_1" else 0.0
        assert value("area") == pytest.approx((value("length") - shorter) * value("width"), rel=1e-9)
        assert 3300.0 < value("mass") / (value("area") * value("thickness")) < 3900.0

    of_every([name for name in RIGID if name not in {"qc_17", "pc_072"}], check)
