"""Each quantity has words, unit, and range or reason; limits have their rules; symbols give what floats give."""

import numpy as np
import pint
import pytest
import yaml
from cad_designs import TILES, VANE_TILE_ROWS
from device_values import inputs_of
from every import of_every
from hypothesis import given as drawn
from hypothesis import settings
from hypothesis import strategies as st
from support import ROOT, digits

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import to_si
from tvimdesign.catalog import CATEGORIES, Catalog
from tvimdesign.device import MODES, Choice, Input, Output, Supplied, Table, table_for
from tvimdesign.device.table import Feature
from tvimdesign.device.table.quantity_group import _all_inputs
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.nlp.constraints import constraints_of, refuse_impossible
from tvimdesign.study import given, read_study_text

POINTS = ("cold", "hot")
TABLE = table_for("shear")
each_mode = pytest.mark.parametrize("mode", MODES)


@each_mode
def test_numbers_are_described_and_have_a_unit_that_can_be_read(mode):
    def check(row: Input | Output) -> None:
        assert len(row.description) >= 8
        assert row.group
        assert np.isfinite(to_si(1.0, row.unit))

    of_every([row for row in table_for(mode).quantities if not isinstance(row, Choice)], check)


@each_mode
def test_choices_are_described_and_their_defaults_exist(mode):
    inputs = inputs_of(mode)

    def check(row: Choice) -> None:
        assert len(row.description) >= 8
        if row.category and inputs[row.name] not in row.options:
            assert Catalog().record(row.category, inputs[row.name].name) == inputs[row.name]
        else:
            assert (inputs[row.name] if row.record else row.default) in row.options

    of_every(table_for(mode).choices, check)


@each_mode
def test_defaults_lie_within_their_limits_and_have_a_source(mode):
    inputs = inputs_of(mode)

    def check(row: Input) -> None:
        assert row.lower < row.upper
        values = [value for name, value in inputs.items() if name.partition("@")[0] == row.name]
        assert values
        assert all(row.lower <= value <= row.upper for value in values)
        status, _, source = row.source.partition(": ")
        assert status in {"paper", "handbook", "datasheet", "calibrated", "assumed", "chosen", "numerics", "record"}
        assert len(source) > 3
        assert status != "assumed" or "; test: " in source, "names no least test"

    of_every(table_for(mode).inputs, check)


REGISTRY = pint.UnitRegistry()


def dimension(unit: str) -> str:
    kelvin = unit.replace("degC", "kelvin").replace("%", "dimensionless").replace("1/K", "1/kelvin")
    return str(REGISTRY.Quantity(1.0, REGISTRY.parse_units("" if kelvin == "1" else kelvin)).dimensionality)


@each_mode
def test_properties_have_the_dimension_of_their_record(mode):
    inputs = inputs_of(mode)

    def check(row: Input) -> None:
        assert dimension(inputs[row.record[0]].entry(row.record[1]).unit) == dimension(row.unit)

    rows = [row for row in table_for(mode).inputs if row.record and row.default is None and row.exists(inputs)]
    of_every(rows, check)


@each_mode
def test_every_intermediate_result_is_used(mode):
    table = table_for(mode)
    used = {name for row in table.outputs for name in table.ancestors(row.name)} | {"state_rates"}  # of the simulator
    assert {row.name for row in table.outputs if row.hidden} <= used


def test_the_default_compression_module_satisfies_every_rule(squeezed_model, squeezed_switch):
    values = squeezed_model.values(squeezed_model.start, squeezed_switch.values)
    for row in table_for("compression").outputs:
        for rule in row.rules:
            value = values[row.name]
            assert value <= rule.value if rule.sense == "<=" else value >= rule.value, row.name


def test_every_feature_is_a_choice_that_has_the_word_for_none():
    requires = {feature for row in TABLE.quantities for feature in row.requires}
    wanted = {"cover", "preload_adjuster", "motor", "encoder", "cold_side", "impedance_targets"}
    assert {feature.choice for feature in requires} >= wanted
    words = {row.name: row.options for row in TABLE.choices}
    assert [feature for feature in requires if feature.without not in words[feature.choice]] == []
    # What is zero in a module without a feature is no geometry that does not exist.
    assert not any(rule.exists_above is not None for row in TABLE.outputs if row.requires for rule in row.rules)


WITHOUT = {"glass": {"pcl_grade": "pla"}, "rigid": {"heater_module": "ma10_063_05_1", "floor_thickness": 8e-3}}
"""Records that bring a word along which cannot be set alone."""


