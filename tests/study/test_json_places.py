"""Lines of values in a JSON file, held against PyYAML's places, whose language JSON is a part of."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from typing import Any

import pytest
import yaml
from cad_designs import shipped_design

from tvimdesign.study.design import JsonPlaces, design_json


def marks(node: yaml.Node, path: str = "") -> Iterator[tuple[str, int, int]]:
    """Yield every path of a document with the place of its key, or of the item."""
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            yield f"{path}{key.value}", key.start_mark.line + 1, key.start_mark.column + 1
            yield from marks(value, f"{path}{key.value}.")
    elif isinstance(node, yaml.SequenceNode):
        for number, item in enumerate(node.value):
            yield f"{path}{number}", item.start_mark.line + 1, item.start_mark.column + 1
            yield from marks(item, f"{path}{number}.")


@pytest.mark.parametrize("indent", [None, 2])
def test_places_are_those_of_yaml(indent: int | None) -> None:
    plain: dict[str, Any] = json.loads(design_json(shipped_design("paper_compression")))
    plain["name"] = 'a "quote", a \\, {[ and é'
    text = json.dumps(plain, indent=indent, ensure_ascii=False)
    places = JsonPlaces(text.encode())
    loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    every = [item for item in marks(yaml.compose(text, Loader=loader)) if "@" not in item[0]]
    for path, line, column in random.Random(1).sample(every, 30):
        assert (places.at(path).line, places.at(path).column) == (line, column)


def test_a_step_that_is_not_there_is_where_the_last_one_is() -> None:
    places = JsonPlaces(b'{"a": [1,\n {"b": 2}], "c": 3}')
    assert [(places.at(path).line, places.at(path).column) for path in ("a.1.b.x", "a.7", "c.d", "", "z")] == [
        (2, 3), (1, 2), (2, 13), (1, 1), (1, 1),
    ]  # fmt: skip


@pytest.mark.parametrize("data", [b"", b"{", b"\xff\xfe\x00", b"[" * 5000])
def test_of_a_broken_file_no_line_is_known(data: bytes) -> None:
    assert JsonPlaces(data).at("a").line == 0
