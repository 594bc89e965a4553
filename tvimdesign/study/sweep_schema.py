"""The part of the JSON Schema that is the section `sweep`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tvimdesign.study.sections.sweep_block import EVERY_OUTPUT, METHODS, MOST_CELLS, SAMPLED, TASKS
from tvimdesign.study.sections.sweeps import SPACINGS, SWEPT_SECTIONS

Schema = dict[str, Any]
_COUNT: Schema = {"type": "integer", "minimum": 1}


def sweep_schema(about: str, values: Mapping[str, Schema], words: frozenset[str], output: Schema) -> Schema:
    """What may stand under `sweep`: `values` are the schemas of what a module is set to, `words` those without a range.

    `output` is the schema of an output's full name.
    """
    quantity: Schema = {"type": ["string", "number"]}
    named = {name: _axis(value, ranged=name not in words) for name, value in values.items()}
    cell = {
        "type": "object", "additionalProperties": False, "properties": dict(values),
        "patternProperties": {_PATHS: quantity},
    }  # fmt: skip
    over = {
        "type": "object", "minProperties": 1, "additionalProperties": False, "properties": named,
        "patternProperties": {_PATHS: _axis(quantity, ranged=True)},
    }  # fmt: skip
    properties: Schema = {
        "method": {"enum": list(METHODS), "description": "how cells are laid over the axes; a grid unless said"},
        "over": {**over, "description": "what is swept: lists of values, or ranges"},
        "cells": {"type": "array", "minItems": 1, "items": cell, "description": "the cells of a list, one by one"},
        "task": {"enum": list(TASKS), "description": "what is done in each cell; what the study asks unless said"},
        "count": {**_COUNT, "description": f"cells of a sample ({', '.join(SAMPLED)})"},
        "seed": {"type": "integer", "minimum": 0, "description": "of a sample; 1 unless said"},
        "outputs": {
            "description": "outputs that are kept beside those the study asks about",
            "anyOf": [{"const": EVERY_OUTPUT}, {"type": "array", "items": output}],
        },
        "most": {**_COUNT, "description": f"cells beyond which the sweep is refused; {MOST_CELLS} unless said"},
    }  # fmt: skip
    return {
        "description": about, "type": ["object", "null"], "additionalProperties": False, "properties": properties,
    }  # fmt: skip


_PATHS = rf"^({'|'.join(SWEPT_SECTIONS)})\."


def _axis(value: Schema, *, ranged: bool) -> Schema:
    listed: Schema = {"type": "array", "minItems": 1, "items": value}
    if not ranged:
        return listed
    span: Schema = {
        "type": "object", "additionalProperties": False, "required": ["from", "to"],
        "properties": {
            "from": value, "to": value, "count": {"type": "integer", "minimum": 2}, "step": value,
            "spacing": {"enum": list(SPACINGS)},
        },
    }  # fmt: skip
    return {"anyOf": [listed, span]}