@each_mode
def test_an_input_of_a_lacking_feature_is_refused(mode):
    table, study = table_for(mode), read_study_text(f"mode: {mode}\n", "a test")

    def check(name: str) -> None:
        row = table.quantity(name)
        value = Catalog().names(row.category)[0] if isinstance(row, Choice) and row.category else row.default
        lacking = row.requires[0]
        by_default = table.quantity(lacking.choice).default == lacking.without
        without = WITHOUT.get(lacking.without, {lacking.choice: lacking.without})
        module = {name: value} if by_default else {**without, name: value}
        with pytest.raises(InputError, match=f"{name}: no effect, as {lacking.choice} is {lacking.without}"):
            refuse_impossible(study.model_copy(update={"module": module}))

    of_every([row.name for row in (*table.choices, *table.inputs) if row.requires], check)


def test_refused_inputs_and_lacking_features_have_words_and_defaults():
    study = read_study_text("mode: shear\nmodule:\n  cover_thickness: 2 mm\n", "a test")
    with pytest.raises(InputError, match="add `cover: plate` under `module`"):
        refuse_impossible(study)
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
    # A yield counts a limit where something that spreads is behind it; the source spreads by 1 %.
    assert "current" in TABLE.ancestors("current_margin")
    assert "cooling_current" not in TABLE.ancestors("current_margin")
    assert {"current", "cooling_current"} <= TABLE.ancestors("cooling_current_margin")
    names = table_for("compression").by_name.keys()
    assert not {"pcl_thickness", "arc_span", "arc_count", "layer_strain", "arc_width"} & names


@each_mode
def test_rules_hold_exactly_where_the_module_has_their_features(mode):
    table, study = table_for(mode), read_study_text(f"mode: {mode}\n", "a test")
    chosen = given(study)
    features = {feature for row in table.outputs if row.rules for feature in row.requires}
    assert len(features) > 8
    for changed in ({}, *({feature.choice: word} for feature in features for word in (feature.without, "another"))):
        limited = {limit.output for limit in constraints_of(study, table, chosen | changed)}
        assert limited == {row.name for row in table.outputs if row.rules and row.exists(chosen | changed)}
    # An option that the search chooses may be any.
    free = study.model_copy(update={"vary": dict.fromkeys((feature.choice for feature in features), None)})
    limited = {limit.output for limit in constraints_of(free, table, {})}
    assert limited == {row.name for row in table.outputs if row.rules}


# --- floats, arrays and symbols ------------------------------------------------------------------------------------

MOTOR = {"motor": "ilm_e70x10", "encoder": "on_axis_28", "motor_driver": "moteus_c1", "stroke": 0.104}
EXTRAS = {
    "cover": "plate", "preload_adjuster": "rotary", "thread_insert": "heat_set", "radial_clearance": 1.7e-3,
    "axial_preload": "wave_21x25", "liner_material": "peek", "cold_side": "sink", "transmission": "unity",
}  # fmt: skip
MODULES = {
    "shear": ("shear", {}),
    "shear, unity": ("shear", {"transmission": "unity"}),
    "shear, motor": ("shear", MOTOR),
    "shear, tiles": ("shear", TILES),
    "shear, extras": ("shear", {**EXTRAS, "key_count": 0.0, "melt_lip": "rings"}),
    "lock": ("lock", {"cover": "plate", "axial_preload": "wave_21x25"}),
    "compression": ("compression", {}),
    "compression, tiles": ("compression", VANE_TILE_ROWS),
    "compression, extras": ("compression", {**EXTRAS, "vane_thickness": 9e-3}),
}


def algebraic(table: Table) -> list[str]:
    """Full names of the outputs a study can ask for that no simulation supplies."""
    return [name for name in table.names(POINTS) if not isinstance(table.quantity(name), Supplied)]


@pytest.mark.parametrize("case", MODULES)
def test_floats_and_symbols_give_the_same_outputs(case):
    mode, module = MODULES[case]
    table = table_for(mode)
    model = DeviceFunctions(table, inputs_of(mode, **module), POINTS, 4)
    supplied = dict(zip(model.switch_names, np.linspace(60.0, 300.0, len(model.switch_names)), strict=True))
    numbers = {name: float(model.start[i]) for name, i in model.index.items()}
    floats = table.evaluate({**model.words, **numbers, **supplied}, algebraic(table))
    symbols = model.values(model.start, supplied)
    for name, value in floats.items():
        assert float(value) == pytest.approx(symbols[name], rel=digits(name, 1e-11), abs=1e-300), name


@pytest.fixture(scope="module")
def small_model() -> DeviceFunctions:
    return DeviceFunctions(TABLE, inputs_of("shear"), POINTS, 4)


