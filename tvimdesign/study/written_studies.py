"""Studies that the program writes: a template, shipped examples, a result as a study; and their JSON Schema."""

import json
import os
import re
from collections.abc import Mapping
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path

from tvimdesign import __version__
from tvimdesign.base.errors import InputError
from tvimdesign.device import MODES, Choice, Input, Table, table_for
from tvimdesign.device.table import Feature
from tvimdesign.study.design import Design
from tvimdesign.study.sections import SECTIONS, written
from tvimdesign.study.sections.section import DEFINITIONS, Schema
from tvimdesign.study.sections.tolerances import tolerance_schema
from tvimdesign.study.study import FORMAT, GivenCurrent, ProfileOptions, Range, Study
from tvimdesign.study.text.mistakes import did_you_mean, one_of
from tvimdesign.study.text.yaml_text import Text, yaml_of
from tvimdesign.study.tree import tree_of_values, tree_yaml


def result_text(design: Design, source: str, folder: Path, *, built: bool = False) -> str:
    """Return the text of a study whose `run` gives the design; `folder` will hold its file.

    Of a module that is `built` it has the sizes of its process that the parts are drawn with, which then stay.
    """
    study, table = evaluating(design), table_for(design.mode)
    process = [row.name for row in table.inputs if row.unit == "mm" and (row.record or ("",))[0] == "process"]
    drawn = {name: design.values[name] for name in process if name in table.drawn_with} if built else {}
    study = study.model_copy(update={"as_drawn": {**drawn, **study.as_drawn}})
    return study_text(study, f"The module of {source}", folder)


def study_text(study: Study, title: str, folder: Path) -> str:
    """Return the text of a study below a line with its title; `folder` will hold its file."""
    if study.catalog_folder:
        records = os.path.relpath(Path(study.catalog_folder).resolve(), folder.resolve())
        study = study.model_copy(update={"catalog_folder": records})
    return tree_yaml(tree_of_values(written(study), title, folder))


def started_at(study: Study, values: Mapping[str, float], choices: Mapping[str, str | float]) -> Study:
    """Return the study with its search started at a design, or as near as its ranges allow."""
    module, vary = dict(study.module), dict(study.vary)
    for name, allowed in study.vary.items():
        if isinstance(allowed, Range):
            start = min(max(values[name], allowed.lower), allowed.upper)
            vary[name] = allowed.model_copy(update={"start": start})
        else:
            module[name] = choices[name] if name in choices else values[name]
    return study.model_copy(update={"module": module, "vary": vary})


def evaluating(design: Design) -> Study:
    """Return the design's study with the chosen values in place of ranges and lists, without what a search needs.

    Inputs and choices that have no effect in this module, such as those of a part it does not have, are left out.
    """
    study, table = Study.model_validate(design.study), table_for(design.mode)
    chosen = {name: design.choices.get(name, design.values.get(name)) for name in study.vary}
    module = {**study.module, **{name: value for name, value in chosen.items() if value is not None}}
    lacking = {Feature(choice.name, design.choices[choice.name]) for choice in table.choices}
    rows: list[Choice | Input] = [*table.choices, *table.inputs]
    idle = {row.name for row in rows if lacking & set(row.requires)}
    effective = {name: value for name, value in module.items() if name not in idle}
    currents = {phase: GivenCurrent.model_validate(plain) for phase, plain in design.current_profiles.items()}
    update = {
        "module": effective, "vary": {}, "minimize": {}, "front": None, "profile": ProfileOptions(),
        "currents": currents,
    }  # fmt: skip
    return study.model_copy(update=update)


SCHEMA_FILE = "study.schema.json"
_RENAMED = {"paper_as_published": "paper_reconstructed"}
"""What editors find beside a study, or above `studies/`, once `tvimdesign schema` has written it."""


def template_text() -> str:
    """Return the text of a commented study of the shear module."""
    return files("tvimdesign.study").joinpath("template.yaml").read_text(encoding="utf-8")


def examples() -> dict[str, str]:
    """Return the title line of every shipped study by name."""
    studies = sorted((file for file in _shipped().iterdir() if file.name.endswith(".yaml")), key=lambda file: file.name)
    return {
        file.name.removesuffix(".yaml"): file.read_text(encoding="utf-8").partition("\n")[0].lstrip("# ")
        for file in studies
    }


def example_text(name: str, named: str = "") -> str:
    """Return the text of a shipped study, for a schema beside it; it may be `named` otherwise than the example.

    Raises InputError where there is none of that name.
    """
    known, name = list(examples()), _RENAMED.get(name, name)
    if name not in known:
        raise InputError(f"no shipped study is named {name[:60]!r}; {did_you_mean(name, known) or one_of(known)}")
    text = _shipped().joinpath(f"{name}.yaml").read_text(encoding="utf-8")
    if named and named != name:
        text = re.sub(r"(?m)^name: .*$", lambda _: f"name: {yaml_of(Text(0, 0, named)).splitlines()[0]}", text)
    return text.replace(f"$schema=../{SCHEMA_FILE}", f"$schema={SCHEMA_FILE}")


def _shipped() -> Traversable:
    """Return the folder of studies: beside the package in a checkout, a copy made by setup.py in a wheel."""
    packaged = files("tvimdesign.study").joinpath("examples")
    return packaged if packaged.is_dir() else Path(__file__).parents[2] / "studies"


def json_schema(tables: Mapping[str, Table]) -> Schema:
    """Return the schema of the studies of the modes, each with its table.

    It knows names, shapes and which values need a unit. What needs the catalogue or arithmetic - whether a record
    exists, a unit fits, a value lies in its limits - only the reader knows.
    """
    of_mode = [section for section in SECTIONS if callable(section.schema)]
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "$id": f"urn:tvimdesign:study:{FORMAT}:{__version__}",
        "title": f"tvimdesign study, format {FORMAT}, of tvimdesign {__version__}",
        "description": "A study of a thermo-active variable impedance module. Every quantity has its unit.",
        "type": "object",
        "required": ["mode"],
        "additionalProperties": False,
        "properties": {
            section.name: section.describe() | ({"enum": list(tables)} if section.name == "mode" else {})
            for section in SECTIONS
        },
        "allOf": [
            {
                "if": {"properties": {"mode": {"const": mode}}},
                "then": {"properties": {section.name: section.describe(table) for section in of_mode}},
            }
            for mode, table in tables.items()
        ],
        "definitions": {**DEFINITIONS, "tolerance": tolerance_schema(tables.values())},
    }


def schema_text() -> str:
    """Return the schema of all modes as the text of its file."""
    return json.dumps(json_schema({mode: table_for(mode) for mode in MODES}), indent=2, ensure_ascii=False) + "\n"
