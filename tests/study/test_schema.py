"""The schema for editors, of one mind with the reader in each mode, and the template that `tvimdesign new` writes."""

import json
import re
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import jsonschema
import pytest
import yaml
from support import STUDIES, refused
from test_reader import GOOD

from tvimdesign import __version__
from tvimdesign.device import MODES, Output, Table, table_for
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.study import Study, StudyError, given, read_study_text, template_text
from tvimdesign.study.sections.all_sections import NAMES
from tvimdesign.study.written_studies import example_text, json_schema

WRONG = refused("studies")


@pytest.fixture(scope="module")
def validator(table: Table) -> Any:
    schema = json_schema({"shear": table})
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def test_names_and_units_stand_in_the_schema(table: Table) -> None:
    module = json_schema({"shear": table})["allOf"][0]["then"]["properties"]["module"]["properties"]
    assert set(module) == {row.name for row in (*table.inputs, *table.choices)} - {"temperature", "frequency"}
    assert module["wire_diameter"]["description"] == "Wire diameter [mm]"
    assert module["coil_count"]["description"] == "Coil count"


@pytest.mark.parametrize(
    "text",
    [
        GOOD,
        "mode: shear",
        "mode: shear\nmodule:\nvary: {wire_diameter: {catalog: metric, to: 2 mm}}\nminimize: joint_stiffness@hot",
        "mode: shear\nvary: {coil_count: {choose: [2, '3']}}\nminimize: {module_mass: 50 %}",
        "mode: shear\nvary: {rate_model: {choose: [smi]}}\nminimize: {module_mass: 1e-1}",
        "mode: shear\nsweep: {over: {pcl_thickness: {from: 1 mm, to: 2 mm, step: 1 mm}, arc_count: {from: 3, to: 5}}}",
        "mode: shear\nsweep: {method: sobol, count: 8, over: {require.module_mass: {from: <= 90 g, to: <= 120 g}}}",
        "mode: shear\nsweep: {cells: [{pcl_thickness: 1 mm, rate_model: smi}], outputs: all, most: 3}",
    ],
)
def test_a_good_study_fits(validator: Any, read: Callable[..., Study], text: str) -> None:
    validator.validate(yaml.safe_load(text))
    read(text)


@pytest.mark.parametrize("text", WRONG)
def test_a_wrong_study_does_not(validator: Any, read: Callable[..., Study], text: str) -> None:
    assert not validator.is_valid(yaml.safe_load(text))
    with pytest.raises(StudyError):
        read(text)


def test_the_command_prints_the_schema_of_all_modes() -> None:
    done = subprocess.run([sys.executable, "-m", "tvimdesign", "schema"], capture_output=True, text=True, check=True)
    printed = json.loads(done.stdout)
    jsonschema.Draft7Validator.check_schema(printed)
    assert printed["properties"]["mode"]["enum"] == list(MODES)
    for mode in MODES:
        jsonschema.Draft7Validator(printed).validate({"mode": mode})


def test_schema_and_studies_name_format_and_version() -> None:
    schema = json_schema({})
    assert schema["$id"] == f"urn:tvimdesign:study:1:{__version__}"
    line = "# yaml-language-server: $schema={}study.schema.json\n"
    for path in STUDIES:
        assert line.format("../") in path.read_text(), path.name
        assert line.format("") in example_text(path.stem), path.name
    assert line.format("") in template_text()


def test_the_template_and_its_commented_lines_fit_the_schema() -> None:
    study = read_study_text(template_text(), "template.yaml")
    assert study.task == "optimize"
    assert given(study)["process"].name == study.module["process"]
    validator = jsonschema.Draft7Validator(json_schema({"shear": table_for("shear")}))
    validator.validate(yaml.safe_load(template_text()))
    shown = re.findall(r"^(\w+):", template_text(), re.MULTILINE)
    assert [name for name in NAMES if name not in shown] == ["catalog"]
    text = template_text()
    for name in re.findall(r"^  # (\w+): ", text, re.MULTILINE):
        text = re.sub(rf"^  {name}: .*\n", "", text, flags=re.MULTILINE)
    study = read_study_text(re.sub(r"^  # (\w+: )", r"  \1", text, flags=re.MULTILINE), "template.yaml")
    assert {"wire_diameter", "pcl_grade"} <= set(study.vary)


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
        return [
            limit.limit
            for limit in constraints_of(study, TABLES["compression"], study.module)
            if limit.output == "block_strain"
        ]

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
