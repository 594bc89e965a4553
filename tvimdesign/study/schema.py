"""The JSON Schema of a study, from its sections, for editors; `tvimdesign schema` prints it."""

from __future__ import annotations

import json
from collections.abc import Mapping

from tvimdesign import __version__
from tvimdesign.device import MODES, Table, table_for
from tvimdesign.study.sections.all_sections import SECTIONS
from tvimdesign.study.sections.section import DEFINITIONS, Schema
from tvimdesign.study.sections.tolerances import tolerance_schema
from tvimdesign.study.study import FORMAT


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
