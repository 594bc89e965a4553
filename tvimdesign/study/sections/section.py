"""The declaration of a study's section: name, meaning, reader, JSON Schema and writer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

from tvimdesign.device import Choice, FirstOscillation, Input, Output, Table
from tvimdesign.study.study import Study
from tvimdesign.study.text.values import Reading
from tvimdesign.study.text.yaml_text import Node

Schema: TypeAlias = dict[str, Any]
NUMBER = r"[+-]?[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?"
POINT = "[a-z][a-z0-9_]{0,31}"
"""Names of operating points."""
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
    read: Callable[[Reading, Node | None], Any]
    """Returns the section's value, and notes every problem."""
    schema: Schema | Callable[[Table], Schema]
    """The JSON Schema, without the meaning; a function of the table if it depends on the mode."""
    write: Callable[[Study], Any] | None = None
    """Returns the values from which the reader makes the same section; None if a read study has no such section."""
    needs_mode: bool = True
    """False if the section is read although the study's mode is not known."""

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
        output
        for output in table.outputs
        if not (output.instant or output.hidden or isinstance(output, FirstOscillation))
    ]
    return {
        f"^{output.name}{'@' + POINT if output.per_point else ''}$": {"description": described(output), **schema}
        for output in named
    }


def output_name(table: Table) -> Schema:
    """Return the schema of the full name of an output."""
    names = "|".join(pattern[1:-1] for pattern in by_output(table, {}))
    return {"type": "string", "pattern": f"^({names})$"}
