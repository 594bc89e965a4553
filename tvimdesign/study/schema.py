"""The JSON Schema of a study, read off the table, for editors; `tvimdesign schema` prints it."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any, TypeAlias

from pydantic import BaseModel

from tvimdesign import __version__
from tvimdesign.device import MODES, Choice, FirstOscillation, Input, Output, Table, table_for
from tvimdesign.study.sections.accept import rating_names
from tvimdesign.study.sections.tolerances import STANDARD, tolerance_rows
from tvimdesign.study.study import FEWEST_POINTS, FORMAT, MOST_POINTS, ProfileOptions, SolverOptions, WriteOptions
from tvimdesign.study.sweep_schema import sweep_schema

_NUMBER = r"[+-]?[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?"
_POINT = "[a-z][a-z0-9_]{0,31}"
_Schema: TypeAlias = dict[str, Any]
_SECTIONS = {
    "module": "what the module is",
    "vary": "what may change",
    "require": "what must hold",
    "accept": "ratings of materials and bought parts beyond which the design may be",
    "minimize": "what is to be small, with weights",
    "front": "two or three outputs to be traded against one another, and how many designs to find",
    "operating_points": "where stiffness and damping are wanted; `cold` and `hot` always exist",
    "sweep": "many cells of the study, which `tvimdesign sweep` answers",
    "tolerances": "how far inputs lie from what is drawn; `standard` takes the usual ones",
}
"""The sections whose names depend on the mode, and what they are for."""


def json_schema(tables: Mapping[str, Table]) -> _Schema:
    """Return the schema of the studies of the modes, each with its table.

    It knows names, shapes and which values need a unit. What needs the catalogue or arithmetic - whether a record
    exists, a unit fits, a value lies in its limits - only the reader knows.
    """
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "$id": f"urn:tvimdesign:study:{FORMAT}:{__version__}",
        "title": f"tvimdesign study, format {FORMAT}, of tvimdesign {__version__}",
        "description": "A study of a thermo-active variable impedance module. Every quantity has its unit.",
        "type": "object",
        "required": ["mode"],
        "additionalProperties": False,
        "properties": {
            "tvimdesign": {"const": FORMAT, "description": "format of the file"},
            "name": _text("what the study is called"),
            "description": _text("what the study is for"),
            "mode": {"enum": list(tables), "description": "how the polymer is loaded"},
            "catalog": _text("folder of your own records, relative to this file"),
            **{section: {"description": about} for section, about in _SECTIONS.items()},
            "profile": _options(ProfileOptions),
            "currents": _currents(),
            "robust": _robust(),
            "solver": _options(SolverOptions),
            "write": _options(WriteOptions),
        },
        "allOf": [
            {"if": {"properties": {"mode": {"const": mode}}}, "then": {"properties": _of_mode(table)}}
            for mode, table in tables.items()
        ],
        "definitions": {
            "quantity": {"type": "string", "pattern": rf"^\s*{_NUMBER} ?[^\s0-9.,_].*$"},
            "number": {"anyOf": [{"type": "number"}, {"type": "string", "pattern": rf"^\s*{_NUMBER}( ?%)?\s*$"}]},
            "tolerance": _tolerance(tables.values()),
            "limit": {"type": "string", "pattern": rf"^\s*(<=|>=)\s*{_NUMBER}"},
        },
    }


def _of_mode(table: Table) -> _Schema:
    """The sections that depend on the mode."""
    settable = _settable(table)
    about = _SECTIONS
    return {
        "module": _section(about["module"], {row.name: _set(row) for row in settable}),
        "vary": _section(about["vary"], {row.name: _vary(row) for row in settable if _varies(row)}),
        "require": _section(about["require"], {}, _by_output(table, _require)),
        "accept": _accept(table),
        "minimize": _minimize(table),
        "front": _front(table),
        "operating_points": _points(table),
        "sweep": _sweep(table),
        "tolerances": _tolerances(table),
    }


def schema_text() -> str:
    """Return the schema of all modes as the text of its file."""
    return json.dumps(json_schema({mode: table_for(mode) for mode in MODES}), indent=2, ensure_ascii=False) + "\n"


def _text(description: str) -> _Schema:
    return {"type": ["string", "number", "null"], "description": description}


def _section(description: str, properties: _Schema, patterns: _Schema | None = None) -> _Schema:
    section = {"description": description, "type": ["object", "null"], "additionalProperties": False}
    return section | {"properties": properties} | ({"patternProperties": patterns} if patterns else {})


def _settable(table: Table) -> list[Input | Choice]:
    return [
        row for row in table.quantities if isinstance(row, Choice) or (isinstance(row, Input) and not row.per_point)
    ]


def _varies(row: Input | Choice) -> bool:
    return isinstance(row, Choice) or row.variable


def _value(row: Input) -> _Schema:
    return {"$ref": "#/definitions/number" if row.unit == "1" else "#/definitions/quantity"}


def _about(row: Input | Choice | Output) -> str:
    unit = "" if isinstance(row, Choice) or row.unit == "1" else f" [{row.unit}]"
    return f"{row.description}{unit}"


def _word(row: Choice) -> _Schema:
    return {"type": "string"} if row.category else {"enum": list(row.options)}


def _set(row: Input | Choice) -> _Schema:
    value = _value(row) if isinstance(row, Input) else _word(row)
    category = f" (a record of the category {row.category})" if isinstance(row, Choice) and row.category else ""
    return {"description": _about(row) + category, "allOf": [value]}


def _shape(properties: _Schema, required: list[str]) -> _Schema:
    return {"type": "object", "additionalProperties": False, "required": required, "properties": properties}


def _vary(row: Input | Choice) -> _Schema:
    value = _value(row) if isinstance(row, Input) else _word(row)
    forms = [_shape({"choose": {"type": "array", "minItems": 1, "items": value}}, ["choose"])]
    if isinstance(row, Input):
        record = {
            "type": "string",
            "description": f"a record of the category {row.sizes_in[0]} that lists the sizes one can buy",
        }
        forms.append(_shape({"catalog": record, "from": value, "to": value}, ["catalog"]))
    if isinstance(row, Input):
        spaced = {"from": value, "to": value, "step": value}
        forms.append(_shape(spaced, ["from", "to", *([] if row.integer else ["step"])]))
    if isinstance(row, Input) and not row.integer:
        forms.append({"type": "array", "minItems": 2, "maxItems": 2, "items": value})
        forms.append(_shape({"from": value, "to": value, "start": value}, ["from", "to"]))
    return {"description": _about(row), "anyOf": forms}


def _by_output(table: Table, schema: Any) -> _Schema:
    named = [row for row in table.outputs if not (row.instant or row.hidden or isinstance(row, FirstOscillation))]
    return {f"^{row.name}{'@' + _POINT if row.per_point else ''}$": schema(row) for row in named}


def _require(row: Output) -> _Schema:
    limit = {"$ref": "#/definitions/limit"}
    return {"description": _about(row), "anyOf": [limit, {"type": "array", "minItems": 1, "items": limit}]}


def _accept(table: Table) -> _Schema:
    name = {"enum": rating_names(table)}
    names = {"type": "array", "uniqueItems": True, "items": name}
    return {"description": _SECTIONS["accept"], "anyOf": [names, name, {"type": "null"}]}


def _currents() -> _Schema:
    """Currents that are given over time, by phase."""
    quantities = {"type": "array", "minItems": 2, "items": {"$ref": "#/definitions/quantity"}}
    given = _shape({"moments": quantities, "currents": quantities}, ["moments", "currents"])
    about = "currents of an evaluated module over time, by phase: moments from its start, and a current at each"
    return _section(about, dict.fromkeys(ProfileOptions.model_fields, given))


def _minimize(table: Table) -> _Schema:
    weights = _by_output(table, lambda row: {"description": _about(row), "$ref": "#/definitions/number"})
    names = "|".join(pattern[1:-1] for pattern in weights)
    section = _section(_SECTIONS["minimize"], {}, weights)
    return {"anyOf": [section, {"type": "string", "pattern": f"^({names})$"}]}


def _front(table: Table) -> _Schema:
    names = _output_names(table)
    output = {"type": "string", "pattern": f"^({names})$"}
    outputs = {"type": "array", "minItems": 2, "maxItems": 3, "uniqueItems": True, "items": output}
    points = {"type": "integer", "minimum": FEWEST_POINTS, "maximum": MOST_POINTS, "default": 12}
    return _section(_SECTIONS["front"], {"of": outputs, "points": points})


def _sweep(table: Table) -> _Schema:
    settable = _settable(table)
    words = frozenset(row.name for row in settable if isinstance(row, Choice))
    output = {"type": "string", "pattern": f"^({_output_names(table)})$"}
    return sweep_schema(_SECTIONS["sweep"], {row.name: _set(row) for row in settable}, words, output)


def _output_names(table: Table) -> str:
    return "|".join(pattern[1:-1] for pattern in _by_output(table, lambda _: {}))


def _points(table: Table) -> _Schema:
    rows = [row for row in table.inputs if row.per_point]
    point = _section("one operating point", {row.name: _set(row) for row in rows})
    return _section(_SECTIONS["operating_points"], {}, {f"^{_POINT}$": point})


def _tolerance(tables: Iterable[Table]) -> _Schema:
    """What may be said of one tolerance, whatever its input."""
    size = {"anyOf": [{"type": "number"}, {"type": "string", "pattern": rf"^\s*{_NUMBER}"}]}
    full = _shape(
        {
            "plus_minus": size, "row": {"enum": sorted({name for table in tables for name in tolerance_rows(table)})},
            "distribution": {"enum": ["normal", "uniform"]},
            "sigma": {"$ref": "#/definitions/number"}, "adjustable": {"type": "boolean"}, "adjusted_to": size,
        },
        [],
    )  # fmt: skip
    return {"anyOf": [size, full]}


def _tolerances(table: Table) -> _Schema:
    one = [{"$ref": "#/definitions/tolerance"}]
    rows = [row for row in table.inputs if not row.integer]
    points = {f"^{row.name}@{_POINT}$": {"description": _about(row), "allOf": one} for row in rows if row.per_point}
    named = {row.name: {"description": _about(row), "allOf": one} for row in rows if not row.per_point}
    section = _section(_SECTIONS["tolerances"], {STANDARD: {"type": "boolean"}, **named}, points)
    return {"anyOf": [section, {"const": STANDARD}]}


def _robust() -> _Schema:
    number = {"$ref": "#/definitions/number"}
    about = "standard deviations by which each limit must hold, or the share of modules that must keep all of them"
    return _section(about, {"sigma": number, "yield": number}) | {"maxProperties": 1}


def _options(options: type[BaseModel]) -> _Schema:
    schema = options.model_json_schema()
    for name, field in schema["properties"].items():
        field.pop("title", None)
        if unit := field.pop("unit", ""):
            schema["properties"][name] = {
                "description": f"{field['description']}; {field['default']:g} {unit} unless said",
                "allOf": [{"$ref": "#/definitions/quantity"}],
            }
        elif field["type"] == "number":  # YAML 1.1 takes 1e-8, without a point, for text
            value = {key: field.pop(key) for key in ("type", "minimum", "maximum")}
            schema["properties"][name] = field | {"anyOf": [value, {"type": "string", "pattern": f"^{_NUMBER}$"}]}
    return {
        "description": schema["description"],
        "type": ["object", "null"],
        "additionalProperties": False,
        "properties": schema["properties"],
    }
