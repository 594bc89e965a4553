"""Sections whose keys are the fields of a model: units, defaults and descriptions give reader, schema and writer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from tvimdesign.study.sections.section import NUMBER, QUANTITY, Schema, Section, mapping
from tvimdesign.study.text.mistakes import Mistakes, step
from tvimdesign.study.text.values import Reading, entries, exactly, flag, in_unit, number, unknown_keys, whole
from tvimdesign.study.text.yaml_text import Node

_Model = TypeVar("_Model", bound=BaseModel)
_READERS: dict[Any, Callable[[Mistakes, Node, str], Any]] = {int: whole, float: number, bool: flag}


def settings(
    name: str, meaning: str, model: type[BaseModel], check: Callable[[Reading], None] | None = None
) -> Section:
    """Declare a section whose keys are the fields of a model; `check` notes what contradicts other sections."""

    def read(reading: Reading, node: Node | None) -> BaseModel:
        options = _read(reading.problems, node, name, model)
        if check:
            check(reading)
        return options

    return Section(
        name,
        meaning,
        read,
        mapping(field_schemas(model)),
        lambda study: changed(getattr(study, name)),
        needs_mode=False,
    )


def unit_of(field: FieldInfo) -> str:
    """Return the unit a setting is written in; empty for a count, a share or a flag."""
    extra = field.json_schema_extra
    return str(extra["unit"]) if isinstance(extra, dict) and "unit" in extra else ""


def _read(problems: Mistakes, node: Node | None, path: str, model: type[_Model]) -> _Model:
    fields = model.model_fields
    given = entries(problems, node, path, f"settings: {', '.join(fields)}")
    known = unknown_keys(problems, given, path, "setting", list(fields))
    read = {name: _value(problems, value, step(path, name), fields[name]) for name, value in known.items()}
    try:
        return model(**{name: value for name, value in read.items() if value is not None})
    except ValidationError as error:
        for fault in error.errors():
            name = str(fault["loc"][0])
            message = fault["msg"].replace("Input should be", f"{fault['input']:g} should be")
            problems.add(known[name], step(path, name), message, hint=f"{name} means: {fields[name].description}")
        return model()


def _value(problems: Mistakes, node: Node, path: str, field: FieldInfo) -> Any:
    if unit := unit_of(field):
        return in_unit(problems, node, path, unit, f"a quantity in {unit}")
    return _READERS[field.annotation](problems, node, path)


def field_schemas(model: type[BaseModel]) -> Schema:
    """Return the schema of each field of a model."""
    schemas: Schema = model.model_json_schema()["properties"]
    for name, schema in schemas.items():
        schema.pop("title", None)
        if unit := schema.pop("unit", ""):
            default = f"; default {schema['default']:g} {unit}" if "default" in schema else ""
            value = {"type": "array", "minItems": 2, "items": QUANTITY} if "items" in schema else {"allOf": [QUANTITY]}
            schemas[name] = {"description": schema["description"] + default, **value}
        elif schema.get("type") == "number":  # YAML 1.1 takes 1e-8, without a point, for text
            value = {key: schema.pop(key) for key in ("type", "minimum", "maximum")}
            schemas[name] = schema | {"anyOf": [value, {"type": "string", "pattern": f"^{NUMBER}$"}]}
    return schemas


def changed(options: BaseModel) -> dict[str, Any]:
    """Return the settings that differ from their defaults, as they are written."""
    fields, values = type(options).model_fields, options.model_dump(exclude_defaults=True)
    return {name: written(value, unit_of(fields[name])) for name, value in values.items()}


def written(value: Any, unit: str) -> Any:
    """Return a value, or each of several, as it is written in a unit."""
    if isinstance(value, tuple):
        return [written(item, unit) for item in value]
    return exactly(value, unit) if unit else value
