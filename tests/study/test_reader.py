"""Good studies, errors as data, messages as in messages/ (UPDATE_MESSAGES=1 rewrites), schema and template."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml
from support import STUDIES, cases_of, refused, sample_text

from tvimdesign import __version__
from tvimdesign.device import MODES, Output, Table, table_for
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.study import (
    Options,
    Range,
    Requirement,
    Study,
    StudyError,
    given,
    read_study,
    read_study_text,
    read_tree,
)
from tvimdesign.study.sections import NAMES
from tvimdesign.study.tree import tree_of_file
from tvimdesign.study.written_studies import example_text, json_schema, template_text

Read = Callable[..., Study]
Refuse = Callable[..., list[str]]

GOOD = sample_text("of_the_small_table")


def test_a_full_study(read, validator):
    validator.validate(yaml.safe_load(GOOD))
    study = read(GOOD)
    assert study.name == "The paper's module, re-optimised"
    assert study.description == "Two lines\nof text"
    assert (study.mode, study.task, study.catalog_folder) == ("shear", "optimize", None)
    assert study.module["wire_diameter"] == pytest.approx(2.413e-3)
    others = {name: value for name, value in study.module.items() if name != "wire_diameter"}
    assert others == {"spring_material": "stainless_302", "coil_count": 3.25, "rate_model": "smi"}
    assert study.vary == {
        "wire_diameter": Range(lower=1.5e-3, upper=3.2e-3, start=study.module["wire_diameter"]),
        "coil_diameter": Range(lower=16e-3, upper=30e-3, start=20e-3),
        "arc_count": Options(values=(3.0, 4.0, 6.0)),
        "pcl_thickness": Range(lower=0.5e-3, upper=1e-3),
        "peltier": Options(values=("flexible_1600", "qc_17")),
    }
    assert study.require == (
        Requirement(output="joint_stiffness@hot", sense=">=", limit=5.0, text=">= 5 N.m/rad"),
        Requirement(output="joint_stiffness@warm", sense="<=", limit=90.0, text="<= 90 N.m/rad"),
        Requirement(output="envelope_diameter", sense="<=", limit=0.15, text="<=150 mm"),
        Requirement(output="impedance_range", sense=">=", limit=20.0, text=">= 20"),
        Requirement(output="impedance_range", sense="<=", limit=500.0, text="<= 500"),
    )
    assert study.minimize == {"module_mass": 1.0, "response_time": 0.5, "joint_stiffness@cold": 2.0}
    assert study.operating_points == {
        "cold": {"temperature": 303.15, "frequency": 1.0},
        "hot": {"temperature": 373.15, "frequency": 10.0},
        "warm": {"temperature": 333.15, "frequency": 1.0},
    }
    assert (study.solver.starts, study.solver.tolerance, study.solver.cells) == (5, 1e-6, 28)
    assert (study.write.plots, study.write.cad) == (True, False)


def test_only_the_mode_is_needed_and_empty_sections_are_none(read):
    study = read("mode: shear", name="my_study")
    assert (study.name, study.task, study.module, study.vary) == ("my_study", "evaluate", {}, {})
    assert set(study.operating_points) == {"cold", "hot"}
    bare = "".join(f"{key}:\n" for key in ("name", "module", "vary", "require", "solver", "catalog"))
    assert read(f"mode: shear\nminimize: {{}}\n{bare}") == read("mode: shear")


@pytest.mark.parametrize("text", [GOOD, "mode: shear"])
def test_json_round_trip(read, text):
    study = read(text)
    assert Study.model_validate(study.model_dump(mode="json")) == study
    assert Study.model_validate_json(study.model_dump_json()) == study


def test_problems_are_data_and_capped_in_print(read):
    with pytest.raises(StudyError) as caught:
        read("mode: shear\nmodule: {wire_diamter: 2 mm}")
    (problem,) = caught.value.problems
    assert (problem.file, problem.line, problem.column, problem.path) == ("x.yaml", 2, 10, "module.wire_diamter")
    assert problem.hint == "did you mean 'wire_diameter'?"
    assert caught.value.exit_code == 2
    with pytest.raises(StudyError) as caught:
        read("mode: shear\nmodule:\n" + "".join(f"  row_{i}: 1\n" for i in range(60)))
    assert len(caught.value.problems) == 60
    assert str(caught.value).splitlines()[50:] == ["... and 10 more"]


def test_a_folder_of_records(tmp_path, table_of, make_catalog, problems):
    (tmp_path / "mine").mkdir()
    (tmp_path / "x.yaml").write_text("mode: shear\ncatalog: mine\n", encoding="utf-8")
    study = read_tree(tree_of_file(tmp_path / "x.yaml"), table_of, make_catalog)
    assert study.catalog_folder == (tmp_path / "mine").as_posix()
    assert study.name == "x"
    (tmp_path / "mine" / "broken").touch()
    lines = problems("mode: shear\ncatalog: mine", folder=tmp_path)
    assert len(lines) == 1
    assert lines[0].startswith("x.yaml:2:10: catalog: ")
    assert lines[0].endswith("mine is broken; in two ways")


def test_no_folder_of_records(problems, tmp_path):
    (tmp_path / "file").touch()
    for written in ("file", "é" * 190, "../nowhere", "[a]"):
        (line,) = problems(f"mode: shear\ncatalog: {written}", folder=tmp_path)
        assert line.startswith("x.yaml:2:10: catalog: ")


WIRES = sample_text("user_wires")


def test_the_users_records_in_the_shipped_catalogue(tmp_path):
    (tmp_path / "mine" / "wires").mkdir(parents=True)
    (tmp_path / "mine" / "wires" / "drawer.yaml").write_text(WIRES, encoding="utf-8")
    text = "mode: shear\ncatalog: mine\nminimize: module_mass\nvary: {wire_diameter: {catalog: %s, to: 5 mm}}\n"
    (tmp_path / "x.yaml").write_text(text % "drawer", encoding="utf-8")
    assert read_study(tmp_path / "x.yaml").vary["wire_diameter"].model_dump() == {
        "values": (pytest.approx(1.9e-3), pytest.approx(2.4e-3)),
        "source": "drawer",
    }
    (tmp_path / "x.yaml").write_text(text % "drawr", encoding="utf-8")
    with pytest.raises(StudyError, match=r"wires: 'drawr'; expected one of drawer, .*; did you mean 'drawer'\?"):
        read_study(tmp_path / "x.yaml")


FOLDER = Path(__file__).with_name("messages")
SNAPSHOTS = {
    "small_table.txt": "small table and catalogue of these tests",
    "shipped_tables.txt": "shipped tables and records",
}
_MANY = re.compile(r"one of (?:[^;]*, \.\.\. \(\d+ in all\)|\d+ names)")
"""A list of names that grows with the table."""


def cases(text: str) -> list[str]:
    """Return the studies of a snapshot, without their messages."""
    return [case.strip("\n") for case in re.split(r"(?m)(?:^> .*\n)+", text) if case.strip()]


@pytest.mark.parametrize("name", SNAPSHOTS)
def test_messages_are_those_of_the_snapshot(problems, name):
    path = FOLDER / name
    expected = path.read_text(encoding="utf-8")
    result = ""
    for text in cases(expected):
        lines = problems(text) if name == "small_table.txt" else _of_shipped_tables(text)
        messages = "".join(f"> {_MANY.sub('one of ...', line.removeprefix('x.yaml:'))}\n" for line in lines)
        result += f"{text}\n{messages}\n"
    if os.environ.get("UPDATE_MESSAGES"):
        path.write_text(result, encoding="utf-8")
    assert result == expected


def _of_shipped_tables(text: str) -> list[str]:
    with pytest.raises(StudyError) as refused:
        read_study_text(text, "x.yaml")
    return str(refused.value).splitlines()


def test_a_limit_on_nothing_lists_first_what_is_meant_most_often():
    (message,) = _of_shipped_tables("mode: shear\nrequire: {xyz: '<= 1 mm'}")
    assert "expected one of module_mass, envelope_diameter, " in message


WRONG = refused("studies")


@pytest.fixture(scope="module")
def validator(table: Table) -> Any:
    schema = json_schema({"shear": table})
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def test_names_and_units_stand_in_the_schema(table):
    module = json_schema({"shear": table})["allOf"][0]["then"]["properties"]["module"]["properties"]
    assert set(module) == {row.name for row in (*table.inputs, *table.choices)} - {"temperature", "frequency"}
    assert module["wire_diameter"]["description"] == "Wire diameter [mm]"
    assert module["coil_count"]["description"] == "Coil count"


@cases_of("reader", "good")
def test_a_good_study_fits(validator, read, text):
    validator.validate(yaml.safe_load(text))
    read(text)


@pytest.mark.parametrize("text", WRONG)
def test_a_wrong_study_does_not(validator, read, text):
    assert not validator.is_valid(yaml.safe_load(text))
    with pytest.raises(StudyError):
        read(text)


@pytest.mark.gate
def test_the_command_prints_the_schema_of_all_modes():
    done = subprocess.run([sys.executable, "-m", "tvimdesign", "schema"], capture_output=True, text=True, check=True)
    printed = json.loads(done.stdout)
    jsonschema.Draft7Validator.check_schema(printed)
    assert printed["properties"]["mode"]["enum"] == list(MODES)
    for mode in MODES:
        jsonschema.Draft7Validator(printed).validate({"mode": mode})


def test_schema_and_studies_name_format_and_version():
    schema = json_schema({})
    assert schema["$id"] == f"urn:tvimdesign:study:1:{__version__}"
    line = "# yaml-language-server: $schema={}study.schema.json\n"
    for path in STUDIES:
        assert line.format("../") in path.read_text(), path.name
        assert line.format("") in example_text(path.stem), path.name
    assert line.format("") in template_text()
    assert example_text("paper_as_published") == example_text("paper_reconstructed")  # its name before


def test_the_template_and_its_commented_lines_fit_the_schema():
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


@cases_of("reader", "of_the_other_mode")
def test_the_schema_takes_a_name_in_its_own_mode(mode, other, text):
    validator = jsonschema.Draft7Validator(json_schema(TABLES))
    assert validator.is_valid(yaml.safe_load(f"mode: {other}\n{text}"))
    assert not validator.is_valid(yaml.safe_load(f"mode: {mode}\n{text}"))


@pytest.mark.parametrize("goal", ["require: {contact_lost@hot: '<= 0.1'}", "minimize: contact_lost@hot"])
def test_the_schema_has_no_output_of_a_simulated_release(goal):
    validator = jsonschema.Draft7Validator(json_schema(TABLES))
    assert not any(validator.is_valid(yaml.safe_load(f"mode: {mode}\n{goal}")) for mode in MODES)


def test_a_study_may_exceed_an_assumed_rule():
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


def test_rows_of_one_name_mean_the_same_in_both_modes():
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
