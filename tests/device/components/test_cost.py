"""The cost of a module: what its records ask, counted by hand."""

import math

import casadi
import numpy as np
import pytest
from device_values import inputs_of, values_of

from tvimdesign.base.errors import UnitError
from tvimdesign.base.units import format_quantity, parse_quantity
from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for

RIGID = {"heater_module": "cp30138", "process": "print_peek", "bearing": "ball_6803"}


def test_the_cost_is_that_of_all_pieces_and_of_the_material_by_its_mass():
    wanted = "cost material_cost unpriced_count housing_mass rotor_mass link_mass retainer_mass pocket_count"
    values = values_of(wanted, heater_price="18 USD", pcl_price="50 USD/kg", **RIGID)
    count = values_of("heater_count pcl_mass spring_count", **RIGID)
    structure = 707.0 * sum(values[f"{part}_mass"] for part in ("housing", "rotor", "link", "retainer"))
    assert values["material_cost"] == pytest.approx(structure + 50.0 * count["pcl_mass"])
    # Five M3, 6.50 to 7.91 USD a pack of 100, and as many inserts, 10.90 USD a pack of 100.
    screws = 5.0 * (math.sqrt(0.0650 * 0.0791) + 0.1090)
    bought = screws + 4.0 * 12.70 / 50.0 + 2.0 * 13.00 + 1.25 * values["pocket_count"] + 18.0 * count["heater_count"]
    assert values["cost"] == pytest.approx(values["material_cost"] + bought)
    assert values["unpriced_count"] == count["spring_count"] + 1.0  # and the cut-out
    assert values_of("unpriced_count", spring_price="4 USD", pcl_price="50 USD/kg", heater_price="18 USD", **RIGID) == {
        "unpriced_count": 1.0
    }


def test_a_record_costs_what_the_list_of_parts_is_ordered_for():
    price = Catalog().record("screws", "iso_7380_m3").entry("price")
    assert price.value == pytest.approx(math.sqrt(0.0650 * 0.0791))
    assert "0.065 to 0.0791 USD a piece, 2024-09-16 to 2025-06" in price.source
    assert not Catalog().record("spreaders", "copper").has("price")
    assert not Catalog().record("screws", "iso_4762_m5").has("price")


def test_its_derivatives_are_exact():
    table, inputs = table_for("shear"), inputs_of(pcl_price="50 USD/kg", **RIGID)
    symbol = casadi.SX.sym("x")
    cost = table.evaluate({**inputs, "pcl_thickness": symbol}, ["cost"])["cost"]
    slope = casadi.Function("slope", [symbol], [casadi.jacobian(cost, symbol)])
    at, step = inputs["pcl_thickness"], 1e-7
    ends = [table.evaluate({**inputs, "pcl_thickness": at + d}, ["cost"])["cost"] for d in (-step, step)]
    assert float(slope(at)) == pytest.approx(float(np.diff(ends)[0]) / (2.0 * step), rel=1e-5)
    assert float(slope(at)) > 0.0


def test_a_price_is_in_one_currency():
    assert parse_quantity("60 USD", "USD") == 60.0
    assert format_quantity(0.04, "USD") == "0.04 USD"
    with pytest.raises(UnitError, match="a price such as 25 USD"):
        parse_quantity("60 EUR", "USD")