@settings(max_examples=5, deadline=None)
@drawn(seed=st.integers(0, 2**31))
def test_arrays_and_symbols_give_the_same_outputs(seed, small_model):
    random, model = np.random.default_rng(seed), small_model
    factors = random.uniform(0.97, 1.03, (len(model.names), 3))
    factors[model.index["rotor_cells"]] = 1.0
    columns = model.start[:, None] * factors
    known = {**model.words, **{name: columns[i] for name, i in model.index.items()}}
    supplied = {name: random.uniform(50.0, 300.0, 3) for name in model.switch_names}
    wanted = algebraic(TABLE)
    arrays = TABLE.evaluate({**known, **supplied}, wanted)
    for j in range(3):
        symbols = model.values(columns[:, j], {name: float(value[j]) for name, value in supplied.items()})
        for name in wanted:
            value = np.broadcast_to(np.asarray(arrays[name], dtype=float), (3,))[j]
            # A difference of angles of about one is as good as they are, to a rounding each.
            rounded = 4.0 * np.finfo(float).eps if TABLE.unit(name) in ("rad", "deg") else 1e-300
            assert value == pytest.approx(symbols[name], rel=digits(name, 1e-11), abs=rounded), name


ENTRIES = [(name, entry) for group in _all_inputs().values() for name, entry in group.items()]
TABLES = [table_for(mode) for mode in ("shear", "compression")]
INPUTS = {row.name: row for table in TABLES for row in table.inputs}


def test_defaults_have_ranges_as_data_and_choices_a_reason():
    def check(item: tuple[str, dict[str, object]]) -> None:
        name, entry = item
        if entry.get("status") == "assumed":
            assert {"low", "high"} <= entry.keys() or "range_of" in entry, name
        if entry.get("status") == "chosen":
            assert len(str(entry["source"])) > 3, name
            assert "low" not in entry, name

    of_every(ENTRIES, check)


def test_what_surrounds_a_module_is_not_chosen():
    # Air, contacts, friction and a supply are not drawn: their ranges are what a result depends on.
    for name in ("ambient_temperature", "surface_emissivity", "adjuster_friction"):
        row = INPUTS[name]
        assert None not in (row.low, row.high), name
        assert row.low < row.high, name
    handbook = Catalog().record("heat_paths", "handbook")
    for name in CATEGORIES["heat_paths"].values:
        assert INPUTS[name].record == ("heat_paths", name)
        assert handbook.entry(name).low < handbook.entry(name).value < handbook.entry(name).high, name


def test_defaults_lie_within_ranges_that_are_read_in_their_unit():
    def check(row: Input) -> None:
        if row.low is None or row.high is None:
            return
        assert row.lower <= row.low <= row.default <= row.high <= row.upper, row.name

    of_every(list(INPUTS.values()), check)


def test_a_viscosity_moves_by_the_record_s_range_alone():
    factor = INPUTS["melt_viscosity_factor"]
    assert (factor.low, factor.high, factor.range_of) == (None, None, None)
    assert INPUTS["pcl_zero_shear_viscosity"].record == ("pcl_grade", "zero_shear_viscosity")


@pytest.mark.parametrize("mode", MODES)
def test_rules_and_headlines_are_those_of_the_table(mode):
    for output in table_for(mode).outputs:
        for rule in output.rules:
            if rule.exists_above is not None:
                assert rule.sense == ">=", output.name
                # A coil of a little more than its wire is one, all else begins at nothing.
                assert rule.exists_above == (1.2 if output.name == "spring_index" else 0.0), output.name
                assert rule.exists_above <= rule.value, output.name
    headlines = {headline.name for headline in table_for(mode).outputs if headline.headline}
    assert {"envelope_diameter", "module_mass", "joint_stiffness", "holding_torque", "response_time"} <= headlines
    # A tenth of the table at most: no gap, and nothing that is one of several screwed joints' alike.
    assert len(headlines) < 0.1 * len(table_for(mode).outputs)
    for output in table_for(mode).outputs:
        assert not (output.headline and (output.group == "Gaps" or output.hidden or "screw" in output.name)), (
            output.name
        )
    numbers = {number.name: number for number in table_for(mode).inputs}
    free = {name for name, number in numbers.items() if number.variable}
    of_springs = {"wire_diameter", "coil_diameter", "coil_count", "preload_angle"}
    assert free & of_springs == (set() if mode == "lock" else of_springs)
    assert "placement_radius" in free
    # A property of a material or of what is bought, the air, or what the user asks for is nobody's to choose.
    of_records = {name for name, number in numbers.items() if number.record is not None and not number.falls_back}
    assert not free & of_records
    assert not free & {"stroke", "ambient_temperature", "temperature", "frequency", "pcl_density", "target_temperature"}


@pytest.mark.parametrize("file", ["formulas.yaml", "margins.yaml", "phase_values.yaml"])
def test_every_formula_of_a_data_file_is_in_a_table(file):
    groups = yaml.safe_load((ROOT / "tvimdesign/device/table" / file).read_text("utf-8"))
    listed = {name for group in groups.values() for name in group}
    assert listed <= {quantity.name for mode in MODES for quantity in table_for(mode).quantities}
