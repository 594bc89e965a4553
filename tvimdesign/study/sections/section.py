"""The declaration of a study's section: name, meaning, reader, JSON Schema and writer.

Sections whose keys are the fields of a model: units, defaults and descriptions give reader, schema and writer.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from tvimdesign.device import Choice, Input, Output, Simulated, Table
from tvimdesign.study.study import Study
from tvimdesign.study.text.mistakes import Mistakes, step
from tvimdesign.study.text.values import Reading, entries, exactly, flag, in_unit, number, readable, unknown_keys, whole
from tvimdesign.study.text.yaml_text import Node

Schema: TypeAlias = dict[str, Any]
NUMBER = r"[+-]?[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?"
POINT = "[a-z][a-z0-9_]{0,31}"  # Names of operating points
DEFINITIONS: Schema = {
    "quantity": {"type": "string", "pattern": rf"^\s*{NUMBER} ?[^\s0-9.,_].*$"},
    "number": {"anyOf": [{"type": "number"}, {"type": "string", "pattern": rf"^\s*{NUMBER}( ?%)?\s*$"}]},
    "limit": {"type": "string", "pattern": rf"^\s*(<=|>=)\s*{NUMBER}"},
}
"""The values that sections refer to."""
QUANTITY, NUMBER_VALUE, LIMIT = ({"$ref": f"#/definitions/{name}"} for name in DEFINITIONS)


@dataclass(frozen=True)
class Section:
    """One section, declared once; the list of all is `all_sections.SECTIONS`."""

    name: str
    meaning: str
    read: Callable[[Reading, Node | None], Any]  # Returns the section's value, and notes every problem
    schema: Schema | Callable[[Table], Schema]
    """The JSON Schema, without the meaning; a function of the table if it depends on the mode."""
    write: Callable[[Study], Any] | None = None
    """Returns the values from which the reader makes the same section; None if a read study has no such section."""
    needs_mode: bool = True  # False if the section is read although the study's mode is not known

    def describe(self, table: Table | None = None) -> Schema:
        """Return the JSON Schema; without a table, that of a section that depends on the mode is its meaning alone."""
        schema = self.schema if isinstance(self.schema, dict) else self.schema(table) if table else {}
        return {"description": self.meaning, **schema}


def mapping(properties: Schema, patterns: Schema | None = None) -> Schema:
    """Return the schema of a section with these keys. Each may be left out, and so may the section."""
    schema = {"type": ["object", "null"], "additionalProperties": False, "properties": properties}
    return schema | ({"patternProperties": patterns} if patterns else {})


def shape(properties: Schema, required: list[str]) -> Schema:
    """Return the schema of a mapping within a section."""
    return {"type": "object", "additionalProperties": False, "required": required, "properties": properties}


def settable(table: Table) -> list[Input | Choice]:
    """Return what `module` may set."""
    quantities = [quantity for quantity in table.quantities if isinstance(quantity, Choice | Input)]
    return [quantity for quantity in quantities if isinstance(quantity, Choice) or not quantity.per_point]


def value_schema(quantity: Input | Choice) -> Schema:
    """Return the schema of one value of an input or a choice."""
    if isinstance(quantity, Choice):
        return {"type": "string"} if quantity.category else {"enum": list(quantity.options)}
    return NUMBER_VALUE if quantity.unit == "1" else QUANTITY


def described(quantity: Input | Choice | Output) -> str:
    """Return the description of a quantity with its unit."""
    unit = "" if isinstance(quantity, Choice) or quantity.unit == "1" else f" [{quantity.unit}]"
    return f"{quantity.description}{unit}"


def set_schema(quantity: Input | Choice) -> Schema:
    """Return the schema of an input or a choice that is set."""
    category = quantity.category if isinstance(quantity, Choice) else ""
    more = f" (a record of the category {category})" if category else ""
    return {"description": described(quantity) + more, "allOf": [value_schema(quantity)]}


def by_output(table: Table, schema: Schema) -> Schema:
    """Return the schema for each output that a study may name, by the pattern of its full names."""
    named = [
        output for output in table.outputs if not (output.instant or output.hidden or isinstance(output, Simulated))
    ]
    return {
        f"^{output.name}{'@' + POINT if output.per_point else ''}$": {"description": described(output), **schema}
        for output in named
    }


def output_name(table: Table) -> Schema:
    """Return the schema of the full name of an output."""
    names = "|".join(pattern[1:-1] for pattern in by_output(table, {}))
    return {"type": "string", "pattern": f"^({names})$"}


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
    read = readable(lambda name, value: _value(problems, value, step(path, name), fields[name]), known)
    try:
        return model(**read)
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
