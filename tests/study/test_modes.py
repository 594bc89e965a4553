"""A study says its mode, and the names it may use are those of that mode."""

import jsonschema
import pytest
import yaml

from tvimdesign.device import MODES, Output, table_for
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.study import read_study_text
from tvimdesign.study.schema import json_schema

TABLES = {mode: table_for(mode) for mode in MODES}
OF_THE_OTHER = [
    ("shear", "compression", "module: {block_depth: 5 mm}"),
    ("shear", "compression", "vary: {block_height: [3 mm, 5 mm]}\nminimize: module_mass"),
    ("shear", "compression", "require: {block_strain: '<= 0.4'}"),
    ("compression", "shear", "module: {pcl_thickness: 1 mm}"),
    ("compression", "shear", "module: {pcl_bond_strength: 3 MPa}"),
    ("compression", "shear", "vary: {arc_span: [30 deg, 40 deg]}\nminimize: module_mass"),
    ("compression", "shear", "vary: {current: [1 A, 2 A]}\nminimize: layer_strain"),
]


@pytest.mark.parametrize(("mode", "other", "text"), OF_THE_OTHER)
def test_the_schema_takes_a_name_in_its_own_mode(mode: str, other: str, text: str) -> None:
    validator = jsonschema.Draft7Validator(json_schema(TABLES))
    assert validator.is_valid(yaml.safe_load(f"mode: {other}\n{text}"))
    assert not validator.is_valid(yaml.safe_load(f"mode: {mode}\n{text}"))


@pytest.mark.parametrize("goal", ["require: {contact_lost@hot: '<= 0.1'}", "minimize: contact_lost@hot"])
def test_the_schema_has_no_output_of_a_simulated_release(goal: str) -> None:
    validator = jsonschema.Draft7Validator(json_schema(TABLES))
    assert not any(validator.is_valid(yaml.safe_load(f"mode: {mode}\n{goal}")) for mode in MODES)


def test_a_study_may_exceed_an_assumed_rule() -> None:
    def limits(text: str) -> list[float]:
        study = read_study_text(f"mode: compression\n{text}")
        return [limit.limit for limit in constraints_of(study, TABLES["compression"]) if limit.output == "block_strain"]

    (rule,) = TABLES["compression"].output("block_strain").rules
    assert "assumed, 0.3 to 0.6" in rule.reason
    assert limits("") == [0.5]
    assert limits("require: {block_strain: '<= 0.6'}") == [0.6]


def test_rows_of_one_name_mean_the_same_in_both_modes() -> None:
    shear, compression = (TABLES[mode].by_name for mode in ("shear", "compression"))
    shared = shear.keys() & compression.keys()
    assert len(shared) > 200
    for name in shared:
        item, other = shear[name], compression[name]
        assert type(item) is type(other), name
        assert getattr(item, "unit", "") == getattr(other, "unit", ""), name
        assert item.group == other.group, name
        if isinstance(item, Output) and isinstance(other, Output):
            assert (item.per_point, item.instant, item.headline) == (other.per_point, other.instant, other.headline), (
                name
            )
