"""Ranges of unmeasured inputs are data; an input without one is a decision with its reason."""

from every import of_every

from tvimdesign.catalog import CATEGORIES, Catalog
from tvimdesign.device import Input, table_for
from tvimdesign.device.table.quantity_group import _all_inputs

ENTRIES = [(name, entry) for group in _all_inputs().values() for name, entry in group.items()]
TABLES = [table_for(mode) for mode in ("shear", "compression")]
INPUTS = {row.name: row for table in TABLES for row in table.inputs}


def test_defaults_have_ranges_as_data_and_choices_a_reason() -> None:
    def check(item: tuple[str, dict[str, object]]) -> None:
        name, entry = item
        if entry.get("status") == "assumed":
            assert {"low", "high"} <= entry.keys() or "range_of" in entry, name
        if entry.get("status") == "chosen":
            assert len(str(entry["source"])) > 3, name
            assert "low" not in entry, name

    of_every(ENTRIES, check)


def test_what_surrounds_a_module_is_not_chosen() -> None:
    # Air, contacts, friction and a supply are not drawn: their ranges are what a result rests on.
    for name in ("ambient_temperature", "surface_emissivity", "adjuster_friction"):
        row = INPUTS[name]
        assert None not in (row.low, row.high), name
        assert row.low < row.high, name
    handbook = Catalog().record("heat_paths", "handbook")
    for name in CATEGORIES["heat_paths"].values:
        assert INPUTS[name].record == ("heat_paths", name)
        assert handbook.entry(name).low < handbook.entry(name).value < handbook.entry(name).high, name


def test_defaults_lie_within_ranges_that_are_read_in_their_unit() -> None:
    def check(row: Input) -> None:
        if row.low is None or row.high is None:
            return
        assert row.lower <= row.low <= row.default <= row.high <= row.upper, row.name

    of_every(list(INPUTS.values()), check)


def test_a_viscosity_moves_by_the_record_s_range_alone() -> None:
    factor = INPUTS["melt_viscosity_factor"]
    assert (factor.low, factor.high, factor.range_of) == (None, None, None)
    assert INPUTS["pcl_zero_shear_viscosity"].record == ("pcl_grade", "zero_shear_viscosity")
