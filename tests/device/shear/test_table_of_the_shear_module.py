"""Every row of the table is said in words and units, and every input is used."""

from typing import Any

import numpy as np
import pint
import pytest
from every import of_every
from hypothesis import given, settings
from hypothesis import strategies as st
from support import digits

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import to_si
from tvimdesign.catalog import Catalog
from tvimdesign.device import Choice, Input, Output, Supplied, Table, table_for
from tvimdesign.device.table.quantity import Feature
from tvimdesign.solve.nlp.constraints import refuse_impossible
from tvimdesign.study import read_study_text

TABLE = table_for("shear")
NUMBERS = [row for row in TABLE.quantities if not isinstance(row, Choice)]


def test_row_is_described_and_has_a_unit_that_can_be_read() -> None:
    def check(row: Input | Output) -> None:
        assert len(row.description) >= 8
        assert row.group
        assert np.isfinite(to_si(1.0, row.unit))

    of_every(NUMBERS, check)


def test_choice_is_described_and_its_default_exists(inputs: dict[str, Any]) -> None:
    def check(row: Choice) -> None:
        assert len(row.description) >= 8
        if row.category and inputs[row.name] not in row.options:
            assert Catalog().record(row.category, inputs[row.name].name) == inputs[row.name]
        else:
            assert (inputs[row.name] if row.record else row.default) in row.options

    of_every(TABLE.choices, check)


def test_default_of_an_input_lies_within_its_limits(inputs: dict[str, Any]) -> None:
    def check(row: Input) -> None:
        assert row.lower < row.upper
        found = [value for name, value in inputs.items() if name.partition("@")[0] == row.name]
        assert found
        assert all(row.lower <= value <= row.upper for value in found)

    of_every(TABLE.inputs, check)


def test_every_extra_is_a_choice_that_has_the_word_for_none() -> None:
    requires = {feature for row in TABLE.quantities for feature in row.requires}
    wanted = {"cover", "preload_adjuster", "sensor_flange", "motor", "encoder", "cold_side", "impedance_targets"}
    assert {feature.choice for feature in requires} >= wanted
    words = {row.name: row.options for row in TABLE.choices}
    assert [feature for feature in requires if feature.without not in words[feature.choice]] == []
    # What is zero in a module without an extra is no geometry that does not exist.
    assert not any(rule.exists_above is not None for row in TABLE.outputs if row.requires for rule in row.rules)


WITHOUT = {"glass": {"pcl_grade": "pla"}}  # PCL has no values of a glass to set the word alone
OF_EXTRAS = [row.name for row in (*TABLE.choices, *TABLE.inputs) if row.requires]


def test_what_is_of_an_extra_is_refused_in_a_study_of_a_module_without_it() -> None:
    def check(name: str) -> None:
        row, study = TABLE.quantity(name), read_study_text("mode: shear\n", "a test")
        value = Catalog().names(row.category)[0] if isinstance(row, Choice) and row.category else row.default
        lacking = row.requires[0]
        by_default = TABLE.quantity(lacking.choice).default == lacking.without
        without = WITHOUT.get(lacking.without, {lacking.choice: lacking.without})
        module = {name: value} if by_default else {**without, name: value}
        with pytest.raises(InputError, match=f"{name}: no effect, as {lacking.choice} is {lacking.without}"):
            refuse_impossible(study.model_copy(update={"module": module}))

    of_every(OF_EXTRAS, check)


def test_a_quantity_of_a_lacking_feature_is_its_default() -> None:
    requires = (Feature("cover", "none"), Feature("motor", "none"))
    row = Output(
        name="gap", unit="mm", description="", group="", function=lambda m: 2.0 * m.width,
        requires=requires, default=7.0,
    )  # fmt: skip
    assert row.needs == ("cover", "motor", "width")
    assert row.call(["plate", "a record", 3.0]) == 6.0
    assert row.call(["none", "a record", None]) == row.call(["plate", "none", None]) == 7.0
    assert row.exists({"cover": "plate", "motor": None})
    assert not row.exists({"cover": "plate", "motor": "none"})


