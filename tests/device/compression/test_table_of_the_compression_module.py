"""Every row of the compression module is said in words and units, every input is used, and its default can be made."""

from typing import Any

import numpy as np
import pytest
from every import of_every
from support import digits

from tvimdesign.base.units import to_si
from tvimdesign.device import Choice, Input, Output, Supplied, table_for
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.trajectory import Cycle

TABLE = table_for("compression")
OWN = [row for row in TABLE.quantities if row.name not in table_for("shear").by_name and not isinstance(row, Choice)]


def test_row_is_described_and_has_a_unit_that_can_be_read() -> None:
    def check(row: Input | Output) -> None:
        assert len(row.description) >= 8
        assert np.isfinite(to_si(1.0, row.unit))
        if isinstance(row, Input):
            status, _, source = row.source.partition(": ")
            assert status == "chosen" or (status == "assumed" and row.low is not None and row.high is not None)
            assert len(source) > 3
            assert row.default is not None
            assert row.lower <= row.default <= row.upper

    of_every(OWN, check)


def test_every_intermediate_result_is_used() -> None:
    used = {name for row in TABLE.outputs for name in TABLE.ancestors(row.name)}
    used |= {"state_rates"}  # the simulator asks for them
    assert {row.name for row in TABLE.outputs if row.hidden} <= used


def test_nothing_of_the_shear_module_is_left_in_it() -> None:
    assert not {"pcl_thickness", "arc_span", "arc_count", "layer_strain", "arc_width"} & TABLE.by_name.keys()


def test_the_default_module_keeps_every_rule(squeezed_model: DeviceFunctions, squeezed_switch: Cycle) -> None:
    values = squeezed_model.values(squeezed_model.start, squeezed_switch.values)
    for row in TABLE.outputs:
        for rule in row.rules:
            value = values[row.name]
            assert value <= rule.value if rule.sense == "<=" else value >= rule.value, row.name


def test_floats_and_symbols_give_the_same_outputs(
    squeezed: dict[str, Any], squeezed_model: DeviceFunctions, squeezed_switch: Cycle
) -> None:
    wanted = [name for name in TABLE.names(("cold", "hot")) if not isinstance(TABLE.quantity(name), Supplied)]
    floats = TABLE.evaluate({**squeezed, **squeezed_switch.values}, wanted)
    symbols = squeezed_model.values(squeezed_model.start, squeezed_switch.values)
    for name, value in floats.items():
        assert float(value) == pytest.approx(symbols[name], rel=digits(name, 1e-12), abs=1e-300), name
