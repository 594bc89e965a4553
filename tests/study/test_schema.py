"""The schema for editors: read off the table, printed by a command, and of one mind with the reader."""

import json
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import jsonschema
import pytest
import yaml
from support import STUDIES
from test_reader import GOOD

from tvimdesign import __version__
from tvimdesign.device import MODES, Table, table_for
from tvimdesign.study import Study, StudyError, template_text
from tvimdesign.study.schema import json_schema
from tvimdesign.study.template import example_text

WRONG = [
    "name: x",
    "mode: bending",
    "mode: shear\nmodul: {}",
    "mode: shear\nmodule: {wire_diamter: 2 mm}",
    "mode: shear\nmodule: {wire_diameter: 2}",
    "mode: shear\nmodule: {wire_diameter: '1,5 mm'}",
    "mode: shear\nmodule: {rate_model: smii}",
    "mode: shear\nmodule: {temperature: 3 degC}",
    "mode: shear\nmodule: [1]",
    "mode: shear\nvary: {wire_diameter: [1 mm]}\nminimize: module_mass",
    "mode: shear\nvary: {arc_count: [1, 3]}\nminimize: module_mass",
    "mode: shear\nvary: {placement_radius: [30 mm, 40 mm]}\nminimize: module_mass",
    "mode: shear\nvary: {wire_diameter: {from: 1 mm, too: 2 mm}}\nminimize: module_mass",
    "mode: shear\nvary: {peltier: {choose: []}}\nminimize: module_mass",
    "mode: shear\nrequire: {module_mas: '<= 3 g'}",
    "mode: shear\nrequire: {module_mass: '< 3 g'}",
    "mode: shear\nrequire: {joint_stiffness: '>= 3 N.m/rad'}",
    "mode: shear\nrequire: {module_mass@hot: '>= 3 g'}",
    "mode: shear\nrequire: {face_temperature: '>= 3 degC'}",
    "mode: shear\nvary: {coil_count: [2, 3]}\nminimize: [module_mass]",
    "mode: shear\nvary: {coil_count: [2, 3]}\nminimize: modul_mass",
    "mode: shear\noperating_points: {Hot: {temperature: 3 degC}}",
    "mode: shear\noperating_points: {hot: {temp: 3 degC}}",
    "mode: shear\nsolver: {starts: 0}",
    "mode: shear\nsolver: {speed: 1}",
    "mode: shear\nwrite: {cad: 1}",
    "mode: shear\ntolerances: usual",
    "mode: shear\ntolerances: {wire_diamter: 1 mm}",
    "mode: shear\ntolerances: {wire_diameter: {plus_minus: 1 mm, distribution: gauss}}",
    "mode: shear\nrobust: {sigma: 2, yield: 0.9}",
    "mode: shear\nsweep: {over: {pcl_thicknes: [1 mm]}}",
    "mode: shear\nsweep: {over: {pcl_thickness: 1 mm}}",
    "mode: shear\nsweep: {over: {rate_model: {from: smi, to: simple}}}",
    "mode: shear\nsweep: {over: {}}",
    "mode: shear\nsweep: {method: random, over: {pcl_thickness: [1 mm]}}",
    "mode: shear\nsweep: {over: {pcl_thickness: {from: 1 mm, too: 2 mm, count: 3}}}",
    "mode: shear\nsweep: {over: {pcl_thickness: [1 mm]}, outputs: [modul_mass]}",
    "mode: shear\nsweep: {over: {pcl_thickness: [1 mm]}, task: solve}",
]


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


def test_the_template_fits_the_schema() -> None:
    validator = jsonschema.Draft7Validator(json_schema({"shear": table_for("shear")}))
    validator.validate(yaml.safe_load(template_text()))


def test_the_schema_names_format_and_version() -> None:
    schema = json_schema({})
    assert schema["$id"] == f"urn:tvimdesign:study:1:{__version__}"


def test_every_shipped_study_and_what_is_written_of_it_names_its_schema() -> None:
    line = "# yaml-language-server: $schema={}study.schema.json\n"
    for path in STUDIES:
        assert line.format("../") in path.read_text(), path.name
        assert line.format("") in example_text(path.stem), path.name
    assert line.format("") in template_text()