def test_every_intermediate_result_is_used() -> None:
    used = {name for row in TABLE.outputs for name in TABLE.ancestors(row.name)}
    used |= {"state_rates"}  # the simulator asks for them
    assert {row.name for row in TABLE.outputs if row.hidden} <= used


def test_property_is_in_the_default_record_in_the_dimension_of_its_row(inputs: dict[str, Any]) -> None:
    def check(row: Input) -> None:
        assert row.record is not None
        record = inputs[row.record[0]]
        written = record.entry(row.record[1]).unit
        assert _dimension(written) == _dimension(row.unit)

    of_every([row for row in TABLE.inputs if row.record and row.default is None and row.exists(inputs)], check)


REGISTRY = pint.UnitRegistry()


def _dimension(unit: str) -> str:
    kelvin = unit.replace("degC", "kelvin").replace("%", "dimensionless").replace("1/K", "1/kelvin")
    return str(REGISTRY.Quantity(1.0, REGISTRY.parse_units("" if kelvin == "1" else kelvin)).dimensionality)


def test_floats_and_symbols_give_the_same_outputs(
    model: Any, table: Table, algebraic: list[str], numbers: dict[str, float]
) -> None:
    given_numbers = {name: float(model.start[i]) for name, i in model.index.items()}
    floats = table.evaluate({**model.words, **given_numbers, **numbers}, algebraic)
    symbols = model.values(model.start, numbers)
    assert set(floats) <= set(symbols)
    for name, value in floats.items():
        assert float(value) == pytest.approx(symbols[name], rel=digits(name, 1e-12), abs=1e-300), name


@settings(max_examples=5, deadline=None)
@given(seed=st.integers(0, 2**31))
def test_arrays_and_symbols_give_the_same_outputs(seed: int) -> None:
    _hold_arrays_to_symbols(np.random.default_rng(seed))


_BUILT: dict[str, Any] = {}


def _hold_arrays_to_symbols(random: np.random.Generator) -> None:
    from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
    from tvimdesign.study import given as resolve

    if not _BUILT:
        start = resolve(read_study_text("mode: shear\n", "a test"))
        _BUILT["model"] = DeviceFunctions(TABLE, {**start, "transmission": "geometry"}, ("cold", "hot"), 4)
    model = _BUILT["model"]
    factors = random.uniform(0.97, 1.03, (len(model.names), 3))
    factors[model.index["rotor_cells"]] = 1.0
    columns = model.start[:, None] * factors
    known = {**model.words, **{name: columns[i] for name, i in model.index.items()}}
    supplied = {name: random.uniform(50.0, 300.0, 3) for name in model.switch_names}
    wanted = [name for name in TABLE.names(model.points) if not isinstance(TABLE.quantity(name), Supplied)]
    arrays = TABLE.evaluate({**known, **supplied}, wanted)
    for j in range(3):
        symbols = model.values(columns[:, j], {name: float(value[j]) for name, value in supplied.items()})
        for name in wanted:
            value = np.broadcast_to(np.asarray(arrays[name], dtype=float), (3,))[j]
            assert value == pytest.approx(symbols[name], rel=digits(name, 1e-11), abs=1e-300), name


def test_every_input_says_where_its_default_comes_from() -> None:
    def check(row: Input) -> None:
        status, _, source = row.source.partition(": ")
        assert status in {"paper", "handbook", "datasheet", "calibrated", "assumed", "chosen", "numerics", "record"}
        assert len(source) > 3
        assert row.record or row.lower <= row.default <= row.upper

    of_every(TABLE.inputs, check)


def test_a_phase_depends_on_its_current_and_earlier_ones() -> None:
    # A yield counts a limit where something that spreads is behind it; the source spreads by 1 %.
    assert "current" in TABLE.ancestors("current_margin")
    assert "cooling_current" not in TABLE.ancestors("current_margin")
    assert {"current", "cooling_current"} <= TABLE.ancestors("cooling_current_margin")
